//! Finds where two regions differ, in slices.

use std::sync::Arc;

use glam::DVec2;

use super::Region;
use super::region::EdgeCursor;
use crate::geometry::{NumberMap, Rect};
use crate::mesh::Progress;

/// Compares two regions in the same frame by their edges.
///
/// An edge that both regions have, in the same direction, has both of them on its left. So a part that
/// belongs to one region only is enclosed by edges that the other region does not have, and these edges touch
/// each other.
///
/// An edit keeps most edges in their order. So equal edges at the beginning are skipped, and equal edges at
/// the end of the first ring that differs; only the rest is looked up in a table:
///
/// ```text
/// before  =========|~~~~~~~~~~|=====|.........      =  skipped: equal edges in both
/// after   =========|~~~~~|=====|..............      ~  looked up: rest of the first ring that differs
///                  ring ends here   ^               .  looked up: all later rings
/// ```
#[derive(Clone, Debug)]
pub struct RegionComparison {
    regions: [Arc<Region>; 2],
    pass: Pass,
    /// The edges that are not skipped, of both regions: in the first ring that differs, and after that ring.
    rest: [[Edges; 2]; 2],
    /// The edges that the current pass has not visited.
    to_visit: [Edges; 2],
    /// How many edges of the region before still have no equal in the region after, by their ends.
    unmatched: NumberMap<EdgeKey, u32>,
    areas: Areas,
}

/// Consecutive edges of a region.
#[derive(Clone, Copy, Debug)]
struct Edges {
    /// The position before the first edge.
    first: EdgeCursor,
    count: usize,
}

impl Edges {
    fn next(&mut self, region: &Region) -> Option<[DVec2; 2]> {
        self.count = self.count.checked_sub(1)?;
        self.first.next(region)
    }
}

/// The passes over the edges, in their order.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pass {
    /// Skips equal edges at the beginning.
    SkipFirst,
    /// Skips equal edges at the end of the first ring that differs.
    SkipLast,
    /// Counts the edges of the region before in the table.
    Count,
    /// Looks up the edges of the region after: those without an equal are new.
    Match,
    /// Looks up the edges of the region before again: those left in the table were removed.
    FindRemoved,
    Done,
}

/// The bits of the coordinates of both ends.
type EdgeKey = [u64; 4];

fn key([from, to]: [DVec2; 2]) -> EdgeKey {
    [from.x, from.y, to.x, to.y].map(f64::to_bits)
}

impl RegionComparison {
    /// Begins the comparison of a region before an edit with the region after it.
    pub fn new(before: Arc<Region>, after: Arc<Region>) -> Self {
        let all = |region: &Region| Edges { first: EdgeCursor::default(), count: region.corner_count() };
        let none = Edges { first: EdgeCursor::default(), count: 0 };
        Self {
            rest: [[none, all(&before)], [none, all(&after)]],
            to_visit: [none; 2],
            regions: [before, after],
            pass: Pass::SkipFirst,
            unmatched: NumberMap::default(),
            areas: Areas::default(),
        }
    }

    /// Compares about `edges` edges.
    pub fn advance(&mut self, edges: usize) -> Progress {
        for _ in 0..edges {
            let found = match self.pass {
                Pass::SkipFirst => self.skip_first(),
                Pass::SkipLast => self.skip_last(),
                Pass::Count | Pass::Match | Pass::FindRemoved => self.visit(),
                Pass::Done => return Progress::Done,
            };
            if !found {
                self.next_pass();
            }
        }
        Progress::More
    }

    /// Skips the next edge, if it is equal in both regions.
    fn skip_first(&mut self) -> bool {
        let mut rest = self.rest.map(|[_, rest]| rest);
        let [before, after] = [0, 1].map(|n| rest[n].next(&self.regions[n]).map(key));
        let equal = before.is_some() && before == after;
        if equal {
            [self.rest[0][1], self.rest[1][1]] = rest;
        }
        equal
    }

    /// Splits the rest of both regions into the rest of the current ring and the edges after that ring.
    fn split_at_ring(&mut self) {
        for (region, left) in self.regions.iter().zip(&mut self.rest) {
            let [_, rest] = *left;
            let in_ring = rest.first.left_in_ring(region);
            let behind = Edges { first: rest.first.after_ring(region), count: rest.count - in_ring };
            *left = [Edges { count: in_ring, ..rest }, behind];
        }
    }

    /// Skips the last edge of the ring, if it is equal in both regions.
    fn skip_last(&mut self) -> bool {
        let last = |n: usize| -> Option<EdgeKey> {
            let Edges { first, count } = self.rest[n][0];
            Some(key(first.edge_in_ring(&self.regions[n], count.checked_sub(1)?)))
        };
        let equal = last(0).is_some() && last(0) == last(1);
        if equal {
            self.rest.iter_mut().for_each(|[ring, _]| ring.count -= 1);
        }
        equal
    }

    /// Visits the next edge of the current pass. Returns whether there was one.
    fn visit(&mut self) -> bool {
        let region = &self.regions[usize::from(self.pass == Pass::Match)];
        let [ring, behind] = &mut self.to_visit;
        let Some(edge) = ring.next(region).or_else(|| behind.next(region)) else { return false };
        if self.pass == Pass::Count {
            *self.unmatched.entry(key(edge)).or_default() += 1;
            return true;
        }
        let was_unmatched = match self.unmatched.get_mut(&key(edge)) {
            Some(count) if *count > 0 => {
                *count -= 1;
                true
            }
            _ => false,
        };
        // In `Match` an edge that was not in the table is new; in `FindRemoved` one that still is was
        // removed.
        if was_unmatched == (self.pass == Pass::FindRemoved) {
            self.areas.add(Rect::spanning(edge[0], edge[1]));
        }
        true
    }

    fn next_pass(&mut self) {
        self.pass = match self.pass {
            Pass::SkipFirst => Pass::SkipLast,
            Pass::SkipLast => Pass::Count,
            Pass::Count => Pass::Match,
            Pass::Match => Pass::FindRemoved,
            Pass::FindRemoved | Pass::Done => Pass::Done,
        };
        if self.pass == Pass::SkipLast {
            self.split_at_ring();
        }
        self.to_visit = self.rest[usize::from(self.pass == Pass::Match)];
    }

    /// When the comparison is done: rectangles in world units that contain every point of exactly one of the
    /// regions, and every edge that only one of them has.
    pub fn areas(&self) -> &[Rect] {
        &self.areas.rects
    }
}

/// Most rectangles; beyond that they are joined into one.
const MOST_AREAS: usize = 64;

/// A set of rectangles that do not touch each other.
#[derive(Clone, Debug, Default)]
struct Areas {
    rects: Vec<Rect>,
}

impl Areas {
    fn add(&mut self, mut area: Rect) {
        // The union may touch rectangles that neither part touched.
        while let Some(touched) = self.rects.iter().position(|other| touch(other, &area)) {
            area = area.union(&self.rects.swap_remove(touched));
        }
        self.rects.push(area);
        if self.rects.len() > MOST_AREAS {
            self.rects = self.rects.drain(..).reduce(|a, b| a.union(&b)).into_iter().collect();
        }
    }
}

/// Returns whether two closed rectangles intersect.
fn touch(a: &Rect, b: &Rect) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}
