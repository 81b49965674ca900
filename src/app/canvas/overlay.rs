//! The field as colours, in place of those of the levels. They are computed on another thread: sampling many
//! layers takes longer than a frame.

use std::sync::Arc;

use super::super::contours::pixels_over;
use super::overlay_palette::OverlayPalette;
use super::quality_colors::QualityData;
use super::relief_colors::ReliefColors;
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::layers::{DepthSurface, Layer, LevelCache, PaintLayers, SizeField};
use meshbrush_core::raster::Raster;
use meshbrush_core::surface::SurfaceRule;
use meshbrush_kit::kit::derivation::Derived;
use meshbrush_kit::kit::jobs::{Jobs, Slot, Wanted};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Extract, Limits};
use meshbrush_render::scene::{Camera, Overlay};
use meshbrush_study::pixels::PixelTriangles;
use meshbrush_study::relief::{depth_differences, surface_differences};

/// The data from which colours are made.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OverlayState {
    pub kind: FieldOverlay,
    pub document: u64,
    /// The revision of the mesh; 0 for the depths, which do not depend on it.
    pub mesh: u64,
    /// Whether the nodes along the outline of this mesh are known, where they are compared with depths.
    pub is_derived: bool,
    /// The rectangle of the domain, in world units.
    pub domain: Rect,
    /// The rectangle of the pixels, in world units.
    pub bounds: Rect,
    /// [columns, rows] of the pixels.
    pub size: [u32; 2],
    pub palette: OverlayPalette,
}

/// What the colours of an overlay are found from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OverlaySource {
    /// The size field, at the pixels of a raster over the domain.
    Field,
    /// The data of layers, pixel by pixel of the screen.
    Data,
    /// The triangles, pixel by pixel of the screen: each has one colour.
    Triangles,
    /// The mesh with its nodes on the outline, which is compared with data or measured, pixel by pixel of the
    /// screen.
    Comparison,
}

impl OverlaySource {
    fn of(kind: FieldOverlay) -> Self {
        match kind {
            FieldOverlay::None | FieldOverlay::Risk | FieldOverlay::Target | FieldOverlay::Layer => {
                Self::Field
            }
            FieldOverlay::Depth | FieldOverlay::Surface => Self::Data,
            FieldOverlay::Slack | FieldOverlay::Forced | FieldOverlay::Age => Self::Triangles,
            FieldOverlay::DepthError
            | FieldOverlay::SurfaceError
            | FieldOverlay::SmallestAngle
            | FieldOverlay::LargestAngle
            | FieldOverlay::EdgeRatio
            | FieldOverlay::TargetRatio
            | FieldOverlay::TimeStep
            | FieldOverlay::Valence => Self::Comparison,
        }
    }
}

impl OverlayState {
    fn new(kind: FieldOverlay, session: &Session, palette: OverlayPalette, camera: &Camera) -> Self {
        let (document, follower) = (session.document(), session.follower());
        let domain = document.settings().domain.bounds;
        let source = OverlaySource::of(kind);
        let (bounds, size) = match source {
            OverlaySource::Field => (domain, pixels_over(&domain)),
            OverlaySource::Data | OverlaySource::Triangles | OverlaySource::Comparison => {
                (camera.visible_world(), camera.size_px())
            }
        };
        let mesh = if kind == FieldOverlay::Depth { 0 } else { follower.revision() };
        let document = document.revision();
        let is_derived = source == OverlaySource::Comparison && session.derived().is_some();
        Self { kind, document, mesh, is_derived, domain, bounds, size, palette }
    }
}

/// Colours by pixel, row by row from the lowest.
pub(super) struct Pixels {
    pub rgba: Vec<[u8; 4]>,
}

/// The colours of an overlay, computed again only when what they show has changed.
#[derive(Default)]
pub struct OverlayColors {
    latest: Slot<OverlayState, Pixels>,
    /// What is shown until the first colours are there: the neutral colour, as one pixel.
    neutral: [[u8; 4]; 1],
    /// Grows with each new colours.
    revision: u64,
}

