//! The cost of paths in numbers: weights of length and risk, or a formula.

use eframe::egui::Ui;

use crate::app::features::paths::{CostKind, PathCommand};
use meshbrush_core::document::PathCost;
use meshbrush_core::path::Weights;
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_kit::kit::{FormulaRow, FrameState, end_gesture_when_released};
use meshbrush_ui::widgets::{NumberRow, segmented};

/// The largest weight.
pub const MOST_WEIGHT: f64 = 1e6;

/// Shows the rows of the cost.
pub(super) fn rows(ui: &mut Ui, state: &FrameState<'_>, cost: &PathCost, commands: &mut Vec<Command>) {
    ui.add_space(2.0);
    let mut kind = CostKind::of(cost);
    let kinds = [(CostKind::Weights, "Weights"), (CostKind::Formula, "Formula")];
    if segmented(ui, "What paths cost", &mut kind, &kinds).changed() {
        commands.push(Command::from(PathCommand::CostBy(kind)));
    }
    ui.add_space(4.0);
    match cost {
        PathCost::Weighted(weights) => weight_rows(ui, *weights, commands),
        PathCost::Formula(formula) => {
            let help =
                "What a unit of length costs, as a formula of x, y and risk; it must be positive everywhere.";
            let row = FormulaRow { label: "Cost per length", hint: "1 + 10*risk", help };
            if let Some(Some(formula)) = row.show(ui, state, Some(formula)) {
                let cost = PathCommand::Cost(PathCost::Formula(formula));
                commands.extend([Command::from(cost), Command::from(EditCommand::EndGesture)]);
            }
        }
    }
    ui.add_space(4.0);
}

fn weight_rows(ui: &mut Ui, weights: Weights, commands: &mut Vec<Command>) {
    let mut new = weights;
    let row = NumberRow::new("Weight of length", &mut new.length).range(0.0..=MOST_WEIGHT);
    let by_length = row.help("λ: what a unit of length costs without risk.").show(ui);
    let row = NumberRow::new("Weight of risk", &mut new.risk).range(0.0..=MOST_WEIGHT);
    let by_risk = row.help("κ: what a unit of length costs more at risk 1.").show(ui);
    if new != weights {
        commands.push(Command::from(PathCommand::Cost(PathCost::Weighted(new))));
    }
    [by_length, by_risk].iter().for_each(|response| end_gesture_when_released(response, commands));
}
