//! The mesh of a problem: nodes and triangles in an order that follows from their places alone.

use glam::DVec2;
use rayon::prelude::*;

use super::plane_metric::PlaneMetric;
use crate::geometry::{LatticePoint, NumberMap, interleaved};
use crate::mesh::Extract;

/// No triangle or node.
pub(crate) const NONE: u32 = u32::MAX;

/// A mesh for finite elements.
///
/// Nodes are numbered along a space-filling curve through their places on the lattice, and triangles by their
/// nodes. So every sum over them has the same order whatever the order of the mesh's entries.
#[derive(Clone, Debug)]
pub struct FemMesh {
    /// Places of the nodes, in world units: N of them.
    pub(crate) points: Vec<DVec2>,
    /// Nodes of each triangle, anticlockwise, the one with the least number first.
    pub(crate) corners: Vec<[u32; 3]>,
    /// Triangles across the edges, the i-th opposite the i-th corner; [`NONE`] at the boundary.
    pub(crate) across: Vec<[u32; 3]>,
    /// Lengths of unit steps along x and y in each triangle; empty where they are 1.
    pub(crate) metric: Vec<[f64; 2]>,
    /// Places on the lattice when bisection made the nodes; `None` for nodes that something else added.
    pub(crate) homes: Vec<Option<LatticePoint>>,
    /// The edges of the boundary.
    pub(crate) edges: Vec<FemEdge>,
    /// The triangles at each node: `fans[fan_start[n]..fan_start[n + 1]]`, in ascending order.
    pub(crate) fan_start: Vec<u32>,
    pub(crate) fans: Vec<u32>,
    /// The number here of each node of the extract.
    number_of_node: Vec<u32>,
    /// The number in the extract of each triangle.
    triangle_in_extract: Vec<u32>,
}

/// An edge of the boundary, with the domain on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FemEdge {
    /// Its nodes.
    pub ends: [u32; 2],
    /// Its triangle.
    pub triangle: u32,
    /// The corner of the triangle that is not on it.
    pub opposite: usize,
    /// Its place among the boundary edges of the extract.
    pub number: usize,
    /// Its length: world units, or metres on the Earth.
    pub length: f64,
}

/// The place in [`FemMesh::edges`] of a boundary edge, by its triangle and the corner that is not on it.
pub(crate) type EdgeNumbers = NumberMap<(u32, u32), usize>;

impl FemMesh {
    /// Numbers the nodes and triangles of an extract. `homes` are the places where bisection made its nodes
    /// ([`Mesh::homes_with`](crate::mesh::Mesh::homes_with)).
    ///
    /// # Panics
    /// Panics when `homes` are not as many as the nodes.
    pub fn new(extract: &Extract, homes: &[Option<LatticePoint>], metric: &PlaneMetric) -> Self {
        assert_eq!(homes.len(), extract.nodes().len(), "one home for each node");
        let lattice = extract.lattice();
        let place = |node: usize| extract.nodes()[node];
        let mut order: Vec<u32> = (0..homes.len() as u32).collect();
        order.par_sort_unstable_by_key(|&node| {
            let at = place(node as usize);
            (interleaved(at.x, at.y), node)
        });
        let mut number_of_node = vec![0; order.len()];
        order.iter().enumerate().for_each(|(number, &node)| number_of_node[node as usize] = number as u32);
        let points = order.par_iter().map(|&node| lattice.world_from_lattice(place(node as usize))).collect();
        let (corners, across, triangle_in_extract) = triangles(extract, &number_of_node);
        let homes = order.iter().map(|&node| homes[node as usize]).collect();
        let mut mesh = Self {
            points,
            corners,
            across,
            metric: Vec::new(),
            homes,
            edges: Vec::new(),
            fan_start: Vec::new(),
            fans: Vec::new(),
            number_of_node,
            triangle_in_extract,
        };
        if !metric.is_world() {
            mesh.metric =
                (0..mesh.corners.len()).into_par_iter().map(|t| metric.at(mesh.middle(t))).collect();
        }
        mesh.find_edges(extract);
        mesh.find_fans();
        mesh
    }

    /// Returns where each boundary edge stands among [`Self::edges`].
    pub(crate) fn edge_numbers(&self) -> EdgeNumbers {
        let edges = self.edges.iter().enumerate();
        edges.map(|(n, edge)| ((edge.triangle, edge.opposite as u32), n)).collect()
    }

    /// Returns how many nodes there are.
    pub fn node_count(&self) -> usize {
        self.points.len()
    }

