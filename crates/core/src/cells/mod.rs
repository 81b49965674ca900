//! Cells of a mesh: triangles, and quadrilaterals joined from two of them.
//!
//! A solver such as Delft3D-FM has its water levels at the circumcentres of cells, and lets water flow along
//! the *links* between the centres of neighbours. The two triangles of a square have one circumcentre: their
//! link has no length, the solver removes it, and no water crosses there. Joined, they are a square whose
//! links cross its edges at right angles. The mesh stays as it is: no node moves, and the boundary is the
//! same.
//!
//! ```text
//!   ┌───────┐      ┌───────┐
//!   │ ╲  ∘  │      │       │    ∘ the circumcentre of both triangles
//!   │   ∘   │  →   │   ∘   │    and of the square
//!   │  ∘ ╲  │      │       │
//!   └───────┘      └───────┘
//! ```

mod center;
mod edges;
mod join;
mod links;
#[cfg(test)]
mod tests;
mod values;

use glam::DVec2;

use crate::text::LengthUnit;
pub use links::{CellLink, LARGEST_COSINE, LEAST_SHARE, LinkFigures};

/// A cell of three or four corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshCell {
    corners: [usize; 4],
    count: usize,
    /// The triangles that it is made of; the same one twice where it is one.
    pub triangles: [usize; 2],
}

impl MeshCell {
    fn of_triangle(triangle: usize, [a, b, c]: [usize; 3]) -> Self {
        Self { corners: [a, b, c, c], count: 3, triangles: [triangle; 2] }
    }

    /// Returns the numbers of its nodes, anticlockwise: three or four.
    pub fn corners(&self) -> &[usize] {
        &self.corners[..self.count]
    }

    /// Returns its edges, each from a node to the next one.
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let corners = self.corners();
        (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])
    }

    /// Returns whether it was joined from two triangles.
    pub fn is_joined(&self) -> bool {
        self.count == 4
    }
}

/// The nodes and triangles of a mesh in the coordinates of a file.
#[derive(Clone, Copy, Debug)]
pub struct CellNodes<'a> {
    /// The nodes.
    pub nodes: &'a [DVec2],
    /// The nodes of each triangle, anticlockwise.
    pub triangles: &'a [[usize; 3]],
    /// The unit of the coordinates: with degrees lengths are those on the Earth.
    pub unit: LengthUnit,
}

/// A mesh as cells.
#[derive(Clone, Debug)]
pub struct MeshCells {
    cells: Vec<MeshCell>,
}

impl MeshCells {
    /// Returns the triangles as they are.
    pub fn triangles(mesh: CellNodes<'_>) -> Self {
        let cell = |(triangle, corners): (usize, &[usize; 3])| MeshCell::of_triangle(triangle, *corners);
        Self { cells: mesh.triangles.iter().enumerate().map(cell).collect() }
    }

    /// Joins pairs of triangles, so that no link is short and links cross edges at right angles, as far as
    /// that is possible without moving a node.
    ///
    /// First each pair whose link is short is joined where the quadrilateral is convex, the shortest first;
    /// then, at each link that is still short or far from a right angle, one more pair where that leaves
    /// less. The same mesh has the same cells on every machine.
    pub fn joined(mesh: CellNodes<'_>) -> Self {
        join::joined(mesh, std::iter::empty())
    }

    /// Joins pairs as [`Self::joined`] does, but never across an edge between the two nodes of one of `kept`:
    /// it stays an edge of the cells.
    pub fn joined_beside(mesh: CellNodes<'_>, kept: impl Iterator<Item = [usize; 2]>) -> Self {
        join::joined(mesh, kept)
    }

    /// Returns the cells, in the order of their first triangles.
    pub fn list(&self) -> &[MeshCell] {
        &self.cells
    }

    /// Returns how many cells were joined from two triangles.
    pub fn joined_count(&self) -> usize {
        self.cells.iter().filter(|cell| cell.is_joined()).count()
    }

    /// Returns the centre of each cell, in the coordinates of the nodes: the circumcentre of a triangle, and
    /// of a quadrilateral the place nearest to the perpendicular bisectors of its inner edges; both within
    /// the cell. A link joins two centres.
    pub fn centers(&self, mesh: CellNodes<'_>) -> Vec<DVec2> {
        links::centers_of(mesh, &self.cells)
    }

    /// Returns the value at the centre of each cell, [`Self::centers`], of what is `value` at the nodes and
    /// linear on each triangle.
    pub fn at_centers(
        &self,
        mesh: CellNodes<'_>,
        centers: &[DVec2],
        value: impl Fn(usize) -> f64,
    ) -> Vec<f64> {
        let cells = self.cells.iter().zip(centers);
        cells.map(|(cell, &center)| values::interpolate(mesh, cell, center, &value)).collect()
    }

    /// Returns the links between the cells, in ascending order of the nodes of their edges.
    pub fn links(&self, mesh: CellNodes<'_>) -> Vec<CellLink> {
        self.links_with_cells(mesh).0
    }

    /// Returns the links of [`Self::links`], and the numbers of the two cells of each.
    pub fn links_with_cells(&self, mesh: CellNodes<'_>) -> (Vec<CellLink>, Vec<[usize; 2]>) {
        let edges = links::edges_of(&self.cells);
        let sides = edges.iter().map(|edge| edge.cells).collect();
        (links::links_of(mesh, &self.cells, &edges), sides)
    }

    /// Measures the links between the cells.
    pub fn link_figures(&self, mesh: CellNodes<'_>) -> LinkFigures {
        links::figures(mesh, &self.cells)
    }
}
