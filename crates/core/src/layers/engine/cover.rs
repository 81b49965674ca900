//! Depths that hide those of layers below.

use std::sync::Arc;

use glam::DVec2;

use crate::geometry::Lattice;
use crate::layers::{Coverage, Mask};
use crate::raster::{RasterPyramid, ValueRange, ValueRanges};

use super::asked::Ternary;
use super::cells::{Cells, Cut, GridOnLattice};
use super::values::WithGaps;

/// The part of the plane in which a raster has values, within a mask.
#[derive(Clone, Debug)]
pub struct Cover {
    raster: Arc<RasterPyramid>,
    grid: GridOnLattice,
    mask: Option<Mask>,
}

/// The values of a raster in some cells.
#[derive(Clone, Copy, Debug)]
pub struct CoveredValues {
    /// Bounds of the values that it has.
    pub range: ValueRange,
    /// In how many of the cells it has one.
    pub share: Ternary,
    /// Where to divide the cells to know more.
    pub cut: Option<Cut>,
}

impl Cover {
    pub fn new(raster: &Arc<RasterPyramid>, mask: Option<&Mask>, lattice: &Lattice) -> Self {
        let grid = GridOnLattice::new(raster.grid(), lattice);
        Self { raster: raster.clone(), grid, mask: mask.cloned() }
    }

    /// Returns how many of some cells it has, and where to divide them to know more.
    pub fn share_of(&self, cells: &Cells, lattice: &Lattice) -> (Ternary, Option<Cut>) {
        let (masked, mask_cut) = share_in_mask(self.mask.as_ref(), cells, lattice);
        if masked == Ternary::Never {
            return (Ternary::Never, None);
        }
        let with_gaps = WithGaps { raster: &self.raster, gap: f32::INFINITY };
        let (range, cut) = self.grid.range(&with_gaps, cells);
        let known = match (range.least < f32::INFINITY, range.greatest < f32::INFINITY) {
            (_, true) => Ternary::Always,
            (true, false) => Ternary::Maybe,
            (false, false) => Ternary::Never,
        };
        let share = masked.and(known);
        (share, mask_cut.or(cut).filter(|_| share == Ternary::Maybe))
    }

    /// Returns the values in some cells; `None` where it has none.
    pub fn values(&self, cells: &Cells, lattice: &Lattice) -> Option<CoveredValues> {
        let (masked, mask_cut) = share_in_mask(self.mask.as_ref(), cells, lattice);
        if masked == Ternary::Never {
            return None;
        }
        let [(low, cut), (high, _)] = [f32::INFINITY, f32::NEG_INFINITY]
            .map(|gap| self.grid.range(&WithGaps { raster: &self.raster, gap }, cells));
        let known = match (low.least < f32::INFINITY, low.greatest < f32::INFINITY) {
            (false, _) => return None,
            (true, false) => Ternary::Maybe,
            (true, true) => Ternary::Always,
        };
        let range = ValueRange { least: low.least, greatest: high.greatest };
        Some(CoveredValues { range, share: masked.and(known), cut: cut.or(mask_cut) })
    }

    /// Returns the value at a point in world units, if it has one.
    pub fn value_at(&self, point: DVec2) -> Option<f32> {
        let is_covered = self.mask.as_ref().is_none_or(|mask| mask.contains(point));
        self.raster.sample(point).filter(|value| is_covered && !value.is_nan())
    }

    /// Returns whether it has a point in world units.
    pub fn contains(&self, point: DVec2) -> bool {
        self.value_at(point).is_some()
    }

    /// Returns the binary logarithm of the side of the pixels in lattice steps, rounded down.
    pub fn log_steps(&self) -> i32 {
        self.grid.log_steps()
    }
}

/// Returns how many of some cells a mask covers, all without one, and where to divide them to know more.
pub fn share_in_mask(mask: Option<&Mask>, cells: &Cells, lattice: &Lattice) -> (Ternary, Option<Cut>) {
    let Some(mask) = mask else { return (Ternary::Always, None) };
    let Some(cut) = cells.middle() else {
        return (Ternary::of(mask.contains(cells.center(lattice))), None);
    };
    match mask.classify(&cells.centers(lattice)) {
        Coverage::Inside => (Ternary::Always, None),
        Coverage::Outside => (Ternary::Never, None),
        Coverage::Mixed => (Ternary::Maybe, Some(cut)),
    }
}
