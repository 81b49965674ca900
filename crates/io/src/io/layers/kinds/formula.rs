use serde::{Deserialize, Serialize};

use super::super::{LayerData, LayerOrigin, SavedQuantity, Stored, compiled};
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use crate::io::lengths::{Measure, TextContext};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{FormulaLayer, LayerKind};
use meshbrush_mesh::text::Length;

/// The keys of a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FormulaKeys {
    /// What its values are.
    pub quantity: SavedQuantity,
    /// A formula in x and y; one of a diameter also in the depth.
    pub formula: String,
}

impl FormulaKeys {
    pub(super) fn of(FormulaLayer { quantity, formula }: &FormulaLayer) -> Self {
        Self { quantity: (*quantity).into(), formula: formula.source().to_owned() }
    }

    fn compiled(&self) -> Result<Formula, KeyFault> {
        let parse = match self.quantity {
            SavedQuantity::Diameter => Formula::parse_of_size,
            SavedQuantity::Risk | SavedQuantity::Error => Formula::parse,
        };
        compiled("formula", &self.formula, parse)
    }
}

impl KindKeys for FormulaKeys {
    fn check(&self, _: Stored) -> Result<(), KeyFault> {
        self.compiled().map(|_| ())
    }

    fn is_risk(&self) -> bool {
        self.quantity == SavedQuantity::Risk
    }

    fn uses_depth(&self) -> bool {
        self.compiled().is_ok_and(|formula| formula.uses_depth())
    }
}

impl LoadKind for FormulaKeys {
    const WORD: &str = "formula";
    const NAME: &str = "Formula";

    /// A target diameter may be a length with a unit.
    fn read_lengths(&mut self, context: &TextContext) -> Result<(), KeyFault> {
        if self.quantity == SavedQuantity::Diameter && Length::with_unit(&self.formula).is_some() {
            let read = || context.number(Measure::Length, &self.formula);
            let length = context.within("formula".into(), read).map_err(|fault| fault.within("formula"))?;
            self.formula = length.to_string();
        }
        Ok(())
    }

    fn load<D: LayerData>(&self, _: &LayerOrigin, _: &mut D) -> Result<LayerKind, D::Error> {
        Ok(LayerKind::Formula(FormulaLayer { quantity: self.quantity.into(), formula: self.compiled()? }))
    }
}
