//! The tag beside the brush ring: what a click there would add or free.

use eframe::egui::{Align, Align2, Color32, Pos2, Rect, Ui, Vec2, vec2};

use crate::app::features::painting::picks;
use meshbrush_core::document::{NoChange, NoPaintLayer, Price, Settings};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::readout::{Quantity, value_at};
use meshbrush_kit::kit::tools::PaintKind;
use meshbrush_mesh::mesh::Progress;
use meshbrush_mesh::text::short_name;
use meshbrush_ui::theme::{Tokens, tokens};
use meshbrush_ui::widgets::{floating_tag, format, tag_size};

/// Space between ring and tag, in points.
const GAP: f32 = 14.0;
/// The tag is no farther from the pointer than this, in points: in a larger ring it is inside.
const FARTHEST: f32 = 120.0;

/// Radius around the eyedropper that the tag leaves free, in points.
const PICKER: f32 = 18.0;

/// Shows the tag beside a ring of the given radius in points. `floats` are drawn over the canvas.
pub fn show(ui: &Ui, state: &FrameState<'_>, (canvas, floats): (Rect, &[Rect]), pointer: Pos2, radius: f32) {
    let picks = state.tools.paints() && ui.input(|input| picks(input.modifiers) && !input.pointer.any_down());
    let (tag, reach) =
        if picks { (picked_tag(state, tokens(ui)), PICKER) } else { (price_tag(state, tokens(ui)), radius) };
    let Some((text, color)) = tag else { return };
    let bounds = canvas.shrink(8.0);
    let (anchor, align) = place(bounds, floats, pointer, reach, tag_size(ui, &text));
    floating_tag(ui, anchor, align, bounds, &text, color);
}

/// Returns the tag with the risk or diameter that a click would pick at the pointer, and its colour.
fn picked_tag(state: &FrameState<'_>, t: &Tokens) -> Option<(String, Color32)> {
    let (session, point) = (state.session, state.pointer?);
    let value = |quantity| value_at(point, session.document(), session.follower(), quantity);
    let text = match state.tools.kind {
        PaintKind::Risk => format!("risk {}", format::digits(value(Quantity::Risk), 3)),
        PaintKind::Diameter => {
            let diameter = value(Quantity::TargetDiameter);
            let level = session.follower().field().level_of_diameter(diameter, point);
            let level = level.map_or(String::new(), |level| format!(" · level {level}"));
            format!("h̄ {}{level}", format::length(diameter, state.unit()))
        }
        PaintKind::Error => {
            let (_, error) = session.follower().surface()?.allowed_at(point)?;
            format!("largest error {}", format::digits(error, 5))
        }
    };
    Some((text, t.value))
}

fn price_tag(state: &FrameState<'_>, t: &Tokens) -> Option<(String, Color32)> {
    let (session, pricer) = (state.session, state.session.pricer());
    let (count, settings) = (session.mesh().raw_triangle_count(), session.document().settings());
    match (pricer.price(), pricer.progress()) {
        (Some(Price::Nothing(reason)), _) => {
            let is_outside = state.pointer.is_some_and(|point| session.locate(point).triangle().is_none());
            let reason = if is_outside { NoChange::OutsideField } else { reason };
            let brush = state.tools.brush()?;
            let why = match reason {
                NoChange::TrianglesFit | NoChange::PaintedAlready if is_limited(&brush, settings) => {
                    let smallest = format::length(settings.transfer.h_min, state.unit());
                    format!("the smallest diameter, {smallest}, limits it")
                }
                NoChange::LayerDecides(id) => {
                    let layer = settings.layer(id);
                    format!("“{}” decides here", layer.map_or("another layer", |layer| &layer.name))
                }
                NoChange::NoLayer => why_no_layer(&session.document().layer_for(&brush.medium).err()?),
                reason => why_nothing(reason, brush.medium).into(),
            };
            Some((format!("no change: {why}"), t.label))
        }
        (Some(price), _) => Some(tag(price, count, settings, t)),
        // Whether there is such a frame depends on the machine's speed.
        (None, Progress::More) if state.reproducible => None,
        (None, Progress::More) => Some(("counting …".to_owned(), t.faint)),
        (None, Progress::Done) => None,
    }
}

/// Returns whether a brush refines to a diameter below the smallest one of the document.
fn is_limited(brush: &Brush, settings: &Settings) -> bool {
    let finer = |change| !matches!(change, DiameterChange::Coarser);
    matches!(brush.medium, Medium::Diameter(to, change) if finer(change) && to < settings.transfer.h_min)
}

/// Returns why there is no layer to paint on. A click says more, and offers what would help.
fn why_no_layer(problem: &NoPaintLayer) -> String {
    match problem {
        NoPaintLayer::Missing(Some(quantity)) => format!("no layer for painted {}", quantity.noun()),
        NoPaintLayer::Missing(None) => "no layer has paint".into(),
        NoPaintLayer::Locked { name, .. } => format!("“{}” is locked", short_name(name)),
        NoPaintLayer::Hidden { name, .. } => format!("“{}” is hidden", short_name(name)),
    }
}

