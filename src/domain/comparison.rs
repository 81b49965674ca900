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
#[derive(Clone, Debug)]
pub struct RegionComparison {
    before: Arc<Region>,
    after: Arc<Region>,
    pass: Pass,
    cursor: EdgeCursor,
    /// How often each edge of `before` has not been met in `after`.
    unmet: HashMap<EdgeKey, u32>,
    areas: Areas,
}

/// Which edges are gone through.
#[derive(Clone, Copy, Debug)]
enum Pass {
    /// Those before, to be noted.
    Noting,
    /// Those after: new ones are found.
    Meeting,
    /// Those before again: lost ones are found.
    Missing,
    Done,
}

/// The bits of both ends.
type EdgeKey = [u64; 4];

impl RegionComparison {
    /// Begins to compare.
    pub fn new(before: Arc<Region>, after: Arc<Region>) -> Self {
        let pass = if before == after { Pass::Done } else { Pass::Noting };
        let unmet = HashMap::with_capacity(before.corner_count());
        Self { before, after, pass, cursor: EdgeCursor::default(), unmet, areas: Areas::default() }
    }

    /// Goes through about so many edges.
    pub fn advance(&mut self, visits: usize) -> Progress {
        for _ in 0..visits {
            let region = match self.pass {
                Pass::Noting | Pass::Missing => &self.before,
                Pass::Meeting => &self.after,
                Pass::Done => return Progress::Done,
            };
            match self.cursor.next(region) {
                Some(edge) => self.visit(edge),
                None => self.next_pass(),
            }
        }
        Progress::More
    }

    fn visit(&mut self, edge: [DVec2; 2]) {
        let [from, to] = edge;
        let key = [from.x, from.y, to.x, to.y].map(f64::to_bits);
        if matches!(self.pass, Pass::Noting) {
            *self.unmet.entry(key).or_default() += 1;
            return;
        }
        let was_unmet = match self.unmet.get_mut(&key) {
            Some(count) if *count > 0 => {
                *count -= 1;
                true
            }
            _ => false,
        };
        // Then an edge after is one before, and an edge before was found nowhere after.
        let is_missing = matches!(self.pass, Pass::Missing);
        if was_unmet == is_missing {
            self.areas.add(Rect::spanning(from, to));
        }
    }

    fn next_pass(&mut self) {
        self.cursor = EdgeCursor::default();
        self.pass = match self.pass {
            Pass::Noting => Pass::Meeting,
            Pass::Meeting => Pass::Missing,
            Pass::Missing | Pass::Done => Pass::Done,
        };
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
