//! The triangles of the mesh near the outline.

use rayon::prelude::*;

use super::numbers::Numbers;
use super::triangulation::{NONE, Triangulation};
use crate::domain::RegionOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, NodeId, TriangleId};

/// Number of rings of triangles, around those that the outline divides, that may change.
pub(super) const RINGS: usize = 4;
/// Fewest entries that a thread takes at a time.
pub(super) const GRAIN: usize = 512;

/// The triangles of a mesh near the outline of a region, inside and outside.
///
/// Nodes and triangles are numbered by their positions on the lattice, not by their entries in the mesh. So
/// everything that is derived from them depends on mesh and outline only, not on the order of edits.
pub(super) struct Band {
    pub(super) triangles: Triangulation,
    /// The entries of the triangles in the mesh.
    pub(super) ids: Vec<TriangleId>,
    /// The entries of the nodes in the mesh.
    pub(super) node_ids: Vec<NodeId>,
    /// The nodes, in ascending order.
    pub(super) points: Vec<LatticePoint>,
    /// For each node, whether it lies in the closed region.
    pub(super) inside: Vec<bool>,
    /// For each node, whether the outline crosses an edge there, between nodes inside and outside.
    pub(super) active: Vec<bool>,
    /// For each triangle, whether the outline touches it.
    pub(super) is_touched: Vec<bool>,
    /// Triangles beside the band that the outline touches without coming between their nodes, each with the
    /// side of its nodes.
    pub(super) touched: Vec<(TriangleId, bool)>,
}

/// The place of a triangle of the mesh that may differ in the derived mesh.
#[derive(Clone, Copy, Debug)]
pub(super) enum BandPlace {
    /// It has this number in the band.
    InBand(u32),
    /// The outline touches it beside the band, and its nodes are on this side.
    Beside { inside: bool },
}

/// Returns, for each node of a mesh, whether it lies in the closed region.
pub(super) fn signs(mesh: &Mesh, region: &RegionOnLattice) -> Vec<bool> {
    mesh.raw_nodes().par_iter().map(|&node| region.contains(node)).collect()
}

impl Band {
    /// Returns the band along the whole outline. Only triangles that the outline touches can have nodes
    /// inside and outside; the band grows from these.
    pub(super) fn new(mesh: &Mesh, region: &RegionOnLattice) -> Self {
        let all = mesh.raw_triangles().par_iter().enumerate().with_min_len(GRAIN);
        let touches = |(index, triangle): (usize, &crate::mesh::Triangle)| {
            let id = TriangleId::from_index(index);
            region.side_of(mesh.corners(id), triangle.level()).is_none().then_some(id)
        };
        let touched: Vec<TriangleId> = all.filter_map(touches).collect();
        Self::around::<Vec<u32>>(mesh, region, &touched).0
    }

    /// Returns the band around those of the `touched` triangles that have nodes inside and outside, with the
    /// numbers of nodes and triangles of the mesh there.
    pub(super) fn around<N: Numbers>(
        mesh: &Mesh,
        region: &RegionOnLattice,
        touched: &[TriangleId],
    ) -> (Self, [N; 2]) {
        let AtOutline { active, signs } = AtOutline::<N>::new(mesh, region, touched);
        let mut near = RingSearch::<N>::new(mesh);
        near.grow_from(mesh, &active, RINGS);
        let RingSearch { nodes, triangles: mut ids, is_triangle, .. } = near;
        let (points, node_ids) = sorted_by_points(mesh, &nodes);
        let mut numbers = N::for_entries(mesh.raw_nodes().len());
        node_ids.iter().zip(0..).for_each(|(id, number)| _ = numbers.set(id.index(), number));
        let number = |id: NodeId| numbers.get(id.index()).expect("it is in the band");
        let mut is_active = vec![false; node_ids.len()];
        active.iter().for_each(|&id| is_active[number(id) as usize] = true);
        let beside = touched.iter().filter(|id| is_triangle.get(id.index()).is_none());
        let is_inside = |id: NodeId| match signs.get(id.index()) {
            Some(sign) => sign == 1,
            None => region.contains(mesh.node(id)),
        };
        let beside = beside.map(|&id| (id, is_inside(mesh.triangle(id).vertices[0]))).collect();
        let inside = node_ids.par_iter().with_min_len(GRAIN).map(|&id| is_inside(id)).collect();
        let (triangles, triangle_numbers) = numbered::<N>(mesh, &mut ids, node_ids.len(), number);
        let mut is_touched = vec![false; ids.len()];
        let touched = touched.iter().filter_map(|id| triangle_numbers.get(id.index()));
        touched.for_each(|t| is_touched[t as usize] = true);
        let band =
            Self { inside, points, active: is_active, is_touched, touched: beside, triangles, ids, node_ids };
        (band, [numbers, triangle_numbers])
    }

    /// Returns the triangles of the mesh that may differ in the derived mesh, in no order.
    pub(super) fn triangles_by_id(&self) -> Vec<(TriangleId, BandPlace)> {
        let in_band = self.ids.iter().zip(0..).map(|(&id, t)| (id, BandPlace::InBand(t)));
        let beside = self.touched.iter().map(|&(id, inside)| (id, BandPlace::Beside { inside }));
        in_band.chain(beside).collect()
    }

    /// Returns nodes and those within `rings` rings of triangles around them.
    pub(super) fn near(&self, nodes: &[u32], rings: usize) -> Vec<u32> {
        let mut is_near = vec![false; self.points.len()];
        nodes.iter().for_each(|&v| is_near[v as usize] = true);
        let (mut near, mut star, mut start) = (nodes.to_vec(), Vec::new(), 0);
        for _ in 0..rings {
            let end = near.len();
            for n in start..end {
                self.triangles.star(near[n], &mut star);
                for w in star.iter().flat_map(|&(t, _)| self.triangles.corners[t as usize]) {
                    if !std::mem::replace(&mut is_near[w as usize], true) {
                        near.push(w);
                    }
                }
            }
            start = end;
        }
        near
    }

