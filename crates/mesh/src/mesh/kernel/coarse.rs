//! The coarse triangulation T₀: Algorithms 4 to 7, and 16 to 18 for domains other than a full grid.

use std::error::Error;
use std::fmt;

use glam::DVec2;

use super::{
    LevelAndSide, LevelAndSideCounts, Limits, Mesh, Neighbour, NodeId, Orientation, Triangle, TriangleId,
};
use crate::geometry::{GridError, Lattice, LatticePoint};
use crate::text::Number;

/// Why no coarse triangulation could be made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CoarseError {
    /// The grid itself is impossible or too fine.
    Grid(GridError),
    /// No coarse triangle has all three nodes in the domain.
    EmptyDomain {
        /// The side of a coarse cell, in world units.
        spacing: f64,
    },
}

impl fmt::Display for CoarseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grid(error) => error.fmt(f),
            Self::EmptyDomain { spacing } => write!(
                f,
                "No coarse triangle lies in the domain: with a coarse spacing of {} not one triangle has all three \
                 corners inside. Choose a smaller spacing.",
                Number(*spacing)
            ),
        }
    }
}

impl Error for CoarseError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Grid(error) => error.source(),
            Self::EmptyDomain { .. } => None,
        }
    }
}

impl From<GridError> for CoarseError {
    fn from(error: GridError) -> Self {
        Self::Grid(error)
    }
}

/// Which entry of the triangle array descends from which coarse triangle (ℳ_t of Algorithm 17).
///
/// Coarse triangles are numbered as in Figure 2 of the report, from zero: row by row from the lower left, in
/// each cell first the one below the diagonal.
#[derive(Clone, Debug, Default)]
pub(in crate::mesh) struct CoarseIndex {
    /// Id by coarse number, `Neighbour::BOUNDARY` where the coarse triangle is not in the domain; `None` when
    /// all are, and each number is its own id.
    ids: Option<Vec<Neighbour>>,
    /// How many coarse triangles are in the domain.
    kept: usize,
}

impl CoarseIndex {
    #[inline]
    pub(in crate::mesh) fn get(&self, number: usize) -> Option<TriangleId> {
        match &self.ids {
            None => Some(TriangleId::from_index(number)),
            Some(ids) => ids[number].triangle(),
        }
    }

    pub(in crate::mesh) fn kept(&self) -> usize {
        self.kept
    }
}

impl Mesh {
    /// Returns the coarse triangulation of a domain (Algorithm 7 without its padding, with Appendix A).
    ///
    /// The cells of `lattice` are the coarse cells. A coarse triangle is kept when `contains` is true at its
    /// three nodes, given in world coordinates. Nodes that no kept triangle uses are left out; the report
    /// keeps them.
    ///
    /// # Errors
    /// Fails when the grid has more triangles than `limits` allow, or when none of them lies in the domain.
    pub fn coarse_grid(
        lattice: &Lattice,
        contains: impl Fn(DVec2) -> bool,
        limits: &Limits,
    ) -> Result<Self, CoarseError> {
        let spacing = lattice.spacing();
        let (grid, limit) = (CoarseGrid::new(lattice), limits.most_triangles());
        if grid.triangle_count() > limit {
            let triangles = grid.triangle_count() as f64;
            return Err(GridError::TooManyCells { spacing, triangles, limit }.into());
        }
        let mesh = grid.triangulate(contains);
        if mesh.triangles.is_empty() { Err(CoarseError::EmptyDomain { spacing }) } else { Ok(mesh) }
    }

    /// Returns how many coarse triangles the mesh was refined from. Their entries are the first of the array.
    pub fn coarse_triangles(&self) -> usize {
        self.coarse.kept()
    }
}

/// The numbering of Figure 2: nodes and triangles row by row from the lower left.
struct CoarseGrid<'a> {
    lattice: &'a Lattice,
    columns: usize,
    rows: usize,
}

impl<'a> CoarseGrid<'a> {
    fn new(lattice: &'a Lattice) -> Self {
        let [columns, rows] = lattice.cells().map(|n| n as usize);
        Self { lattice, columns, rows }
    }

