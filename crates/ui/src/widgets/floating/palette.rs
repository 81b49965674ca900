//! The command palette: finds a command by a few letters.

use egui::text::{LayoutJob, TextFormat};
use egui::{
    self, Align2, Context, Frame, Id, Key, Margin, Modifiers, Rect, Response, Role, Sense, Ui, WidgetInfo,
    vec2,
};

use super::search::find;
use super::{SearchField, paint};
use crate::theme::{font, metrics, tokens, tokens_of};

const WIDTH: f32 = 520.0;
const ROW: f32 = 32.0;
/// Rows shown at once; more scroll.
const ROWS: usize = 10;

/// A command as the palette shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaletteItem<'a> {
    /// The action of the command, in words.
    pub title: &'a str,
    /// Other words by which it is found.
    pub words: &'a str,
    /// The shortcut of the command; empty if it has none.
    pub keys: &'a str,
    /// Whether it can be chosen now.
    pub enabled: bool,
}

/// The answer of [`command_palette`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaletteAnswer {
    /// The palette is still open.
    Open,
    /// The palette was closed without a choice.
    Closed,
    /// The item with this index was chosen.
    Chosen(usize),
}

/// The text typed so far and the selected row, kept in egui's memory while the palette is open.
#[derive(Clone, Debug)]
struct Palette {
    query: String,
    selected: usize,
    /// The keyboard moved the selection: scroll it into view.
    moved: bool,
}

/// Shows a list of commands over the window that narrows as the user types.
///
/// Up and Down move, Enter or a click chooses, Escape or a click outside closes. Show it in every frame until
/// it is closed or an item is chosen.
pub fn command_palette(ctx: &Context, items: &[PaletteItem<'_>]) -> PaletteAnswer {
    let id = Id::unique("command palette");
    let kept = ctx.data(|data| data.get_temp::<Palette>(id));
    let mut palette = kept.unwrap_or(Palette { query: String::new(), selected: 0, moved: true });
    let area = egui::Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, 72.0));
    let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(8));
    let modal = egui::Modal::new(id).area(area).frame(frame).backdrop_color(tokens_of(ctx).scrim);
    let shown = modal.show(ctx, |ui| palette.contents(ui, items));
    let answer = match shown.inner {
        Some(index) => PaletteAnswer::Chosen(index),
        None if shown.should_close() => PaletteAnswer::Closed,
        None => PaletteAnswer::Open,
    };
    if answer == PaletteAnswer::Open {
        ctx.data_mut(|data| data.insert_temp(id, palette));
    } else {
        ctx.data_mut(|data| data.remove::<Palette>(id));
    }
    answer
}

impl Palette {
    fn contents(&mut self, ui: &mut Ui, items: &[PaletteItem<'_>]) -> Option<usize> {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 64.0));
        ui.spacing_mut().item_spacing.y = 0.0;
        let keys = PaletteKeys::take(ui);
        self.query_ui(ui);
        let found = ranked(&self.query, items);
        self.step(keys, found.len());
        ui.add_space(8.0);
        let clicked = self.list(ui, items, &found);
        let entered = found.get(self.selected).filter(|_| keys.enter).map(|(index, _)| *index);
        clicked.or(entered).filter(|index| items[*index].enabled)
    }

    fn query_ui(&mut self, ui: &mut Ui) {
        let field = SearchField::new("Command", "Type a command").take_focus();
        if field.show(ui, &mut self.query).changed() {
            (self.selected, self.moved) = (0, true);
        }
    }

    /// Moves the selection; it wraps at both ends.
    fn step(&mut self, keys: PaletteKeys, count: usize) {
        if count == 0 {
            self.selected = 0;
            return;
        }
        let steps = keys.down as i64 - keys.up as i64;
        self.moved |= steps != 0;
        self.selected = (self.selected as i64 + steps).rem_euclid(count as i64) as usize;
    }

    /// Shows the rows; answers the index of the item that was clicked.
    fn list(
        &mut self,
        ui: &mut Ui,
        items: &[PaletteItem<'_>],
        found: &[(usize, Vec<usize>)],
    ) -> Option<usize> {
        if found.is_empty() {
            let rect = ui.allocate_space(vec2(ui.available_width(), ROW)).1;
            let text = paint::line(ui, "No such command", font::body(), tokens(ui).label);
            paint::at_left(ui, rect.shrink2(vec2(10.0, 0.0)), text);
            return None;
        }
        let height = ROW * found.len().min(ROWS) as f32;
        let area = egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]);
        let clicked = area.show(ui, |ui| self.rows(ui, items, found)).inner;
        self.moved = false;
        clicked
    }

