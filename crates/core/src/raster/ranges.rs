//! The positions of the pixels of a raster, and the range of their values over squares of any size.

use glam::DVec2;

use crate::geometry::Rect;

/// Pixels over the plane: pixel [0, 0] has its lower left corner at `origin`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelGrid {
    /// The lower left corner of pixel [0, 0], in world units.
    pub origin: DVec2,
    /// Width and height of a pixel, in world units.
    pub pixel: DVec2,
}

impl PixelGrid {
    /// Returns the grid of `size` = [columns, rows] pixels that fill `bounds`.
    pub fn filling(bounds: &Rect, size: [u32; 2]) -> Self {
        let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        Self { origin: bounds.min, pixel: bounds.size() / size }
    }

    /// Returns whether the pixels are as large as those of a raster over a proper rectangle, and as near. All
    /// grids that are read are checked with this.
    pub fn is_proper(&self) -> bool {
        let shortest = Rect::SHORTEST_SIDE / f64::from(super::LONGEST_SIDE);
        self.pixel.min_element() >= shortest
            && self.pixel.max_element() <= Rect::LONGEST_SIDE
            && self.origin.abs().max_element() <= Rect::LONGEST_SIDE
            && !(self.pixel.is_nan() || self.origin.is_nan())
    }

    /// Returns the rectangle of the square in column `x` and row `y` at a scale, see [`ValueRanges`], in
    /// world units.
    pub fn square(&self, scale: i32, x: i32, y: i32) -> Rect {
        let side = self.pixel * power_of_two(scale);
        let min = self.origin + DVec2::new(f64::from(x), f64::from(y)) * side;
        Rect::new(min, min + side)
    }

    /// Returns a point in world units in units of pixels: its floor is [column, row].
    pub fn pixel_from_world(&self, point: DVec2) -> DVec2 {
        (point - self.origin) / self.pixel
    }
}

/// Returns 2ⁿ exactly, for n = `exponent`, which must be the exponent of a normal number.
#[inline]
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + i64::from(exponent)) as u64) << 52)
}

/// Returns the exponent of a positive normal number: 2ᵉ ≤ x < 2ᵉ⁺¹.
#[inline]
pub fn exponent(x: f64) -> i32 {
    (x.to_bits() >> 52) as i32 - 1023
}

/// The minimum and the maximum of some values. If they are equal, there is one value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// The least value.
    pub least: f32,
    /// The greatest value.
    pub greatest: f32,
}

impl ValueRange {
    /// Returns the range of one value.
    pub const fn one(value: f32) -> Self {
        Self { least: value, greatest: value }
    }

    /// Returns whether the range has one value only.
    pub fn is_one(&self) -> bool {
        self.least == self.greatest
    }

    /// Returns the range of the values of this range and another.
    pub fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), greatest: self.greatest.max(other.greatest) }
    }
}

/// A raster that knows the range of its values over squares of 1, 2 × 2, 4 × 4 … pixels, and, where it has
/// finer pixels, over squares of ½ × ½, ¼ × ¼ ….
///
/// ```text
/// scale  1: squares of 2 × 2 pixels      +-------+
/// scale  0: pixels of the grid           |   +---+
/// scale -1: quarters of a pixel          |   | + |   square [x, y] at a scale covers the squares
///                                        +---+---+   [2x, 2y] to [2x + 1, 2y + 1] at the scale below
/// ```
///
/// A square has one value, or its four quarters are finer: descending from any square ends at squares with
/// one value.
pub trait ValueRanges {
    /// Returns the grid of the pixels.
    fn grid(&self) -> &PixelGrid;

    /// Returns the scale at which at most 2 × 2 squares cover all pixels that have a value of their own.
    fn coarsest(&self) -> i32;

    /// Returns the range of the values in a square. Beyond the pixels, that is the raster's value for no
    /// target.
    fn range(&self, scale: i32, x: i32, y: i32) -> ValueRange;

    /// Returns the range of all values of the raster.
    fn whole_range(&self) -> ValueRange;

    /// Returns the scale of the finest pixels: no square is finer than those that it lies in.
    fn finest(&self) -> i32 {
        i32::MIN
    }

    /// Writes the values of the squares from [column, row] `low` to `high`, both included, at a scale, row by
    /// row. Returns false where they are not quick to read, or not each of them has one value.
    #[inline]
    fn copy_values(&self, _scale: i32, _low: [i32; 2], _high: [i32; 2], _values: &mut [f32]) -> bool {
        false
    }

    /// Returns the result of [`Self::range`] for a square in any column and row, however far from the pixels.
    #[inline]
    fn range_anywhere(&self, mut scale: i32, [mut x, mut y]: [i64; 2]) -> ValueRange {
        let is_near = |n: i64| i32::try_from(n).is_ok();
        // No pixel is this fine so far from the origin.
        while scale < 0 && !(is_near(x) && is_near(y)) {
            (scale, x, y) = (scale + 1, x >> 1, y >> 1);
        }
        let nearest = |n: i64| n.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
        self.range(scale, nearest(x), nearest(y))
    }
}
