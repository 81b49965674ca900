//! Sums of squares over the samples in triangles: the errors of L² and H¹.

use glam::DVec2;
use rayon::prelude::*;

use super::samples::{CLOSED, LayerSamples, Plane, SampleGrid, SampleRow, SampleValues, SurfaceSamples};
use crate::geometry::Rect;
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
    /// difference from the plane with these heights at the corners, by the trapezoidal rule: each sample
    /// stands for the area of a cell of the grid, and one on an edge for half of it, since the triangle at
    /// the other side has it, too.
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
            let weights = plane.weights(&row);
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
            let (weights, count) = (plane.weights(&row), row.columns().len());
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

    /// Measures the areas that samples stand for within a rectangle in world units.
    pub(super) fn measure(&mut self, bounds: &Rect) {
        let cell = self.grid.step.x * self.grid.step.y;
        let values =
            self.grid.count_in(bounds, |column, row| !self.values.get(column, row, &self.grid).is_nan());
        let gradients = self.grid.between().count_in(bounds, |column, row| !self.rise(column, row).is_nan());
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
        }
    }

    /// Counts the samples in a closed rectangle that meet a condition by column and row.
    fn count_in(&self, bounds: &Rect, meets: impl Fn(u32, u32) -> bool + Sync) -> usize {
        let [low, high] = [bounds.min, bounds.max].map(|corner| (corner - self.first) / self.step);
        let least = (low - CLOSED).ceil().max(DVec2::ZERO).as_uvec2();
        let end = ((high + CLOSED).floor() + 1.0).max(DVec2::ZERO).as_uvec2().min(self.size.into());
        let row = |row: u32| (least.x..end.x).filter(|&column| meets(column, row)).count();
        (least.y..end.y).into_par_iter().map(row).sum()
    }
}

/// What the samples of a row count for.
#[derive(Clone, Copy, Debug)]
struct Weights {
    /// Of all but the first and the last.
    inner: f64,
    first: f64,
    last: f64,
}

impl Weights {
    #[inline]
    fn at(self, place: usize, count: usize) -> f64 {
        match place {
            // A triangle that ends in a sample has it on an edge.
            0 if count == 1 => self.first.min(self.last),
            0 => self.first,
            _ if place + 1 == count => self.last,
            _ => self.inner,
        }
    }
}

impl Plane {
    /// Returns 1/2 for samples on an edge of the triangle, and 1 for others.
    fn weights(&self, row: &SampleRow) -> Weights {
        let height = f64::from(row.row);
        let is_at = |corner: &&DVec2| (corner.y - height).abs() <= CLOSED;
        let inner = if self.corners.iter().filter(is_at).count() > 1 { 0.5 } else { 1.0 };
        let ends = self.ends_in(height);
        let [least, greatest] =
            [ends.into_iter().fold(f64::NAN, f64::min), ends.into_iter().fold(f64::NAN, f64::max)];
        let (start, last) = (f64::from(row.columns.start), f64::from(row.columns.end) - 1.0);
        let of_end = |is_on_edge: bool| if is_on_edge { 0.5 } else { inner };
        Weights {
            inner,
            first: of_end((start - least).abs() <= CLOSED),
            last: of_end((greatest - last).abs() <= CLOSED),
        }
    }
}

impl SampleRow {
    /// Returns the weighted sum of the squares of the differences. Samples that do not count are NaN.
    #[inline]
    fn squares<V: Copy + Into<f64>>(&self, values: &[V], weights: Weights) -> f64 {
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
