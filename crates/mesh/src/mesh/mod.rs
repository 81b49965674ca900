//! The method of the report: a mesh of right-angled isosceles triangles, refined by local bisection. In other
//! words, adaptive mesh refinement by newest vertex bisection.
//!
//! Nothing here knows a field, a file or a window. What to refine and where the domain lies come in as
//! closures.
//!
//! ```
//! use meshbrush_mesh::geometry::{Lattice, Rect};
//! use meshbrush_mesh::mesh::{Limits, Mesh};
//!
//! // Refine to a diameter of 0.1 near the origin, 0.5 elsewhere.
//! let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000)?;
//! let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default())?;
//! mesh.refine(&Limits::default(), |element| {
//!     let near = element.world_corners().iter().any(|x| x.length() < 0.3);
//!     element.diameter() > if near { 0.1 } else { 0.5 }
//! })?;
//! assert!(mesh.violations().is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Three parts: `kernel` makes and changes meshes, `extract` numbers what leaves the program, `query` answers
//! questions. Each imports only from those before it.

mod kernel;
mod extract;
mod query;

pub use extract::{
    BoundaryEdge, Cell, CurveOrder, DrawnPiece, Extract, MeshEdge, MeshPatch, MeshStatistics, MeshView,
    PatchPieces, PatchTriangle, Replacement,
};
pub use kernel::{
    Answer, BlockRefiner, ChangedArea, Changes, CoarseError, Element, Falloff, InvalidTarget, LevelsWithin,
    Limits, MOST_TRIANGLES, MemoryLimit, Mesh, MeshCopy, Neighbour, NodeId, Orientation, ProgramAllocator,
    Progress, RefineError, Refiner, RuleAnswers, SharedRule, TargetChange, TreeTriangle, Triangle,
    TriangleId, Updater, bisection_edge_length, level_for_diameter,
};
pub use query::{
    Adjacency, Cause, Census, Cleaning, Fingerprint, Forecast, KeptParts, Location, Locator, PatchedLocator,
    Removed, RemovedPart, Topology, Violation, barycentric, fingerprint_of, interpolate,
};
