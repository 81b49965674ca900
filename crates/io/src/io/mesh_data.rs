use std::io::{self, Write};

use super::{CellShape, JoinedCells, Provenance};
use meshbrush_core::domain::MeshBoundary;
use meshbrush_core::outline::LineEdges;

/// The data that is written with a mesh. The level of each triangle comes from the mesh.
///
/// In files a piece of the boundary has the marker 1 + its number.
#[derive(Clone, Copy, Debug)]
pub struct MeshData<'a> {
    /// h̄ at each node, in world units, in the order of the extract's nodes; only formats with
    /// [`MeshFormat::has_targets`](super::MeshFormat::has_targets) read it.
    pub target_diameter: &'a [f64],
    /// Further values at the nodes, in the same order.
    pub quantities: &'a [NodeValues],
    /// The height of each node above the plane, in the same order, for formats with a third coordinate.
    pub heights: Option<&'a [f64]>,
    /// The boundary in named pieces.
    pub boundary: &'a MeshBoundary,
    /// The edges along lines of the document, for formats with strings of nodes or named curves.
    pub lines: &'a [LineEdges],
    /// The number of each triangle's part, from 0 for the largest: [`Extract::part_numbers`].
    ///
    /// [`Extract::part_numbers`]: meshbrush_mesh::mesh::Extract::part_numbers
    pub parts: &'a [u32],
    /// The cells of formats that can have quadrilaterals, [`MeshFormat::holds_squares`].
    ///
    /// [`MeshFormat::holds_squares`]: super::MeshFormat::holds_squares
    pub cells: CellShape,
    /// These cells, which the first file that has them finds for the others.
    pub joined: &'a JoinedCells,
    /// The number of parts for a solver on several processors, for formats that have the part of each cell.
    pub parts_for: Option<u32>,
    /// The origin of the mesh, for all formats except `.csv`, whose readers take no comments.
    pub provenance: &'a Provenance,
}

/// A value at each node, and its name in files.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeValues {
    /// Letters, digits and underscores.
    pub name: String,
    /// One value for each node.
    pub values: Vec<f64>,
}

/// The name of the quantity that is the depth.
pub const DEPTH: &str = "depth";

/// The name of the values of surfaces at the nodes.
pub const SURFACE: &str = "surface";

impl MeshData<'_> {
    /// The depth at each node, positive downwards, for the formats of coastal solvers: the quantity with the
    /// name `depth`. Without it they have depth 0 everywhere; h̄ is a length of triangles and no depth.
    pub fn depths(&self) -> Option<&[f64]> {
        self.quantities.iter().find(|quantity| quantity.name == DEPTH).map(|depth| &*depth.values)
    }

    /// The quantities that are neither the depth nor the height of a surface, such as Manning's n.
    pub(super) fn attributes(&self) -> impl Iterator<Item = &NodeValues> {
        self.quantities.iter().filter(|quantity| quantity.name != DEPTH && quantity.name != SURFACE)
    }

    /// The third coordinate of a node: the height of the surface, 0 without one.
    pub(super) fn height(&self, node: usize) -> f64 {
        self.heights.map_or(0.0, |heights| heights[node])
    }

    /// The depth at a node, positive downwards; 0 without depths.
    pub(super) fn depth(&self, node: usize) -> f64 {
        self.depths().map_or(0.0, |depths| depths[node])
    }

    /// The height of the ground at a node, positive upwards; 0 without depths.
    pub(super) fn ground(&self, node: usize) -> f64 {
        0.0 - self.depth(node) // not -0 without depths
    }

    /// Writes the origin of the mesh in lines that a format takes for comments.
    pub(super) fn write_comments(&self, out: &mut impl Write) -> io::Result<()> {
        self.provenance.lines().try_for_each(|line| writeln!(out, "# {line}"))
    }

    /// h̄ and then the quantities, each with its name.
    pub(super) fn node_values(&self) -> impl Iterator<Item = (&str, &[f64])> + Clone {
        let further = self.quantities.iter().map(|q| (q.name.as_str(), q.values.as_slice()));
        std::iter::once(("target_diameter", self.target_diameter)).chain(further)
    }
}
