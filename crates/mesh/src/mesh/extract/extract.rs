use std::borrow::Cow;

use glam::DVec2;

use super::MeshPatch;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::kernel::{Mesh, Neighbour, NodeId, Triangle, TriangleId};

/// The part of a mesh that is exported: the triangles of the domain and their nodes, numbered from zero
/// without gaps.
///
/// Its ids are indices into its own arrays. If the extract is the whole mesh, they are the ids of the mesh,
/// and nothing is copied.
#[derive(Clone, Debug)]
pub struct Extract<'a> {
    pub(super) lattice: Lattice,
    pub(super) nodes: Cow<'a, [LatticePoint]>,
    pub(super) triangles: Cow<'a, [Triangle]>,
    /// The index of each triangle of the mesh in the extract; `None` if no triangle was left out.
    pub(super) places: Option<Vec<Neighbour>>,
    pub(super) is_patched: bool,
    /// See [`Self::with_coordinates`].
    pub(super) coordinates: Option<Vec<DVec2>>,
}

/// A triangle in plain numbers, for writers of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Cell {
    /// Nodes, anticlockwise, the first two the ends of the bisection edge.
    pub corners: [usize; 3],
    /// Triangles across the edges, the i-th opposite the i-th corner; `None` at the boundary.
    pub opposite: [Option<usize>; 3],
    /// How many bisections made it.
    pub level: u32,
}

impl Cell {
    fn of(triangle: &Triangle) -> Self {
        let [bisection, second, third] = triangle.raw_neighbours.map(|n| n.triangle().map(TriangleId::index));
        Self {
            corners: triangle.edge_nodes().map(|(from, _)| from.index()),
            // The bisection edge joins the first two corners, so its neighbour is opposite the last.
            opposite: [second, third, bisection],
            level: triangle.level(),
        }
    }
}

/// An edge in plain numbers, for writers of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshEdge {
    /// Its nodes.
    pub ends: [usize; 2],
    /// Whether the domain ends there.
    pub on_boundary: bool,
}

/// An edge at which the domain ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BoundaryEdge {
    /// Its nodes, with the domain to the left.
    pub ends: [usize; 2],
    /// The triangle that it belongs to.
    pub triangle: usize,
    /// The level of the triangle.
    pub level: u32,
}

impl Mesh {
    /// Returns the part of the mesh that belongs to the domain, in the mesh's order, with the nodes that it
    /// uses.
    pub fn extract(&self) -> Extract<'_> {
        if self.outside_count() > 0 {
            return self.extract_with(&MeshPatch::default());
        }
        let (nodes, triangles) = (Cow::Borrowed(&self.nodes[..]), Cow::Borrowed(&self.triangles[..]));
        Extract {
            lattice: self.lattice,
            nodes,
            triangles,
            places: None,
            is_patched: false,
            coordinates: None,
        }
    }
}

