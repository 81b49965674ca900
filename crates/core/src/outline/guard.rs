//! Moves nodes back towards their homes where an angle would be too small.

use rayon::prelude::*;

use super::angles::Angles;
use super::band::{Band, GRAIN};
use super::patchwork::{Gap, gap};
use super::snap::OutlineSide;
use super::stencil::{CutTriangle, NodePlacement};

/// Lets nodes retreat until no angle is too small.
pub(super) struct Guard<'a> {
    pub(super) band: &'a Band,
    /// For each node of the band, whether the triangles at it count.
    pub(super) zone: &'a [bool],
    pub(super) angles: &'a Angles,
    /// The cotangent of the smallest angle that is allowed inside.
    pub(super) limit: f64,
    /// The pinned nodes in ascending order, each with the cotangent of the smallest angle that is allowed
    /// beside it.
    pub(super) pin_limits: Vec<(u32, f64)>,
}

impl Guard<'_> {
    /// Lets nodes retreat, in rounds, until no angle is too small: in a round, the nodes of all failing
    /// triangles take one step back at once. Returns the pinned nodes at which an angle stays too small.
    pub(super) fn run(&self, placement: &mut NodePlacement) -> Vec<u32> {
        let all = (0..self.band.triangles.len() as u32).into_par_iter().with_min_len(GRAIN);
        let gap = |t| if self.is_in_zone(t) { gap(self.band, placement, t) } else { Gap::Full };
        let gaps: Vec<Gap> = all.clone().map(gap).collect();
        let mut suspects: Vec<u32> =
            all.filter(|&t| self.is_in_zone(t) && self.can_change(placement, t)).collect();
        let mut stuck = Vec::new();
        while !suspects.is_empty() {
            let mut back = Vec::new();
            let failing = suspects.par_iter().with_min_len(GRAIN);
            let failing: Vec<[u32; 3]> =
                failing.flat_map_iter(|&t| self.failing(placement, t, gaps[t as usize])).collect();
            for corners in failing {
                let can: Vec<u32> = corners.into_iter().filter(|&v| placement.can_retreat(v)).collect();
                if can.is_empty() {
                    stuck.extend(self.stuck_pins(placement, corners));
                }
                back.extend(can);
            }
            back.sort_unstable();
            back.dedup();
            back.iter().for_each(|&v| placement.retreat(v));
            suspects = self.around(placement, &back);
        }
        stuck.sort_unstable();
        stuck.dedup();
        stuck
    }

    fn is_in_zone(&self, triangle: u32) -> bool {
        self.band.starting_at(triangle, 0, self.zone).contains(&true)
    }

    fn can_change(&self, placement: &NodePlacement, triangle: u32) -> bool {
        let corners = self.band.starting_at(triangle, 0, &placement.sides);
        corners.contains(&OutlineSide::On)
            || (corners.contains(&OutlineSide::Inside) && corners.contains(&OutlineSide::Outside))
    }

    /// Returns the triangles that have a node of `moved`, in ascending order.
    fn around(&self, placement: &NodePlacement, moved: &[u32]) -> Vec<u32> {
        let mut around = Vec::new();
        moved.iter().for_each(|&v| placement.push_triangles_at(self.band, v, &mut around));
        around.sort_unstable();
        around.dedup();
        around.retain(|&t| self.is_in_zone(t));
        around
    }

    /// Returns the corners of those pieces of a triangle that have an angle that is too small.
    fn failing(&self, placement: &NodePlacement, triangle: u32, gap: Gap) -> Vec<[u32; 3]> {
        let pieces = placement.pieces(self.band, triangle, self.angles);
        let fails = |piece: &CutTriangle| {
            let points = placement.points(piece.corners);
            match piece.inside {
                true => self.angles.worst(points) > self.limit,
                false => !gap.is_open(self.angles, piece.corners, points),
            }
        };
        pieces.into_iter().flatten().filter(fails).map(|piece| piece.corners).collect()
    }

    /// Returns the pinned nodes of a triangle whose nodes cannot retreat, if its smallest angle is below the
    /// limit of these nodes.
    fn stuck_pins(&self, placement: &NodePlacement, corners: [u32; 3]) -> Vec<u32> {
        let worst = self.angles.worst(placement.points(corners));
        let limit =
            |node| self.pin_limits.binary_search_by_key(&node, |pin| pin.0).map(|n| self.pin_limits[n].1);
        corners.into_iter().filter(|&node| limit(node).is_ok_and(|limit| worst > limit)).collect()
    }
}
