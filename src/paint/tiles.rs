use std::collections::BTreeMap;

use super::Layers;
use crate::raster::{PixelRect, Raster};

/// Pixels along the side of a tile.
pub(super) const TILE: u32 = 64;

/// Column and row of a tile.
pub(super) type TilePlace = [u32; 2];

/// Old pixels of the tiles that a gesture touched: enough to take it back, and then to do it again.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    tiles: BTreeMap<TilePlace, TilePixels>,
}

/// The pixels of one tile, row by row, cut off at the raster's edge.
#[derive(Clone, Debug)]
pub(super) struct TilePixels {
    pub(super) risk: Box<[f32]>,
    pub(super) diameter: Box<[f32]>,
}

impl Patch {
    pub(super) fn from_tiles(tiles: BTreeMap<TilePlace, TilePixels>) -> Self {
        Self { tiles }
    }

    /// Exchanges the kept pixels with those of the layers: once takes the gesture back, twice changes nothing. Returns
    /// the pixels exchanged, a rectangle for each tile: a long stroke touches far fewer than lie in its bounds.
    pub fn exchange(&mut self, layers: &mut Layers) -> Vec<PixelRect> {
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
    pub(super) fn copied(layers: &Layers, place: TilePlace) -> Self {
        let area = tile_area(place, layers.risk.size());
        let copy = |raster: &Raster| area.pixels().map(|(x, y)| raster.get(x, y)).collect();
        Self { risk: copy(&layers.risk), diameter: copy(&layers.diameter) }
    }
}

/// The pixels of a tile of a raster with the given columns and rows.
pub(super) fn tile_area(place: TilePlace, size: [u32; 2]) -> PixelRect {
    let min = place.map(|n| n * TILE);
    PixelRect { min, max: [(min[0] + TILE).min(size[0]), (min[1] + TILE).min(size[1])] }
}

/// The tiles that a rectangle of pixels touches.
pub(super) fn tiles_touching(area: PixelRect) -> impl Iterator<Item = TilePlace> {
    let tiles = PixelRect { min: area.min.map(|n| n / TILE), max: area.max.map(|n| n.div_ceil(TILE)) };
    tiles.pixels().map(|(x, y)| [x, y])
}

fn exchange_pixels(raster: &mut Raster, area: PixelRect, kept: &mut [f32]) {
    for ((x, y), kept) in area.pixels().zip(kept) {
        let current = raster.get(x, y);
        raster.set(x, y, *kept);
        *kept = current;
    }
}
