//! The areas in which a rule has changed, and what is known of the change.

use glam::DVec2;

use super::scan::Concern;
use crate::geometry::{LatticePoint, LatticeRect};
use crate::mesh::kernel::Mesh;

/// How the target diameters of a rule change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetChange {
    /// None becomes larger: no triangle that exceeded its target ceases to.
    Finer,
    /// None becomes smaller: no triangle that satisfied its target ceases to.
    Coarser,
    /// Any change.
    Any,
}

/// A rectangle to be searched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) changed: ChangedArea,
    /// Whether all triangles that touch it count as changed.
    pub(super) reports_all: bool,
}

impl Area {
    /// Returns what the change can have done to a triangle that touches the rectangle.
    #[inline]
    pub(super) fn concern(&self, mesh: &Mesh, corners: [LatticePoint; 3], level: u32) -> Concern {
        let [asks, loosens] = self.changed.concerns(mesh, corners, level);
        Concern { asks, loosens, is_reported: self.reports_all }
    }

    /// Returns the first level from which on it concerns no triangle.
    pub(super) fn levels(&self, mesh: &Mesh) -> u32 {
        if self.reports_all {
            return u32::MAX;
        }
        let least = self.changed.falloff.map_or(0.0, |falloff| falloff.least * ROUNDED_DOWN);
        let deepest = mesh.lattice().deepest_level();
        let exceeding = (0..=deepest).take_while(|&level| mesh.diameter(level) > least).count() as u32;
        // A triangle is also concerned where its parent exceeds the least diameter.
        exceeding + u32::from(self.changed.change != TargetChange::Finer)
    }
}

/// A rectangle in which the target diameters of a rule have changed, and what is known of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangedArea {
    /// Triangles that touch it can get another answer.
    pub rect: LatticeRect,
    /// The change of the target diameters.
    pub change: TargetChange,
    /// A lower bound of the target diameters that changed; `None` if it is unknown.
    pub falloff: Option<Falloff>,
}

/// A least diameter that grows with the distance from the cause of a change: no smaller target diameter is
/// other than before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falloff {
    /// The rectangle that contains the cause of the change.
    pub core: LatticeRect,
    /// The least diameter there, in world units.
    pub least: f64,
    /// The growth of this diameter per unit of length.
    pub slope: f64,
}

/// A little less than one, for rounding errors here and where the target diameters are computed.
const ROUNDED_DOWN: f64 = 1.0 - 1e-9;

impl ChangedArea {
    /// Returns whether a triangle can have begun to exceed its target, and whether its parent can have ceased
    /// to.
    #[inline]
    pub fn concerns(&self, mesh: &Mesh, corners: [LatticePoint; 3], level: u32) -> [bool; 2] {
        let least = self.falloff.map_or(0.0, |falloff| falloff.least_at(mesh, corners));
        // The answer for a triangle changes only if a changed target diameter is smaller than the triangle's.
        let exceeds = |level: u32| mesh.diameter(level) > least;
        let asks = self.change != TargetChange::Coarser && exceeds(level);
        // A triangle without a parent has no node that could go.
        let loosens = self.change != TargetChange::Finer && level > 0 && exceeds(level - 1);
        [asks, loosens]
    }
}

impl Falloff {
    /// Returns the least diameter in a triangle, in world units.
    #[inline]
    fn least_at(&self, mesh: &Mesh, [a, b, c]: [LatticePoint; 3]) -> f64 {
        let Self { core, least, slope } = self;
        if *slope == 0.0 {
            return least * ROUNDED_DOWN;
        }
        let gap =
            |low: u32, high: u32, from: u32, to: u32| low.saturating_sub(to).max(from.saturating_sub(high));
        let x = gap(core.min.x, core.max.x, a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let y = gap(core.min.y, core.max.y, a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let step = mesh.lattice().step();
        let distance = (DVec2::new(f64::from(x), f64::from(y)) * step).length();
        (least + slope * distance) * ROUNDED_DOWN
    }
}
