//! The size field: a stack of layers, each at its own resolution, that together ask for h̄.

mod areas;
mod check;
mod courant;
mod curve;
mod depth;
mod depth_surface;
mod difference;
mod distance;
mod engine;
mod extent;
mod feature_size;
mod idle;
mod kinds;
mod layer;
mod least;
mod mask;
#[cfg(test)]
mod model_tests;
mod models;
mod near_segments;
mod node_depths;
mod paint_layers;
mod paint_reach;
mod reach;
mod risk;
mod risk_model;
mod risk_pixels;
mod risk_slopes;
mod sampled;
mod settled;
mod size_field;
mod strait_count;
mod strait_passage;
mod strait_search;
mod straits;
mod surface;
mod targets;
mod targets_in_order;
mod threat_models;
mod threat_series;
mod threats;
mod usual;

pub use areas::PaintChange;
pub use check::{InvalidLayer, LayerCheck};
pub use courant::CourantFit;
pub use curve::{CurveError, FineAt, ValueCurve};
pub use depth::{DepthError, DepthRule, DepthSizes, Depths, PositiveDepth, wavelength};
pub use depth_surface::DepthSurface;
use depth_surface::{hidden_differently, hiding, surface_changes};
pub(crate) use difference::Circumstances;
pub use distance::{ShapeList, Shapes, ShapesError};
pub use feature_size::{FeatureSize, WaterMiddle};
pub use kinds::{
    BandLayer, DistanceLayer, DistanceTo, FormulaLayer, LayerKind, LayerSource, PaintLayer, RasterLayer,
    RasterReading, RasterSource,
};
pub use layer::{Combine, Layer, LayerId, Quantity};
pub use least::LeastTarget;
pub use mask::{Coverage, Mask};
pub(crate) use models::ModelPlace;
pub use node_depths::{DepthFit, NoDepth, NodeDepths};
pub use paint_layers::PaintLayers;
pub use risk::RiskField;
pub use settled::{SettledPool, SettledSquares};
pub use size_field::{SizeField, SizeFieldSpec};
pub use strait_count::StraitCount;
pub(crate) use strait_search::StraitSearch;
pub use straits::{StraitDisc, StraitDiscs, Straits};
pub use surface::{Surface, SurfaceGoal, SurfaceGoalError, SurfaceNorm, SurfaceSource};
pub use targets::{Decision, DiameterLimit};
pub use targets_in_order::NODES_AT_A_TIME;
pub use threats::{Threat, ThreatError, ThreatLaw, Threats};