impl Extract<'_> {
    /// Returns the grid and lattice that the mesh was refined from.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns all nodes in lattice coordinates.
    pub fn nodes(&self) -> &[LatticePoint] {
        &self.nodes
    }

    /// Returns all triangles.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Returns the extract with arrays of its own.
    pub fn into_owned(self) -> Extract<'static> {
        let (nodes, triangles) = (self.nodes.into_owned(), self.triangles.into_owned());
        Extract { nodes: Cow::Owned(nodes), triangles: Cow::Owned(triangles), ..self }
    }

    /// Returns the same nodes and triangles with other coordinates in files, as longitudes and latitudes: one
    /// point for each node, which [`Self::world`] then returns. Lattice coordinates stay.
    ///
    /// # Panics
    /// Panics when there are not as many points as nodes.
    pub fn with_coordinates(&self, coordinates: Vec<DVec2>) -> Extract<'_> {
        assert_eq!(coordinates.len(), self.nodes.len(), "one point for each node");
        let (nodes, triangles) = (Cow::Borrowed(&self.nodes[..]), Cow::Borrowed(&self.triangles[..]));
        let coordinates = Some(coordinates);
        Extract { nodes, triangles, places: self.places.clone(), coordinates, ..*self }
    }

    /// Returns the index in [`Self::triangles`] of a triangle of the mesh; `None` for a triangle outside the
    /// domain, or one that a [`MeshPatch`](super::MeshPatch) changed.
    ///
    /// # Panics
    /// Panics when the id is not of the mesh.
    pub fn place_of(&self, id: TriangleId) -> Option<TriangleId> {
        self.places.as_ref().map_or(Some(id), |places| places[id.index()].triangle())
    }

    /// Returns whether a [`MeshPatch`](super::MeshPatch) changed nodes and triangles.
    pub fn is_patched(&self) -> bool {
        self.is_patched
    }

    /// Returns the area of the triangles, in square world units, computed from the coordinates of the nodes.
    pub fn area(&self) -> f64 {
        let doubled = self.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.edge_nodes().map(|(from, _)| self.node(from).as_dvec2());
            (b - a).perp_dot(c - a)
        });
        0.5 * doubled.sum::<f64>() * self.lattice.step().x * self.lattice.step().y
    }

    /// Returns the area of the triangles by another measure of the area of one.
    pub fn area_by(&self, area: impl Fn([DVec2; 3]) -> f64) -> f64 {
        let corners = |triangle: &Triangle| triangle.edge_nodes().map(|(from, _)| self.world(from));
        self.triangles.iter().map(|triangle| area(corners(triangle))).sum()
    }

    /// Returns the lattice coordinates of a node.
    ///
    /// # Panics
    /// Panics when there is no such node.
    #[inline]
    pub fn node(&self, id: NodeId) -> LatticePoint {
        self.nodes[id.index()]
    }

    /// Returns the world coordinates of a node.
    ///
    /// # Panics
    /// Panics when there is no such node.
    #[inline]
    pub fn world(&self, id: NodeId) -> DVec2 {
        match &self.coordinates {
            Some(coordinates) => coordinates[id.index()],
            None => self.lattice.world_from_lattice(self.node(id)),
        }
    }

    /// Returns the coordinates of all nodes in world units.
    pub fn world_nodes(&self) -> impl ExactSizeIterator<Item = DVec2> + Clone + '_ {
        (0..self.nodes.len()).map(|node| self.world(NodeId::from_index(node)))
    }

    /// Counts the triangles at each level, from level 0 to the deepest.
    pub fn level_counts(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for triangle in self.triangles.iter() {
            let level = triangle.level() as usize;
            if level >= counts.len() {
                counts.resize(level + 1, 0);
            }
            counts[level] += 1;
        }
        counts
    }

    /// Returns all triangles in plain numbers, in the order of [`Self::triangles`].
    pub fn cells(&self) -> impl ExactSizeIterator<Item = Cell> + Clone + '_ {
        self.triangles.iter().map(Cell::of)
    }

    /// Returns a triangle of [`Self::triangles`] in plain numbers.
    ///
    /// # Panics
    /// Panics when there is no such triangle.
    pub fn cell(&self, id: TriangleId) -> Cell {
        Cell::of(&self.triangles[id.index()])
    }

    /// Returns every edge once, in the order of the triangles.
    pub fn edges(&self) -> impl Iterator<Item = MeshEdge> + Clone + '_ {
        (0..self.triangles.len()).flat_map(|index| self.first_edges_of(TriangleId::from_index(index)))
    }

    /// Returns the edges of a triangle that no triangle with a lower index has.
    ///
    /// # Panics
    /// Panics when there is no such triangle.
    pub fn first_edges_of(&self, id: TriangleId) -> impl Iterator<Item = MeshEdge> + Clone + '_ {
        let triangle = &self.triangles[id.index()];
        let edges = triangle.edge_nodes().into_iter().zip(triangle.raw_neighbours);
        let mine = edges.filter(move |(_, across)| across.triangle().is_none_or(|other| id < other));
        mine.map(|((from, to), across)| MeshEdge {
            ends: [from.index(), to.index()],
            on_boundary: across.triangle().is_none(),
        })
    }

    /// Returns all edges at which the domain ends, in the order of their triangles.
    pub fn boundary_edges(&self) -> impl Iterator<Item = BoundaryEdge> + Clone + '_ {
        self.triangles.iter().enumerate().flat_map(|(index, triangle)| {
            let edges = triangle.edge_nodes().into_iter().zip(triangle.raw_neighbours);
            edges.filter(|(_, across)| across.triangle().is_none()).map(move |((from, to), _)| BoundaryEdge {
                ends: [from.index(), to.index()],
                triangle: index,
                level: triangle.level(),
            })
        })
    }

    /// Returns the smallest and the largest angle of all triangles, in degrees; [180, 0] without triangles.
    pub fn angle_range(&self) -> [f64; 2] {
        self.extreme_angles().map(|(angle, _)| angle)
    }

    /// Returns the smallest and the largest angle of all triangles in degrees, each with its corner in world
    /// units; 180° and 0° without triangles.
    pub fn extreme_angles(&self) -> [(f64, DVec2); 2] {
        // By their cosines: one arc cosine for each end.
        let mut extremes = [(-1.0_f64, DVec2::ZERO), (1.0, DVec2::ZERO)];
        for cell in self.cells() {
            let corners = cell.corners.map(|node| self.world(NodeId::from_index(node)));
            for k in 0..3 {
                let (p, q) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
                let cosine = p.dot(q) / (p.length() * q.length());
                if cosine > extremes[0].0 {
                    extremes[0] = (cosine, corners[k]);
                }
                if cosine < extremes[1].0 {
                    extremes[1] = (cosine, corners[k]);
                }
            }
        }
        extremes.map(|(cosine, at)| (libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees(), at))
    }

    /// Returns for each node whether a boundary edge ends there.
    pub fn on_boundary(&self) -> Vec<bool> {
        let mut on_boundary = vec![false; self.nodes.len()];
        for node in self.boundary_edges().flat_map(|edge| edge.ends) {
            on_boundary[node] = true;
        }
        on_boundary
    }
}
