//! Layers of a formula.

use std::fmt;
use std::str::FromStr;

use eframe::egui::Ui;

use super::quantity_name;
use meshbrush_core::field::Formula;
use meshbrush_core::field::formula::ParseError;
use meshbrush_core::layers::{FormulaLayer, Layer, LayerKind, Quantity};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{Addition, FormulaRow, FrameState, LayerKindRow, add_layer, set_kind_once};
use meshbrush_ui::widgets::{Icon, NumberRow, segmented};

/// A formula in x and y.
pub static FORMULA: LayerKindRow = LayerKindRow {
    place: 1,
    is_of: |kind| kind.is::<FormulaLayer>(),
    icon: Icon::FORMULA,
    tool: None,
    additions: &[
        Addition {
            title: "formula for the target diameter",
            command: |state| {
                add_layer(LayerKind::constant(state.session.document().settings().transfer.h_max))
            },
        },
        Addition {
            title: "formula for the risk",
            command: |_| add_layer(LayerKind::risk(Formula::constant_of(0.0))),
        },
    ],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(FormulaLayer { quantity, formula }) = layer.kind.get() else { return };
    let mut chosen = *quantity;
    let choices = [Quantity::Diameter, Quantity::Risk, Quantity::Error]
        .map(|quantity| (quantity, quantity_name(quantity)));
    if segmented(ui, "What the formula gives", &mut chosen, &choices).changed() {
        let kind = LayerKind::Formula(FormulaLayer { quantity: chosen, formula: formula.clone() });
        set_kind_once(layer, kind, commands);
    }
    ui.add_space(4.0);
    if let (Quantity::Diameter, Some(diameter)) = (quantity, formula.constant().filter(|d| d.is_finite())) {
        constant_row(ui, state, layer, diameter, commands);
    }
    let row = match quantity {
        Quantity::Diameter => FormulaRow {
            label: "Target diameter h̄(x, y)",
            hint: "if(abs(x) + abs(y) < 0.4, 0.01, 0.2)",
            help: "Target diameter at x and y, as a formula; h_min and h_max bound it. With layers of depths, `depth` is \
                   the depth of the water in metres: where there is none, the formula asks for nothing.",
        },
        Quantity::Risk => FormulaRow {
            label: "Risk at (x, y)",
            hint: "if(abs(x) + abs(y) < 0.4, 1, 0)",
            help: "Risk at x and y, 0 to 1, as a formula.",
        },
        Quantity::Error => FormulaRow {
            label: "Largest error at (x, y)",
            hint: "if(x < 0.5, 0.1, 2)",
            help: "The largest error of the mesh from surfaces at x and y, in their unit, as a formula. It counts in place \
                   of that of the layer of the surface; inf leaves that as it is.",
        },
    };
    let entered = match quantity {
        Quantity::Diameter => {
            let typed = row.show(ui, state, Some(&TypedSize(formula.clone())));
            typed.map(|typed| typed.map(|TypedSize(formula)| formula))
        }
        Quantity::Risk | Quantity::Error => row.show(ui, state, Some(formula)),
    };
    if let Some(Some(formula)) = entered {
        set_kind_once(layer, FormulaLayer { quantity: *quantity, formula }, commands);
    }
}

/// A formula of a target diameter, which may use the depth.
#[derive(Clone, Debug, PartialEq)]
struct TypedSize(Formula);

impl FromStr for TypedSize {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        Formula::parse_of_size(text).map(Self)
    }
}

impl fmt::Display for TypedSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A formula that is the same everywhere, as a number.
fn constant_row(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, value: f64, commands: &mut Vec<Command>) {
    let h_max = state.session.document().settings().transfer.h_max;
    let mut value = value;
    let help = "Target diameter everywhere; h_min and h_max bound it.";
    let row = NumberRow::new("Diameter", &mut value).range(f64::MIN_POSITIVE..=f64::MAX).default(h_max);
    if row.unit(state.unit().symbol()).help(help).show(ui).changed() {
        set_kind_once(layer, LayerKind::constant(value), commands);
    }
}
