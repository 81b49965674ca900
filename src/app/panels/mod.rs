//! The panels around the canvas. A panel is a function of the state that it shows; it changes nothing, but
//! sends commands.
//!
//! What is being typed or set up in a control, and is no setting yet, is in egui's memory.

mod bars;
mod brush;
mod domain;
mod fit;
mod formula;
mod inspector;
mod layers;
mod levels;
mod mesh;
mod path;
mod report;
mod statistics;
mod status;
mod steps;
mod transfer;
mod view;
mod why;

use eframe::egui::{self, Frame, Id, Margin, Response, RichText, ScrollArea, Ui};

pub use bars::menu_item;
pub use brush::BRUSH;
pub use domain::DOMAIN;
pub use inspector::INSPECTOR;
pub use layers::{LAYER_KINDS, ask_name as ask_layer_name, combine_name};
pub use path::{OTHER_PATHS, PATH};
pub use why::WHY;

use super::command::{Command, EditCommand};
use super::features::boundary::PIECES;
use super::features::picture::BACKGROUND;
use super::features::pins::PINS;
use super::features::plots::PLOTS;
use super::frame::FrameState;
use super::theme::{font, metrics, tokens};
use super::tools::Tool;
use super::widgets::{self, ActionButton};
use meshbrush_core::document::Setting;

/// A section of the side panel.
pub struct Panel {
    /// Identifies it.
    pub name: &'static str,
    /// Whether it is shown only while a tool that lists it is selected.
    pub only_with_tool: bool,
    /// Draws it.
    pub show: fn(&mut Ui, &FrameState<'_>, &mut Vec<Command>),
}

/// All sections of the side panel, from the top. Those of the selected tool move to the top.
pub static PANELS: [&Panel; 17] = [
    &BRUSH,
    &layers::LAYERS,
    &transfer::TRANSFER,
    &levels::LEVELS,
    &INSPECTOR,
    &WHY,
    &PINS,
    &PATH,
    &OTHER_PATHS,
    &mesh::MESH,
    &statistics::STATISTICS,
    &PLOTS,
    &DOMAIN,
    &PIECES,
    &fit::FIT,
    &BACKGROUND,
    &view::VIEW,
];

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
    if let Some(stepping) = state.stepping {
        egui::Panel::bottom("steps")
            .frame(bar)
            .exact_size(steps::BAR_HEIGHT)
            .show(ui, |ui| steps::step_bar(ui, stepping, commands));
    }
    if !state.view.panels {
        return;
    }
    egui::Panel::left("tools")
        .frame(Frame::new().fill(t.panel).inner_margin(Margin::symmetric(6, 10)))
        .resizable(false)
        .exact_size(metrics::TOOL + 12.0)
        .show(ui, |ui| bars::tool_strip(ui, state, commands));
    if let Some(stepping) = state.stepping {
        egui::Panel::right("step")
            .frame(Frame::new().fill(t.panel))
            .resizable(false)
            .exact_size(steps::WIDTH)
            .show(ui, |ui| steps::show(ui, stepping, state, commands));
        return;
    }
    // The scroll bar is in the margin.
    egui::Panel::right("side")
        .frame(Frame::new().fill(t.panel))
        .resizable(false)
        .exact_size(metrics::PANEL_WIDTH)
        .show(ui, |ui| side_panel(ui, state, commands));
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

/// Whether another tool is selected than in the last frame.
fn tool_changed(ui: &Ui, tool: Tool) -> bool {
    let id = Id::unique("tool of the side panel");
    let before = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or(id, tool.name), tool.name));
    before != tool.name
}

/// The sections to show, those of the tool first.
fn sections(tool: Tool) -> impl Iterator<Item = &'static Panel> {
    let of_tool = |panel: &&Panel| tool.panels.iter().any(|own| own.name == panel.name);
    let others = PANELS.into_iter().filter(move |panel| !panel.only_with_tool && !of_tool(panel));
    tool.panels.iter().copied().chain(others)
}

/// Rows of buttons: name, whether it is enabled, and the command that it sends.
pub fn button_rows<Row, C>(ui: &mut Ui, rows: impl IntoIterator<Item = Row>, commands: &mut Vec<C>)
where
    Row: IntoIterator<Item = (&'static str, bool, C)>,
{
    for row in rows {
        ui.horizontal(|ui| {
            for (name, enabled, command) in row {
                let button = ActionButton::new(name);
                if ui.add_enabled_ui(enabled, |ui| ui.add(button)).inner.clicked() {
                    commands.push(command);
                }
            }
        });
    }
}

/// Sends the end of a gesture when a control was released.
pub fn end_gesture_when_released(response: &Response, commands: &mut Vec<Command>) {
    if widgets::edit_done(response) {
        commands.push(Command::Edit(EditCommand::EndGesture));
    }
}

/// Sends a setting as a gesture of its own.
pub fn set_once(setting: Setting, commands: &mut Vec<Command>) {
    commands.extend([Command::Edit(EditCommand::Set(setting)), Command::Edit(EditCommand::EndGesture)]);
}

/// A remark in small print.
pub fn remark(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).font(font::caption()).color(tokens(ui).faint));
    ui.add_space(4.0);
}
