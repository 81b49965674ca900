//! Where the values of a layer come from.

use std::sync::{Arc, OnceLock};

use crate::field::Formula;
use crate::geometry::Lattice;
use crate::layers::{Quantity, Shapes};
use crate::raster::{PixelGrid, RasterPyramid, ValueRange, ValueRanges};

use super::analytic::{Analytic, Function, Profile};
use super::cells::GridOnLattice;
use super::compiled::CompiledPlane;
use super::depth_formula::DepthFormula;

/// The source of the values of a layer.
#[derive(Clone, Debug)]
pub enum Values {
    /// There are none.
    Nothing,
    /// One value everywhere.
    Constant(Analytic),
    /// Painted pixels, which are passed with each question.
    Paint(PaintGrid),
    /// The pixels of a raster.
    Raster { raster: Arc<RasterPyramid>, gap: f32, grid: GridOnLattice },
    /// A function of the point.
    Analytic(Analytic),
    /// A function of the point and the depth there.
    Depth(DepthFormula),
}

/// The grid of the painted pixels on the lattice, as of the first question: it hardly ever changes.
#[derive(Clone, Debug, Default)]
pub struct PaintGrid(OnceLock<(PixelGrid, GridOnLattice)>);

impl PaintGrid {
    #[inline]
    pub fn on_lattice(&self, grid: &PixelGrid, lattice: &Lattice) -> GridOnLattice {
        let (of, on_lattice) = self.0.get_or_init(|| (*grid, GridOnLattice::new(grid, lattice)));
        if of == grid { *on_lattice } else { GridOnLattice::new(grid, lattice) }
    }
}

impl Values {
    /// Returns the pixels of a raster, in which places without a value have a given one.
    pub fn of_raster(raster: &Arc<RasterPyramid>, gap: f32, lattice: &Lattice) -> Self {
        let grid = GridOnLattice::new(raster.grid(), lattice);
        Self::Raster { raster: raster.clone(), gap, grid }
    }

    /// Returns painted pixels.
    pub fn paint() -> Self {
        Self::Paint(PaintGrid::default())
    }

    /// Returns a function of the distance from shapes; nothing without any.
    pub fn of_distance(shapes: Option<&Shapes>, profile: Profile) -> Self {
        shapes.cloned().map_or(Self::Nothing, |shapes| {
            Self::Analytic(Analytic::new(Function::Distance { shapes, profile }, Quantity::Diameter))
        })
    }

    /// Returns the diameters that a function gives.
    pub fn of_diameters(function: Function) -> Self {
        Self::Analytic(Analytic::new(function, Quantity::Diameter))
    }

    /// Returns the values of a formula.
    pub fn of_formula(formula: &Formula, quantity: Quantity, plane: &CompiledPlane) -> Self {
        let analytic = Analytic::new(Function::Formula(formula.clone()), quantity);
        match formula.constant() {
            _ if formula.uses_depth() => Self::Depth(DepthFormula::new(formula, quantity, plane.depths)),
            Some(_) => Self::Constant(analytic),
            None => Self::Analytic(analytic),
        }
    }
}

/// A raster in which places without a value have a given one.
pub(super) struct WithGaps<'a> {
    pub raster: &'a RasterPyramid,
    pub gap: f32,
}

impl ValueRanges for WithGaps<'_> {
    fn grid(&self) -> &PixelGrid {
        self.raster.grid()
    }

    fn coarsest(&self) -> i32 {
        self.raster.coarsest()
    }

    #[inline]
    fn range(&self, scale: i32, x: i32, y: i32) -> ValueRange {
        self.raster.range_with_gaps(scale, x, y, self.gap)
    }

    fn whole_range(&self) -> ValueRange {
        self.raster.whole().with_gaps(self.gap)
    }

    fn finest(&self) -> i32 {
        0
    }

    fn copy_values(&self, scale: i32, low: [i32; 2], high: [i32; 2], values: &mut [f32]) -> bool {
        let width = high[0].abs_diff(low[0]) as usize + 1;
        let has_pixels = scale == 0;
        if has_pixels {
            for (row, values) in (low[1]..=high[1]).zip(values.chunks_exact_mut(width)) {
                self.raster.copy_row([low[0], row], self.gap, values);
            }
        }
        has_pixels
    }
}
