//! The field as colours, drawn over the mesh. They are computed on another thread: sampling many layers takes
//! longer than a frame.

use super::super::contours::pixels_over;
use super::super::features::layers::layer_color32;
use super::super::jobs::{Jobs, Slot, Wanted};
use super::super::session::Session;
use super::super::view::FieldOverlay;
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::layers::{Layer, LayerId, PaintLayers, SizeField};
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;
use meshbrush_render::colormap::LevelColors;
use meshbrush_render::scene::Overlay;
use meshbrush_study::pixels::PixelTriangles;

/// How strongly h̄ covers the mesh, 0 to 1.
const TARGET_OPACITY: f32 = 0.75;
/// How strongly the colours of layers do: the mesh stays readable.
const LAYER_OPACITY: f32 = 0.55;

/// The data from which colours are made.
#[derive(Clone, Debug, PartialEq)]
struct OverlayState {
    kind: FieldOverlay,
    document: u64,
    mesh: u64,
    bounds: Rect,
    colors: LevelColors,
}

/// Colours by pixel, row by row from the lowest.
struct Pixels {
    rgba: Vec<[u8; 4]>,
    /// [columns, rows].
    size: [u32; 2],
}

/// The colours of an overlay, computed again only when what they show has changed.
#[derive(Default)]
pub struct OverlayColors {
    latest: Slot<OverlayState, Pixels>,
    /// Grows with each new colours.
    revision: u64,
}

impl OverlayColors {
    /// Returns the overlay to draw, if any: the last one that was computed.
    pub fn overlay<'a>(
        &'a mut self,
        kind: FieldOverlay,
        session: &Session,
        colors: LevelColors,
        jobs: &Jobs,
    ) -> Option<Overlay<'a>> {
        if kind == FieldOverlay::None {
            self.latest.stop(jobs);
            return None;
        }
        let (document, follower) = (session.document(), session.follower());
        let bounds = document.settings().domain.bounds;
        let (document_state, mesh) = (document.revision(), follower.revision());
        let state = OverlayState { kind, document: document_state, mesh, bounds, colors };
        self.take_ready(jobs);
        self.latest.want(&state, jobs);
        // Those of another domain or another kind are of no use.
        self.latest.keep_if(|found| found.kind == kind && found.bounds == bounds);
        if !self.latest.is_running() && !self.latest.has(&state) {
            let compute = colors_of(state.clone(), session);
            self.latest.start_wanted(state, compute, jobs);
            let has_ended = self.latest.is_running() && !self.latest.take(jobs);
            self.note(has_ended);
        }
        let (_, Pixels { rgba, size: [columns, rows] }) = self.latest.last()?;
        let opacity = match kind {
            FieldOverlay::Target => TARGET_OPACITY,
            FieldOverlay::Layer | FieldOverlay::Slack | FieldOverlay::Forced | FieldOverlay::Age => {
                LAYER_OPACITY
            }
            FieldOverlay::Risk | FieldOverlay::None => 1.0,
        };
        Some(Overlay { bounds, columns: *columns, rows: *rows, rgba, opacity, revision: self.revision })
    }

    fn take_ready(&mut self, jobs: &Jobs) {
        let has_ended = self.latest.is_running() && !self.latest.take_ready(jobs);
        self.note(has_ended);
    }

    /// Notes whether other colours may have come.
    fn note(&mut self, has_changed: bool) {
        self.revision += u64::from(has_changed);
    }
}

fn colors_of(
    state: OverlayState,
    session: &Session,
) -> impl FnOnce(&Wanted) -> Option<Pixels> + Send + 'static {
    let (document, follower) = (session.document(), session.follower());
    let (paint, layers) = (document.paint().clone(), document.settings().layers.clone());
    let field = follower.shared_field();
    let of_mesh = matches!(state.kind, FieldOverlay::Slack | FieldOverlay::Forced | FieldOverlay::Age);
    let mesh = of_mesh.then(|| follower.shared_mesh());
    let ages = (state.kind == FieldOverlay::Age).then(|| session.ages());
    let rule = (state.kind == FieldOverlay::Forced)
        .then(|| (follower.domain().clone(), follower.settings().rule, follower.settings().limits()));
    move |wanted| {
        let size = pixels_over(&state.bounds);
        let goes_on = &|| wanted.goes_on();
        let rgba = match state.kind {
            FieldOverlay::Risk => risk_colors(&layers, &paint, state.bounds, size, goes_on)?,
            FieldOverlay::Layer => layer_colors(&field.sampled_while(&paint, state.bounds, size, goes_on)?.1),
            FieldOverlay::Slack | FieldOverlay::Forced | FieldOverlay::Age => {
                let mesh = mesh.expect("the mesh is shared for these overlays");
                let pixels = PixelTriangles::new(&mesh, state.bounds, size);
                wanted.goes_on().then_some(())?;
                if let Some(ages) = ages {
                    pixels.ages(&ages).into_iter().map(age_color).collect()
                } else if state.kind == FieldOverlay::Slack {
                    let (target, _) = field.sampled_while(&paint, state.bounds, size, goes_on)?;
                    pixels.slack(&target).into_iter().map(slack_color).collect()
                } else {
                    let (domain, rule, limits) = rule.expect("the rule is taken along for this overlay");
                    let criterion = RefinementCriterion::new(&domain, &field, rule, Some(&paint));
                    let forced = pixels.forced(&criterion, &limits);
                    forced.into_iter().map(|forced| if forced { FORCED } else { [0; 4] }).collect()
                }
            }
            _ => target_colors(&field, &field.sampled_while(&paint, state.bounds, size, goes_on)?.0, &state),
        };
        Some(Pixels { rgba, size })
    }
}

