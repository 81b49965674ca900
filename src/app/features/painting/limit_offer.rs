//! The offer to lower the smallest diameter, after a smaller one was painted.

use crate::app::features::painting::Painting;
use meshbrush_kit::kit::clock::{Duration, Instant};

use eframe::egui::{self, Frame, Margin, Pos2, Rect, RichText, Ui, UiBuilder, vec2};
use glam::DVec2;

use meshbrush_core::document::{Price, TransferPrice, TransferPricer};
use meshbrush_core::field::Transfer;
use meshbrush_core::paint::{Brush, DiameterChange, Medium, Mirror};
use meshbrush_kit::kit::command::{BrushCommand, Command};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::slices::SLICE;
use meshbrush_kit::kit::{FrameState, NO_LIMIT, marks::point_from_px};
use meshbrush_mesh::geometry::Rect as WorldRect;
use meshbrush_mesh::mesh::Progress;
use meshbrush_render::scene::Camera;
use meshbrush_ui::theme::{font, metrics, tokens};
use meshbrush_ui::widgets::{ActionButton, ButtonKind, format};

/// Width of the offer, in points.
const WIDTH: f32 = 312.0;
/// The most height of the offer, in points.
const HEIGHT: f32 = 196.0;
/// Space between the rim of the brush and the offer, in points.
const GAP: f32 = 16.0;
/// The offer is no farther from the end of the stroke than this, in points.
const FARTHEST: f32 = 120.0;
/// The most time of a frame for the prices.
const FRAME_BUDGET: Duration = Duration::from_millis(4);

/// Where a diameter below the smallest one of the document is painted, and the prices of lowering that.
#[derive(Clone, Debug)]
pub struct LimitOffer {
    /// The painted diameter, in world units.
    pub diameter: f64,
    /// A rectangle around what was painted, in world units.
    painted: WorldRect,
    /// The end of the stroke, in world units.
    at: DVec2,
    /// Prices the smaller limit with the risk curve as it is.
    kept: TransferPricer,
    /// Prices it with a risk curve that ends at the painted diameter, too.
    remapped: TransferPricer,
}

impl LimitOffer {
    /// Returns the offer for a stroke that begins at a point, in world units; `None` if the brush paints
    /// nothing smaller than the smallest diameter.
    pub fn of(brush: &Brush, transfer: &Transfer) -> Option<Self> {
        let Medium::Diameter(diameter, DiameterChange::Finer | DiameterChange::Any) = brush.medium else {
            return None;
        };
        (diameter < transfer.h_min).then(|| Self {
            diameter,
            painted: WorldRect::new(DVec2::INFINITY, DVec2::NEG_INFINITY),
            at: DVec2::ZERO,
            kept: TransferPricer::default(),
            remapped: TransferPricer::default(),
        })
    }

    /// Notes a point of the stroke, in world units.
    pub fn extend(&mut self, point: DVec2, radius: f64, mirror: &Mirror) {
        self.at = point;
        for image in mirror.images(point) {
            self.painted.min = self.painted.min.min(image - radius);
            self.painted.max = self.painted.max.max(image + radius);
        }
    }

    /// Returns whether lowering the limit would change what was painted, as far as it is known.
    pub fn is_open(&self, session: &Session) -> bool {
        let is_below = self.diameter < session.document().settings().transfer.h_min;
        is_below && self.kept.price().is_none_or(|price| price.here != Price::Change(0))
    }

    /// Counts triangles for a while. Returns whether more are to be counted.
    pub fn advance(&mut self, session: &Session, reproducible: bool) -> bool {
        let (document, follower) = (session.document(), session.follower());
        let transfer = document.settings().transfer;
        let remaps = document.settings().layers.iter().any(|layer| layer.visible && layer.is_of_risk());
        let kept = transfer.with_smallest(self.diameter);
        let remapped = Transfer { h_risk: self.diameter, ..kept };
        let deadline = Instant::now() + if reproducible { NO_LIMIT } else { FRAME_BUDGET };
        for (pricer, transfer) in
            [(&mut self.kept, Some(kept)), (&mut self.remapped, remaps.then_some(remapped))]
        {
            pricer.ask(transfer.map(|transfer| (transfer, self.painted)), document, follower);
            while pricer.progress() == Progress::More && Instant::now() < deadline {
                pricer.advance(document, follower, SLICE);
            }
        }
        [&self.kept, &self.remapped].iter().any(|pricer| pricer.progress() == Progress::More)
    }
}

/// Shows the offer beside the end of the stroke. Returns its place.
pub fn show(
    ui: &mut Ui,
    canvas: Rect,
    state: &FrameState<'_>,
    camera: &Camera,
    commands: &mut Vec<Command>,
) -> Option<Rect> {
    let offer = state.feature::<Painting>().offer.as_ref()?;
    let px_per_point = ui.pixels_per_point();
    let at = point_from_px(canvas, camera.screen_from_world(offer.at), px_per_point);
    let radius = (state.tools.radius * camera.px_per_world()) as f32 / px_per_point;
    let place = place(canvas.shrink(12.0), at, radius.min(FARTHEST) + GAP);
    let mut child = ui.new_child(UiBuilder::new().max_rect(place).id_salt("limit offer"));
    let t = tokens(ui);
    let frame = Frame::new()
        .fill(t.popup)
        .stroke(t.hairline())
        .corner_radius(metrics::RADIUS_PANEL)
        .shadow(t.tag_shadow())
        .inner_margin(Margin::same(12));
    frame.show(&mut child, |ui| contents(ui, state, offer, commands));
    Some(child.min_rect())
}

