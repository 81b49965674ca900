use super::{PixelRect, Raster};
use crate::geometry::{Lattice, LatticePoint, LatticeRect};

/// Maxima of a raster over squares of 1, 2 × 2, 4 × 4 … pixels.
///
/// Answers "is there a value above this one under this triangle?" with early exits both ways, and is kept up to date in
/// time proportional to the pixels that change.
#[derive(Clone, Debug)]
pub struct MaxMipmap<T = u8> {
    /// From the raster itself (0) to a single value.
    layers: Vec<Layer<T>>,
}

#[derive(Clone, Debug)]
struct Layer<T> {
    size: [u32; 2],
    values: Vec<T>,
}

impl<T: Copy> Layer<T> {
    #[inline]
    fn get(&self, x: u32, y: u32) -> T {
        self.values[y as usize * self.size[0] as usize + x as usize]
    }
}

impl<T: Copy + PartialOrd> MaxMipmap<T> {
    /// The mipmap over a grid of one value; `size` is columns and rows.
    ///
    /// # Panics
    /// When a side is zero.
    pub fn filled(size: [u32; 2], value: T) -> Self {
        assert!(size.iter().all(|&side| side > 0), "sides are checked where a raster is read");
        let mut layers = Vec::new();
        let mut size = size;
        loop {
            layers.push(Layer { size, values: vec![value; size[0] as usize * size[1] as usize] });
            if size == [1, 1] {
                return Self { layers };
            }
            size = size.map(|side| side.div_ceil(2));
        }
    }

    /// Columns and rows of the grid.
    pub fn size(&self) -> [u32; 2] {
        self.layers[0].size
    }

    /// The value of a pixel.
    ///
    /// # Panics
    /// Beyond the grid.
    pub fn get(&self, x: u32, y: u32) -> T {
        self.layers[0].get(x, y)
    }

    /// The largest value of all.
    pub fn max(&self) -> T {
        self.layers.last().map(|top| top.values[0]).expect("a mipmap has at least one layer")
    }

    /// Sets every pixel of `area` to what `value` gives for its column and row, and brings the maxima up to date.
    pub fn update(&mut self, area: PixelRect, mut value: impl FnMut(u32, u32) -> T) {
        if area.is_empty() {
            return;
        }
        let columns = self.layers[0].size[0] as usize;
        for (x, y) in area.pixels() {
            self.layers[0].values[y as usize * columns + x as usize] = value(x, y);
        }
        let mut area = area;
        for k in 1..self.layers.len() {
            area = PixelRect { min: area.min.map(|v| v / 2), max: area.max.map(|v| v.div_ceil(2)) };
            let (below, above) = self.layers.split_at_mut(k);
            let (fine, coarse) = (&below[k - 1], &mut above[0]);
            let columns = coarse.size[0] as usize;
            for (x, y) in area.pixels() {
                coarse.values[y as usize * columns + x as usize] = max_of_four(fine, 2 * x, 2 * y);
            }
        }
    }
}

fn max_of_four<T: Copy + PartialOrd>(fine: &Layer<T>, x: u32, y: u32) -> T {
    let (right, top) = ((x + 1).min(fine.size[0] - 1), (y + 1).min(fine.size[1] - 1));
    let larger = |a: T, b: T| if b > a { b } else { a };
    larger(larger(fine.get(x, y), fine.get(right, y)), larger(fine.get(x, top), fine.get(right, top)))
}

/// How the pixels of a raster lie on a lattice that covers the same rectangle.
///
/// Lattice and pixel coordinates are brought to a common unit by multiplying, never dividing, so that whether a closed
/// pixel meets a closed triangle is decided exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterOnLattice {
    /// Common units in a lattice step, along both axes.
    per_step: i64,
    /// Common units in a pixel, along x and y.
    per_pixel: [i64; 2],
    /// Pixels in a lattice step, along x and y, rounded.
    pixels_per_step: [f64; 2],
}

impl RasterOnLattice {
    /// For a raster of `size` columns and rows over the bounds of `lattice`.
    pub fn new(lattice: &Lattice, size: [u32; 2]) -> Self {
        let extent = lattice.extent();
        let [columns, rows] = size.map(i64::from);
        // 2^30 lattice steps times 2^13 columns times 2^13 rows: below 2^57, and sums of two below 2^58.
        let per_pixel = [i64::from(extent.x) * rows, i64::from(extent.y) * columns];
        let [x, y] = [extent.x, extent.y].map(f64::from);
        let pixels_per_step = [f64::from(size[0]) / x, f64::from(size[1]) / y];
        Self { per_step: columns * rows, per_pixel, pixels_per_step }
    }

    /// The smallest rectangle of the lattice that holds the closed pixels of `area`: all triangles that meet one of them touch
    /// it.
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

