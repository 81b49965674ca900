//! Overlays segments on the lattice: afterwards they meet in their ends only.

use std::ops::ControlFlow;

use super::LinePart;
use super::exact::{crossing, is_near, lies_between, place};
use crate::geometry::{BoxTree, LatticePoint, NumberMap, Rect};

/// Rounds in which segments are cut where they meet. A cut bends a segment by up to one lattice step, which
/// can make it meet another one; more than three rounds were never seen.
const ROUNDS: usize = 12;

/// Segments that meet in their ends only, each with its lower end first.
#[derive(Default)]
pub(super) struct Arrangement {
    segments: Vec<[LatticePoint; 2]>,
    /// What became of each segment that was cut or moved.
    became: NumberMap<[LatticePoint; 2], Vec<LatticePoint>>,
    /// The corner that a point became, if it is another one.
    corners: NumberMap<LatticePoint, LatticePoint>,
}

/// Points of which no two are within one step of each other along x and y.
#[derive(Default)]
struct Corners {
    points: NumberMap<LatticePoint, ()>,
}

impl Corners {
    /// Returns the corner at most one step from a point, which becomes one if there is none.
    fn at(&mut self, p: LatticePoint) -> LatticePoint {
        if self.points.contains_key(&p) {
            return p;
        }
        let near = |c: u32| c.saturating_sub(1)..=c + 1;
        let mut around = near(p.x).flat_map(|x| near(p.y).map(move |y| LatticePoint::new(x, y)));
        let found = around.find(|other| self.points.contains_key(other));
        found.unwrap_or_else(|| {
            self.points.insert(p, ());
            p
        })
    }
}

impl Arrangement {
    /// Overlays segments, each with its lower end first.
    pub(super) fn of(ends: impl Iterator<Item = [LatticePoint; 2]>) -> Self {
        let mut segments: Vec<[LatticePoint; 2]> = ends.collect();
        segments.sort_unstable();
        segments.dedup();
        let mut points: Vec<LatticePoint> = segments.iter().flatten().copied().collect();
        points.sort_unstable();
        points.dedup();
        let (mut corners, mut arrangement) = (Corners::default(), Self::default());
        for p in points {
            let corner = corners.at(p);
            if corner != p {
                arrangement.corners.insert(p, corner);
            }
        }
        segments.iter_mut().for_each(|ends| *ends = arrangement.moved(*ends));
        arrangement.segments = without_repeats(segments);
        for _ in 0..ROUNDS {
            if !arrangement.cut(&mut corners) {
                return arrangement;
            }
        }
        arrangement.leave_out_crossing();
        arrangement
    }

    /// Returns the segments, in ascending order.
    pub(super) fn into_segments(self) -> Vec<[LatticePoint; 2]> {
        self.segments
    }

    /// Returns the parts that a segment became, from its lower end on.
    pub(super) fn parts_of(&self, [from, to]: [LatticePoint; 2]) -> Vec<LinePart> {
        let (mut parts, mut stack) = (Vec::new(), vec![([self.corner(from), self.corner(to)], 0)]);
        while let Some((ends, round)) = stack.pop() {
            match self.became.get(&sorted(ends)) {
                _ if ends[0] == ends[1] => {}
                // In a round, a segment becomes others; a longer chain is one in a circle.
                Some(path) if round <= ROUNDS => {
                    let pairs = path.windows(2).map(|pair| [pair[0], pair[1]]);
                    if ends[0] < ends[1] {
                        stack.extend(pairs.rev().map(|pair| (pair, round + 1)));
                    } else {
                        stack.extend(pairs.map(|[a, b]| ([b, a], round + 1)));
                    }
                }
                _ => parts.push(self.part(ends)),
            }
        }
        parts
    }

    fn part(&self, ends: [LatticePoint; 2]) -> LinePart {
        match self.segments.binary_search(&sorted(ends)) {
            Ok(segment) => LinePart::Segment { segment: segment as u32, backwards: ends[1] < ends[0] },
            Err(_) => LinePart::Tangled { ends },
        }
    }

    fn corner(&self, p: LatticePoint) -> LatticePoint {
        self.corners.get(&p).copied().unwrap_or(p)
    }

