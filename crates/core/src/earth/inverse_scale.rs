//! 1/k over a rectangle of a plane: from lengths in the plane to those on the Earth.

use std::ops::RangeInclusive;

use glam::{DVec2, dvec2};
use rayon::prelude::*;

use super::Projection;
use super::squares::SquareGrid;
use crate::geometry::Rect;

/// The inverse scale 1/k over a rectangle, with bounds of its values and of its derivatives.
///
/// It is interpolated: a cubic polynomial in x and y in each cell of a grid, through the sixteen values
/// around the cell. Cells are so small that this differs from 1/k by less than 10⁻⁸ of it, but beside the tip
/// of Lambert's cone, where 1/k is 0. Bounds are those of the interpolation, so that they agree with its
/// values. Beyond the grid it is constant along x or y.
///
/// ```text
///    o   o   o   o
///    o   o---o   o      a cell with its corners, and the values around it
///    o   o---o   o
///    o   o   o   o
/// ```
#[derive(Debug)]
pub struct InverseScale {
    /// The lower left corner of the first cell.
    origin: DVec2,
    /// The side of a cell, in metres of the plane.
    side: f64,
    /// Cells along x and y.
    cells: [u32; 2],
    /// One more around the corners of all cells, row by row from the lowest.
    values: Vec<f64>,
    /// Bounds in each cell, then in squares of 2 × 2 of them, and so on up to one square.
    squares: Vec<SquareGrid<SquareBounds>>,
}

/// What holds in a square.
#[derive(Clone, Copy, Debug)]
struct SquareBounds {
    least: f64,
    greatest: f64,
    /// Bound of the absolute values of the second derivatives: along x, along y and mixed.
    curvature: f64,
}

/// The preferred side of a cell in metres, which is a small share of the radius of the Earth.
const SIDE: f64 = 16e3;
/// Cells along the longer side of the rectangle.
const CELLS: RangeInclusive<f64> = 16.0..=256.0;
/// The grid is larger than the rectangle by this share of a cell on each side.
const MARGIN: f64 = 1.0;
/// The weights of four values add up to this at most, each without its sign.
const LEBESGUE: f64 = 1.25;
/// As [`LEBESGUE`], for derivatives as weights of the differences of neighbours.
const LEBESGUE_OF_SLOPES: f64 = 4.0 / 3.0;
/// Derivatives jump between cells by less than this share of a cell times the second derivative.
const JUMP: f64 = 1e-3;
/// Bounds are wider than values by this share, for rounding.
const ROUNDING: f64 = 1e-14;

impl InverseScale {
    /// Returns the inverse scale of a projection over a rectangle of its plane.
    pub fn new(projection: &Projection, bounds: &Rect) -> Self {
        let size = bounds.size();
        let longest = size.max_element();
        let side = longest / (longest / SIDE).clamp(*CELLS.start(), *CELLS.end());
        let cells = [size.x, size.y].map(|length| (length / side + 2.0 * MARGIN).ceil() as u32);
        let origin = bounds.min - MARGIN * side;
        let [columns, rows] = cells.map(|count| count as usize + 3);
        let at = |number: usize| {
            let place = dvec2((number % columns) as f64, (number / columns) as f64);
            1.0 / projection.scale_in_plane(origin + side * (place - 1.0))
        };
        let values: Vec<f64> = (0..columns * rows).into_par_iter().with_min_len(1024).map(at).collect();
        let mut inverse = Self { origin, side, cells, values, squares: Vec::new() };
        let places = (0..cells[1]).flat_map(|row| (0..cells[0]).map(move |column| [column, row]));
        let bounds = places.map(|cell| inverse.bounds_in(cell)).collect();
        inverse.squares = SquareGrid::new(cells[0], bounds).pyramid(SquareBounds::joined);
        inverse
    }

