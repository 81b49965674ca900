//! A mesh as a file of a solver has it.

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::OnceLock;

use glam::DVec2;

use super::Solver;
use crate::io::boundary_strings::{BoundaryString, BoundaryStrings, LAND, StringKind};
use crate::io::{CellShape, MeshData, joined_cells};
use meshbrush_core::cells::{CellLink, CellNodes, MeshCells};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::LengthUnit;

/// A string of nodes along the boundary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenString {
    /// The names of its pieces.
    pub name: String,
    /// Whether it is open.
    pub is_open: bool,
    /// Its nodes as the file lists them.
    pub nodes: Vec<usize>,
}

/// Nodes, triangles and strings, as a solver reads them. Nothing is taken for granted: triangles may be
/// clockwise and nodes repeated.
#[derive(Clone, Debug, Default)]
pub struct WrittenMesh {
    /// The nodes, in the coordinates of the file.
    pub nodes: Vec<DVec2>,
    /// The nodes of each triangle.
    pub triangles: Vec<[usize; 3]>,
    /// The unit of coordinates.
    pub unit: LengthUnit,
    /// The depth at each node, positive downwards, if the file has depths.
    pub depths: Option<Vec<f64>>,
    /// The height of the surface at each node, if the file has one.
    pub heights: Option<Vec<f64>>,
    /// The strings of the boundary, if the boundary can be divided.
    pub strings: Vec<WrittenString>,
    /// For each node whether the file marks it as open.
    pub is_open: Vec<bool>,
    /// Open strings of which no edge would be left where nodes are marked: a node, and the name.
    pub lost_open: Vec<(usize, String)>,
    boundary: Vec<[usize; 2]>,
    on_boundary: Vec<bool>,
    /// The cells of the file; `None` where they are the triangles.
    joined: Option<MeshCells>,
    /// The links between the cells, once a rule needs them.
    links: OnceLock<Vec<CellLink>>,
}

impl WrittenMesh {
    /// Returns a mesh with this boundary, whose open nodes are those of its open strings.
    ///
    /// # Panics
    /// Panics when a triangle or string has a node that is not there.
    pub fn new(nodes: Vec<DVec2>, triangles: Vec<[usize; 3]>, strings: Vec<WrittenString>) -> Self {
        let mut mesh = Self { nodes, triangles, strings, ..Self::default() };
        mesh.is_open = vec![false; mesh.nodes.len()];
        for string in mesh.strings.iter().filter(|string| string.is_open) {
            string.nodes.iter().for_each(|&node| mesh.is_open[node] = true);
        }
        mesh.find_edges();
        mesh
    }

    /// Returns an extract, with its nodes in the coordinates of the file, as a file of a solver has it. A
    /// boundary that touches itself has no strings: see [`Self::has_strings`].
    pub fn of(extract: &Extract, data: &MeshData, solver: Solver) -> Self {
        let strings = BoundaryStrings::new(extract, data, solver.name(), solver.is_open()).ok();
        let strings = match strings {
            Some(strings) if solver.joins_open() => Some(strings.with_open_joined()),
            strings => strings,
        };
        let written = |string: &BoundaryString| WrittenString {
            name: string.name.clone(),
            is_open: string.kind == StringKind::Open,
            nodes: string.distinct().to_vec(),
        };
        let nodes = extract.world_nodes().collect();
        let triangles = extract.cells().map(|cell| cell.corners).collect();
        let all = strings.iter().flat_map(|strings| strings.all().map(written)).collect();
        let mut mesh = Self::new(nodes, triangles, all);
        mesh.depths = data.depths().map(<[f64]>::to_vec);
        mesh.heights = data.heights.map(<[f64]>::to_vec);
        mesh.unit = data.provenance.unit();
        let joins = match data.cells {
            CellShape::OfFormat => solver.wants_squares(),
            CellShape::Triangles => false,
            CellShape::Squares => true,
        };
        mesh.joined = joins.then(|| joined_cells(extract, data).clone());
        if let (Some(strings), Solver::Fvcom | Solver::Mike | Solver::Telemac) = (&strings, solver) {
            let codes = strings.marked_codes(extract);
            mesh.is_open = codes.iter().map(|&code| code > LAND).collect();
            let lost = strings.without_own_edge(&codes);
            mesh.lost_open = lost.into_iter().map(|string| (string.nodes[0], string.name.clone())).collect();
        }
        mesh
    }

