//! The settings of the path tool, on the strip above the canvas: from short to safe, and other paths.

use std::ops::RangeInclusive;

use eframe::egui::Ui;

use super::panel::MOST_WEIGHT;
use super::{AlternativesCommand, PathCommand};
use crate::app::features::paths::Paths;
use meshbrush_core::document::PathCost;
use meshbrush_core::path::Weights;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, StripItem, end_gesture_when_released};
use meshbrush_ui::widgets::{ActionButton, SliderRow, toggle_row};

/// The caution of the paths, and which other paths are shown.
pub static PATH_OPTIONS: [StripItem; 4] = [
    StripItem::new(160.0, 0, caution_row)
        .only(|state| matches!(state.session.document().settings().paths.cost, PathCost::Weighted(_))),
    StripItem::new(88.0, 1, corridor_row),
    StripItem::new(112.0, 2, alternatives_row),
    StripItem::new(152.0, 3, swap_button),
];

/// The track of the slider from the shortest path to the safest.
const CAUTION: RangeInclusive<f64> = 0.1..=1000.0;

fn caution_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let PathCost::Weighted(weights) = state.session.document().settings().paths.cost else { return };
    let mut caution = (weights.risk / weights.length).min(MOST_WEIGHT);
    let row = SliderRow::new("Caution", &mut caution, CAUTION).logarithmic();
    let row = row.typed_range(0.0..=MOST_WEIGHT).default(Weights::default().risk);
    let help = "From the shortest path at the left to the safest at the right: the weight of risk, where length has \
                the weight 1.";
    let response = row.help(help).show(ui);
    if response.changed() {
        let cost = PathCost::Weighted(Weights { length: 1.0, risk: caution });
        commands.push(Command::from(PathCommand::Cost(cost)));
    }
    end_gesture_when_released(&response, commands);
}

fn corridor_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut is_on = state.feature::<Paths>().finder.corridor.is_on;
    if toggle_row(ui, "Corridor", &mut is_on).changed() {
        commands.push(Command::from(PathCommand::ShowCorridor(is_on)));
    }
}

fn alternatives_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut is_on = state.feature::<Paths>().finder.alternatives.is_on;
    if toggle_row(ui, "Alternatives", &mut is_on).changed() {
        commands.push(Command::from(PathCommand::Alternatives(AlternativesCommand::Show(is_on))));
    }
}

fn swap_button(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let has_paths = !state.session.document().settings().paths.routes.is_empty();
    let button = ActionButton::new("Swap start and goal");
    if ui.add_enabled_ui(has_paths, |ui| ui.add(button)).inner.clicked() {
        commands.push(Command::from(PathCommand::Swap));
    }
}
