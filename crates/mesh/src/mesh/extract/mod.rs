//! The exported mesh: nodes and triangles of the domain, numbered without gaps.

#[expect(clippy::module_inception, reason = "the part is named for its main type")]
mod extract;
mod boundary;
mod curve;
mod homes;
mod patch;
mod pieces;
mod refined;
mod statistics;
mod view;

pub use curve::CurveOrder;
pub use extract::{BoundaryEdge, Cell, Extract, MeshEdge};
pub use patch::{MeshPatch, PatchTriangle};
pub use pieces::{DrawnPiece, PatchPieces, Replacement};
pub use statistics::MeshStatistics;
pub use view::MeshView;
