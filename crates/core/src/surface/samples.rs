//! The samples of a surface: values on grids, and the surface between them.

use std::sync::Arc;

use glam::DVec2;

use super::errors::ErrorLayers;
use crate::geometry::Rect;
use crate::layers::{Layer, LayerId, Mask, Surface, SurfaceSource};
use crate::raster::RasterPyramid;

/// Farthest that a corner without a value may be from a pixel with one, in pixels.
const FARTHEST_PIXEL: u32 = 64;

/// The samples of the surface that the visible layers of a stack describe. At each place the topmost layer
/// that covers it and has a value counts.
#[derive(Clone, Debug, Default)]
pub struct SurfaceSamples {
    /// From the top to the bottom.
    pub(super) layers: Vec<LayerSamples>,
    pub(super) count: SampleCount,
    /// The minimum and the maximum value of a sample in the domain.
    pub(super) range: Option<[f64; 2]>,
    pub(super) errors: ErrorLayers,
}

/// How many samples of the layers are in the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleCount {
    /// Those with a value.
    pub known: usize,
    /// Those at which no layer has a value. There the mesh is not refined.
    pub missing: usize,
}

impl SampleCount {
    /// Returns the share of samples without a value, 0 to 1.
    pub fn missing_share(self) -> f64 {
        self.missing as f64 / (self.known + self.missing).max(1) as f64
    }

    fn plus(self, other: Self) -> Self {
        Self { known: self.known + other.known, missing: self.missing + other.missing }
    }
}

/// Figures of some samples: how many there are, and their minimum and maximum.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SampleFigures {
    pub(super) count: SampleCount,
    pub(super) range: Option<[f64; 2]>,
}

impl SampleFigures {
    /// Adds a sample with a value.
    pub(super) fn add_known(&mut self, value: f64) {
        self.count.known += 1;
        self.range = joined(self.range, Some([value; 2]));
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self { count: self.count.plus(other.count), range: joined(self.range, other.range) }
    }
}

fn joined(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Option<[f64; 2]> {
    let both = a.zip(b).map(|(a, b)| [a[0].min(b[0]), a[1].max(b[1])]);
    both.or(a).or(b)
}

/// The samples of one layer.
#[derive(Clone, Debug)]
pub(super) struct LayerSamples {
    pub(super) id: LayerId,
    pub(super) source: SurfaceSource,
    pub(super) mask: Option<Mask>,
    /// Whether no value of the source is infinite.
    pub(super) is_finite: bool,
    pub(super) grid: SampleGrid,
    /// Row by row from the lowest; NaN where the surface has no value, the domain ends, or another layer
    /// counts.
    pub(super) values: SampleValues,
    /// The areas that the samples stand for, in square world units: those of values, and those of gradients.
    pub(super) areas: [f64; 2],
    /// The largest error at each sample by layers of errors, NaN where they say none; `None` where they say
    /// none anywhere.
    pub(super) errors: Option<Vec<f32>>,
}

/// The places of samples: `first + step * (column, row)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SampleGrid {
    /// The lowest sample at the left, in world units.
    pub(super) first: DVec2,
    /// From one sample to the next along both axes, in world units.
    pub(super) step: DVec2,
    /// Columns and rows.
    pub(super) size: [u32; 2],
    /// The domain is in this rectangle, in world units.
    pub(super) bounds: Rect,
}

/// Values of samples, with the precision of their source.
#[derive(Clone, Debug)]
pub(super) enum SampleValues {
    /// All pixels of the raster count.
    Pixels(Arc<RasterPyramid>),
    /// Some pixels count.
    Singles(Vec<f32>),
    /// The values of a formula.
    Doubles(Vec<f64>),
}

/// The plane through the surface at the corners of a triangle, in the coordinates of a grid of samples:
/// columns and rows.
pub(super) struct SamplePlane {
    pub(super) corners: [DVec2; 3],
    at_first: f64,
    pub(super) gradient: DVec2,
}

/// The samples of a row in a triangle.
pub(super) struct SampleRow {
    pub(super) row: u32,
    pub(super) columns: std::ops::Range<u32>,
    /// The height of the plane at the first of them.
    first: f64,
    /// How much the plane rises from one to the next.
    rise: f64,
}

