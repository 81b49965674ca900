//! The strip of the query tool: what can be done with the queried point, and the ways through the bisection
//! tree.

use eframe::egui::Ui;

use super::TreeStep;
use crate::app::features::inspection::{ExploreCommand, InspectCommand, Inspector};
use crate::app::features::pins::PinsCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, StripItem};
use meshbrush_ui::widgets::ActionButton;

/// Pins and copies the queried point, and steps in the bisection tree.
pub static QUERY_OPTIONS: [StripItem; 8] = [
    StripItem::new(48.0, 0, pin_button),
    StripItem::new(104.0, 1, copy_button),
    StripItem::new(72.0, 2, |ui, state, commands| step(ui, state, "Parent", TreeStep::Parent, commands)),
    StripItem::new(72.0, 3, |ui, state, commands| step(ui, state, "Sibling", TreeStep::Sibling, commands)),
    StripItem::new(80.0, 4, |ui, state, commands| {
        step(ui, state, "First half", TreeStep::Child(0), commands)
    }),
    StripItem::new(104.0, 4, |ui, state, commands| {
        step(ui, state, "Second half", TreeStep::Child(1), commands);
    }),
    StripItem::new(120.0, 5, |ui, state, commands| {
        step(ui, state, "Coarse triangle", TreeStep::Coarse, commands);
    }),
    StripItem::new(128.0, 5, |ui, state, commands| {
        step(ui, state, "Queried triangle", TreeStep::Queried, commands);
    }),
];

/// A button that goes to another triangle of the bisection tree.
fn step(ui: &mut Ui, state: &FrameState<'_>, name: &str, to: TreeStep, commands: &mut Vec<Command>) {
    let leads = state.feature::<Inspector>().explore.target(to, state.session.mesh()).is_some();
    if ui.add_enabled_ui(leads, |ui| ui.add(ActionButton::new(name))).inner.clicked() {
        commands.push(Command::from(InspectCommand::Explore(ExploreCommand::Step(to))));
    }
}

fn pin_button(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let button = ActionButton::new("Pin");
    if ui.add_enabled_ui(state.readout.is_some(), |ui| ui.add(button)).inner.clicked() {
        commands.push(Command::from(PinsCommand::Pin));
    }
}

fn copy_button(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let has_triangle = state.readout.is_some_and(|readout| readout.triangle.is_some());
    let button = ActionButton::new("Copy values");
    if ui.add_enabled_ui(has_triangle, |ui| ui.add(button)).inner.clicked() {
        commands.push(Command::from(InspectCommand::CopyReadout));
    }
}
