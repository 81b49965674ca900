//! The size field: a stack of layers, each at its own resolution, that together ask for h̄.

mod areas;
mod check;
mod curve;
mod depth;
mod difference;
mod distance;
mod engine;
mod extent;
mod layer;
mod least;
mod mask;
#[cfg(test)]
mod model_tests;
mod models;
mod node_depths;
mod paint_layers;
mod reach;
mod risk;
mod risk_pixels;
mod risk_slopes;
mod sampled;
mod settled;
mod size_field;
mod targets;
mod targets_in_order;
mod threat_models;
mod threat_series;
mod threats;
mod usual;

pub use areas::PaintChange;
pub use check::{InvalidLayer, LayerCheck};
pub use curve::{CurveError, FineAt, ValueCurve};
pub use depth::{DepthError, DepthRule, DepthSizes, Depths, PositiveDepth, wavelength};
pub(crate) use difference::Circumstances;
pub use distance::{ShapeList, Shapes, ShapesError};
pub use layer::{Combine, DistanceTo, Layer, LayerId, LayerKind, Quantity, RasterReading, RasterSource};
pub use least::LeastTarget;
pub use mask::{Coverage, Mask};
pub use node_depths::{DepthFit, NoDepth, NodeDepths};
pub use paint_layers::PaintLayers;
pub use risk::RiskField;
pub use settled::{SettledPool, SettledSquares};
pub use size_field::{SizeField, SizeFieldSpec};
pub use targets::{Decision, DiameterLimit};
pub use targets_in_order::NODES_AT_A_TIME;
pub use threats::{Threat, ThreatError, ThreatLaw, Threats};
