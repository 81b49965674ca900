use std::sync::Arc;

use glam::DVec2;

use super::integral::{PathFigures, RiskAlong};
use super::shortcuts::{SHORTCUT_TOLERANCE, Shortcuts};
use super::{CostDensity, PathError, Walls};

/// A path, and how far from the best it can be.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Solution {
    /// The cost of the path, as computed.
    pub cost: f64,
    /// No path costs less: a bound of the best.
    pub lower: f64,
    /// No less than what this path costs, so the best costs no more.
    pub upper: f64,
    /// Length in world units.
    pub length: f64,
    /// Length on the Earth, in the plane of a projection; otherwise the same.
    pub length_on_ground: f64,
    /// The integral of the risk over the length, on the Earth where the plane lies there.
    pub risk: f64,
    /// The highest risk on the way.
    pub highest_risk: f64,
    /// The distance from the start of the place with the highest risk.
    pub(super) highest_risk_at: f64,
    /// The path from the start to the goal, in world units.
    pub points: Vec<DVec2>,
    /// The places in `points` of the start, the via points and the goal.
    pub stops: Vec<usize>,
    /// For each leg between stops, the walls of the mesh on which it was found: they admit it.
    pub(super) walls: Vec<Arc<Walls>>,
}

impl PartialEq for Solution {
    /// Compares paths without regard to the meshes on which they were found.
    fn eq(&self, other: &Self) -> bool {
        let figures = |one: &Self| [one.cost, one.lower, one.upper, one.length, one.risk, one.highest_risk];
        figures(self) == figures(other) && self.points == other.points && self.stops == other.stops
    }
}

/// A place on a path, for a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSample {
    /// Distance from the start along the path: on the Earth, in the plane of a projection, else in world
    /// units.
    pub distance: f64,
    /// The place, in world units.
    pub point: DVec2,
    /// The cost of the path up to this point.
    pub cost: f64,
    /// The risk there.
    pub risk: f64,
    /// The cost per unit of length there, on the Earth where the plane lies there.
    pub density: f64,
}

impl Solution {
    /// Returns the width of the interval as a share of its upper end: how much better than this path the best
    /// can be. 0 for a path that costs nothing.
    pub fn gap(&self) -> f64 {
        if self.upper > 0.0 { ((self.upper - self.lower) / self.upper).max(0.0) } else { 0.0 }
    }

    /// Raises the lower bound to another one, for example that of a certificate.
    pub fn tighten(&mut self, lower: f64) {
        self.lower = self.lower.max(lower).min(self.upper);
    }

    /// Takes over the result of a certificate: a cheaper path between the same stops, a smaller upper or a
    /// larger lower bound. Returns whether the path changed.
    ///
    /// Along jumps of the cost, bounds are far apart, and the path with the least upper bound can be more
    /// expensive than this one: then its bound counts, since this path costs less, and this path stays.
    pub fn take(&mut self, proved: Self) -> bool {
        let [lower, upper] = [self.lower.max(proved.lower), self.upper.min(proved.upper)];
        let is_cheaper = proved.upper < self.upper && proved.cost < self.cost;
        let is_other = is_cheaper && proved.points != self.points;
        if is_cheaper {
            *self = proved;
        }
        if self.cost <= upper {
            self.upper = upper;
        }
        self.tighten(lower);
        is_other
    }

    /// Returns the solution of a polyline. `tolerance` is that of [`PathFigures::new`].
    pub(super) fn new(points: Vec<DVec2>, density: &dyn CostDensity, tolerance: f64) -> Self {
        let PathFigures { cost, upper, length, length_on_ground } =
            PathFigures::new(&points, density, tolerance);
        let RiskAlong { integral: risk, highest: highest_risk, highest_at: highest_risk_at } =
            RiskAlong::new(&points, density);
        let stops = vec![0, points.len() - 1];
        Self {
            cost,
            lower: 0.0,
            upper,
            length,
            length_on_ground,
            risk,
            highest_risk,
            highest_risk_at,
            points,
            stops,
            walls: Vec::new(),
        }
    }

