//! Rectangles of lattice cells, and the pixels of a raster on the lattice.

use glam::DVec2;

use super::asked::Ternary;
use crate::geometry::{Lattice, LatticePoint, LatticeRect, Octagon, Rect};
use crate::raster::{PixelGrid, ValueRange, ValueRanges, exponent, power_of_two};

/// A half-open rectangle of the unit cells of a lattice: cell [x, y] lies between lattice points [x, y] and
/// [x + 1, y + 1].
///
/// The value of every layer is constant on each cell. So a rectangle that is divided again and again ends
/// at cells on which every question is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cells {
    /// First column and row.
    pub min: [i64; 2],
    /// One past the last column and row.
    pub max: [i64; 2],
}

/// A cut that divides a rectangle of cells in two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cut {
    /// 0: between columns, 1: between rows.
    pub axis: usize,
    /// The first column or row of the second part.
    pub at: i64,
}

impl Cells {
    /// Returns the cells that touch a closed triangle, and others in the rectangle around it.
    #[inline]
    pub fn around(triangle: &Octagon, extent: LatticePoint) -> Self {
        let [min, max] = triangle.bounds();
        let extent = [i64::from(extent.x), i64::from(extent.y)];
        Self {
            min: min.map(|v| (v - 1).max(0)),
            max: [(max[0] + 1).min(extent[0]), (max[1] + 1).min(extent[1])],
        }
    }

    /// Returns all cells of a lattice.
    pub fn all(extent: LatticePoint) -> Self {
        Self { min: [0, 0], max: [i64::from(extent.x), i64::from(extent.y)] }
    }

    /// Returns the closed rectangle that the cells cover.
    #[inline]
    pub fn octagon(&self) -> Octagon {
        Octagon::rect(self.min, self.max)
    }

    /// Returns the two parts on both sides of a cut.
    #[inline]
    pub fn divided(self, cut: Cut) -> [Self; 2] {
        let (mut low, mut high) = (self, self);
        low.max[cut.axis] = cut.at;
        high.min[cut.axis] = cut.at;
        [low, high]
    }

    /// Returns the part on one side of lines along both axes; `upper` says for each axis whether it is the
    /// upper one.
    #[inline]
    pub fn quarter(&self, lines: [i64; 2], upper: [bool; 2]) -> Self {
        Self {
            min: [0, 1].map(|axis: usize| if upper[axis] { lines[axis] } else { self.min[axis] }),
            max: [0, 1].map(|axis: usize| if upper[axis] { self.max[axis] } else { lines[axis] }),
        }
    }

    /// Divides the cells in quarters up to `depth` times, and adds the parts in which some cells matter;
    /// `share` returns the share of those that do. Returns whether it added the whole.
    pub fn add_parts(&self, depth: u32, share: &impl Fn(&Self) -> Ternary, parts: &mut Vec<Self>) -> bool {
        let middle = [0, 1].map(|axis: usize| self.min[axis].midpoint(self.max[axis]));
        let can_divide = depth > 0 && [0, 1].iter().all(|&axis| self.min[axis] < middle[axis]);
        match share(self) {
            Ternary::Never => return false,
            Ternary::Maybe if can_divide => {}
            Ternary::Maybe | Ternary::Always => {
                parts.push(*self);
                return true;
            }
        }
        let first = parts.len();
        let quarters = [[false, false], [true, false], [false, true], [true, true]];
        let whole = quarters.map(|upper| self.quarter(middle, upper).add_parts(depth - 1, share, parts));
        if whole == [true; 4] {
            parts.truncate(first);
            parts.push(*self);
        }
        whole == [true; 4]
    }

    /// Returns whether a cut has cells on both sides.
    #[inline]
    pub fn admits(&self, cut: Cut) -> bool {
        self.min[cut.axis] < cut.at && cut.at < self.max[cut.axis]
    }

    /// Returns a cut through the longer side at a multiple of the largest power of two that has one there:
    /// parts of several rectangles then coincide. `None` for a single cell.
    #[inline]
    pub fn middle(&self) -> Option<Cut> {
        let side = |axis: usize| self.max[axis] - self.min[axis];
        let axis = usize::from(side(1) > side(0));
        if side(axis) <= 1 {
            return None;
        }
        // The highest bit in which the first and the last cell differ.
        let (first, last) = (self.min[axis], self.max[axis] - 1);
        let bit = (first ^ last).ilog2();
        Some(Cut { axis, at: last >> bit << bit })
    }

