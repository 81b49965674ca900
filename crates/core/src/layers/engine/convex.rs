//! Convex polygons, and their distances from segments.

use glam::DVec2;

use crate::geometry::{Rect, nearest_on_segment};

/// A rectangle of which each corner may be cut off.
const MOST_CORNERS: usize = 8;

/// A convex polygon by its corners, counter-clockwise. Some may coincide.
#[derive(Clone, Copy, Debug)]
pub struct Convex {
    corners: [DVec2; MOST_CORNERS],
    count: usize,
}

impl Convex {
    /// Returns the rectangle between its lower left and its upper right corner.
    pub fn rect(min: DVec2, max: DVec2) -> Self {
        let mut corners = [min; MOST_CORNERS];
        (corners[1], corners[2], corners[3]) = (DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y));
        Self { corners, count: 4 }
    }

    /// Returns the corners.
    pub fn corners(&self) -> &[DVec2] {
        &self.corners[..self.count]
    }

    /// Returns the polygon with other corners, in the same order.
    pub fn map(mut self, corner: impl Fn(DVec2) -> DVec2) -> Self {
        self.corners[..self.count].iter_mut().for_each(|place| *place = corner(*place));
        self
    }

    /// Returns the smallest rectangle around the polygon.
    pub fn bounds(&self) -> Rect {
        let [first, rest @ ..] = self.corners() else { return Rect::new(DVec2::ZERO, DVec2::ZERO) };
        rest.iter().fold(Rect::new(*first, *first), |all, &corner| all.union(&Rect::new(corner, corner)))
    }

    /// Cuts off what lies beyond a line, where `along` · p is greater than `most`, and returns whether that
    /// is something. At most four lines may cut corners off; one that would leave nothing cuts off nothing.
    pub fn cut(&mut self, along: DVec2, most: f64) -> bool {
        let beyond = self.corners.map(|corner| along.dot(corner) - most);
        let count = beyond[..self.count].iter().filter(|&&beyond| beyond > 0.0).count();
        if count == 0 || count == self.count {
            return false;
        }
        let before = *self;
        self.count = 0;
        for n in 0..before.count {
            let next = (n + 1) % before.count;
            if beyond[n] <= 0.0 {
                self.push(before.corners[n]);
            }
            if (beyond[n] < 0.0 && beyond[next] > 0.0) || (beyond[n] > 0.0 && beyond[next] < 0.0) {
                let share = beyond[n] / (beyond[n] - beyond[next]);
                self.push(before.corners[n].lerp(before.corners[next], share));
            }
        }
        true
    }

    fn push(&mut self, corner: DVec2) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    /// Returns the squares of the least and the greatest distance of a point of the polygon from a segment.
    pub fn squared_distances(&self, segment @ [a, b]: [DVec2; 2]) -> [f64; 2] {
        let corners = self.corners();
        let squared = |p: DVec2, edge: [DVec2; 2]| p.distance_squared(nearest_on_segment(p, edge));
        let (mut least, mut greatest) = (f64::INFINITY, 0.0f64);
        // Both distances are those of a corner, or of an end of the segment, unless the two cross.
        for &corner in corners {
            let distance = squared(corner, segment);
            (least, greatest) = (least.min(distance), greatest.max(distance));
        }
        // A polygon of a single point holds no other.
        let (mut crosses, mut holds) = (false, corners.iter().any(|&corner| corner != corners[0]));
        for (n, &from) in corners.iter().enumerate() {
            let edge @ [_, to] = [from, corners[(n + 1) % corners.len()]];
            least = least.min(squared(a, edge)).min(squared(b, edge));
            let sides = [a, b].map(|p| (to - from).perp_dot(p - from));
            let ends = [from, to].map(|p| (b - a).perp_dot(p - a));
            crosses |= sides[0] * sides[1] < 0.0 && ends[0] * ends[1] < 0.0;
            holds &= sides[0] > 0.0 || from == to;
        }
        [if crosses || holds { 0.0 } else { least }, greatest]
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn near(random: &mut fastrand::Rng) -> DVec2 {
        dvec2(random.f64(), random.f64())
    }

    #[test]
    fn distances_are_those_of_the_points_within() {
        let mut random = fastrand::Rng::with_seed(31);
        let mut zero = 0;
        for _ in 0..2_000 {
            let min = near(&mut random);
            let size = [dvec2(0.0, 0.3), dvec2(0.2, 0.3), DVec2::ZERO][random.usize(..3)];
            let mut polygon = Convex::rect(min, min + size);
            let lines = [dvec2(1.0, 1.0), dvec2(-1.0, 1.0), dvec2(1.0, -1.0)];
            let cuts: Vec<(DVec2, f64)> = lines
                .map(|along| (along, along.dot(min + 0.5 * size) + 0.3 * random.f64()))
                .into_iter()
                .filter(|_| random.bool())
                .collect();
            cuts.iter().for_each(|&(along, most)| _ = polygon.cut(along, most));
            let end = near(&mut random);
            let segment = [near(&mut random), if random.u8(..4) == 0 { end } else { near(&mut random) }];
            let [least, greatest] = polygon.squared_distances(segment).map(f64::sqrt);
            zero += usize::from(least == 0.0);
            let (mut found, mut farthest) = (f64::INFINITY, 0.0f64);
            let steps = 60;
            for (i, j) in (0..=steps).flat_map(|j| (0..=steps).map(move |i| (i, j))) {
                let p = min + size * dvec2(f64::from(i), f64::from(j)) / f64::from(steps);
                if cuts.iter().all(|&(along, most)| along.dot(p) <= most + 1e-12) {
                    let distance = p.distance(nearest_on_segment(p, segment));
                    (found, farthest) = (found.min(distance), farthest.max(distance));
                }
            }
            let step = size.max_element() / f64::from(steps);
            assert!(least <= found + 1e-9 && found <= least + 2.0 * step + 1e-9, "{least} {found}");
            assert!(greatest >= farthest - 1e-9 && farthest >= greatest - 2.0 * step - 1e-9);
        }
        assert!(zero > 50, "{zero}");
    }
}
