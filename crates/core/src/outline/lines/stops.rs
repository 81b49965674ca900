//! Cuts segments where they meet the boundary of the domain and the edges of the mesh.

use std::ops::ControlFlow;

use crate::domain::{RegionOnLattice, crossing, is_near, lies_between, place};
use crate::geometry::{BoxTree, LatticePoint, NumberSet, Rect};
use crate::outline::local::LocalMesh;
use crate::outline::triangulation::NONE;

/// Where a run of a segment may begin or end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StopKind {
    /// An end of the segment.
    Corner,
    /// A node of the boundary on the segment.
    BoundaryNode(u32),
    /// In an edge of the boundary; with the place where the segment crosses the outline near it, if it does.
    BoundaryEdge([u32; 2], Option<LatticePoint>),
    /// In an edge inside, or in a node.
    Inside,
}

/// A place on a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    pub(super) at: LatticePoint,
    pub(super) kind: StopKind,
    /// A node nearby, from which a search for the place begins.
    pub(super) near: u32,
}

/// A segment cut into stretches by stops.
#[derive(Clone, Debug)]
pub(super) struct CutSegment {
    /// Its number among all.
    pub(super) segment: u32,
    pub(super) ends: [LatticePoint; 2],
    pub(super) stops: Vec<Stop>,
    /// For each stretch from a stop to the next, whether it is in the domain.
    pub(super) inside: Vec<bool>,
}

/// Finds triangles by their place.
pub(super) struct TriangleIndex<'a> {
    local: &'a LocalMesh,
    tree: BoxTree,
}

impl<'a> TriangleIndex<'a> {
    pub(super) fn new(local: &'a LocalMesh) -> Self {
        let boxes: Vec<Rect> =
            (0..local.triangles.len() as u32).map(|t| rect_around(&local.corners(t), 1.0)).collect();
        Self { local, tree: BoxTree::new(&boxes) }
    }

    /// Returns the triangles whose rectangles a segment touches, in ascending order.
    fn near(&self, ends: [LatticePoint; 2]) -> Vec<u32> {
        let mut found = Vec::new();
        let is_met = |rect: &Rect| meets(rect, ends);
        let _ = self.tree.descend(
            |_, rect| is_met(rect),
            |t, rect| {
                found.extend(is_met(rect).then_some(t));
                ControlFlow::Continue(())
            },
        );
        found.sort_unstable();
        found
    }

    /// Cuts a segment; `None` if no part of it is in the domain.
    pub(super) fn cut(
        &self,
        segment: u32,
        ends: [LatticePoint; 2],
        region: Option<&RegionOnLattice>,
    ) -> Option<CutSegment> {
        let triangles = self.near(ends);
        let nearest = *triangles.first()?;
        let near = self.local.triangles.corners[nearest as usize][0];
        let mut stops: Vec<Stop> = ends.map(|at| Stop { at, kind: StopKind::Corner, near }).into();
        self.push_stops(ends, &triangles, region, &mut stops);
        for stop in &mut stops[..2] {
            let holder = triangles.iter().find(|&&t| holds(self.local.corners(t), twice(stop.at)));
            stop.near = holder.map_or(near, |&t| self.local.triangles.corners[t as usize][0]);
        }
        let [a, b] = ends;
        let along = |p: LatticePoint| {
            let ([ax, ay], [bx, by], [px, py]) = (place(a), place(b), place(p));
            (bx - ax) * (px - ax) + (by - ay) * (py - ay)
        };
        stops.sort_by_key(|stop| (along(stop.at), stop.at, stop.kind.rank()));
        let stops = joined(stops);
        let is_inside = |pair: &[Stop]| self.is_inside(&triangles, [pair[0].at, pair[1].at]);
        let inside: Vec<bool> = stops.windows(2).map(is_inside).collect();
        inside.contains(&true).then_some(CutSegment { segment, ends, stops, inside })
    }

    /// Adds the stops between the ends.
    fn push_stops(
        &self,
        ends: [LatticePoint; 2],
        triangles: &[u32],
        region: Option<&RegionOnLattice>,
        stops: &mut Vec<Stop>,
    ) {
        let local = self.local;
        let mut seen = NumberSet::<u32>::default();
        let outline = region.map(|region| region.crossings_with(ends)).unwrap_or_default();
        for &t in triangles {
            for i in 0..3 {
                let [_, p, q] = local.triangles.starting_at(t, i);
                let across = local.triangles.across[t as usize][i];
                let edge = [p, q].map(|v| local.points[v as usize]);
                if is_near(ends, edge[0]) && lies_between(ends, edge[0]) && seen.insert(p) {
                    let kind = if local.on_boundary[p as usize] {
                        StopKind::BoundaryNode(p)
                    } else {
                        StopKind::Inside
                    };
                    stops.push(Stop { at: edge[0], kind, near: p });
                }
                if (across != NONE && across < t) || edge.iter().any(|&v| is_near(ends, v)) {
                    continue;
                }
                let Some(at) = crossing(ends, edge) else { continue };
                let kind = match across {
                    NONE => StopKind::BoundaryEdge([p, q], nearest(&outline, at, edge)),
                    _ => StopKind::Inside,
                };
                stops.push(Stop { at, kind, near: p });
            }
        }
    }