    /// Returns the inverse scale at a point of the plane: the length on the Earth of a short line of length 1
    /// in the plane.
    pub fn at(&self, point: DVec2) -> f64 {
        let (cell, [u, v]) = self.place(point);
        let across = weights(u);
        let rows: [f64; 4] = std::array::from_fn(|number| dot(across, self.row(cell, number)));
        dot(weights(v), rows)
    }

    /// Returns bounds of the inverse scale over a rectangle of the plane: [minimum, maximum].
    pub fn range(&self, rectangle: &Rect) -> [f64; 2] {
        let (within, [width, height]) = self.within(rectangle);
        let (around, center) = (self.bounds_over(&within), within.center());
        let slope = self.slope(center).abs();
        let spread = slope.x * width + slope.y * height;
        let curved = around.curvature * (width + height) * (0.5 * (width + height) + self.jump());
        let (middle, most) = (self.at(center), spread + curved);
        // Numbers that are not finite leave the bounds of the squares.
        let [least, greatest] = [around.least.max(middle - most), around.greatest.min(middle + most)];
        [least * (1.0 - ROUNDING), greatest * (1.0 + ROUNDING)]
    }

    /// Returns bounds of the derivatives along x and y over a rectangle of the plane, each as [minimum,
    /// maximum]. `None` where they are not known.
    pub fn slopes(&self, rectangle: &Rect) -> Option<[[f64; 2]; 2]> {
        let (within, [width, height]) = self.within(rectangle);
        let around = self.bounds_over(&within);
        let most = around.curvature * (width + height + self.jump());
        if !most.is_finite() {
            return None;
        }
        let (slope, grid) = (self.slope(within.center()), self.grid());
        let of_axis = |axis: usize| {
            let [least, greatest] = [slope[axis] - most, slope[axis] + most];
            // Constant beyond the grid.
            let reaches_beyond = rectangle.min[axis] < grid.min[axis] || rectangle.max[axis] > grid.max[axis];
            if reaches_beyond { [least.min(0.0), greatest.max(0.0)] } else { [least, greatest] }
        };
        Some([of_axis(0), of_axis(1)])
    }

    fn grid(&self) -> Rect {
        let size = self.side * dvec2(self.cells[0] as f64, self.cells[1] as f64);
        Rect::new(self.origin, self.origin + size)
    }

    /// Returns the part of a rectangle in the grid, or its side or corner next to the rectangle, and the
    /// halves of its width and height.
    fn within(&self, rectangle: &Rect) -> (Rect, [f64; 2]) {
        let grid = self.grid();
        let [min, max] = [rectangle.min, rectangle.max].map(|corner| corner.clamp(grid.min, grid.max));
        (Rect::new(min, max), (0.5 * (max - min)).to_array())
    }

    fn jump(&self) -> f64 {
        JUMP * self.side
    }

    /// Returns the cell of a point, and where it lies there, from 0 to 1 along x and y.
    fn place(&self, point: DVec2) -> ([u32; 2], [f64; 2]) {
        let from_origin = (point - self.origin) / self.side;
        let of_axis = |axis: usize| {
            let last = self.cells[axis] - 1;
            let along = from_origin[axis].clamp(0.0, f64::from(last + 1));
            let cell = (along as u32).min(last);
            (cell, along - f64::from(cell))
        };
        let [(column, u), (row, v)] = [of_axis(0), of_axis(1)];
        ([column, row], [u, v])
    }

    /// Returns four values of a row, from 0 to 3, around a cell.
    fn row(&self, [column, row]: [u32; 2], number: usize) -> [f64; 4] {
        let first = (row as usize + number) * (self.cells[0] as usize + 3) + column as usize;
        std::array::from_fn(|n| self.values[first + n])
    }

    fn slope(&self, point: DVec2) -> DVec2 {
        let (cell, [u, v]) = self.place(point);
        let (across, up, along_x, along_y) = (weights(u), weights(v), slopes(u), slopes(v));
        let mut slope = DVec2::ZERO;
        for number in 0..4 {
            let row = self.row(cell, number);
            slope += dvec2(up[number] * dot(along_x, row), along_y[number] * dot(across, row));
        }
        slope / self.side
    }

