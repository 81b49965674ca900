//! A sparse raster of any depth: tiles of 32 × 32 pixels where something is painted, and finer tiles over
//! them where something finer is painted.

mod blocks;
mod difference;
mod summary;
mod tile;

use std::sync::Arc;

use glam::DVec2;

use super::{PixelGrid, ValueRange, ValueRanges, power_of_two};
use blocks::Blocks;
use summary::{Summary, TileExtent};
use tile::index;

pub use tile::{TILE, Tile, TilePlace};

/// A raster without bounds and without a smallest pixel. Clones share all tiles.
///
/// ```text
/// depth 0   +-------+-------+     A tile of depth d + 1 covers a quadrant of its parent, which exists too,
///           |       |       |     and counts there instead of the parent. Where no tile is, the value is
///           |   +---+       |     that of a blank raster.
///           |   |d 1|       |
///           +---+---+-------+
/// ```
///
/// Beside the tiles, the raster keeps a pyramid of ranges of values over squares of any size, which follows
/// each change of a tile.
#[derive(Clone, Debug)]
pub struct TiledRaster {
    grid: PixelGrid,
    blank: f32,
    /// The tiles of each depth. The last depth has tiles.
    depths: Vec<Arc<Blocks<TileNode>>>,
    /// The ranges of scale 1, 2 … up to the coarsest, see [`ValueRanges`].
    scales: Vec<Arc<Blocks<Arc<Summary>>>>,
    /// The rectangle of the tiles of depth 0.
    extent: Option<TileExtent>,
    /// The range of all values.
    whole: ValueRange,
}

/// A tile, and the ranges of its pixels if it has children.
#[derive(Clone, Debug)]
struct TileNode {
    tile: Arc<Tile>,
    summary: Option<Arc<Summary>>,
}

impl TileNode {
    #[inline]
    fn range(&self, index: usize) -> ValueRange {
        match &self.summary {
            Some(summary) => summary[index],
            None => ValueRange::one(self.tile[index]),
        }
    }
}

impl TiledRaster {
    /// Creates a raster with the value `blank` everywhere. `grid` places the pixels of depth 0.
    pub fn new(grid: PixelGrid, blank: f32) -> Self {
        let whole = ValueRange::one(blank);
        Self { grid, blank, depths: Vec::new(), scales: Vec::new(), extent: None, whole }
    }

    /// Creates a raster with the given tiles, parents before their children.
    ///
    /// # Errors
    /// Fails with the place of the first tile that is beyond the limits or has no parent.
    pub fn from_tiles(
        grid: PixelGrid,
        blank: f32,
        tiles: impl IntoIterator<Item = (TilePlace, Arc<Tile>)>,
    ) -> Result<Self, TilePlace> {
        let mut raster = Self::new(grid, blank);
        for (place, tile) in tiles {
            if !place.is_valid() || place.parent().is_some_and(|parent| raster.tile(parent).is_none()) {
                return Err(place);
            }
            raster.exchange(place, Some(tile));
        }
        Ok(raster)
    }

    /// Returns the value of points that are not painted.
    pub fn blank(&self) -> f32 {
        self.blank
    }

    /// Returns whether the raster has the blank value everywhere.
    pub fn is_blank(&self) -> bool {
        self.whole_range().is_one()
    }

    /// Returns the value at a point in world units. On a line between pixels the right or upper pixel counts.
    pub fn sample(&self, point: DVec2) -> f32 {
        let pixel = self.grid.pixel_from_world(point);
        let mut value = self.blank;
        for depth in 0..self.depths.len() {
            let [x, y] = (pixel * power_of_two(depth as i32)).floor().to_array().map(|n| n as i32);
            let Some(node) = self.node(depth, x, y) else { break };
            value = node.tile[index(x, y)];
            if node.summary.is_none() {
                break;
            }
        }
        value
    }

    /// Returns the tile at a place.
    pub fn tile(&self, place: TilePlace) -> Option<&Arc<Tile>> {
        self.depths.get(usize::from(place.depth))?.get(place.x, place.y).map(|node| &node.tile)
    }

    /// Returns all tiles, in the order of their places.
    pub fn tiles(&self) -> impl Iterator<Item = (TilePlace, &Arc<Tile>)> {
        self.depths.iter().enumerate().flat_map(|(depth, tiles)| {
            let mut sorted: Vec<_> = tiles.iter().map(|(block, node)| (block, &node.tile)).collect();
            sorted.sort_unstable_by_key(|(block, _)| *block);
            sorted.into_iter().map(move |([x, y], tile)| (TilePlace { depth: depth as u8, x, y }, tile))
        })
    }

