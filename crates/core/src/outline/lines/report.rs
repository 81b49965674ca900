//! How well a mesh fits lines.

use glam::DVec2;

use super::island::Island;
use super::stops::{Stop, StopKind};
use crate::domain::{LineOnLattice, LinePart, LinesOnLattice, cross, place};
use crate::geometry::{BoxTree, Lattice, LatticePoint, NumberMap, Rect, nearest_on_segment};
use crate::mesh::{Extract, Mesh};
use crate::outline::local::LocalMesh;
use crate::text::{Number, short_name};

/// Shares of a segment that differ by less than this many lattice steps are the same.
const SAME_STEPS: f64 = 4.0;

/// How well a mesh fits a line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineFit {
    /// The name of the line.
    pub name: String,
    /// The length of the line, in world units.
    pub length: f64,
    /// The length of its part on edges of the mesh, in world units.
    pub length_on_edges: f64,
    /// How far it is at most from a point of the line to one that is on an edge, along the line, in world
    /// units; the length of the line if no part of it is on edges.
    pub farthest: f64,
    /// The parts that are not on edges, along the line.
    pub unresolved: Vec<UnresolvedPlace>,
    /// The edges, along the line.
    pub edges: Vec<[LatticePoint; 2]>,
}

/// A part of a line that is not on edges of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct UnresolvedPlace {
    /// Its middle, in world units.
    pub place: DVec2,
    /// Its length in world units.
    pub length: f64,
    /// Why it is not on edges.
    pub problem: LineProblem,
    /// An estimate of the diameter that triangles there need to resolve it, in world units; `None` where no
    /// diameter would help.
    pub diameter: Option<f64>,
}

/// Why a part of a line is not on edges of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LineProblem {
    /// The triangles are too large for what is near: another line, a corner, an end, the boundary.
    TooCoarse,
    /// It is not in the domain.
    OutsideDomain,
    /// It crosses other lines again and again within a few lattice steps.
    Tangled,
    /// A corner is not a finite number.
    NotFinite,
    /// All corners of the line are one lattice point.
    NoLength,
    /// It is in a part of the mesh that was removed.
    Removed,
}

impl LineFit {
    /// Returns a sentence for a person where a line that is a weir has gaps in the domain, or no edge at all.
    pub fn weir_note(&self) -> Option<String> {
        let name = short_name(&self.name);
        if self.edges.is_empty() {
            return Some(format!("The weir “{name}” has no edge in the mesh, so that no file has it."));
        }
        let in_domain = |part: &&UnresolvedPlace| part.problem != LineProblem::OutsideDomain;
        let gaps: Vec<&UnresolvedPlace> = self.unresolved.iter().filter(in_domain).collect();
        let first = gaps.first()?;
        let count =
            if gaps.len() == 1 { "a gap".to_owned() } else { format!("{} gaps, the first", gaps.len()) };
        let help = match first.problem {
            LineProblem::TooCoarse => " Smaller triangles there close it.",
            _ => "",
        };
        Some(format!(
            "The weir “{name}” has {count} at x = {}, y = {}, where it is not on edges: water passes at any height.{help}",
            Number(first.place.x),
            Number(first.place.y)
        ))
    }

