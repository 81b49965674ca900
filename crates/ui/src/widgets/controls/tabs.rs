//! Tabs above a dock.

use egui::{self, Id, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use super::paint;
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

/// Height of the bar, in points.
const TAB_BAR: f32 = 32.0;
/// Height of the line under the selected tab, in points.
const LINE: f32 = 2.0;
/// Least space at both sides of a name, in points.
const PADDING: f32 = 3.0;

/// Shows a bar of tabs over the full width, and returns the tab that was clicked. `selected` is the place of
/// the tab that is shown. The arrow keys go from tab to tab.
pub fn tab_bar(ui: &mut Ui, names: &[&str], selected: usize) -> Option<usize> {
    let (_, bar) = ui.allocate_space(vec2(ui.available_width(), TAB_BAR));
    let t = tokens(ui);
    ui.painter().hline(bar.x_range(), bar.bottom() - 0.5, t.hairline());
    let widths: Vec<f32> = names.iter().map(|name| text_width(ui, name) + 2.0 * PADDING).collect();
    let room = bar.width() - metrics::GRID;
    let spare = ((room - widths.iter().sum::<f32>()) / names.len() as f32).clamp(0.0, 24.0);
    let mut left = bar.left() + metrics::GRID / 2.0;
    let (mut chosen, mut by_key) = (None, None);
    for (place, (name, width)) in names.iter().zip(widths).enumerate() {
        let right = left + width + spare;
        let rect = Rect::from_x_y_ranges(left..=right, bar.y_range());
        let response = tab(ui, rect, name, place == selected);
        if response.clicked() {
            chosen = Some(place);
        }
        by_key = by_key.or(neighbour_by_key(ui, &response, place, names.len()));
        left = right;
    }
    // Only now: the tab that gets the focus must not act on the same key.
    if let Some(next) = by_key {
        ui.memory_mut(|memory| memory.request_focus(tab_id(ui, names[next])));
    }
    by_key.or(chosen)
}

fn text_width(ui: &Ui, name: &str) -> f32 {
    paint::line(ui, name, font::body(), tokens(ui).value).size().x.ceil()
}

fn tab_id(ui: &Ui, name: &str) -> Id {
    ui.scope_id().with(("tab", name))
}

fn tab(ui: &Ui, rect: Rect, name: &str, is_selected: bool) -> Response {
    let t = tokens(ui);
    let response = ui.interact(rect, tab_id(ui, name), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Tab, ui.is_enabled(), is_selected, name));
    let ink = match (is_selected, response.hovered()) {
        (true, _) => t.value,
        (false, true) => t.text,
        (false, false) => t.label,
    };
    if is_selected {
        let top = rect.bottom() - LINE;
        let line = Rect::from_min_max(pos2(rect.left() + 2.0, top), pos2(rect.right() - 2.0, rect.bottom()));
        ui.painter().rect_filled(line, 1.0, t.accent);
    }
    paint::focus_ring(ui, &response, rect.shrink(4.0), metrics::RADIUS_CONTROL - 2);
    paint::at_centre(ui, rect, paint::elided(ui, name, font::body(), ink, rect.width()));
    tips::explain(ui, response, tips::sentence(&format!("Tab/{name}")))
}

/// Returns the tab that an arrow key asks for while tab `place` of `count` has the focus.
fn neighbour_by_key(ui: &Ui, response: &Response, place: usize, count: usize) -> Option<usize> {
    if !response.has_focus() {
        return None;
    }
    let filter = egui::EventFilter { horizontal_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    match (pressed(egui::Key::ArrowLeft), pressed(egui::Key::ArrowRight)) {
        (true, false) => place.checked_sub(1),
        (false, true) => Some(place + 1).filter(|next| *next < count),
        _ => None,
    }
}