/// How far beyond an edge of a triangle a sample counts as in it, in steps of the grid: far more than the
/// rounding of its place.
pub(super) const CLOSED: f64 = 1e-9;

impl SurfaceSamples {
    /// Returns whether the surfaces of two stacks have the same samples in the same domain, whatever errors
    /// are asked for. Layers of errors, whose pixels can differ, are not compared: with them the answer is
    /// no.
    pub fn are_same(one: &[Layer], other: &[Layer]) -> bool {
        let of_errors = |layer: &&Layer| layer.visible && layer.is_of_errors();
        one.iter().chain(other).find(of_errors).is_none() && surfaces(one).eq(surfaces(other))
    }

    /// Returns the height of the surface at a point in world units: of the topmost layer that covers it and
    /// has a value; else of the topmost one with a value, whatever it covers; else of the nearest pixel
    /// within 64 pixels. `None` farther away.
    pub fn height_at(&self, point: DVec2) -> Option<f64> {
        let heights = |covering: bool| {
            let layers = self.layers.iter().filter(move |layer| !covering || layer.covers(point));
            layers.filter_map(|layer| layer.source.height_at(point))
        };
        heights(true).next().or_else(|| heights(false).next()).or_else(|| self.nearest(point))
    }

    /// Returns the minimum and the maximum of the samples in the domain; `None` without any.
    pub fn height_range(&self) -> Option<[f64; 2]> {
        self.range
    }

    /// Returns how many samples are in the domain, with a value and without.
    pub fn count(&self) -> SampleCount {
        self.count
    }

    /// Returns the value of the nearest pixel of any layer.
    fn nearest(&self, point: DVec2) -> Option<f64> {
        let rasters = self.layers.iter().filter_map(|layer| layer.source.raster());
        let found = rasters.filter_map(|source| source.raster.raster().nearest(point, FARTHEST_PIXEL));
        found.min_by(|a, b| a.distance.total_cmp(&b.distance)).map(|nearest| nearest.value)
    }
}

/// Returns what decides the samples of the visible surfaces of a stack.
fn surfaces(stack: &[Layer]) -> impl Iterator<Item = (LayerId, &SurfaceSource, &Option<Mask>)> {
    let visible = stack.iter().filter(|layer| layer.visible);
    visible.filter_map(|layer| Some((layer.id, &layer.kind.get::<Surface>()?.source, &layer.mask)))
}

impl SurfaceSource {
    /// Returns the height at a point in world units; `None` where there is none.
    pub fn height_at(&self, point: DVec2) -> Option<f64> {
        match self {
            Self::Raster(source) => {
                source.raster.raster().continued_at(point).filter(|value| value.is_finite())
            }
            Self::Formula(formula) => Some(formula.eval(point.x, point.y)).filter(|value| value.is_finite()),
        }
    }
}

impl LayerSamples {
    pub(super) fn covers(&self, point: DVec2) -> bool {
        self.mask.as_ref().is_none_or(|mask| mask.contains(point))
    }

    /// Returns whether a sample in a closed triangle, given by its corners in world units, is farther from
    /// the plane with these heights at the corners than layers of errors allow there, or than `error` where
    /// they say nothing.
    pub(super) fn exceeds(&self, corners: [DVec2; 3], heights: [f64; 3], error: f64) -> bool {
        self.is_beyond(corners, heights, error, f64::from)
    }

    /// Returns whether a sample in a closed triangle is farther from a plane than `error`, or than
    /// `of_layers` of the error that layers of errors allow there.
    fn is_beyond(
        &self,
        corners: [DVec2; 3],
        heights: [f64; 3],
        error: f64,
        of_layers: impl Fn(f32) -> f64 + Copy,
    ) -> bool {
        let plane = self.grid.plane(corners, heights);
        let most = |most: f32| if most.is_nan() { error } else { of_layers(most) };
        plane.rows(&self.grid).any(|row| match (&self.values, self.errors_in(&row)) {
            (SampleValues::Pixels(raster), None) => {
                row.exceeds(raster.raster().row(row.row, row.columns()), error)
            }
            (SampleValues::Singles(values), None) => row.exceeds(&values[self.grid.places(&row)], error),
            (SampleValues::Doubles(values), None) => row.exceeds(&values[self.grid.places(&row)], error),
            (SampleValues::Pixels(raster), Some(errors)) => {
                row.exceeds_each(raster.raster().row(row.row, row.columns()), errors, most)
            }
            (SampleValues::Singles(values), Some(errors)) => {
                row.exceeds_each(&values[self.grid.places(&row)], errors, most)
            }
            (SampleValues::Doubles(values), Some(errors)) => {
                row.exceeds_each(&values[self.grid.places(&row)], errors, most)
            }
        })
    }

