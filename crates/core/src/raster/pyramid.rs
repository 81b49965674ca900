//! A raster with the range of its values over squares of any size.

use glam::DVec2;

use super::{PixelGrid, Raster, ValueRange, ValueRanges};
use crate::geometry::Rect;

/// A raster with the ranges of its values over squares of 4 × 4, 8 × 8 … pixels. Pixels without a value are
/// NaN.
///
/// The pixels take four bytes each, and the ranges a sixth of that. Ranges over 2 × 2 pixels are computed
/// from the pixels when they are needed.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterPyramid {
    raster: Raster,
    grid: PixelGrid,
    /// The squares of scale 2, 3 …, up to a single one.
    scales: Vec<PyramidLevel>,
}

/// The values in a part of a raster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SquareValues {
    /// The range of the values, or `None` if there are none.
    pub range: Option<ValueRange>,
    /// Whether some point has no value: in a pixel without one, or beyond the raster.
    pub has_gaps: bool,
}

/// The squares of one scale, row by row from the lowest.
#[derive(Clone, Debug, PartialEq)]
struct PyramidLevel {
    /// [columns, rows].
    size: [u32; 2],
    /// Columns and rows of squares that do not reach beyond the raster.
    inside: [u32; 2],
    /// The range of each square; [`NO_VALUES`] if no pixel has a value.
    ranges: Vec<ValueRange>,
    /// A bit for each square, set if a pixel has no value. Empty if all pixels have one.
    gaps: Vec<u64>,
}

const NO_VALUES: ValueRange = ValueRange { least: f32::INFINITY, greatest: f32::NEG_INFINITY };

/// The scale of the smallest squares whose ranges are stored.
const FINEST: i32 = 2;

impl RasterPyramid {
    /// Computes the ranges of all squares.
    pub fn new(raster: Raster) -> Self {
        let mut scales = vec![PyramidLevel::of_pixels(&raster)];
        while let Some(finer) = scales.last().filter(|squares| squares.size != [1, 1]) {
            scales.push(PyramidLevel::of_squares(finer));
        }
        let grid = PixelGrid::filling(&raster.bounds(), raster.size());
        Self { raster, grid, scales }
    }

    /// Returns the pixels.
    pub fn raster(&self) -> &Raster {
        &self.raster
    }

    /// Returns memory of pixels and ranges, in bytes.
    pub fn bytes(&self) -> usize {
        let of_scale = |squares: &PyramidLevel| size_of_val(&*squares.ranges) + size_of_val(&*squares.gaps);
        self.raster.bytes() + self.scales.iter().map(of_scale).sum::<usize>()
    }

    /// Returns the value at a point in world units, `None` beyond the raster and at pixels without a value.
    /// On a line between pixels the right or upper pixel counts.
    pub fn sample(&self, point: DVec2) -> Option<f32> {
        self.raster.sample(point).filter(|value| !value.is_nan())
    }

