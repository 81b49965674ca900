//! Layers by a formula.

use glam::DVec2;

use crate::field::Formula;
use crate::layers::engine::{CompiledPlane, NO_RISK, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::risk_source::RiskSource;
use crate::layers::value_change::{LayerEdit, ValueChange, direction};
use crate::layers::{Combine, LayerSlot, LayerSource, Quantity};
use crate::mesh::TargetChange;
use crate::raster::TiledRaster;

/// A formula in x and y.
#[derive(Clone, Debug, PartialEq)]
pub struct FormulaLayer {
    /// The meaning of the formula's value.
    pub quantity: Quantity,
    /// The formula.
    pub formula: Formula,
}

impl LayerSource for FormulaLayer {
    fn label(&self) -> &'static str {
        "Formula"
    }

    fn change_title(&self) -> &'static str {
        "formula"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        (plane.reading(self.quantity, NO_RISK), Values::of_formula(&self.formula, self.quantity, plane))
    }

    fn quantity(&self) -> Quantity {
        self.quantity
    }

    fn says_diameters(&self) -> bool {
        self.quantity == Quantity::Diameter
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        vec![(self.formula.address(), self.formula.bytes())]
    }

    fn risk_at(&self, point: DVec2, _: Option<&TiledRaster>) -> Option<f64> {
        (self.quantity == Quantity::Risk).then(|| self.formula.eval(point.x, point.y))
    }

    fn risks(&self, _: Option<&TiledRaster>) -> Option<RiskSource> {
        (self.quantity == Quantity::Risk).then(|| RiskSource::Formula(self.formula.clone()))
    }

    fn error_at(&self, point: DVec2, _: Option<&TiledRaster>) -> Option<f64> {
        (self.quantity == Quantity::Error).then(|| self.formula.eval(point.x, point.y))
    }

    fn uses_depth(&self) -> bool {
        self.formula.uses_depth()
    }

    fn extent(&self, _: LayerSlot, _: &ExtentContext) -> Extent {
        match (self.quantity, self.formula.constant()) {
            (Quantity::Diameter, Some(f64::INFINITY)) => Extent::NOTHING,
            _ => Extent::Everywhere,
        }
    }

    fn change_since(&self, old: &dyn LayerSource, edit: &LayerEdit) -> ValueChange {
        match old.get::<Self>() {
            Some(old) if old.quantity == self.quantity => {
                let formulas = [&self.formula, &old.formula];
                ValueChange::Anywhere(formula_change(self.quantity, formulas, edit.combine))
            }
            _ => ValueChange::Anywhere(TargetChange::Any),
        }
    }
}

/// Returns the direction of a change of a formula: known where both are constant.
fn formula_change(quantity: Quantity, [new, old]: [&Formula; 2], combine: Combine) -> TargetChange {
    let (Quantity::Diameter, Some(new), Some(old)) = (quantity, new.constant(), old.constant()) else {
        return TargetChange::Any;
    };
    let ask_alike = combine == Combine::Finest || (new.is_finite() && old.is_finite());
    match direction([new], [old]) {
        Some(change) if ask_alike && new > 0.0 && old > 0.0 => change,
        _ => TargetChange::Any,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TargetChange::{Any, Coarser, Finer};

    #[test]
    fn a_formula_without_a_diameter_before_or_after_can_change_either_way() {
        let infinite = f64::INFINITY;
        for (new, old, finest, floor) in [
            (0.2, 0.3, Finer, Finer),
            (0.3, 0.2, Coarser, Coarser),
            // Where the finest counts, a layer that asks for nothing is coarser than any; a floor is lower.
            (infinite, 0.3, Coarser, Any),
            (0.3, infinite, Finer, Any),
            (0.0, 0.3, Any, Any),
            (0.3, -0.1, Any, Any),
        ] {
            let formulas = [new, old].map(Formula::constant_of);
            let change = |quantity, combine| formula_change(quantity, [&formulas[0], &formulas[1]], combine);
            assert_eq!(change(Quantity::Diameter, Combine::Finest), finest, "{new} {old}");
            assert_eq!(change(Quantity::Diameter, Combine::Floor), floor, "{new} {old}");
            assert_eq!(change(Quantity::Risk, Combine::Finest), Any, "{new} {old}");
        }
    }
}
