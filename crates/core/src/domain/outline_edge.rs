//! An edge of an outline in lattice coordinates, with exact tests against triangles, points and lines.

use crate::geometry::LatticePoint;

/// An edge of a region, with the region on its left.
#[derive(Clone, Copy, Debug)]
pub(super) struct OutlineEdge {
    /// The ends of the edge, in lattice coordinates.
    pub(super) ends: [[i64; 2]; 2],
    /// Whether the edge is along a side of the grid.
    pub(super) on_frame: bool,
}

/// A triangle of a mesh, with its extents along x, y, x + y and x − y: perpendicular to the directions of its
/// sides.
pub(super) struct TriangleExtents {
    places: [[i64; 2]; 3],
    extents: [[i64; 2]; 4],
}

impl TriangleExtents {
    pub(super) fn new(corners: [LatticePoint; 3]) -> Self {
        let places = corners.map(|p| [i64::from(p.x), i64::from(p.y)]);
        let along = |measure: fn([i64; 2]) -> i64| {
            let [a, b, c] = places.map(measure);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let extents = [along(|p| p[0]), along(|p| p[1]), along(|p| p[0] + p[1]), along(|p| p[0] - p[1])];
        Self { places, extents }
    }
}

impl OutlineEdge {
    /// Returns whether the edge touches a closed triangle: no line along a side of the triangle or along the
    /// edge separates them.
    pub(super) fn touches(&self, triangle: &TriangleExtents) -> bool {
        let [[ax, ay], [bx, by]] = self.ends;
        let apart = |[low, high]: [i64; 2], a: i64, b: i64| a.max(b) < low || a.min(b) > high;
        let [x, y, sum, difference] = triangle.extents;
        if apart(x, ax, bx)
            || apart(y, ay, by)
            || apart(sum, ax + ay, bx + by)
            || apart(difference, ax - ay, bx - by)
        {
            return false;
        }
        // Lattice coordinates stay below 2^31, so the products fit.
        let sides = triangle.places.map(|[px, py]| (bx - ax) * (py - ay) - (by - ay) * (px - ax));
        !(sides.iter().all(|&s| s > 0) || sides.iter().all(|&s| s < 0))
    }

    /// Returns the extent along x plus its extent along y, in lattice steps.
    pub(super) fn length(&self) -> u64 {
        let [[ax, ay], [bx, by]] = self.ends;
        ax.abs_diff(bx) + ay.abs_diff(by)
    }

    /// Returns whether a point, given by three times its coordinates, lies on the edge.
    pub(super) fn holds(&self, [px, py]: [i64; 2]) -> bool {
        let [[ax, ay], [bx, by]] = self.ends.map(|end| end.map(|c| 3 * c));
        let between = |a: i64, b: i64, p: i64| a.min(b) <= p && p <= a.max(b);
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        between(ax, bx, px) && between(ay, by, py) && product(bx - ax, py - ay) == product(by - ay, px - ax)
    }

    /// Returns whether the edge crosses the horizontal line through a point, left of the point and within
    /// `left..right`. All numbers are in thirds of a lattice step. An end on the line counts as below it.
    pub(super) fn crosses_between(&self, left: i64, right: i64, [px, py]: [i64; 2]) -> bool {
        let [[ax, ay], [bx, by]] = self.ends.map(|end| end.map(|c| 3 * c));
        if (ay <= py) == (by <= py) {
            return false;
        }
        // The crossing is at x = ax + (py − ay) (bx − ax) / (by − ay).
        let (rise, run) = (i128::from(by - ay), i128::from(bx - ax));
        let is_left_of = |limit: i64| {
            if (ax < limit) == (bx < limit) {
                return ax < limit;
            }
            let limit_run = i128::from(limit) - i128::from(ax);
            let (crossing, bound) = (i128::from(py - ay) * run, limit_run * rise);
            if rise > 0 { crossing < bound } else { crossing > bound }
        };
        is_left_of(px) && is_left_of(right) && (left == i64::MIN || !is_left_of(left))
    }

    /// Returns whether the edge crosses the vertical line just left of `px` between two heights. All numbers
    /// are in thirds of a lattice step. To agree with [`Self::crosses_between`], the heights are
    /// infinitesimally higher than given, by less than the line is left of `px`.
    pub(super) fn crosses_beside(&self, px: i64, from: i64, to: i64) -> bool {
        let [[ax, ay], [bx, by]] = self.ends.map(|end| end.map(|c| 3 * c));
        if (ax < px) == (bx < px) {
            return false;
        }
        // The line through the edge meets px at y = ay + (px − ax) (by − ay) / (bx − ax).
        let (run, rise) = (i128::from(bx - ax), i128::from(by - ay));
        let is_above = |height: i64| {
            let offset = (i128::from(px - ax) * rise - i128::from(height - ay) * run) * run.signum();
            offset > 0 || (offset == 0 && rise * run < 0)
        };
        is_above(from) != is_above(to)
    }

    /// Calls `touched` for every square of a grid that the edge touches, sides included. `counts` is
    /// [columns, rows], `bits` the binary logarithm of a square's side; squares are numbered row by row.
    pub(super) fn squares_touched(&self, counts: [u32; 2], bits: u32, mut touched: impl FnMut(usize)) {
        let [[ax, ay], [bx, by]] = self.ends;
        let (low, high) = ([ax.min(bx), ay.min(by)], [ax.max(bx), ay.max(by)]);
        let first = |c: i64| ((c - 1) >> bits).max(0);
        let last = |c: i64, count: u32| (c >> bits).min(i64::from(count) - 1);
        for row in first(low[1])..=last(high[1], counts[1]) {
            let (bottom, top) = (row << bits, (row + 1) << bits);
            // The part of the edge at these heights, and the columns that it may touch.
            let (from, to) = self.columns_between(bottom, top);
            for column in first(from.max(low[0]))..=last(to.min(high[0]), counts[0]) {
                touched(row as usize * counts[0] as usize + column as usize);
            }
        }
    }

    /// Returns the smallest and largest x of the part of the edge between two heights, rounded outwards.
    fn columns_between(&self, bottom: i64, top: i64) -> (i64, i64) {
        let [[ax, ay], [bx, by]] = self.ends;
        if ay == by {
            return (ax.min(bx), ax.max(bx));
        }
        let at = |height: i64| {
            let height = height.clamp(ay.min(by), ay.max(by));
            let (run, rise) = (i128::from(bx - ax) * i128::from(height - ay), i128::from(by - ay));
            let floor = run.div_euclid(rise);
            let exact = run.rem_euclid(rise) == 0;
            // A negative divisor rounds up instead of down: the interval of one step to both sides contains
            // the exact value.
            (ax + floor as i64 - i64::from(!exact), ax + floor as i64 + i64::from(!exact))
        };
        let ((l0, h0), (l1, h1)) = (at(bottom), at(top));
        (l0.min(l1), h0.max(h1))
    }
}
