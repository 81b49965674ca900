//! Finds the samples of a surface, in slices.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::errors::ErrorLayers;
use super::samples::{LayerSamples, SampleFigures, SampleGrid, SampleValues, SurfaceSamples};
use crate::domain::DomainOnLattice;
use crate::geometry::Lattice;
use crate::layers::{Layer, PaintLayers, Surface, SurfaceSource};
use crate::mesh::Progress;
use crate::raster::Raster;

/// The least number of steps between samples of a formula along the longer side of the domain. Coarse cells
/// are halved until there are so many, so that samples are at nodes of the mesh.
const STEPS_OF_FORMULA: u32 = 1024;

/// Finds the samples of the surface that a stack of layers describes, in slices.
#[derive(Clone, Debug)]
pub struct SurfaceSampling {
    found: SurfaceSamples,
    /// The layers of errors, until the first slice has their pixels.
    of_errors: Option<Vec<Layer>>,
    /// The layer that is next.
    layer: usize,
    /// The row that is next.
    row: u32,
}

impl SurfaceSampling {
    /// Returns the work for the layers of surfaces of a stack, from the bottom to the top, on a lattice;
    /// `None` if no visible layer is one.
    pub fn new(layers: &[Layer], lattice: &Lattice) -> Option<Self> {
        let of_errors = layers.iter().filter(|layer| layer.is_of_errors()).cloned().collect();
        let visible = layers.iter().rev().filter(|layer| layer.visible);
        let layers: Vec<LayerSamples> =
            visible.filter_map(|layer| LayerSamples::new(layer, lattice)).collect();
        let found = SurfaceSamples { layers, ..SurfaceSamples::default() };
        (!found.layers.is_empty()).then_some(Self { found, of_errors: Some(of_errors), layer: 0, row: 0 })
    }

    /// One slice of work: about `budget` samples. The pixels of the first slice count in all.
    pub fn advance(&mut self, domain: &DomainOnLattice, paint: &PaintLayers, budget: usize) -> Progress {
        if let Some(of_errors) = self.of_errors.take() {
            self.found.errors = ErrorLayers::new(&of_errors, paint);
        }
        let Some(layer) = self.found.layers.get(self.layer) else { return Progress::Done };
        let [columns, rows] = layer.grid.size;
        let count = (budget / columns.max(1) as usize).clamp(1, rows as usize) as u32;
        let range = self.row..(self.row + count).min(rows);
        // A raster of which every pixel counts stays as it is.
        let all_count = self.layer == 0 && layer.is_finite && layer.mask.is_none() && domain.is_whole();
        let new = match &layer.source {
            SurfaceSource::Raster(_) if all_count => None,
            SurfaceSource::Raster(source) => {
                Some(SampleValues::Singles(self.pixels(source.raster.raster(), domain, range.clone())))
            }
            SurfaceSource::Formula(_) => Some(SampleValues::Doubles(self.heights(domain, range.clone()))),
        };
        self.row = range.end;
        if let Some(new) = new {
            self.found.layers[self.layer].values.append(new);
        }
        let before = SampleFigures { count: self.found.count, range: self.found.range };
        let figures = before.plus(self.figures(domain, range.clone()));
        (self.found.count, self.found.range) = (figures.count, figures.range);
        self.find_errors(range);
        if self.row >= rows {
            self.found.layers[self.layer].measure();
            (self.layer, self.row) = (self.layer + 1, 0);
        }
        if self.layer == self.found.layers.len() { Progress::Done } else { Progress::More }
    }

    /// Returns the samples.
    ///
    /// # Panics
    /// Panics when the work is not done.
    pub fn take_found(&mut self) -> SurfaceSamples {
        assert_eq!(self.layer, self.found.layers.len(), "the samples are found once `advance` says so");
        std::mem::take(&mut self.found)
    }

    /// Returns the samples of a formula in some rows.
    fn heights(&self, domain: &DomainOnLattice, rows: Range<u32>) -> Vec<f64> {
        let (layer, counts) = (&self.found.layers[self.layer], self.counts(domain));
        layer.grid.each_place(rows, |place| {
            let height = counts(place).then(|| layer.source.height_at(place));
            height.flatten().unwrap_or(f64::NAN)
        })
    }

    /// Returns the samples of a raster in some rows.
    fn pixels(&self, pixels: &Raster, domain: &DomainOnLattice, rows: Range<u32>) -> Vec<f32> {
        let layer = &self.found.layers[self.layer];
        let counts = layer.grid.each_place(rows.clone(), self.counts(domain));
        let values = rows.flat_map(|row| pixels.row(row, 0..layer.grid.size[0]).iter());
        let counting = values.zip(counts).map(
            |(&value, counts)| {
                if counts && value.is_finite() { value } else { f32::NAN }
            },
        );
        counting.collect()
    }

