//! The settings of the region tool, on the strip above the canvas.

use eframe::egui::Ui;

use super::{RegionCommand, RegionShape, RegionTarget};
use crate::app::features::regions::RegionTool;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, StripItem, name_field, radius_row};
use meshbrush_ui::widgets::{dropdown_row, segmented};

/// What is drawn on, with what, whether it adds, and the size of the brush.
pub static REGION_OPTIONS: [StripItem; 6] = [
    StripItem::new(232.0, 0, target_row),
    StripItem::new(208.0, 1, shape_row),
    StripItem::new(112.0, 2, cuts_row),
    StripItem::new(136.0, 3, radius_row)
        .only(|state| state.tools.settings::<RegionTool>().shape() == RegionShape::Brush),
    StripItem::new(224.0, 4, keep_out_row)
        .stretching()
        .only(|state| state.tools.settings::<RegionTool>().target == RegionTarget::KeepOut),
    StripItem::new(208.0, 5, name_row).only(|state| keep_out(state).is_some()),
];

/// Returns the number and the name of the keep-out region that is drawn on.
fn keep_out<'a>(state: &FrameState<'a>) -> Option<(usize, &'a str)> {
    let tool = state.tools.settings::<RegionTool>();
    let number = tool.keep_out.filter(|_| tool.target == RegionTarget::KeepOut)?;
    let region = state.session.document().settings().paths.keep_out.get(number)?;
    Some((number, &region.name))
}

fn name_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((number, name)) = keep_out(state) else { return };
    if let Some(name) = name_field(ui, "keep-out region", name) {
        commands.push(Command::from(RegionCommand::Rename(number, name)));
    }
}

fn target_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut target = state.tools.settings::<RegionTool>().target;
    let choices =
        [(RegionTarget::Mask, "Mask"), (RegionTarget::KeepOut, "Keep out"), (RegionTarget::Shapes, "Shapes")];
    if segmented(ui, "What is drawn", &mut target, &choices).changed() {
        commands.push(Command::from(RegionCommand::Target(target)));
    }
}

fn shape_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let tool = state.tools.settings::<RegionTool>();
    let mut shape = tool.shape();
    let choices = [
        (RegionShape::Brush, "Brush"),
        (RegionShape::Lasso, "Lasso"),
        (RegionShape::Polygon, "Polygon"),
        (RegionShape::Rectangle, "Rectangle"),
        (RegionShape::Circle, "Circle"),
        (RegionShape::Fill, "Fill"),
        (RegionShape::Line, "Line"),
        (RegionShape::Point, "Point"),
    ];
    let count = choices.len() - if tool.has_lines_and_points() { 0 } else { 2 };
    if dropdown_row(ui, "Draw with", &mut shape, &choices[..count]).changed() {
        commands.push(Command::from(RegionCommand::Shape(shape)));
    }
}

fn cuts_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut cuts = state.tools.settings::<RegionTool>().cuts;
    if segmented(ui, "Add or cut", &mut cuts, &[(false, "Add"), (true, "Cut")]).changed() {
        commands.push(Command::from(RegionCommand::Cuts(cuts)));
    }
}

fn keep_out_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let regions = &state.session.document().settings().paths.keep_out;
    let known = regions.iter().enumerate().map(|(number, region)| (Some(number), &*region.name));
    let choices: Vec<(Option<usize>, &str)> = std::iter::once((None, "new region")).chain(known).collect();
    let mut chosen = keep_out(state).map(|(number, _)| number);
    if dropdown_row(ui, "Draw on", &mut chosen, &choices).changed() {
        commands.push(Command::from(RegionCommand::KeepOut(chosen)));
    }
}