    /// Takes edges away that are not in a mesh.
    pub(in crate::outline) fn keep_edges_of(&mut self, extract: &Extract) {
        let sorted = |[a, b]: [LatticePoint; 2]| [a.min(b), a.max(b)];
        let mut is_there: NumberMap<[LatticePoint; 2], bool> =
            self.edges.iter().map(|&ends| (sorted(ends), false)).collect();
        for cell in extract.cells() {
            let [a, b, c] = cell.corners.map(|node| extract.nodes()[node]);
            for edge in [[a, b], [b, c], [c, a]] {
                is_there.entry(sorted(edge)).and_modify(|is_there| *is_there = true);
            }
        }
        let is_gone = |ends: &[LatticePoint; 2]| !is_there[&sorted(*ends)];
        let lattice = extract.lattice();
        for run in self.edges.chunk_by(|a, b| a[1] == b[0] && is_gone(a) == is_gone(b)) {
            if !is_gone(&run[0]) {
                continue;
            }
            let world = |p: LatticePoint| lattice.world_from_lattice(p);
            let length = run.iter().map(|ends| world(ends[0]).distance(world(ends[1]))).sum();
            let place = world(run[run.len() / 2][0]);
            let problem = LineProblem::Removed;
            self.unresolved.push(UnresolvedPlace { place, length, problem, diameter: None });
            self.length_on_edges = (self.length_on_edges - length).max(0.0);
            self.farthest = self.farthest.max(length);
        }
        self.edges.retain(|ends| !is_gone(ends));
        if self.edges.is_empty() {
            (self.length_on_edges, self.farthest) = (0.0, self.length);
        }
    }
}

/// What is known of a segment.
#[derive(Default)]
struct SegmentFit {
    /// Along the segment.
    edges: Vec<[LatticePoint; 2]>,
    /// Parts in the domain, as shares of the length.
    inside: Vec<[f64; 2]>,
    /// Parts that were left out, with the diameter that is needed there because of the boundary and because
    /// the triangles there are too large, in world units.
    left_out: Vec<([f64; 2], f64)>,
}

/// Returns the fit of each line.
pub(super) fn fits(mesh: &Mesh, lines: &LinesOnLattice, fitted: &[(Island, LocalMesh)]) -> Vec<LineFit> {
    let mut found: NumberMap<u32, SegmentFit> = NumberMap::default();
    let share = |segment: u32, p: LatticePoint| share(lines.segments[segment as usize], p);
    for (island, local) in fitted {
        for (ends, &segment) in &local.fixed {
            let mut ends = ends.map(|v| local.points[v as usize]);
            if share(segment, ends[1]) < share(segment, ends[0]) {
                ends.reverse();
            }
            // At stairs of the boundary, the last node of a segment can slide off it.
            if ends.iter().all(|&p| is_along(lines.segments[segment as usize], p)) {
                found.entry(segment).or_default().edges.push(ends);
            }
        }
        for cut in &island.cuts {
            let of_segment = found.entry(cut.segment).or_default();
            let at = |n: usize, entering: bool| share_in_domain(cut.ends, &cut.stops[n], entering);
            let inside = (0..cut.inside.len()).filter(|&n| cut.inside[n]);
            of_segment.inside.extend(inside.map(|n| [at(n, true), at(n + 1, false)]));
        }
        let boundary = island.boundary();
        for (segment, ends) in island.unresolved() {
            let shares = ends.map(|stop| share(segment, stop.at));
            found.entry(segment).or_default().left_out.push((shares, island.size_at(ends, &boundary)));
        }
    }
    for (&segment, of_segment) in &mut found {
        of_segment.edges.sort_by(|a, b| share(segment, a[0]).total_cmp(&share(segment, b[0])));
        of_segment.inside.sort_by(|a, b| a[0].total_cmp(&b[0]));
        of_segment.left_out.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    }
    let sizes = FeatureSizes::new(lines, mesh.lattice());
    let reporter = Reporter { lattice: mesh.lattice(), lines, found, sizes };
    lines.lines.iter().map(|line| reporter.fit(line)).collect()
}

/// Returns the place of a stop as a share of the segment; of one on the outline, the one of its two places
/// that is more inside.
fn share_in_domain(ends: [LatticePoint; 2], stop: &Stop, entering: bool) -> f64 {
    let own = share(ends, stop.at);
    match stop.kind {
        StopKind::BoundaryEdge(_, Some(other)) if entering => own.max(share(ends, other)),
        StopKind::BoundaryEdge(_, Some(other)) => own.min(share(ends, other)),
        _ => own,
    }
}

/// Returns whether a point is at most a few lattice steps beside the straight line through a segment.
fn is_along([a, b]: [LatticePoint; 2], p: LatticePoint) -> bool {
    let length = (b.as_dvec2() - a.as_dvec2()).length();
    (cross(a, b, p) as f64).abs() <= SAME_STEPS * length
}

