//! The max-mipmap: is a value above a limit under this triangle?

use std::ops::Range;

use super::{MAX_SIDE, PixelRect, Raster};
use crate::geometry::{Lattice, LatticePoint, LatticeRect};

/// Maxima of a raster over squares of 1, 2 × 2, 4 × 4 … pixels.
///
/// ```text
/// level 2          level 1           level 0: the raster
///                                    +---+---+---+---+
/// +-------+        +---+---+         | 0 | 3 | 1 | 0 |
/// |       |        | 3 | 1 |         +---+---+---+---+
/// |   7   |  <---  +---+---+  <---   | 2 | 0 | 0 | 1 |      each value is the maximum of the
/// |       |        | 5 | 7 |         +---+---+---+---+      up to four values that it covers
/// +-------+        +---+---+         | 5 | 0 | 0 | 0 |      on the level below
///                                    +---+---+---+---+
///                                    | 1 | 0 | 7 | 4 |
///                                    +---+---+---+---+
/// ```
///
/// A query descends from the level where the triangle spans about two squares. It skips a square whose
/// maximum is not above the limit, or that does not touch the triangle; it ends at a square within the
/// triangle whose maximum is above. An update takes time proportional to the pixels that change.
#[derive(Clone, Debug)]
pub struct MaxMipmap<T = u8> {
    /// From the raster itself (level 0) to a single value.
    levels: Vec<MipmapLevel<T>>,
}

/// The maxima over squares of one size, row by row from the lowest.
#[derive(Clone, Debug)]
struct MipmapLevel<T> {
    /// [columns, rows].
    size: [u32; 2],
    values: Vec<T>,
}

impl<T: Copy> MipmapLevel<T> {
    #[inline]
    fn get(&self, x: u32, y: u32) -> T {
        self.values[y as usize * self.size[0] as usize + x as usize]
    }

    #[inline]
    fn row(&self, y: u32, columns: Range<u32>) -> &[T] {
        &self.values[self.places(y, columns)]
    }

    #[inline]
    fn row_mut(&mut self, y: u32, columns: Range<u32>) -> &mut [T] {
        let places = self.places(y, columns);
        &mut self.values[places]
    }

    fn places(&self, y: u32, columns: Range<u32>) -> Range<usize> {
        let start = y as usize * self.size[0] as usize;
        start + columns.start as usize..start + columns.end as usize
    }
}

impl<T: Copy + PartialOrd> MipmapLevel<T> {
    /// The maxima over squares of 2 × 2 values, for row `y` of the next level from column `x` on. At the
    /// right and upper rim a square may have one column or row only.
    fn maxima_of_row(&self, y: u32, x: u32, maxima: &mut [T]) {
        let columns = 2 * x..self.size[0].min(2 * (x + maxima.len() as u32));
        let lower = self.row(2 * y, columns.clone());
        let upper = self.row((2 * y + 1).min(self.size[1] - 1), columns);
        let larger = |a: T, b: T| if b > a { b } else { a };
        let (lower_pairs, lower_last) = lower.as_chunks::<2>();
        let (upper_pairs, upper_last) = upper.as_chunks::<2>();
        for ((maximum, &[a, b]), &[c, d]) in maxima.iter_mut().zip(lower_pairs).zip(upper_pairs) {
            *maximum = larger(larger(a, b), larger(c, d));
        }
        if let (Some(maximum), [a], [b]) = (maxima.last_mut(), lower_last, upper_last) {
            *maximum = larger(*a, *b);
        }
    }
}

impl<T: Copy + PartialOrd> MaxMipmap<T> {
    /// The mipmap over a raster with the same value everywhere; `size` is [columns, rows].
    ///
    /// # Panics
    /// When a side is zero.
    pub fn filled(size: [u32; 2], value: T) -> Self {
        assert!(size.iter().all(|&side| side > 0), "sides are checked where a raster is read");
        let mut levels = Vec::new();
        let mut size = size;
        loop {
            levels.push(MipmapLevel { size, values: vec![value; size[0] as usize * size[1] as usize] });
            if size == [1, 1] {
                return Self { levels };
            }
            size = size.map(|side| side.div_ceil(2));
        }
    }

    /// [columns, rows] of the raster.
    pub fn size(&self) -> [u32; 2] {
        self.levels[0].size
    }

    /// The value of the pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// May panic when the pixel is outside the raster: only the index of the value is checked.
    pub fn get(&self, x: u32, y: u32) -> T {
        self.levels[0].get(x, y)
    }

    /// The values of the pixels of some columns of row `y`.
    ///
    /// # Panics
    /// When they are outside the raster.
    #[inline]
    pub fn row(&self, y: u32, columns: Range<u32>) -> &[T] {
        self.levels[0].row(y, columns)
    }

