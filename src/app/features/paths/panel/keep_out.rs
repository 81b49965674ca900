//! The regions that paths stay out of, and their clearance, in the panel of the paths.

use eframe::egui::Ui;

use crate::app::features::paths::{KeepOutCommand, OPEN_KEEP_OUT, PathCommand};
use crate::app::features::regions::{RegionCommand, RegionTarget};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{FrameState, area_text, button_rows, end_gesture_when_released};
use meshbrush_ui::theme::metrics;
use meshbrush_ui::widgets::{Icon, NumberRow, ToolButton, ValueRow};

/// How far paths stay from the outline and from the regions.
pub fn clearance_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let mut clearance = settings.paths.clearance;
    let most = settings.domain.bounds.size().max_element();
    let row = NumberRow::new("Clearance", &mut clearance).range(0.0..=most).default(0.0);
    let help = "Paths stay so far from the outline, where polygons give the domain, and from keep-out regions. Sides of \
                the rectangle around the domain do not count.";
    let response = row.unit(state.unit().symbol()).help(help).show(ui);
    if response.changed() {
        commands.push(Command::from(PathCommand::Clearance(clearance)));
    }
    end_gesture_when_released(&response, commands);
}

/// The regions with their areas, and what adds and removes them.
pub fn rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let command = |command| Command::from(PathCommand::KeepOut(command));
    for (number, region) in state.session.document().settings().paths.keep_out.iter().enumerate() {
        let area = area_text(ui, state, &region.mask, 4);
        ui.push_id(number, |ui| {
            ui.horizontal(|ui| {
                let width = ui.available_width() - metrics::ROW - ui.spacing().item_spacing.x;
                ui.vertical(|ui| {
                    ui.set_width(width);
                    let name = format!("Keep out: {}", region.name);
                    ValueRow::new(&name, &area).help("Paths stay out of this region; its area.").show(ui);
                });
                if ToolButton::small(Icon::DELETE, "Remove keep-out region").show(ui).clicked() {
                    commands.push(command(KeepOutCommand::Remove(number)));
                }
            });
        });
    }
    let can_take_mask = KeepOutCommand::mask_to_add(state.session).is_some();
    let rows = [
        [("Draw keep-out region", true, Command::from(RegionCommand::Target(RegionTarget::KeepOut)))],
        [("Add keep-out region…", true, Command::from(FileCommand::Ask(&OPEN_KEEP_OUT)))],
        [("Use the layer's mask", can_take_mask, command(KeepOutCommand::AddMask))],
    ];
    button_rows(ui, rows, commands);
}