    /// Returns whether the boundary is divided into strings; without them rules on the open boundary find
    /// nothing.
    pub fn has_strings(&self) -> bool {
        self.boundary.is_empty() || !self.strings.is_empty()
    }

    /// Returns the edges of one triangle, in its direction.
    pub(super) fn boundary(&self) -> &[[usize; 2]] {
        &self.boundary
    }

    /// Returns the nodes of each loop of the boundary, with the domain on the left. One that touches itself
    /// has none.
    pub(super) fn boundary_loops(&self) -> Vec<Vec<usize>> {
        let mut next = vec![None; self.nodes.len()];
        for &[from, to] in &self.boundary {
            if next[from].replace(to).is_some() {
                return Vec::new();
            }
        }
        let mut loops = Vec::new();
        for &[first, _] in &self.boundary {
            let mut nodes: Vec<usize> =
                std::iter::successors(Some(first), |&node| next[node].take()).collect();
            // The first node comes again at the end, where it has no next one any more.
            nodes.pop();
            if !nodes.is_empty() {
                loops.push(nodes);
            }
        }
        loops
    }

    /// Returns the triangles with an edge of the boundary at one of these nodes.
    pub(super) fn triangles_along(&self, nodes: &[usize]) -> Vec<usize> {
        let edges: HashSet<[usize; 2]> =
            self.boundary.iter().filter(|ends| ends.iter().any(|end| nodes.contains(end))).copied().collect();
        let has_one = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]].iter().any(|it| edges.contains(it));
        self.triangles.iter().enumerate().filter(|(_, corners)| has_one(corners)).map(|(it, _)| it).collect()
    }

    /// Returns which nodes are chosen, or share a triangle with a node that is.
    pub(super) fn beside(&self, chosen: &[bool]) -> Vec<bool> {
        let mut beside = chosen.to_vec();
        for corners in &self.triangles {
            if corners.iter().any(|&node| chosen[node]) {
                corners.iter().for_each(|&node| beside[node] = true);
            }
        }
        beside
    }

    /// Returns the cells of the file.
    pub(super) fn cells(&self) -> Cow<'_, MeshCells> {
        match &self.joined {
            Some(cells) => Cow::Borrowed(cells),
            None => Cow::Owned(MeshCells::triangles(self.cell_nodes())),
        }
    }

    /// Returns the links between these cells.
    pub(super) fn links(&self) -> &[CellLink] {
        self.links.get_or_init(|| self.cells().links(self.cell_nodes()))
    }

    /// Returns nodes and triangles, as cells are made of them.
    pub(super) fn cell_nodes(&self) -> CellNodes<'_> {
        CellNodes { nodes: &self.nodes, triangles: &self.triangles, unit: self.unit }
    }

    /// Joins pairs of triangles, as a file with squares has them.
    #[cfg(test)]
    pub(super) fn join_cells(&mut self) {
        self.joined = Some(MeshCells::joined(self.cell_nodes()));
        self.links = OnceLock::new();
    }

    /// Returns whether a node is on the boundary.
    pub(super) fn is_on_boundary(&self, node: usize) -> bool {
        self.on_boundary[node]
    }

    /// Returns the corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [DVec2; 3] {
        self.triangles[triangle].map(|node| self.nodes[node])
    }

    /// Returns the middle of a triangle.
    pub(super) fn middle(&self, triangle: usize) -> DVec2 {
        self.corners(triangle).iter().sum::<DVec2>() / 3.0
    }

    /// Returns how many triangles meet in each node.
    pub(super) fn triangles_at_nodes(&self) -> Vec<usize> {
        let mut counts = vec![0; self.nodes.len()];
        self.triangles.iter().flatten().for_each(|&node| counts[node] += 1);
        counts
    }

    /// Finds the edges of one triangle.
    fn find_edges(&mut self) {
        let sides = (0..).zip(&self.triangles).flat_map(|(triangle, &[a, b, c])| {
            [[a, b], [b, c], [c, a]]
                .map(|ends| ([ends[0].min(ends[1]), ends[0].max(ends[1])], triangle, ends))
        });
        let mut sides: Vec<([usize; 2], usize, [usize; 2])> = sides.collect();
        sides.sort_unstable();
        for group in sides.chunk_by(|a, b| a.0 == b.0) {
            if group.len() != 2 {
                self.boundary.extend(group.iter().map(|side| side.2));
            }
        }
        self.on_boundary = vec![false; self.nodes.len()];
        self.boundary.iter().flatten().for_each(|&node| self.on_boundary[node] = true);
    }
}