impl OverlayColors {
    /// Returns the overlay to draw, if any: the last one that was computed, or a neutral one until there is
    /// one. So the colours of levels are never beside the legend of an overlay.
    pub fn overlay<'a>(
        &'a mut self,
        kind: FieldOverlay,
        session: &Session,
        palette: OverlayPalette,
        camera: &Camera,
        jobs: &Jobs,
    ) -> Option<Overlay<'a>> {
        if kind == FieldOverlay::None {
            self.latest.stop(jobs);
            return None;
        }
        let beyond = palette.neutral();
        let state = OverlayState::new(kind, session, palette, camera);
        let domain = state.domain;
        self.take_ready(jobs);
        self.latest.want(&state, jobs);
        // Those of another domain, another kind or another theme are of no use.
        self.latest.keep_if(|found| {
            (found.kind, found.domain, &found.palette) == (kind, state.domain, &state.palette)
        });
        if !self.latest.is_running() && !self.latest.has(&state) {
            self.start(state, session, jobs);
            let has_ended = self.latest.is_running() && !self.latest.take(jobs);
            self.note(has_ended);
        }
        if self.neutral != [beyond] {
            self.neutral = [beyond];
            self.revision += 1;
        }
        let (bounds, [columns, rows], rgba) = match self.latest.last() {
            Some((OverlayState { bounds, size, .. }, Pixels { rgba })) => (*bounds, *size, &rgba[..]),
            None => (domain, [1, 1], &self.neutral[..]),
        };
        Some(Overlay { bounds, columns, rows, rgba, beyond, revision: self.revision })
    }

    fn start(&mut self, state: OverlayState, session: &Session, jobs: &Jobs) {
        if OverlaySource::of(state.kind) == OverlaySource::Data {
            let layers = session.document().settings().layers.clone();
            let colors = ReliefColors::new(state.clone(), layers, session.follower().surface().cloned());
            self.latest.start_in_slices(state, || Some(colors), ReliefColors::advance, jobs);
        } else {
            let compute = colors_of(state.clone(), session);
            self.latest.start_wanted(state, compute, jobs);
        }
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
    let source = OverlaySource::of(state.kind);
    let reads_mesh = matches!(source, OverlaySource::Triangles | OverlaySource::Comparison);
    let mesh = reads_mesh.then(|| follower.shared_mesh());
    let derived = session.derived().filter(|_| source == OverlaySource::Comparison);
    let derived = derived.map(Derived::shared_extract);
    let ages = (state.kind == FieldOverlay::Age).then(|| session.ages());
    let settings = follower.settings();
    let (domain, rule, limits) = (follower.domain().clone(), settings.rule, settings.limits());
    let surface = follower.surface().cloned();
    let quality = QualityData::of(session);
    move |wanted| {
        let OverlayState { kind, bounds, size, palette, .. } = &state;
        let goes_on = &|| wanted.goes_on();
        let sampled = || field.sampled_while(&paint, *bounds, *size, goes_on);
        let extract = || derived.or_else(|| Some(Arc::new(mesh.as_ref()?.extract().into_owned())));
        let triangles = || Some(PixelTriangles::new(mesh.as_ref()?, *bounds, *size));
        let rgba = match kind {
            FieldOverlay::Age => {
                let ages = ages?;
                triangles()?.colors(goes_on, palette.neutral(), |id| palette.age(ages.of(id)))
            }
            FieldOverlay::Forced => {
                let criterion = RefinementCriterion::new(&domain, &field, rule, Some(&paint))
                    .with_surface(surface.as_deref());
                forced_colors(&triangles()?, &criterion, &limits, palette, goes_on)
            }
            FieldOverlay::Slack => {
                let (triangles, mut squares) = (triangles()?, LevelCache::default());
                triangles.colors(goes_on, palette.neutral(), |id| {
                    palette.slack(triangles.slack(id, &field, &paint, &mut squares))
                })
            }
            FieldOverlay::DepthError => depth_error_colors(&layers, &*extract()?, &state, goes_on),
            FieldOverlay::SurfaceError => {
                surface_error_colors(surface.as_deref(), &*extract()?, &state, goes_on)
            }
            FieldOverlay::SmallestAngle
            | FieldOverlay::LargestAngle
            | FieldOverlay::EdgeRatio
            | FieldOverlay::TargetRatio
            | FieldOverlay::TimeStep
            | FieldOverlay::Valence => quality.colors(&*extract()?, &state, goes_on),
            FieldOverlay::Risk => risk_colors(&layers, &paint, &state, goes_on),
            FieldOverlay::Layer => {
                sampled().map(|(_, layers)| layers.into_iter().map(|layer| palette.layer(layer)).collect())
            }
            FieldOverlay::Target => sampled().map(|(target, _)| target_colors(&field, &target, palette)),
            // `start` finds those of data in slices, and nobody asks for none.
            FieldOverlay::None | FieldOverlay::Depth | FieldOverlay::Surface => None,
        };
        Some(Pixels { rgba: rgba? })
    }
}

