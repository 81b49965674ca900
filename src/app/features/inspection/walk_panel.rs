//! The walk of point location, in numbers.

use eframe::egui::Ui;

use crate::app::features::inspection::{InspectCommand, Inspector};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::view::CanvasAid;
use meshbrush_kit::kit::{FrameState, Panel, Tab, remark};
use meshbrush_ui::widgets::{Section, format, toggle_row, value_row};

/// The walk to the queried point, and how long walks are in this mesh.
pub static WALK: Panel = Panel { name: "walk", tab: Tab::Method, place: 1, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Point location").show(ui, |ui| {
        if state.readout.is_none() {
            return remark(
                ui,
                "Click the mesh with the query tool[ ({query})]: the walk to the point appears here.",
            );
        }
        walk_rows(ui, state, commands);
    });
}

/// How many steps point location took, beside their mean and their bound.
fn walk_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(readout) = state.readout else { return };
    if state.feature::<Inspector>().walks.is_due(state.session) {
        // It is measured only while it is shown.
        commands.push(Command::from(InspectCommand::MeasureWalks));
    }
    let mesh = state.session.mesh();
    let steps = mesh.walk_path(readout.point).len().saturating_sub(1);
    let steps = if steps == 1 { "1 step".into() } else { format!("{} steps", format::count(steps as u64)) };
    let mean =
        state.feature::<Inspector>().walks.mean_steps().map_or("…".into(), |mean| format::fixed(mean, 1));
    let bound = format::count(mesh.walk_bound() as u64);
    value_row(ui, "Walk", &format!("{steps} (mean {mean}, bound {bound})"));
    let mut shown = state.view.aids.walk;
    if toggle_row(ui, "Show the walk", &mut shown).changed() {
        commands.push(Command::from(ViewCommand::ToggleAid(CanvasAid::Walk)));
    }
}
