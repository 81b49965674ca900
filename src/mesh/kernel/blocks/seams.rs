//! Edges between blocks: which nodes both sides share, and how the sides are sewn together.
//!
//! A seam is an edge of the planned mesh between two blocks. Each block divides it by itself:
//!
//! ```text
//!    one side      o-----------o-----------o-----o-----o
//!    the other     o-----------o-----o-----o-----------o
//!                      |           |             |
//!                 equal: linked    |        coarser: the other side is bisected
//!                          coarser: one side is bisected
//! ```
//!
//! Edges come from repeated halving: where two of them begin at the same place, they are equal, or one is
//! part of the other.

use std::collections::BTreeMap;
use std::ops::Range;

use super::plan::PlannedSeams;
use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Limits, Mesh, Neighbour, NodeId, Progress, RefineError, TriangleId};

/// An edge of a triangle on a seam.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeamEdge {
    pub seam: u32,
    /// Where it starts and ends along the seam, in lattice steps along both axes together.
    pub start: u32,
    pub end: u32,
    /// Whether the triangle runs along it from start to end when it is passed around anticlockwise: the two
    /// sides of a seam differ in this.
    pub is_forward: bool,
    pub triangle: TriangleId,
    /// The number of the edge in the triangle.
    pub edge: u8,
    pub start_node: NodeId,
}

/// All seams, and what is left to do with them.
#[derive(Clone, Debug, Default)]
pub(super) struct Seams {
    planned: PlannedSeams,
    /// Edges of first sides that wait for the other side.
    first_sides: Vec<SeamEdge>,
    /// The part of `first_sides` for each seam.
    first_side_of: Vec<Range<usize>>,
    /// Pairs of equal edges.
    links: Vec<[(TriangleId, u8); 2]>,
    /// Edges that have no equal one across, by seam, direction and start.
    open: BTreeMap<Place, OpenEdge>,
    /// Places to look at; `None` before the links are made.
    waiting: Option<Vec<Place>>,
}

/// Seam, direction and start of an edge.
type Place = (u32, bool, u32);

/// An edge of a triangle of the whole mesh that has no equal one across the seam.
#[derive(Clone, Copy, Debug)]
struct OpenEdge {
    end: u32,
    /// The triangle and the number of the edge in it.
    side: (TriangleId, u8),
}

impl SeamEdge {
    fn place(&self) -> Place {
        (self.seam, self.is_forward, self.start)
    }

    fn side(&self) -> (TriangleId, u8) {
        (self.triangle, self.edge)
    }

    fn open(&self) -> OpenEdge {
        OpenEdge { end: self.end, side: self.side() }
    }
}

impl Seams {
    pub fn new(planned: PlannedSeams) -> Self {
        let first_side_of = vec![0..0; planned.origins.len()];
        Self { planned, first_side_of, ..Self::default() }
    }

    /// The mark of the seam on an edge of the planned mesh.
    pub fn mark(&self, root: TriangleId, edge: usize) -> Neighbour {
        let number = self.planned.numbers[root.index()][edge];
        Neighbour::seam(number.expect("edges between blocks have seams"))
    }

    /// An edge of a triangle, if it lies on a seam.
    pub fn edge(&self, mesh: &Mesh, id: TriangleId, edge: usize) -> Option<SeamEdge> {
        let triangle = mesh.triangle(id);
        let seam = triangle.raw_neighbours[edge].as_seam()?;
        let (from, to) = triangle.edge_nodes()[edge];
        let [first, second] = [from, to].map(|node| self.position(seam, mesh.node(node)));
        let is_forward = first < second;
        Some(SeamEdge {
            seam,
            start: first.min(second),
            end: first.max(second),
            is_forward,
            triangle: id,
            edge: edge as u8,
            start_node: if is_forward { from } else { to },
        })
    }

    /// The distance of a point on a seam from its origin, in lattice steps along both axes together.
    fn position(&self, seam: u32, point: LatticePoint) -> u32 {
        let origin = self.planned.origins[seam as usize];
        origin.x.abs_diff(point.x) + origin.y.abs_diff(point.y)
    }

    /// Compares one side of a seam with the other, if that is there already: links equal edges, notes others
    /// as open, and calls `share` for each common node with its number on this and on the other side.
    ///
    /// Triangles have outer numbers, and nodes of `side` inner ones.
    pub fn match_sides(&mut self, side: &[SeamEdge], mut share: impl FnMut(NodeId, NodeId)) {
        let first = &self.first_sides[self.first_side_of[side[0].seam as usize].clone()];
        let (mut here, mut there) = (side, first);
        while let ([a, ..], [b, ..]) = (here, there) {
            if a.start > 0 {
                share(a.start_node, b.start_node);
            }
            if a.end == b.end {
                self.links.push([a.side(), b.side()]);
                (here, there) = (&here[1..], &there[1..]);
                continue;
            }
            // One of them is part of the other.
            let end = a.end.max(b.end);
            for edges in [&mut here, &mut there] {
                let (inside, rest) = edges.split_at(edges.partition_point(|edge| edge.start < end));
                self.open.extend(inside.iter().map(|edge| (edge.place(), edge.open())));
                *edges = rest;
            }
        }
    }