    /// Returns the initial values of a new tile at a place: those of its parent, or blank if it has no
    /// parent.
    pub fn inherited(&self, place: TilePlace) -> Tile {
        let parent = place.parent().and_then(|parent| self.tile(parent));
        parent.map_or(Tile::filled(self.blank), |parent| parent.enlarged(&place))
    }

    /// Returns whether the tile at a place can be merged into its parent without changing any value: half its
    /// resolution is enough, or, at depth 0, the tile is blank.
    pub fn is_redundant(&self, place: TilePlace) -> bool {
        let node = self.node(usize::from(place.depth), place.x * TILE, place.y * TILE);
        node.is_some_and(|node| {
            let is_blank = || node.tile.values().iter().all(|&value| value == self.blank);
            node.summary.is_none() && if place.depth == 0 { is_blank() } else { node.tile.is_enlarged() }
        })
    }

    /// Removes a redundant tile; its parent takes over its values.
    ///
    /// # Panics
    /// Panics when the tile has children.
    pub fn merge(&mut self, place: TilePlace) {
        let Some(tile) = self.exchange(place, None) else { return };
        if let Some(parent) = place.parent() {
            self.change(parent, |parent| parent.put_reduced(&place, &tile));
        }
    }

    /// Returns number of tiles.
    pub fn tile_count(&self) -> usize {
        self.depths.iter().map(|tiles| tiles.len()).sum()
    }

    /// Returns memory of tiles and ranges, in bytes. Tiles that clones share are counted for each clone.
    pub fn bytes(&self) -> usize {
        let of_node =
            |node: &TileNode| size_of::<Tile>() + node.summary.as_ref().map_or(0, |s| size_of_val(&**s));
        let tiles =
            self.depths.iter().flat_map(|tiles| tiles.iter()).map(|(_, node)| of_node(node)).sum::<usize>();
        tiles + self.scales.iter().map(|ranges| ranges.len() * size_of::<Summary>()).sum::<usize>()
    }

    /// Returns the deepest tile, of at most the given depth, that contains the pixel in column `x` and row
    /// `y` of that depth, and the index of the pixel in it.
    #[inline]
    fn deepest_at(&self, depth: usize, x: i32, y: i32) -> Option<(&TileNode, usize)> {
        // Try depth 0 first: most tiles have no children.
        let (node, index) = self.ancestor(depth, 0, x, y)?;
        if depth == 0 || node.summary.is_none() {
            return Some((node, index));
        }
        let at = |to| self.ancestor(depth, to, x, y);
        at(depth).or_else(|| {
            // A tile has all its ancestors, so bisect between a depth with a tile and one without.
            let (mut found, mut with, mut without) = ((node, index), 0, depth.min(self.depths.len()));
            while without - with > 1 && found.0.summary.is_some() {
                let middle = (with + without) / 2;
                match at(middle) {
                    Some(deeper) => (with, found) = (middle, deeper),
                    None => without = middle,
                }
            }
            // No child covers the pixel, so its own value counts.
            Some(found)
        })
    }

    /// Returns the deepest tile, of at most the given depth, over the tile with the pixel in column `x` and
    /// row `y` of that depth, and how many depths it is above it.
    fn deepest_over(&self, depth: usize, x: i32, y: i32) -> Option<(&TileNode, usize)> {
        let deepest = depth.min(self.depths.len().saturating_sub(1));
        (0..=deepest).rev().find_map(|to| Some((self.ancestor(depth, to, x, y)?.0, depth - to)))
    }

    /// Returns the range of all values, found from the ranges of the largest squares.
    fn range_of_all(&self) -> ValueRange {
        let coarsest = self.coarsest();
        let squares = self.extent.iter().flat_map(|extent| extent.squares(coarsest));
        let ranges = squares.map(|[x, y]| self.range(coarsest, x, y));
        ranges.fold(ValueRange::one(self.blank), ValueRange::union)
    }

    /// Returns the tile of depth `to` over the pixel in column `x` and row `y` of a greater depth, and the
    /// index of the pixel in it.
    #[inline]
    fn ancestor(&self, depth: usize, to: usize, x: i32, y: i32) -> Option<(&TileNode, usize)> {
        let up = (depth - to).min(31);
        self.node(to, x >> up, y >> up).map(|node| (node, index(x >> up, y >> up)))
    }

