//! Puts lines into connected triangles, as far as the angles allow.

use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::ControlFlow;

use glam::DVec2;

use super::insert::Inserter;
use super::sharp::SharpNodes;
use super::stops::{CutSegment, Stop, StopKind, meets, rect_around};
use crate::domain::{is_near, lies_between, place};
use crate::geometry::{BoxTree, LatticePoint, Rect, nearest_on_segment};
use crate::mesh::Mesh;
use crate::outline::angles::Angles;
use crate::outline::islands::ChangedIsland;
use crate::outline::lengths::{AskedArea, LengthAnswers, LengthRule};
use crate::outline::local::Improver;
use crate::outline::local::{LineNodeState, LocalMesh};

/// Attempts before everything that is left near a small angle is left out.
const ATTEMPTS: usize = 400;
/// Times that edges longer than their target are cut in an attempt.
const HALVINGS: usize = 4;

/// Share of the diameter of the triangles that a segment is long at least, for an attempt to be worth it.
const SHORTEST: f64 = 0.15;

/// Connected triangles and the segments in them.
pub(super) struct Island<'a> {
    pub(super) start: LocalMesh,
    pub(super) cuts: Vec<CutSegment>,
    /// For each segment, the stretches that are left out: they have no edges.
    left_out: Vec<Vec<bool>>,
    pub(super) shared: &'a Shared<'a>,
    asked: AskedArea,
}

/// What is the same for all islands.
pub(super) struct Shared<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) angles: Angles,
    pub(super) lengths: LengthRule<'a>,
    pub(super) segments: &'a [[LatticePoint; 2]],
    pub(super) extent: LatticePoint,
}

/// Stretches of a segment, one after the other, that become edges.
#[derive(Clone, Copy)]
struct Run {
    cut: usize,
    /// The first stop and the last one.
    stops: [usize; 2],
}

/// A stretch of a segment: the number of the segment in the island, and that of the stretch.
type CutStretch = (usize, usize);

impl<'a> Island<'a> {
    /// Segments that are much shorter than the triangles are left out from the beginning.
    pub(super) fn new(start: LocalMesh, cuts: Vec<CutSegment>, shared: &'a Shared<'a>) -> Self {
        let asked = AskedArea::default();
        let mut island = Self { start, cuts, left_out: Vec::new(), shared, asked };
        let is_short = |cut: &CutSegment| {
            let [a, b] = cut.ends;
            let diameter = |stop: &Stop| island.diameter_at(stop);
            let least = cut.stops.iter().map(diameter).fold(f64::INFINITY, f64::min);
            shared.angles.vector(a, b).length() < SHORTEST * least
        };
        let left_out = island.cuts.iter().map(|cut| vec![is_short(cut); cut.inside.len()]).collect();
        island.left_out = left_out;
        island
    }

    /// Returns the island with the triangles that [`Self::fit`] returned.
    pub(super) fn into_changed(self, now: LocalMesh) -> ChangedIsland {
        ChangedIsland { start: self.start, now, asked: self.asked.rect() }
    }

    /// Returns the triangles with edges on the segments. What cannot have edges is left out, a stretch after
    /// the other: at last, nothing changes.
    pub(super) fn fit(&mut self) -> LocalMesh {
        for attempt in 0..ATTEMPTS {
            let mut local = self.start.clone();
            let mut failing = self.insert(&mut local);
            self.improve(&mut local);
            let poor = self.failing(&local);
            if failing.is_empty() && poor.is_empty() {
                self.find_edges(&mut local);
                return local;
            }
            failing.sort_unstable();
            failing.dedup();
            failing.extend(self.stretches_at(&local, &poor, attempt));
            failing.iter().for_each(|&(cut, stretch)| self.left_out[cut][stretch] = true);
        }
        self.left_out.iter_mut().flatten().for_each(|out| *out = true);
        self.start.clone()
    }

