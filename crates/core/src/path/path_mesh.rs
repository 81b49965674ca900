//! The triangles that paths go through, as plain arrays.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use glam::DVec2;

use super::area::PathArea;
use super::meshing::PathMeshing;
use crate::geometry::{BoxRuns, Rect, Side, side_of_points, z_order};
use crate::layers::Mask;
use crate::mesh::MeshView;

/// Marks a missing triangle.
pub(super) const NONE: u32 = u32::MAX;

/// Whether paths go through a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Passage {
    /// No path goes there.
    Closed,
    /// A part of it may be open: bounds from below count it, and the path that is shown stays outside.
    Partly,
    /// Paths go there.
    Open,
}

/// The triangles of a mesh for paths: nodes in world units, adjacency, and where paths may go.
///
/// Nodes and triangles are numbered along a curve, so that neighbours mostly lie together in memory.
#[derive(Clone, Debug, Default)]
pub struct PathMesh {
    pub(super) nodes: Vec<DVec2>,
    pub(super) triangles: Vec<PathTriangle>,
    /// The triangle across the edge from corner j to the next one; [`NONE`] where there is none.
    pub(super) across: Vec<[u32; 3]>,
    pub(super) has_obtuse: bool,
    /// Where paths may go.
    pub(super) area: PathArea,
    /// Whether the triangles cover the whole rectangle of the mesh, but for what the area leaves out: then no
    /// path through the domain leaves them.
    pub(super) covers_domain: bool,
    /// Both are made on first use: a mesh that is only bisected further needs neither.
    boxes: OnceLock<BoxRuns>,
    rows: OnceLock<NodeRows>,
}

/// The triangles around each node that are not closed, in the order of their numbers.
#[derive(Clone, Debug)]
struct NodeRows {
    /// The index in `triangles` of the first entry of each node's row.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl NodeRows {
    fn new(mesh: &PathMesh) -> Self {
        let mut starts = vec![0; mesh.nodes.len() + 1];
        let passable = || (0..).zip(&mesh.triangles).filter(|(_, triangle)| triangle.is_passable());
        for (_, triangle) in passable() {
            triangle.corners.iter().for_each(|&node| starts[node as usize + 1] += 1);
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; starts.last().map_or(0, |&end| end as usize)];
        for (number, triangle) in passable() {
            for &node in &triangle.corners {
                triangles[next[node as usize] as usize] = number;
                next[node as usize] += 1;
            }
        }
        Self { starts, triangles }
    }

    #[inline]
    fn of(&self, node: u32) -> &[u32] {
        let [start, end] = [node as usize, node as usize + 1].map(|n| self.starts[n] as usize);
        &self.triangles[start..end]
    }
}

/// A triangle for paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PathTriangle {
    /// Nodes, anticlockwise.
    pub corners: [u32; 3],
    pub passage: Passage,
    /// The corner with an obtuse angle; 3 without one.
    pub obtuse: u8,
    /// Whether it belongs to the mesh of the domain, and no point of it to the area of paths.
    pub is_kept_out: bool,
    /// How often it is still bisected along the rim of that area.
    pub divisions: u8,
}

impl PathTriangle {
    /// Returns the corner with the least number, by which triangles are sorted.
    pub fn least_node(&self) -> u32 {
        let [a, b, c] = self.corners;
        a.min(b).min(c)
    }

    pub fn is_passable(&self) -> bool {
        self.passage > Passage::Closed
    }
}

impl PathMesh {
    /// All triangles of the domain are open.
    pub fn new(view: MeshView) -> Self {
        Self::in_area(view, &PathArea::default())
    }

    /// Keep-out regions close the triangles within and leave out those that they touch.
    pub fn with_keep_out(view: MeshView, keep_out: &[Mask]) -> Self {
        Self::in_area(view, &PathArea::outside_of(keep_out))
    }

    /// The triangles outside an area are closed, and those through which its rim passes are left out. Along
    /// the outline of a domain, and with a clearance, these are bisected first.
    pub fn in_area(view: MeshView, area: &PathArea) -> Self {
        let mut meshing = PathMeshing::new(view, area);
        loop {
            if let Some(mesh) = meshing.advance(usize::MAX) {
                return mesh;
            }
        }
    }

