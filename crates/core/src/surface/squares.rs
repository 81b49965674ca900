//! Sums of squares over the samples in triangles: the errors of L² and H¹.

use glam::DVec2;
use rayon::prelude::*;

use super::samples::{
    CLOSED, LayerSamples, SampleGrid, SamplePlane, SampleRow, SampleValues, SurfaceSamples,
};
use crate::layers::SurfaceNorm;

impl SurfaceSamples {
    /// Returns the area that a sum of squares is divided by, for the norms that have one, in square world
    /// units.
    pub(super) fn area(&self, norm: SurfaceNorm) -> f64 {
        self.layers.iter().map(|layer| layer.areas[usize::from(norm == SurfaceNorm::Gradient)]).sum()
    }

    /// Returns the root of a mean: of the sum of the squares over triangles.
    pub(crate) fn root_of_mean(&self, squares: f64, norm: SurfaceNorm) -> f64 {
        let area = self.area(norm);
        if area > 0.0 { libm::sqrt(squares.max(0.0) / area) } else { 0.0 }
    }
}

impl LayerSamples {
    /// Returns the integral over a closed triangle, given by its corners in world units, of the square of the
    /// difference from the plane with these heights at the corners. Each sample stands for the area of a cell
    /// of the grid, which triangles that share it divide by their angles there ([`SamplePlane::weights`]).
    ///
    /// For the gradient, samples are at the middle between four values.
    pub(super) fn squares(&self, corners: [DVec2; 3], heights: [f64; 3], norm: SurfaceNorm) -> f64 {
        let cell = self.grid.step.x * self.grid.step.y;
        let sum = match norm {
            SurfaceNorm::Gradient => self.squares_of_gradients(corners, heights),
            SurfaceNorm::Largest | SurfaceNorm::RootMeanSquare => self.squares_of_values(corners, heights),
        };
        sum * cell
    }

    fn squares_of_values(&self, corners: [DVec2; 3], heights: [f64; 3]) -> f64 {
        let plane = self.grid.plane(corners, heights);
        let rows = plane.rows(&self.grid).map(|row| {
            let weights = plane.weights(&row, &self.grid);
            match &self.values {
                SampleValues::Pixels(raster) => {
                    row.squares(raster.raster().row(row.row, row.columns()), weights)
                }
                SampleValues::Singles(values) => row.squares(&values[self.grid.places(&row)], weights),
                SampleValues::Doubles(values) => row.squares(&values[self.grid.places(&row)], weights),
            }
        });
        rows.sum()
    }

    fn squares_of_gradients(&self, corners: [DVec2; 3], heights: [f64; 3]) -> f64 {
        let grid = self.grid.between();
        let plane = grid.plane(corners, heights);
        let rows = plane.rows(&grid).map(|row| {
            let (weights, count) = (plane.weights(&row, &grid), row.columns().len());
            let squares = row.columns().enumerate().map(|(n, column)| {
                let difference = (self.rise(column, row.row) - plane.gradient) / grid.step;
                let square = difference.length_squared();
                if square.is_nan() { 0.0 } else { weights.at(n, count) * square }
            });
            squares.sum::<f64>()
        });
        rows.sum()
    }

    /// Returns how much the surface rises from a column to the next, and from a row to the next, in the
    /// middle between four samples. NaN where one of them has no value.
    fn rise(&self, column: u32, row: u32) -> DVec2 {
        let value = |x, y| self.values.get(column + x, row + y, &self.grid);
        let ([a, b], [c, d]) = ([value(0, 0), value(1, 0)], [value(0, 1), value(1, 1)]);
        0.5 * DVec2::new(b - a + d - c, c - a + d - b)
    }

    /// Measures the areas that the samples in the domain stand for.
    pub(super) fn measure(&mut self) {
        let cell = self.grid.step.x * self.grid.step.y;
        let values = self.grid.count(|column, row| !self.values.get(column, row, &self.grid).is_nan());
        let gradients = self.grid.between().count(|column, row| !self.rise(column, row).is_nan());
        self.areas = [values, gradients].map(|count| cell * count as f64);
    }
}

impl SampleGrid {
    /// Returns the grid of the places in the middle between four samples.
    fn between(&self) -> Self {
        Self {
            first: self.first + 0.5 * self.step,
            step: self.step,
            size: self.size.map(|n| n.saturating_sub(1)),
            bounds: self.bounds,
        }
    }

