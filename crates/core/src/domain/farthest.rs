//! The largest distance of one set of segments from another.

use glam::DVec2;

use super::segments::Segments;

/// How much the reported distance may exceed the true maximum, as a share of it.
const RELATIVE_TOLERANCE: f64 = 1e-9;
/// Rounding errors of a distance, in units of the largest coordinate.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A point of a segment, with the nearest of the other segments and its distance, in world units.
#[derive(Clone, Copy)]
struct FarPoint {
    point: DVec2,
    nearest: u32,
    distance: f64,
}

/// Returns the largest distance of the points of `edges` from `others`, and a point that has it. The distance
/// is at least the true maximum and exceeds it by a share of 1e-9 at most, apart from rounding errors. `None`
/// without edges.
///
/// The distance from one segment is a convex function of the place, so that between two points it is at most
/// the larger of the values at them. A part of an edge is done where that bound, of the segment nearest to
/// one of its ends, does not exceed the largest distance found so far. Other parts are divided at the place
/// that is as far from the segment nearest to one end as from that nearest to the other:
///
/// ```text
///              s ─────┐          the distance from s grows along the edge,
///   edge  o───────────┼──────o   that from t shrinks: both are equal at +
///         a           +      b
///                 └────── t
/// ```
pub(super) fn farthest(edges: &[[DVec2; 2]], others: &Segments) -> Option<(f64, DVec2)> {
    let mut last: Option<FarPoint> = None;
    let mut measured = |point: DVec2| {
        // Edges mostly begin where the one before ends.
        let known = last.filter(|last| last.point == point);
        last = Some(known.unwrap_or_else(|| measure(point, others)));
        last.expect("it was just set")
    };
    let parts: Vec<[FarPoint; 2]> = edges.iter().map(|&[a, b]| [measured(a), measured(b)]).collect();
    let best = parts.iter().flatten().copied().reduce(|a, b| if b.distance > a.distance { b } else { a })?;
    let coordinates = edges.iter().flatten().map(|p| p.abs().max_element());
    let largest = coordinates.fold(others.largest_coordinate(), f64::max);
    let mut search = FarthestSearch { others, best, upper: best.distance, rounding: ROUNDING * largest };
    parts.iter().for_each(|&part| search.search(part));
    let is_rounding = search.upper <= search.rounding;
    Some((if is_rounding { search.best.distance } else { search.upper }, search.best.point))
}

fn measure(point: DVec2, others: &Segments) -> FarPoint {
    let (nearest, distance) = others.nearest(point, |_| true).expect("there are segments");
    FarPoint { point, nearest, distance }
}

/// A search by branch and bound.
struct FarthestSearch<'a> {
    others: &'a Segments,
    /// The farthest point found so far.
    best: FarPoint,
    /// No point that was searched is farther.
    upper: f64,
    /// Rounding errors of a distance, in world units.
    rounding: f64,
}

