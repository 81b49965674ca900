//! Raises the smallest angles: flips edges, shifts nodes, and joins nodes that are too near to each other.

use glam::{DVec2, dvec2};

use super::{LineNodeState, LocalMesh};
use crate::domain::{OutlineNearby, RegionOnLattice};
use crate::geometry::LatticePoint;
use crate::outline::angles::Angles;
use crate::outline::lengths::LengthAnswers;
use crate::outline::smooth::DIRECTIONS;
use crate::outline::snap::rounded;
use crate::outline::triangulation::NONE;

/// Step lengths of the search, as shares of the mean edge: the first one, and how often it is halved.
const FIRST_STEP: f64 = 0.25;
const STEP_LENGTHS: usize = 5;
/// Angles below this one are raised: 27°, a cotangent.
const GOAL: f64 = 1.962_610_505_505_150_6;
/// Rounds over all triangles with small angles.
const ROUNDS: usize = 12;
/// By how much a cotangent must fall for a change to count.
const LEAST_GAIN: f64 = 1e-3;

/// Improves triangles.
pub(in crate::outline) struct Improver<'a> {
    pub(in crate::outline) angles: &'a Angles,
    pub(in crate::outline) answers: LengthAnswers<'a>,
    /// The upper right corner of the lattice.
    pub(in crate::outline) extent: LatticePoint,
    /// The ends of all segments.
    pub(in crate::outline) segments: &'a [[LatticePoint; 2]],
    /// The region along whose outline nodes may slide.
    pub(in crate::outline) slides_along: Option<&'a RegionOnLattice>,
}

/// A change, with the largest cotangent that it leaves in the triangles that it changes.
#[derive(Clone, Copy)]
enum Improvement {
    Flip { triangle: u32, edge: usize },
    Move { node: u32, to: LatticePoint },
    Collapse { node: u32, onto: u32 },
}