/// Returns the place of a point along a segment, as a share of its length.
fn share([a, b]: [LatticePoint; 2], p: LatticePoint) -> f64 {
    let ([ax, ay], [bx, by], [px, py]) = (place(a), place(b), place(p));
    let along = (bx - ax) * (px - ax) + (by - ay) * (py - ay);
    let whole = (bx - ax) * (bx - ax) + (by - ay) * (by - ay);
    along as f64 / whole as f64
}

/// Makes the fits of lines.
struct Reporter<'a> {
    lattice: &'a Lattice,
    lines: &'a LinesOnLattice,
    found: NumberMap<u32, SegmentFit>,
    sizes: FeatureSizes,
}

/// A part of a line: its length, and why it is not on edges.
struct LinePiece {
    length: f64,
    place: DVec2,
    problem: Option<(LineProblem, Option<f64>)>,
}

impl Reporter<'_> {
    fn fit(&self, line: &LineOnLattice) -> LineFit {
        let (mut pieces, mut edges) = (Vec::new(), Vec::new());
        for part in &line.parts {
            self.push_pieces(part, &mut pieces, &mut edges);
        }
        if line.parts.is_empty() {
            let place = line.first.unwrap_or(DVec2::ZERO);
            pieces.push(LinePiece {
                length: line.length,
                place,
                problem: Some((LineProblem::NoLength, None)),
            });
        }
        let on_edges: f64 =
            pieces.iter().filter(|piece| piece.problem.is_none()).map(|piece| piece.length).sum();
        let is_whole = pieces.iter().all(|piece| piece.problem.is_none());
        LineFit {
            name: line.name.clone(),
            length: line.length,
            // The same number where all of it is on edges, whose nodes are rounded.
            length_on_edges: if is_whole { line.length } else { on_edges.min(line.length) },
            farthest: farthest(&pieces).min(line.length),
            unresolved: unresolved(&pieces),
            edges,
        }
    }

    fn push_pieces(&self, part: &LinePart, pieces: &mut Vec<LinePiece>, edges: &mut Vec<[LatticePoint; 2]>) {
        let problem = |problem, length, place| LinePiece { length, place, problem: Some((problem, None)) };
        match *part {
            LinePart::NotFinite { near } => pieces.push(problem(LineProblem::NotFinite, 0.0, near)),
            LinePart::Beyond { ends: [a, b] } => {
                pieces.push(problem(LineProblem::OutsideDomain, a.distance(b), 0.5 * (a + b)));
            }
            LinePart::Tangled { ends } => {
                let [a, b] = ends.map(|p| self.lattice.world_from_lattice(p));
                pieces.push(problem(LineProblem::Tangled, a.distance(b), 0.5 * (a + b)));
            }
            LinePart::Segment { segment, backwards } => {
                let (from, first) = (pieces.len(), edges.len());
                self.push_segment(segment, pieces);
                edges.extend(self.found.get(&segment).into_iter().flat_map(|found| &found.edges));
                if backwards {
                    pieces[from..].reverse();
                    edges[first..].reverse();
                    edges[first..].iter_mut().for_each(|ends| ends.reverse());
                }
            }
        }
    }

    /// Adds the pieces of a segment, from its lower end on.
    fn push_segment(&self, segment: u32, pieces: &mut Vec<LinePiece>) {
        let ends = self.lines.segments[segment as usize];
        let [a, b] = ends.map(|p| self.lattice.world_from_lattice(p));
        let same = SAME_STEPS / (ends[1].as_dvec2() - ends[0].as_dvec2()).length();
        let none = SegmentFit::default();
        let found = self.found.get(&segment).unwrap_or(&none);
        let mut stops = vec![0.0, 1.0];
        let edges: Vec<[f64; 2]> = found.edges.iter().map(|edge| edge.map(|p| share(ends, p))).collect();
        stops.extend(edges.iter().chain(&found.inside).flatten());
        stops.iter_mut().for_each(|share| *share = share.clamp(0.0, 1.0));
        stops.sort_by(f64::total_cmp);
        let holds = |parts: &[[f64; 2]], at: f64| {
            let after = parts.partition_point(|part| part[0] <= at);
            after > 0 && parts[after - 1][1] >= at
        };
        for pair in stops.windows(2).filter(|pair| pair[1] > pair[0]) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let (length, place) = ((pair[1] - pair[0]) * a.distance(b), a + middle * (b - a));
            let is_tiny = pair[1] - pair[0] <= same;
            let problem = if holds(&edges, middle) || is_tiny {
                None
            } else if holds(&found.inside, middle) {
                let own = found.left_out.iter().filter(|(part, _)| part[0] <= middle && middle <= part[1]);
                let diameter = own.map(|(_, diameter)| *diameter).fold(f64::INFINITY, f64::min);
                let size = self.sizes.at(segment, a + middle * (b - a));
                Some((LineProblem::TooCoarse, Some(size.min(diameter))))
            } else {
                Some((LineProblem::OutsideDomain, None))
            };
            pieces.push(LinePiece { length, place, problem });
        }
    }
}

