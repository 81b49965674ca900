use std::ops::{Index, IndexMut};

use crate::geometry::Rect;
use crate::raster::PixelGrid;

/// Side of a tile, in pixels.
pub const TILE: i32 = 32;

/// Pixels of a tile.
pub(super) const TILE_PIXELS: usize = (TILE * TILE) as usize;

/// The position of a tile. At depth d, pixels have the width of the grid's pixels divided by 2ᵈ, and the tile
/// covers the pixels [32 x, 32 y] to [32 x + 31, 32 y + 31]. The order is by depth, then x, then y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TilePlace {
    /// Number of times the pixels of the grid are halved.
    pub depth: u8,
    /// Column of tiles of this depth.
    pub x: i32,
    /// Row of tiles of this depth.
    pub y: i32,
}

impl TilePlace {
    /// The greatest depth.
    pub const DEEPEST: u8 = 40;

    /// Limit of the absolute column and row of tiles: the columns and rows of their pixels then fit an i32.
    pub const FARTHEST: i32 = 1 << 25;

    /// Returns the tile that contains the pixel in column `x` and row `y` of the given depth.
    pub fn of_pixel(depth: u8, x: i32, y: i32) -> Self {
        Self { depth, x: x.div_euclid(TILE), y: y.div_euclid(TILE) }
    }

    /// Returns whether depth, column and row are within their limits.
    pub fn is_valid(&self) -> bool {
        let is_near = |n: i32| (-Self::FARTHEST..=Self::FARTHEST).contains(&n);
        self.depth <= Self::DEEPEST && is_near(self.x) && is_near(self.y)
    }

    /// Returns the tile of the next smaller depth that covers this one; `None` at depth 0.
    pub fn parent(&self) -> Option<Self> {
        let depth = self.depth.checked_sub(1)?;
        Some(Self { depth, x: self.x >> 1, y: self.y >> 1 })
    }

    /// Returns the four tiles of the next depth that cover this one, row by row.
    pub fn children(&self) -> [Self; 4] {
        [0, 1, 2, 3].map(|n| Self {
            depth: self.depth + 1,
            x: 2 * self.x + (n & 1),
            y: 2 * self.y + (n >> 1),
        })
    }

    /// Returns the rectangle of the tile, in world units.
    pub fn area(&self, grid: &PixelGrid) -> Rect {
        grid.square(TILE.ilog2() as i32 - i32::from(self.depth), self.x, self.y)
    }

    /// Returns the rectangle of some pixels, in world units. `first` and `end` are column and row within the
    /// tile.
    pub fn area_of_pixels(&self, [first, end]: [[i32; 2]; 2], grid: &PixelGrid) -> Rect {
        let corner =
            |[x, y]: [i32; 2]| grid.square(-i32::from(self.depth), self.x * TILE + x, self.y * TILE + y).min;
        Rect::new(corner(first), corner(end))
    }

    /// Column and row, within the parent, of the first pixel that this tile covers.
    pub(super) fn first_in_parent(&self) -> [i32; 2] {
        [self.x & 1, self.y & 1].map(|n| n * TILE / 2)
    }
}

/// The values of 32 × 32 pixels, row by row from the lowest.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile([f32; TILE_PIXELS]);

impl Tile {
    /// Returns a tile with the same value everywhere.
    pub const fn filled(value: f32) -> Self {
        Self([value; TILE_PIXELS])
    }

    /// Returns the values of `count` pixels from one to the right. Column and row may be those of a pixel of
    /// the raster.
    #[inline]
    pub(super) fn row_from(&self, [x, y]: [i32; 2], count: usize) -> &[f32] {
        let first = index(x, y);
        &self.0[first..first + count]
    }

    /// Returns the values of `count` pixels from one to the right, to be changed.
    #[inline]
    pub(crate) fn row_mut(&mut self, [x, y]: [i32; 2], count: usize) -> &mut [f32] {
        let first = index(x, y);
        &mut self.0[first..first + count]
    }

    /// Returns a tile with the given values; `None` if they are not 32 × 32.
    pub fn from_values(values: &[f32]) -> Option<Self> {
        values.try_into().ok().map(Self)
    }

    /// Returns all values, row by row from the lowest.
    pub fn values(&self) -> &[f32] {
        &self.0
    }

    /// Returns all values as an array.
    pub(super) fn array(&self) -> &[f32; TILE_PIXELS] {
        &self.0
    }

    /// Returns all values, to be changed.
    pub(crate) fn values_mut(&mut self) -> &mut [f32] {
        &mut self.0
    }

    /// Returns the value of the pixel in column `x` and row `y` of the tile.
    pub fn get(&self, x: i32, y: i32) -> f32 {
        self.0[index(x, y)]
    }

    /// Sets the pixel in column `x` and row `y` of the tile.
    pub fn set(&mut self, x: i32, y: i32, value: f32) {
        self.0[index(x, y)] = value;
    }

    /// Returns the part of this tile that lies under one of its children, as a tile of twice the resolution.
    pub fn enlarged(&self, child: &TilePlace) -> Self {
        let [left, lowest] = child.first_in_parent();
        let mut enlarged = Self::filled(0.0);
        for y in 0..TILE {
            (0..TILE).for_each(|x| enlarged.set(x, y, self.get(left + x / 2, lowest + y / 2)));
        }
        enlarged
    }

    /// Returns whether half the resolution is enough: all blocks of 2 × 2 pixels have one value each.
    pub(super) fn is_enlarged(&self) -> bool {
        let mut blocks = (0..TILE).step_by(2).flat_map(|y| (0..TILE).step_by(2).map(move |x| (x, y)));
        blocks.all(|(x, y)| {
            let value = self.get(x, y);
            [(x + 1, y), (x, y + 1), (x + 1, y + 1)].iter().all(|&(x, y)| self.get(x, y) == value)
        })
    }

    /// Returns the smallest rectangle of pixels that contains all pixels in which two tiles differ, see
    /// [`TilePlace::area_of_pixels`]; `None` if they are equal.
    pub fn difference(&self, other: &Self) -> Option<[[i32; 2]; 2]> {
        let differing = (0..TILE_PIXELS).filter(|&index| self.0[index] != other.0[index]);
        let pixels = differing.map(|index| [index as i32 % TILE, index as i32 / TILE]);
        pixels.fold(None, |area, [x, y]| {
            let [first, end] = area.unwrap_or([[x, y], [x + 1, y + 1]]);
            Some([[first[0].min(x), first[1].min(y)], [end[0].max(x + 1), end[1].max(y + 1)]])
        })
    }

    /// Copies the lower left pixel of each block of 2 × 2 pixels of `child` to the quadrant of the child in
    /// this tile.
    pub(super) fn put_reduced(&mut self, place: &TilePlace, child: &Self) {
        let [left, lowest] = place.first_in_parent();
        for y in 0..TILE / 2 {
            (0..TILE / 2).for_each(|x| self.set(left + x, lowest + y, child.get(2 * x, 2 * y)));
        }
    }
}

impl Index<usize> for Tile {
    type Output = f32;

    /// Returns the value at an index into the pixels.
    #[inline]
    fn index(&self, index: usize) -> &f32 {
        &self.0[index]
    }
}

impl IndexMut<usize> for Tile {
    fn index_mut(&mut self, index: usize) -> &mut f32 {
        &mut self.0[index]
    }
}

/// Returns the index of the pixel in column `x` and row `y` of a tile. Columns and rows that are counted from
/// elsewhere are taken modulo 32.
#[inline]
pub(super) fn index(x: i32, y: i32) -> usize {
    ((y & (TILE - 1)) * TILE + (x & (TILE - 1))) as usize
}