impl FarthestSearch<'_> {
    /// Searches a part of an edge. The recursion ends: if a part is not done, the distances of its ends from
    /// the two nearest segments differ by more than the tolerance, so the point that divides it is at least
    /// half the tolerance away from both ends; and parts shorter than that are done.
    fn search(&mut self, part: [FarPoint; 2]) {
        let mut parts = vec![part];
        while let Some([a, b]) = parts.pop() {
            let bound = self.bound([a, b]);
            let tolerance = (RELATIVE_TOLERANCE * self.best.distance).max(self.rounding);
            if bound <= self.best.distance + tolerance {
                self.upper = self.upper.max(bound);
                continue;
            }
            let middle = measure(self.equidistant([a, b]), self.others);
            if middle.distance > self.best.distance {
                self.best = middle;
                self.upper = self.upper.max(middle.distance);
            }
            parts.extend([[a, middle], [middle, b]]);
        }
    }

    /// No point between two is farther from the others than this.
    fn bound(&self, [a, b]: [FarPoint; 2]) -> f64 {
        let by_nearest_to_a = a.distance.max(self.others.distance(a.nearest, b.point));
        let by_nearest_to_b = b.distance.max(self.others.distance(b.nearest, a.point));
        // A distance changes by no more than the distance between the points.
        let by_length = 0.5 * (a.distance + b.distance + a.point.distance(b.point));
        by_nearest_to_a.min(by_nearest_to_b).min(by_length)
    }

    /// Returns a place between two points that is as far from the segment nearest to one as from that nearest
    /// to the other.
    fn equidistant(&self, [a, b]: [FarPoint; 2]) -> DVec2 {
        let nearer_to_a = |share: f64| {
            let p = a.point.lerp(b.point, share);
            self.others.distance(a.nearest, p) < self.others.distance(b.nearest, p)
        };
        let [mut low, mut high] = [0.0, 1.0];
        // At most 52 halvings.
        while high - low > f64::EPSILON {
            let share = 0.5 * (low + high);
            if nearer_to_a(share) { low = share } else { high = share }
        }
        a.point.lerp(b.point, high)
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::nearest_on_segment;

    fn edges(points: &[DVec2]) -> Vec<[DVec2; 2]> {
        points.windows(2).map(|ends| [ends[0], ends[1]]).collect()
    }

    fn farthest_of(from: &[[DVec2; 2]], to: &[[DVec2; 2]]) -> (f64, DVec2) {
        farthest(from, &Segments::new(to.to_vec()).unwrap()).unwrap()
    }

    #[test]
    fn the_farthest_point_may_be_between_corners() {
        // A line below a roof: the point under the roof's gap is farthest, at neither an end nor the middle.
        let floor = edges(&[dvec2(0.0, 0.0), dvec2(10.0, 0.0)]);
        let posts = [0.0, 6.0, 10.0].map(|x| [dvec2(x, 0.0), dvec2(x, 1.0)]);
        let (distance, place) = farthest_of(&floor, &posts);
        assert!(
            (distance - 3.0).abs() < 1e-8 && place.distance(dvec2(3.0, 0.0)) < 1e-8,
            "{distance} {place}"
        );
        // The same line in other parts: zero, but for the rounding of places on it.
        let parts = edges(&[0.0, 0.1, 0.7, 3.3, 10.0].map(|x| dvec2(x, 0.0)));
        assert!(farthest_of(&floor, &parts).0 < 1e-15);
        assert!(farthest_of(&parts, &floor).0 < 1e-15);
        assert!(farthest(&[], &Segments::new(parts).unwrap()).is_none());
    }

    #[test]
    fn many_equal_maxima_take_no_longer() {
        // A staircase along a line: every corner is equally far, but for rounding.
        let steps: Vec<DVec2> =
            (0..40_000).map(|k| dvec2(f64::from(k / 2), f64::from((k + 1) / 2))).collect();
        let line = [[dvec2(0.0, 0.0), dvec2(20_000.0, 20_000.0)]];
        let (distance, _) = farthest_of(&edges(&steps), &line);
        assert!((distance - 0.5f64.sqrt()).abs() < 1e-8, "{distance}");
        let (distance, _) = farthest_of(&line, &edges(&steps));
        assert!((distance - 0.5).abs() < 1.0, "{distance}");
    }

    #[test]
    fn no_sample_is_farther_and_some_are_as_far() {
        let mut random = fastrand::Rng::with_seed(9);
        for _ in 0..300 {
            let mut line = |count: usize| -> Vec<DVec2> {
                let mut at = dvec2(random.f64(), random.f64());
                let mut next = |_| {
                    at += 0.3 * dvec2(random.f64() - 0.5, random.f64() - 0.5);
                    at
                };
                (0..count).map(&mut next).collect()
            };
            let (from, to) = (edges(&line(6)), edges(&line(12)));
            let (distance, place) = farthest_of(&from, &to);
            let of = |p: DVec2| {
                to.iter().map(|&e| p.distance(nearest_on_segment(p, e))).fold(f64::INFINITY, f64::min)
            };
            let samples =
                from.iter().flat_map(|&[a, b]| (0..=2000).map(move |k| a.lerp(b, f64::from(k) / 2e3)));
            let sampled = samples.map(of).fold(0.0, f64::max);
            assert!(sampled <= distance * (1.0 + 1e-12) && distance - sampled < 2e-4, "{sampled} {distance}");
            assert!((of(place) - distance).abs() <= 1.01e-9 * distance);
        }
    }
}