    /// Returns the centre in world units.
    #[inline]
    pub fn center(&self, lattice: &Lattice) -> DVec2 {
        let twice = [0, 1].map(|axis: usize| (self.min[axis] + self.max[axis]) as f64);
        lattice.bounds().min + 0.5 * DVec2::from(twice) * lattice.step()
    }

    /// Returns the smallest rectangle around the centres of the cells, in world units. A line between cells,
    /// where a function may jump, lies between two such rectangles.
    #[inline]
    pub fn centers(&self, lattice: &Lattice) -> Rect {
        let corner = |place: [f64; 2]| lattice.bounds().min + DVec2::from(place) * lattice.step();
        let min = self.min.map(|v| v as f64 + 0.5);
        Rect::new(corner(min), corner([0, 1].map(|axis: usize| self.max[axis] as f64 - 0.5)))
    }

    /// These cells and those that touch them.
    pub fn with_neighbours(&self, extent: LatticePoint) -> Self {
        let extent = [extent.x, extent.y].map(i64::from);
        Self {
            min: self.min.map(|v| (v - 1).max(0)),
            max: [0, 1].map(|axis: usize| (self.max[axis] + 1).min(extent[axis])),
        }
    }

    /// Returns the common cells.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let common = Self {
            min: [self.min[0].max(other.min[0]), self.min[1].max(other.min[1])],
            max: [self.max[0].min(other.max[0]), self.max[1].min(other.max[1])],
        };
        (common.min[0] < common.max[0] && common.min[1] < common.max[1]).then_some(common)
    }

    /// Returns the rectangle in world units; parts beyond the lattice are cut off.
    #[inline]
    pub fn world_rect(&self, lattice: &Lattice) -> Rect {
        let extent = lattice.extent();
        let corner = |[x, y]: [i64; 2]| {
            let point = LatticePoint::new(
                x.clamp(0, i64::from(extent.x)) as u32,
                y.clamp(0, i64::from(extent.y)) as u32,
            );
            lattice.world_from_lattice(point)
        };
        Rect::new(corner(self.min), corner(self.max))
    }
}

impl Cells {
    /// Returns the cells that a rectangle covers or touches from within, at least one along each side.
    pub fn of(rect: &LatticeRect) -> Self {
        let [min, max] = [rect.min, rect.max].map(|p| [i64::from(p.x), i64::from(p.y)]);
        Self { min: [0, 1].map(|axis: usize| min[axis].min(max[axis] - 1).max(0)), max }
    }
}

impl From<Cells> for LatticeRect {
    /// Returns the closed rectangle. The cells must lie on the lattice.
    fn from(cells: Cells) -> Self {
        let [min, max] = [cells.min, cells.max].map(|[x, y]| LatticePoint::new(x as u32, y as u32));
        Self { min, max }
    }
}

/// The pixels of a raster as rectangles of lattice cells.
///
/// Lines between pixels are rounded down to the lattice. So each cell belongs to one pixel at every scale,
/// and squares of several pixels consist of the cells of these pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridOnLattice {
    /// The lower left corner of pixel [0, 0] in lattice coordinates.
    origin: DVec2,
    /// Lattice steps per pixel.
    steps: DVec2,
    /// The inverse of that, rounded.
    pixels_per_step: DVec2,
    /// Binary logarithm of the shorter side of a pixel in lattice steps, rounded down.
    log_steps: i32,
}

/// A line between pixels that is a lattice line, but for rounding errors, is taken for that line.
const ROUNDING: f64 = 1.0 / 65536.0;

impl GridOnLattice {
    pub fn new(grid: &PixelGrid, lattice: &Lattice) -> Self {
        let steps = grid.pixel / lattice.step();
        let origin = (grid.origin - lattice.bounds().min) / lattice.step();
        Self { origin, steps, pixels_per_step: 1.0 / steps, log_steps: exponent(steps.min_element()) }
    }