    fn moved(&self, ends: [LatticePoint; 2]) -> [LatticePoint; 2] {
        sorted(ends.map(|p| self.corner(p)))
    }

    /// Cuts segments at corners beside them and where they cross. Returns whether there was anything to cut.
    fn cut(&mut self, corners: &mut Corners) -> bool {
        let tree = tree_of(&self.segments);
        let mut cuts: Vec<Vec<LatticePoint>> = vec![Vec::new(); self.segments.len()];
        let mut points: Vec<LatticePoint> = self.segments.iter().flatten().copied().collect();
        points.sort_unstable();
        points.dedup();
        for p in points {
            visit(&tree, [p, p], |n| {
                let ends = self.segments[n];
                if !ends.contains(&p) && is_near(ends, p) && lies_between(ends, p) {
                    cuts[n].push(p);
                }
            });
        }
        let mut crossings = Vec::new();
        for (n, &ends) in self.segments.iter().enumerate() {
            visit(&tree, ends, |m| {
                if m > n
                    && let Some(at) = crossing(ends, self.segments[m])
                {
                    crossings.push((at, [n, m]));
                }
            });
        }
        crossings.sort_unstable();
        for (at, pair) in crossings {
            let corner = corners.at(at);
            for n in pair.into_iter().filter(|&n| !self.segments[n].contains(&corner)) {
                cuts[n].push(corner);
            }
        }
        self.apply(cuts)
    }

    fn apply(&mut self, cuts: Vec<Vec<LatticePoint>>) -> bool {
        let (mut is_cut, mut parts) = (false, Vec::with_capacity(self.segments.len()));
        for (&ends, mut cuts) in self.segments.iter().zip(cuts) {
            if cuts.is_empty() {
                parts.push(ends);
                continue;
            }
            is_cut = true;
            cuts.sort_by_cached_key(|&p| (along(ends, p), p));
            cuts.dedup();
            let path: Vec<LatticePoint> = [ends[0]].into_iter().chain(cuts).chain([ends[1]]).collect();
            parts.extend(path.windows(2).map(|pair| sorted([pair[0], pair[1]])));
            self.became.insert(ends, path);
        }
        self.segments = without_repeats(parts);
        is_cut
    }

    /// Leaves out the later one of two segments that still cross.
    fn leave_out_crossing(&mut self) {
        let tree = tree_of(&self.segments);
        let mut stays = vec![true; self.segments.len()];
        for (n, &ends) in self.segments.iter().enumerate() {
            visit(&tree, ends, |m| {
                if m < n && stays[m] && crossing(ends, self.segments[m]).is_some() {
                    stays[n] = false;
                }
            });
        }
        let mut stays = stays.into_iter();
        self.segments.retain(|_| stays.next() == Some(true));
    }
}

/// Returns how far a point is along a segment, in an exact measure.
fn along([a, b]: [LatticePoint; 2], p: LatticePoint) -> i64 {
    let ([ax, ay], [bx, by], [px, py]) = (place(a), place(b), place(p));
    (bx - ax) * (px - ax) + (by - ay) * (py - ay)
}

fn sorted([a, b]: [LatticePoint; 2]) -> [LatticePoint; 2] {
    [a.min(b), a.max(b)]
}

fn without_repeats(mut segments: Vec<[LatticePoint; 2]>) -> Vec<[LatticePoint; 2]> {
    segments.retain(|[a, b]| a != b);
    segments.sort_unstable();
    segments.dedup();
    segments
}

/// Returns the rectangle of a segment and one step around it, in lattice coordinates.
fn rect_of([a, b]: [LatticePoint; 2]) -> Rect {
    let (a, b) = (a.as_dvec2(), b.as_dvec2());
    Rect::new(a.min(b) - 1.0, a.max(b) + 1.0)
}

fn tree_of(segments: &[[LatticePoint; 2]]) -> BoxTree {
    BoxTree::new(&segments.iter().map(|&ends| rect_of(ends)).collect::<Vec<_>>())
}

fn visit(tree: &BoxTree, ends: [LatticePoint; 2], mut visit: impl FnMut(usize)) {
    let _ = tree.visit_meeting(&rect_of(ends), |n| {
        visit(n as usize);
        ControlFlow::Continue(())
    });
}
