//! The docks and bars around the canvas. A panel is a function of the state that it shows; it changes
//! nothing, but sends commands.
//!
//! ```text
//!  menu bar
//!  tools │ strip: options of the tool, view   │ upper dock: layers, selected layer
//!        │ canvas                             │ ───────────── divider
//!        │                                    │ lower dock: tabs
//!  status bar
//! ```
//!
//! Values that are being typed or set up in a control, and are not settings yet, are in egui's memory; so are
//! the sizes of the docks.

mod bars;
mod budgets;
mod docks;
mod mesh;
mod status;
mod strip;
mod view;

pub use bars::ask_for_menu;

use eframe::egui::{self, Frame, Margin, ScrollArea, Ui};

use super::features::{ROWS, report, stepping};
use super::parts::{WindowPart, mark};
use crate::app::features::stepping::Stepping;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CatalogItem, FrameState, Panel, Tab};
use meshbrush_ui::theme::{metrics, tokens};

/// The sections of the docks that belong to no feature.
static PANELS: [&Panel; 2] = [&budgets::BUDGETS, &mesh::MESH];

/// Draws all panels, from the rim inwards. The menus have the `entries`.
pub fn show(ui: &mut Ui, state: &FrameState<'_>, entries: &[CatalogItem], commands: &mut Vec<Command>) {
    show_bars(ui, state, entries, commands);
    if !state.view.surrounds {
        if state.view.strip {
            strip::show(ui, state, commands);
        }
        return;
    }
    if !state.view.panels {
        return;
    }
    let t = *tokens(ui);
    // In a presentation there is one panel at most.
    let presents = state.view.presentation.is_some();
    if !presents {
        egui::Panel::left("tools")
            .frame(Frame::new().fill(t.panel).inner_margin(Margin::symmetric(6, 10)))
            .resizable(false)
            .exact_size(metrics::TOOL + 12.0)
            .show(ui, |ui| {
                mark(ui, WindowPart::Tools);
                bars::tool_strip(ui, state, commands);
            });
    }
    if state.feature::<Stepping>().steps().is_some() {
        egui::Panel::right("step")
            .frame(Frame::new().fill(t.panel))
            .resizable(false)
            .exact_size(stepping::width(ui))
            .show(ui, |ui| {
                mark(ui, WindowPart::Panel);
                step_panel(ui, state, commands);
            });
    } else {
        docks::show(ui, state, commands);
    }
    if !presents {
        strip::show(ui, state, commands);
    }
}

/// Draws the bars at the top and at the bottom of the window.
fn show_bars(ui: &mut Ui, state: &FrameState<'_>, entries: &[CatalogItem], commands: &mut Vec<Command>) {
    let t = *tokens(ui);
    let bar = Frame::new().fill(t.window).inner_margin(Margin::symmetric(metrics::PANEL_MARGIN as i8, 2));
    // egui puts the row of a menu bar at its top: the margin centres it.
    let above = ((metrics::MENU_BAR - metrics::ROW) / 2.0) as i8;
    let menu = bar.inner_margin(Margin::symmetric(metrics::PANEL_MARGIN as i8, above));
    if state.view.surrounds {
        egui::Panel::top("menu").frame(menu).exact_size(metrics::MENU_BAR).show(ui, |ui| {
            mark(ui, WindowPart::Menus);
            bars::menu_bar(ui, state, entries, commands);
        });
        egui::Panel::bottom("status").frame(bar).exact_size(metrics::STATUS_BAR).show(ui, |ui| {
            mark(ui, WindowPart::Status);
            status::status_bar(ui, state);
        });
    }
    if let Some(steps) = state.feature::<Stepping>().steps() {
        egui::Panel::bottom("steps")
            .frame(bar)
            .exact_size(stepping::BAR_HEIGHT)
            .show(ui, |ui| stepping::step_bar(ui, steps, commands));
        if stepping::sentence::is_shown(state) {
            egui::Panel::top("sentence")
                .frame(bar.inner_margin(Margin::symmetric(metrics::PANEL_MARGIN as i8, 0)))
                .exact_size(stepping::sentence::height(ui, steps))
                .show(ui, |ui| stepping::sentence::show(ui, steps));
        }
    }
}

/// Draws the panel in place of the docks while steps are shown.
fn step_panel(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let margin = Margin::symmetric(metrics::PANEL_MARGIN as i8, 0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        Frame::new().inner_margin(margin).show(ui, |ui| {
            stepping::title(ui, commands);
            // Text and code stay in sight, also in a low window.
            stepping::text_and_code(ui, state, commands);
            stepping::details(ui, state, commands);
            report::section(ui, state, commands);
            ui.add_space(metrics::PANEL_MARGIN);
        });
    });
}

/// Returns the sections of a tab, from the top. They stay in this order.
fn sections(tab: Tab) -> Vec<&'static Panel> {
    let mut sections: Vec<_> = all().filter(|panel| panel.tab == tab).collect();
    sections.sort_by_key(|panel| panel.place);
    sections
}

/// Returns all sections of the docks.
pub fn all() -> impl Iterator<Item = &'static Panel> {
    let of_features = ROWS.iter().flat_map(|row| row.panels);
    PANELS.iter().chain(of_features).copied()
}

/// Returns the section with a name.
pub fn named(name: &str) -> Option<&'static Panel> {
    all().find(|panel| panel.name == name)
}
