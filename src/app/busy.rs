use std::time::{Duration, Instant};

/// Work shorter than this shows no progress bar: it would only flicker.
const MOMENT: Duration = Duration::from_millis(250);

/// Tells work that takes a moment from work that takes long.
#[derive(Clone, Copy, Debug, Default)]
pub struct Busy {
    since: Option<Instant>,
}

impl Busy {
    /// Whether the work under way has been so for longer than a moment. To be asked in every frame.
    pub fn is_long(&mut self, working: bool) -> bool {
        if !working {
            self.since = None;
            return false;
        }
        self.since.get_or_insert_with(Instant::now).elapsed() > MOMENT
    }
}