    /// Returns the tile with the pixel in column `x` and row `y` of a depth.
    #[inline]
    fn node(&self, depth: usize, x: i32, y: i32) -> Option<&TileNode> {
        self.depths.get(depth)?.get(x >> TILE.ilog2(), y >> TILE.ilog2())
    }
}

impl ValueRanges for TiledRaster {
    fn grid(&self) -> &PixelGrid {
        &self.grid
    }

    fn coarsest(&self) -> i32 {
        self.scales.len() as i32
    }

    fn finest(&self) -> i32 {
        1 - self.depths.len().max(1) as i32
    }

    #[inline]
    fn range(&self, scale: i32, x: i32, y: i32) -> ValueRange {
        if scale > self.coarsest() {
            return self.range_beyond(scale, x, y);
        }
        if scale > 0 {
            let ranges = &self.scales[scale as usize - 1];
            let found = ranges.get(x >> TILE.ilog2(), y >> TILE.ilog2());
            return found.map_or(ValueRange::one(self.blank), |summary| summary[index(x, y)]);
        }
        let found = self.deepest_at(scale.unsigned_abs() as usize, x, y);
        found.map_or(ValueRange::one(self.blank), |(node, index)| node.range(index))
    }

    fn copy_values(&self, scale: i32, low: [i32; 2], high: [i32; 2], values: &mut [f32]) -> bool {
        let (depth, width) = (scale.unsigned_abs() as usize, (high[0] - low[0] + 1) as usize);
        if scale > 0 || scale < self.finest() {
            return false;
        }
        for tile in tiles_between(low, high) {
            let (tile, [x, y]) = (Span::of_tile(tile, [low, high]), tile.map(|n| n * TILE));
            let found = self.deepest_over(depth, x, y);
            if found.is_some_and(|(node, up)| up == 0 && node.summary.is_some()) {
                return false;
            }
            for row in tile.rows() {
                let at = (row - low[1]) as usize * width + (tile.first[0] - low[0]) as usize;
                let values = &mut values[at..at + tile.width()];
                match found {
                    None => values.fill(self.blank),
                    Some((node, 0)) => {
                        values.copy_from_slice(node.tile.row_from([tile.first[0], row], values.len()))
                    }
                    // No tile is this fine here, so that the square has one value.
                    Some((node, up)) => (tile.first[0]..).zip(values).for_each(|(column, value)| {
                        *value = node.tile[index(column >> up, row >> up)];
                    }),
                }
            }
        }
        true
    }

    fn whole_range(&self) -> ValueRange {
        self.whole
    }
}

/// The pixels of a tile that lie in a rectangle of pixels.
struct Span {
    first: [i32; 2],
    last: [i32; 2],
}

impl Span {
    fn of_tile(tile: [i32; 2], [low, high]: [[i32; 2]; 2]) -> Self {
        let first = [0, 1].map(|axis: usize| low[axis].max(tile[axis] * TILE));
        Self { first, last: [0, 1].map(|axis: usize| high[axis].min(tile[axis] * TILE + TILE - 1)) }
    }

    fn rows(&self) -> std::ops::RangeInclusive<i32> {
        self.first[1]..=self.last[1]
    }

    fn width(&self) -> usize {
        (self.last[0] - self.first[0] + 1) as usize
    }
}

/// Returns column and row of the tiles that have pixels from `low` to `high`.
fn tiles_between(low: [i32; 2], high: [i32; 2]) -> impl Iterator<Item = [i32; 2]> {
    let [columns, rows] = [0, 1].map(|axis: usize| low[axis] >> TILE.ilog2()..=high[axis] >> TILE.ilog2());
    rows.flat_map(move |y| columns.clone().map(move |x| [x, y]))
}

/// Rasters are equal if they have equal tiles at the same places.
impl PartialEq for TiledRaster {
    fn eq(&self, other: &Self) -> bool {
        let same = |a: &Arc<Tile>, b: &Arc<Tile>| Arc::ptr_eq(a, b) || a == b;
        let equal_tiles = |a: &Arc<Blocks<TileNode>>, b: &Arc<Blocks<TileNode>>| {
            Arc::ptr_eq(a, b) || a.equal_by(b, |a, b| same(&a.tile, &b.tile))
        };
        let depths = self.depths.len() == other.depths.len();
        let pairs = self.depths.iter().zip(&other.depths);
        self.grid == other.grid && self.blank == other.blank && depths && { pairs }
            .all(|(a, b)| equal_tiles(a, b))
    }
}

#[cfg(test)]
mod tests;