    /// Returns the values in the square in column `x` and row `y` at a scale, see `ValueRanges`.
    pub fn square(&self, scale: i32, x: i32, y: i32) -> SquareValues {
        let coarsest = FINEST + self.scales.len() as i32 - 1;
        if scale < 0 {
            let down = (-scale).min(31);
            return self.square(0, x >> down, y >> down);
        }
        if scale > coarsest {
            // The square [0, 0] contains the whole raster.
            let whole = if [x, y] == [0, 0] { self.whole() } else { SquareValues::NONE };
            return SquareValues { has_gaps: true, ..whole };
        }
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return SquareValues::NONE };
        match scale {
            0 => self.pixel(x, y),
            1 => {
                let [x, y] = [x, y].map(|place| place.saturating_mul(2));
                let [right, upper] = [x, y].map(|place| place.saturating_add(1));
                let lower = self.pixel(x, y).union(self.pixel(right, y));
                lower.union(self.pixel(x, upper).union(self.pixel(right, upper)))
            }
            _ => {
                let values = self.scales[(scale - FINEST) as usize].get(x, y);
                let reaches_beyond = [x, y]
                    .iter()
                    .zip(self.raster.size())
                    .any(|(&place, side)| (u64::from(place) + 1) << scale > u64::from(side));
                SquareValues { has_gaps: values.has_gaps || reaches_beyond, ..values }
            }
        }
    }

    /// Returns the range of the values in the square in column `x` and row `y` at a scale, with the value
    /// `gap` for pixels that have none.
    #[inline]
    pub(crate) fn range_with_gaps(&self, scale: i32, x: i32, y: i32, gap: f32) -> ValueRange {
        let known = match scale {
            0 => self.value(x as u32, y as u32).map(ValueRange::one),
            1 => self.four_pixels(x as u32, y as u32),
            _ => {
                self.scales.get(scale.wrapping_sub(FINEST) as usize).and_then(|s| s.whole(x as u32, y as u32))
            }
        };
        known.unwrap_or_else(|| self.range_of_rare_square(scale, x, y, gap))
    }

    /// Writes the values of pixels from [column, row] to the right, with the value `gap` for those that have
    /// none.
    #[inline]
    pub(crate) fn copy_row(&self, [column, row]: [i32; 2], gap: f32, values: &mut [f32]) {
        for (x, value) in (column..).zip(values) {
            *value = self.value(x as u32, row as u32).unwrap_or(gap);
        }
    }

    /// Returns the result of [`Self::range_with_gaps`] for a square at the border of the raster, or with
    /// pixels without a value.
    #[cold]
    fn range_of_rare_square(&self, scale: i32, x: i32, y: i32, gap: f32) -> ValueRange {
        self.square(scale, x, y).with_gaps(gap)
    }

    /// Returns the values in all pixels.
    pub fn whole(&self) -> SquareValues {
        self.scales.last().map_or(SquareValues::NONE, |top| top.get(0, 0))
    }

    /// Returns the range of the finite values, or `None` if there are none. Reads every pixel if a value is
    /// infinite.
    pub fn finite_range(&self) -> Option<ValueRange> {
        let whole = self.whole().range?;
        if whole.least.is_finite() && whole.greatest.is_finite() {
            return Some(whole);
        }
        let finite = self.raster.values().iter().copied().filter(|value| value.is_finite());
        finite.map(ValueRange::one).reduce(ValueRange::union)
    }

    /// Returns the values in a closed rectangle in world units. They are computed from at most nine squares,
    /// so the range may include values from around the rectangle.
    pub fn values_in(&self, area: &Rect) -> SquareValues {
        let Some(common) = area.intersection(&self.raster.bounds()) else { return SquareValues::NONE };
        // Pixels that only touch the rectangle count, on both sides of a line between pixels.
        let corners = [common.min, common.max].map(|corner| self.raster.pixel_from_world(corner).floor());
        let last = self.raster.size().map(|side| side - 1);
        let place = |axis: usize, v: f64| (v.max(0.0) as u32).min(last[axis]);
        let first = [0, 1].map(|axis| place(axis, corners[0][axis] - 1.0));
        let end = [0, 1].map(|axis| place(axis, corners[1][axis] + 1.0));
        let span = (end[0] - first[0]).max(end[1] - first[1]) + 1;
        let scale = span.ilog2();
        let mut all: Option<SquareValues> = None;
        for y in first[1] >> scale..=end[1] >> scale {
            for x in first[0] >> scale..=end[0] >> scale {
                let square = self.square(scale as i32, x as i32, y as i32);
                all = Some(all.map_or(square, |all| all.union(square)));
            }
        }
        let all = all.unwrap_or(SquareValues::NONE);
        SquareValues { has_gaps: all.has_gaps || common != *area, ..all }
    }

    fn pixel(&self, x: u32, y: u32) -> SquareValues {
        let Some(value) = self.value(x, y) else { return SquareValues::NONE };
        SquareValues { range: Some(ValueRange::one(value)), has_gaps: false }
    }

    /// Returns the range of the values in a square of 2 × 2 pixels; `None` if one of them has no value, and
    /// possibly if one is infinite.
    #[inline]
    fn four_pixels(&self, x: u32, y: u32) -> Option<ValueRange> {
        let [columns, rows] = self.raster.size().map(|side| side / 2);
        if x >= columns || y >= rows {
            return None;
        }
        let stride = self.raster.size()[0] as usize;
        let place = 2 * (y as usize * stride + x as usize);
        let values = self.raster.values();
        let ([a, b], [c, d]) = (pair(&values[place..]), pair(&values[place + stride..]));
        // The sum is NaN if a value is; comparisons alone would not notice a NaN.
        if (a + b + c + d).is_nan() {
            return None;
        }
        let least = |p: f32, q: f32| if p < q { p } else { q };
        let greatest = |p: f32, q: f32| if p > q { p } else { q };
        Some(ValueRange {
            least: least(least(a, b), least(c, d)),
            greatest: greatest(greatest(a, b), greatest(c, d)),
        })
    }

    /// Returns the value of a pixel; `None` beyond the raster and for a pixel without a value.
    #[inline]
    fn value(&self, x: u32, y: u32) -> Option<f32> {
        let [columns, rows] = self.raster.size();
        (x < columns && y < rows).then(|| self.raster.get(x, y)).filter(|value| !value.is_nan())
    }
}

