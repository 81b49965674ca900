//! Where two regions differ, found in slices.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec2;

use super::Region;
use super::region::EdgeCursor;
use crate::geometry::Rect;
use crate::mesh::Progress;

/// Compares two regions in the same frame, by their edges.
///
/// Across an edge that both have, in the same direction, both begin or both end. So whatever lies in one of them only is enclosed
/// by edges that the other has not, and these touch each other.
///
/// An edit mostly leaves the edges in their order: those that both have at the beginning are passed over, and so are those at the
/// end of the ring in which they first differ. Only what is left is looked up.
#[derive(Clone, Debug)]
pub struct RegionComparison {
    regions: [Arc<Region>; 2],
    pass: Pass,
    /// What is not passed over, of both regions: of the ring in which they first differ, and behind it.
    left: [[Edges; 2]; 2],
    /// What is left of the present pass.
    to_visit: [Edges; 2],
    /// How often each edge before has not been met after.
    unmet: HashMap<EdgeKey, u32>,
    areas: Areas,
}

/// Some edges of a region, one after the other.
#[derive(Clone, Copy, Debug)]
struct Edges {
    /// Before the first of them.
    first: EdgeCursor,
    count: usize,
}

impl Edges {
    fn next(&mut self, region: &Region) -> Option<[DVec2; 2]> {
        self.count = self.count.checked_sub(1)?;
        self.first.next(region)
    }
}

/// What is done.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pass {
    /// Equal edges at the beginning are passed over.
    Beginning,
    /// Equal edges at the end of a ring are.
    Ending,
    /// The edges before are noted.
    Noting,
    /// The edges after are met: new ones are found.
    Meeting,
    /// The edges before are gone through again: lost ones are found.
    Missing,
    Done,
}

/// The bits of both ends.
type EdgeKey = [u64; 4];

fn key([from, to]: [DVec2; 2]) -> EdgeKey {
    [from.x, from.y, to.x, to.y].map(f64::to_bits)
}

impl RegionComparison {
    /// Begins to compare.
    pub fn new(before: Arc<Region>, after: Arc<Region>) -> Self {
        let all = |region: &Region| Edges { first: EdgeCursor::default(), count: region.corner_count() };
        let none = Edges { first: EdgeCursor::default(), count: 0 };
        Self {
            left: [[none, all(&before)], [none, all(&after)]],
            to_visit: [none; 2],
            regions: [before, after],
            pass: Pass::Beginning,
            unmet: HashMap::new(),
            areas: Areas::default(),
        }
    }

    /// Goes through about so many edges.
    pub fn advance(&mut self, visits: usize) -> Progress {
        for _ in 0..visits {
            let goes_on = match self.pass {
                Pass::Beginning => self.pass_over_first(),
                Pass::Ending => self.pass_over_last(),
                Pass::Noting | Pass::Meeting | Pass::Missing => self.visit(),
                Pass::Done => return Progress::Done,
            };
            if !goes_on {
                self.next_pass();
            }
        }
        Progress::More
    }

    /// Passes an edge over that both regions have next.
    fn pass_over_first(&mut self) -> bool {
        let mut rest = self.left.map(|[_, rest]| rest);
        let [before, after] = [0, 1].map(|n| rest[n].next(&self.regions[n]).map(key));
        let equal = before.is_some() && before == after;
        if equal {
            [self.left[0][1], self.left[1][1]] = rest;
        }
        equal
    }

    /// Parts what is left of the present rings from what is behind them.
    fn part_rings(&mut self) {
        for (region, left) in self.regions.iter().zip(&mut self.left) {
            let [_, rest] = *left;
            let in_ring = rest.first.left_in_ring(region);
            let behind = Edges { first: rest.first.behind_ring(region), count: rest.count - in_ring };
            *left = [Edges { count: in_ring, ..rest }, behind];
        }
    }

    /// Passes an edge over that both regions have at the end of the ring.
    fn pass_over_last(&mut self) -> bool {
        let last = |n: usize| -> Option<EdgeKey> {
            let Edges { first, count } = self.left[n][0];
            Some(key(first.edge_in_ring(&self.regions[n], count.checked_sub(1)?)))
        };
        let equal = last(0).is_some() && last(0) == last(1);
        if equal {
            self.left.iter_mut().for_each(|[ring, _]| ring.count -= 1);
        }
        equal
    }

    /// Looks the next edge of the present pass up.
    fn visit(&mut self) -> bool {
        let region = &self.regions[usize::from(self.pass == Pass::Meeting)];
        let [ring, behind] = &mut self.to_visit;
        let Some(edge) = ring.next(region).or_else(|| behind.next(region)) else { return false };
        if self.pass == Pass::Noting {
            *self.unmet.entry(key(edge)).or_default() += 1;
            return true;
        }
        let was_unmet = match self.unmet.get_mut(&key(edge)) {
            Some(count) if *count > 0 => {
                *count -= 1;
                true
            }
            _ => false,
        };
        // Then an edge after is one before, and an edge before was found nowhere after.
        if was_unmet == (self.pass == Pass::Missing) {
            self.areas.add(Rect::spanning(edge[0], edge[1]));
        }
        true
    }

    fn next_pass(&mut self) {
        self.pass = match self.pass {
            Pass::Beginning => Pass::Ending,
            Pass::Ending => Pass::Noting,
            Pass::Noting => Pass::Meeting,
            Pass::Meeting => Pass::Missing,
            Pass::Missing | Pass::Done => Pass::Done,
        };
        if self.pass == Pass::Ending {
            self.part_rings();
        }
        self.to_visit = self.left[usize::from(self.pass == Pass::Meeting)];
    }

    /// Once done: rectangles that hold every point which lies in one of the regions and not in the other, and every edge of which the
    /// other has not the same. World units.
    pub fn areas(&self) -> &[Rect] {
        &self.areas.rects
    }
}

/// Longest list of areas; beyond it they become one.
const MOST_AREAS: usize = 64;

/// Rectangles that do not touch each other.
#[derive(Clone, Debug, Default)]
struct Areas {
    rects: Vec<Rect>,
}

impl Areas {
    fn add(&mut self, mut area: Rect) {
        // The joined one may touch what neither did.
        while let Some(touched) = self.rects.iter().position(|other| touch(other, &area)) {
            area = area.union(&self.rects.swap_remove(touched));
        }
        self.rects.push(area);
        if self.rects.len() > MOST_AREAS {
            self.rects = self.rects.drain(..).reduce(|a, b| a.union(&b)).into_iter().collect();
        }
    }
}

/// Whether two closed rectangles have a point in common.
fn touch(a: &Rect, b: &Rect) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}