/// Returns why a stroke changes no triangle.
fn why_nothing(reason: NoChange, medium: Medium) -> &'static str {
    let lowers = matches!(medium, Medium::Eraser | Medium::Diameter(_, DiameterChange::Coarser))
        || medium == Medium::Risk(0.0);
    match (reason, medium) {
        (NoChange::OutsideField, _) => "outside the domain",
        (NoChange::PaintedAlready, Medium::Eraser) => "nothing is painted here",
        (NoChange::PaintedAlready, Medium::Risk(0.0)) => "no risk is painted here",
        (NoChange::PaintedAlready, Medium::Risk(1.0)) => "the risk is 1 already",
        (NoChange::PaintedAlready, Medium::Diameter(_, DiameterChange::Finer)) => "painted as fine already",
        (NoChange::PaintedAlready, Medium::Diameter(_, DiameterChange::Coarser)) => {
            "nothing finer is painted here"
        }
        (NoChange::PaintedAlready, _) => "this value is painted already",
        (NoChange::CoarserThanGrid, _) => "h̄ is coarser than the grid here",
        (NoChange::LayerDecides(_), _) => "another layer decides here",
        (NoChange::NoLayer, _) => "no layer to paint on",
        (NoChange::TrianglesFit, Medium::Error(_)) => "already this close here",
        (NoChange::TrianglesFit, _) if lowers => "finer triangles nearby need these",
        (NoChange::TrianglesFit, _) => "already finer here",
    }
}

/// Returns the text of the tag for a price, on a mesh of `count` triangles.
fn tag(price: Price, count: usize, settings: &Settings, t: &Tokens) -> (String, Color32) {
    let text = match price {
        Price::Change(0) => return ("as many triangles as before".into(), t.label),
        Price::Change(change) => {
            let noun = if change.abs() == 1 { "triangle" } else { "triangles" };
            format!("{} {noun}", format::change(change))
        }
        Price::MoreThan(most @ 1..) => format!("over {} triangles", format::change(most)),
        Price::MoreThan(most) => format!("frees over {} triangles", format::count(most.unsigned_abs())),
        Price::About(change) => format!("about {} triangles", format::about_change(change)),
        Price::Many => format!("changes over {} triangles", format::count(Price::MOST as u64)),
        Price::TooFine => return ("finer than the lattice".into(), t.danger),
        Price::Nothing(_) => return ("no change".into(), t.label),
    };
    let after = count as i64 + price.change();
    if price.change() > 0 && after > settings.limits().most_triangles() as i64 {
        return (format!("{text}, over the budget"), t.danger);
    }
    (text, t.value)
}

/// Returns the place of a tag of the given size: right of the ring, else left, else below, else above; never
/// over its middle, and not below what floats over the canvas if there is another place.
fn place(bounds: Rect, floats: &[Rect], pointer: Pos2, radius: f32, size: Vec2) -> (Pos2, Align2) {
    let reach = radius.min(FARTHEST) + GAP;
    let places = [
        (vec2(reach, 0.0), Align2::LEFT_CENTER),
        (vec2(-reach, 0.0), Align2::RIGHT_CENTER),
        (vec2(0.0, reach), Align2::CENTER_TOP),
        (vec2(0.0, -reach), Align2::CENTER_BOTTOM),
    ];
    let places = places.map(|(by, align)| (pointer + by, align));
    let fits = |(anchor, align): &&(Pos2, Align2)| {
        let rect = align.anchor_size(*anchor, size);
        let is_beside = align.y() == Align::Center;
        if is_beside {
            bounds.x_range().contains(rect.left()) && bounds.x_range().contains(rect.right())
        } else {
            bounds.y_range().contains(rect.top()) && bounds.y_range().contains(rect.bottom())
        }
    };
    let is_free = |(anchor, align): &&(Pos2, Align2)| {
        let rect = align.anchor_size(*anchor, size);
        !floats.iter().any(|float| float.intersects(rect))
    };
    let found = places.iter().filter(fits).find(is_free).or_else(|| places.iter().find(fits));
    *found.unwrap_or(&places[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;
    use meshbrush_ui::theme::DARK;

    #[test]
    fn the_tag_says_the_number_and_whether_it_passes_the_budget() {
        let settings = Settings { max_triangles: 1000, ..Settings::default() };
        let says = |price, count| tag(price, count, &settings, &DARK);
        assert_eq!(says(Price::Change(0), 1000), ("as many triangles as before".into(), DARK.label));
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
                let (anchor, align) = place(bounds, &[], pointer, radius, size);
                let rect = align.anchor_size(anchor, size);
                let free = bounds.shrink2(size / 2.0);
                let shown = Rect::from_center_size(free.clamp(rect.center()), size);
                assert!(!shown.expand(GAP - 1.0).contains(pointer), "{pointer} {radius} {shown}");
            }
        }
    }

    #[test]
    fn the_tag_is_not_below_what_floats_over_the_canvas() {
        let (bounds, size) = (Rect::from_min_size(pos2(0.0, 0.0), vec2(500.0, 400.0)), vec2(120.0, 28.0));
        let legend = Rect::from_min_size(pos2(340.0, 10.0), vec2(150.0, 200.0));
        let rect = |pointer| {
            let (anchor, align) = place(bounds, &[legend], pointer, 20.0, size);
            align.anchor_size(anchor, size)
        };
        let pointer = pos2(300.0, 100.0);
        assert!(rect(pointer).right() < pointer.x, "left of the ring, as the legend is on the right");
        assert!(rect(pos2(300.0, 300.0)).left() > 300.0, "nothing is on the right here");
        let narrow = Rect::from_min_size(pos2(0.0, 0.0), vec2(340.0, 400.0));
        let (anchor, align) = place(bounds, &[legend, narrow], pointer, 20.0, size);
        assert!(align.anchor_size(anchor, size).left() > pointer.x, "no place is free: the first that fits");
    }
}