    fn rows(
        &mut self,
        ui: &mut Ui,
        items: &[PaletteItem<'_>],
        found: &[(usize, Vec<usize>)],
    ) -> Option<usize> {
        let pointer_moved = ui.input(|input| input.pointer.is_moving());
        let mut clicked = None;
        for (place, (index, matched)) in found.iter().enumerate() {
            let response = row(ui, &items[*index], matched, place == self.selected);
            if response.hovered() && pointer_moved {
                self.selected = place;
            }
            if place == self.selected && self.moved {
                response.scroll_to_me(None);
            }
            if response.clicked() {
                clicked = Some(*index);
            }
        }
        clicked
    }
}

/// The keys that move in the list, taken from the text field.
#[derive(Clone, Copy)]
struct PaletteKeys {
    up: usize,
    down: usize,
    enter: bool,
}

impl PaletteKeys {
    fn take(ui: &Ui) -> Self {
        ui.input_mut(|input| Self {
            up: input.count_and_consume_key(Modifiers::NONE, Key::ArrowUp),
            down: input.count_and_consume_key(Modifiers::NONE, Key::ArrowDown),
            enter: input.consume_key(Modifiers::NONE, Key::Enter),
        })
    }
}

/// Returns the items that match, with the characters that do: those whose words begin so first, in their own
/// order.
fn ranked(query: &str, items: &[PaletteItem<'_>]) -> Vec<(usize, Vec<usize>)> {
    let matches =
        items.iter().enumerate().filter_map(|(i, item)| Some((i, find(query, item.title, item.words)?)));
    let mut found: Vec<_> = matches.collect();
    found.sort_by_key(|(_, found)| found.rank);
    found.into_iter().map(|(i, found)| (i, found.places)).collect()
}

fn row(ui: &mut Ui, item: &PaletteItem<'_>, matched: &[usize], selected: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::CLICK);
    response.widget_info(|| WidgetInfo::selected(Role::MenuItem, item.enabled, selected, item.title));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let mut painter = ui.new_child(egui::UiBuilder::new().max_rect(rect));
    if !item.enabled {
        painter.multiply_opacity(0.45);
    }
    paint_row(&painter, rect, item, matched, selected);
    response
}

fn paint_row(ui: &Ui, rect: Rect, item: &PaletteItem<'_>, matched: &[usize], selected: bool) {
    if selected {
        ui.painter().rect_filled(rect, metrics::RADIUS_CONTROL, tokens(ui).field);
    }
    let inner = rect.shrink2(vec2(10.0, 0.0));
    let room = inner.width() - paint::shortcut_width(ui, item.keys) - 16.0;
    paint::at_left(ui, inner, title(ui, item.title, matched, room));
    paint::shortcut_at_right(ui, inner, item.keys);
}

/// Returns the title with the matched characters highlighted.
fn title(ui: &Ui, text: &str, places: &[usize], width: f32) -> std::sync::Arc<egui::Galley> {
    let t = tokens(ui);
    let plain = TextFormat::simple(font::body(), t.text);
    let lit = TextFormat::simple(font::strong(), t.accent);
    let mut job = LayoutJob::default();
    for (i, c) in text.chars().enumerate() {
        let format = if places.binary_search(&i).is_ok() { &lit } else { &plain };
        job.append(c.encode_utf8(&mut [0; 4]), 0.0, format.clone());
    }
    job.wrap = egui::text::TextWrapping::truncate_at_width(width);
    ui.painter().layout_job(job)
}
