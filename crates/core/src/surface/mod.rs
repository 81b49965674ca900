//! The smallest mesh whose values, linear over triangles, are within an error of a surface.
//!
//! The error of a triangle is the largest difference between the samples of the surface in the closed
//! triangle and the plane through the surface at its corners. *Bisect while the error of a triangle exceeds
//! ε*, with the bisections that keep the mesh conforming, gives one mesh: the smallest of all conforming
//! meshes whose triangles meet ε. Each of its bisections is one that every such mesh must have: the coarse
//! triangles must be bisected where they exceed ε, so must the children of these bisections, and so on.
//!
//! ```text
//!   error of a triangle        ε = 5                              the meshes of smaller ε contain those of
//!   and of its children        9 > ε: bisected                    larger ε, so that the least error with at
//!        9                     3 ≤ ε: stays, although a child     most N triangles is found by bisecting the
//!       / \                    of it would exceed ε               triangle of the largest error, again and
//!      3   7                   7 > ε: bisected                    again
//!     / \  |\
//!    6  2  1 4
//! ```
//!
//! Layers of errors, such as paint, give samples another ε. It stays that of a sample, so that all of this
//! holds with "a sample of the triangle differs by more than its ε" in place of "the error exceeds ε".
//!
//! For the root mean square of differences, or of those of the gradient, the error is a sum over the mesh.
//! The triangle of the largest part is bisected then, again and again (`order`), until the sum is small
//! enough: the mesh is near the smallest one. In either case [`ErrorQueue`] passes all meshes of the order,
//! which are the curve of error against triangles.
//!
//! The error is not monotone: a triangle can meet ε while its children do not. So a mesh for another ε, or
//! after an edit, is made from the top of the bisection tree, and not by coarsening the former one.

mod alignment;
mod errors;
mod fit;
mod heights;
mod nodes;
mod order;
mod queue;
mod rule;
mod samples;
mod sampling;
mod squares;
mod two_sum;

pub use alignment::domain_on_samples;
pub use fit::SurfaceFit;
pub use heights::HeightSource;
pub use nodes::SurfaceNodes;
pub use queue::{CurvePoint, ErrorQueue, QueueGoal};
pub use rule::{SurfaceDemand, SurfaceRule};
pub use samples::{SampleCount, SurfaceSamples};
pub use sampling::SurfaceSampling;
