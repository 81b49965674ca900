//! Paint: two rasters, the brush as data, the stroke that stamps it into the rasters, and old pixels for
//! undo.

mod stroke;
mod tiles;

use glam::DVec2;

use crate::field::PaintRef;
use crate::geometry::Rect;
use crate::raster::Raster;

pub use stroke::{Dab, Stroke};
pub use tiles::{Patch, TILE, TilePixels, TilePlace, Tiles, tile_area, tiles_touching};

/// What a brush does to the pixels under it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Medium {
    /// Raises the risk towards 1, with each stroke by the brush's strength.
    Risk,
    /// Lowers the target diameter to this value, in world units; towards the soft rim the diameter grows to
    /// the largest of the document.
    Diameter(f64),
    /// Removes risk and target diameter.
    Eraser,
}

/// A round brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// What it does to a pixel.
    pub medium: Medium,
    /// Radius in world units.
    pub radius: f64,
    /// Fraction of the radius with full coverage, 0 to 1; from there the coverage falls to 0 at the rim.
    pub hardness: f64,
    /// How far one stroke moves a pixel towards the full effect, 0 to 1.
    pub strength: f64,
}

impl Brush {
    /// Coverage at a distance from the brush's centre, in world units: 1 in the core, 0 at the rim and
    /// beyond.
    pub fn coverage(&self, distance: f64) -> f64 {
        let core = self.radius * self.hardness.clamp(0.0, 1.0);
        if distance <= core {
            1.0
        } else if distance >= self.radius {
            0.0
        } else {
            // Smoothstep from the rim to the core.
            let t = (self.radius - distance) / (self.radius - core);
            t * t * (3.0 - 2.0 * t)
        }
    }

    /// The brush for these rasters: one smaller than a pixel is widened until it always reaches the centre of
    /// a pixel, which is half a diagonal away at most.
    fn on(&self, paint: &PaintRasters) -> Self {
        let radius = self.radius.max(0.71 * paint.risk.pixel_size().max_element());
        Self { radius, ..*self }
    }
}

/// What is painted: two rasters of the same size over the domain's bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintRasters {
    /// Risk, 0 to 1.
    pub risk: Raster,
    /// Target diameter in world units, infinite where nothing is painted.
    pub diameter: Raster,
}

impl PaintRasters {
    /// Rasters with nothing painted; `size` is [columns, rows].
    pub fn blank(bounds: Rect, size: [u32; 2]) -> Self {
        Self {
            risk: Raster::filled(bounds, size, 0.0),
            diameter: Raster::filled(bounds, size, f32::INFINITY),
        }
    }

    /// The same paint on another grid of [columns, rows]. Paint outside `bounds` is lost.
    pub fn resampled(&self, bounds: Rect, size: [u32; 2]) -> Self {
        Self {
            risk: self.risk.resampled(bounds, size, 0.0),
            diameter: self.diameter.resampled(bounds, size, f32::INFINITY),
        }
    }

    /// Memory of the pixels, in bytes.
    pub fn bytes(&self) -> usize {
        self.risk.bytes() + self.diameter.bytes()
    }

    /// The rasters as the field reads them.
    pub fn as_paint(&self) -> PaintRef<'_> {
        PaintRef { risk: &self.risk, diameter: &self.diameter }
    }

    /// Whether nothing is painted.
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