    /// Finds the errors that layers of errors allow at the samples of some rows.
    fn find_errors(&mut self, rows: Range<u32>) {
        if self.found.errors.is_empty() {
            return;
        }
        let (layer, errors) = (&self.found.layers[self.layer], &self.found.errors);
        let is_last = rows.end == layer.grid.size[1];
        let new =
            layer.grid.each_place(rows, |place| errors.at(place).map_or(f32::NAN, |error| error as f32));
        let layer = &mut self.found.layers[self.layer];
        let all = layer.errors.get_or_insert_default();
        all.extend(new);
        if is_last && all.iter().all(|error| error.is_nan()) {
            layer.errors = None;
        }
    }

    /// Returns the figures of the samples of some rows that were found.
    fn figures(&self, domain: &DomainOnLattice, rows: Range<u32>) -> SampleFigures {
        let (layers, layer) = (&self.found.layers, &self.found.layers[self.layer]);
        let counts = self.counts(domain);
        let has_value =
            |place| layers.iter().any(|layer| layer.covers(place) && layer.source.height_at(place).is_some());
        // What is missing in two layers is missing once.
        let has_sample = |place| {
            layers[..self.layer].iter().any(|above| above.covers(place) && above.grid.has_sample_at(place))
        };
        let of_row = |row: u32| {
            let mut figures = SampleFigures::default();
            for column in 0..layer.grid.size[0] {
                let place = layer.grid.place(column, row);
                let value = layer.values.get(column, row, &layer.grid);
                if value.is_nan() {
                    figures.count.missing +=
                        usize::from(counts(place) && !has_value(place) && !has_sample(place));
                } else if layer.grid.is_in(domain, place) {
                    figures.add_known(value);
                }
            }
            figures
        };
        rows.into_par_iter().map(of_row).reduce(SampleFigures::default, SampleFigures::plus)
    }

    /// Returns the condition for a sample of the layer that is next: it is in the domain, the layer covers
    /// it, and no layer above has a value there.
    fn counts<'a>(&'a self, domain: &'a DomainOnLattice) -> impl Fn(DVec2) -> bool + Sync + 'a {
        let (above, layer) = (&self.found.layers[..self.layer], &self.found.layers[self.layer]);
        move |place| {
            let is_hidden =
                |above: &LayerSamples| above.covers(place) && above.source.height_at(place).is_some();
            layer.grid.is_in(domain, place) && layer.covers(place) && !above.iter().any(is_hidden)
        }
    }
}

impl LayerSamples {
    /// Returns the samples of a layer, without values yet; `None` if it is not one of a surface.
    fn new(layer: &Layer, lattice: &Lattice) -> Option<Self> {
        let surface = layer.kind.get::<Surface>()?;
        let (grid, values, is_finite) = match &surface.source {
            SurfaceSource::Raster(source) => {
                let raster = source.raster.raster();
                let grid = SampleGrid {
                    first: raster.pixel_center(0, 0),
                    step: raster.pixel_size(),
                    size: raster.size(),
                    bounds: lattice.bounds(),
                };
                let range = source.raster.whole().range;
                let is_finite =
                    range.is_none_or(|range| range.least.is_finite() && range.greatest.is_finite());
                (grid, SampleValues::Pixels(Arc::clone(&source.raster)), is_finite)
            }
            SurfaceSource::Formula(_) => (SampleGrid::over(lattice), SampleValues::Doubles(Vec::new()), true),
        };
        Some(Self {
            id: layer.id,
            source: surface.source.clone(),
            mask: layer.mask.clone(),
            is_finite,
            grid,
            values,
            areas: [0.0; 2],
            errors: None,
        })
    }
}

impl SampleGrid {
    /// Returns the grid of the samples of a formula: the corners of equal parts of the coarse cells.
    fn over(lattice: &Lattice) -> Self {
        let cells = lattice.cells();
        let longest = cells[0].max(cells[1]);
        let halvings = (0..lattice.halvings()).find(|&n| longest << n >= STEPS_OF_FORMULA);
        let steps = cells.map(|count| count << halvings.unwrap_or(lattice.halvings()));
        let bounds = lattice.bounds();
        let step = bounds.size() / DVec2::new(f64::from(steps[0]), f64::from(steps[1]));
        Self { first: bounds.min, step, size: steps.map(|count| count + 1), bounds }
    }

    /// Returns whether a sample of the grid stands for a point in world units.
    fn has_sample_at(&self, point: DVec2) -> bool {
        let last = DVec2::from(self.size.map(f64::from)) - 0.5;
        let at = (point - self.first) / self.step;
        at.cmpge(DVec2::splat(-0.5)).all() && at.cmple(last).all()
    }

    /// Returns whether a place of a sample is in the domain.
    fn is_in(&self, domain: &DomainOnLattice, place: DVec2) -> bool {
        // A region asks about the nearest point of the lattice.
        self.bounds.contains(place) && domain.contains(place)
    }

    /// Returns the value of a function at each place of some rows, row by row, found by several threads.
    fn each_place<T: Send>(&self, rows: Range<u32>, value: impl Fn(DVec2) -> T + Sync) -> Vec<T> {
        let columns = self.size[0];
        let places = (rows.start as usize * columns as usize)..(rows.end as usize * columns as usize);
        places
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|place| {
                value(self.place((place % columns as usize) as u32, (place / columns as usize) as u32))
            })
            .collect()
    }
}

/// Samples that a thread takes at a time.
const GRAIN: usize = 1024;
