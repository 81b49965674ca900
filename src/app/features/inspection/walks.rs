//! How many steps point location takes in the mesh, which is measured on another thread.

use meshbrush_kit::kit::jobs::{Jobs, Slot};
use meshbrush_kit::kit::session::Session;

/// Points that are located: the mean is then known to a few percent.
const SAMPLES: usize = 1000;

/// Measures the walks of point location (Algorithm 15), and keeps the last mean.
#[derive(Default)]
pub struct WalkMeter(Slot<u64, f64>);

impl WalkMeter {
    /// Returns the mean number of steps that was measured last; it may be that of an earlier mesh.
    pub fn mean_steps(&self) -> Option<f64> {
        self.0.last().map(|(_, mean)| *mean)
    }

    /// Returns whether [`Self::measure`] would measure.
    pub fn is_due(&self, session: &Session) -> bool {
        let is_settled = session.stage().is_settled() && !session.document().is_in_gesture();
        is_settled && !self.0.is_running() && !self.0.has(&session.follower().revision())
    }

    /// Measures the mesh, where that is due.
    pub fn measure(&mut self, session: &Session, jobs: &Jobs) {
        if self.is_due(session) {
            let mesh = session.follower().shared_mesh();
            self.0.start(session.follower().revision(), move || mesh.mean_walk_steps(SAMPLES), jobs);
        }
    }

    /// Takes a mean that is ready, waiting for it as long as the frame may. Returns whether one is being
    /// measured.
    pub fn take(&mut self, session: &Session, jobs: &Jobs) -> bool {
        if session.stage().is_settled() {
            self.0.want(&session.follower().revision(), jobs);
        }
        self.0.take(jobs)
    }
}
