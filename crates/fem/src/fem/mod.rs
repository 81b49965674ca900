//! Finite elements on a mesh: −∇·(a∇u) + b·∇u + c u = f with linear elements.
//!
//! The equations are solved by conjugate gradients, or by GMRES where there is convection, with one V-cycle a
//! step. Its levels are the meshes that the bisection went through: a node gets a mean of its *parents*, the
//! ends of the edge that it halved, and each level smooths only its new nodes and their parents
//! \[ChenNochettoXu2012\]. So a V-cycle costs as much as a few products with the matrix, however the mesh is
//! graded. Nodes that the outline or lines moved keep their parents; for those that were added, weights
//! follow from the equations.
//!
//! Numbers in sums are added in an order that follows from the places of the nodes. So the same mesh and
//! problem give the same bits on any number of threads and for any order of the mesh's entries.

mod fem_error;
mod plane_metric;
mod fem_mesh;
mod problem;
mod matrix;
mod element;
mod boundary_data;
mod assembly;
mod tree;
mod growing_rows;
mod coarse_solver;
mod hierarchy;
mod cycle;
mod krylov;
mod solution;
mod flux;
mod doubt;
mod source_range;
mod transport;
mod bound;
mod exact_error;
mod marking;
mod proof;

pub use bound::ErrorBound;
pub use doubt::Doubt;
pub use fem_error::FemError;
pub use fem_mesh::FemMesh;
pub use plane_metric::PlaneMetric;
pub use problem::{BoundaryCondition, EVERY_PIECE, FemProblem, NamedCondition};
pub use proof::{BoundProof, WITHOUT_PROOF};
pub use solution::{ACCURACY, FemSolution};
