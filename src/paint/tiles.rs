use std::collections::BTreeMap;

use super::PaintRasters;
use crate::raster::{PixelRect, Raster};

/// Pixels along the side of a tile.
pub const TILE: u32 = 64;

/// Column and row of a tile.
pub type TilePlace = [u32; 2];

/// Some tiles of the painted layers, by their places.
pub type Tiles = BTreeMap<TilePlace, TilePixels>;

/// Old pixels of the tiles that a gesture touched: enough to take it back, and then to do it again.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    tiles: BTreeMap<TilePlace, TilePixels>,
}

/// The pixels of one tile, row by row, cut off at the raster's edge.
#[derive(Clone, Debug, PartialEq)]
pub struct TilePixels {
    /// Risk, 0 to 1.
    pub risk: Box<[f32]>,
    /// Target diameter in world units, infinite where nothing is painted.
    pub diameter: Box<[f32]>,
}

impl Patch {
    pub(super) fn from_tiles(tiles: BTreeMap<TilePlace, TilePixels>) -> Self {
        Self { tiles }
    }

    /// Exchanges the kept pixels with those of the layers: once takes the gesture back, twice changes nothing. Returns
    /// the pixels exchanged, a rectangle for each tile: a long stroke touches far fewer than lie in its bounds.
    pub fn exchange(&mut self, layers: &mut PaintRasters) -> Vec<PixelRect> {
        let size = layers.risk.size();
        for (&place, old) in &mut self.tiles {
            let area = tile_area(place, size);
            exchange_pixels(&mut layers.risk, area, &mut old.risk);
            exchange_pixels(&mut layers.diameter, area, &mut old.diameter);
        }
        self.tiles.keys().map(|&place| tile_area(place, size)).collect()
    }

    /// Whether the gesture touched nothing.
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Memory taken, in bytes.
    pub fn bytes(&self) -> usize {
        self.tiles.values().map(|t| size_of_val(&*t.risk) + size_of_val(&*t.diameter)).sum()
    }
}

impl TilePixels {
    pub(super) fn copied(layers: &PaintRasters, place: TilePlace) -> Self {
        let area = tile_area(place, layers.risk.size());
        let copy = |raster: &Raster| raster.rows(area).collect::<Vec<_>>().concat().into();
        Self { risk: copy(&layers.risk), diameter: copy(&layers.diameter) }
    }
}

impl PaintRasters {
    /// The tiles on which something is painted.
    pub fn painted_tiles(&self) -> Tiles {
        let size = self.risk.size();
        let painted = |&place: &TilePlace| {
            let area = tile_area(place, size);
            self.risk.rows(area).any(|row| row.iter().any(|&risk| risk != 0.0))
                || self.diameter.rows(area).any(|row| row.iter().any(|diameter| diameter.is_finite()))
        };
        self.tiles(tiles_touching(self.risk.all()).filter(painted))
    }

    /// The tiles at the given places, painted or not.
    pub fn tiles(&self, places: impl IntoIterator<Item = TilePlace>) -> Tiles {
        places.into_iter().map(|place| (place, TilePixels::copied(self, place))).collect()
    }

    /// Puts tiles in their places.
    ///
    /// # Panics
    /// When one does not fit: its place is beyond the layers, or its count of pixels another.
    pub fn put_tiles(&mut self, tiles: &Tiles) {
        for (&place, tile) in tiles {
            let area = tile_area(place, self.risk.size());
            put_pixels(&mut self.risk, area, &tile.risk);
            put_pixels(&mut self.diameter, area, &tile.diameter);
        }
    }
}

/// The pixels of a tile of a raster with the given columns and rows.
pub fn tile_area(place: TilePlace, size: [u32; 2]) -> PixelRect {
    let min = place.map(|n| n * TILE);
    PixelRect { min, max: [(min[0] + TILE).min(size[0]), (min[1] + TILE).min(size[1])] }
}

/// The tiles that a rectangle of pixels touches.
pub fn tiles_touching(area: PixelRect) -> impl Iterator<Item = TilePlace> {
    let tiles = PixelRect { min: area.min.map(|n| n / TILE), max: area.max.map(|n| n.div_ceil(TILE)) };
    tiles.pixels().map(|(x, y)| [x, y])
}

fn exchange_pixels(raster: &mut Raster, area: PixelRect, kept: &mut [f32]) {
    let columns = area.max[0] - area.min[0];
    for (row, kept) in raster.rows_mut(area).zip(kept.chunks_exact_mut(columns as usize)) {
        row.swap_with_slice(kept);
    }
}

fn put_pixels(raster: &mut Raster, area: PixelRect, pixels: &[f32]) {
    assert_eq!(area.pixels().count(), pixels.len(), "a tile fits its place");
    let columns = area.max[0] - area.min[0];
    for (row, pixels) in raster.rows_mut(area).zip(pixels.chunks_exact(columns as usize)) {
        row.copy_from_slice(pixels);
    }
}