    /// The largest value of the raster.
    pub fn max(&self) -> T {
        self.levels.last().map(|top| top.values[0]).expect("a mipmap has at least one level")
    }

    /// Sets every pixel of `area` to `value(column, row)`, and updates the maxima above.
    pub fn update(&mut self, area: PixelRect, mut value: impl FnMut(u32, u32) -> T) {
        self.update_rows(area, |y, row| {
            row.iter_mut().zip(area.min[0]..).for_each(|(pixel, x)| *pixel = value(x, y));
        });
    }

    /// As [`Self::update`], row by row: `set(y, pixels)` writes the pixels of row `y` within `area`.
    pub fn update_rows(&mut self, area: PixelRect, mut set: impl FnMut(u32, &mut [T])) {
        if area.is_empty() {
            return;
        }
        for y in area.min[1]..area.max[1] {
            set(y, self.levels[0].row_mut(y, area.min[0]..area.max[0]));
        }
        // On each level, the squares above the changed ones.
        let mut area = area;
        for k in 1..self.levels.len() {
            area = PixelRect { min: area.min.map(|v| v / 2), max: area.max.map(|v| v.div_ceil(2)) };
            let (below, above) = self.levels.split_at_mut(k);
            let (fine, coarse) = (&below[k - 1], &mut above[0]);
            for y in area.min[1]..area.max[1] {
                fine.maxima_of_row(y, area.min[0], coarse.row_mut(y, area.min[0]..area.max[0]));
            }
        }
    }
}

/// The map between the pixels of a raster and a lattice over the same rectangle.
///
/// Lattice and pixel coordinates are multiplied to a common unit, never divided. So whether a closed pixel
/// touches a closed triangle is decided exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterOnLattice {
    /// Common units per lattice step, along both axes.
    per_step: i64,
    /// Common units per pixel, along x and y.
    per_pixel: [i64; 2],
    /// Pixels per lattice step, along x and y, rounded.
    pixels_per_step: [f64; 2],
}

impl RasterOnLattice {
    /// For a raster of `size` = [columns, rows] over the bounds of `lattice`.
    ///
    /// # Panics
    /// When a side is above [`MAX_SIDE`].
    pub fn new(lattice: &Lattice, size: [u32; 2]) -> Self {
        assert!(size.iter().all(|&side| side <= MAX_SIDE), "products must fit 64 bits");
        let extent = lattice.extent();
        let [columns, rows] = size.map(i64::from);
        // 2^30 lattice steps times 2^13 columns times 2^13 rows: below 2^57, and sums of two below 2^58.
        let per_pixel = [i64::from(extent.x) * rows, i64::from(extent.y) * columns];
        let [x, y] = [extent.x, extent.y].map(f64::from);
        let pixels_per_step = [f64::from(size[0]) / x, f64::from(size[1]) / y];
        Self { per_step: columns * rows, per_pixel, pixels_per_step }
    }

    /// The smallest lattice rectangle that contains the closed pixels of `area`. Every triangle that touches
    /// one of these pixels touches the rectangle.
    pub fn lattice_rect(&self, area: PixelRect) -> LatticeRect {
        let low =
            |pixel: u32, per_pixel: i64| (i64::from(pixel) * per_pixel).div_euclid(self.per_step) as u32;
        let high = |pixel: u32, per_pixel: i64| {
            (i64::from(pixel) * per_pixel + self.per_step - 1).div_euclid(self.per_step) as u32
        };
        let [per_x, per_y] = self.per_pixel;
        LatticeRect {
            min: LatticePoint::new(low(area.min[0], per_x), low(area.min[1], per_y)),
            max: LatticePoint::new(high(area.max[0], per_x), high(area.max[1], per_y)),
        }
    }

    /// Whether a pixel that touches the closed triangle has a value above `limit`.
    ///
    /// The triangle must be one of a mesh: its edges are parallel to the axes and diagonals of the lattice.
    #[inline]
    pub fn any_above<T: Copy + PartialOrd>(
        &self,
        mipmap: &MaxMipmap<T>,
        corners: [LatticePoint; 3],
        limit: T,
    ) -> bool {
        if mipmap.max() <= limit {
            return false;
        }
        let size = mipmap.size();
        let (x0, x1) = self.closed_pixels(0, corners.map(|c| c.x), size[0]);
        let (y0, y1) = self.closed_pixels(1, corners.map(|c| c.y), size[1]);
        // Start on the level where the triangle spans at most two squares along both axes. This ends: the top
        // level has one square.
        let mut level = (x1 - x0).max(y1 - y0).checked_ilog2().unwrap_or(0);
        while (x1 >> level) - (x0 >> level) > 1 || (y1 >> level) - (y0 >> level) > 1 {
            level += 1;
        }
        let (x0, x1, y0, y1) = (x0 >> level, x1 >> level, y0 >> level, y1 >> level);
        let level = level as usize;
        let above = |x, y| mipmap.levels[level].get(x, y) > limit;
        // Most queries end here: none of the four squares has a maximum above the limit.
        if !(above(x0, y0) | above(x1, y0) | above(x0, y1) | above(x1, y1)) {
            return false;
        }
        let shape = Octagon::around(corners, self.per_step);
        (y0..=y1).any(|y| (x0..=x1).any(|x| self.search(mipmap, &shape, limit, level, x, y)))
    }

