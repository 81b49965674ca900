//! Brush and stroke as data, and stamping a stroke into the painted layers.

mod stroke;
mod tiles;

use glam::DVec2;

use crate::field::PaintRef;
use crate::geometry::Rect;
use crate::raster::Raster;

pub use stroke::{Dab, Stroke};
pub use tiles::{Patch, TILE, TilePixels, TilePlace, Tiles, tile_area, tiles_touching};

/// What a brush lays down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Medium {
    /// Risk builds up towards 1, by the brush's strength in each stroke.
    Risk,
    /// The target diameter sinks to this value, in world units; the soft rim grades up to the largest diameter.
    Diameter(f64),
    /// Takes away what was painted, of both kinds.
    Eraser,
}

/// A round brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// What it lays down.
    pub medium: Medium,
    /// Radius in world units.
    pub radius: f64,
    /// Share of the radius within which it works fully, 0 to 1; from there it fades to the rim.
    pub hardness: f64,
    /// How much of the way one stroke goes, 0 to 1.
    pub strength: f64,
}

impl Brush {
    /// How fully the brush works at a distance from its middle, 0 to 1; distance in world units.
    pub fn coverage(&self, distance: f64) -> f64 {
        let core = self.radius * self.hardness.clamp(0.0, 1.0);
        if distance <= core {
            1.0
        } else if distance >= self.radius {
            0.0
        } else {
            let t = (self.radius - distance) / (self.radius - core);
            t * t * (3.0 - 2.0 * t)
        }
    }

    /// The brush, widened where it is smaller than a pixel so that it always reaches the middle of one.
    fn on(&self, layers: &PaintRasters) -> Self {
        let radius = self.radius.max(0.71 * layers.risk.pixel_size().max_element());
        Self { radius, ..*self }
    }
}

/// What was painted: two rasters over the domain's rectangle.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintRasters {
    /// Risk, 0 to 1.
    pub risk: Raster,
    /// Target diameter in world units, infinite where nothing is painted.
    pub diameter: Raster,
}

impl PaintRasters {
    /// PaintRasters with nothing on them; `size` is columns and rows.
    pub fn blank(bounds: Rect, size: [u32; 2]) -> Self {
        Self {
            risk: Raster::filled(bounds, size, 0.0),
            diameter: Raster::filled(bounds, size, f32::INFINITY),
        }
    }

    /// The same paint on another grid. What lies beyond `bounds` is lost.
    pub fn resampled(&self, bounds: Rect, size: [u32; 2]) -> Self {
        Self {
            risk: self.risk.resampled(bounds, size, 0.0),
            diameter: self.diameter.resampled(bounds, size, f32::INFINITY),
        }
    }

    /// As the field reads them.
    pub fn as_paint(&self) -> PaintRef<'_> {
        PaintRef { risk: &self.risk, diameter: &self.diameter }
    }

    /// Whether anything is painted.
    pub fn is_blank(&self) -> bool {
        self.risk.values().iter().all(|&r| r == 0.0) && self.diameter.values().iter().all(|d| d.is_infinite())
    }
}

/// Distance from `point` to the segment from `a` to `b`.
fn distance_to_segment(point: DVec2, a: DVec2, b: DVec2) -> f64 {
    let (along, from_a) = (b - a, point - a);
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 { (from_a.dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (from_a - along * t).length()
}
