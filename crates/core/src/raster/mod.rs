//! Rasters: row-major grids of values over a rectangle, the lowest row first; sparse rasters of any depth;
//! and the ranges of their values over squares of any size.

mod linear;
mod nearest;
mod projected;
mod pyramid;
mod ranges;
mod sample;
mod tiled;
mod values;

use std::ops::Range;

use glam::DVec2;

use crate::geometry::Rect;

pub use nearest::NearestPixel;
pub use projected::{ProjectedRasterError, Resampling, projected_raster, resampled_raster};
pub use pyramid::{RasterPyramid, SquareValues};
pub use ranges::{PixelGrid, ValueRange, ValueRanges, exponent, power_of_two};
pub use tiled::{TILE, Tile, TilePlace, TiledRaster};
pub use values::{RasterValues, check_values};

/// Largest number of pixels along a side of a raster.
pub const LONGEST_SIDE: u32 = 65_536;

/// Largest number of pixels of a raster.
pub const MOST_PIXELS: u64 = 200_000_000;

/// Returns whether a raster may have `size` = [columns, rows].
pub fn is_raster_size(size: [u32; 2]) -> bool {
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    size.iter().all(|side| (1..=LONGEST_SIDE).contains(side)) && pixels <= MOST_PIXELS
}

/// A half-open rectangle of pixels. Column 0 is the leftmost, row 0 the lowest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// First column and row.
    pub min: [u32; 2],
    /// One past the last column and row.
    pub max: [u32; 2],
}

impl PixelRect {
    /// Returns whether the rectangle has no pixel.
    pub fn is_empty(&self) -> bool {
        self.min[0] >= self.max[0] || self.min[1] >= self.max[1]
    }

    /// Returns whether the pixel in column `x` and row `y` is in the rectangle.
    pub fn contains(&self, x: u32, y: u32) -> bool {
        (self.min[0]..self.max[0]).contains(&x) && (self.min[1]..self.max[1]).contains(&y)
    }

    /// Returns the smallest rectangle that contains this one and another.
    pub fn union(&self, other: &Self) -> Self {
        if self.is_empty() {
            return *other;
        }
        if other.is_empty() {
            return *self;
        }
        let [x0, y0] = [self.min[0].min(other.min[0]), self.min[1].min(other.min[1])];
        let [x1, y1] = [self.max[0].max(other.max[0]), self.max[1].max(other.max[1])];
        Self { min: [x0, y0], max: [x1, y1] }
    }

    /// Returns (column, row) of every pixel, row by row from the lowest.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.min[1]..self.max[1]).flat_map(move |y| (self.min[0]..self.max[0]).map(move |x| (x, y)))
    }
}

/// A grid of values over a rectangle in world units, constant within each pixel. Values are stored row by
/// row, the lowest row first, each from left to right:
///
/// ```text
///        bounds.max
///   +---+---+---+
///   | 3 | 4 | 5 |   row 1        values[row * size[0] + column]
///   +---+---+---+
///   | 0 | 1 | 2 |   row 0        size = [columns, rows] = [3, 2]
///   +---+---+---+
/// bounds.min
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Raster<T = f32> {
    bounds: Rect,
    size: [u32; 2],
    values: Vec<T>,
}

impl<T: Copy> Raster<T> {
    /// Returns a raster with the same value everywhere; `size` is [columns, rows].
    ///
    /// # Panics
    /// Panics when [`is_raster_size`] is false.
    pub fn filled(bounds: Rect, size: [u32; 2], value: T) -> Self {
        Self::from_values(bounds, size, vec![value; size[0] as usize * size[1] as usize])
    }

    /// Returns a raster with the given values, row by row from the lowest; `size` is [columns, rows].
    ///
    /// # Panics
    /// Panics when [`is_raster_size`] is false, or the number of values is not columns times rows.
    pub fn from_values(bounds: Rect, size: [u32; 2], values: Vec<T>) -> Self {
        assert!(is_raster_size(size), "sizes are checked where a raster is read");
        assert_eq!(values.len(), size[0] as usize * size[1] as usize);
        Self { bounds, size, values }
    }