    /// Returns the binary logarithm of the shorter side of a pixel in lattice steps, rounded down.
    pub fn log_steps(&self) -> i32 {
        self.log_steps
    }

    /// Returns the lines between squares at a scale, across an axis.
    #[inline]
    fn lines(&self, scale: i32, axis: usize) -> Lines {
        Lines {
            origin: self.origin[axis],
            spacing: (self.steps[axis] * power_of_two(scale)).min(f64::MAX),
            per_step: self.pixels_per_step[axis] * power_of_two(-scale),
        }
    }

    /// Returns the lattice coordinate of line `n` between squares at a scale, along an axis.
    #[inline]
    fn line(&self, scale: i32, axis: usize, n: i64) -> i64 {
        self.lines(scale, axis).line(n)
    }

    /// Writes the lattice coordinates of lines between squares at a scale, along an axis, from line `n` on.
    #[inline]
    pub fn lines_from(&self, scale: i32, axis: usize, n: i64, coordinates: &mut [i64]) {
        let lines = self.lines(scale, axis);
        (n..).zip(coordinates).for_each(|(n, coordinate)| *coordinate = lines.line(n));
    }

    /// Returns the square [x, y] at a scale, see [`ValueRanges`].
    #[inline]
    pub fn square(&self, scale: i32, x: i64, y: i64) -> Cells {
        Cells {
            min: [self.line(scale, 0, x), self.line(scale, 1, y)],
            max: [self.line(scale, 0, x + 1), self.line(scale, 1, y + 1)],
        }
    }

    /// Returns the lattice lines, one along each axis, between the quarters of the square [x, y] at a scale.
    #[inline]
    pub fn middle(&self, scale: i32, [x, y]: [i64; 2]) -> [i64; 2] {
        [self.line(scale - 1, 0, 2 * x + 1), self.line(scale - 1, 1, 2 * y + 1)]
    }

    /// Returns the scale at which a rectangle of cells spans about one square. The whole raster can be
    /// smaller.
    #[inline]
    pub fn scale_of(&self, cells: &Cells) -> i32 {
        let longer = (cells.max[0] - cells.min[0]).max(cells.max[1] - cells.min[1]).max(1);
        longer.ilog2() as i32 + 1 - self.log_steps
    }

    /// Returns the squares at a scale that have cells of a rectangle: [first column, first row], [last
    /// column, last row].
    #[inline]
    pub fn squares(&self, scale: i32, cells: &Cells) -> [[i64; 2]; 2] {
        let [x0, x1] = self.lines(scale, 0).between([cells.min[0], cells.max[0] - 1]);
        let [y0, y1] = self.lines(scale, 1).between([cells.min[1], cells.max[1] - 1]);
        [[x0, y0], [x1, y1]]
    }

    /// Returns the range of the values of a raster in a rectangle of cells, and where to divide the rectangle
    /// to know more: at a line between squares. There is no such line when the range is exact.
    pub fn range(&self, raster: &impl ValueRanges, cells: &Cells) -> (ValueRange, Option<Cut>) {
        let mut scale = self.scale_of(cells).max(raster.finest());
        loop {
            let [low, high] = self.squares(scale, cells);
            let range = joined_range(raster, scale, low, high);
            if range.is_one() {
                return (range, None);
            }
            let cut = (0..2).filter(|&axis| low[axis] < high[axis]).find_map(|axis| {
                let cut = Cut { axis, at: self.line(scale, axis, high[axis]) };
                cells.admits(cut).then_some(cut)
            });
            if cut.is_some() {
                return (range, cut);
            }
            // The cells lie within one square: its quarters tell more.
            scale -= 1;
        }
    }
}

/// Lines this far from the origin of the lattice, in steps, are beyond it, and sums of them are numbers.
const BEYOND: f64 = (1_i64 << 44) as f64;
/// No line is farther from the first one: a raster has no pixel there.
const FARTHEST_LINE: i64 = 1 << 60;

/// Parallel lines at equal distances, rounded down to the lattice.
struct Lines {
    /// The lattice coordinate of line 0, not rounded.
    origin: f64,
    /// Lattice steps from line to line.
    spacing: f64,
    /// The inverse of that, rounded.
    per_step: f64,
}

