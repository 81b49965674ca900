//! How far a limit of gradation carries an edit.
//!
//! Let h before gradation change within a core only, where it is at least m before and after. Then h̄ at a
//! point x beyond can change only through a point of the core, so that it is at least m + g d at distance d;
//! and it is at most what is carried to x from elsewhere, which is the same before and after: h(x) itself, or
//! h(y) + g |x − y| from any y beyond the core. So only points are affected at which m + g d is less than all
//! of that:
//!
//! ```text
//!        h(x) ─────────────┐
//!                     .·´  │      affected on the left of *, up to the core, and not where h̄ is small
//!                  .*´·.   └───────────
//!   m + g d    .·´      `·.     carried from a fine place on the right
//!   ──────────´
//!   core │      d ─▶
//! ```
//!
//! A rectangle around the core is divided, and the parts without such points are left out.

use super::engine::KnownParts;
use super::engine::cells::Cells;
use super::engine::counting::Counting;
use super::engine::gradation::{Elsewhere, most_from_elsewhere};
use super::engine::parts::PartId;
use super::{PaintLayers, SizeField};
use crate::geometry::Lattice;

/// Two fields on the same lattice that differ before gradation in some parts, and the limit of the slope that
/// they have in common.
pub struct Reach<'a> {
    pub fields: [&'a SizeField; 2],
    pub paint: &'a PaintLayers,
    /// Largest change of h̄ per unit of length.
    pub slope: f64,
    /// Where only pixels have changed: all cores, and what is known of the one field.
    pub repainted: Option<(&'a [Cells], &'a mut KnownParts)>,
}

/// How often the rectangle around the core is made smaller as a whole.
const MOST_ROUNDS: usize = 8;
/// How often the rectangle is divided in quarters where two fields are compared.
const DEEPEST: u32 = 4;
/// How often it is divided where what is carried from elsewhere is known.
const DEEPEST_REPAINTED: u32 = 5;

impl Reach<'_> {
    /// Returns the cells that an edit of a core can affect. `least` is the least diameter within the core
    /// before and after, in world units.
    pub fn of(&mut self, core: Cells, least: f64) -> Vec<Cells> {
        let Some(around) = self.around(&core, least) else { return vec![core] };
        let mut parts = vec![core];
        if around != core {
            let (depth, sources) = match &mut self.repainted {
                None => (DEEPEST, Vec::new()),
                Some((_, known)) => (DEEPEST_REPAINTED, vec![known.whole(self.fields[0])]),
            };
            self.divide(&around, (&core, least), &sources, depth, &mut parts);
        }
        parts
    }

    /// Returns a rectangle around the core that holds all affected cells.
    fn around(&self, core: &Cells, least: f64) -> Option<Cells> {
        let mut distance = self.farthest(least, self.longest());
        let mut around = cells_within(core, distance, self.lattice())?;
        for _ in 0..MOST_ROUNDS {
            let next = self.farthest(least, self.bounds(&around)[1]);
            if next > 0.9 * distance {
                break;
            }
            distance = next;
            around = cells_within(core, distance, self.lattice())?;
        }
        Some(around)
    }

    /// Returns the distance from which on a diameter does not matter where h is `greatest`, in world units.
    fn farthest(&self, least: f64, greatest: f64) -> f64 {
        (greatest.min(self.longest()) * (1.0 + 1e-9) - least).max(0.0) / self.slope
    }

    /// Adds the parts of a rectangle that can have affected cells. Returns whether it added the whole.
    /// `sources` hold what is carried to the rectangle from elsewhere.
    fn divide(
        &mut self,
        cells: &Cells,
        edit: (&Cells, f64),
        sources: &[PartId],
        depth: u32,
        parts: &mut Vec<Cells>,
    ) -> bool {
        let Some(sources) = self.affects(cells, edit, sources) else { return false };
        let middle = [0, 1].map(|axis: usize| cells.min[axis].midpoint(cells.max[axis]));
        let can_divide = [0, 1].iter().all(|&axis| cells.min[axis] < middle[axis]);
        if depth == 0 || !can_divide {
            parts.push(*cells);
            return true;
        }
        let first = parts.len();
        let quarters = [[false, false], [true, false], [false, true], [true, true]];
        let whole = quarters
            .map(|upper| self.divide(&cells.quarter(middle, upper), edit, &sources, depth - 1, parts));
        if whole == [true; 4] {
            parts.truncate(first);
            parts.push(*cells);
        }
        whole == [true; 4]
    }

    /// Returns the parts from which the same is carried to a rectangle before and after an edit of a core;
    /// `None` if the edit affects no cell of the rectangle.
    fn affects(
        &mut self,
        cells: &Cells,
        (core, least): (&Cells, f64),
        sources: &[PartId],
    ) -> Option<Vec<PartId>> {
        let distance = distance_between(cells, core, self.lattice());
        let Some((changed, known)) = &mut self.repainted else {
            let is_near = distance <= self.farthest(least, self.bounds(cells)[1]);
            return is_near.then(Vec::new);
        };
        let ([field, _], slope) = (self.fields, self.slope);
        // A little less, for rounding errors.
        let limit = (least + slope * distance) * (1.0 - 1e-9);
        let elsewhere = Elsewhere { field, paint: self.paint, slope, changed };
        (limit < field.longest())
            .then(|| most_from_elsewhere(&elsewhere, known, (cells, sources), limit))
            .flatten()
    }

    /// Returns the least and the greatest diameter before gradation in some cells, in world units.
    fn bounds(&self, cells: &Cells) -> [f64; 2] {
        let [old, new] = self.fields;
        let [low, high] = old.diameters(self.paint, cells, Counting::ALL).0;
        if std::ptr::eq(old, new) {
            return [low, high];
        }
        // Other limits are a step of their own, which changes h̄ everywhere.
        let [new_low, new_high] = old.limited_diameters(new.asked_diameters(self.paint, cells).0);
        [low.min(new_low), high.max(new_high)]
    }

    fn longest(&self) -> f64 {
        self.fields[0].longest()
    }

    fn lattice(&self) -> &Lattice {
        self.fields[0].lattice()
    }
}

/// Returns the cells within a distance of others, in world units.
fn cells_within(core: &Cells, distance: f64, lattice: &Lattice) -> Option<Cells> {
    let all = Cells::all(lattice.extent());
    let steps = (distance / lattice.step()).ceil().to_array().map(|steps| steps.min(4e9) as i64 + 1);
    let min = [0, 1].map(|axis: usize| core.min[axis] - steps[axis]);
    let max = [0, 1].map(|axis: usize| core.max[axis] + steps[axis]);
    Cells { min, max }.intersection(&all)
}

/// Returns the distance between two closed rectangles of cells, in world units.
fn distance_between(a: &Cells, b: &Cells, lattice: &Lattice) -> f64 {
    let gap =
        [0, 1].map(|axis: usize| (a.min[axis] - b.max[axis]).max(b.min[axis] - a.max[axis]).max(0) as f64);
    (glam::DVec2::from(gap) * lattice.step()).length()
}