    /// Returns whether the middle between two points is in the domain, or on its boundary.
    fn is_inside(&self, triangles: &[u32], [a, b]: [LatticePoint; 2]) -> bool {
        let middle = [0, 1].map(|i| place(a)[i] + place(b)[i]);
        let rounded = LatticePoint::new((middle[0] / 2) as u32, (middle[1] / 2) as u32);
        triangles.iter().any(|&t| {
            let corners = self.local.corners(t);
            let on_edge = |i: usize| {
                let edge = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                let is_boundary = self.local.triangles.across[t as usize][i] == NONE;
                is_boundary && is_near(edge, rounded) && lies_between(edge, rounded)
            };
            holds(corners, middle) || (0..3).any(on_edge)
        })
    }
}

impl StopKind {
    /// Of stops at one place, the one with the lowest rank counts.
    fn rank(self) -> u8 {
        match self {
            Self::Corner => 0,
            Self::BoundaryNode(_) => 1,
            Self::BoundaryEdge(..) => 2,
            Self::Inside => 3,
        }
    }
}

/// Returns stops without those at most one step from another one. The corners at the ends stay.
fn joined(stops: Vec<Stop>) -> Vec<Stop> {
    let mut kept: Vec<Stop> = Vec::with_capacity(stops.len());
    for stop in stops {
        let is_same =
            |other: &&mut Stop| other.at.x.abs_diff(stop.at.x) <= 1 && other.at.y.abs_diff(stop.at.y) <= 1;
        match kept.last_mut().filter(is_same) {
            Some(last) if last.kind.rank() > stop.kind.rank() => *last = stop,
            Some(last) if last.kind == StopKind::Corner && stop.kind == StopKind::Corner => kept.push(stop),
            Some(_) => {}
            None => kept.push(stop),
        }
    }
    kept
}

/// Returns the crossing with the outline nearest to that with an edge of the boundary, if it is nearer than
/// the ends of the edge are to each other.
fn nearest(outline: &[LatticePoint], at: LatticePoint, [p, q]: [LatticePoint; 2]) -> Option<LatticePoint> {
    let squared = |a: LatticePoint, b: LatticePoint| {
        let ([ax, ay], [bx, by]) = (place(a), place(b));
        (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
    };
    let best = outline.iter().copied().min_by_key(|&other| (squared(at, other), other))?;
    (4 * squared(at, best) < squared(p, q)).then_some(best)
}

fn twice(p: LatticePoint) -> [i64; 2] {
    place(p).map(|c| 2 * c)
}

/// Returns whether a closed triangle holds a point, given by twice its coordinates.
fn holds(corners: [LatticePoint; 3], [x, y]: [i64; 2]) -> bool {
    (0..3).all(|i| {
        let ([ax, ay], [bx, by]) = (twice(corners[i]), twice(corners[(i + 1) % 3]));
        let product = |p: i64, q: i64| i128::from(p) * i128::from(q);
        product(bx - ax, y - ay) >= product(by - ay, x - ax)
    })
}

/// Returns the rectangle around points, in lattice coordinates, with a margin.
pub(super) fn rect_around(points: &[LatticePoint], margin: f64) -> Rect {
    let places = || points.iter().map(|p| p.as_dvec2());
    let low = places().reduce(|a, b| a.min(b)).unwrap_or_default();
    let high = places().reduce(|a, b| a.max(b)).unwrap_or_default();
    Rect::new(low - margin, high + margin)
}

/// Returns whether a segment may touch a rectangle: unless one side of the rectangle or the line through the
/// segment separates them.
pub(super) fn meets(rect: &Rect, [a, b]: [LatticePoint; 2]) -> bool {
    let (a, b) = (a.as_dvec2(), b.as_dvec2());
    let (low, high) = (a.min(b), a.max(b));
    if high.cmplt(rect.min).any() || low.cmpgt(rect.max).any() {
        return false;
    }
    let (along, middle, half) = (b - a, rect.center() - a, 0.5 * rect.size());
    // Twice rounded, so with a margin.
    along.perp_dot(middle).abs() <= (along.x.abs() * half.y + along.y.abs() * half.x) * (1.0 + 1e-9) + 1.0
}
