//! Ranges of the pixels of a risk over a rectangle anywhere.

use crate::geometry::Rect;
use crate::raster::{PixelGrid, RasterPyramid, ValueRange, ValueRanges, exponent, power_of_two};

/// Pixels this near to a rectangle, as a share of their side, count: places are rounded.
pub(super) const PIXEL_MARGIN: f64 = 1e-9;

/// A square this many times finer than a pixel has one value.
const FINEST_SCALE: i32 = -60;

/// A raster whose gaps have a risk of −∞.
pub(super) struct RiskWithGaps<'a>(pub &'a RasterPyramid);

impl ValueRanges for RiskWithGaps<'_> {
    fn grid(&self) -> &PixelGrid {
        self.0.grid()
    }

    fn coarsest(&self) -> i32 {
        self.0.coarsest()
    }

    fn range(&self, scale: i32, x: i32, y: i32) -> ValueRange {
        self.0.square(scale, x, y).with_gaps(f32::NEG_INFINITY)
    }

    fn whole_range(&self) -> ValueRange {
        self.0.whole().with_gaps(f32::NEG_INFINITY)
    }
}

/// Returns the range of the pixels that touch a closed rectangle in world units, and of some around it.
pub(super) fn range_within(
    raster: &impl ValueRanges,
    rectangle: &Rect,
    grid: &PixelGrid,
    gap: f32,
) -> ValueRange {
    let whole = raster.whole_range().union(ValueRange::one(gap));
    if whole.is_one() {
        return whole;
    }
    let [min, max] = [rectangle.min, rectangle.max].map(|corner| grid.pixel_from_world(corner));
    let side = (max - min).max_element();
    // Squares of about a quarter of the rectangle.
    let finest = if side > 0.0 { exponent(side) - 2 } else { FINEST_SCALE }.max(FINEST_SCALE);
    let start = if side > 1.0 { exponent(side) + 1 } else { 0 };
    if start > raster.coarsest() + 1 {
        return whole;
    }
    let search = Descent { raster, min: min.to_array(), max: max.to_array(), finest };
    let [first, last] = search.places(power_of_two(start));
    let mut range: Option<ValueRange> = None;
    for y in first[1]..=last[1] {
        for x in first[0]..=last[0] {
            let found = search.square(start, x, y);
            range = Some(range.map_or(found, |range| range.union(found)));
        }
    }
    range.unwrap_or(whole)
}

struct Descent<'a, R> {
    raster: &'a R,
    /// The corners of the rectangle in pixels.
    min: [f64; 2],
    max: [f64; 2],
    /// The scale at which descending ends.
    finest: i32,
}

impl<R: ValueRanges> Descent<'_, R> {
    /// Returns the first and the last column and row of squares of a side in pixels that touch the rectangle.
    fn places(&self, side: f64) -> [[i64; 2]; 2] {
        let margin = PIXEL_MARGIN * side.min(1.0);
        let first = self.min.map(|v| (((v - margin) / side).ceil() as i64).saturating_sub(1));
        let last = self.max.map(|v| ((v + margin) / side).floor() as i64);
        // The ceiling of a place between two lines belongs to the square before it.
        let first = [0, 1].map(|axis: usize| first[axis].min(last[axis]));
        [first, last]
    }

    fn square(&self, scale: i32, x: i64, y: i64) -> ValueRange {
        let range = self.raster.range_anywhere(scale, [x, y]);
        if range.is_one() || scale <= self.finest {
            return range;
        }
        let Some([x, y]) = x.checked_mul(2).zip(y.checked_mul(2)).map(|(x, y)| [x, y]) else { return range };
        let [first, last] = self.places(power_of_two(scale - 1));
        let columns = x.max(first[0])..=(x + 1).min(last[0]);
        let rows = y.max(first[1])..=(y + 1).min(last[1]);
        let parts = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        parts.map(|(x, y)| self.square(scale - 1, x, y)).reduce(ValueRange::union).unwrap_or(range)
    }
}