    /// The first and last pixel along an axis that touch a triangle with these lattice coordinates.
    #[inline]
    fn closed_pixels(&self, axis: usize, [a, b, c]: [u32; 3], count: u32) -> (u32, u32) {
        let pixels = |steps: u32| f64::from(steps) * self.pixels_per_step[axis];
        // A lattice coordinate in pixels is a multiple of 2^-30 or coarser, and computed to within 2^-39. So
        // a margin of 2^-32 separates whole numbers, the lines between pixels, from all others.
        let margin = 1.0 / f64::from(1u32 << 31) / 2.0;
        let first = (pixels(a.min(b).min(c)) - margin) as u32; // no less than zero
        let last = (pixels(a.max(b).max(c)) + margin) as u32;
        (first, last.min(count - 1))
    }

    /// Searches one square of a level. The recursion is as deep as the mipmap.
    fn search<T: Copy + PartialOrd>(
        &self,
        mipmap: &MaxMipmap<T>,
        shape: &Octagon,
        limit: T,
        level: usize,
        x: u32,
        y: u32,
    ) -> bool {
        if mipmap.levels[level].get(x, y) <= limit {
            return false;
        }
        let square = self.square(level, x, y);
        if !shape.intersects(&square) {
            return false;
        }
        if level == 0 || shape.contains(&square) {
            return true;
        }
        let finer = mipmap.levels[level - 1].size;
        let (right, top) = ((2 * x + 1).min(finer[0] - 1), (2 * y + 1).min(finer[1] - 1));
        (2 * y..=top).any(|y| (2 * x..=right).any(|x| self.search(mipmap, shape, limit, level - 1, x, y)))
    }

    fn square(&self, level: usize, x: u32, y: u32) -> Octagon {
        let side = |n: u32, per_pixel: i64| {
            let low = i64::from(n) << level;
            Span { low: low * per_pixel, high: (low + (1 << level)) * per_pixel }
        };
        let (x, y) = (side(x, self.per_pixel[0]), side(y, self.per_pixel[1]));
        let sum = Span { low: x.low + y.low, high: x.high + y.high };
        let difference = Span { low: x.low - y.high, high: x.high - y.low };
        Octagon { x, y, sum, difference }
    }
}

/// A closed interval in common units.
#[derive(Clone, Copy)]
struct Span {
    low: i64,
    high: i64,
}

