//! Shortcuts that leave out points of a path.

use glam::DVec2;

use super::integral::PathFigures;
use super::{CostDensity, Walls};
use crate::geometry::nearest_on_segment;

/// The upper bounds of shortcuts, and of simplified paths, are above the cost by about this share.
pub(super) const SHORTCUT_TOLERANCE: f64 = 2e-5;

/// A shortcut costs at most this many times as much as the part of the path that it replaces.
const MOST_COST: f64 = 1.01;

/// Which shortcuts may be taken.
pub(super) struct Shortcuts<'a> {
    /// No point that is left out is farther from its shortcut, in world units; with a projection, in metres
    /// on the Earth.
    pub tolerance: f64,
    /// The walls, which no shortcut crosses.
    pub walls: Option<&'a Walls>,
    /// The cost density of paths.
    pub density: &'a dyn CostDensity,
}

impl Shortcuts<'_> {
    /// Returns a polyline with fewer points (Douglas and Peucker's method): where a shortcut between two
    /// points may not be taken, the point farthest from it stays, and shortcuts to and from that are tried.
    pub fn taken(&self, points: &[DVec2]) -> Vec<DVec2> {
        let costs: Vec<[f64; 2]> = points.windows(2).map(|pair| self.costs(pair[0], pair[1])).collect();
        let mut keeps = vec![false; points.len()];
        (keeps[0], keeps[points.len() - 1]) = (true, true);
        let mut parts = vec![[0, points.len() - 1]];
        while let Some([first, last]) = parts.pop() {
            let ends = [points[first], points[last]];
            let distances = (first + 1..last).map(|n| (n, self.distance(points[n], ends)));
            let Some((farthest, distance)) = distances.max_by(|p, q| p.1.total_cmp(&q.1)) else { continue };
            if distance > self.tolerance || !self.may_be_taken(ends, &costs[first..last]) {
                keeps[farthest] = true;
                parts.extend([[first, farthest], [farthest, last]]);
            }
        }
        points.iter().zip(keeps).filter_map(|(&point, keeps)| keeps.then_some(point)).collect()
    }

    /// Returns how far a point is from a segment, on the Earth where the costs are those on the Earth.
    fn distance(&self, point: DVec2, ends: [DVec2; 2]) -> f64 {
        point.distance(nearest_on_segment(point, ends)) * self.density.inverse_scale_at(point)
    }

    /// Returns whether a shortcut stays where paths may go, and neither its cost nor the upper bound of that
    /// is much above those of the pieces that it replaces.
    fn may_be_taken(&self, [a, b]: [DVec2; 2], replaced: &[[f64; 2]]) -> bool {
        if self.walls.is_some_and(|walls| !walls.admit(a, b)) {
            return false;
        }
        let own = self.costs(a, b);
        (0..2).all(|which| own[which] <= MOST_COST * replaced.iter().map(|costs| costs[which]).sum::<f64>())
    }

    /// Returns the cost of a segment, and its upper bound.
    fn costs(&self, a: DVec2, b: DVec2) -> [f64; 2] {
        let PathFigures { cost, upper, .. } = PathFigures::new(&[a, b], self.density, SHORTCUT_TOLERANCE);
        [cost, upper]
    }
}