impl Lines {
    /// Returns the lattice coordinate of line `n`.
    #[inline]
    fn line(&self, n: i64) -> i64 {
        let line = self.origin + n as f64 * self.spacing + ROUNDING;
        floor(line.clamp(-BEYOND, BEYOND))
    }

    /// Returns the first and the last gap between lines that have cells from `first` to `last`. Gap n follows
    /// line n.
    #[inline]
    fn between(&self, [first, last]: [i64; 2]) -> [i64; 2] {
        let (gap, end) = self.gap_and_end(first);
        if end > last {
            return [gap; 2];
        }
        // Usually the last gap is the next one.
        let is_next = self.line(gap + 2) > last;
        [gap, if is_next { gap + 1 } else { self.gap_and_end(last).0 }]
    }

    /// Returns the gap that has a cell, and the line where that gap ends.
    #[inline]
    fn gap_and_end(&self, cell: i64) -> (i64, i64) {
        let n = floor((cell as f64 - self.origin) * self.per_step).clamp(-FARTHEST_LINE, FARTHEST_LINE);
        let end = self.line(n + 1);
        // The product is rounded, and so are the lines.
        if end <= cell {
            let next = self.line(n + 2);
            return if next > cell { (n + 1, next) } else { self.gap_after(n + 2, cell) };
        }
        let start = self.line(n);
        if start <= cell {
            return (n, end);
        }
        if self.line(n - 1) <= cell { (n - 1, start) } else { self.gap_before(n - 1, cell) }
    }

    /// Returns the gap that has a cell, and the line where that gap ends, from a line at or before the cell.
    ///
    /// Where lines are many to a lattice step, or far from the origin, many of them are rounded to the same
    /// place: the steps double.
    #[cold]
    fn gap_after(&self, mut before: i64, cell: i64) -> (i64, i64) {
        let mut step = 1;
        while before < FARTHEST_LINE && self.line(before + step) <= cell {
            before += step;
            step = (2 * step).min(FARTHEST_LINE - before);
        }
        self.gap_between(before, before + step.max(1), cell)
    }

    /// Returns the same from a line after the cell.
    #[cold]
    fn gap_before(&self, mut after: i64, cell: i64) -> (i64, i64) {
        let mut step = 1;
        while after > -FARTHEST_LINE && self.line(after - step) > cell {
            after -= step;
            step = (2 * step).min(after + FARTHEST_LINE);
        }
        self.gap_between(after - step.max(1), after, cell)
    }

    /// Returns the same from a line at or before the cell and one after it.
    fn gap_between(&self, mut before: i64, mut after: i64, cell: i64) -> (i64, i64) {
        while after - before > 1 {
            let middle = before.midpoint(after);
            *(if self.line(middle) <= cell { &mut before } else { &mut after }) = middle;
        }
        (before, self.line(after))
    }
}

/// Returns the range over squares from `low` to `high`, both included.
#[inline]
fn joined_range(raster: &impl ValueRanges, scale: i32, low: [i64; 2], high: [i64; 2]) -> ValueRange {
    let mut range = raster.range_anywhere(scale, low);
    for y in low[1]..=high[1] {
        for x in low[0]..=high[0] {
            range = range.union(raster.range_anywhere(scale, [x, y]));
        }
    }
    range
}

