//! The segments nearest to a point, of many.

use std::ops::ControlFlow;

use glam::DVec2;

use crate::geometry::{BoxTree, Rect, nearest_on_segment};

/// Segments in world units, with a tree of their bounding boxes.
#[derive(Clone, Debug)]
pub struct Segments {
    list: Vec<[DVec2; 2]>,
    tree: BoxTree,
}

impl Segments {
    /// Indexes segments; `None` without segments.
    pub fn new(list: Vec<[DVec2; 2]>) -> Option<Self> {
        let boxes: Vec<Rect> = list.iter().map(|&[a, b]| Rect::spanning(a, b)).collect();
        (!list.is_empty()).then(|| Self { tree: BoxTree::new(&boxes), list })
    }

    /// Returns the largest absolute value of a coordinate.
    pub fn largest_coordinate(&self) -> f64 {
        self.tree.bounds().map_or(0.0, |bounds| bounds.min.abs().max(bounds.max.abs()).max_element())
    }

    /// Returns a segment, by its number in the list.
    pub fn segment(&self, number: u32) -> [DVec2; 2] {
        self.list[number as usize]
    }

    /// Returns the distance from `p` to one of the segments.
    pub fn distance(&self, number: u32, p: DVec2) -> f64 {
        p.distance(nearest_on_segment(p, self.segment(number)))
    }

    /// Returns the nearest of the segments that `counts` accepts, with its distance from `p`. Of several, the
    /// first.
    pub fn nearest(&self, p: DVec2, counts: impl Fn(u32) -> bool) -> Option<(u32, f64)> {
        let squared = |number: u32| {
            let distance = || p.distance_squared(nearest_on_segment(p, self.segment(number)));
            if counts(number) { distance() } else { f64::INFINITY }
        };
        let (number, _) = self.tree.nearest(p, squared)?;
        Some((number, self.distance(number, p)))
    }

    /// Visits the segments whose rectangles meet another, until `visit` breaks.
    pub fn visit_meeting(&self, area: &Rect, visit: impl FnMut(u32) -> ControlFlow<()>) -> ControlFlow<()> {
        self.tree.visit_meeting(area, visit)
    }

    /// Calls `found` once for each segment within a distance of `p`, with its distance.
    pub fn visit_within(&self, p: DVec2, reach: f64, mut found: impl FnMut(u32, f64)) {
        let _ = self.tree.visit_meeting(&Rect::around(p, reach), |number| {
            let distance = self.distance(number, p);
            if distance <= reach {
                found(number, distance);
            }
            ControlFlow::Continue(())
        });
    }

    /// Returns the first segment that a ray from `p` towards lower x meets, of those that `counts` accepts. A
    /// horizontal segment is met nowhere, and an end belongs to the segment above it: so the ray of a point
    /// beside a closed line meets it an even number of times.
    pub fn first_to_the_left(&self, p: DVec2, counts: impl Fn(u32) -> bool) -> Option<u32> {
        let mut first = (f64::NEG_INFINITY, u32::MAX);
        let nearest_so_far = std::cell::Cell::new(first.0);
        let may_be_first = |area: &Rect| {
            let meets = area.min.y <= p.y && p.y <= area.max.y && area.min.x <= p.x;
            meets && area.max.x >= nearest_so_far.get()
        };
        let _ = self.tree.descend(
            |_, area| may_be_first(area),
            |number, area| {
                let met = if may_be_first(area) { meets_ray(self.segment(number), p) } else { None };
                if let Some(x) = met.filter(|&x| (x, number) > first && counts(number)) {
                    first = (x, number);
                    nearest_so_far.set(x);
                }
                ControlFlow::Continue(())
            },
        );
        (first.1 != u32::MAX).then_some(first.1)
    }
}

/// Returns the x at which a ray from `p` towards lower x meets a segment.
fn meets_ray([a, b]: [DVec2; 2], p: DVec2) -> Option<f64> {
    if (a.y <= p.y) == (b.y <= p.y) {
        return None;
    }
    let x = a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y));
    (x <= p.x).then_some(x)
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn random_segments(random: &mut fastrand::Rng, count: usize) -> Vec<[DVec2; 2]> {
        let mut place = || dvec2(random.f64(), 0.3 * random.f64());
        let mut segment = |_| {
            let a = place();
            [a, a + 0.1 * (place() - dvec2(0.5, 0.1))]
        };
        (0..count).map(&mut segment).collect()
    }

    #[test]
    fn the_nearest_of_all_segments_is_found() {
        let mut random = fastrand::Rng::with_seed(3);
        for count in [1, 2, 7, 500] {
            let list = random_segments(&mut random, count);
            let segments = Segments::new(list.clone()).unwrap();
            for _ in 0..300 {
                let p = 3.0 * dvec2(random.f64() - 0.3, 0.3 * random.f64() - 0.1);
                let distances: Vec<f64> =
                    list.iter().map(|&segment| p.distance(nearest_on_segment(p, segment))).collect();
                let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
                let found = segments.nearest(p, |_| true).unwrap();
                assert_eq!(found.1, nearest, "{count} segments, {p}");
                let odd = (1..count).step_by(2).map(|n| distances[n]).reduce(f64::min);
                let found = segments.nearest(p, |segment| segment % 2 == 1);
                assert_eq!(found.map(|(_, distance)| distance), odd, "{count} segments, {p}");
                let mut within = Vec::new();
                segments.visit_within(p, 1.5 * nearest, |segment, _| within.push(segment as usize));
                within.sort_unstable();
                let expected: Vec<usize> = (0..count).filter(|&n| distances[n] <= 1.5 * nearest).collect();
                assert_eq!(within, expected, "{count} segments, {p}");
            }
        }
        assert!(Segments::new(Vec::new()).is_none());
    }

    #[test]
    fn the_first_segment_to_the_left_is_the_one_that_brute_force_finds() {
        let mut random = fastrand::Rng::with_seed(4);
        for count in [1, 9, 300] {
            let list = random_segments(&mut random, count);
            let segments = Segments::new(list.clone()).unwrap();
            for _ in 0..300 {
                let p = dvec2(1.2 * random.f64(), 0.3 * random.f64());
                let met = list.iter().enumerate().filter_map(|(n, &[a, b])| {
                    let [low, high] = if a.y < b.y { [a, b] } else { [b, a] };
                    let share = (p.y - low.y) / (high.y - low.y);
                    let x = low.lerp(high, share).x;
                    (low.y <= p.y && p.y < high.y && x < p.x && n % 3 != 0).then_some((x, n))
                });
                let expected = met.reduce(|a, b| if b.0 > a.0 { b } else { a }).map(|(_, n)| n as u32);
                assert_eq!(segments.first_to_the_left(p, |n| n % 3 != 0), expected, "{count} segments, {p}");
            }
        }
    }
}