    /// Returns the area of paths.
    pub fn area(&self) -> &PathArea {
        &self.area
    }

    /// `passage` says for each triangle, by its corners and whether it is marked as outside the domain,
    /// whether paths go there.
    pub fn with_passages(view: MeshView, passage: impl Fn(&[DVec2; 3], bool) -> Passage) -> Self {
        let lattice = view.lattice();
        let nodes: Vec<DVec2> = view.nodes().iter().map(|&node| lattice.world_from_lattice(node)).collect();
        let mut mesh = Self { nodes, ..Self::default() };
        let mut covered = 0;
        for triangle in view.triangles() {
            let corners = triangle.edge_nodes().map(|(from, _)| from.index() as u32);
            let places = corners.map(|node| mesh.nodes[node as usize]);
            let across = triangle.raw_neighbours.map(|n| n.triangle().map_or(NONE, |t| t.index() as u32));
            let (passage, obtuse) = (passage(&places, triangle.is_outside()), obtuse_corner(&places));
            mesh.has_obtuse |= obtuse < 3 && passage > Passage::Closed;
            covered += if triangle.is_outside() { 0 } else { twice_area(&view, corners) };
            let is_kept_out = passage == Passage::Closed && !triangle.is_outside();
            mesh.triangles.push(PathTriangle { corners, passage, obtuse, is_kept_out, divisions: 0 });
            mesh.across.push(across);
        }
        let extent = lattice.extent();
        mesh.covers_domain = covered == 2 * i128::from(extent.x) * i128::from(extent.y);
        mesh.sort_along_curve();
        mesh
    }

    /// Returns a copy with room for `more` further triangles, and nothing derived from them yet.
    pub(super) fn with_room(&self, more: usize) -> Self {
        let (nodes, triangles) = (with_room(&self.nodes, more), with_room(&self.triangles, more));
        self.with_triangles(nodes, triangles, with_room(&self.across, more))
    }

    /// Returns a mesh of other triangles that cover as much.
    pub(super) fn with_triangles(
        &self,
        nodes: Vec<DVec2>,
        triangles: Vec<PathTriangle>,
        across: Vec<[u32; 3]>,
    ) -> Self {
        let Self { has_obtuse, covers_domain, .. } = *self;
        let area = self.area.clone();
        Self { nodes, triangles, across, has_obtuse, area, covers_domain, ..Self::default() }
    }

    /// Returns whether nodes and triangles are those of another mesh with the same keep-out regions.
    pub(super) fn is_same_as(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
            || (self.nodes == other.nodes
                && self.triangles.len() == other.triangles.len()
                && self.triangles.iter().zip(&other.triangles).all(|(a, b)| a.corners == b.corners))
    }

    /// Numbers the nodes along a Z-order curve, and the triangles by their first nodes: so nodes that two
    /// meshes of one rectangle share are in the same order in both. Returns the former numbers of the
    /// triangles in their new order.
    pub(super) fn sort_along_curve(&mut self) -> Vec<u32> {
        let Some(bounds) = self.extent() else { return Vec::new() };
        let keys: Vec<u32> = self.nodes.iter().map(|&p| z_order(p, &bounds)).collect();
        let mut node_order = sorted_by(&keys);
        // Nodes at one place of the curve, by their coordinates.
        let place = |&node: &u32| order_on_curve(self.nodes[node as usize], &bounds);
        for near in node_order.chunk_by_mut(|&a, &b| keys[a as usize] == keys[b as usize]) {
            near.sort_unstable_by_key(place);
        }
        let new_nodes = inverse(&node_order);
        self.nodes = node_order.iter().map(|&old| self.nodes[old as usize]).collect();
        for triangle in &mut self.triangles {
            triangle.corners = triangle.corners.map(|node| new_nodes[node as usize]);
        }
        let keys: Vec<u32> = self.triangles.iter().map(PathTriangle::least_node).collect();
        let order = sorted_by(&keys);
        let new_triangles = inverse(&order);
        let renumbered = |t: u32| if t == NONE { NONE } else { new_triangles[t as usize] };
        self.across = order.iter().map(|&old| self.across[old as usize].map(renumbered)).collect();
        self.triangles = order.iter().map(|&old| self.triangles[old as usize]).collect();
        self.clear_indices();
        order
    }

