//! The areas in which a rule has changed, and what is known about the change.

use glam::DVec2;

use super::scan::Concern;
use crate::geometry::{LatticePoint, LatticeRect};
use crate::mesh::kernel::Mesh;

/// How the target diameters of a rule change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetChange {
    /// None becomes larger: every triangle that exceeded its target still does.
    Finer,
    /// None becomes smaller: every triangle that satisfied its target still does.
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
        if self.reports_all { u32::MAX } else { self.changed.levels(mesh) }
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

/// A minimum diameter that grows with the distance from the cause of a change: no smaller target diameter has
/// changed.
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
    /// Returns the first level from which on it concerns no triangle.
    pub(in crate::mesh) fn levels(&self, mesh: &Mesh) -> u32 {
        let least = self.falloff.map_or(0.0, |falloff| falloff.least * ROUNDED_DOWN);
        let deepest = mesh.lattice().deepest_level();
        let exceeding = (0..=deepest).take_while(|&level| mesh.diameter(level) > least).count() as u32;
        // A triangle is also affected where its parent exceeds the minimum diameter.
        exceeding + u32::from(self.change != TargetChange::Finer)
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::Limits;

    /// The least diameter in a triangle is that at its nearest point to the core, and no less than by the
    /// rectangle around the triangle.
    #[test]
    fn the_least_diameter_grows_with_the_distance_from_the_core() {
        let lattice = Lattice::covering(Rect::UNIT, 0.25, 100).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let (extent, step) = (lattice.extent(), lattice.step());
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..2_000 {
            let mut point = || LatticePoint::new(random.u32(..=extent.x), random.u32(..=extent.y));
            let (first, last) = (point(), point());
            let core = LatticeRect {
                min: LatticePoint::new(first.x.min(last.x), first.y.min(last.y)),
                max: LatticePoint::new(first.x.max(last.x), first.y.max(last.y)),
            };
            let corners = [point(), point(), point()];
            let falloff = Falloff { core, least: 0.1, slope: 0.5 };
            let least = falloff.least_at(&mesh, corners);
            let world = |point: LatticePoint| point.as_dvec2() * step;
            let beyond = |at: DVec2| at - at.clamp(world(core.min), world(core.max));
            let at_corners = corners.map(|corner| beyond(world(corner)));
            for (at, share) in at_corners.iter().zip([0.2, 0.5, 0.9]) {
                let between = beyond(world(corners[0]).lerp(world(corners[1]), share));
                for gap in [at, &between] {
                    assert!(least <= 0.1 + 0.5 * gap.length(), "{corners:?} {core:?}");
                }
            }
            // The rectangle around the triangle is that far away along each axis.
            let [low, high] = [DVec2::min, DVec2::max].map(|end| at_corners.into_iter().reduce(end).unwrap());
            let gap = low.max(DVec2::ZERO).max(-high.min(DVec2::ZERO));
            let expected = 0.1 + 0.5 * gap.length();
            assert!((least / expected - 1.0).abs() < 1e-8, "{least} {expected}");
        }
        let core = LatticeRect { min: LatticePoint::new(0, 0), max: extent };
        let uniform = Falloff { core, least: 0.1, slope: 0.0 };
        assert_eq!(uniform.least_at(&mesh, [core.min; 3]), 0.1 * ROUNDED_DOWN);
    }
}
