//! Puts lines into triangles: their corners become nodes, and their segments edges.

use super::stops::{Stop, StopKind};
use crate::domain::{cross, crossing, is_near, lies_between};
use crate::geometry::LatticePoint;
use crate::outline::angles::Angles;
use crate::outline::local::{LineNodeState, LocalMesh};
use crate::outline::triangulation::NONE;

/// The cotangent of the smallest angle that a move may leave for the steps that follow: 5°.
const COT_5: f64 = 11.430_052_302_761_343;
/// By how much worse a further node is than a moved one, as a factor of cotangents and as a term.
const PRICE_OF_NODE: (f64, f64) = (1.3, 0.5);

/// Changes triangles.
pub(super) struct Inserter<'a> {
    pub(super) local: &'a mut LocalMesh,
    pub(super) angles: &'a Angles,
    star: Vec<(u32, usize)>,
}

/// How a segment goes on from a node.
enum LineStep {
    /// Along an edge to this node.
    To(u32),
    /// Through the edge opposite the corner of a triangle, at a place.
    Through(u32, usize, LatticePoint),
}

/// What makes the place where a segment crosses an edge a node.
#[derive(Clone, Copy)]
enum WayOfCrossing {
    Move(u32),
    Flip,
    Split,
}

impl<'a> Inserter<'a> {
    pub(super) fn new(local: &'a mut LocalMesh, angles: &'a Angles) -> Self {
        Self { local, angles, star: Vec::new() }
    }

    /// Makes a stop on a segment a node, and returns it; `None` if that is not possible.
    pub(super) fn node_at(&mut self, stop: &Stop, segment: u32) -> Option<u32> {
        let count = self.local.points.len();
        let (node, was) = match stop.kind {
            StopKind::BoundaryNode(node) => (node, LineNodeState::Fixed),
            StopKind::BoundaryEdge(edge, on_outline) => {
                (self.node_in_boundary(edge, stop.at, on_outline)?, LineNodeState::Fixed)
            }
            StopKind::Corner | StopKind::Inside => {
                let node = self.node_inside(stop)?;
                (node, self.local.states.get(node as usize).copied()?)
            }
        };
        // What ends a run only because the rest is left out may slide along the segment.
        let slides = stop.kind == StopKind::Inside && !self.local.on_boundary[node as usize];
        let is_new = was == LineNodeState::Free || node as usize >= count;
        self.local.states[node as usize] =
            if slides && is_new { LineNodeState::OnSegment(segment) } else { LineNodeState::Fixed };
        Some(node)
    }

    /// Makes a place in an edge of the boundary a node: one of its ends moves there, along the outline or
    /// along a straight boundary, or the edge is cut.
    fn node_in_boundary(
        &mut self,
        edge: [u32; 2],
        at: LatticePoint,
        on_outline: Option<LatticePoint>,
    ) -> Option<u32> {
        let mut best: Option<(f64, u32, LatticePoint)> = None;
        for v in edge {
            let to = match (self.local.states[v as usize], on_outline) {
                (LineNodeState::OnBoundary(axis), _) if is_along(axis, self.local.points[v as usize], at) => {
                    at
                }
                (LineNodeState::OnOutline, Some(to)) => to,
                _ => continue,
            };
            let worst = self.worst_moved(v, to);
            if worst <= COT_5 && best.is_none_or(|(least, ..)| worst < least) {
                best = Some((worst, v, to));
            }
        }
        if let Some((_, v, to)) = best {
            self.local.points[v as usize] = to;
            self.local.states[v as usize] = LineNodeState::Fixed;
            return Some(v);
        }
        let (t, i) = self.triangle_with(edge)?;
        self.cut_edge(t, i, at, LineNodeState::Fixed)
    }

    /// Makes a place inside the domain, or on its boundary, a node.
    fn node_inside(&mut self, stop: &Stop) -> Option<u32> {
        let t = self.triangle_at(stop)?;
        let corners = self.local.triangles.corners[t as usize];
        let is_there = |v: &&u32| is_beside(self.local.points[**v as usize], stop.at);
        if let Some(&v) = corners.iter().find(is_there) {
            if self.local.states[v as usize] == LineNodeState::Free
                && self.worst_moved(v, stop.at).is_finite()
            {
                self.local.points[v as usize] = stop.at;
            }
            return Some(v);
        }
        let edge = (0..3).find(|&i| {
            let [_, b, c] = self.local.triangles.starting_at(t, i).map(|v| self.local.points[v as usize]);
            is_near([b, c], stop.at)
        });
        let on_boundary = edge.filter(|&i| self.local.triangles.across[t as usize][i] == NONE);
        if let Some(i) = on_boundary {
            let [_, b, c] = self.local.triangles.starting_at(t, i);
            return self.node_in_boundary([b, c], stop.at, Some(stop.at));
        }
        let is_free = |v: &u32| self.local.states[*v as usize] == LineNodeState::Free;
        let mut candidates: Vec<u32> = corners.into_iter().filter(is_free).collect();
        if let Some((opposite, _)) = edge.and_then(|i| self.local.opposite(t, i)) {
            candidates.extend(Some(opposite).filter(is_free));
        }
        let mut best: Option<(f64, u32)> = None;
        for v in candidates {
            let worst = self.worst_moved(v, stop.at);
            if worst <= COT_5 && best.is_none_or(|(least, _)| worst < least) {
                best = Some((worst, v));
            }
        }
        if let Some((_, v)) = best {
            self.local.points[v as usize] = stop.at;
            return Some(v);
        }
        match edge {
            Some(i) => self.cut_edge(t, i, stop.at, LineNodeState::Fixed),
            None => self.cut_triangle(t, stop.at),
        }
    }