/// Returns how far it is at most from a point of the line to one on an edge, along the line.
fn farthest(pieces: &[LinePiece]) -> f64 {
    let mut farthest = 0.0f64;
    let runs: Vec<&[LinePiece]> =
        pieces.chunk_by(|a, b| a.problem.is_some() == b.problem.is_some()).collect();
    for (n, run) in runs.iter().enumerate().filter(|(_, run)| run[0].problem.is_some()) {
        let length: f64 = run.iter().map(|piece| piece.length).sum();
        let is_between = n > 0 && n + 1 < runs.len();
        farthest = farthest.max(if is_between { 0.5 * length } else { length });
    }
    farthest
}

/// Returns the pieces that are not on edges, those with the same reason joined where they follow one another.
fn unresolved(pieces: &[LinePiece]) -> Vec<UnresolvedPlace> {
    let reason = |piece: &LinePiece| piece.problem.map(|(problem, _)| problem);
    let runs = pieces.chunk_by(|a, b| reason(a) == reason(b));
    let place = |run: &[LinePiece]| {
        let (problem, _) = run[0].problem?;
        let length: f64 = run.iter().map(|piece| piece.length).sum();
        let mut half = 0.5 * length;
        let middle = run.iter().find(|piece| {
            half -= piece.length;
            half <= 0.0
        });
        let middle = middle.unwrap_or(&run[0]);
        let diameter = middle.problem.and_then(|(_, diameter)| diameter);
        Some(UnresolvedPlace { place: middle.place, length, problem, diameter })
    };
    runs.filter_map(place).collect()
}

/// Distances between parts of lines.
struct FeatureSizes {
    world: Vec<[DVec2; 2]>,
    tree: BoxTree,
}

impl FeatureSizes {
    fn new(lines: &LinesOnLattice, lattice: &Lattice) -> Self {
        let world: Vec<[DVec2; 2]> =
            lines.segments.iter().map(|ends| ends.map(|p| lattice.world_from_lattice(p))).collect();
        let boxes: Vec<Rect> = world.iter().map(|[a, b]| Rect::new(a.min(*b), a.max(*b))).collect();
        Self { world, tree: BoxTree::new(&boxes) }
    }

    /// Returns the distance from a point of a segment to the nearest other segment; at most the length of
    /// the segment.
    fn at(&self, segment: u32, p: DVec2) -> f64 {
        let [a, b] = self.world[segment as usize];
        let nearest = self.tree.nearest(p, |other| match other == segment {
            true => f64::INFINITY,
            false => nearest_on_segment(p, self.world[other as usize]).distance_squared(p),
        });
        let own = a.distance(b);
        nearest.map_or(own, |(_, squared)| squared.sqrt().min(own))
    }
}