    fn triangulate(&self, contains: impl Fn(DVec2) -> bool) -> Mesh {
        let inside: Vec<bool> =
            (0..self.node_count()).map(|n| contains(self.lattice.world_from_lattice(self.node(n)))).collect();
        let (coarse, kept) = self.filter_triangles(&inside);
        let (nodes, id_of_node) = self.filter_nodes(&kept);
        let triangles: Vec<Triangle> = kept
            .iter()
            .map(|&number| {
                let vertices = self.vertices(number).map(|n| id_of_node[n]);
                let across = self.neighbours(number);
                let neighbours = across.map(|n| match n.and_then(|n| coarse.get(n)) {
                    Some(id) => id.into(),
                    None => Neighbour::BOUNDARY,
                });
                Triangle::new(vertices, neighbours, Orientation::Anticlockwise, LevelAndSide::inside(0))
            })
            .collect();
        let mut triangle_at = vec![TriangleId(0); nodes.len()];
        for (index, vertex) in triangles.iter().enumerate().flat_map(|(i, t)| t.vertices.map(|v| (i, v))) {
            triangle_at[vertex.index()] = TriangleId::from_index(index);
        }
        let counts = LevelAndSideCounts::coarse(triangles.len());
        Mesh { lattice: *self.lattice, nodes, triangles, triangle_at, counts, coarse }
    }

    /// Returns the index map ℳ_t, and the numbers of the coarse triangles that stay (Algorithm 17).
    fn filter_triangles(&self, inside: &[bool]) -> (CoarseIndex, Vec<usize>) {
        let kept: Vec<usize> = (0..self.triangle_count())
            .filter(|&number| self.vertices(number).iter().all(|&n| inside[n]))
            .collect();
        if kept.len() == self.triangle_count() {
            return (CoarseIndex { ids: None, kept: kept.len() }, kept);
        }
        let mut ids = vec![Neighbour::BOUNDARY; self.triangle_count()];
        for (id, &number) in kept.iter().enumerate() {
            ids[number] = TriangleId::from_index(id).into();
        }
        (CoarseIndex { ids: Some(ids), kept: kept.len() }, kept)
    }

    /// Returns the nodes that some kept triangle uses, and ℳ_x from grid number to id (Algorithm 16, without
    /// orphans).
    fn filter_nodes(&self, kept: &[usize]) -> (Vec<LatticePoint>, Vec<NodeId>) {
        let mut used = vec![false; self.node_count()];
        for &number in kept {
            for n in self.vertices(number) {
                used[n] = true;
            }
        }
        let mut nodes = Vec::new();
        let id_of_node = used
            .iter()
            .enumerate()
            .map(|(n, &used)| {
                let id = NodeId::from_index(nodes.len());
                if used {
                    nodes.push(self.node(n));
                }
                id
            })
            .collect();
        (nodes, id_of_node)
    }

    fn node_count(&self) -> usize {
        (self.columns + 1) * (self.rows + 1)
    }

    fn triangle_count(&self) -> usize {
        2 * self.columns * self.rows
    }

    /// Returns the lattice coordinates of a grid node (Algorithm 4).
    fn node(&self, number: usize) -> LatticePoint {
        let per_row = self.columns + 1;
        let steps = self.lattice.cell_steps();
        LatticePoint::new((number % per_row) as u32 * steps, (number / per_row) as u32 * steps)
    }

    /// Grid nodes of a coarse triangle, anticlockwise, the bisection edge from the first to the last
    /// (Algorithm 5).
    ///
    /// ```text
    ///   upper left o-----o upper right      below: (upper left, lower left, lower right)
    ///              | \   |                  above: (lower right, upper right, upper left)
    ///              |   \ |
    ///   lower left o-----o lower right
    /// ```
    fn vertices(&self, number: usize) -> [usize; 3] {
        let (column, row) = self.cell(number);
        let lower_left = row * (self.columns + 1) + column;
        let upper_left = lower_left + self.columns + 1;
        if number.is_multiple_of(2) {
            [upper_left, lower_left, lower_left + 1]
        } else {
            [lower_left + 1, upper_left + 1, upper_left]
        }
    }

    /// Returns coarse numbers across the three edges, the bisection edge first, anticlockwise (Algorithm 6).
    fn neighbours(&self, number: usize) -> [Option<usize>; 3] {
        let (column, row) = self.cell(number);
        let strip = 2 * self.columns;
        if number.is_multiple_of(2) {
            let left = (column > 0).then(|| number - 1);
            let below = (row > 0).then(|| number + 1 - strip);
            [Some(number + 1), left, below]
        } else {
            let right = (column + 1 < self.columns).then_some(number + 1);
            let above = (row + 1 < self.rows).then_some(number + strip - 1);
            [Some(number - 1), right, above]
        }
    }

    fn cell(&self, number: usize) -> (usize, usize) {
        (number / 2 % self.columns, number / 2 / self.columns)
    }
}