    /// Keeps the edges of a side until the other one comes, if it is the first. All numbers are outer ones.
    pub fn keep_first_side(&mut self, side: &[SeamEdge]) {
        let first = &mut self.first_side_of[side[0].seam as usize];
        if Range::is_empty(first) {
            *first = self.first_sides.len()..self.first_sides.len() + side.len();
            self.first_sides.extend_from_slice(side);
        }
    }

    /// Makes neighbours of the two sides of all seams, and bisects where they do not match. Looks at about
    /// `visits` edges.
    pub fn sew(&mut self, mesh: &mut Mesh, limits: &Limits, visits: usize) -> Result<Progress, RefineError> {
        if self.waiting.is_none() {
            for pair in std::mem::take(&mut self.links) {
                link(mesh, pair);
            }
            self.waiting = Some(self.open.keys().copied().collect());
        }
        for _ in 0..visits {
            let Some(place) = self.waiting.as_mut().and_then(Vec::pop) else { return Ok(Progress::Done) };
            self.sew_edge(mesh, limits, place)?;
        }
        Ok(Progress::More)
    }

    fn sew_edge(&mut self, mesh: &mut Mesh, limits: &Limits, place: Place) -> Result<(), RefineError> {
        let Some(edge) = self.open.get(&place).copied() else { return Ok(()) };
        let (seam, is_forward, start) = place;
        let other_place = (seam, !is_forward, start);
        let mut before = self.open.range((seam, !is_forward, 0)..=other_place);
        let (&(.., other_start), &other) = before.next_back().expect("both sides of an open edge are open");
        if (other_start, other.end) == (start, edge.end) {
            self.open.remove(&place);
            self.open.remove(&other_place);
            link(mesh, [edge.side, other.side]);
            return Ok(());
        }
        let is_coarser = other_start == start && other.end < edge.end;
        let (coarser, _) = if is_coarser { edge.side } else { other.side };
        self.waiting.get_or_insert_default().push(place);
        self.bisect(mesh, limits, coarser)
    }

    /// Bisects a triangle on a seam, and others as compatibility asks, and notes their edges on seams.
    fn bisect(&mut self, mesh: &mut Mesh, limits: &Limits, id: TriangleId) -> Result<(), RefineError> {
        mesh.room_for(id, Mesh::most_new_triangles(mesh.triangle(id).level()), limits)?;
        let mut new = mesh.raw_triangle_count();
        mesh.refine_triangle_with(id, &mut Vec::new(), |mesh, parent| {
            let children = [parent, TriangleId::from_index(new)];
            new += 1;
            self.share_midpoint(mesh, children);
            for (child, edge) in children.into_iter().flat_map(|child| [0, 1, 2].map(|edge| (child, edge))) {
                if let Some(edge) = self.edge(mesh, child, edge) {
                    self.open.insert(edge.place(), edge.open());
                    self.waiting.get_or_insert_default().push(edge.place());
                }
            }
        });
        Ok(())
    }

    /// Where a bisection has made a node on a seam, and the other side has one there, it takes that.
    fn share_midpoint(&self, mesh: &mut Mesh, children: [TriangleId; 2]) {
        let apex = mesh.triangle(children[0]).apex();
        let halves = (0..3).filter_map(|edge| self.edge(mesh, children[0], edge));
        let is_at_apex = |half: &SeamEdge| {
            let (from, to) = mesh.triangle(children[0]).edge_nodes()[usize::from(half.edge)];
            from == apex || to == apex
        };
        let Some(half) = halves.into_iter().find(is_at_apex) else { return };
        let position = self.position(half.seam, mesh.node(apex));
        let Some(other) = self.open.get(&(half.seam, !half.is_forward, position)) else { return };
        let (triangle, edge) = other.side;
        let (from, to) = mesh.triangle(triangle).edge_nodes()[usize::from(edge)];
        // Where this side runs forward, the other one runs backward.
        let shared = if half.is_forward { to } else { from };
        for child in children {
            for vertex in &mut mesh.triangles[child.index()].vertices {
                if *vertex == apex {
                    *vertex = shared;
                }
            }
        }
        mesh.nodes.pop();
        mesh.triangle_at.pop();
    }
}

fn link(mesh: &mut Mesh, [(a, edge_of_a), (b, edge_of_b)]: [(TriangleId, u8); 2]) {
    mesh.triangles[a.index()].raw_neighbours[usize::from(edge_of_a)] = b.into();
    mesh.triangles[b.index()].raw_neighbours[usize::from(edge_of_b)] = a.into();
}