/// `None` where `goes_on` says at the beginning of a row that nobody wants the colours any more.
fn risk_colors(
    layers: &[Layer],
    paint: &PaintLayers,
    bounds: Rect,
    size: [u32; 2],
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let table: [[u8; 4]; 256] = std::array::from_fn(|i| risk_color(i as u8));
    let grid = Raster::filled(bounds, size, 0u8);
    let centers = grid.pixel_centers();
    let risk = |point| {
        let visible = layers.iter().filter(|layer| layer.visible);
        visible.filter_map(|layer| layer.risk_at(paint, point)).fold(0.0, f64::max)
    };
    let color = |(x, y)| table[(risk(centers(x, y)) * 255.0) as u8 as usize];
    grid.all().pixels().map(|(x, y)| (x > 0 || goes_on()).then(|| color((x, y)))).collect()
}

/// Returns the colours of the layers that decide h̄; transparent where none asks for anything.
fn layer_colors(decisions: &[Option<LayerId>]) -> Vec<[u8; 4]> {
    let color = |layer: &Option<LayerId>| layer.map_or([0; 4], |id| layer_color32(id).to_array());
    decisions.iter().map(color).collect()
}

fn target_colors(field: &SizeField, target: &Raster, state: &OverlayState) -> Vec<[u8; 4]> {
    let level = |target: f32| field.level_of_diameter(f64::from(target)).unwrap_or(63).min(63) as u8;
    target.values().iter().map(|&target| state.colors.of(level(target))).collect()
}

/// The colour of triangles that only compatibility asked for.
pub const FORCED: [u8; 4] = [0xff, 0x8a, 0x1e, 0xff];

/// Halvings from which on slack has its strongest colour.
pub const MOST_SLACK: f32 = 4.0;

/// Returns a colour from transparent to white, by the number of halvings by which the mesh is finer than h̄
/// requires.
pub fn slack_color(halvings: f32) -> [u8; 4] {
    let share = (halvings / MOST_SLACK).clamp(0.0, 1.0);
    [0xff, 0xff, 0xff, if halvings.is_nan() { 0 } else { (share * 255.0) as u8 }]
}

/// Edits from which on a triangle counts as old.
pub const OLD_AGE: u32 = 10;

/// Returns a colour from white for the last edit to transparent for old triangles, and for those from before
/// the first edit.
pub fn age_color(edits_ago: Option<u32>) -> [u8; 4] {
    let age = edits_ago.map_or(OLD_AGE, |age| age.min(OLD_AGE));
    [0xff, 0xff, 0xff, (255 * (OLD_AGE - age) / OLD_AGE) as u8]
}

/// Returns a colour from transparent to a warm red; alpha carries the risk.
pub fn risk_color(risk: u8) -> [u8; 4] {
    [0xff, 0x5a - risk / 6, 0x3c, (f32::from(risk) * 0.8) as u8]
}

#[cfg(test)]
mod tests {
    use eframe::egui::Context;
    use meshbrush_core::document::Example;

    use super::*;
    use crate::app::files::example;
    use crate::app::jobs::Kind;
    use crate::app::view::View;

    #[test]
    fn an_overlay_that_is_shown_and_hidden_many_times_is_computed_once_at_a_time() {
        let jobs = Jobs::new(&Context::default());
        jobs.hold();
        let session = Session::new(example(Example::ALL[0])).expect("the example has a mesh");
        let colors = View::default().level_colors(session.document().settings());
        let mut shown = OverlayColors::default();
        for kind in [FieldOverlay::Target, FieldOverlay::None].repeat(50) {
            assert!(shown.overlay(kind, &session, colors.clone(), &jobs).is_none());
            assert!(jobs.threads(Kind::Compute) <= 1);
        }
        assert_eq!(jobs.started(), 1, "the first one has not ended for the window");
    }
}