#[inline]
fn floor(v: f64) -> i64 {
    let truncated = v as i64;
    truncated.saturating_sub(i64::from((truncated as f64) > v))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    /// Returns the square of each cell along an axis, by looking at the lines one by one.
    fn squares_by_lines(origin: f64, spacing: f64, cells: std::ops::Range<i64>) -> Vec<i64> {
        let line = |n: i64| (origin + n as f64 * spacing + 1.0 / 65536.0).floor() as i64;
        let of_cell = |cell: i64| (-200..200).find(|&n| line(n) <= cell && cell < line(n + 1)).unwrap();
        cells.map(of_cell).collect()
    }

    /// Also where origins are so far away that the quotients of their distances are rounded to the next line.
    #[test]
    fn a_cell_is_between_the_line_at_or_before_it_and_the_next_one() {
        let mut random = fastrand::Rng::with_seed(2);
        for _ in 0..200_000 {
            let spacing = libm::exp2(40.0 * random.f64()) * [1.0, 1.0 + 1e-9][random.usize(..2)];
            let origin = random.f64() - libm::exp2(58.0 * random.f64());
            let lines = Lines { origin, spacing, per_step: 1.0 / spacing };
            let cell = random.i64(-4..4) + if random.bool() { 0 } else { random.i64(0..1 << 30) };
            let (gap, end) = lines.gap_and_end(cell);
            assert!(lines.line(gap) <= cell && cell < end, "{origin} {spacing} {cell}: {gap} {end}");
            assert_eq!(end, lines.line(gap + 1), "{origin} {spacing} {cell}");
        }
    }

    /// Lines that are many to a lattice step, or so far away that neighbours are rounded to one place: each
    /// answer takes few steps, or this test does not end.
    #[test]
    fn lines_of_any_distance_and_origin_are_found() {
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..20_000 {
            let spacing = libm::exp2(1800.0 * random.f64() - 900.0);
            let cell = random.i64(0..1 << 31);
            let near = cell as f64 + random.f64() + [0.0, 1.0 - ROUNDING][random.usize(..2)];
            let far = (random.f64() - 0.5) * libm::exp2(900.0 * random.f64());
            let origin = if random.bool() { near } else { far };
            let lines = Lines { origin, spacing, per_step: 1.0 / spacing };
            let (gap, end) = lines.gap_and_end(cell);
            let [low, high] = lines.between([cell, cell + random.i64(0..100)]);
            assert!(low == gap && low <= high, "{origin} {spacing} {cell}: {gap} {low} {high}");
            if gap.abs() < FARTHEST_LINE {
                assert!(lines.line(gap) <= cell && cell < end, "{origin} {spacing} {cell}: {gap} {end}");
            }
        }
    }

    #[test]
    fn common_cells_are_common_along_both_axes() {
        let cells = |x: [i64; 2], y: [i64; 2]| Cells { min: [x[0], y[0]], max: [x[1], y[1]] };
        let square = cells([0, 4], [0, 4]);
        assert_eq!(square.intersection(&cells([2, 9], [3, 5])), Some(cells([2, 4], [3, 4])));
        for beside in
            [cells([4, 8], [0, 4]), cells([0, 4], [4, 8]), cells([5, 8], [1, 2]), cells([1, 2], [9, 9])]
        {
            assert_eq!(square.intersection(&beside), None);
            assert_eq!(beside.intersection(&square), None);
        }
    }

    #[test]
    fn squares_of_cells_are_those_between_their_lines() {
        let mut random = fastrand::Rng::with_seed(8);
        let (mut next, mut behind_an_empty_one) = (0, 0);
        for _ in 0..20_000 {
            let origin = dvec2(random.f64() - 0.5, random.f64() - 0.5) * 4.0;
            // Also pixels that are finer than the lattice: some have no cell.
            let steps = dvec2(0.6 + 3.0 * random.f64(), 0.6 + 3.0 * random.f64());
            let log_steps = exponent(steps.min_element());
            let grid = GridOnLattice { origin, steps, pixels_per_step: 1.0 / steps, log_steps };
            let scale = random.i32(0..3);
            let min = [0, 0].map(|_| random.i64(0..20));
            let cells = Cells { min, max: min.map(|v| v + random.i64(1..6)) };
            let [low, high] = grid.squares(scale, &cells);
            for axis in 0..2 {
                let spacing = steps[axis] * f64::from(1 << scale);
                let expected = squares_by_lines(origin[axis], spacing, cells.min[axis]..cells.max[axis]);
                assert_eq!(Some(&low[axis]), expected.first(), "{origin} {steps} {cells:?}");
                assert_eq!(Some(&high[axis]), expected.last(), "{origin} {steps} {cells:?}");
                next += usize::from(high[axis] == low[axis] + 1);
                let jump = expected.windows(2).any(|pair| pair[1] == pair[0] + 2);
                behind_an_empty_one += usize::from(expected.len() == 2 && jump);
            }
        }
        assert!(next > 5_000 && behind_an_empty_one > 50, "{next} {behind_an_empty_one}");
    }
}
