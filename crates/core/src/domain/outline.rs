//! The outline of a region, to ask where its water ends.

use std::ops::ControlFlow;

use glam::DVec2;

use super::Region;
use super::segments::Segments;
use crate::geometry::Rect;

/// The edges of a region in world units, but for distances without those along the sides of its frame: they
/// are where the data ends.
#[derive(Clone, Debug)]
pub(crate) struct RegionOutline {
    edges: Segments,
    /// For each edge, whether it is not along a side of the frame.
    is_inner: Vec<bool>,
    frame: Rect,
}

/// An edge along a side of the frame is at most this share of the frame away from it.
const BESIDE: f64 = 1e-9;
/// A point at a side is taken to be this part of the frame inside.
const WITHIN: f64 = 1e-13;

impl RegionOutline {
    /// Returns the outline; `None` where the region is all of its frame.
    pub(crate) fn new(region: &Region) -> Option<Self> {
        let frame = region.frame();
        let margin = BESIDE * frame.size();
        let on_frame = |[a, b]: &[DVec2; 2]| {
            let beside = |side: DVec2| {
                let is_near = |p: &DVec2| (*p - side).abs().cmple(margin);
                is_near(a) & is_near(b)
            };
            beside(frame.min).any() || beside(frame.max).any()
        };
        let list: Vec<[DVec2; 2]> = region.edges().collect();
        let is_inner: Vec<bool> = list.iter().map(|edge| !on_frame(edge)).collect();
        let has_inner = is_inner.contains(&true);
        Segments::new(list).filter(|_| has_inner).map(|edges| Self { edges, is_inner, frame: *frame })
    }

    /// Returns whether the region covers a point of its frame. On the outline either answer is possible.
    pub(crate) fn covers(&self, point: DVec2) -> bool {
        // A ray along a side of the frame would meet nothing.
        let margin = WITHIN * self.frame.size();
        let point = point.clamp(self.frame.min + margin, self.frame.max - margin);
        // Edges have the region on the left, which is on the right of those that run down.
        let first = self.edges.first_to_the_left(point, |_| true).map(|number| self.edges.segment(number));
        first.is_some_and(|[from, to]| to.y < from.y)
    }

    /// Visits the edges that count for distances and whose rectangles meet another, until `visit` breaks.
    pub(crate) fn visit_meeting(
        &self,
        area: &Rect,
        mut visit: impl FnMut([DVec2; 2]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.edges.visit_meeting(area, |number| match self.is_inner[number as usize] {
            true => visit(self.edges.segment(number)),
            false => ControlFlow::Continue(()),
        })
    }

    /// Returns the edge nearest to a point, of those that count for distances.
    pub(crate) fn nearest_edge(&self, point: DVec2) -> Option<[DVec2; 2]> {
        let (number, _) = self.edges.nearest(point, |number| self.is_inner[number as usize])?;
        Some(self.edges.segment(number))
    }

    /// Returns the largest absolute value of a coordinate.
    pub(crate) fn largest_coordinate(&self) -> f64 {
        self.edges.largest_coordinate()
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn the_region_is_on_one_side_and_the_frame_does_not_count() {
        let square =
            |min: f64, max: f64| vec![dvec2(min, min), dvec2(max, min), dvec2(max, max), dvec2(min, max)];
        // The sea with an island, and a bay of land at the lower left corner.
        let frame = Rect::new(DVec2::ZERO, DVec2::splat(4.0));
        let sea =
            Region::new(&[vec![square(0.0, 4.0), square(2.0, 3.0)]], frame).without(&[square(0.0, 1.0)]);
        let outline = RegionOutline::new(&sea).unwrap();
        for (point, is_covered) in [
            (dvec2(0.5, 0.5), false),
            (dvec2(1.5, 0.5), true),
            (dvec2(0.5, 1.5), true),
            (dvec2(2.5, 2.5), false),
            (dvec2(3.5, 2.5), true),
        ] {
            assert_eq!(outline.covers(point), is_covered, "{point}");
        }
        let distance = |point: DVec2| {
            let nearest = crate::geometry::nearest_on_segment(point, outline.nearest_edge(point).unwrap());
            point.distance(nearest)
        };
        assert!((distance(dvec2(3.9, 0.1)) - 2.9_f64.min(0.9_f64.hypot(1.9))).abs() < 1e-9, "not 0.1");
        assert!((distance(dvec2(0.1, 3.5)) - 2.0).abs() < 0.6);
        assert!(RegionOutline::new(&Region::new(&[vec![square(0.0, 4.0)]], frame)).is_none());
    }
}