    /// Returns how many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.corners.len()
    }

    /// Returns values at the nodes in the order of the nodes of the extract.
    pub fn values_in_extract(&self, values: &[f64]) -> Vec<f64> {
        self.number_of_node.iter().map(|&number| values[number as usize]).collect()
    }

    /// Returns values of the triangles in the order of the triangles of the extract.
    pub fn triangles_in_extract(&self, values: &[f64]) -> Vec<f64> {
        let mut ordered = vec![0.0; values.len()];
        self.triangle_in_extract.iter().zip(values).for_each(|(&at, &value)| ordered[at as usize] = value);
        ordered
    }

    /// Returns the number in the extract of a triangle.
    pub(crate) fn triangle_in_extract(&self, triangle: usize) -> usize {
        self.triangle_in_extract[triangle] as usize
    }

    /// Returns the corners of a triangle, in world units.
    #[inline]
    pub(crate) fn triangle(&self, triangle: usize) -> [DVec2; 3] {
        self.corners[triangle].map(|node| self.points[node as usize])
    }

    /// Returns the middle of a triangle, in world units.
    pub(crate) fn middle(&self, triangle: usize) -> DVec2 {
        let [a, b, c] = self.triangle(triangle);
        (a + b + c) / 3.0
    }

    /// Returns the lengths of unit steps along x and y in a triangle.
    #[inline]
    pub(crate) fn metric_of(&self, triangle: usize) -> [f64; 2] {
        self.metric.get(triangle).copied().unwrap_or([1.0; 2])
    }

    /// Returns the triangles at a node, in ascending order.
    #[inline]
    pub(crate) fn fan(&self, node: usize) -> &[u32] {
        &self.fans[self.fan_start[node] as usize..self.fan_start[node + 1] as usize]
    }

    fn find_edges(&mut self, extract: &Extract) {
        let mut triangle_of = vec![0; self.corners.len()];
        for (number, &at) in self.triangle_in_extract.iter().enumerate() {
            triangle_of[at as usize] = number as u32;
        }
        let edge = |(number, edge): (usize, crate::mesh::BoundaryEdge)| {
            let ends = edge.ends.map(|node| self.number_of_node[node]);
            let triangle = triangle_of[edge.triangle];
            let corners = self.corners[triangle as usize];
            let opposite = (0..3).find(|&k| !ends.contains(&corners[k])).unwrap_or(0);
            let [gx, gy] = self.metric_of(triangle as usize);
            let step = self.points[ends[1] as usize] - self.points[ends[0] as usize];
            let length = DVec2::new(gx * step.x, gy * step.y).length();
            FemEdge { ends, triangle, opposite, number, length }
        };
        let mut edges: Vec<FemEdge> = extract.boundary_edges().enumerate().map(edge).collect();
        edges.sort_unstable_by_key(|edge| (edge.ends, edge.triangle));
        self.edges = edges;
    }

    fn find_fans(&mut self) {
        let mut start = vec![0_u32; self.points.len() + 1];
        for node in self.corners.iter().flatten() {
            start[*node as usize + 1] += 1;
        }
        for node in 1..start.len() {
            start[node] += start[node - 1];
        }
        let mut next = start.clone();
        let mut fans = vec![0; 3 * self.corners.len()];
        for (triangle, corners) in self.corners.iter().enumerate() {
            for node in corners {
                let place = &mut next[*node as usize];
                fans[*place as usize] = triangle as u32;
                *place += 1;
            }
        }
        (self.fan_start, self.fans) = (start, fans);
    }
}

/// Corners and neighbours of the triangles in their order, and the place of each in the extract.
type Triangles = (Vec<[u32; 3]>, Vec<[u32; 3]>, Vec<u32>);

fn triangles(extract: &Extract, number_of_node: &[u32]) -> Triangles {
    let turned = |triangle: u32| {
        let cell = extract.cell(crate::mesh::TriangleId::from_index(triangle as usize));
        let corners = cell.corners.map(|node| number_of_node[node]);
        let first = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
        let turn = |k: usize| (first + k) % 3;
        ([0, 1, 2].map(|k| corners[turn(k)]), [0, 1, 2].map(|k| cell.opposite[turn(k)]))
    };
    let count = extract.triangles().len();
    let all: Vec<([u32; 3], [Option<usize>; 3])> = (0..count as u32).into_par_iter().map(turned).collect();
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.par_sort_unstable_by_key(|&triangle| (all[triangle as usize].0, triangle));
    let mut number = vec![0; count];
    order.iter().enumerate().for_each(|(n, &triangle)| number[triangle as usize] = n as u32);
    let corners = order.par_iter().map(|&triangle| all[triangle as usize].0).collect();
    let across =
        |&triangle: &u32| all[triangle as usize].1.map(|across| across.map_or(NONE, |across| number[across]));
    let across = order.par_iter().map(across).collect();
    (corners, across, order)
}
