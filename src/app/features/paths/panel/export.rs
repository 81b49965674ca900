//! How the path is exported, in the panel of the paths.

use eframe::egui::Ui;

use crate::app::features::paths::{EXPORT_PATH, PathCommand, Paths};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{FrameState, button_rows};
use meshbrush_ui::widgets::NumberRow;

/// The tolerance of the points, and the button.
pub fn rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let most = state.session.document().settings().domain.bounds.size().max_element();
    let mut tolerance = state.feature::<Paths>().tool.export_tolerance;
    let row = NumberRow::new("Export tolerance", &mut tolerance).range(0.0..=most).default(0.0);
    let help =
        "Points that are no farther than this from the path are left out of files; 0: all are written.";
    if row.unit(state.unit().symbol()).help(help).show(ui).changed() {
        commands.push(Command::from(PathCommand::ExportTolerance(tolerance)));
    }
    button_rows(ui, [[("Export path…", true, Command::from(FileCommand::Ask(&EXPORT_PATH)))]], commands);
}
