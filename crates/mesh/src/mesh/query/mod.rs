//! Queries on a finished mesh: location, adjacency, survey, interpolation, fingerprint, checks, forecast, the
//! bisection tree and the causes of its triangles.

mod adjacency;
mod cause;
mod census;
mod check;
mod cleaning;
mod fingerprint;
mod forecast;
mod forecast_questions;
mod forest;
mod interpolate;
mod locate;
mod locator;
mod patched_locator;
mod parts;
mod topology;
mod tree;

pub use adjacency::Adjacency;
pub use cause::Cause;
pub use census::Census;
pub use check::Violation;
pub use cleaning::{Cleaning, KeptParts, Removed, RemovedPart};
pub use fingerprint::{Fingerprint, fingerprint_of};
pub use forecast::Forecast;
pub use interpolate::{barycentric, interpolate};
pub use locate::Location;
pub use locator::Locator;
pub use patched_locator::PatchedLocator;
pub use topology::Topology;
