//! Paths of least cost through the domain, with bounds of how far from the best they can be.

mod certificate;
mod cost;
mod error;

pub use certificate::{Certificate, CertificateEnd, CertificateTask, Placement, PlacementTest};
pub use cost::{CostDensity, CostRange, FormulaCost, WeightedCost, Weights, checked_range};
pub use error::{PathError, Waypoint};
