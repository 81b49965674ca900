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

use eframe::egui::{self, Frame, Margin, Rect, ScrollArea, Ui};

use super::features::{ROWS, report, stepping};
use super::parts::{WindowPart, mark};
use crate::app::features::stepping::Stepping;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CatalogItem, FrameState, Panel, Tab};
use meshbrush_ui::theme::{metrics, tokens};

/// The sections of the docks that belong to no feature.
static PANELS: [&Panel; 2] = [&budgets::BUDGETS, &mesh::MESH];

/// Draws all panels but the status bar, whose place it returns: egui divides a window from the rim inwards,
/// and a screen reader reads what is drawn first. The menus have the `entries`.
pub fn show(
    ui: &mut Ui,
    state: &FrameState<'_>,
    entries: &[CatalogItem],
    commands: &mut Vec<Command>,
) -> Option<Rect> {
    let status = show_bars(ui, state, entries, commands);
    show_around_canvas(ui, state, commands);
    status
}

/// Draws tools, strip and docks, in the order in which they are read.
fn show_around_canvas(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
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
        if !presents {
            strip::show(ui, state, commands);
        }
        return;
    }
    let docks = docks::reserve(ui);
    if !presents {
        strip::show(ui, state, commands);
    }
    docks::show(ui, &docks, state, commands);
}

/// Draws the status bar in its place, after the canvas.
pub fn show_status(ui: &mut Ui, place: Rect, state: &FrameState<'_>) {
    let mut bar = docks::in_place(ui, place, "in the status bar");
    mark(&bar, WindowPart::Status);
    let margin = bar_margin(2);
    Frame::new().inner_margin(margin).show(&mut bar, |ui| status::status_bar(ui, state));
}

fn bar_margin(above: i8) -> Margin {
    Margin::symmetric(metrics::PANEL_MARGIN as i8, above)
}

/// Draws the bars at the top and at the bottom of the window, but leaves the status bar empty. Returns its
/// place.
fn show_bars(
    ui: &mut Ui,
    state: &FrameState<'_>,
    entries: &[CatalogItem],
    commands: &mut Vec<Command>,
) -> Option<Rect> {
    let t = *tokens(ui);
    let bar = Frame::new().fill(t.window).inner_margin(bar_margin(2));
    let mut place = None;
    // egui puts the row of a menu bar at its top: the margin centres it.
    let above = ((metrics::MENU_BAR - metrics::ROW) / 2.0) as i8;
    let menu = bar.inner_margin(bar_margin(above));
    if state.view.surrounds {
        egui::Panel::top("menu").frame(menu).exact_size(metrics::MENU_BAR).show(ui, |ui| {
            mark(ui, WindowPart::Menus);
            bars::menu_bar(ui, state, entries, commands);
        });
        let status = egui::Panel::bottom("status").frame(bar).exact_size(metrics::STATUS_BAR);
        place = Some(status.show(ui, |_| {}).response.rect);
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
    place
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
