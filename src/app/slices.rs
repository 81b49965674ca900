//! Work on the mesh in slices, until a frame's time is spent.

use std::time::Instant;

use meshbrush_core::build::BuildError;
use meshbrush_core::document::{Document, Follower};
use meshbrush_mesh::mesh::Progress;

/// Pixels of a stroke, or triangles of its price, in one slice of work: well below a millisecond.
pub const SLICE: usize = 2048;

/// Triangles in one slice of work on the mesh. Few, because a question to a stack of layers with a limit of
/// gradation can take 20 µs.
const MESH_SLICE: usize = 256;

/// Draws the current stroke and brings the follower closer to the document. Returns whether work is left.
pub fn follow_document(
    document: &mut Document,
    follower: &mut Follower,
    deadline: Instant,
) -> Result<bool, BuildError> {
    loop {
        if document.advance_stroke(SLICE) == Progress::More && Instant::now() < deadline {
            continue;
        }
        if follower.advance(document, MESH_SLICE)?.is_settled() {
            return Ok(false);
        }
        if Instant::now() >= deadline {
            return Ok(true);
        }
    }
}
