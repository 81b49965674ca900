//! The settings of the domain tool, on the strip above the canvas.

use eframe::egui::Ui;

use super::{DomainCommand, DomainToolMode};
use crate::app::features::domain::DomainTool;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, StripItem, radius_row};
use meshbrush_ui::widgets::{dropdown_row, segmented};

/// What cuts the domain, whether it adds, and the size of the brush.
pub static DOMAIN_OPTIONS: [StripItem; 3] = [
    StripItem::new(208.0, 0, mode_row),
    StripItem::new(136.0, 1, adds_row)
        .only(|state| state.tools.settings::<DomainTool>().mode != DomainToolMode::Frame),
    StripItem::new(136.0, 2, radius_row)
        .stretching()
        .only(|state| state.tools.settings::<DomainTool>().mode == DomainToolMode::Brush),
];

fn mode_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut mode = state.tools.settings::<DomainTool>().mode;
    let choices = [
        (DomainToolMode::Brush, "Brush"),
        (DomainToolMode::Lasso, "Lasso"),
        (DomainToolMode::Polygon, "Polygon"),
        (DomainToolMode::Rectangle, "Rectangle"),
        (DomainToolMode::Circle, "Circle"),
        (DomainToolMode::Fill, "Fill"),
        (DomainToolMode::Frame, "Frame"),
    ];
    if dropdown_row(ui, "Cut with", &mut mode, &choices).changed() {
        commands.push(Command::from(DomainCommand::Mode(mode)));
    }
}

fn adds_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut adds = state.tools.settings::<DomainTool>().adds;
    if segmented(ui, "Add or remove", &mut adds, &[(false, "Remove"), (true, "Add")]).changed() {
        commands.push(Command::from(DomainCommand::Adds(adds)));
    }
}
