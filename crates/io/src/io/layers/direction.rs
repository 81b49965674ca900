//! The direction in which the values of a file grow.

use std::sync::Arc;

use meshbrush_core::layers::{DepthSizes, LayerKind, PositiveDepth, RasterSource, Surface, SurfaceSource};
use meshbrush_core::raster::{Raster, RasterPyramid};

/// Returns a layer of depths whose values grow in this direction, and a surface of heights, where the file of
/// either says the direction; other layers as they are.
pub fn in_direction(kind: LayerKind, positive: Option<PositiveDepth>) -> LayerKind {
    match (kind, positive) {
        (LayerKind::Depth(depths), Some(positive)) => {
            let sizes = DepthSizes { positive, ..*depths.sizes() };
            LayerKind::Depth(depths.with_sizes(sizes))
        }
        (LayerKind::Surface(surface), Some(PositiveDepth::Down)) => {
            let source = match surface.source {
                SurfaceSource::Raster(source) => SurfaceSource::Raster(heights(source)),
                formula @ SurfaceSource::Formula(_) => formula,
            };
            LayerKind::Surface(Surface { source, ..surface })
        }
        (kind, _) => kind,
    }
}

/// Returns depths as heights.
fn heights(source: RasterSource) -> RasterSource {
    let depths = source.raster.raster();
    let heights = depths.values().iter().map(|&depth| 0.0 - depth).collect();
    let raster = Raster::from_values(depths.bounds(), depths.size(), heights);
    RasterSource { raster: Arc::new(RasterPyramid::new(raster)), ..source }
}
