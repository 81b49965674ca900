//! The settings of the boundary tool, on the strip above the canvas: what a click does, and the name of the
//! selected piece.

use eframe::egui::Ui;

use super::{BoundaryCommand, BoundaryToolMode};
use crate::app::features::boundary::BoundaryTool;
use meshbrush_core::document::Setting;
use meshbrush_core::domain::BoundaryPieces;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, StripItem, name_field, set_once};
use meshbrush_ui::widgets::{ActionButton, segmented};

/// What a click does, and what can be done with the selected piece.
pub static BOUNDARY_OPTIONS: [StripItem; 3] = [
    StripItem::new(136.0, 1, mode_row),
    StripItem::new(256.0, 0, name_row).only(|state| selected(state).is_some()),
    StripItem::new(112.0, 2, join_button).only(|state| selected(state).is_some()),
];

/// Returns the pieces and the number of the selected one.
fn selected<'a>(state: &FrameState<'a>) -> Option<(&'a BoundaryPieces, usize)> {
    let pieces = state.session.boundary_pieces()?;
    Some((pieces, state.tools.settings::<BoundaryTool>().selected_of(pieces)?))
}

fn mode_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut mode = state.tools.settings::<BoundaryTool>().mode;
    let choices = [(BoundaryToolMode::Select, "Select"), (BoundaryToolMode::Split, "Split")];
    if segmented(ui, "What a click does", &mut mode, &choices).changed() {
        commands.push(Command::from(BoundaryCommand::Mode(mode)));
    }
}

fn name_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((pieces, number)) = selected(state) else { return };
    let marks = &state.session.document().settings().boundary_marks;
    if let Some(name) = name_field(ui, "piece", &pieces.list()[number].name) {
        set_once(Setting::BoundaryMarks(pieces.renamed(marks, number, &name)), commands);
    }
}

fn join_button(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some((pieces, number)) = selected(state) else { return };
    let joined = pieces.joined(&state.session.document().settings().boundary_marks, number);
    let button = ActionButton::new("Join with next");
    if ui.add_enabled_ui(joined.is_some(), |ui| ui.add(button)).inner.clicked()
        && let Some(joined) = joined
    {
        set_once(Setting::BoundaryMarks(joined), commands);
    }
}