/// The ranges of a raster of target diameters: ∞, no target, where it has no value.
impl ValueRanges for RasterPyramid {
    fn grid(&self) -> &PixelGrid {
        &self.grid
    }

    fn coarsest(&self) -> i32 {
        let longer = self.raster.size().into_iter().max().unwrap_or(1);
        // Two squares of 2^scale pixels cover the longer side.
        (u32::BITS - longer.div_ceil(2).saturating_sub(1).leading_zeros()) as i32
    }

    fn range(&self, scale: i32, x: i32, y: i32) -> ValueRange {
        self.range_with_gaps(scale, x, y, f32::INFINITY)
    }

    fn whole_range(&self) -> ValueRange {
        self.whole().with_gaps(f32::INFINITY)
    }

    fn finest(&self) -> i32 {
        0
    }
}

impl SquareValues {
    /// No value anywhere.
    pub const NONE: Self = Self { range: None, has_gaps: true };

    /// Returns the values of both parts together.
    pub fn union(self, other: Self) -> Self {
        let range = match (self.range, other.range) {
            (Some(a), Some(b)) => Some(a.union(b)),
            (a, b) => a.or(b),
        };
        Self { range, has_gaps: self.has_gaps || other.has_gaps }
    }

    /// Returns the range of the values, with the value `gap` if some point has none.
    #[inline]
    pub fn with_gaps(self, gap: f32) -> ValueRange {
        let nothing = ValueRange::one(gap);
        match self.range {
            Some(range) if self.has_gaps => range.union(nothing),
            Some(range) => range,
            None => nothing,
        }
    }
}

impl PyramidLevel {
    /// Returns the squares of 4 × 4 pixels.
    fn of_pixels(raster: &Raster) -> Self {
        let side = 1 << FINEST;
        let size = raster.size().map(|pixels| pixels.div_ceil(side as u32));
        let mut ranges = vec![NO_VALUES; size[0] as usize * size[1] as usize];
        // The bits take a pass of their own over the few squares that need one: most rasters have no gaps.
        let mut has_gap = false;
        let rows = raster.values().chunks_exact(raster.size()[0] as usize);
        for (y, row) in rows.enumerate() {
            let start = y / side * size[0] as usize;
            let squares = &mut ranges[start..start + size[0] as usize];
            let (whole, rest) = row.as_chunks::<4>();
            for (square, pixels) in squares.iter_mut().zip(whole) {
                has_gap |= square.take(pixels);
            }
            if let Some(last) = squares.last_mut().filter(|_| !rest.is_empty()) {
                has_gap |= last.take(rest);
            }
        }
        let gaps = if has_gap { gaps_of_pixels(raster, size) } else { Vec::new() };
        let inside = raster.size().map(|pixels| pixels >> FINEST);
        Self { size, inside, ranges, gaps }
    }

