//! Paths of least cost through the domain, with bounds of how far from the best they can be.
//!
//! ```text
//!   domain, keep-out regions, clearance → PathArea: where paths may go
//!   mesh, PathArea         → PathMesh: triangles that paths go through, smaller along the rim of the area
//!   cost on the Earth      → GroundCost: the same in the plane of a projection
//!   CostDensity            → TriangleCosts: the mean and the least cost of each triangle; finer triangles
//!                            where the cost varies much
//!   March                  → distance to each node: fast marching on triangles
//!   trace, refine          → a polyline, and a better one near it, taut where the cost is constant
//!   Ways                   → others, through other valleys that cost nearly the same
//!   Shortest               → the shortest, exactly, where the cost is constant
//!   Lines                  → one along lines that are cheaper than the triangles around them
//!   Shortcuts              → fewer points, for about the same cost
//!   PathFigures            → its cost, rounded up: no path needs to cost more
//!   LowerBound             → no path costs less
//!   Certificate            → a better bound, on a mesh of its own, as close as asked for
//!   DeepestWay             → a path whose cost is low where water is deep
//! ```

mod adaptation;
mod alternatives;
mod area;
mod bisection;
mod certificate;
mod corridor;
mod cost;
mod deepest;
mod detail;
mod error;
mod follow;
mod front;
mod ground;
mod integral;
mod leg;
mod lines;
mod lower;
mod march;
mod meshing;
mod obstacle;
mod origin;
mod outline;
mod disjoint_sets;
mod path_mesh;
mod place;
mod planner;
mod planning;
mod queue;
mod refine;
mod resolve;
#[cfg(test)]
mod resolve_tests;
mod search;
mod shared;
mod shortcuts;
mod shortest;
mod solution;
mod taut;
mod trace;
mod triangle_costs;
mod walls;
mod ways;

pub use alternatives::{Alternatives, Difference};
pub use area::PathArea;
pub(crate) use area::check_clearance;
pub use certificate::{
    Certificate, CertificateEnd, CertificateTask, DualFunction, LegProof, PathCertificate, Placement,
    PlacementTest,
};
pub use corridor::Corridor;
pub use cost::{CostDensity, CostModel, CostRange, FormulaCost, WeightedCost, Weights, checked_range};
pub use deepest::{DeepestWay, DeepestWayError, DepthCost};
pub use error::{PathError, Waypoint};
pub use follow::PlannerMove;
pub use front::{Front, FrontPoint};
pub use ground::{GroundCost, in_plane};
pub use integral::PathFigures;
pub use march::{March, Seed};
pub use meshing::PathMeshing;
pub use path_mesh::{Passage, PathMesh};
pub use place::MeshPlace;
pub use planner::{PathRequest, Planner};
pub use planning::Planning;
pub use refine::Effort;
pub use search::PathSearch;
pub use solution::{PathSample, Solution};
pub use triangle_costs::TriangleCosts;
pub use walls::Walls;
