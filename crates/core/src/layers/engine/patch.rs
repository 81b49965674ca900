//! The cells of a rectangle that touch a triangle.
//!
//! ```text
//!   +---+---+---+---+     Where a line on which h̄ is ℓ runs along the side of a triangle, bounds over the
//!   | . | ./|   |   |     whole rectangle do not tell whether h̄ is less in the triangle, nor do those of
//!   +---+-/-+---+---+     smaller rectangles on the line. Bounds over the centres of the cells that touch
//!   | . |/. |   |   |     the triangle do: no other values count.
//!   +---+---+---+---+
//! ```

use glam::DVec2;

use crate::geometry::{Lattice, Octagon};

use super::cells::Cells;
use super::convex::Convex;

/// A triangle has so many times the side of rectangles at which searches look more closely.
const SMALL: i64 = 16;

/// The cells of a rectangle that touch a triangle, if there is one, and otherwise all of them.
#[derive(Clone, Copy, Debug)]
pub struct TouchedCells<'a> {
    pub cells: Cells,
    triangle: Option<&'a Octagon>,
}

impl<'a> TouchedCells<'a> {
    /// Returns the cells of a rectangle that touch a triangle.
    pub fn touching(cells: Cells, triangle: &'a Octagon) -> Self {
        Self { cells, triangle: Some(triangle) }
    }

    /// Returns whether the rectangle has been divided so often that a closer look at it is worth its time: it
    /// is small beside the triangle.
    pub fn is_small(&self) -> bool {
        let Some(([min, max], Cells { min: from, max: to })) =
            self.triangle.map(|triangle| (triangle.bounds(), self.cells))
        else {
            return false;
        };
        (0..2).all(|axis: usize| (to[axis] - from[axis]) * SMALL <= max[axis] - min[axis])
    }

    /// Returns a polygon in world units that holds the centres of the cells, and hardly more. `None` where
    /// that is the whole rectangle around all centres.
    pub fn cut_centers(&self, lattice: &Lattice) -> Option<Convex> {
        let triangle = self.triangle?;
        let [min, max] = [self.cells.min.map(|v| v as f64 + 0.5), self.cells.max.map(|v| v as f64 - 0.5)];
        let mut centers = Convex::rect(min.into(), max.into());
        let [sum, difference] = triangle.diagonals();
        let mut is_cut = false;
        for (along, [least, most]) in [(DVec2::ONE, sum), (DVec2::new(1.0, -1.0), difference)] {
            // The centre of a cell that touches a line across a diagonal is one step beyond it at most, in
            // this measure.
            is_cut |= centers.cut(along, most as f64 + 1.0);
            is_cut |= centers.cut(-along, 1.0 - least as f64);
        }
        is_cut.then(|| centers.map(|place| lattice.bounds().min + place * lattice.step()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{LatticePoint, Rect};

    /// Polygons hold the centre of each cell that touches the triangle, and no centre far away.
    #[test]
    fn the_polygon_holds_the_centres_of_the_cells_that_touch_the_triangle() {
        let lattice =
            Lattice::covering(Rect::new(DVec2::new(-3.0, 2.0), DVec2::new(5.0, 10.0)), 1.0, 1000).unwrap();
        let mut random = fastrand::Rng::with_seed(12);
        let (mut cut, mut whole) = (0, 0);
        for _ in 0..400 {
            let [x, y] = [0, 1].map(|_| 64 + random.u32(..64));
            let side = random.u32(1..20);
            let right_angle = [[x, y], [x + side, y], [x, y - side], [x + side, y + side]][random.usize(..4)];
            let corners = [right_angle, [x, y + side], [x + side, y]];
            let triangle = Octagon::triangle(corners.map(|[x, y]| LatticePoint::new(x, y)));
            let around = Cells::around(&triangle, lattice.extent());
            let low = [0, 1].map(|axis: usize| random.i64(around.min[axis]..around.max[axis]));
            let high = [0, 1].map(|axis: usize| random.i64(low[axis]..around.max[axis]) + 1);
            let cells = Cells { min: low, max: high };
            let patch = TouchedCells::touching(cells, &triangle);
            let Some(polygon) = patch.cut_centers(&lattice) else {
                whole += 1;
                continue;
            };
            cut += 1;
            for (x, y) in (low[1]..high[1]).flat_map(|y| (low[0]..high[0]).map(move |x| (x, y))) {
                let cell = Cells { min: [x, y], max: [x + 1, y + 1] };
                let center = cell.center(&lattice);
                let [distance, _] = polygon.squared_distances([center, center]);
                if triangle.meets(&cell.octagon()) {
                    assert!(distance < 1e-24, "{center} {polygon:?} {triangle:?}");
                }
            }
        }
        assert!(cut > 100 && whole > 20, "{cut} {whole}");
    }
}
