//! Leaves out points of rings that lie between others on one line, and joins the points around a corner.

use glam::DVec2;

use super::super::Ring;

/// A point is left out where it is at most this many tolerances beside the line between others.
const BESIDE: f64 = 0.5;
/// Points at most this many tolerances apart are those of one corner.
const AT_CORNER: f64 = 8.0;
/// The sine of the least angle between the sides of a corner whose lines are intersected.
const LEAST_SINE: f64 = 0.05;

/// Returns a ring with fewer points.
pub(super) fn thinned(ring: &[DVec2], tolerance: f64) -> Ring {
    with_corners(&without_points_between(ring, BESIDE * tolerance), tolerance)
}

/// Leaves out points that are at most `beside` beside the line between others (the algorithm of Ramer,
/// Douglas and Peucker).
fn without_points_between(ring: &[DVec2], beside: f64) -> Ring {
    let Some(&first) = ring.first() else { return Ring::new() };
    let farthest = (0..ring.len()).max_by(|&a, &b| {
        ring[a].distance_squared(first).total_cmp(&ring[b].distance_squared(first)).then(b.cmp(&a))
    });
    let farthest = farthest.unwrap_or(0);
    let mut stays = vec![false; ring.len()];
    stays[0] = true;
    stays[farthest] = true;
    let mut ranges = vec![(0, farthest), (farthest, ring.len())];
    while let Some((start, end)) = ranges.pop() {
        let [from, to] = [ring[start], ring[end % ring.len()]];
        let distance = |n: usize| to_segment(ring[n], [from, to]);
        let between = (start + 1..end).map(|n| (distance(n), n));
        let widest = between.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        if let Some((_, place)) = widest.filter(|(distance, _)| *distance > beside) {
            stays[place] = true;
            ranges.extend([(start, place), (place, end)]);
        }
    }
    ring.iter().zip(stays).filter(|(_, stays)| *stays).map(|(point, _)| *point).collect()
}

fn to_segment(at: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    at.distance(crate::geometry::nearest_on_segment(at, [from, to]))
}

/// Replaces points that are close together by the corner between the sides around them.
fn with_corners(ring: &[DVec2], tolerance: f64) -> Ring {
    let count = ring.len();
    let is_close = |n: usize| ring[n].distance(ring[(n + 1) % count]) <= AT_CORNER * tolerance;
    let Some(start) = (0..count).find(|&n| !is_close(n)) else { return Ring::new() };
    let mut corners = Ring::new();
    let mut group = Vec::new();
    for n in (start + 1..=start + count).map(|n| n % count) {
        group.push(n);
        if !is_close(n) {
            corners.push(corner(ring, &group));
            group.clear();
        }
    }
    corners
}

/// Returns the corner of some points that follow one another: where the lines of the sides before and after
/// them meet, if that is close.
fn corner(ring: &[DVec2], group: &[usize]) -> DVec2 {
    let (count, first, last) = (ring.len(), group[0], group[group.len() - 1]);
    if first == last {
        return ring[first];
    }
    let [before, after] = [ring[(first + count - 1) % count], ring[(last + 1) % count]];
    let [a, b] = [ring[first], ring[last]];
    let [along, back] = [(a - before).normalize_or_zero(), (after - b).normalize_or_zero()];
    let (sine, middle) = (along.perp_dot(back), 0.5 * (a + b));
    if sine.abs() < LEAST_SINE {
        return middle;
    }
    let met = a + along * ((b - a).perp_dot(back) / sine);
    if met.distance(middle) <= 2.0 * a.distance(b) { met } else { middle }
}