    /// Returns the rectangle covered, in world units.
    pub fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Returns [columns, rows].
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns all values, row by row from the lowest.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Returns memory of the values, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.values)
    }

    /// Returns the values of an area, row by row from the lowest.
    ///
    /// # Panics
    /// Panics when the area is not within the raster.
    pub fn rows(&self, area: PixelRect) -> impl Iterator<Item = &[T]> {
        let [first, last] = [area.min[1], area.max[1]].map(|y| y as usize * self.size[0] as usize);
        let columns = area.min[0] as usize..area.max[0] as usize;
        self.values[first..last].chunks_exact(self.size[0] as usize).map(move |row| &row[columns.clone()])
    }

    /// Returns the values of an area for changing, row by row from the lowest.
    ///
    /// # Panics
    /// Panics when the area is not within the raster.
    pub fn rows_mut(&mut self, area: PixelRect) -> impl Iterator<Item = &mut [T]> {
        let [first, last] = [area.min[1], area.max[1]].map(|y| y as usize * self.size[0] as usize);
        let columns = area.min[0] as usize..area.max[0] as usize;
        self.values[first..last]
            .chunks_exact_mut(self.size[0] as usize)
            .map(move |row| &mut row[columns.clone()])
    }

    /// Returns the rectangle of all pixels.
    pub fn all(&self) -> PixelRect {
        PixelRect { min: [0, 0], max: self.size }
    }

    /// Returns the value of the pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// May panic when the pixel is outside the raster: only the index of the value is checked.
    #[inline]
    pub fn get(&self, x: u32, y: u32) -> T {
        self.values[y as usize * self.size[0] as usize + x as usize]
    }

    /// Sets the pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// May panic when the pixel is outside the raster: only the index of the value is checked.
    #[inline]
    pub fn set(&mut self, x: u32, y: u32, value: T) {
        self.values[y as usize * self.size[0] as usize + x as usize] = value;
    }

    /// Returns the values of row `y` in a range of columns.
    ///
    /// # Panics
    /// Panics when the columns or the row are outside the raster.
    #[inline]
    pub fn row(&self, y: u32, columns: Range<u32>) -> &[T] {
        &self.values[self.places(y, columns)]
    }

    /// Returns the values of row `y` in a range of columns, for changing.
    ///
    /// # Panics
    /// Panics when the columns or the row are outside the raster.
    #[inline]
    pub fn row_mut(&mut self, y: u32, columns: Range<u32>) -> &mut [T] {
        let places = self.places(y, columns);
        &mut self.values[places]
    }

    fn places(&self, y: u32, columns: Range<u32>) -> Range<usize> {
        let start = y as usize * self.size[0] as usize;
        start + columns.start as usize..start + columns.end as usize
    }

    /// Returns width and height of a pixel in world units.
    pub fn pixel_size(&self) -> DVec2 {
        self.bounds.size() / DVec2::new(f64::from(self.size[0]), f64::from(self.size[1]))
    }

    /// Returns the centre of a pixel in world units.
    #[inline]
    pub fn pixel_center(&self, x: u32, y: u32) -> DVec2 {
        self.pixel_centers()(x, y)
    }

    /// Returns a function that computes [`Self::pixel_center`], for many pixels.
    #[inline]
    pub fn pixel_centers(&self) -> impl Fn(u32, u32) -> DVec2 + use<T> {
        let (min, pixel) = (self.bounds.min, self.pixel_size());
        move |x, y| min + DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) * pixel
    }

    /// Returns a point in world units in units of pixels: its floor is (column, row).
    pub fn pixel_from_world(&self, point: DVec2) -> DVec2 {
        (point - self.bounds.min) / self.pixel_size()
    }

    /// Returns the value at a point in world units, `None` outside the bounds. On a line between pixels the
    /// right or upper pixel counts.
    pub fn sample(&self, point: DVec2) -> Option<T> {
        Some(self.get(self.pixel_under(point, 0)?, self.pixel_under(point, 1)?))
    }

    /// Returns the pixels of the raster that touch a rectangle in world units.
    pub fn pixels_touching(&self, area: &Rect) -> PixelRect {
        let low = self.pixel_from_world(area.min).floor();
        let high = self.pixel_from_world(area.max).floor() + 1.0;
        let clamp = |v: DVec2| {
            [v.x.clamp(0.0, f64::from(self.size[0])) as u32, v.y.clamp(0.0, f64::from(self.size[1])) as u32]
        };
        PixelRect { min: clamp(low), max: clamp(high) }
    }

    /// Returns this raster over other bounds and with another size. Each new pixel takes the value at its
    /// centre, or `outside` where this raster has none.
    pub fn resampled(&self, bounds: Rect, size: [u32; 2], outside: T) -> Self {
        let mut new = Self::filled(bounds, size, outside);
        // The old column depends on the new column only, and so does the row: each is looked up once.
        let column_under = |x| self.pixel_under(new.pixel_center(x, 0), 0);
        let row_under = |y| self.pixel_under(new.pixel_center(0, y), 1);
        let rows: Vec<_> = (0..size[1]).map(row_under).collect();
        // The new columns within this raster are consecutive.
        let left = (0..size[0]).take_while(|&x| column_under(x).is_none()).count();
        let columns: Vec<u32> = (left as u32..size[0]).map_while(column_under).collect();
        let (old_width, width) = (self.size[0] as usize, size[0] as usize);
        for (y, row) in rows.iter().enumerate() {
            let Some(row) = *row else { continue };
            let (done, rest) = new.values.split_at_mut(y * width);
            let to = &mut rest[left..left + columns.len()];
            // Enlarging gives runs of equal rows: copy the previous row.
            if y > 0 && rows[y - 1] == Some(row) {
                to.copy_from_slice(&done[(y - 1) * width + left..][..columns.len()]);
                continue;
            }
            let from = &self.values[row as usize * old_width..][..old_width];
            to.iter_mut().zip(&columns).for_each(|(value, &column)| *value = from[column as usize]);
        }
        new
    }

    /// Column (axis 0) or row (axis 1) at a point in world units, `None` outside the bounds.
    fn pixel_under(&self, point: DVec2, axis: usize) -> Option<u32> {
        let inside = (self.bounds.min[axis]..=self.bounds.max[axis]).contains(&point[axis]);
        inside.then(|| (self.pixel_from_world(point)[axis] as u32).min(self.size[axis] - 1))
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn resampling_takes_the_value_at_the_centre_of_each_new_pixel() {
        let mut random = fastrand::Rng::with_seed(9);
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..300 {
            let size = [0, 0].map(|_| random.u32(1..40));
            let values = (0..size[0] * size[1]).map(|_| random.u32(..)).collect();
            let raster = Raster::from_values(Rect::new(DVec2::ZERO, dvec2(3.0, 2.0)), size, values);
            let corner = dvec2(random.f64() * 5.0 - 1.5, random.f64() * 4.0 - 1.5);
            let sides = dvec2(0.1 + 4.0 * random.f64(), 0.1 + 4.0 * random.f64());
            let bounds =
                if random.u8(..4) == 0 { raster.bounds() } else { Rect::new(corner, corner + sides) };
            let new = raster.resampled(bounds, [0, 0].map(|_| random.u32(1..90)), 7);
            for (x, y) in new.all().pixels() {
                let under = raster.sample(new.pixel_center(x, y));
                assert_eq!(new.get(x, y), under.unwrap_or(7));
                *(if under.is_some() { &mut inside } else { &mut outside }) += 1;
            }
        }
        assert!(inside > 50_000 && outside > 50_000, "{inside} {outside}");
    }
}
