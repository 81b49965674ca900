//! Which triangles are joined.

use std::cmp::Reverse;

use glam::DVec2;

use super::edges::InnerEdge;
use super::links::{CellLink, edge_between, edges_of, link, links_of, scale};
use super::{CellNodes, MeshCell, MeshCells};

/// Pairs whose link is shorter than this share of the size of their cells are joined: half as much again as
/// the solver's limit. Between 0.10 and 0.30 the limit does not matter.
const JOINED_BELOW: f64 = 0.15;
/// The least sine of the angle at a corner of a quadrilateral, as its share of a right angle's: flatter ones
/// are triangles with a node on an edge.
const LEAST_SINE: f64 = 0.05;
/// Rounds in which further pairs are joined. Each leaves less; three are enough on all coasts that were
/// tried.
const ROUNDS: usize = 6;

/// Returns the mesh as cells without short links, as far as that is possible with the `kept` edges in it.
pub(super) fn joined(mesh: CellNodes<'_>, kept: impl Iterator<Item = [usize; 2]>) -> MeshCells {
    let triangles = MeshCells::triangles(mesh).cells;
    let edges = edges_of(&triangles);
    let mut pairing = Pairing::new(mesh, &edges);
    for edge in kept.filter_map(|ends| edge_between(&edges, ends)) {
        pairing.is_kept[edge] = true;
    }
    pairing.join_short(&links_of(mesh, &triangles, &edges));
    for _ in 0..ROUNDS {
        if !pairing.join_at_bad_links() {
            break;
        }
    }
    MeshCells { cells: pairing.cells() }
}

/// Which triangles are joined so far.
struct Pairing<'a> {
    mesh: CellNodes<'a>,
    /// The edges between triangles, in ascending order.
    edges: &'a [InnerEdge],
    /// The edges of each triangle that have a triangle beyond them, by their numbers.
    edges_at: Vec<Vec<usize>>,
    /// The edge across which each triangle is joined.
    joined: Vec<Option<usize>>,
    /// Which edges stay in any case.
    is_kept: Vec<bool>,
}

impl<'a> Pairing<'a> {
    fn new(mesh: CellNodes<'a>, edges: &'a [InnerEdge]) -> Self {
        let mut edges_at = vec![Vec::new(); mesh.triangles.len()];
        for (number, edge) in edges.iter().enumerate() {
            edge.cells.iter().for_each(|&triangle| edges_at[triangle].push(number));
        }
        let (joined, is_kept) = (vec![None; mesh.triangles.len()], vec![false; edges.len()]);
        Self { mesh, edges, edges_at, joined, is_kept }
    }

    /// Joins pairs with a short link, the shortest first.
    fn join_short(&mut self, links: &[CellLink]) {
        let mut short: Vec<(f64, usize)> = links.iter().map(CellLink::share).zip(0..).collect();
        short.retain(|(share, _)| *share < JOINED_BELOW);
        short.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (_, edge) in short {
            if self.can_join(edge) {
                self.join(edge);
            }
        }
    }

    /// Joins one more pair beside each bad link where that leaves less. Returns whether any was joined.
    fn join_at_bad_links(&mut self) -> bool {
        let bad: Vec<[usize; 2]> = {
            let cells = self.cells();
            let edges = edges_of(&cells);
            let links = links_of(self.mesh, &cells, &edges);
            let mut bad: Vec<(&InnerEdge, &CellLink)> =
                edges.iter().zip(&links).filter(|(_, link)| link.is_bad()).collect();
            bad.sort_by_key(|(edge, link)| {
                (Reverse(link.is_short()), Reverse(link.cosine.to_bits()), edge.ends)
            });
            bad.into_iter().map(|(edge, _)| edge.ends).collect()
        };
        let mut has_joined = false;
        for ends in bad {
            has_joined |= self.join_beside(ends);
        }
        has_joined
    }

    /// Joins the pair beside an edge between triangles that leaves least, if it leaves less than there is.
    fn join_beside(&mut self, ends: [usize; 2]) -> bool {
        let Some(across) = edge_between(self.edges, ends) else { return false };
        let sides = self.edges[across].cells;
        let candidates = sides.iter().flat_map(|&triangle| self.edges_at[triangle].iter().copied());
        let mut candidates: Vec<usize> = candidates.filter(|&edge| self.can_join(edge)).collect();
        candidates.sort_unstable();
        candidates.dedup();
        // The bad links that it saves, the largest cosine that it leaves, and the edge.
        let mut best: Option<(usize, f64, usize)> = None;
        for edge in candidates {
            let around = self.edges[edge].cells;
            let touched = self.links_around(&[sides[0], sides[1], around[0], around[1]]);
            let (bad_before, _) = self.badness(&touched);
            self.join(edge);
            let (bad_after, cosine) = self.badness(&touched);
            self.separate(edge);
            let saved = bad_before.saturating_sub(bad_after);
            let is_better =
                best.is_none_or(|(most, least, _)| saved > most || (saved == most && cosine < least));
            if saved > 0 && is_better {
                best = Some((saved, cosine, edge));
            }
        }
        best.map(|(.., edge)| self.join(edge)).is_some()
    }