    /// Returns the path along several, each of which begins where the last ends.
    pub fn joined(legs: impl IntoIterator<Item = Self>) -> Self {
        let mut solution = Self::default();
        legs.into_iter().for_each(|leg| solution.append(leg));
        solution
    }

    /// Returns the places at equal distances along the path, at least two.
    pub(super) fn evenly(&self, count: usize) -> Vec<DVec2> {
        let (mut piece, mut walked) = (0, 0.0);
        let mut places = Vec::with_capacity(count);
        for n in 0..count {
            let distance = self.length * n as f64 / (count - 1) as f64;
            let length = |piece: usize| self.points[piece].distance(self.points[piece + 1]);
            while piece + 2 < self.points.len() && walked + length(piece) < distance {
                walked += length(piece);
                piece += 1;
            }
            let share = ((distance - walked) / length(piece).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            places.push(self.points[piece].lerp(self.points[piece + 1], share));
        }
        places
    }

    /// Continues the path with one that begins where it ends.
    pub(super) fn append(&mut self, next: Self) {
        if self.points.is_empty() {
            *self = next;
            return;
        }
        self.cost += next.cost;
        self.lower += next.lower;
        self.upper += next.upper;
        if next.highest_risk > self.highest_risk {
            self.highest_risk = next.highest_risk;
            self.highest_risk_at = self.length + next.highest_risk_at;
        }
        self.length += next.length;
        self.length_on_ground += next.length_on_ground;
        self.risk += next.risk;
        let end = self.points.len() - 1;
        self.points.extend(&next.points[1..]);
        self.stops.extend(next.stops[1..].iter().map(|stop| end + stop));
        self.walls.extend(next.walls);
    }

    /// Returns cost, risk and density at all points.
    pub fn samples(&self, density: &dyn CostDensity) -> Vec<PathSample> {
        let mut along = PathFigures::default();
        let mut last = self.points.first().copied().unwrap_or_default();
        let mut samples = Vec::with_capacity(self.points.len());
        for &point in &self.points {
            along.go_on(&mut last, point, density, PROFILE_TOLERANCE);
            samples.push(sample_at(point, &along, density));
        }
        samples
    }

    /// Returns cost, risk and density at `count` places at equal distances along the path, its ends among
    /// them, and at the place of the highest risk.
    pub fn profile(&self, density: &dyn CostDensity, count: usize) -> Vec<PathSample> {
        let distances = self.profile_distances(count.max(2));
        let mut samples = Vec::with_capacity(distances.len());
        let (mut piece, mut walked) = (0, 0.0);
        // Along the path so far.
        let mut along = PathFigures::default();
        let mut last = self.points.first().copied().unwrap_or_default();
        for distance in distances {
            let length = |piece: usize| self.points[piece].distance(self.points[piece + 1]);
            while piece + 2 < self.points.len() && walked + length(piece) < distance {
                walked += length(piece);
                along.go_on(&mut last, self.points[piece + 1], density, PROFILE_TOLERANCE);
                piece += 1;
            }
            let point = match piece + 1 < self.points.len() && length(piece) > 0.0 {
                true => {
                    let share = ((distance - walked) / length(piece)).clamp(0.0, 1.0);
                    self.points[piece].lerp(self.points[piece + 1], share)
                }
                false => last,
            };
            along.go_on(&mut last, point, density, PROFILE_TOLERANCE);
            let mut sample = sample_at(point, &along, density);
            if distance == self.highest_risk_at {
                // Where the risk jumps, the point may lie on the other side by a rounding error.
                sample.risk = self.highest_risk.max(sample.risk);
            }
            samples.push(sample);
        }
        samples
    }

    /// Returns `count` equal distances from the start, and that of the highest risk.
    fn profile_distances(&self, count: usize) -> Vec<f64> {
        let even = |n: usize| self.length * n as f64 / (count - 1) as f64;
        let mut distances: Vec<f64> = (0..count).map(even).collect();
        let place = distances.partition_point(|&distance| distance < self.highest_risk_at);
        if distances.get(place).is_some_and(|&distance| distance != self.highest_risk_at) {
            distances.insert(place, self.highest_risk_at);
        }
        distances
    }

    /// Returns a path with fewer points: none of those left out is farther than `tolerance` from it, in world
    /// units, with a projection in metres on the Earth (Douglas and Peucker's method).
    ///
    /// A shortcut stands for a part of the path only where it stays in the domain and out of keep-out
    /// regions, and costs at most 1 % more than that part; neither may its upper bound be larger by more.
    /// So the simplified path costs at most 1 % more, beside jumps of the cost too. Stops stay. The figures
    /// are those of the new path. The lower bound holds for it, too.
    ///
    /// # Errors
    /// Fails when the tolerance is negative or NaN.
    pub fn simplified(&self, density: &dyn CostDensity, tolerance: f64) -> Result<Self, PathError> {
        if tolerance < 0.0 || tolerance.is_nan() {
            return Err(PathError::InvalidTolerance { tolerance });
        }
        let leg = |(number, ends): (usize, &[usize])| {
            let walls = self.walls.get(number);
            let shortcuts = Shortcuts { tolerance, walls: walls.map(|walls| &**walls), density };
            let points = shortcuts.taken(&self.points[ends[0]..=ends[1]]);
            let figures = Self::new(points, density, SHORTCUT_TOLERANCE);
            Self { walls: walls.into_iter().cloned().collect(), ..figures }
        };
        let mut solution = Self::joined(self.stops.windows(2).enumerate().map(leg));
        solution.lower = self.lower.min(solution.upper);
        Ok(solution)
    }
}

/// Returns the sample at the end of a part of a path.
fn sample_at(point: DVec2, along: &PathFigures, density: &dyn CostDensity) -> PathSample {
    PathSample {
        distance: along.length_on_ground,
        point,
        cost: along.cost,
        risk: density.risk_at(point),
        density: density.at(point) / density.inverse_scale_at(point),
    }
}

/// Bounds of the cost of a piece of a profile differ by this share.
const PROFILE_TOLERANCE: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::CostFormula;
    use crate::layers::RiskField;
    use crate::path::FormulaCost;

