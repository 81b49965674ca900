//! The docks at the right: the layers above, and below them the tabs.

use eframe::egui::{
    self, Align, Context, CursorIcon, Frame, Id, Layout, Margin, Rect, ScrollArea, Sense, Stroke, Ui,
    UiBuilder, vec2,
};

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
/// How far from a divider the pointer takes hold of it, in points.
const REACH: f32 = 4.0;

/// What a person chose by dragging a divider: the width of the docks in points, or the share of the upper
/// one. A window with less room shows less, and forgets nothing: the choice is there again with the room.
/// egui's memory keeps it over restarts.
struct Split {
    id: &'static str,
    default: f32,
}

impl Split {
    const WIDTH: Self = Self { id: "width of the docks", default: metrics::PANEL_WIDTH };
    const SHARE: Self = Self { id: "share of the upper dock", default: UPPER_SHARE };

    fn chosen(&self, ctx: &Context) -> f32 {
        ctx.data_mut(|data| data.get_persisted(Id::unique(self.id))).unwrap_or(self.default)
    }

    fn choose(&self, ctx: &Context, value: f32) {
        ctx.data_mut(|data| data.insert_persisted(Id::unique(self.id), value));
    }
}

/// The place of the docks in a window.
pub struct DockPlace {
    rect: Rect,
    /// The greatest width that the docks can be dragged to.
    widest: f32,
}

/// Takes the place of both docks at the right, before what is at its left. What is in them is shown later, in
/// the order in which it is read.
pub fn reserve(ui: &mut Ui) -> DockPlace {
    let widest = (ui.available_width() - LEAST_CANVAS).clamp(*WIDTHS.start(), *WIDTHS.end());
    let width = Split::WIDTH.chosen(ui.ctx()).clamp(*WIDTHS.start(), widest);
    let panel = egui::Panel::right("docks").frame(Frame::new().fill(tokens(ui).panel));
    let shown = panel.resizable(false).exact_size(width).show(ui, |_| {});
    DockPlace { rect: shown.response.rect, widest }
}

/// Shows both docks.
///
/// ```text
///  canvas ‖ upper dock: layers
///         ‖ ══════════ divider
///         ‖ lower dock: tabs
///   divider
/// ```
pub fn show(ui: &mut Ui, place: &DockPlace, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let &DockPlace { rect: dock, widest } = place;
    let mut inner = in_place(ui, dock, "in the docks");
    let height = dock.height();
    let tallest = (height - LEAST_LOWER).max(LEAST_UPPER);
    let upper = (Split::SHARE.chosen(ui.ctx()) * height).round().clamp(LEAST_UPPER, tallest);
    egui::Panel::top("layers")
        .frame(Frame::new().fill(tokens(ui).panel).inner_margin(margin()))
        .resizable(false)
        .exact_size(upper)
        .show(&mut inner, |ui| upper_dock(ui, state, commands));
    lower_dock(&mut inner, state, commands);
    let line = dock.with_min_y(dock.top() + upper).with_max_y(dock.top() + upper);
    if let Some(y) = divider(&inner, line).map(|at| at.y) {
        let height_chosen = (y - dock.top()).clamp(LEAST_UPPER, tallest);
        Split::SHARE.choose(ui.ctx(), height_chosen / height);
    }
    if let Some(x) = divider(ui, dock.with_max_x(dock.left())).map(|at| at.x) {
        Split::WIDTH.choose(ui.ctx(), (dock.right() - x).clamp(*WIDTHS.start(), widest));
    }
}

/// Returns where to show what belongs to a panel whose place was taken before.
pub(super) fn in_place(ui: &mut Ui, place: Rect, name: &str) -> Ui {
    let layout = Layout::top_down(Align::Min);
    let mut inner = ui.new_child(UiBuilder::new().id_salt(name).max_rect(place).layout(layout));
    inner.set_clip_rect(place);
    inner
}

/// Takes hold of a divider, a vertical or a horizontal line. Returns where it is dragged to.
fn divider(ui: &Ui, line: Rect) -> Option<egui::Pos2> {
    let is_vertical = line.width() == 0.0;
    let (around, icon) = match is_vertical {
        true => (line.expand2(vec2(REACH, 0.0)), CursorIcon::ResizeHorizontal),
        false => (line.expand2(vec2(0.0, REACH)), CursorIcon::ResizeVertical),
    };
    let response = ui.interact(around, ui.scope_id().with(("divider", is_vertical)), Sense::drag());
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(icon);
        let stroke = Stroke::new(1.5, tokens(ui).accent);
        ui.ctx().layer_painter(ui.layer_id()).line_segment([line.left_top(), line.right_bottom()], stroke);
    }
    response.interact_pointer_pos().filter(|_| response.dragged())
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
