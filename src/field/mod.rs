//! h̄, the target diameter: formulas, rasters and paint, and the rules that compare a triangle with it.

mod bounds;
mod contours;
pub mod formula;
mod samples;
mod source;
mod target_field;
mod transfer;
mod vertex_rule;

pub use bounds::Bounds;
pub use contours::{Contour, contours};
pub use formula::Formula;
pub use source::{Source, checked_target, smallest_target};
pub use target_field::{PaintRef, RefinementRule, TargetField, TargetFieldSpec, f32_not_below};
pub use transfer::{RiskToDiameter, Transfer, TransferError, TransferTable};
pub use vertex_rule::VertexRule;