    /// Notes the edges that lie on stretches that are left out: between nodes on both sides of one.
    fn find_edges(&self, local: &mut LocalMesh) {
        let settled = |v: &u32| local.states[*v as usize] != LineNodeState::Free;
        let nodes: Vec<u32> = (0..local.points.len() as u32).filter(settled).collect();
        let boxes: Vec<Rect> = nodes.iter().map(|&v| rect_around(&[local.points[v as usize]], 1.0)).collect();
        let (tree, mut star) = (BoxTree::new(&boxes), Vec::new());
        let cuts = self.cuts.iter().zip(&self.left_out).filter(|(_, left_out)| left_out.contains(&true));
        for (cut, _) in cuts {
            let is_on = |p: LatticePoint| {
                cut.ends.contains(&p) || (is_near(cut.ends, p) && lies_between(cut.ends, p))
            };
            let mut on_segment = Vec::new();
            let _ = tree.visit_meeting(&rect_around(&cut.ends, 1.0), |n| {
                let v = nodes[n as usize];
                on_segment.extend(is_on(local.points[v as usize]).then_some(v));
                ControlFlow::Continue(())
            });
            on_segment.sort_unstable();
            for v in on_segment {
                local.triangles.star(v, &mut star);
                let ends = star.iter().flat_map(|&(t, i)| local.triangles.starting_at(t, i));
                let ends: Vec<u32> = ends.filter(|&w| w != v && is_on(local.points[w as usize])).collect();
                for w in ends {
                    local.fixed.entry(LocalMesh::key(v, w)).or_insert(cut.segment);
                }
            }
        }
    }

    fn improve(&self, local: &mut LocalMesh) {
        let shared = self.shared;
        let mut improver = Improver {
            angles: &shared.angles,
            answers: shared.lengths.answers_noted(&self.asked),
            extent: shared.extent,
            segments: shared.segments,
            slides_along: None,
        };
        improver.run(local);
        for _ in 0..HALVINGS {
            let mut answers = shared.lengths.answers_noted(&self.asked);
            let counts = |local: &LocalMesh, t: u32| {
                self.has_changed(local, t) && self.meets_target(local, t, &mut answers)
            };
            if !shared.lengths.is_any() || !improver.halve_long(local, counts) {
                return;
            }
            improver.run(local);
        }
    }

    /// Returns whether the triangle of the mesh at a place is not larger than its target.
    fn meets_target(&self, local: &LocalMesh, t: u32, answers: &mut LengthAnswers) -> bool {
        let mesh = self.shared.mesh;
        local.owners[t as usize]
            .is_some_and(|owner| !answers.ask_for_more(mesh.corners(owner), mesh.triangle(owner).level()))
    }

    fn has_changed(&self, local: &LocalMesh, t: u32) -> bool {
        (t as usize) >= self.start.triangles.len() || local.corners(t) != self.start.corners(t)
    }