    /// Returns the edges of these triangles, and of those that they are joined with, in ascending order.
    fn links_around(&self, triangles: &[usize]) -> Vec<usize> {
        let partner = |&triangle: &usize| {
            let edge = self.joined[triangle].map(|edge| self.edges[edge].cells);
            edge.into_iter().flatten().chain([triangle])
        };
        let all = triangles.iter().flat_map(partner);
        let mut edges: Vec<usize> =
            all.flat_map(|triangle| self.edges_at[triangle].iter().copied()).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Returns how many of these links are bad, and the largest cosine of one.
    fn badness(&self, edges: &[usize]) -> (usize, f64) {
        let links = edges.iter().filter_map(|&edge| self.link(edge));
        links.fold((0, 0.0), |(bad, cosine), link| {
            let cosine = if link.is_short() { cosine } else { f64::max(cosine, link.cosine) };
            (bad + usize::from(link.is_bad()), cosine)
        })
    }

    /// Returns the link across an edge between two triangles; `None` inside a cell.
    fn link(&self, number: usize) -> Option<CellLink> {
        let InnerEdge { ends, cells } = self.edges[number];
        if self.joined[cells[0]] == Some(number) {
            return None;
        }
        let cells = cells.map(|triangle| self.cell(triangle));
        let is_inner = |ends| edge_between(self.edges, ends).is_some();
        Some(link(self.mesh, ends, [&cells[0], &cells[1]], is_inner))
    }

    fn join(&mut self, edge: usize) {
        self.edges[edge].cells.iter().for_each(|&triangle| self.joined[triangle] = Some(edge));
    }

    fn separate(&mut self, edge: usize) {
        self.edges[edge].cells.iter().for_each(|&triangle| self.joined[triangle] = None);
    }

    /// Returns whether an edge need not stay, and both its triangles are free and make a convex
    /// quadrilateral.
    fn can_join(&self, edge: usize) -> bool {
        let [first, second] = self.edges[edge].cells;
        let are_free = self.joined[first].is_none() && self.joined[second].is_none();
        !self.is_kept[edge] && are_free && self.is_convex(edge)
    }

    fn is_convex(&self, edge: usize) -> bool {
        let corners = self.quadrilateral(edge);
        let latitude = self.mesh.nodes[corners[0]].y;
        let scale = scale(self.mesh.unit, latitude);
        let at: Vec<DVec2> = corners.iter().map(|&node| scale * self.mesh.nodes[node]).collect();
        (0..4).all(|k| {
            let (before, after) = (at[(k + 1) % 4] - at[k], at[(k + 2) % 4] - at[(k + 1) % 4]);
            before.perp_dot(after) > LEAST_SINE * before.length() * after.length()
        })
    }

    /// Returns the corners of two triangles with a common edge, anticlockwise, from a corner of the first.
    fn quadrilateral(&self, edge: usize) -> [usize; 4] {
        let InnerEdge { ends, cells: [first, second] } = self.edges[edge];
        let corners = self.mesh.triangles[first];
        let is_end = |node: &usize| ends.contains(node);
        let apex = (0..3).find(|&k| !is_end(&corners[k])).unwrap_or(0);
        let beyond = self.mesh.triangles[second].into_iter().find(|node| !is_end(node));
        let [a, b, c] = [0, 1, 2].map(|k| corners[(apex + k) % 3]);
        [a, b, beyond.unwrap_or(c), c]
    }

    /// Returns the cell that a triangle belongs to.
    fn cell(&self, triangle: usize) -> MeshCell {
        match self.joined[triangle] {
            None => MeshCell::of_triangle(triangle, self.mesh.triangles[triangle]),
            Some(edge) => {
                MeshCell { corners: self.quadrilateral(edge), count: 4, triangles: self.edges[edge].cells }
            }
        }
    }

    /// Returns all cells, in the order of their first triangles.
    fn cells(&self) -> Vec<MeshCell> {
        let is_first = |&triangle: &usize| {
            self.joined[triangle].is_none_or(|edge| self.edges[edge].cells[0] == triangle)
        };
        (0..self.mesh.triangles.len()).filter(is_first).map(|triangle| self.cell(triangle)).collect()
    }
}
