use std::collections::BTreeMap;

use super::PaintRasters;
use crate::raster::{PixelRect, Raster};

/// Side of a tile in pixels. Undo, saving and the journal keep paint tile by tile.
pub const TILE: u32 = 64;

/// Column and row of a tile; tile [0, 0] has the lowest left pixels.
pub type TilePlace = [u32; 2];

/// Some tiles of the paint rasters, by column and row.
pub type Tiles = BTreeMap<TilePlace, TilePixels>;

/// The pixels before a stroke of all tiles that it touched: enough to undo the stroke and to redo it.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    tiles: BTreeMap<TilePlace, TilePixels>,
}

/// The pixels of one tile, row by row from the lowest. Tiles at the upper and right edge of the rasters have
/// fewer.
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

    /// Exchanges the kept pixels with those of the rasters: the first call undoes the stroke, the second
    /// redoes it.
    ///
    /// Returns the exchanged pixels, one rectangle for each tile: a long stroke touches far fewer than its
    /// bounding rectangle has.
    pub fn exchange(&mut self, paint: &mut PaintRasters) -> Vec<PixelRect> {
        let size = paint.risk.size();
        for (&place, old) in &mut self.tiles {
            let area = tile_area(place, size);
            exchange_pixels(&mut paint.risk, area, &mut old.risk);
            exchange_pixels(&mut paint.diameter, area, &mut old.diameter);
        }
        self.tiles.keys().map(|&place| tile_area(place, size)).collect()
    }

    /// Whether the stroke touched nothing.
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Memory of the pixels, in bytes.
    pub fn bytes(&self) -> usize {
        self.tiles.values().map(|t| size_of_val(&*t.risk) + size_of_val(&*t.diameter)).sum()
    }
}

impl TilePixels {
    pub(super) fn copied(paint: &PaintRasters, place: TilePlace) -> Self {
        let area = tile_area(place, paint.risk.size());
        let copy = |raster: &Raster| raster.rows(area).collect::<Vec<_>>().concat().into();
        Self { risk: copy(&paint.risk), diameter: copy(&paint.diameter) }
    }
}

impl PaintRasters {
    /// The tiles with paint on them.
    pub fn painted_tiles(&self) -> Tiles {
        let size = self.risk.size();
        let painted = |&place: &TilePlace| {
            let area = tile_area(place, size);
            self.risk.rows(area).any(|row| row.iter().any(|&risk| risk != 0.0))
                || self.diameter.rows(area).any(|row| row.iter().any(|diameter| diameter.is_finite()))
        };
        self.tiles(tiles_touching(self.risk.all()).filter(painted))
    }

    /// Copies of the tiles at the given places, painted or not.
    pub fn tiles(&self, places: impl IntoIterator<Item = TilePlace>) -> Tiles {
        places.into_iter().map(|place| (place, TilePixels::copied(self, place))).collect()
    }

    /// Overwrites the pixels of these tiles.
    ///
    /// # Panics
    /// When a tile lies outside the rasters, or has more or fewer pixels than its place.
    pub fn put_tiles(&mut self, tiles: &Tiles) {
        for (&place, tile) in tiles {
            let area = tile_area(place, self.risk.size());
            put_pixels(&mut self.risk, area, &tile.risk);
            put_pixels(&mut self.diameter, area, &tile.diameter);
        }
    }
}

/// The pixels of a tile, in a raster of `size` = [columns, rows].
pub fn tile_area(place: TilePlace, size: [u32; 2]) -> PixelRect {
    let min = place.map(|n| n * TILE);
    PixelRect { min, max: [(min[0] + TILE).min(size[0]), (min[1] + TILE).min(size[1])] }
}

/// The tiles that have pixels in a rectangle, row by row.
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
    assert_eq!(area.pixels().count(), pixels.len(), "a tile has as many pixels as its place");
    let columns = area.max[0] - area.min[0];
    for (row, pixels) in raster.rows_mut(area).zip(pixels.chunks_exact(columns as usize)) {
        row.copy_from_slice(pixels);
    }
}