    /// Returns what holds in all cells that a rectangle in the grid meets, from four squares at most.
    fn bounds_over(&self, within: &Rect) -> SquareBounds {
        let [first, last] = [within.min, within.max].map(|corner| self.place(corner).0);
        let is_enough =
            |level: &usize| (0..2).all(|axis| (last[axis] >> level) - (first[axis] >> level) <= 1);
        let level = (0..self.squares.len()).find(is_enough).expect("the last level has one square");
        let of_axis = |axis: usize| first[axis] >> level..=last[axis] >> level;
        let places = of_axis(1).flat_map(|row| of_axis(0).map(move |column| [column, row]));
        let bounds = places.map(|place| self.squares[level].at(place));
        bounds.reduce(SquareBounds::joined).expect("the rectangle is in a square")
    }

    fn bounds_in(&self, cell: [u32; 2]) -> SquareBounds {
        let rows: [[f64; 4]; 4] = std::array::from_fn(|number| self.row(cell, number));
        let columns: [[f64; 4]; 4] = std::array::from_fn(|n| rows.map(|row| row[n]));
        let straight = rows.iter().chain(&columns).map(bend).fold(0.0, f64::max);
        let mixed = rows.windows(2).map(|pair| twist(&pair[0], &pair[1])).fold(0.0, f64::max);
        let bent = (LEBESGUE * straight).max(LEBESGUE_OF_SLOPES * LEBESGUE_OF_SLOPES * mixed);
        let corners = [rows[1][1], rows[1][2], rows[2][1], rows[2][2]];
        if !bent.is_finite() || corners.iter().any(|value| value.is_nan()) {
            return SquareBounds { least: 0.0, greatest: f64::INFINITY, curvature: f64::INFINITY };
        }
        // Along each axis, a curve deviates from a straight line by at most an eighth of that.
        SquareBounds {
            least: corners.into_iter().fold(f64::INFINITY, f64::min) - 0.25 * bent,
            greatest: corners.into_iter().fold(f64::NEG_INFINITY, f64::max) + 0.25 * bent,
            curvature: bent / (self.side * self.side),
        }
    }
}

impl SquareBounds {
    fn joined(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
            curvature: self.curvature.max(other.curvature),
        }
    }
}

/// Returns the larger second difference of four values, without its sign.
fn bend([a, b, c, d]: &[f64; 4]) -> f64 {
    (a - 2.0 * b + c).abs().max((b - 2.0 * c + d).abs())
}

/// Returns the largest mixed difference of two rows, without its sign.
fn twist(lower: &[f64; 4], upper: &[f64; 4]) -> f64 {
    let difference = |n: usize| (upper[n + 1] - upper[n]) - (lower[n + 1] - lower[n]);
    (0..3).map(|n| difference(n).abs()).fold(0.0, f64::max)
}

/// Returns the weights of values at −1, 0, 1 and 2 in the cubic polynomial through them at a place.
fn weights(u: f64) -> [f64; 4] {
    let (before, after, last) = (u + 1.0, 1.0 - u, 2.0 - u);
    [-u * after * last / 6.0, 0.5 * before * after * last, 0.5 * before * u * last, -before * u * after / 6.0]
}

/// Returns the derivatives of [`weights`].
fn slopes(u: f64) -> [f64; 4] {
    [
        (-2.0 + u * (6.0 - 3.0 * u)) / 6.0,
        0.5 * (-1.0 + u * (-4.0 + 3.0 * u)),
        0.5 * (2.0 + u * (2.0 - 3.0 * u)),
        (-1.0 + 3.0 * u * u) / 6.0,
    ]
}

fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Planes with a rectangle, up to half a hemisphere wide.
    fn planes() -> Vec<(Projection, Rect)> {
        let rect = |x: f64, y: f64, width: f64, height: f64| {
            Rect::new(dvec2(x, y), dvec2(x, y) + dvec2(width, height))
        };
        let planes = [
            ("+proj=merc +lat_ts=0 +ellps=WGS84 +units=m", rect(-3e6, -2e6, 5e6, 9e6)),
            ("+proj=merc +lat_ts=60 +lon_0=20 +ellps=WGS84 +units=m", rect(-8e5, 3.5e6, 1.6e6, 1.5e6)),
            ("+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m", rect(-2.5e5, 4e6, 9e5, 1.3e6)),
            ("+proj=tmerc +lon_0=15 +ellps=WGS84 +units=m", rect(1e3, 5e6, 900.0, 40.0)),
            ("+proj=stere +lat_0=90 +lat_ts=70 +lon_0=-45 +ellps=WGS84 +units=m", rect(-2e6, -1e6, 5e6, 3e6)),
            (
                "+proj=lcc +lat_1=35 +lat_2=65 +lat_0=52 +lon_0=10 +ellps=WGS84 +units=m",
                rect(-2e6, -2e6, 4e6, 3e6),
            ),
        ];
        planes.map(|(text, rect)| (text.parse().unwrap(), rect)).to_vec()
    }

    /// Returns a random rectangle in another one, often a small one.
    fn part(bounds: &Rect, random: &mut fastrand::Rng) -> Rect {
        let mut point = || bounds.min + dvec2(random.f64(), random.f64()) * bounds.size();
        let (center, corner) = (point(), point());
        let share = 10.0_f64.powf(-5.0 * random.f64());
        Rect::spanning(center, center.lerp(corner, share))
    }

    #[test]
    fn it_is_one_by_the_scale() {
        let mut random = fastrand::Rng::with_seed(1);
        for (projection, bounds) in planes() {
            let inverse = InverseScale::new(&projection, &bounds);
            for _ in 0..3000 {
                let at = bounds.min + dvec2(random.f64(), random.f64()) * bounds.size();
                let off = inverse.at(at) * projection.scale_in_plane(at) - 1.0;
                assert!(off.abs() < 1e-8, "{projection}: {off:e} at {at}");
            }
        }
    }

    #[test]
    fn values_and_differences_are_between_their_bounds_which_are_close() {
        let mut random = fastrand::Rng::with_seed(2);
        for (projection, bounds) in planes() {
            let inverse = InverseScale::new(&projection, &bounds);
            for _ in 0..2000 {
                // Beyond the grid, too.
                let rect = part(&bounds.expanded(0.1 * bounds.size().max_element()), &mut random);
                let [least, greatest] = inverse.range(&rect);
                let slopes = inverse.slopes(&rect).unwrap();
                let diagonal = rect.size().length();
                let spread = slopes.iter().map(|[a, b]| b - a).fold(0.0, f64::max);
                // A few times what it curves over the radius of the Earth.
                let curved = (diagonal + inverse.jump()) / (6.3e6 * 6.3e6);
                let is_inside = bounds.union(&rect) == bounds;
                assert!(!is_inside || spread <= 20.0 * curved, "{projection}: {rect:?} {slopes:?}");
                let mut point = || rect.min + dvec2(random.f64(), random.f64()) * rect.size();
                for _ in 0..10 {
                    let (p, q) = (point(), point());
                    let [at_p, at_q] = [inverse.at(p), inverse.at(q)];
                    assert!((least..=greatest).contains(&at_p), "{projection}: {at_p} in {least} {greatest}");
                    let (mut low, mut high) = (-1e-14, 1e-14);
                    for (axis, [a, b]) in slopes.into_iter().enumerate() {
                        let way = (q - p)[axis];
                        low += (a * way).min(b * way);
                        high += (a * way).max(b * way);
                    }
                    let rise = at_q - at_p;
                    assert!((low..=high).contains(&rise), "{projection}: {rise:e} in {low:e} {high:e}");
                }
            }
        }
    }
}
