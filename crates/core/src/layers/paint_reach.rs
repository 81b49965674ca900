//! How far a limit of gradation carries pixels that have changed.
//!
//! As for any edit ([`reach`](super::reach)), only points are affected at which m + g d is less than what is
//! carried to them from elsewhere. That is known, or will be soon, since the mesh asks for it: so the lattice
//! is divided as the known parts are, down to small parts or parts with few triangles.
//!
//! A part of the core itself is not affected, either, where the layers that have not changed ask for at most
//! m:
//!
//! ```text
//!   ───────┐               ┌──────────    the layers that have not changed
//!          │               │
//!      ----│---------------│-------       m
//!          └───────────────┘
//!   affected  not affected  affected
//!      |            core          |
//! ```

use super::engine::KnownParts;
use super::engine::cells::Cells;
use super::engine::counting::Counting;
use super::engine::gradation::{Elsewhere, most_from_elsewhere};
use super::engine::parts::{LEAST_BITS, PartId};
use super::reach::distance_between;
use super::{PaintLayers, SizeField};

/// A field of which pixels have changed, with a limit of the slope.
pub struct RepaintedField<'a> {
    pub field: &'a SizeField,
    /// The pixels as they are now.
    pub paint: &'a PaintLayers,
    /// Largest change of h̄ per unit of length.
    pub slope: f64,
    /// The cells that have changed.
    pub cores: &'a [Cells],
    /// The layers that have not changed, if h̄ is nowhere greater than with them alone.
    pub others: Option<Counting>,
    /// What is known of the field now.
    pub known: &'a mut KnownParts,
}

/// The cells that have changed in one way.
#[derive(Clone, Copy)]
struct Core {
    cells: Cells,
    /// The least diameter there that has changed, in world units.
    least: f64,
}

/// Parts with at most about so many triangles are not divided: looking at these takes no longer.
const FEW_TRIANGLES: f64 = 128.0;

/// Nor are parts divided of which at least so many, side by side, fit across the core, or between the core
/// and the part. Where very small diameters are painted, the division would otherwise not end.
const PARTS_ACROSS: f64 = 8.0;

/// A little less than one, for rounding errors of what is carried.
const ROUNDED_DOWN: f64 = 1.0 - 1e-9;

impl RepaintedField<'_> {
    /// Returns the cells that changes of some cells can affect. `least` is the least diameter that has
    /// changed there, before or after, in world units.
    pub fn reach(&mut self, core: Cells, least: f64) -> Vec<Cells> {
        let whole = self.known.whole(&self.field.stack);
        let mut parts = Vec::new();
        self.divide(whole, Core { cells: core, least }, &[whole], &mut parts);
        parts
    }

    /// Adds the parts of a square that can have affected cells. Returns whether it added the whole. `sources`
    /// hold what is carried to the square from elsewhere.
    fn divide(&mut self, square: PartId, core: Core, sources: &[PartId], parts: &mut Vec<Cells>) -> bool {
        // Beside the lattice, nothing is missing.
        let Some(cells) = self.known.cells(square) else { return true };
        let Some(sources) = self.sources(square, &cells, core, sources) else { return false };
        if self.is_small(square, &cells, core) {
            parts.push(cells);
            return true;
        }
        let first = parts.len();
        let mut is_whole = true;
        for quarter in self.known.divided(&self.field.stack, self.paint, square, LEAST_BITS) {
            is_whole &= self.divide(quarter, core, &sources, parts);
        }
        if is_whole {
            parts.truncate(first);
            parts.push(cells);
        }
        is_whole
    }

    /// Returns whether a square is small beside the core, or beside its distance from it, or has few
    /// triangles.
    fn is_small(&mut self, square: PartId, cells: &Cells, core: Core) -> bool {
        let lattice = self.field.lattice();
        let [size, core_size] = [cells, &core.cells].map(|cells| cells.world_rect(lattice).size());
        let extent = core_size.max_element().max(distance_between(cells, &core.cells, lattice));
        if PARTS_ACROSS * size.max_element() <= extent || !self.known.is_square_above(square, LEAST_BITS) {
            return true;
        }
        let asked = self.known.diameters(&self.field.stack, self.paint, square)[0];
        let diameter = if self.meets_changed(cells) { asked.min(core.least) } else { asked };
        // The area of a triangle is a quarter of the square of its diameter.
        size.element_product() <= FEW_TRIANGLES * 0.25 * diameter * diameter
    }

    fn meets_changed(&self, cells: &Cells) -> bool {
        self.cores.iter().any(|core| core.intersection(cells).is_some())
    }

    /// Returns the parts from which values are carried to a square; `None` if the changes affect no cell of
    /// it.
    fn sources(
        &mut self,
        square: PartId,
        cells: &Cells,
        core: Core,
        sources: &[PartId],
    ) -> Option<Vec<PartId>> {
        let Self { field, paint, slope, cores, .. } = *self;
        let distance = distance_between(cells, &core.cells, field.lattice());
        let carried = (core.least + slope * distance) * ROUNDED_DOWN;
        let limit = if distance > 0.0 { carried } else { core.least };
        if limit >= field.longest() || self.greatest_unchanged(square, cells) <= limit {
            return None;
        }
        let elsewhere = Elsewhere { stack: &field.stack, paint, slope, changed: cores };
        most_from_elsewhere(&elsewhere, self.known, (cells, sources), carried)
    }

    /// Returns a diameter that h̄ does not exceed in a square, before and after.
    fn greatest_unchanged(&mut self, square: PartId, cells: &Cells) -> f64 {
        if !self.meets_changed(cells) {
            return self.known.diameters(&self.field.stack, self.paint, square)[1];
        }
        let of_others = |others| self.field.stack.diameters(self.paint, cells, others).0[1];
        self.others.map_or(f64::INFINITY, of_others)
    }
}