/// Returns the place of the offer: right of the brush, or else left of it, within the canvas.
fn place(bounds: Rect, at: Pos2, reach: f32) -> Rect {
    let is_right = at.x + reach + WIDTH <= bounds.right();
    let left = if is_right { at.x + reach } else { at.x - reach - WIDTH };
    let room = (bounds.size() - vec2(WIDTH, HEIGHT)).max(egui::Vec2::ZERO);
    let corner = (vec2(left, at.y - HEIGHT / 2.0) - bounds.min.to_vec2()).clamp(egui::Vec2::ZERO, room);
    Rect::from_min_size(bounds.min + corner, vec2(WIDTH, HEIGHT))
}

fn contents(ui: &mut Ui, state: &FrameState<'_>, offer: &LimitOffer, commands: &mut Vec<Command>) {
    let t = tokens(ui);
    let smallest = state.session.document().settings().transfer.h_min;
    let [painted, smallest] =
        [offer.diameter, smallest].map(|diameter| format::length(diameter, state.unit()));
    let text =
        format!("You painted {painted}. The smallest diameter of the document, {smallest}, limits it.");
    ui.label(RichText::new(text).font(font::body()).color(t.text));
    let mut choice = |ui: &mut Ui, label, kind, price: Option<String>, command| {
        ui.add_space(6.0);
        if ui.add(ActionButton::new(label).kind(kind)).clicked() {
            commands.push(Command::from(command));
        }
        if let Some(price) = price {
            ui.label(RichText::new(price).font(font::caption()).color(t.label));
        }
    };
    let price = |pricer: &TransferPricer| words(pricer, state);
    let (kept, remapped) = (price(&offer.kept), price(&offer.remapped));
    choice(ui, "Lower the smallest diameter", ButtonKind::Main, kept, BrushCommand::LowerLimit);
    if let Some(remapped) = remapped {
        let remapped = format!("{remapped}. Layers of risk get finer, too.");
        let command = BrushCommand::LowerLimitAndRisk;
        choice(ui, "Lower it and the risk curve", ButtonKind::Quiet, Some(remapped), command);
    }
    choice(ui, "Not now", ButtonKind::Quiet, None, BrushCommand::KeepLimit);
}

/// Returns a price in words; `None` where there is none.
fn words(pricer: &TransferPricer, state: &FrameState<'_>) -> Option<String> {
    let Some(price) = pricer.price() else {
        // Whether there is such a frame depends on the machine's speed.
        let counts = pricer.progress() == Progress::More && !state.reproducible;
        return counts.then(|| "counting …".to_owned());
    };
    let text = price_in_words(price);
    let after = state.session.mesh().raw_triangle_count() as i64 + price.everywhere.change();
    let most = state.session.document().settings().limits().most_triangles() as i64;
    Some(if after > most { format!("{text}, over the budget") } else { text })
}

fn price_in_words(price: TransferPrice) -> String {
    let here = match price.here {
        Price::Change(1) => "+1 triangle here".to_owned(),
        Price::Change(change) => format!("{} triangles here", format::change(change)),
        Price::TooFine => return "finer than the lattice".to_owned(),
        Price::MoreThan(_) | Price::Many | Price::Nothing(_) | Price::About(_) => {
            return match price.everywhere {
                Price::About(change) => format!("about {} triangles", format::about_change(change)),
                _ => format!("over {} triangles here", format::change(Price::MOST as i64)),
            };
        }
    };
    match price.elsewhere() {
        Some(Price::Change(0)) => format!("{here}, none elsewhere"),
        Some(Price::Change(change)) => format!("{here}, {} elsewhere", format::change(change)),
        Some(Price::About(change)) => format!("{here}, about {} elsewhere", format::about_change(change)),
        _ if price.everywhere == Price::TooFine => format!("{here}, finer than the lattice elsewhere"),
        _ => format!("{here}, over {} elsewhere", format::change(Price::MOST as i64)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    #[test]
    fn the_price_says_what_is_here_and_what_is_elsewhere() {
        let words = |here, everywhere| price_in_words(TransferPrice { here, everywhere });
        let change = Price::Change;
        assert_eq!(words(change(2000), change(2000)), "+2,000 triangles here, none elsewhere");
        assert_eq!(words(change(1), change(21)), "+1 triangle here, +20 elsewhere");
        let many = Price::MoreThan(500_000);
        assert_eq!(words(change(2000), many), "+2,000 triangles here, over +500,000 elsewhere");
        assert_eq!(words(many, many), "over +500,000 triangles here");
        let about = Price::About(20_312_345);
        assert_eq!(words(change(2000), about), "+2,000 triangles here, about +20 million elsewhere");
        assert_eq!(words(many, about), "about +20 million triangles", "here and elsewhere");
        assert_eq!(words(change(2), Price::TooFine), "+2 triangles here, finer than the lattice elsewhere");
        assert_eq!(words(Price::TooFine, Price::TooFine), "finer than the lattice");
    }

    #[test]
    fn the_offer_is_beside_the_brush_and_on_the_canvas() {
        let bounds = Rect::from_min_size(pos2(20.0, 40.0), vec2(900.0, 500.0));
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.5, 1.0), (0.9, 0.5)] {
            let at = bounds.min + vec2(x, y) * bounds.size();
            let place = place(bounds, at, 40.0);
            assert!(bounds.contains_rect(place) && !place.contains(at), "{at} {place}");
        }
    }
}
