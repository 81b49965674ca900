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

use super::engine::asked::Ternary;
use super::engine::cells::Cells;
use super::engine::counting::Counting;
use super::{PaintLayers, SizeField};
use crate::geometry::Lattice;

/// Two fields on the same lattice that differ before gradation in some parts, and the limit of the slope that
/// they have in common.
pub struct Reach<'a> {
    pub fields: [&'a SizeField; 2],
    pub paint: &'a PaintLayers,
    /// Largest change of h̄ per unit of length.
    pub slope: f64,
}

/// How often the rectangle around the core is made smaller as a whole.
const MOST_ROUNDS: usize = 8;
/// How often the rectangle is divided in quarters.
const DEEPEST: u32 = 4;

impl Reach<'_> {
    /// Returns the cells that an edit of a core can affect. `least` is the least diameter within the core
    /// before and after, in world units.
    pub fn of(&self, core: Cells, least: f64) -> Vec<Cells> {
        let Some(around) = self.around(&core, least) else { return vec![core] };
        let mut parts = Vec::new();
        let affected = |cells: &Cells| self.affected(cells, (&core, least));
        around.add_parts(DEEPEST, &affected, &mut parts);
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

    /// Returns the share of some cells that an edit of a core can affect.
    fn affected(&self, cells: &Cells, (core, least): (&Cells, f64)) -> Ternary {
        let distance = distance_between(cells, core, self.lattice());
        Ternary::of(distance <= self.farthest(least, self.bounds(cells)[1])).masked()
    }

    /// Returns the least and the greatest diameter before gradation in some cells, in world units.
    fn bounds(&self, cells: &Cells) -> [f64; 2] {
        let [old, new] = self.fields;
        let [low, high] = old.stack.diameters(self.paint, cells, Counting::ALL).0;
        // Other limits are a step of their own, which changes h̄ everywhere.
        let [new_low, new_high] = old.stack.limited_diameters(new.stack.asked_diameters(self.paint, cells).0);
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
pub(super) fn distance_between(a: &Cells, b: &Cells, lattice: &Lattice) -> f64 {
    let gap =
        [0, 1].map(|axis: usize| (a.min[axis] - b.max[axis]).max(b.min[axis] - a.max[axis]).max(0) as f64);
    (glam::DVec2::from(gap) * lattice.step()).length()
}
