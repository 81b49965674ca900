//! The ingredients of target diameters h̄: formulas, the curve from risk to diameter, and the report's rule.

mod bounds;
mod contours;
pub mod formula;
mod taylor_model;
mod target;
mod transfer;
mod vertex_rule;

pub use bounds::Bounds;
pub use contours::{Contour, contours};
pub use formula::{CostFormula, Formula};
pub use target::{RefinementRule, checked_target, f32_not_below};
pub(crate) use taylor_model::TaylorModel;
pub use transfer::{RiskToDiameter, Transfer, TransferError, TransferTable};
pub use vertex_rule::VertexRule;