    /// Returns the errors that layers of errors allow at the samples of a row, if they say any.
    fn errors_in(&self, row: &SampleRow) -> Option<&[f32]> {
        self.errors.as_ref().map(|errors| &errors[self.grid.places(row)])
    }

    /// Returns the largest difference of a sample in a closed triangle from the plane with these heights at
    /// the corners; 0 without samples. Samples with an error by layers of errors do not count.
    pub(super) fn error(&self, corners: [DVec2; 3], heights: [f64; 3]) -> f64 {
        let plane = self.grid.plane(corners, heights);
        plane.rows(&self.grid).fold(0.0, |error, row| {
            let errors = self.errors_in(&row);
            match &self.values {
                SampleValues::Pixels(raster) => {
                    row.error(raster.raster().row(row.row, row.columns()), errors, error)
                }
                SampleValues::Singles(values) => row.error(&values[self.grid.places(&row)], errors, error),
                SampleValues::Doubles(values) => row.error(&values[self.grid.places(&row)], errors, error),
            }
        })
    }

    /// Calls `visit` with the place of each sample in a closed triangle, and its difference: the plane less
    /// the sample.
    pub(super) fn each(&self, corners: [DVec2; 3], heights: [f64; 3], mut visit: impl FnMut(DVec2, f64)) {
        let plane = self.grid.plane(corners, heights);
        for row in plane.rows(&self.grid) {
            for (n, column) in row.columns().enumerate() {
                let difference = row.height(n) - self.values.get(column, row.row, &self.grid);
                if !difference.is_nan() {
                    visit(self.grid.place(column, row.row), difference);
                }
            }
        }
    }

    /// Returns whether a closed triangle, given by its corners in world units, has a sample.
    pub(super) fn has_sample(&self, corners: [DVec2; 3]) -> bool {
        self.is_beyond(corners, [0.0; 3], -1.0, |_| -1.0)
    }

    /// Returns whether a closed triangle has a sample for which layers of errors say an error.
    pub(super) fn has_sample_of_layers(&self, corners: [DVec2; 3]) -> bool {
        self.errors.is_some() && self.is_beyond(corners, [0.0; 3], f64::INFINITY, |_| -1.0)
    }
}

impl SampleValues {
    /// Appends the values of the rows that follow. Pixels that all count are replaced.
    pub(super) fn append(&mut self, more: Self) {
        match (self, more) {
            (Self::Singles(values), Self::Singles(more)) => values.extend(more),
            (Self::Doubles(values), Self::Doubles(more)) => values.extend(more),
            (values, more) => *values = more,
        }
    }

    pub(super) fn get(&self, column: u32, row: u32, grid: &SampleGrid) -> f64 {
        let place = row as usize * grid.size[0] as usize + column as usize;
        match self {
            Self::Pixels(raster) => f64::from(raster.raster().get(column, row)),
            Self::Singles(values) => f64::from(values[place]),
            Self::Doubles(values) => values[place],
        }
    }
}

impl SampleGrid {
    /// Returns the place of a sample, in world units. A sample that is beside a side of the domain by no more
    /// than rounding, [`CLOSED`] steps of the grid, is on the side.
    pub(super) fn place(&self, column: u32, row: u32) -> DVec2 {
        let place = self.first + self.step * DVec2::new(f64::from(column), f64::from(row));
        let within = place.clamp(self.bounds.min, self.bounds.max);
        DVec2::select((place - within).abs().cmple(CLOSED * self.step), within, place)
    }

    pub(super) fn places(&self, row: &SampleRow) -> std::ops::Range<usize> {
        let start = row.row as usize * self.size[0] as usize;
        start + row.columns.start as usize..start + row.columns.end as usize
    }

