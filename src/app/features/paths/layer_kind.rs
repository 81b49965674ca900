//! Layers that ask for finer triangles along paths.

use eframe::egui::Ui;

use super::PathCommand;
use meshbrush_core::layers::{DistanceLayer, DistanceTo, Layer};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{
    Addition, FrameState, LayerKindRow, button_rows, range_rows, remark, set_kind_once,
};
use meshbrush_ui::widgets::{Icon, NumberRow};

/// A strip along the paths as they were when they were taken.
pub static CORRIDOR: LayerKindRow = LayerKindRow {
    place: 5,
    is_of: |kind| kind.get().is_some_and(|distance: &DistanceLayer| distance.to.is_corridor()),
    icon: Icon::PATH,
    tool: None,
    additions: &[Addition {
        title: "corridor along the paths",
        command: |_| Command::from(PathCommand::AddCorridor),
    }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(DistanceLayer { to, at_zero, slope, range }) = layer.kind.get() else { return };
    let DistanceTo::Corridor { lines, width } = to else { return };
    let (mut at_zero, mut slope, mut range, mut width) = (*at_zero, *slope, *range, *width);
    let (positive, unit) = (f64::MIN_POSITIVE..=f64::MAX, state.unit().symbol());
    let row = NumberRow::new("Diameter at the path", &mut at_zero).range(positive.clone()).unit(unit);
    let mut changed =
        row.help("Target diameter within the corridor; it grows from its edge.").show(ui).changed();
    let row = NumberRow::new("Corridor width", &mut width).range(positive).unit(unit);
    changed |= row.help("The whole width of the corridor, half of it on each side.").show(ui).changed();
    let row = NumberRow::new("Growth", &mut slope).range(0.0..=f64::MAX);
    let help = "How much the target diameter grows with the distance, per unit of length.";
    changed |= row.help(help).show(ui).changed();
    changed |= range_rows(ui, state, &mut range);
    if changed {
        let to = DistanceTo::Corridor { lines: lines.clone(), width };
        set_kind_once(layer, DistanceLayer { to, at_zero, slope, range }, commands);
    }
    remark(ui, "The corridor stays where the paths were when it was made.");
    let take = Command::from(PathCommand::MoveCorridor(layer.id));
    button_rows(ui, [[("Take the current path again", true, take)]], commands);
}