    fn found(cost: f64, [lower, upper]: [f64; 2], y: f64) -> Solution {
        let points = vec![DVec2::ZERO, dvec2(0.5, y), DVec2::X];
        Solution { cost, lower, upper, points, ..Solution::default() }
    }

    #[test]
    fn a_proof_never_makes_a_path_dearer() {
        // Beside a jump of the cost, the bound of the cheaper path is far above its cost.
        let mut kept = found(2.0, [1.0, 5.0], 0.0);
        assert!(!kept.take(found(2.5, [1.5, 2.75], 1.0)));
        assert_eq!(kept, found(2.0, [1.5, 2.75], 0.0));
        assert!(kept.take(found(1.75, [1.5, 2.25], 1.0)));
        assert_eq!(kept, found(1.75, [1.5, 2.25], 1.0));
        // A bound that is below the cost is one of another path.
        let mut other = found(3.0, [1.0, 5.0], 0.0);
        assert!(!other.take(found(3.0, [2.0, 2.9], 0.0)));
        assert_eq!(other, found(3.0, [2.0, 5.0], 0.0));
    }

    #[test]
    fn a_profile_goes_over_points_that_are_there_twice() {
        let cost = FormulaCost { formula: CostFormula::parse("1").unwrap(), risk: RiskField::default() };
        let [a, b, c] = [dvec2(0.0, 0.0), dvec2(0.5, 0.0), dvec2(0.5, 0.5)];
        for points in
            [vec![a, b, c], vec![a, a, b, c], vec![a, b, b, c], vec![a, b, c, c], vec![a, a], vec![a]]
        {
            let solution = Solution::new(points.clone(), &cost, 1e-3);
            let profile = solution.profile(&cost, 9);
            assert!(profile.iter().all(|sample| sample.point.is_finite()), "{points:?}");
            let [first, last] = [0, points.len() - 1].map(|n| points[n]);
            assert_eq!([profile[0].point, profile[profile.len() - 1].point], [first, last]);
        }
    }
}
