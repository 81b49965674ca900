//! Paint: two rasters, the brush as data, the stroke that stamps it into the rasters, its preview, and old
//! pixels for undo.

mod brush;
mod preview;
mod stroke;
pub mod tiled;
mod tiles;

use crate::field::PaintRef;
use crate::geometry::Rect;
use crate::raster::Raster;

pub use brush::{Brush, DiameterChange, Medium, Mirror, PathPoint};
pub use preview::{Preview, StrokePlan};
pub use stroke::Stroke;
pub use tiles::{Patch, TILE, TilePixels, TilePlace, Tiles, tile_area, tiles_touching};

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
