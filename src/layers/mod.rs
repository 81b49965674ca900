//! The size field: a stack of layers, each at its own resolution, that together ask for h̄.

mod curve;
mod distance;
mod layer;
mod mask;
mod threats;

pub use curve::{CurveError, ValueCurve};
pub use distance::{ShapeList, Shapes, ShapesError};
pub use layer::{Combine, Layer, LayerId, LayerKind, Quantity};
pub use mask::{Coverage, Mask};
pub use threats::{Threat, ThreatError, ThreatLaw, Threats};
