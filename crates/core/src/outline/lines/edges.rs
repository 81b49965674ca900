//! The edges along lines, as files number them.

use super::LineFit;
use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::Extract;

/// An edge of a mesh along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineEdge {
    /// The numbers of its nodes, along the line.
    pub ends: [usize; 2],
    /// The number of a triangle with this edge.
    pub triangle: usize,
}

/// The edges of a mesh along a line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LineEdges {
    /// The name of the line.
    pub name: String,
    /// Its edges, along the line.
    pub edges: Vec<LineEdge>,
}

impl LineEdges {
    /// Returns the edges along each line that has some in a mesh, in the order of the lines. Takes time in
    /// proportion to the mesh.
    pub fn all(fits: &[LineFit], mesh: &Extract) -> Vec<Self> {
        let sorted = |[a, b]: [LatticePoint; 2]| [a.min(b), a.max(b)];
        let wanted = fits.iter().flat_map(|fit| &fit.edges).map(|&ends| (sorted(ends), None));
        let mut found: NumberMap<[LatticePoint; 2], Option<LineEdge>> = wanted.collect();
        if found.is_empty() {
            return Vec::new();
        }
        for (triangle, cell) in mesh.cells().enumerate() {
            let [a, b, c] = cell.corners;
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let ends = if mesh.nodes()[from] < mesh.nodes()[to] { [from, to] } else { [to, from] };
                let edge = found.get_mut(&ends.map(|node| mesh.nodes()[node]));
                if let Some(edge @ None) = edge {
                    *edge = Some(LineEdge { ends, triangle });
                }
            }
        }
        let along = |ends: &[LatticePoint; 2]| {
            let edge = found[&sorted(*ends)]?;
            let [low, high] = edge.ends;
            Some(LineEdge { ends: if ends[0] < ends[1] { [low, high] } else { [high, low] }, ..edge })
        };
        let of_line = |fit: &LineFit| Self {
            name: fit.name.clone(),
            edges: fit.edges.iter().filter_map(along).collect(),
        };
        fits.iter().map(of_line).filter(|line| !line.edges.is_empty()).collect()
    }

    /// Returns the nodes of each part of the line that is on edges without a gap.
    pub fn runs(&self) -> Vec<Vec<usize>> {
        let runs = self.edges.chunk_by(|a, b| a.ends[1] == b.ends[0]);
        let nodes = |run: &[LineEdge]| {
            let first = run.first().map(|edge| edge.ends[0]);
            first.into_iter().chain(run.iter().map(|edge| edge.ends[1])).collect()
        };
        runs.map(nodes).collect()
    }
}