    /// Combines squares into squares of twice the side.
    fn of_squares(finer: &Self) -> Self {
        let size = finer.size.map(|squares| squares.div_ceil(2));
        let mut ranges = vec![NO_VALUES; size[0] as usize * size[1] as usize];
        let mut gaps = if finer.gaps.is_empty() { Vec::new() } else { bits(size) };
        for (place, range) in finer.ranges.iter().enumerate() {
            let [x, y] = [place % finer.size[0] as usize / 2, place / finer.size[0] as usize / 2];
            let above = y * size[0] as usize + x;
            ranges[above] = ranges[above].union(*range);
            if finer.is_gap(place) {
                gaps[above / 64] |= 1 << (above % 64);
            }
        }
        Self { size, inside: finer.inside.map(|squares| squares / 2), ranges, gaps }
    }

    fn is_gap(&self, place: usize) -> bool {
        self.gaps.get(place / 64).is_some_and(|word| word >> (place % 64) & 1 == 1)
    }

    /// Returns the range of a square, if no square of this scale has gaps.
    #[inline]
    fn whole(&self, x: u32, y: u32) -> Option<ValueRange> {
        let [columns, rows] = self.inside;
        let is_whole = x < columns && y < rows && self.gaps.is_empty();
        is_whole.then(|| self.ranges[y as usize * self.size[0] as usize + x as usize])
    }

    fn get(&self, x: u32, y: u32) -> SquareValues {
        if x >= self.size[0] || y >= self.size[1] {
            return SquareValues::NONE;
        }
        let place = y as usize * self.size[0] as usize + x as usize;
        let range = Some(self.ranges[place]).filter(|range| range.least <= range.greatest);
        SquareValues { range, has_gaps: self.is_gap(place) }
    }
}

impl ValueRange {
    /// Extends the range by values, and returns whether one of them is NaN.
    fn take(&mut self, values: &[f32]) -> bool {
        let mut is_gap = false;
        for &value in values {
            is_gap |= value.is_nan();
            // `min` and `max` ignore NaN.
            self.least = self.least.min(value);
            self.greatest = self.greatest.max(value);
        }
        is_gap
    }
}

#[inline]
fn pair(values: &[f32]) -> [f32; 2] {
    [values[0], values[1]]
}

/// Returns room for a bit for each of [columns, rows] squares.
fn bits(size: [u32; 2]) -> Vec<u64> {
    vec![0; (size[0] as usize * size[1] as usize).div_ceil(64)]
}