impl Improver<'_> {
    /// Changes triangles, the one with the smallest angle first, until no change helps.
    pub(in crate::outline) fn run(&mut self, local: &mut LocalMesh) {
        let mut may_help: Vec<bool> = vec![true; local.triangles.len()];
        for _ in 0..ROUNDS {
            let mut poor = Vec::new();
            may_help.resize(local.triangles.len(), true);
            for t in (0..local.triangles.len() as u32).filter(|&t| may_help[t as usize]) {
                let worst = if local.is_alive(t) { self.angles.worst(local.corners(t)) } else { 0.0 };
                if worst > GOAL {
                    poor.push((worst, t));
                }
            }
            poor.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let mut has_changed = false;
            for (_, t) in poor {
                let is_poor = local.is_alive(t) && self.angles.worst(local.corners(t)) > GOAL;
                let changed = if is_poor { self.improve(local, t) } else { None };
                has_changed |= changed.is_some();
                match changed {
                    None => may_help[t as usize] = false,
                    Some(nodes) => note(local, &nodes, &mut may_help),
                }
            }
            if !has_changed {
                return;
            }
        }
    }

    /// Makes the best change at a triangle, and returns nodes around which triangles have changed.
    fn improve(&mut self, local: &mut LocalMesh, t: u32) -> Option<Vec<u32>> {
        let mut best: Option<(f64, Improvement)> = None;
        let mut offer = |found: Option<(f64, Improvement)>| {
            if let Some((worst, _)) = found
                && best.is_none_or(|(least, _)| worst < least)
            {
                best = found;
            }
        };
        for i in 0..3 {
            offer(self.flip(local, t, i));
        }
        for v in local.triangles.corners[t as usize] {
            offer(self.shift(local, v));
        }
        let [a, b, c] = local.triangles.corners[t as usize];
        for [node, onto] in [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]] {
            offer(self.collapse(local, node, onto));
        }
        let (_, change) = best?;
        Some(self.apply(local, change))
    }

    fn apply(&self, local: &mut LocalMesh, change: Improvement) -> Vec<u32> {
        match change {
            Improvement::Flip { triangle, edge } => {
                let mut nodes: Vec<u32> = local.triangles.corners[triangle as usize].into();
                nodes.extend(local.opposite(triangle, edge).map(|(v, _)| v));
                local.flip(triangle, edge);
                nodes
            }
            Improvement::Move { node, to } => {
                local.points[node as usize] = to;
                vec![node]
            }
            Improvement::Collapse { node, onto } => {
                let mut star = Vec::new();
                local.triangles.star(node, &mut star);
                let at = |&(t, i): &(u32, usize)| local.triangles.starting_at(t, i)[1] == onto;
                if let Some(k) = star.iter().position(at) {
                    local.collapse(node, &star, k);
                }
                vec![onto]
            }
        }
    }

    /// Returns whether triangles may take the place of others: whether no edge becomes too long.
    fn allows(&mut self, new: &[[LatticePoint; 3]], former: &[[LatticePoint; 3]]) -> bool {
        let answers = &mut self.answers;
        new.iter().all(|&points| former.iter().any(|&former| answers.allow(points, former)))
    }

    fn worst(&self, triangles: &[[LatticePoint; 3]]) -> f64 {
        triangles.iter().map(|&points| self.angles.worst(points)).fold(0.0, f64::max)
    }

    /// Returns what is left if the change helps.
    fn gain(&mut self, new: &[[LatticePoint; 3]], former: &[[LatticePoint; 3]]) -> Option<f64> {
        let (after, before) = (self.worst(new), self.worst(former));
        (after < before - LEAST_GAIN && self.allows(new, former)).then_some(after)
    }

    fn flip(&mut self, local: &LocalMesh, t: u32, i: usize) -> Option<(f64, Improvement)> {
        let (d, _) = local.opposite(t, i)?;
        let [a, b, c] = local.triangles.starting_at(t, i);
        if local.is_fixed(b, c) {
            return None;
        }
        let [a, b, c, d] = [a, b, c, d].map(|v| local.points[v as usize]);
        let after = self.gain(&[[a, b, d], [a, d, c]], &[[a, b, c], [b, d, c]])?;
        Some((after, Improvement::Flip { triangle: t, edge: i }))
    }

    fn shift(&mut self, local: &LocalMesh, v: u32) -> Option<(f64, Improvement)> {
        let outline = match (local.states[v as usize], self.slides_along) {
            (LineNodeState::Fixed, _) | (LineNodeState::OnOutline, None) => return None,
            (LineNodeState::OnOutline, outline) => outline,
            _ => None,
        };
        let mut star = Vec::new();
        local.triangles.star(v, &mut star);
        let former: Vec<[LatticePoint; 3]> = star.iter().map(|&(t, _)| local.corners(t)).collect();
        let moved = |to: LatticePoint| -> Vec<[LatticePoint; 3]> {
            let with = |(corners, &(_, i)): (&[LatticePoint; 3], &(u32, usize))| {
                let mut corners = *corners;
                corners[i] = to;
                corners
            };
            former.iter().zip(&star).map(with).collect()
        };
        let edges = star.iter().map(|&(t, i)| {
            let [a, b, _] = local.triangles.starting_at(t, i).map(|v| local.points[v as usize]);
            self.angles.vector(a, b).length()
        });
        let mean = edges.sum::<f64>() / star.len() as f64;
        let mut nearby = OutlineNearby::default();
        if let Some(region) = outline {
            nearby.collect(region, local.points[v as usize].as_dvec2(), 2.0 * mean, self.angles.step());
        }
        let before = self.worst(&former);
        let (mut best, mut length) = ((before, local.points[v as usize]), FIRST_STEP * mean);
        for _ in 0..STEP_LENGTHS {
            let from = best.1;
            for direction in DIRECTIONS {
                let to = match outline {
                    Some(_) => self.on_outline(&nearby, from, length * direction, mean),
                    None => self.target(local, v, from, length * direction),
                };
                let Some(to) = to else { continue };
                let new = moved(to);
                let worst = self.worst(&new);
                if worst < best.0 && self.allows(&new, &former) {
                    best = (worst, to);
                }
            }
            length /= 2.0;
        }
        (best.0 < before - LEAST_GAIN).then_some((best.0, Improvement::Move { node: v, to: best.1 }))
    }

    /// Returns the place on the outline that is nearest to a node after a step in world units.
    fn on_outline(
        &self,
        nearby: &OutlineNearby,
        from: LatticePoint,
        by: DVec2,
        reach: f64,
    ) -> Option<LatticePoint> {
        let to = nearby.nearest(from.as_dvec2() + by / self.angles.step(), reach)?;
        Some(rounded(to, self.extent))
    }

    /// Returns the place of a node after a step in world units, on what it slides along.
    fn target(&self, local: &LocalMesh, v: u32, from: LatticePoint, by: DVec2) -> Option<LatticePoint> {
        let (step, start) = (self.angles.step(), from.as_dvec2());
        let to = match local.states[v as usize] {
            LineNodeState::Free => start + by / step,
            LineNodeState::OnSegment(segment) => {
                let [a, b] = self.segments[segment as usize].map(LatticePoint::as_dvec2);
                // The directions along it only: two of eight are enough.
                if by.y != 0.0 {
                    return None;
                }
                let along = b - a;
                let world = (along * step).length();
                let share = (start - a).dot(along) / along.length_squared() + by.x / world;
                (0.0 < share && share < 1.0).then(|| a + share * along)?
            }
            LineNodeState::OnBoundary(axis) => {
                if by.y != 0.0 {
                    return None;
                }
                if axis == 0 { start + dvec2(by.x / step.x, 0.0) } else { start + dvec2(0.0, by.x / step.y) }
            }
            LineNodeState::Fixed | LineNodeState::OnOutline => return None,
        };
        let to = (to + 0.5).floor().clamp(DVec2::ZERO, self.extent.as_dvec2());
        Some(LatticePoint::new(to.x as u32, to.y as u32))
    }

    fn collapse(&mut self, local: &LocalMesh, v: u32, onto: u32) -> Option<(f64, Improvement)> {
        let may = match local.states[v as usize] {
            LineNodeState::Free => !local.on_boundary[v as usize],
            LineNodeState::OnSegment(segment) => {
                !local.on_boundary[v as usize] && local.fixed.get(&LocalMesh::key(v, onto)) == Some(&segment)
            }
            _ => false,
        };
        if !may {
            return None;
        }
        let mut star = Vec::new();
        local.triangles.star(v, &mut star);
        let ring: Vec<u32> = star.iter().map(|&(t, i)| local.triangles.starting_at(t, i)[1]).collect();
        let k = ring.iter().position(|&w| w == onto)?;
        let beside = [ring[(k + 1) % ring.len()], ring[(k + ring.len() - 1) % ring.len()]];
        if star.len() < 4 || !self.has_two_in_common(local, &ring, onto, beside) {
            return None;
        }
        let former: Vec<[LatticePoint; 3]> = star.iter().map(|&(t, _)| local.corners(t)).collect();
        let kept = star
            .iter()
            .zip(&former)
            .filter(|((t, _), _)| !local.triangles.corners[*t as usize].contains(&onto));
        let new: Vec<[LatticePoint; 3]> = kept
            .map(|((_, i), corners)| {
                let mut corners = *corners;
                corners[*i] = local.points[onto as usize];
                corners
            })
            .collect();
        let after = self.gain(&new, &former)?;
        Some((after, Improvement::Collapse { node: v, onto }))
    }

    /// Returns whether a node on a ring has no other nodes of the ring beside it than these two: otherwise
    /// two triangles would become one.
    fn has_two_in_common(&self, local: &LocalMesh, ring: &[u32], onto: u32, beside: [u32; 2]) -> bool {
        let mut star = Vec::new();
        local.triangles.star(onto, &mut star);
        let mut neighbours =
            star.iter().flat_map(|&(t, i)| local.triangles.starting_at(t, i)).filter(|&w| w != onto);
        neighbours.all(|w| !ring.contains(&w) || beside.contains(&w))
    }

    /// Cuts the edges that are longer than their target in their middles. Returns whether there were any.
    pub(in crate::outline) fn halve_long(
        &mut self,
        local: &mut LocalMesh,
        mut may: impl FnMut(&LocalMesh, u32) -> bool,
    ) -> bool {
        let mut has_cut = false;
        for t in 0..local.triangles.len() as u32 {
            if !local.is_alive(t) || !may(local, t) {
                continue;
            }
            let points = local.corners(t);
            if !self.answers.exceed(points) {
                continue;
            }
            let length =
                |i: usize| self.angles.vector(points[(i + 1) % 3], points[(i + 2) % 3]).length_squared();
            let longest = (1..3).fold(0, |best, i| if length(i) > length(best) { i } else { best });
            has_cut |= self.halve(local, t, longest);
        }
        has_cut
    }

    fn halve(&self, local: &mut LocalMesh, t: u32, i: usize) -> bool {
        let [a, b, c] = local.triangles.starting_at(t, i);
        let [pa, pb, pc] = [a, b, c].map(|v| local.points[v as usize]);
        let on_boundary = local.is_boundary(t, i);
        if !on_boundary && local.triangles.across[t as usize][i] == NONE {
            return false;
        }
        let segment = local.fixed.get(&LocalMesh::key(b, c)).copied();
        let x = LatticePoint::new((pb.x + pc.x) / 2, (pb.y + pc.y) / 2);
        let state = match (segment, on_boundary) {
            (_, true) => LineNodeState::Fixed,
            (Some(segment), false) => LineNodeState::OnSegment(segment),
            (None, false) => LineNodeState::Free,
        };
        let x = match segment {
            Some(segment) => nearest_on(self.segments[segment as usize], x),
            None => x,
        };
        let mut parts = vec![[pa, pb, x], [pa, x, pc]];
        if let Some((d, _)) = local.opposite(t, i) {
            let d = local.points[d as usize];
            parts.extend([[d, pc, x], [d, x, pb]]);
        }
        if !self.worst(&parts).is_finite() {
            return false;
        }
        let x = local.add_node(x, state, on_boundary);
        local.split_edge(t, i, x);
        true
    }
}

/// Returns the lattice point nearest to the foot of a point on a segment.
fn nearest_on([a, b]: [LatticePoint; 2], p: LatticePoint) -> LatticePoint {
    let [a, b, p] = [a, b, p].map(LatticePoint::as_dvec2);
    let foot = crate::geometry::nearest_on_segment(p, [a, b]);
    let foot = (foot + 0.5).floor();
    LatticePoint::new(foot.x as u32, foot.y as u32)
}

/// Notes that triangles at these nodes have changed, so that changes of them and of those beside them may
/// help again.
fn note(local: &LocalMesh, nodes: &[u32], may_help: &mut Vec<bool>) {
    may_help.resize(local.triangles.len(), true);
    let (mut star, mut outer) = (Vec::new(), Vec::new());
    for &v in nodes {
        local.triangles.star(v, &mut star);
        for &(t, _) in &star {
            for w in local.triangles.corners[t as usize] {
                local.triangles.star(w, &mut outer);
                outer.iter().for_each(|&(t, _)| may_help[t as usize] = true);
            }
        }
    }
}