    /// Returns the stretches that are to become edges, as far as they are connected.
    fn runs(&self) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for (cut, of) in self.cuts.iter().enumerate() {
            for n in (0..of.inside.len()).filter(|&n| of.inside[n] && !self.left_out[cut][n]) {
                match runs.last_mut() {
                    Some(run) if run.cut == cut && run.stops[1] == n => run.stops[1] = n + 1,
                    _ => runs.push(Run { cut, stops: [n, n + 1] }),
                }
            }
        }
        runs
    }

    /// Puts the runs into triangles, and returns the stretches for which that was not possible.
    fn insert(&self, local: &mut LocalMesh) -> Vec<CutStretch> {
        let (runs, mut failing) = (self.runs(), Vec::new());
        let mut ends: Vec<(u8, LatticePoint, usize, usize)> = Vec::new();
        for (n, run) in runs.iter().enumerate() {
            for end in 0..2 {
                let stop = self.stop(run, end);
                ends.push((u8::from(stop.kind == StopKind::Inside), stop.at, n, end));
            }
        }
        ends.sort_unstable();
        let mut nodes = vec![[None; 2]; runs.len()];
        let mut inserter = Inserter::new(local, &self.shared.angles);
        for (_, _, n, end) in ends {
            let stop = *self.stop(&runs[n], end);
            nodes[n][end] = inserter.node_at(&stop, self.cuts[runs[n].cut].segment);
            if nodes[n][end].is_none() {
                failing.push(self.stretch_at(&runs[n], stop.at));
            }
        }
        for (run, nodes) in runs.iter().zip(nodes) {
            let cut = &self.cuts[run.cut];
            if let [Some(from), Some(to)] = nodes
                && let Err(at) = inserter.walk(cut.segment, cut.ends, [from, to])
            {
                failing.push(self.stretch_at(run, at));
            }
        }
        failing
    }

    fn stop(&self, run: &Run, end: usize) -> &Stop {
        &self.cuts[run.cut].stops[run.stops[end]]
    }

    /// Returns the stretch of a run in which a place is, or the nearest one.
    fn stretch_at(&self, run: &Run, at: LatticePoint) -> CutStretch {
        let cut = &self.cuts[run.cut];
        let [a, b] = cut.ends.map(place);
        let along = |p: LatticePoint| {
            let [x, y] = place(p);
            (b[0] - a[0]) * (x - a[0]) + (b[1] - a[1]) * (y - a[1])
        };
        let found = (run.stops[0]..run.stops[1]).find(|&n| along(cut.stops[n + 1].at) > along(at));
        (run.cut, found.unwrap_or(run.stops[1] - 1))
    }

    /// Returns the triangles that have too small an angle or too long an edge, the worst first.
    fn failing(&self, local: &LocalMesh) -> Vec<u32> {
        let (angles, mut answers) = (&self.shared.angles, self.shared.lengths.answers_noted(&self.asked));
        let sharp = SharpNodes::new(local, angles);
        let mut failing = Vec::new();
        for t in 0..local.triangles.len() as u32 {
            if !local.is_alive(t) || !self.has_changed(local, t) {
                continue;
            }
            let worst = angles.worst(local.corners(t));
            let limit = local.triangles.corners[t as usize]
                .iter()
                .map(|&v| sharp.limit(v).max(local.poor_at.get(v as usize).copied().unwrap_or(0.0)))
                .fold(angles.limit(), f64::max);
            if worst > limit
                || (answers.exceed(local.corners(t)) && self.meets_target(local, t, &mut answers))
            {
                failing.push((worst, t));
            }
        }
        failing.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        failing.into_iter().map(|(_, t)| t).collect()
    }

    /// Returns stretches to leave out for triangles that fail: one for each, unless another one nearby was
    /// found before.
    fn stretches_at(&self, local: &LocalMesh, failing: &[u32], attempt: usize) -> Vec<CutStretch> {
        let mut found = Vec::new();
        let mut taken: Vec<Rect> = Vec::new();
        let candidates: Vec<CutStretch> = (0..self.cuts.len())
            .flat_map(|cut| (0..self.cuts[cut].inside.len()).map(move |n| (cut, n)))
            .filter(|&(cut, n)| self.cuts[cut].inside[n] && !self.left_out[cut][n])
            .collect();
        let ends = |(cut, n): CutStretch| [n, n + 1].map(|n| self.cuts[cut].stops[n].at);
        let boxes: Vec<Rect> = candidates.iter().map(|&stretch| rect_around(&ends(stretch), 1.0)).collect();
        let tree = BoxTree::new(&boxes);
        for &t in failing {
            let corners = local.corners(t);
            let rect = rect_around(&corners, 1.0);
            if taken.iter().any(|other| rect.min.cmple(other.max).all() && other.min.cmple(rect.max).all()) {
                continue;
            }
            let size = rect.size().max_element();
            let mut margin = size * attempt as f64 / 512.0;
            while margin < 4.0 * self.shared.extent.as_dvec2().max_element() {
                let around = rect_around(&corners, margin + 1.0);
                // The last one in their order.
                let mut last = None;
                let _ = tree.visit_meeting(&around, |n| {
                    if meets(&around, ends(candidates[n as usize])) {
                        last = last.max(Some(n));
                    }
                    ControlFlow::Continue(())
                });
                if let Some(n) = last {
                    found.push(candidates[n as usize]);
                    taken.push(rect_around(&corners, margin + size));
                    break;
                }
                margin = 2.0 * margin + size;
            }
        }
        found
    }

    /// Returns the stretches in the domain that have no edges, joined where they follow one another: the
    /// number of the segment and the ends.
    pub(super) fn unresolved(&self) -> Vec<(u32, [Stop; 2])> {
        let mut found = Vec::new();
        for (cut, left_out) in self.cuts.iter().zip(&self.left_out) {
            let is_out: Vec<bool> =
                cut.inside.iter().zip(left_out).map(|(&inside, &left_out)| inside && left_out).collect();
            let mut first = 0;
            for run in is_out.chunk_by(|a, b| a == b) {
                let last = first + run.len();
                if run[0] {
                    found.push((cut.segment, [cut.stops[first], cut.stops[last]]));
                }
                first = last;
            }
        }
        found
    }

    /// Returns the diameter of the smallest triangle of the start at a stop, in world units.
    fn diameter_at(&self, stop: &Stop) -> f64 {
        let mut star = Vec::new();
        self.start.triangles.star(stop.near, &mut star);
        let length = |a, b| self.shared.angles.vector(a, b).length();
        let longest = |[a, b, c]: [LatticePoint; 3]| length(a, b).max(length(b, c)).max(length(c, a));
        star.iter().map(|&(t, _)| longest(self.start.corners(t))).fold(f64::INFINITY, f64::min)
    }

    /// Returns the boundary of the domain there.
    pub(super) fn boundary(&self) -> LocalBoundary {
        let (start, step) = (&self.start, self.shared.angles.step());
        let all = (0..start.triangles.len() as u32).flat_map(|t| [0, 1, 2].map(|i| (t, i)));
        let edge = |(t, i): (u32, usize)| {
            let [_, b, c] = start.triangles.starting_at(t, i);
            [b, c].map(|v| start.points[v as usize].as_dvec2() * step)
        };
        let edges: Vec<[DVec2; 2]> = all.filter(|&(t, i)| start.is_boundary(t, i)).map(edge).collect();
        let boxes: Vec<Rect> = edges.iter().map(|[a, b]| Rect::new(a.min(*b), a.max(*b))).collect();
        LocalBoundary { edges, tree: BoxTree::new(&boxes) }
    }

    /// Returns an estimate of the diameter that a stretch needs because of the boundary near its middle, in
    /// world units: at most the diameter of the triangles at it, divided by √2.
    pub(super) fn size_at(&self, ends: [Stop; 2], boundary: &LocalBoundary) -> f64 {
        let own = ends.iter().map(|stop| self.diameter_at(stop)).fold(0.0, f64::max) * FRAC_1_SQRT_2;
        let [a, b] = ends.map(|stop| stop.at.as_dvec2() * self.shared.angles.step());
        own.min(boundary.distance(0.5 * (a + b)))
    }
}

/// The boundary of the domain near lines, in world units from the corner of the grid.
pub(super) struct LocalBoundary {
    edges: Vec<[DVec2; 2]>,
    tree: BoxTree,
}

impl LocalBoundary {
    fn distance(&self, p: DVec2) -> f64 {
        let squared = |n: u32| nearest_on_segment(p, self.edges[n as usize]).distance_squared(p);
        self.tree.nearest(p, squared).map_or(f64::INFINITY, |(_, squared)| squared.sqrt())
    }
}