/// Returns, for each square of 4 × 4 pixels, a bit that is set if a pixel has no value.
fn gaps_of_pixels(raster: &Raster, size: [u32; 2]) -> Vec<u64> {
    let mut gaps = bits(size);
    for (y, row) in raster.values().chunks_exact(raster.size()[0] as usize).enumerate() {
        let start = (y >> FINEST) * size[0] as usize;
        for (x, _) in row.iter().enumerate().filter(|(_, value)| value.is_nan()) {
            let place = start + (x >> FINEST);
            gaps[place / 64] |= 1 << (place % 64);
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    /// Returns a raster of random size and values; some have gaps.
    fn raster(random: &mut fastrand::Rng) -> Raster {
        let size = [0, 0].map(|_| random.u32(1..40));
        let gaps = [0.0, 0.02, 0.9, 1.0][random.usize(..4)];
        let value = |_| match random.f64() {
            chance if chance < gaps => f32::NAN,
            chance if chance > 0.99 => [f32::INFINITY, f32::NEG_INFINITY][random.usize(..2)],
            _ => 10.0 * random.f32(),
        };
        let values = (0..size[0] * size[1]).map(value).collect();
        Raster::from_values(Rect::new(dvec2(-1.0, 2.0), dvec2(2.0, 3.0)), size, values)
    }

    /// Returns the values of the pixels for which `counts` holds, found by looking at each.
    fn referee(raster: &Raster, counts: impl Fn(i64, i64) -> bool) -> (Vec<f32>, bool) {
        let (mut values, mut gaps) = (Vec::new(), false);
        for (x, y) in raster.all().pixels().filter(|&(x, y)| counts(x.into(), y.into())) {
            let value = raster.get(x, y);
            if value.is_nan() { gaps = true } else { values.push(value) }
        }
        values.sort_unstable_by(f32::total_cmp);
        (values, gaps)
    }

    #[test]
    fn squares_of_every_scale_have_the_range_of_their_pixels() {
        let mut random = fastrand::Rng::with_seed(31);
        let (mut filled, mut with_gaps) = (0, 0);
        for _ in 0..150 {
            let raster = raster(&mut random);
            let pyramid = RasterPyramid::new(raster.clone());
            let [columns, rows] = raster.size().map(i64::from);
            for scale in 0..9 {
                let side = 1i64 << scale;
                for (x, y) in
                    (-1..columns / side + 2).flat_map(|x| (-1..rows / side + 2).map(move |y| (x, y)))
                {
                    let inside = |px: i64, py: i64| px.div_euclid(side) == x && py.div_euclid(side) == y;
                    let (values, mut gaps) = referee(&raster, inside);
                    gaps |= x < 0 || y < 0 || (x + 1) * side > columns || (y + 1) * side > rows;
                    let range = values.first().map(|&least| (least, values[values.len() - 1]));
                    let square = pyramid.square(scale, x as i32, y as i32);
                    let found = square.range.map(|range| (range.least, range.greatest));
                    assert_eq!(
                        (found, square.has_gaps),
                        (range, gaps),
                        "{scale} {x} {y} of {columns} × {rows}"
                    );
                    filled += usize::from(range.is_some());
                    with_gaps += usize::from(range.is_some() && gaps);
                    let filled_in = pyramid.range(scale, x as i32, y as i32);
                    let (least, greatest) = range.unwrap_or((f32::INFINITY, f32::INFINITY));
                    assert_eq!(filled_in.least, least);
                    assert_eq!(filled_in.greatest, if gaps { f32::INFINITY } else { greatest });
                }
            }
            let coarsest = pyramid.coarsest();
            assert!(
                columns.max(rows) <= 2 << coarsest && (coarsest == 0 || columns.max(rows) > 1 << coarsest)
            );
        }
        assert!(filled > 20_000 && with_gaps > 3_000, "{filled} {with_gaps}");
    }

    #[test]
    fn below_a_pixel_squares_have_its_value() {
        let pyramid = RasterPyramid::new(Raster::from_values(Rect::UNIT, [2, 1], vec![3.0, f32::NAN]));
        assert_eq!(pyramid.range(-2, 3, 2), ValueRange::one(3.0));
        assert_eq!(pyramid.square(-2, 4, 2), SquareValues::NONE);
        assert_eq!(pyramid.square(-40, -1, 0), SquareValues::NONE);
        assert_eq!(pyramid.sample(dvec2(0.2, 0.5)), Some(3.0));
        assert_eq!(pyramid.sample(dvec2(0.7, 0.5)), None);
        assert_eq!(pyramid.sample(dvec2(-0.1, 0.5)), None);
    }

    #[test]
    fn the_values_in_a_rectangle_hold_every_sample() {
        let mut random = fastrand::Rng::with_seed(32);
        let mut samples = 0;
        for _ in 0..3_000 {
            let raster = raster(&mut random);
            let pyramid = RasterPyramid::new(raster.clone());
            let a = dvec2(4.0 * random.f64() - 1.5, 2.0 * random.f64() + 1.5);
            let size = [2.0, 0.1][random.usize(..2)] * dvec2(random.f64(), random.f64());
            let area = Rect::new(a, a + size);
            let values = pyramid.values_in(&area);
            for _ in 0..20 {
                let p = area.min + size * dvec2(random.f64(), random.f64());
                match pyramid.sample(p) {
                    Some(value) => {
                        let range = values.range.unwrap();
                        assert!(range.least <= value && value <= range.greatest, "{area:?}");
                        samples += 1;
                    }
                    None => assert!(values.has_gaps, "{area:?}"),
                }
            }
        }
        assert!(samples > 10_000, "{samples}");
    }
}
