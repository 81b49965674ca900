//! The shape, the size and the time step of triangles as colours.

use std::sync::Arc;

use meshbrush_core::domain::Domain;
use meshbrush_core::layers::{Layer, LevelCache, NodeDepths, PaintLayers, SizeField};
use meshbrush_core::quality::{QualityMeasure, TriangleMeasures};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_render::colormap::overlay_palette::OverlayPalette;
use meshbrush_render::render::overlay::{PictureOverlay, measure_overlay};
use meshbrush_study::pixels::numbers_by_pixel;

use super::overlay::OverlayState;
use super::overlay_data::neutral;
use meshbrush_render::colormap::overlay_palette::Opaque;

/// Returns the measure that an overlay shows, if it shows one.
pub(super) fn measure_of(kind: FieldOverlay) -> Option<QualityMeasure> {
    QualityMeasure::ALL.into_iter().find(|measure| FieldOverlay::of_measure(*measure) == kind)
}

/// What triangles are compared with.
pub(super) struct QualityData {
    domain: Domain,
    unit: LengthUnit,
    layers: Vec<Layer>,
    field: Arc<SizeField>,
    paint: PaintLayers,
}

impl QualityData {
    /// Takes that of the document as it is.
    pub fn of(session: &Session) -> Self {
        let (document, settings) = (session.document(), session.document().settings());
        Self {
            domain: settings.domain.clone(),
            unit: settings.unit,
            layers: settings.layers.clone(),
            field: session.follower().shared_field(),
            paint: document.paint().clone(),
        }
    }

    /// Returns the colour of the triangle at each pixel; neutral beyond the mesh, and where a triangle has no
    /// number. `None` where `goes_on` says that nobody wants the colours any more.
    pub fn colors(
        &self,
        mesh: &Extract,
        state: &OverlayState,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Vec<Opaque>> {
        let measure = measure_of(state.kind)?;
        self.with_measures(mesh, measure, |measures| numbers(measures, measure, state, mesh, goes_on))
    }

    /// Returns the colours of all triangles by a measure, with their legend; `None` where none has it.
    pub fn overlay(
        &self,
        mesh: &Extract,
        measure: QualityMeasure,
        palette: &OverlayPalette,
        time: impl Fn(f64) -> String,
    ) -> Option<PictureOverlay> {
        self.with_measures(mesh, measure, |measures| measure_overlay(measures, measure, palette, time))
    }

    /// Calls `use_measures` with what measures the triangles of a mesh.
    fn with_measures<T>(
        &self,
        mesh: &Extract,
        measure: QualityMeasure,
        use_measures: impl FnOnce(&TriangleMeasures<'_>) -> T,
    ) -> T {
        let is_time = measure == QualityMeasure::TimeStep;
        let depths = is_time.then(|| NodeDepths::of(&self.layers, mesh.view())).flatten();
        let depths = depths.and_then(Result::ok);
        let ground = self.domain.ground();
        let mut measures = TriangleMeasures::new(mesh.view(), &ground).with_target(&self.field, &self.paint);
        if let Some(NodeDepths { depths, .. }) = &depths {
            measures = measures.with_depths(depths, self.unit);
        }
        if measure.is_of_links() {
            measures = measures.with_links(self.unit);
        }
        use_measures(&measures)
    }
}

/// Returns the colours of a measure by pixel.
fn numbers(
    measures: &TriangleMeasures<'_>,
    measure: QualityMeasure,
    state: &OverlayState,
    mesh: &Extract,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<Opaque>> {
    let OverlayState { bounds, size, palette, .. } = state;
    let is_time = measure == QualityMeasure::TimeStep;
    // Time steps are compared with the least one.
    let Some(scale) = (if is_time { measures.least_time_step() } else { Some(1.0) }) else {
        return Some(neutral(*size, palette));
    };
    let mut squares = LevelCache::default();
    let of_all = measures.of_all(measure);
    let number = |triangle: usize| match &of_all {
        Some(numbers) => Some(numbers[triangle]).filter(|number| !number.is_nan()),
        None => measures.of(measure, triangle, &mut squares),
    };
    let numbers = numbers_by_pixel(mesh.view(), (*bounds, *size), goes_on, number)?;
    let color = |number: &f32| match number.is_nan() {
        true => palette.neutral(),
        false => palette.quality(measure, number / scale as f32),
    };
    Some(numbers.values().iter().map(color).collect())
}