    /// Returns the rectangle around all nodes.
    pub(super) fn extent(&self) -> Option<Rect> {
        Rect::holding(self.nodes.iter().copied())
    }

    /// Forgets what was derived from the triangles, after they changed.
    pub(super) fn clear_indices(&mut self) {
        (self.boxes, self.rows) = Default::default();
    }

    /// Returns the number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the triangles around a node that are not closed.
    #[inline]
    pub(super) fn around(&self, node: u32) -> &[u32] {
        self.rows.get_or_init(|| NodeRows::new(self)).of(node)
    }

    /// Returns the corners of a triangle in world units.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [DVec2; 3] {
        self.triangles[triangle as usize].corners.map(|node| self.nodes[node as usize])
    }

    /// Returns whether paths go through a triangle.
    pub fn passage(&self, triangle: u32) -> Passage {
        self.triangles[triangle as usize].passage
    }

    /// Returns the rectangle around a triangle.
    pub(super) fn rectangle(&self, triangle: u32) -> Rect {
        let [a, b, c] = self.corners(triangle);
        Rect::new(a.min(b).min(c), a.max(b).max(c))
    }

    /// Returns the rectangle around all triangles that are not closed.
    pub fn bounds(&self) -> Option<Rect> {
        let passable = (0..).zip(&self.triangles).filter(|(_, triangle)| triangle.is_passable());
        passable.map(|(number, _)| self.rectangle(number)).reduce(|a, b| a.union(&b))
    }

    /// Returns the longest side of a triangle.
    pub(super) fn diameter(&self, triangle: u32) -> f64 {
        let [a, b, c] = self.corners(triangle);
        a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt()
    }

    /// Returns the triangles whose rectangles meet one of the given ones, in the order of their numbers.
    pub(super) fn meeting(&self, areas: &[Rect]) -> Vec<u32> {
        let mut found = Vec::new();
        let rectangle = |triangle| self.rectangle(triangle);
        for area in areas {
            let _ = self.boxes().visit_meeting(area, rectangle, |triangle| {
                found.push(triangle);
                ControlFlow::Continue(())
            });
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Returns the triangles that may contain a point, but for rounding.
    fn around_point(&self, point: DVec2) -> Vec<u32> {
        let size = self.boxes().bounds().map_or(0.0, |all| all.size().max_element());
        self.meeting(&[Rect::new(point, point).expanded(1e-12 * size)])
    }

    /// Returns an index of the triangles' rectangles, made when it is first needed.
    fn boxes(&self) -> &BoxRuns {
        self.boxes.get_or_init(|| BoxRuns::new(self.triangles.len(), |triangle| self.rectangle(triangle)))
    }

    /// Returns whether a point lies in a triangle of the domain that the area of paths closes.
    pub(super) fn is_kept_out(&self, point: DVec2) -> bool {
        let holds = |&t: &u32| self.triangles[t as usize].is_kept_out && contains(&self.corners(t), point);
        self.around_point(point).iter().any(holds)
    }

    /// Returns the point, or one as near as rounding allows that a closed triangle contains, where rounding
    /// put the point outside.
    pub(super) fn moved_into(&self, triangle: u32, point: DVec2) -> DVec2 {
        let corners = self.corners(triangle);
        let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
        let shares = std::iter::successors(Some(f64::EPSILON), |share| Some(2.0 * share));
        let moved = shares.take_while(|&share| share < 1.0).map(|share| point + share * (centroid - point));
        std::iter::once(point).chain(moved).find(|&point| holds(&corners, point)).unwrap_or(corners[0])
    }

    /// Returns an open triangle that contains a point: exactly if there is one, else but for rounding.
    pub(super) fn open_triangle_at(&self, point: DVec2) -> Option<u32> {
        let found = self.around_point(point);
        let mut open = found.iter().copied().filter(|&t| self.passage(t) == Passage::Open);
        open.find(|&t| holds(&self.corners(t), point)).or_else(|| self.locate(point, Passage::Open))
    }

    /// Returns the open triangles that contain a point, but for rounding, in the order of their numbers.
    pub(super) fn open_triangles_at(&self, point: DVec2) -> Vec<u32> {
        let mut found = self.around_point(point);
        found.retain(|&t| self.passage(t) == Passage::Open && contains(&self.corners(t), point));
        found
    }

    /// Returns the triangle with the lowest number that contains a point and has at least this passage.
    pub fn locate(&self, point: DVec2, least: Passage) -> Option<u32> {
        let contains = |&number: &u32| {
            self.triangles[number as usize].passage >= least && contains(&self.corners(number), point)
        };
        self.around_point(point).into_iter().find(contains)
    }
}

/// Returns a copy of values with room for `more` further ones.
fn with_room<T: Copy>(values: &[T], more: usize) -> Vec<T> {
    let mut copy = Vec::with_capacity(values.len() + more);
    copy.extend_from_slice(values);
    copy
}

/// Returns twice the area of a triangle, in square lattice steps.
fn twice_area(view: &MeshView, corners: [u32; 3]) -> i128 {
    let [a, b, c] = corners.map(|node| view.nodes()[node as usize]);
    let way = |from: u32, to: u32| i128::from(to) - i128::from(from);
    way(a.x, b.x) * way(a.y, c.y) - way(a.y, b.y) * way(a.x, c.x)
}

/// Returns the order of numbers by their keys.
fn sorted_by(keys: &[u32]) -> Vec<u32> {
    let mut sorted: Vec<u64> = (0..).zip(keys).map(|(n, &key): (u64, _)| u64::from(key) << 32 | n).collect();
    sorted.sort_unstable();
    sorted.into_iter().map(|entry| entry as u32).collect()
}

/// Returns the place of each number in an order.
fn inverse(order: &[u32]) -> Vec<u32> {
    let mut places = vec![0; order.len()];
    (0..).zip(order).for_each(|(place, &n)| places[n as usize] = place);
    places
}

/// Returns the key by which nodes are numbered in a mesh with this rectangle around its nodes.
pub(super) fn order_on_curve(node: DVec2, extent: &Rect) -> (u32, u64, u64) {
    (z_order(node, extent), node.y.to_bits(), node.x.to_bits())
}

/// Returns the corner with an angle above 90°, beyond rounding; 3 without one.
pub(super) fn obtuse_corner(corners: &[DVec2; 3]) -> u8 {
    let is_obtuse = |&k: &usize| {
        let (p, q) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
        p.dot(q) < -1e-9 * p.length() * q.length()
    };
    (0..3).find(is_obtuse).unwrap_or(3) as u8
}

/// Returns whether a closed triangle, anticlockwise, contains a point.
pub(super) fn holds(&[a, b, c]: &[DVec2; 3], point: DVec2) -> bool {
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| side_of_points(from, to, point) != Side::Right)
}