    /// Cuts an edge, if that leaves no triangle without area.
    fn cut_edge(&mut self, t: u32, i: usize, at: LatticePoint, state: LineNodeState) -> Option<u32> {
        if !self.worst_cut(t, i, at).is_finite() {
            return None;
        }
        let on_boundary = self.local.triangles.across[t as usize][i] == NONE;
        let x = self.local.add_node(at, state, on_boundary);
        self.local.split_edge(t, i, x);
        Some(x)
    }

    fn cut_triangle(&mut self, t: u32, at: LatticePoint) -> Option<u32> {
        let [a, b, c] = self.local.corners(t);
        let parts = [[a, b, at], [b, c, at], [c, a, at]];
        if parts.iter().any(|&part| !self.angles.worst(part).is_finite()) {
            return None;
        }
        let x = self.local.add_node(at, LineNodeState::Fixed, false);
        self.local.split_triangle(t, x);
        Some(x)
    }

    /// Makes edges of the straight way from one node to another.
    ///
    /// # Errors
    /// Fails with the place at which the way cannot go on. What is done stays.
    pub(super) fn walk(
        &mut self,
        segment: u32,
        line: [LatticePoint; 2],
        [from, to]: [u32; 2],
    ) -> Result<(), LatticePoint> {
        let mut at = from;
        // Each step comes nearer to the end. Few cut an edge, which adds triangles.
        for _ in 0..4 * self.local.triangles.len() {
            if at == to {
                return Ok(());
            }
            let here = self.local.points[at as usize];
            let next = match self.step(line, at, to).ok_or(here)? {
                LineStep::To(v) => Some(v),
                LineStep::Through(t, i, x) => self.cross(segment, line, (t, i), x),
            };
            // A flip has made no node: the same place is looked at again.
            let Some(next) = next else { continue };
            if next == NONE {
                return Err(here);
            }
            let state = &mut self.local.states[next as usize];
            *state = match *state {
                LineNodeState::Free => LineNodeState::OnSegment(segment),
                LineNodeState::OnSegment(own) if own == segment => *state,
                _ => LineNodeState::Fixed,
            };
            if next != to && self.local.on_boundary[next as usize] {
                *state = LineNodeState::Fixed;
            }
            self.local.fixed.insert(LocalMesh::key(at, next), segment);
            at = next;
        }
        Err(self.local.points[at as usize])
    }

    /// Finds how the way from a node to another one goes on.
    fn step(&mut self, line: [LatticePoint; 2], at: u32, to: u32) -> Option<LineStep> {
        let local = &*self.local;
        local.triangles.star(at, &mut self.star);
        let [a, b] = [at, to].map(|v| local.points[v as usize]);
        let point = |v: u32| local.points[v as usize];
        let mut neighbours: Vec<u32> =
            self.star.iter().map(|&(t, i)| local.triangles.starting_at(t, i)[1]).collect();
        if let Some(&(t, i)) = self.star.last() {
            neighbours.push(local.triangles.starting_at(t, i)[2]);
        }
        if neighbours.contains(&to) {
            return Some(LineStep::To(to));
        }
        let is_on_way = |&v: &u32| {
            let p = point(v);
            lies_between([a, b], p) && (cross(a, b, p) == 0 || is_near(line, p))
        };
        if let Some(v) = neighbours.into_iter().find(is_on_way) {
            return Some(LineStep::To(v));
        }
        let sector = self.star.iter().find(|&&(t, i)| {
            let [_, p, q] = local.triangles.starting_at(t, i).map(point);
            cross(a, b, p) < 0 && cross(a, b, q) > 0
        });
        let &(t, i) = sector?;
        let [_, p, q] = local.triangles.starting_at(t, i).map(point);
        let x = crossing(line, [p, q]).or_else(|| crossing([a, b], [p, q]))?;
        Some(LineStep::Through(t, i, x))
    }

