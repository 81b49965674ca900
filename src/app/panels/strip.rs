//! The strip above the canvas: the options of the tool, and at its end those of the view.

use eframe::egui::{
    self, Align, Frame, Layout, Margin, Popup, PopupCloseBehavior, RectAlign, RichText, Ui, vec2,
};

use super::view;
use crate::app::parts::{WindowPart, mark};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, StripItem};
use meshbrush_ui::theme::{font, metrics, tokens};
use meshbrush_ui::widgets::{Icon, ToolButton};

/// Space between options, in points.
const GAP: f32 = 8.0;
/// Room for the buttons at the end, in points.
const BUTTONS: f32 = 3.0 * metrics::ROW + 3.0 * GAP;
/// By how much an option can be wider than its least width, in points.
const MOST_STRETCH: f32 = 48.0;
/// Width of a popup, in points.
const POPUP: f32 = 288.0;

/// For a popup that stays open while its controls are used.
const KEEP_OPEN: PopupCloseBehavior = PopupCloseBehavior::CloseOnClickOutside;
/// For a popup in which one thing is chosen.
const CLOSE_AT_ONCE: PopupCloseBehavior = PopupCloseBehavior::CloseOnClick;

/// Shows the strip.
pub fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let margin = Margin::symmetric(12, 0);
    egui::Panel::top("strip")
        .frame(Frame::new().fill(tokens(ui).panel).inner_margin(margin))
        .exact_size(metrics::STRIP)
        .show(ui, |ui| {
            mark(ui, WindowPart::Strip);
            ui.horizontal_centered(|ui| {
                ui.spacing_mut().item_spacing.x = GAP;
                let options = state.tools.tool.options.iter().filter(|item| (item.is_shown)(state)).collect();
                let room = ui.available_width() - BUTTONS;
                let (fitting, others) = divided(options, room);
                let more = stretch(&fitting, room);
                if fitting.is_empty() {
                    let name = RichText::new(state.tools.tool.name).font(font::strong());
                    ui.label(name.color(tokens(ui).label));
                }
                for item in fitting {
                    let layout = Layout::left_to_right(Align::Center);
                    let width = item.width + if item.stretches { more } else { 0.0 };
                    ui.allocate_ui_with_layout(vec2(width, metrics::STRIP), layout, |ui| {
                        ui.set_min_width(width);
                        (item.show)(ui, state, commands);
                    });
                }
                // Added from the left, which is the order in which they are read aloud.
                let count = if others.is_empty() { 2.0 } else { 3.0 };
                ui.add_space(ui.available_width() - count * metrics::ROW - (count - 1.0) * GAP);
                if !others.is_empty() {
                    popup(ui, Icon::TUNE, "More options", KEEP_OPEN, |ui| {
                        others.iter().for_each(|item| (item.show)(ui, state, commands));
                    });
                }
                popup(ui, Icon::OVERLAY, "Overlays", CLOSE_AT_ONCE, |ui| {
                    view::overlay_rows(ui, state, commands);
                });
                popup(ui, Icon::VISIBLE, "View options", KEEP_OPEN, |ui| view::rows(ui, state, commands));
            });
        });
}

/// Divides the options of a tool into those that fit on the strip, from the left, and all others.
fn divided(
    options: Vec<&'static StripItem>,
    room: f32,
) -> (Vec<&'static StripItem>, Vec<&'static StripItem>) {
    let width_of = |ranks: Option<u8>| {
        let shown = options.iter().filter(|item| item.rank.is_some() && item.rank <= ranks);
        shown.map(|item| item.width + GAP).sum::<f32>()
    };
    // Options of one rank, such as the two halves of a triangle, are shown together or not at all.
    let last = options.iter().filter_map(|item| item.rank).filter(|rank| width_of(Some(*rank)) <= room).max();
    options.into_iter().partition(|item| item.rank.is_some() && item.rank <= last)
}

/// Returns by how much each option that stretches is wider than its least width.
fn stretch(fitting: &[&StripItem], room: f32) -> f32 {
    let used: f32 = fitting.iter().map(|item| item.width + GAP).sum();
    let count = fitting.iter().filter(|item| item.stretches).count().max(1);
    ((room - used) / count as f32).clamp(0.0, MOST_STRETCH).floor()
}

/// Shows a button that opens and closes a popup.
fn popup(ui: &mut Ui, icon: Icon, name: &str, close: PopupCloseBehavior, contents: impl FnOnce(&mut Ui)) {
    let id = ui.scope_id().with(("popup of the strip", name));
    let is_open = Popup::is_id_open(ui.ctx(), id);
    let button = ToolButton::small(icon, name).selected(is_open).show(ui);
    Popup::from_toggle_button_response(&button)
        .id(id)
        .align(RectAlign::BOTTOM_END)
        .gap(8.0)
        .close_behavior(close)
        .show(|ui| {
            Frame::new().inner_margin(Margin::same(8)).show(ui, |ui| {
                ui.set_width(POPUP);
                contents(ui);
            });
        });
}

#[cfg(test)]
mod tests {
    use super::*;

    static ITEMS: [StripItem; 4] = [
        StripItem::new(100.0, 1, |_, _, _| {}),
        StripItem::new(100.0, 2, |_, _, _| {}),
        StripItem::new(100.0, 0, |_, _, _| {}),
        StripItem::rare(|_, _, _| {}),
    ];

    static PAIR: [StripItem; 2] =
        [StripItem::new(100.0, 1, |_, _, _| {}), StripItem::new(100.0, 1, |_, _, _| {})];

    #[test]
    fn options_with_numbers_use_the_room_that_is_left() {
        let items =
            [StripItem::new(100.0, 0, |_, _, _| {}).stretching(), StripItem::new(100.0, 1, |_, _, _| {})];
        let stretched = |room| stretch(&items.iter().collect::<Vec<_>>(), room);
        assert_eq!([216.0, 226.0, 900.0].map(stretched), [0.0, 10.0, MOST_STRETCH]);
    }

    #[test]
    fn the_most_important_options_stay_on_a_narrow_strip_in_their_order() {
        let ranks = |items: Vec<&StripItem>| items.iter().map(|item| item.rank).collect::<Vec<_>>();
        let with_pair = ITEMS[2..3].iter().chain(&PAIR).collect();
        assert_eq!(ranks(divided(with_pair, 230.0).0), [Some(0)], "a pair is not divided");
        for (room, on_strip) in
            [(400.0, vec![1, 2, 0]), (230.0, vec![1, 0]), (120.0, vec![0]), (50.0, vec![])]
        {
            let (fitting, others) = divided(ITEMS.iter().collect(), room);
            assert_eq!(ranks(fitting), on_strip.into_iter().map(Some).collect::<Vec<_>>(), "{room}");
            assert_eq!(ranks(others).last(), Some(&None), "{room}");
        }
    }
}
