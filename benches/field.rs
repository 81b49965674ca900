//! The diamond of [`crate::diamond`] as the pixels of a raster layer, asked by the area rule.

use std::convert::Infallible;
use std::sync::Arc;

use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{
    Layer, LevelCache, PaintLayers, RasterLayer, RasterReading, RasterSource, SizeField, SizeFieldSpec,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::{LatticePoint, Rect};
use meshbrush_mesh::mesh::{LevelsWithin, RuleAnswers, SharedRule};

use crate::diamond;

/// Pixels along a side.
const SIDE: u32 = 2048;

/// h̄ is `target` in the diamond ‖x‖₁ < 8, and 20 elsewhere.
pub fn diamond(target: f64) -> SizeField {
    let target = target * (1.0 + 1e-6);
    of_pixels(|distance| if distance < 0.0 { target } else { 20.0 })
}

/// h̄ is `target` on the boundary of the diamond, and grows by a tenth of the distance from it.
pub fn graded(target: f64) -> SizeField {
    of_pixels(|distance| target + 0.1 * distance.abs())
}

/// Returns a raster of h̄ at the distance ‖x‖₁ − 8 from the diamond.
fn of_pixels(target_diameter: impl Fn(f64) -> f64) -> SizeField {
    let bounds = Rect::around(glam::DVec2::ZERO, 10.0);
    let at = |n: u32| (f64::from(n) + 0.5) / f64::from(SIDE) * 20.0 - 10.0;
    let distance = |n: u32| at(n % SIDE).abs() + at(n / SIDE).abs() - 8.0;
    let values = (0..SIDE * SIDE).map(|n| target_diameter(distance(n)) as f32).collect();
    let raster = Raster::from_values(bounds, [SIDE; 2], values);
    let source = RasterSource { name: "diamond".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    let spec = SizeFieldSpec {
        layers: Layer::stack([RasterLayer { source, reading: RasterReading::Diameter }]),
        transfer: Transfer::between(1e-6, 20.0),
        unasked: 20.0,
        outline: None,
        gradation: None,
        projection: None,
    };
    SizeField::new(spec, diamond::coarse().lattice())
}

/// Returns the area rule.
pub fn rule(field: &SizeField) -> impl SharedRule<Error = Infallible> {
    || Answers { field, squares: LevelCache::default() }
}

struct Answers<'a> {
    field: &'a SizeField,
    squares: LevelCache,
}

impl RuleAnswers for Answers<'_> {
    type Error = Infallible;

    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> Result<LevelsWithin, Infallible> {
        Ok(self.field.levels_within(&mut self.squares, PaintLayers::blank(), corners, level))
    }
}
