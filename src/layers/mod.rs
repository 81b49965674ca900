//! The size field: a stack of layers, each at its own resolution, that together ask for h̄.

mod layer;
mod threats;

pub use layer::{Combine, Layer, LayerId, LayerKind, Quantity};
pub use threats::{Threat, ThreatError, ThreatLaw, Threats};