fn forced_colors(
    triangles: &PixelTriangles<'_>,
    criterion: &RefinementCriterion<'_>,
    limits: &Limits,
    palette: &OverlayPalette,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let color = |id| palette.forced(triangles.is_forced(id, criterion, limits));
    triangles.colors(goes_on, palette.neutral(), color)
}

/// `None` where `goes_on` says at the beginning of a row that nobody wants the colours any more.
fn risk_colors(
    layers: &[Layer],
    paint: &PaintLayers,
    state: &OverlayState,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let table: [[u8; 4]; 256] = std::array::from_fn(|i| state.palette.risk(i as u8));
    let grid = Raster::filled(state.bounds, state.size, 0u8);
    let centers = grid.pixel_centers();
    let risk = |point| {
        let visible = layers.iter().filter(|layer| layer.visible);
        visible.filter_map(|layer| layer.risk_at(paint, point)).fold(0.0, f64::max)
    };
    let color = |(x, y)| table[(risk(centers(x, y)) * 255.0) as u8 as usize];
    grid.all().pixels().map(|(x, y)| (x > 0 || goes_on()).then(|| color((x, y)))).collect()
}

/// Returns how far the mesh is from the depths; neutral beyond it, and without depths.
fn depth_error_colors(
    layers: &[Layer],
    mesh: &Extract,
    OverlayState { bounds, size, palette, .. }: &OverlayState,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let surface = DepthSurface::of(layers);
    let depths = surface.as_ref().and_then(|surface| surface.depths_at_nodes(mesh.view()).ok());
    let Some((surface, depths)) = surface.zip(depths) else { return Some(neutral(*size, palette)) };
    let differences = depth_differences(mesh.view(), &depths, &surface, (*bounds, *size), goes_on)?;
    Some(differences.values().iter().map(|&difference| palette.depth_error(difference)).collect())
}

/// Returns how far the mesh is from surfaces; neutral beyond it, and without a surface.
fn surface_error_colors(
    rule: Option<&SurfaceRule>,
    mesh: &Extract,
    OverlayState { bounds, size, palette, .. }: &OverlayState,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<[u8; 4]>> {
    let Some(rule) = rule else { return Some(neutral(*size, palette)) };
    let fit = rule.samples().fit(mesh.view());
    let differences = surface_differences(mesh.view(), &fit, rule, (*bounds, *size), goes_on)?;
    Some(differences.values().iter().map(|&share| palette.surface_error(share)).collect())
}

pub(super) fn neutral(size: [u32; 2], palette: &OverlayPalette) -> Vec<[u8; 4]> {
    vec![palette.neutral(); size[0] as usize * size[1] as usize]
}

fn target_colors(field: &SizeField, target: &Raster, palette: &OverlayPalette) -> Vec<[u8; 4]> {
    let center = target.pixel_centers();
    let level =
        |x, y| field.level_of_diameter(f64::from(target.get(x, y)), center(x, y)).unwrap_or(63).min(63);
    target.all().pixels().map(|(x, y)| palette.level(level(x, y) as u8)).collect()
}

#[cfg(test)]
mod tests {
    use eframe::egui::Context;
    use meshbrush_core::document::Example;

    use super::*;
    use crate::app::files::example;
    use meshbrush_kit::kit::jobs::JobKind;
    use meshbrush_kit::kit::view::View;

    #[test]
    fn an_overlay_that_is_shown_and_hidden_many_times_is_computed_once_at_a_time() {
        let jobs = Jobs::new(&Context::default());
        jobs.hold();
        let session = Session::new(example(Example::ALL[0])).expect("the example has a mesh");
        let view = View::default();
        let palette = OverlayPalette::new(view.ground, view.level_colors(session.document().settings()));
        let lattice = session.mesh().lattice();
        let camera = Camera::fit(lattice, lattice.bounds(), [100, 100], 0.0);
        let mut shown = OverlayColors::default();
        for kind in [FieldOverlay::Target, FieldOverlay::None].repeat(50) {
            let overlay = shown.overlay(kind, &session, palette.clone(), &camera, &jobs);
            let colors = overlay.map(|overlay| overlay.rgba.to_vec());
            assert_eq!(colors, (kind != FieldOverlay::None).then(|| vec![palette.neutral()]));
            assert!(jobs.threads(JobKind::Compute) <= 1);
        }
        assert_eq!(jobs.started(), 1, "the first one has not ended for the window");
    }
}
