//! The cells of a mesh as a file has them: triangles, or quadrilaterals joined from two where that is asked
//! for.

use std::borrow::Cow;
use std::str::FromStr;
use std::sync::OnceLock;

use super::MeshData;
use super::format_spec::SquareCells;
use glam::DVec2;

use meshbrush_core::cells::{CellNodes, LinkFigures, MeshCell, MeshCells};
use meshbrush_mesh::mesh::{Extract, TriangleId};
use meshbrush_mesh::text::LengthUnit;

/// The cells of a file whose format can have quadrilaterals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CellShape {
    /// What the solver of the format wants: squares for Delft3D-FM (`.nc`) and MODFLOW (`.disv`), triangles
    /// for all others.
    #[default]
    OfFormat,
    /// The triangles of the mesh.
    Triangles,
    /// Pairs of triangles are joined where a solver could have no link between them.
    Squares,
}

/// The error for a word that names no cells.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("“{0}” is neither triangles nor squares.")]
pub struct UnknownCells(pub String);

impl FromStr for CellShape {
    type Err = UnknownCells;

    /// Reads `triangles` or `squares`.
    fn from_str(word: &str) -> Result<Self, UnknownCells> {
        match word {
            "triangles" => Ok(Self::Triangles),
            "squares" => Ok(Self::Squares),
            _ => Err(UnknownCells(word.into())),
        }
    }
}

/// The cells of a mesh with pairs of triangles joined, which are found when a file first has them. A mesh in
/// other coordinates has others.
#[derive(Clone, Debug, Default)]
pub struct JoinedCells(OnceLock<MeshCells>);

/// The cells of a file.
pub(super) struct WrittenCells<'a> {
    mesh: &'a Extract<'a>,
    /// None where all cells are triangles.
    joined: Option<&'a MeshCells>,
    /// The diagonal of the quadrilateral that each triangle belongs to, the smaller node first.
    diagonals: Vec<Option<[usize; 2]>>,
}

impl<'a> WrittenCells<'a> {
    /// Returns the cells of a mesh, whose nodes are in the coordinates of the file.
    pub(super) fn new(mesh: &'a Extract<'a>, data: &MeshData<'a>, squares: SquareCells) -> Self {
        let joins = match data.cells {
            CellShape::OfFormat => squares == SquareCells::Usual,
            CellShape::Triangles => false,
            CellShape::Squares => squares != SquareCells::Impossible,
        };
        if !joins {
            return Self { mesh, joined: None, diagonals: Vec::new() };
        }
        let cells = joined_cells(mesh, data);
        let mut diagonals = vec![None; mesh.triangles().len()];
        for cell in cells.list().iter().filter(|cell| cell.is_joined()) {
            cell.triangles.iter().for_each(|&triangle| diagonals[triangle] = Some(diagonal(mesh, cell)));
        }
        Self { mesh, joined: Some(cells), diagonals }
    }

    /// Returns the number of cells.
    pub(super) fn count(&self) -> usize {
        self.joined.map_or_else(|| self.mesh.triangles().len(), |cells| cells.list().len())
    }

    /// Returns how many of them have four corners.
    pub(super) fn joined_count(&self) -> usize {
        self.joined.map_or(0, MeshCells::joined_count)
    }

    /// Returns the most corners of a cell.
    pub(super) fn most_corners(&self) -> usize {
        if self.joined_count() > 0 { 4 } else { 3 }
    }

    /// Returns the corners of a cell, anticlockwise; the fourth is `None` for a triangle.
    pub(super) fn corners(&self, cell: usize) -> ([usize; 3], Option<usize>) {
        match self.joined {
            None => (self.mesh.cell(TriangleId::from_index(cell)).corners, None),
            Some(cells) => {
                let corners = cells.list()[cell].corners();
                ([corners[0], corners[1], corners[2]], corners.get(3).copied())
            }
        }
    }

    /// Returns the centre of each cell, [`MeshCells::centers`], and the values there of each of `fields`,
    /// which are given by node: [`MeshCells::at_centers`].
    pub(super) fn centers<const N: usize>(
        &self,
        unit: LengthUnit,
        fields: [&dyn Fn(usize) -> f64; N],
    ) -> (Vec<DVec2>, [Vec<f64>; N]) {
        let (nodes, triangles) = arrays(self.mesh);
        let nodes = CellNodes { nodes: &nodes, triangles: &triangles, unit };
        let cells = match self.joined {
            Some(cells) => Cow::Borrowed(cells),
            None => Cow::Owned(MeshCells::triangles(nodes)),
        };
        let centers = cells.centers(nodes);
        let values = fields.map(|field| cells.at_centers(nodes, &centers, field));
        (centers, values)
    }

    /// Returns the triangles of a cell; the same one twice where it is one.
    pub(super) fn triangles(&self, cell: usize) -> [usize; 2] {
        self.joined.map_or([cell; 2], |cells| cells.list()[cell].triangles)
    }

    /// Returns the level of a cell: the lower one of those of its triangles.
    pub(super) fn level(&self, cell: usize) -> u32 {
        let [a, b] = self.triangles(cell).map(|triangle| self.mesh.triangles()[triangle].level());
        a.min(b)
    }

    /// Returns whether an edge of a triangle is an edge of its cell, and not inside it.
    pub(super) fn has_edge(&self, triangle: usize, [from, to]: [usize; 2]) -> bool {
        let diagonal = self.diagonals.get(triangle).copied().flatten();
        diagonal != Some([from.min(to), from.max(to)])
    }
}

/// Returns the cells of a mesh with pairs of triangles joined, but for those with an edge along a line. Its
/// nodes are in the coordinates of a file.
pub fn joined_cells<'a>(mesh: &Extract, data: &MeshData<'a>) -> &'a MeshCells {
    data.joined.0.get_or_init(|| {
        let (nodes, triangles) = arrays(mesh);
        let unit = data.provenance.unit();
        let along_lines = data.lines.iter().flat_map(|line| line.edges.iter().map(|edge| edge.ends));
        MeshCells::joined_beside(CellNodes { nodes: &nodes, triangles: &triangles, unit }, along_lines)
    })
}

/// Returns how the links between these cells are.
pub fn joined_links(mesh: &Extract, data: &MeshData) -> LinkFigures {
    let (nodes, triangles) = arrays(mesh);
    let nodes = CellNodes { nodes: &nodes, triangles: &triangles, unit: data.provenance.unit() };
    joined_cells(mesh, data).link_figures(nodes)
}

fn arrays(mesh: &Extract) -> (Vec<DVec2>, Vec<[usize; 3]>) {
    (mesh.world_nodes().collect(), mesh.cells().map(|cell| cell.corners).collect())
}

/// Returns the common nodes of the two triangles of a cell, the smaller number first.
fn diagonal(mesh: &Extract, cell: &MeshCell) -> [usize; 2] {
    let [first, second] = cell.triangles.map(|triangle| mesh.cell(TriangleId::from_index(triangle)).corners);
    let mut common = first.into_iter().filter(|node| second.contains(node));
    let ends = [common.next().unwrap_or_default(), common.next().unwrap_or_default()];
    [ends[0].min(ends[1]), ends[0].max(ends[1])]
}
