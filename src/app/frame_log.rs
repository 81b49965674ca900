//! A line on standard error for each frame, for whoever measures how long frames take.

use meshbrush_kit::kit::clock::{SystemTime, UNIX_EPOCH};

use meshbrush_kit::kit::notices::{Notice, Notices};
use meshbrush_kit::kit::session::Session;

/// Environment variable that asks for the lines. `tests/frame_times.py` and `tests/random_events.py` read
/// them.
const VARIABLE: &str = "MESHBRUSH_FRAMES";

/// Tells when frames were drawn, and what the mesh was.
pub struct FrameLog {
    wanted: bool,
    /// The number of the message that was reported last.
    message: Option<u64>,
}

impl FrameLog {
    /// Writes lines where the environment asks for them.
    pub fn from_environment() -> Self {
        Self { wanted: std::env::var_os(VARIABLE).is_some(), message: None }
    }

    /// Notes a frame that was drawn just now, and the message on the canvas where that changed. The time is
    /// that of the system's clock, in seconds, which other programs can read too.
    pub fn note(&mut self, session: &Session) {
        if !self.wanted {
            return;
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
        let rests = session.follower().is_in_step(session.document()) && session.document().is_stroke_drawn();
        let state = if rests { "at rest" } else { "behind" };
        eprintln!("frame {now:.4} {} {state}", session.mesh().raw_triangle_count());
        self.note_message(session.notices());
    }

    fn note_message(&mut self, notices: &Notices) {
        let shown = notices.shown();
        if self.message == shown.map(|notice| notice.number) {
            return;
        }
        self.message = shown.map(|notice| notice.number);
        let kind = |notice: &Notice| match (notices.shown_stands(), notice.failed) {
            (true, _) => "standing",
            (false, true) => "failed",
            (false, false) => "news",
        };
        match shown {
            Some(notice) => eprintln!("message {} {}", kind(notice), notice.text.replace('\n', " ")),
            None => eprintln!("message none"),
        }
    }
}
