use glam::DVec2;

use super::stroke::widest;
use super::{Brush, Mirror, PaintRasters, PathPoint};
use crate::geometry::Rect;
use crate::raster::PixelRect;

/// A stroke that could be painted: a click, or a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokePlan {
    /// The brush.
    pub brush: Brush,
    /// The lines in which the stroke is repeated.
    pub mirror: Mirror,
    /// Where it begins, in world units.
    pub from: DVec2,
    /// Where it ends, in world units.
    pub to: DVec2,
}

impl StrokePlan {
    /// A click with a brush at a point in world units.
    pub fn click(brush: Brush, at: DVec2) -> Self {
        Self { brush, mirror: Mirror::default(), from: at, to: at }
    }

    /// Whether both ends are finite.
    pub fn is_finite(&self) -> bool {
        self.from.is_finite() && self.to.is_finite()
    }
}

/// What a planned stroke would paint, computed without changing the rasters.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    brush: Brush,
    /// The largest target diameter, in world units.
    h_max: f64,
    /// The segment and its images, each with the pixels that it may change.
    segments: Vec<([PathPoint; 2], PixelRect)>,
}

impl Preview {
    /// The preview of a plan, whose ends must be finite. `h_max` is the largest target diameter, in world
    /// units.
    pub fn new(plan: &StrokePlan, h_max: f64, paint: &PaintRasters) -> Self {
        let segments = plan.mirror.segments([plan.from.into(), plan.to.into()]).map(|ends| {
            let reach = Rect::spanning(ends[0].at, ends[1].at).expanded(widest(&ends, &plan.brush, paint));
            (ends, paint.risk.pixels_touching(&reach))
        });
        Self { brush: plan.brush.on(paint), h_max, segments: segments.collect() }
    }

    /// The pixels that may change, in one to four rectangles.
    pub fn areas(&self) -> impl Iterator<Item = PixelRect> + '_ {
        self.segments.iter().map(|(_, area)| *area).filter(|area| !area.is_empty())
    }

    /// [risk, target diameter] of the pixel in column `x` and row `y` after the stroke; `None` where the
    /// stroke does not reach it.
    pub fn pixel(&self, paint: &PaintRasters, x: u32, y: u32) -> Option<[f32; 2]> {
        let center = paint.risk.pixel_center(x, y);
        let reaching = self.segments.iter().filter(|(_, area)| area.contains(x, y));
        let coverage = reaching.map(|(ends, _)| self.brush.coverage_of_segment(center, *ends) as f32);
        let coverage = coverage.fold(0.0, f32::max);
        let old = [paint.risk.get(x, y), paint.diameter.get(x, y)];
        (coverage > 0.0).then(|| self.brush.painted_pixel(coverage, old, self.h_max))
    }
}
