//! The field as colours, in place of those of the levels. They are computed on another thread: sampling many
//! layers takes longer than a frame.

use super::super::contours::pixels_over;
use super::overlay_data::OverlayData;
use super::relief_colors::ReliefColors;
use meshbrush_kit::kit::derivation::Derived;
use meshbrush_kit::kit::jobs::{Jobs, Slot, Wanted};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::geometry::Rect;
use meshbrush_render::colormap::overlay_palette::OverlayPalette;
use meshbrush_render::scene::{Camera, Overlay};

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
pub(super) enum OverlaySource {
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
    pub(super) fn of(kind: FieldOverlay) -> Self {
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
            | FieldOverlay::Valence
            | FieldOverlay::LinkLength
            | FieldOverlay::Orthogonality => Self::Comparison,
        }
    }
}

impl OverlayState {
    /// Returns the state of colours over a rectangle that nobody keeps.
    pub(super) fn once(
        kind: FieldOverlay,
        domain: Rect,
        (bounds, size): (Rect, [u32; 2]),
        palette: OverlayPalette,
    ) -> Self {
        Self { kind, document: 0, mesh: 0, is_derived: false, domain, bounds, size, palette }
    }

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
    let is_comparison = OverlaySource::of(state.kind) == OverlaySource::Comparison;
    let derived = session.derived().filter(|_| is_comparison).map(Derived::shared_extract);
    let data = OverlayData::of(session, state.kind);
    move |wanted| {
        let rgba = data.colors(&state, derived.as_deref(), &|| wanted.goes_on())?;
        Some(Pixels { rgba })
    }
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