    /// Makes the place where a segment crosses an edge a node, and returns it; [`NONE`] if that is not
    /// possible, and `None` if the edge was flipped instead.
    fn cross(
        &mut self,
        segment: u32,
        line: [LatticePoint; 2],
        (t, i): (u32, usize),
        x: LatticePoint,
    ) -> Option<u32> {
        let [_, p, q] = self.local.triangles.starting_at(t, i);
        if self.local.is_fixed(p, q) {
            return Some(NONE);
        }
        let mut best: (f64, Option<WayOfCrossing>) = (f64::INFINITY, None);
        let mut offer = |price: f64, change: WayOfCrossing| {
            if price < best.0 {
                best = (price, Some(change));
            }
        };
        for v in [p, q] {
            if self.local.states[v as usize] == LineNodeState::Free {
                offer(self.worst_moved(v, x), WayOfCrossing::Move(v));
            }
        }
        if let Some((opposite, _)) = self.local.opposite(t, i) {
            let at = self.local.points[opposite as usize];
            let is_end = self.local.states[opposite as usize] == LineNodeState::Fixed && line.contains(&at);
            if is_end || is_near(line, at) {
                offer(self.worst_flipped(t, i), WayOfCrossing::Flip);
            }
        }
        offer(self.worst_cut(t, i, x) * PRICE_OF_NODE.0 + PRICE_OF_NODE.1, WayOfCrossing::Split);
        match best.1 {
            None => Some(NONE),
            Some(WayOfCrossing::Move(v)) => {
                self.local.points[v as usize] = x;
                Some(v)
            }
            Some(WayOfCrossing::Flip) => {
                self.local.flip(t, i);
                None
            }
            Some(WayOfCrossing::Split) => {
                Some(self.cut_edge(t, i, x, LineNodeState::OnSegment(segment)).unwrap_or(NONE))
            }
        }
    }

    /// Returns the cotangent of the smallest angle around a node, if it were elsewhere.
    fn worst_moved(&mut self, node: u32, to: LatticePoint) -> f64 {
        self.local.triangles.star(node, &mut self.star);
        let worst = |&(t, i): &(u32, usize)| {
            let mut points = self.local.corners(t);
            points[i] = to;
            self.angles.worst(points)
        };
        self.star.iter().map(worst).fold(0.0, f64::max)
    }

    fn worst_flipped(&self, t: u32, i: usize) -> f64 {
        let Some((opposite, _)) = self.local.opposite(t, i) else { return f64::INFINITY };
        let [a, b, c] = self.local.triangles.starting_at(t, i);
        let [a, b, c, d] = [a, b, c, opposite].map(|v| self.local.points[v as usize]);
        self.angles.worst([a, b, d]).max(self.angles.worst([a, d, c]))
    }

    fn worst_cut(&self, t: u32, i: usize, x: LatticePoint) -> f64 {
        let [a, b, c] = self.local.triangles.starting_at(t, i).map(|v| self.local.points[v as usize]);
        let own = self.angles.worst([a, b, x]).max(self.angles.worst([a, x, c]));
        let Some((opposite, _)) = self.local.opposite(t, i) else { return own };
        let d = self.local.points[opposite as usize];
        own.max(self.angles.worst([d, c, x])).max(self.angles.worst([d, x, b]))
    }

    /// Returns the triangle inside with an edge of the boundary, and the place of the edge in it.
    fn triangle_with(&mut self, [p, q]: [u32; 2]) -> Option<(u32, usize)> {
        self.local.triangles.star(p, &mut self.star);
        let opposite = |&(t, i): &(u32, usize)| {
            let [_, a, b] = self.local.triangles.starting_at(t, i);
            if a == q { Some((t, (i + 2) % 3)) } else { (b == q).then_some((t, (i + 1) % 3)) }
        };
        let found = self.star.iter().filter_map(opposite);
        let mut found = found.filter(|&(t, i)| self.local.triangles.across[t as usize][i] == NONE);
        found.next()
    }

    /// Finds a triangle that holds a stop: on a way towards it, and otherwise among all.
    fn triangle_at(&self, stop: &Stop) -> Option<u32> {
        let local = &*self.local;
        let beyond = |t: u32| {
            (0..3).find(|&i| {
                let [_, b, c] = local.triangles.starting_at(t, i).map(|v| local.points[v as usize]);
                cross(b, c, stop.at) < 0
            })
        };
        let mut t = local.triangles.at[stop.near as usize];
        for _ in 0..1000 {
            if t == NONE {
                break;
            }
            let Some(i) = beyond(t) else { return Some(t) };
            t = local.triangles.across[t as usize][i];
        }
        let all = 0..local.triangles.len() as u32;
        let holds = |&t: &u32| {
            local.is_alive(t)
                && (0..3).all(|i| {
                    let [_, b, c] = local.triangles.starting_at(t, i).map(|v| local.points[v as usize]);
                    // A place on the outline may be one step beside the boundary.
                    cross(b, c, stop.at) >= 0
                        || (local.triangles.across[t as usize][i] == NONE && is_near([b, c], stop.at))
                })
        };
        all.into_iter().find(holds)
    }
}

/// Returns whether two points are at most one lattice step apart along x and along y.
pub(super) fn is_beside(a: LatticePoint, b: LatticePoint) -> bool {
    a.x.abs_diff(b.x) <= 1 && a.y.abs_diff(b.y) <= 1
}

/// Returns whether two points lie on one line along an axis: 0 along x, 1 along y.
fn is_along(axis: u8, a: LatticePoint, b: LatticePoint) -> bool {
    if axis == 0 { a.y == b.y } else { a.x == b.x }
}
