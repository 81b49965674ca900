//! The docks at the right: the layers above, and below them the tabs.

use eframe::egui::{self, Frame, Margin, ScrollArea, Ui, UiBuilder, vec2};

use super::sections;
use crate::app::features::report::Report;
use crate::app::parts::{WindowPart, mark};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::{FrameState, Tab};
use meshbrush_ui::theme::{metrics, tokens};
use meshbrush_ui::widgets::tab_bar;

/// Widths of the docks, in points.
const WIDTHS: std::ops::RangeInclusive<f32> = 280.0..=520.0;
/// Least width that is left for the canvas, in points.
const LEAST_CANVAS: f32 = 400.0;
/// Least heights of the upper and the lower dock, in points.
const LEAST_UPPER: f32 = 120.0;
const LEAST_LOWER: f32 = 200.0;
/// Share of the height that the upper dock has at first.
const UPPER_SHARE: f32 = 0.46;

/// Shows both docks. Their sizes can be changed, and egui's memory keeps them over restarts.
pub fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let t = *tokens(ui);
    let widest = (ui.available_width() - LEAST_CANVAS).clamp(*WIDTHS.start(), *WIDTHS.end());
    egui::Panel::right("docks")
        .frame(Frame::new().fill(t.panel))
        .default_size(metrics::PANEL_WIDTH)
        .size_range(*WIDTHS.start()..=widest)
        .show(ui, |ui| {
            let height = ui.available_height();
            let tallest = (height - LEAST_LOWER).max(LEAST_UPPER);
            let default = UPPER_SHARE * height;
            egui::Panel::top("layers")
                .frame(Frame::new().fill(t.panel).inner_margin(margin()))
                .resizable(true)
                .default_size((default / metrics::GRID).round() * metrics::GRID)
                .size_range(LEAST_UPPER..=tallest)
                .show(ui, |ui| upper_dock(ui, state, commands));
            lower_dock(ui, state, commands);
        });
}

fn margin() -> Margin {
    Margin::symmetric(metrics::PANEL_MARGIN as i8, 0)
}

/// Shows the layers and the selected layer. What has no room is cut off: the dock is as high as it was
/// dragged.
fn upper_dock(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    mark(ui, WindowPart::Layers);
    let place = ui.available_rect_before_wrap();
    let mut inner = ui.new_child(UiBuilder::new().max_rect(place));
    inner.shrink_clip_rect(place.expand2(vec2(metrics::PANEL_MARGIN, 0.0)));
    for panel in sections(Tab::Layers) {
        (panel.show)(&mut inner, state, commands);
    }
    ui.advance_cursor_after_rect(place);
}

/// Returns the tabs that have something to show. That of the method is out of the way until it is asked for.
fn tabs(state: &FrameState<'_>) -> Vec<Tab> {
    let has_method = state.feature::<Report>().is_shown() || state.view.dock.tab() == Tab::Method;
    Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method || has_method).collect()
}

fn lower_dock(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    mark(ui, WindowPart::Panel);
    ui.spacing_mut().item_spacing.y = 0.0;
    let tabs = tabs(state);
    let names: Vec<&str> = tabs.iter().map(|tab| tab.name()).collect();
    let shown = state.view.dock.tab();
    let selected = tabs.iter().position(|tab| *tab == shown).unwrap_or(0);
    if let Some(place) = tab_bar(ui, &names, selected) {
        commands.push(Command::from(ViewCommand::ShowTab(tabs[place])));
    }
    // The scroll bar is in the margin. Each tab keeps its place.
    ScrollArea::vertical().id_salt(("tab", shown.name())).auto_shrink(false).show(ui, |ui| {
        Frame::new().inner_margin(margin()).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = metrics::ROW_GAP;
            for panel in sections(shown) {
                (panel.show)(ui, state, commands);
            }
            ui.add_space(metrics::PANEL_MARGIN);
        });
    });
}
