use glam::DVec2;

use super::{Brush, Mirror, Repaint, Stroke};
use crate::geometry::Rect;
use crate::raster::TiledRaster;

/// A stroke that could be painted: a click, or a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokePlan {
    /// The brush.
    pub brush: Brush,
    /// The lines in which the stroke is repeated.
    pub mirror: Mirror,
    /// The point where it begins, in world units.
    pub from: DVec2,
    /// The point where it ends, in world units.
    pub to: DVec2,
}

impl StrokePlan {
    /// Returns a click with a brush at a point in world units.
    pub fn click(brush: Brush, at: DVec2) -> Self {
        Self { brush, mirror: Mirror::default(), from: at, to: at }
    }

    /// Returns whether both ends are finite.
    pub fn is_finite(&self) -> bool {
        self.from.is_finite() && self.to.is_finite()
    }
}

/// A planned stroke, painted in slices on a clone of the raster.
#[derive(Clone, Debug)]
pub struct Preview {
    stroke: Stroke,
    raster: TiledRaster,
    changed: Vec<Repaint>,
}

impl Preview {
    /// Creates a preview in which nothing is painted yet. `h_max` is the largest target diameter, in world
    /// units; paint reaches no further than `bounds`.
    pub fn new(plan: &StrokePlan, h_max: f64, bounds: Rect, raster: &TiledRaster) -> Self {
        let mut stroke = Stroke::new(plan.brush, h_max, bounds).mirrored(plan.mirror);
        [plan.from, plan.to].into_iter().for_each(|end| stroke.extend(raster, end));
        Self { stroke, raster: raster.clone(), changed: Vec::new() }
    }

    /// Paints about `pixels` more pixels. Returns whether everything is painted.
    pub fn advance(&mut self, pixels: usize) -> bool {
        self.changed.extend(self.stroke.advance(&mut self.raster, pixels));
        self.stroke.is_drawn()
    }

    /// Returns the raster after the stroke, and the areas where it differs.
    pub fn finish(mut self) -> (TiledRaster, Vec<Repaint>) {
        while !self.advance(usize::MAX) {}
        self.stroke.finish(&mut self.raster);
        (self.raster, self.changed)
    }
}
