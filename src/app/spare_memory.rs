//! Returns freed memory to the system while nothing happens.
//!
//! The allocator of GNU/Linux keeps what is freed, in case it is needed again. After an hour of large and
//! small meshes, that can be more than the document takes.

use eframe::egui::Context;

use meshbrush_kit::kit::clock::Duration;
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs};
use meshbrush_mesh::mesh::ProgramAllocator;

/// For how long nothing happens before memory is returned.
const QUIET: Duration = Duration::from_secs(2);

/// When memory is to be returned.
#[derive(Default)]
pub struct SpareMemory {
    /// The time of the last frame, until memory has been returned after it.
    last_frame: Option<f64>,
    /// Dropping it would end the work.
    returning: Option<Job<()>>,
}

impl SpareMemory {
    /// Notes a frame. The first one after a quiet time returns memory, on another thread; it is asked for
    /// here, once.
    pub fn note_frame(&mut self, ctx: &Context, jobs: &Jobs) {
        let now = ctx.input(|input| input.time);
        match self.last_frame.replace(now) {
            Some(last) if now - last >= QUIET.as_secs_f64() => {
                self.last_frame = None;
                let work = |_: &_| ProgramAllocator::return_freed_memory();
                self.returning = Some(jobs.start(JobKind::Compute, work));
            }
            _ => ctx.request_repaint_after(QUIET),
        }
    }
}
