//! The panels around the canvas. A panel is a function of the state that it shows; it changes nothing, but
//! sends commands.
//!
//! Values that are being typed or set up in a control, and are not settings yet, are in egui's memory.

mod bars;
mod mesh;
mod status;
mod view;

use eframe::egui::{self, Frame, Id, Margin, ScrollArea, Ui};

use super::command::Command;
use super::features::{ROWS, report, stepping};
use super::theme::{metrics, tokens};
use crate::app::kit::{FrameState, Panel, PanelGroup, Tool};

/// The sections of the side panel that belong to no feature, from the top of their groups.
static PANELS: [&Panel; 2] = [&mesh::MESH, &view::VIEW];

/// Draws all panels, from the rim inwards.
pub fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let t = *tokens(ui);
    let bar = Frame::new().fill(t.window).inner_margin(Margin::symmetric(metrics::PANEL_MARGIN as i8, 2));
    // egui puts the row of a menu bar at its top: the margin centres it.
    let above = ((metrics::MENU_BAR - metrics::ROW) / 2.0) as i8;
    let menu = bar.inner_margin(Margin::symmetric(metrics::PANEL_MARGIN as i8, above));
    egui::Panel::top("menu")
        .frame(menu)
        .exact_size(metrics::MENU_BAR)
        .show(ui, |ui| bars::menu_bar(ui, state, commands));
    egui::Panel::bottom("status")
        .frame(bar)
        .exact_size(metrics::STATUS_BAR)
        .show(ui, |ui| status::status_bar(ui, state));
    if let Some(steps) = state.features.stepping.steps() {
        egui::Panel::bottom("steps")
            .frame(bar)
            .exact_size(stepping::BAR_HEIGHT)
            .show(ui, |ui| stepping::step_bar(ui, steps, commands));
    }
    if !state.view.panels {
        return;
    }
    egui::Panel::left("tools")
        .frame(Frame::new().fill(t.panel).inner_margin(Margin::symmetric(6, 10)))
        .resizable(false)
        .exact_size(metrics::TOOL + 12.0)
        .show(ui, |ui| bars::tool_strip(ui, state, commands));
    if state.features.stepping.steps().is_some() {
        egui::Panel::right("step")
            .frame(Frame::new().fill(t.panel))
            .resizable(false)
            .exact_size(stepping::WIDTH)
            .show(ui, |ui| step_panel(ui, state, commands));
        return;
    }
    // The scroll bar is in the margin.
    egui::Panel::right("side")
        .frame(Frame::new().fill(t.panel))
        .resizable(false)
        .exact_size(metrics::PANEL_WIDTH)
        .show(ui, |ui| side_panel(ui, state, commands));
}

/// Draws the panel in place of the side panel while steps are shown.
fn step_panel(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let margin = Margin::symmetric(metrics::PANEL_MARGIN as i8, 0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        Frame::new().inner_margin(margin).show(ui, |ui| {
            stepping::title(ui, commands);
            report::section(ui, state, commands);
            stepping::contents(ui, state, commands);
            ui.add_space(metrics::PANEL_MARGIN);
        });
    });
}

fn side_panel(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let margin = Margin::symmetric(metrics::PANEL_MARGIN as i8, 0);
    let mut area = ScrollArea::vertical().auto_shrink(false);
    if tool_changed(ui, state.tools.tool) {
        // Its sections are at the top.
        area = area.vertical_scroll_offset(0.0);
    }
    area.show(ui, |ui| {
        Frame::new().inner_margin(margin).show(ui, |ui| {
            report::section(ui, state, commands);
            for panel in sections(state.tools.tool) {
                (panel.show)(ui, state, commands);
            }
            ui.add_space(metrics::PANEL_MARGIN);
        });
    });
}

/// Returns whether another tool is selected than in the last frame.
fn tool_changed(ui: &Ui, tool: Tool) -> bool {
    let id = Id::unique("tool of the side panel");
    let before = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or(id, tool.name), tool.name));
    before != tool.name
}

/// Returns all sections of the side panel, from the top.
pub fn all() -> impl Iterator<Item = &'static Panel> {
    PanelGroup::ALL.into_iter().flat_map(|group| {
        let of_features = ROWS.iter().flat_map(|row| row.panels);
        PANELS.iter().chain(of_features).copied().filter(move |panel| panel.group == group)
    })
}

/// Returns the sections to show, those of the tool first.
fn sections(tool: Tool) -> impl Iterator<Item = &'static Panel> {
    let of_tool = |panel: &&Panel| tool.panels.contains(&panel.name);
    let others = all().filter(move |panel| !panel.only_with_tool && !of_tool(panel));
    tool.panels.iter().filter_map(|name| all().find(|panel| panel.name == *name)).chain(others)
}