    /// Returns the lower left and the upper right corner of the rectangle around the domain, in columns and
    /// rows.
    fn sides(&self) -> [DVec2; 2] {
        [self.bounds.min, self.bounds.max].map(|corner| (corner - self.first) / self.step)
    }

    /// Counts the samples in the closed rectangle around the domain that meet a condition by column and row.
    fn count(&self, meets: impl Fn(u32, u32) -> bool + Sync) -> usize {
        let [low, high] = self.sides();
        let least = (low - CLOSED).ceil().max(DVec2::ZERO).as_uvec2();
        let end = ((high + CLOSED).floor() + 1.0).max(DVec2::ZERO).as_uvec2().min(self.size.into());
        let row = |row: u32| (least.x..end.x).filter(|&column| meets(column, row)).count();
        (least.y..end.y).into_par_iter().map(row).sum()
    }
}

/// What the samples of a row count for.
#[derive(Clone, Copy, Debug)]
struct RowWeights {
    /// Of all but the first and the last.
    inner: f64,
    first: f64,
    last: f64,
}

impl RowWeights {
    #[inline]
    fn at(self, place: usize, count: usize) -> f64 {
        match place {
            0 => self.first,
            _ if place + 1 == count => self.last,
            _ => self.inner,
        }
    }
}

/// The share of a full turn that a triangle has at its right angle. It has half of it at the others, on a
/// lattice whose cells are stretched to squares.
const RIGHT_ANGLE: f64 = 0.25;

impl SamplePlane {
    /// Returns what the samples of a row count for: the angle of the triangle at the sample, as a share of
    /// that of the rectangle around the domain there. So the triangles that share a sample count it once.
    ///
    /// ```text
    ///   1/8 + 1/8 + 1/4 + …       inside, shares of a full turn: 1 within a triangle, 1/2 on an edge,
    ///      \|/                    1/4 or 1/8 at a corner
    ///     --*--
    ///      /|\                    twice that on a side of the rectangle, and four times at its corner
    /// ```
    fn weights(&self, row: &SampleRow, grid: &SampleGrid) -> RowWeights {
        let height = f64::from(row.row);
        let is_near = |a: f64, b: f64| (a - b).abs() <= CLOSED;
        let on_side = |axis: usize, at: f64| match grid.sides().iter().any(|side| is_near(side[axis], at)) {
            true => 2.0,
            false => 1.0,
        };
        let is_along_edge = self.corners.iter().filter(|corner| is_near(corner.y, height)).count() > 1;
        let inner = if is_along_edge { 0.5 } else { 1.0 };
        let ends = self.ends_in(height);
        let of_end = |column: u32| {
            let at = f64::from(column);
            let is_corner = |corner: &DVec2| is_near(corner.x, at) && is_near(corner.y, height);
            let share = match self.corners.iter().position(is_corner) {
                Some(corner) if corner == self.right_corner() => RIGHT_ANGLE,
                Some(_) => 0.5 * RIGHT_ANGLE,
                None if ends.iter().any(|end| is_near(*end, at)) => 0.5,
                None => inner,
            };
            share * on_side(0, at)
        };
        let columns = row.columns();
        let (first, last) = (of_end(columns.start), of_end(columns.end - 1));
        let [inner, first, last] = [inner, first, last].map(|weight| weight * on_side(1, height));
        RowWeights { inner, first, last }
    }

    /// Returns the number of the corner with the right angle, on a lattice whose cells are stretched to
    /// squares: two edges along the axes meet there, or it is opposite to the only one.
    fn right_corner(&self) -> usize {
        let along = [0, 1, 2].map(|n| {
            let [p, q] = [self.corners[(n + 1) % 3], self.corners[(n + 2) % 3]];
            p.x == q.x || p.y == q.y
        });
        match along.iter().filter(|along| **along).count() {
            1 => along.iter().position(|along| *along).unwrap_or(0),
            _ => along.iter().position(|along| !along).unwrap_or(0),
        }
    }
}

impl SampleRow {
    /// Returns the weighted sum of the squares of the differences. Samples that do not count are NaN.
    #[inline]
    fn squares<V: Copy + Into<f64>>(&self, values: &[V], weights: RowWeights) -> f64 {
        let square = |n: usize| {
            let difference = self.height(n) - values[n].into();
            if difference.is_nan() { 0.0 } else { difference * difference }
        };
        let count = values.len();
        let ends = weights.at(0, count) * square(0)
            + if count > 1 { weights.at(count - 1, count) * square(count - 1) } else { 0.0 };
        ends + weights.inner * (1..count.saturating_sub(1)).map(square).sum::<f64>()
    }
}