    /// Returns the plane with these heights at corners in world units.
    pub(super) fn plane(&self, corners: [DVec2; 3], heights: [f64; 3]) -> SamplePlane {
        let corners = corners.map(|corner| (corner - self.first) / self.step);
        let [a, b, c] = corners;
        let (u, v) = (b - a, c - a);
        let [to_b, to_c] = [heights[1] - heights[0], heights[2] - heights[0]];
        let gradient = DVec2::new(to_b * v.y - to_c * u.y, to_c * u.x - to_b * v.x) / u.perp_dot(v);
        SamplePlane { corners, at_first: heights[0], gradient }
    }
}

impl SamplePlane {
    /// Returns the rows of a grid that meet the closed triangle.
    pub(super) fn rows(&self, grid: &SampleGrid) -> impl Iterator<Item = SampleRow> {
        let [columns, rows] = grid.size;
        let heights = self.corners.map(|corner| corner.y);
        let rows = between(heights, rows);
        rows.filter_map(move |row| {
            let ends = self.ends_in(f64::from(row));
            let columns = between(ends, columns);
            (!columns.is_empty()).then(|| self.row(row, columns))
        })
    }

    fn row(&self, row: u32, columns: std::ops::Range<u32>) -> SampleRow {
        let from = DVec2::new(f64::from(columns.start), f64::from(row)) - self.corners[0];
        let first = self.at_first + self.gradient.x * from.x + self.gradient.y * from.y;
        SampleRow { row, columns, first, rise: self.gradient.x }
    }

    /// Returns the minimum and the maximum column of the triangle at a row, in any order and with repeats;
    /// NaN where it has none.
    pub(super) fn ends_in(&self, row: f64) -> [f64; 3] {
        let [a, b, c] = self.corners;
        [[a, b], [b, c], [c, a]].map(|[from, to]| {
            let rise = to.y - from.y;
            let share = (row - from.y) / rise;
            let beyond = CLOSED / rise.abs();
            if rise == 0.0 {
                // Both ends belong to other edges, too.
                return if (row - from.y).abs() <= CLOSED { from.x } else { f64::NAN };
            }
            let is_met = share >= -beyond && share <= 1.0 + beyond;
            if is_met { from.x + share.clamp(0.0, 1.0) * (to.x - from.x) } else { f64::NAN }
        })
    }
}

/// Returns the whole numbers below `end` from the least of some numbers to the greatest, both included.
fn between(numbers: [f64; 3], end: u32) -> std::ops::Range<u32> {
    let [least, greatest] =
        [numbers.into_iter().fold(f64::NAN, f64::min), numbers.into_iter().fold(f64::NAN, f64::max)];
    if least.is_nan() {
        return 0..0;
    }
    // Casts saturate: numbers below 0 become 0.
    let (start, stop) = ((least - CLOSED).ceil() as u32, ((greatest + CLOSED).floor() + 1.0) as u32);
    start.min(end)..stop.min(end)
}

impl SampleRow {
    pub(super) fn columns(&self) -> std::ops::Range<u32> {
        self.columns.clone()
    }

    /// Returns the height of the plane at the sample with this place in the row.
    #[inline]
    pub(super) fn height(&self, place: usize) -> f64 {
        self.first + self.rise * place as f64
    }

    /// Comparisons with the value of a sample that does not count, NaN, are false.
    #[inline]
    fn exceeds<V: Copy + Into<f64>>(&self, values: &[V], error: f64) -> bool {
        values.iter().enumerate().any(|(n, &value)| (value.into() - self.height(n)).abs() > error)
    }

    /// Returns whether a sample is farther from the plane than `most` of its number in `errors`.
    #[inline]
    fn exceeds_each<V: Copy + Into<f64>>(
        &self,
        values: &[V],
        errors: &[f32],
        most: impl Fn(f32) -> f64,
    ) -> bool {
        let samples = values.iter().zip(errors).enumerate();
        let mut beyond =
            samples.map(|(n, (&value, &error))| (value.into() - self.height(n)).abs() > most(error));
        beyond.any(|is_beyond| is_beyond)
    }

    /// Samples with a number in `errors` do not count.
    #[inline]
    fn error<V: Copy + Into<f64>>(&self, values: &[V], errors: Option<&[f32]>, least: f64) -> f64 {
        let counts = |n: usize| errors.is_none_or(|errors| errors[n].is_nan());
        values.iter().enumerate().fold(least, |error, (n, &value)| {
            let difference = (value.into() - self.height(n)).abs();
            if difference > error && counts(n) { difference } else { error }
        })
    }
}