/// Returns whether a closed triangle, anticlockwise, contains a point, but for rounding.
pub(super) fn contains(corners: &[DVec2; 3], point: DVec2) -> bool {
    let [a, b, c] = *corners;
    let margin = -1e-12 * (b - a).perp_dot(c - a);
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| (to - from).perp_dot(point - from) >= margin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Lattice;
    use crate::mesh::{Limits, Mesh};

    /// A planner keeps its marches on the same mesh only.
    #[test]
    fn a_mesh_is_the_same_as_its_copy_and_as_no_other() {
        let mesh = |bounds: Rect, spacing: f64| {
            let lattice = Lattice::covering(bounds, spacing, 10_000).unwrap();
            PathMesh::new(Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap().view())
        };
        let [one, copy] = [(); 2].map(|()| mesh(Rect::UNIT, 0.25));
        assert!(one.is_same_as(&one) && one.is_same_as(&copy));
        let elsewhere = mesh(Rect::new(DVec2::splat(1.0), DVec2::splat(2.0)), 0.25);
        assert_eq!(one.triangle_count(), elsewhere.triangle_count());
        let mut turned = copy.clone();
        turned.triangles[3].corners.rotate_left(1);
        for other in [&elsewhere, &mesh(Rect::UNIT, 0.125), &turned] {
            assert!(!one.is_same_as(other) && !other.is_same_as(&one));
        }
    }
}
