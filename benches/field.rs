//! The diamond of [`crate::diamond`] as the pixels of a raster layer, asked by the area rule.

use std::sync::Arc;

use meshbrush::internals::field::Transfer;
use meshbrush::internals::geometry::Rect;
use meshbrush::internals::layers::{
    Layer, LayerKind, PaintLayers, RasterReading, RasterSource, SettledSquares, SizeField, SizeFieldSpec,
};
use meshbrush::internals::mesh::SharedRule;
use meshbrush::internals::raster::{Raster, RasterPyramid};

use crate::diamond;

/// Pixels along a side.
const SIDE: u32 = 2048;

/// h̄ is `target` in the diamond ‖x‖₁ < 8, and 20 elsewhere.
pub fn diamond(target: f64) -> SizeField {
    let coarse = diamond::coarse();
    let bounds = Rect::around(glam::DVec2::ZERO, 10.0);
    let at = |n: u32| (f64::from(n) + 0.5) / f64::from(SIDE) * 20.0 - 10.0;
    let is_inside = |n: u32| at(n % SIDE).abs() + at(n / SIDE).abs() < 8.0;
    let target_f32 = (target * (1.0 + 1e-6)) as f32;
    let values = (0..SIDE * SIDE).map(|n| if is_inside(n) { target_f32 } else { 20.0 }).collect();
    let raster = Raster::from_values(bounds, [SIDE; 2], values);
    let source = RasterSource { name: "diamond".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    let spec = SizeFieldSpec {
        layers: Layer::stack([LayerKind::Raster { source, reading: RasterReading::Diameter }]),
        transfer: Transfer { h_min: 1e-6, h_max: 20.0, shape: 1.0 },
        unasked: 20.0,
        outline: None,
        gradation: None,
    };
    SizeField::new(spec, coarse.lattice())
}

/// The area rule.
pub fn rule(field: &SizeField) -> impl SharedRule {
    move || {
        let mut squares = SettledSquares::default();
        move |corners, level| field.asks_for_more_nearby(&mut squares, PaintLayers::blank(), corners, level)
    }
}