    /// Returns the marks of the corners of a triangle, beginning with the corner at position `i`.
    pub(super) fn starting_at<T: Copy>(&self, triangle: u32, i: usize, of: &[T]) -> [T; 3] {
        self.triangles.starting_at(triangle, i).map(|v| of[v as usize])
    }
}

/// The nodes of triangles that the outline touches.
struct AtOutline<N> {
    /// Those of triangles with nodes inside and outside.
    active: Vec<NodeId>,
    /// For each of them 1 if it lies in the closed region, otherwise 0.
    signs: N,
}

impl<N: Numbers> AtOutline<N> {
    fn new(mesh: &Mesh, region: &RegionOnLattice, touched: &[TriangleId]) -> Self {
        let mut signs = N::for_entries(mesh.raw_nodes().len());
        let mut nodes: Vec<NodeId> = touched.iter().flat_map(|&id| mesh.triangle(id).vertices).collect();
        nodes.retain(|id| signs.set(id.index(), 0));
        let is_inside = |&id: &NodeId| region.contains(mesh.node(id));
        let is_inside: Vec<bool> = nodes.par_iter().with_min_len(GRAIN).map(is_inside).collect();
        let inside = nodes.iter().zip(&is_inside).filter(|(_, is_inside)| **is_inside);
        inside.for_each(|(id, _)| _ = signs.set(id.index(), 1));
        let mut is_active = N::for_entries(mesh.raw_nodes().len());
        let mut active = Vec::new();
        for &id in touched {
            let corners = mesh.triangle(id).vertices;
            let [a, b, c] = corners.map(|v| signs.get(v.index()));
            if a != b || b != c {
                active.extend(corners.into_iter().filter(|v| is_active.set(v.index(), 0)));
            }
        }
        Self { active, signs }
    }
}

/// Triangles and nodes near others, found ring by ring.
struct RingSearch<N> {
    nodes: Vec<NodeId>,
    triangles: Vec<TriangleId>,
    is_node: N,
    is_triangle: N,
}

impl<N: Numbers> RingSearch<N> {
    fn new(mesh: &Mesh) -> Self {
        Self {
            nodes: Vec::new(),
            triangles: Vec::new(),
            is_node: N::for_entries(mesh.raw_nodes().len()),
            is_triangle: N::for_entries(mesh.raw_triangle_count()),
        }
    }

    /// Adds `rings` rings of triangles around nodes.
    fn grow_from(&mut self, mesh: &Mesh, nodes: &[NodeId], rings: usize) {
        nodes.iter().for_each(|&node| self.add_node(node));
        let mut first = 0;
        for _ in 0..rings {
            let last = self.nodes.len();
            for n in first..last {
                for id in mesh.all_triangles_around(self.nodes[n]) {
                    if self.is_triangle.set(id.index(), 0) {
                        self.triangles.push(id);
                        mesh.triangle(id).vertices.into_iter().for_each(|node| self.add_node(node));
                    }
                }
            }
            first = last;
        }
    }

    fn add_node(&mut self, node: NodeId) {
        if self.is_node.set(node.index(), 0) {
            self.nodes.push(node);
        }
    }
}

/// Returns the points of nodes in ascending order, and the nodes in the same order.
fn sorted_by_points(mesh: &Mesh, nodes: &[NodeId]) -> (Vec<LatticePoint>, Vec<NodeId>) {
    // With the points beside them: in the mesh they are far from each other.
    let mut sorted: Vec<(LatticePoint, NodeId)> = nodes.iter().map(|&id| (mesh.node(id), id)).collect();
    sorted.par_sort_unstable();
    sorted.into_iter().unzip()
}

/// Sorts the triangles by their corners, numbers corners and neighbours, and returns the numbers.
fn numbered<N: Numbers>(
    mesh: &Mesh,
    ids: &mut [TriangleId],
    nodes: usize,
    number_of_node: impl Fn(NodeId) -> u32 + Sync,
) -> (Triangulation, N) {
    // The corners, from the one with the lowest number on, and its place.
    let turned = |&id: &TriangleId| {
        let corners = mesh.triangle(id).edge_nodes().map(|(from, _)| number_of_node(from));
        let lowest = (0..3).min_by_key(|&i| corners[i]).expect("three corners");
        ([0, 1, 2].map(|i| corners[(lowest + i) % 3]), lowest as u32, id)
    };
    let mut entries: Vec<([u32; 3], u32, TriangleId)> =
        ids.par_iter().with_min_len(GRAIN).map(turned).collect();
    entries.par_sort_unstable_by_key(|(corners, ..)| *corners);
    let mut numbers = N::for_entries(mesh.raw_triangle_count());
    for ((number, place), (_, _, id)) in (0..).zip(ids.iter_mut()).zip(&entries) {
        numbers.set(id.index(), number);
        *place = *id;
    }
    let number = |id: TriangleId| numbers.get(id.index()).unwrap_or(NONE);
    let across = entries.par_iter().with_min_len(GRAIN).map(|&(_, lowest, id)| {
        // Edge j joins corner j to the next one.
        let [first, second, third] =
            mesh.triangle(id).raw_neighbours.map(|n| n.triangle().map_or(NONE, number));
        let across = [second, third, first];
        [0, 1, 2].map(|i| across[(lowest as usize + i) % 3])
    });
    let across = across.collect();
    let corners = entries.iter().map(|(corners, ..)| *corners).collect();
    (Triangulation::new(nodes, corners, across), numbers)
}
