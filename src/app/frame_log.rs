//! A line on standard error for each frame, for whoever measures how long frames take.

use std::time::{SystemTime, UNIX_EPOCH};

use super::session::Session;

/// Environment variable that asks for the lines. `tests/frame_times.py` reads them.
const VARIABLE: &str = "MESHBRUSH_FRAMES";

/// Tells when frames were drawn, and what the mesh was.
pub struct FrameLog {
    wanted: bool,
}

impl FrameLog {
    /// Writes lines where the environment asks for them.
    pub fn from_environment() -> Self {
        Self { wanted: std::env::var_os(VARIABLE).is_some() }
    }

    /// Notes a frame that was drawn just now. The time is that of the system's clock, in seconds, which other
    /// programs can read too.
    pub fn note(&self, session: &Session) {
        if !self.wanted {
            return;
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
        let rests = session.follower().is_in_step(session.document()) && session.document().is_stroke_drawn();
        let state = if rests { "at rest" } else { "behind" };
        eprintln!("frame {now:.4} {} {state}", session.mesh().raw_triangle_count());
    }
}
