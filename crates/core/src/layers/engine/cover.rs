//! Depths that hide those of layers below.

use std::sync::Arc;

use glam::DVec2;

use crate::geometry::Lattice;
use crate::layers::{Coverage, Mask};
use crate::raster::{RasterPyramid, ValueRanges};

use super::asked::Share;
use super::cells::{Cells, Cut, GridOnLattice};
use super::compiled::WithGaps;

/// The part of the plane in which a raster has values, within a mask.
#[derive(Clone, Debug)]
pub struct Cover {
    raster: Arc<RasterPyramid>,
    grid: GridOnLattice,
    mask: Option<Mask>,
}

impl Cover {
    pub fn new(raster: &Arc<RasterPyramid>, mask: Option<&Mask>, lattice: &Lattice) -> Self {
        let grid = GridOnLattice::new(raster.grid(), lattice);
        Self { raster: raster.clone(), grid, mask: mask.cloned() }
    }

    /// Returns how many of some cells it has, and where to divide them to know more.
    pub fn share_of(&self, cells: &Cells, lattice: &Lattice) -> (Share, Option<Cut>) {
        let (masked, mask_cut) = share_in_mask(self.mask.as_ref(), cells, lattice);
        if masked == Share::None {
            return (Share::None, None);
        }
        let with_gaps = WithGaps { raster: &self.raster, gap: f32::INFINITY };
        let (range, cut) = self.grid.range(&with_gaps, cells);
        let known = match (range.least < f32::INFINITY, range.greatest < f32::INFINITY) {
            (_, true) => Share::All,
            (true, false) => Share::Some,
            (false, false) => Share::None,
        };
        let share = masked.and(known);
        (share, mask_cut.or(cut).filter(|_| share == Share::Some))
    }

    /// Returns whether it has a point in world units.
    pub fn contains(&self, point: DVec2) -> bool {
        self.mask.as_ref().is_none_or(|mask| mask.contains(point))
            && self.raster.sample(point).is_some_and(|value| !value.is_nan())
    }
}

/// Returns how many of some cells a mask covers, all without one, and where to divide them to know more.
pub fn share_in_mask(mask: Option<&Mask>, cells: &Cells, lattice: &Lattice) -> (Share, Option<Cut>) {
    let Some(mask) = mask else { return (Share::All, None) };
    let Some(cut) = cells.middle() else {
        return (Share::of(mask.contains(cells.center(lattice))), None);
    };
    match mask.classify(&cells.centers(lattice)) {
        Coverage::Inside => (Share::All, None),
        Coverage::Outside => (Share::None, None),
        Coverage::Mixed => (Share::Some, Some(cut)),
    }
}
