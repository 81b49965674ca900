//! Work on the mesh in slices, until a frame's time is spent.

use crate::kit::clock::Instant;

use meshbrush_core::build::BuildError;
use meshbrush_core::document::{Document, Follower, Pace, Stage};
use meshbrush_mesh::mesh::Progress;

/// Pixels of a stroke, or triangles of its price, in one slice of work: well below a millisecond.
pub const SLICE: usize = 2048;

/// How far the mesh followed the document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Followed {
    /// No work is left.
    Wholly,
    /// Work is left.
    Partly,
    /// Work is left, and the mesh has more triangles than it may have without a question.
    TooFar,
}

/// Draws the current stroke and brings the follower closer to the document, up to `most` triangles, in slices
/// of the given pace.
pub fn follow_document(
    document: &mut Document,
    follower: &mut Follower,
    pace: &mut Pace,
    most: usize,
    deadline: Instant,
) -> Result<Followed, BuildError> {
    loop {
        if document.advance_stroke(SLICE) == Progress::More && Instant::now() < deadline {
            continue;
        }
        let began = Instant::now();
        let stage = follower.advance(document, pace.visits())?;
        pace.took(began.elapsed().as_secs_f64());
        if stage.is_settled() {
            return Ok(Followed::Wholly);
        }
        if matches!(stage, Stage::Refining { triangles } if triangles > most) {
            return Ok(Followed::TooFar);
        }
        if Instant::now() >= deadline {
            return Ok(Followed::Partly);
        }
    }
}

/// Draws the current stroke, and leaves the mesh alone.
pub fn draw_stroke(document: &mut Document, deadline: Instant) {
    while document.advance_stroke(SLICE) == Progress::More && Instant::now() < deadline {}
}