    /// Whether some pixel that meets the closed triangle has a value above `limit`.
    ///
    /// The triangle is one of a mesh: its edges run along axes and diagonals of the lattice.
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
        // Start where the triangle spans two squares at most along both axes; the top layer has one, so this ends.
        let mut layer = (x1 - x0).max(y1 - y0).checked_ilog2().unwrap_or(0);
        while (x1 >> layer) - (x0 >> layer) > 1 || (y1 >> layer) - (y0 >> layer) > 1 {
            layer += 1;
        }
        let (x0, x1, y0, y1) = (x0 >> layer, x1 >> layer, y0 >> layer, y1 >> layer);
        let layer = layer as usize;
        let above = |x, y| mipmap.layers[layer].get(x, y) > limit;
        // Most triangles are answered here.
        if !(above(x0, y0) | above(x1, y0) | above(x0, y1) | above(x1, y1)) {
            return false;
        }
        let shape = Octagon::around(corners, self.per_step);
        (y0..=y1).any(|y| (x0..=x1).any(|x| self.search(mipmap, &shape, limit, layer, x, y)))
    }

    /// First and last pixel along an axis whose closure meets a triangle with the given coordinates on it.
    #[inline]
    fn closed_pixels(&self, axis: usize, [a, b, c]: [u32; 3], count: u32) -> (u32, u32) {
        let pixels = |steps: u32| f64::from(steps) * self.pixels_per_step[axis];
        // A lattice coordinate in pixels is a fraction of at most 2^30 parts, and known here to within 2^-39: so a margin
        // of 2^-32 tells whole numbers, lines between two pixels, from all others.
        let margin = 1.0 / f64::from(1u32 << 31) / 2.0;
        let first = (pixels(a.min(b).min(c)) - margin) as u32; // no less than zero
        let last = (pixels(a.max(b).max(c)) + margin) as u32;
        (first, last.min(count - 1))
    }

    /// Descends into one square of a layer. The depth is that of the mipmap.
    fn search<T: Copy + PartialOrd>(
        &self,
        mipmap: &MaxMipmap<T>,
        shape: &Octagon,
        limit: T,
        layer: usize,
        x: u32,
        y: u32,
    ) -> bool {
        if mipmap.layers[layer].get(x, y) <= limit {
            return false;
        }
        let square = self.square(layer, x, y);
        if !shape.meets(&square) {
            return false;
        }
        if layer == 0 || shape.holds(&square) {
            return true;
        }
        let finer = mipmap.layers[layer - 1].size;
        let (right, top) = ((2 * x + 1).min(finer[0] - 1), (2 * y + 1).min(finer[1] - 1));
        (2 * y..=top).any(|y| (2 * x..=right).any(|x| self.search(mipmap, shape, limit, layer - 1, x, y)))
    }

    fn square(&self, layer: usize, x: u32, y: u32) -> Octagon {
        let side = |n: u32, per_pixel: i64| {
            let low = i64::from(n) << layer;
            Span { low: low * per_pixel, high: (low + (1 << layer)) * per_pixel }
        };
        let (x, y) = (side(x, self.per_pixel[0]), side(y, self.per_pixel[1]));
        let sum = Span { low: x.low + y.low, high: x.high + y.high };
        let difference = Span { low: x.low - y.high, high: x.high - y.low };
        Octagon { x, y, sum, difference }
    }
}

/// A closed range, in common units.
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
    fn meets(&self, other: &Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }

    #[inline]
    fn holds(&self, other: &Self) -> bool {
        self.low <= other.low && other.high <= self.high
    }
}

/// A convex shape by its extent along x, y, x + y and x − y.
///
/// A triangle of a mesh is exactly the points within its four extents, and a square too; two such shapes meet when all four
/// extents do (the separating axis is always one of the four).
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
    fn meets(&self, other: &Self) -> bool {
        self.x.meets(&other.x)
            && self.y.meets(&other.y)
            && self.sum.meets(&other.sum)
            && self.difference.meets(&other.difference)
    }

    #[inline]
    fn holds(&self, other: &Self) -> bool {
        self.x.holds(&other.x)
            && self.y.holds(&other.y)
            && self.sum.holds(&other.sum)
            && self.difference.holds(&other.difference)
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

    /// The plain meaning of "the closed pixel meets the closed triangle", by clipping in rational arithmetic: the
    /// pixel's polygon is cut by each edge of the triangle, and something must be left.
    fn meets_by_clipping(
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
                    let expected = meets_by_clipping(mesh.lattice(), size, corners, x, y);
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
    fn updates_of_parts_leave_the_mipmap_as_if_made_anew() {
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
        let anew = MaxMipmap::from(&raster);
        for (a, b) in mipmap.layers.iter().zip(&anew.layers) {
            assert_eq!(a.values, b.values);
        }
    }
}
