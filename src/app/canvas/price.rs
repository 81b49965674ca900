//! The tag beside the brush ring: what a click there would add or free.

use eframe::egui::{Align2, Color32, Pos2, Rect, Ui, Vec2, vec2};

use crate::app::frame::FrameState;
use crate::app::theme::{Tokens, tokens};
use crate::app::widgets::{floating_tag, format, tag_size};
use crate::document::{Price, Settings};
use crate::mesh::Progress;

/// Space between ring and tag, in points.
const GAP: f32 = 14.0;
/// The tag is no farther from the pointer than this, in points: in a larger ring it is inside.
const FARTHEST: f32 = 120.0;

/// Shows the tag beside a ring of the given radius in points.
pub fn show(ui: &Ui, state: &FrameState<'_>, canvas: Rect, pointer: Pos2, radius: f32) {
    let pricer = state.session.pricer();
    let t = tokens(ui);
    let count = state.session.mesh().raw_triangle_count();
    let (text, color) = match (pricer.price(), pricer.progress()) {
        (Some(price), _) => tag(price, count, state.session.document().settings(), t),
        // Whether there is such a frame depends on the machine's speed.
        (None, Progress::More) if state.reproducible => return,
        (None, Progress::More) => ("counting …".to_owned(), t.faint),
        (None, Progress::Done) => return,
    };
    let bounds = canvas.shrink(8.0);
    let (anchor, align) = place(bounds, pointer, radius, tag_size(ui, &text));
    floating_tag(ui, anchor, align, bounds, &text, color);
}

/// What the tag says of a price, on a mesh of `count` triangles.
fn tag(price: Price, count: usize, settings: &Settings, t: &Tokens) -> (String, Color32) {
    let text = match price {
        Price::Change(0) => return ("no change".into(), t.label),
        Price::Change(change) => {
            let noun = if change.abs() == 1 { "triangle" } else { "triangles" };
            format!("{} {noun}", format::change(change))
        }
        Price::MoreThan(most @ 1..) => format!("over {} triangles", format::change(most)),
        Price::MoreThan(most) => format!("frees over {} triangles", format::count(most.unsigned_abs())),
        Price::TooFine => return ("finer than the lattice".into(), t.danger),
    };
    let after = count as i64 + price.change();
    if price.change() > 0 && after > settings.limits().most_triangles() as i64 {
        return (format!("{text}, over the budget"), t.danger);
    }
    (text, t.value)
}

/// Where a tag of the given size goes: right of the ring, else left, else below, else above; never over its
/// middle.
fn place(bounds: Rect, pointer: Pos2, radius: f32, size: Vec2) -> (Pos2, Align2) {
    let reach = radius.min(FARTHEST) + GAP;
    if pointer.x + reach + size.x <= bounds.right() {
        (pointer + vec2(reach, 0.0), Align2::LEFT_CENTER)
    } else if pointer.x - reach - size.x >= bounds.left() {
        (pointer - vec2(reach, 0.0), Align2::RIGHT_CENTER)
    } else if pointer.y + reach + size.y <= bounds.bottom() {
        (pointer + vec2(0.0, reach), Align2::CENTER_TOP)
    } else {
        (pointer - vec2(0.0, reach), Align2::CENTER_BOTTOM)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::theme::DARK;
    use eframe::egui::pos2;

    #[test]
    fn the_tag_says_the_number_and_whether_it_passes_the_budget() {
        let settings = Settings { max_triangles: 1000, ..Settings::default() };
        let says = |price, count| tag(price, count, &settings, &DARK);
        assert_eq!(says(Price::Change(0), 1000), ("no change".into(), DARK.label));
        assert_eq!(says(Price::Change(1), 999), ("+1 triangle".into(), DARK.value));
        assert_eq!(says(Price::Change(-3200), 9000), ("−3,200 triangles".into(), DARK.value));
        let over = ("+2 triangles, over the budget".into(), DARK.danger);
        assert_eq!(says(Price::Change(2), 999), over);
        let over = ("over +500,000 triangles, over the budget".into(), DARK.danger);
        assert_eq!(says(Price::MoreThan(500_000), 10), over);
        assert_eq!(says(Price::MoreThan(-500_000), 10).0, "frees over 500,000 triangles");
        assert_eq!(says(Price::TooFine, 10), ("finer than the lattice".into(), DARK.danger));
    }

    #[test]
    fn the_tag_stays_on_the_canvas_and_off_the_middle_of_the_ring() {
        let bounds = Rect::from_min_size(pos2(50.0, 30.0), vec2(500.0, 400.0));
        let size = vec2(190.0, 28.0);
        for (x, y) in (0..=20).flat_map(|i| (0..=20).map(move |j| (i, j))) {
            let share = vec2(x as f32, y as f32) / 20.0;
            let pointer = bounds.min + share * bounds.size();
            for radius in [2.0, 30.0, 90.0, 1000.0] {
                let (anchor, align) = place(bounds, pointer, radius, size);
                let rect = align.anchor_size(anchor, size);
                let free = bounds.shrink2(size / 2.0);
                let shown = Rect::from_center_size(free.clamp(rect.center()), size);
                assert!(!shown.expand(GAP - 1.0).contains(pointer), "{pointer} {radius} {shown}");
            }
        }
    }
}
