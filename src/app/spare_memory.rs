//! Returns freed memory to the system while nothing happens.
//!
//! The allocator of GNU/Linux keeps what is freed, in case it is needed again. After an hour of large and
//! small meshes, that can be more than the document takes.

use eframe::egui::Context;

use meshbrush_kit::kit::clock::Duration;
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::ProgramAllocator;

/// For how long nothing happens before memory is returned, in seconds.
const QUIET: f64 = 2.0;

/// When memory is to be returned.
#[derive(Default)]
pub struct SpareMemory {
    /// The time of the last work, in seconds, until memory has been returned after it.
    worked_at: Option<f64>,
    /// The jobs that had been started, and the revision of the mesh, in the last frame.
    seen: (u64, u64),
    /// Dropping it would end the work.
    returning: Option<Job<()>>,
}

impl SpareMemory {
    /// Notes a frame. Once nothing has happened for a while, memory is returned on another thread. The frames
    /// in which that ends are no work, so the window comes to rest.
    pub fn note_frame(&mut self, ctx: &Context, session: &Session, jobs: &Jobs) {
        let (now, has_input) = ctx.input(|input| (input.time, !input.events.is_empty()));
        let seen = (jobs.started(), session.follower().revision());
        if has_input || std::mem::replace(&mut self.seen, seen) != seen {
            self.worked_at = Some(now);
        }
        let Some(worked_at) = self.worked_at else { return };
        let left = worked_at + QUIET - now;
        if left > 0.0 {
            return ctx.request_repaint_after(Duration::from_secs_f64(left));
        }
        self.worked_at = None;
        let work = |_: &_| ProgramAllocator::return_freed_memory();
        self.returning = Some(jobs.start(JobKind::Compute, work));
        self.seen.0 = jobs.started();
    }
}