impl Span {
    #[inline]
    fn of(values: [i64; 3]) -> Self {
        let [a, b, c] = values;
        Self { low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    #[inline]
    fn intersects(&self, other: &Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }

    #[inline]
    fn contains(&self, other: &Self) -> bool {
        self.low <= other.low && other.high <= self.high
    }
}

/// A convex shape by its extents along x, y, x + y and x − y.
///
/// A triangle of a mesh is exactly the set of points within its four extents, and so is a square. Two such
/// shapes intersect exactly when their extents intersect along all four directions: a separating axis is
/// always one of them.
struct Octagon {
    x: Span,
    y: Span,
    sum: Span,
    difference: Span,
}

impl Octagon {
    #[inline]
    fn around(corners: [LatticePoint; 3], per_step: i64) -> Self {
        let x = corners.map(|c| i64::from(c.x) * per_step);
        let y = corners.map(|c| i64::from(c.y) * per_step);
        Self {
            x: Span::of(x),
            y: Span::of(y),
            sum: Span::of([x[0] + y[0], x[1] + y[1], x[2] + y[2]]),
            difference: Span::of([x[0] - y[0], x[1] - y[1], x[2] - y[2]]),
        }
    }

    #[inline]
    fn intersects(&self, other: &Self) -> bool {
        self.x.intersects(&other.x)
            && self.y.intersects(&other.y)
            && self.sum.intersects(&other.sum)
            && self.difference.intersects(&other.difference)
    }

    #[inline]
    fn contains(&self, other: &Self) -> bool {
        self.x.contains(&other.x)
            && self.y.contains(&other.y)
            && self.sum.contains(&other.sum)
            && self.difference.contains(&other.difference)
    }
}

impl<T: Copy + PartialOrd> From<&Raster<T>> for MaxMipmap<T> {
    fn from(raster: &Raster<T>) -> Self {
        let mut mipmap = Self::filled(raster.size(), raster.get(0, 0));
        mipmap.update(raster.all(), |x, y| raster.get(x, y));
        mipmap
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;
    use crate::mesh::{Limits, Mesh, TriangleId};
    use glam::{DVec2, dvec2};

    /// Whether the closed pixel touches the closed triangle, independent of the product: no line along an
    /// edge of either one separates them, in exact arithmetic.
    fn touches_by_separating_lines(
        lattice: &Lattice,
        size: [u32; 2],
        corners: [LatticePoint; 3],
        x: u32,
        y: u32,
    ) -> bool {
        let extent = lattice.extent();
        let unit = i128::from(size[0]) * i128::from(size[1]);
        let px = |n: u32| i128::from(n) * i128::from(extent.x) * i128::from(size[1]);
        let py = |n: u32| i128::from(n) * i128::from(extent.y) * i128::from(size[0]);
        let square = [(px(x), py(y)), (px(x + 1), py(y)), (px(x + 1), py(y + 1)), (px(x), py(y + 1))];
        let mut t = corners.map(|c| (i128::from(c.x) * unit, i128::from(c.y) * unit));
        let cross = |a: (i128, i128), b: (i128, i128), p: (i128, i128)| {
            (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)
        };
        if cross(t[0], t[1], t[2]) < 0 {
            t.swap(1, 2);
        }
        let separated = |p: &[(i128, i128)], q: &[(i128, i128)]| {
            (0..p.len()).any(|i| {
                let (a, b) = (p[i], p[(i + 1) % p.len()]);
                q.iter().all(|&v| cross(a, b, v) < 0)
            })
        };
        !separated(&square, &t) && !separated(&t, &square)
    }

    #[test]
    fn the_answer_is_exact_for_pixels_that_only_touch() {
        let mut random = fastrand::Rng::with_seed(7);
        for (size, w, h) in [([8, 8], 1.0, 1.0), ([7, 5], 1.0, 1.0), ([16, 9], 3.0, 2.0), ([1, 3], 1.0, 1.3)]
        {
            let bounds = Rect::new(DVec2::ZERO, dvec2(w, h));
            let mut mesh = Mesh::coarse_grid(
                &Lattice::covering(bounds, 0.5, 1_000_000).unwrap(),
                |_| true,
                &Limits::default(),
            )
            .unwrap();
            for _ in 0..60 {
                mesh.refine_triangle(TriangleId::from_index(random.usize(..mesh.raw_triangle_count())));
            }
            let on = RasterOnLattice::new(mesh.lattice(), size);
            for (x, y) in (PixelRect { min: [0, 0], max: size }).pixels() {
                let mut mipmap = MaxMipmap::filled(size, 0u8);
                mipmap.update(PixelRect { min: [x, y], max: [x + 1, y + 1] }, |_, _| 1);
                for id in (0..mesh.raw_triangle_count()).map(TriangleId::from_index) {
                    let corners = mesh.corners(id);
                    let expected = touches_by_separating_lines(mesh.lattice(), size, corners, x, y);
                    assert_eq!(
                        on.any_above(&mipmap, corners, 0),
                        expected,
                        "pixel {x}, {y} of {size:?}, {corners:?}"
                    );
                    assert!(!on.any_above(&mipmap, corners, 1));
                }
            }
        }
    }

    #[test]
    fn partial_updates_equal_a_mipmap_made_from_scratch() {
        let mut random = fastrand::Rng::with_seed(8);
        let size = [37, 21];
        let mut raster = Raster::filled(Rect::UNIT, size, 0u8);
        let mut mipmap = MaxMipmap::from(&raster);
        for _ in 0..200 {
            let (x, y) = (random.u32(..size[0]), random.u32(..size[1]));
            let max = [random.u32(x..size[0]) + 1, random.u32(y..size[1]) + 1];
            let (area, value) = (PixelRect { min: [x, y], max }, random.u8(..));
            area.pixels().for_each(|(x, y)| raster.set(x, y, value));
            mipmap.update(area, |x, y| raster.get(x, y));
            assert_eq!(mipmap.max(), *raster.values().iter().max().unwrap());
        }
        let from_scratch = MaxMipmap::from(&raster);
        for (a, b) in mipmap.levels.iter().zip(&from_scratch.levels) {
            assert_eq!(a.values, b.values);
        }
    }
}
