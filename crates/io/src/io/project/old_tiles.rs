//! The paint of projects of version 1: tiles of two rasters over the domain's bounds.

use std::collections::BTreeMap;

use meshbrush_core::raster::PixelRect;

/// Side of a tile in pixels.
pub const TILE: u32 = 64;

/// Column and row of a tile; tile [0, 0] has the lowest left pixels.
pub type TilePlace = [u32; 2];

/// Some tiles of the rasters, by column and row.
pub type Tiles = BTreeMap<TilePlace, TilePixels>;

/// The pixels of one tile, row by row from the lowest. Tiles at the upper and right edge of the rasters have
/// fewer.
#[derive(Clone, Debug, PartialEq)]
pub struct TilePixels {
    /// Risk, 0 to 1.
    pub risk: Box<[f32]>,
    /// Target diameter in world units, infinite where nothing is painted.
    pub diameter: Box<[f32]>,
}

/// Returns the pixels of a tile, in a raster of `size` = [columns, rows].
pub fn tile_area(place: TilePlace, size: [u32; 2]) -> PixelRect {
    let min = place.map(|n| n * TILE);
    PixelRect { min, max: [(min[0] + TILE).min(size[0]), (min[1] + TILE).min(size[1])] }
}
