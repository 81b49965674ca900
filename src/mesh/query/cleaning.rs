//! Removes parts and pinches: what a solver cannot use.
//!
//! A *pinch* is a node where triangles of the domain meet only in that node. It makes the boundary touch
//! itself, and encloses "holes" that are open to the outside.
//!
//! ```text
//!   o-------o                       o-------o        around m, the triangles form two fans; the smaller
//!   | \     | \                     | \     |        fan is marked as outside
//!   |   \   |   \                   |   \   |
//!   o-----m-------o      =>         o-----m
//!         |   \   |
//!         o-------o
//! ```
//!
//! Removed triangles are only marked, as all triangles outside the domain are. Which triangles are removed
//! follows from the places of the triangles, and not from their numbers: two meshes with the same triangles
//! lose the same ones.

use std::cmp::Ordering::Equal;
use std::cmp::Reverse;
use std::collections::HashMap;

use glam::DVec2;

use super::survey::Forest;
use crate::mesh::kernel::{Mesh, NodeId, TriangleId};

/// Which triangles of a domain a mesh keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cleaning {
    /// The parts that stay. A part is joined by edges.
    pub parts: KeptParts,
    /// Whether nodes stay in which triangles meet without sharing an edge.
    pub keeps_pinches: bool,
}

/// Which parts of a mesh stay.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum KeptParts {
    /// All.
    All,
    /// The one with the largest area.
    Largest,
    /// Those with at least this share of the area of the mesh, 0 to 1.
    Share(f64),
}

impl Cleaning {
    /// Nothing is removed.
    pub const NONE: Self = Self { parts: KeptParts::All, keeps_pinches: true };
    /// One part without pinches, as solvers need it.
    pub const FOR_SOLVERS: Self = Self { parts: KeptParts::Largest, keeps_pinches: false };
}

/// What [`Mesh::clean`] removed.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Removed {
    /// The parts, the largest first.
    pub parts: Vec<RemovedPart>,
    /// Nodes that were pinches.
    pub pinches: usize,
    /// Triangles, of parts and at pinches.
    pub triangles: usize,
    /// Their area, in square world units.
    pub area: f64,
}

/// A part that was removed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RemovedPart {
    /// The centroid of one of its triangles, in world units.
    pub place: DVec2,
    /// Its triangles.
    pub triangles: usize,
    /// Its area, in square world units.
    pub area: f64,
}

impl Mesh {
    /// Removes parts and pinches: marks their triangles as outside the domain.
    ///
    /// To remove a pinch can separate a part, and the other way round, so both are repeated until nothing
    /// changes. Time and memory grow with the mesh.
    pub fn clean(&mut self, cleaning: &Cleaning) -> Removed {
        let (count, area) = (self.triangle_count(), self.area());
        let mut removed = Removed::default();
        let whole = (0..self.triangles.len()).map(|index| self.units_of(index)).sum();
        // Ends: each round but the last removes a triangle.
        loop {
            let parts = Parts::of(self);
            let small = parts.removed_by(cleaning.parts, whole);
            if !small.is_empty() {
                removed.parts.extend(small.iter().map(|&part| parts.describe(self, part)));
                let is_small = |index: &usize| small.binary_search(&parts.roots[*index]).is_ok();
                for id in (0..self.triangles.len()).filter(is_small).map(TriangleId::from_index) {
                    self.set_outside(id);
                }
                continue;
            }
            let pinched = if cleaning.keeps_pinches { Vec::new() } else { self.pinches() };
            if pinched.is_empty() {
                break;
            }
            removed.pinches += pinched.len();
            let around = self.triangles_by_node(&pinched);
            let fans: Vec<TriangleId> =
                around.iter().flat_map(|(&node, around)| self.smaller_fans(node, around, &parts)).collect();
            fans.into_iter().for_each(|id| self.set_outside(id));
        }
        let place = |part: &RemovedPart| [part.place.y, part.place.x];
        removed
            .parts
            .sort_by(|a, b| b.area.total_cmp(&a.area).then(place(a).partial_cmp(&place(b)).unwrap_or(Equal)));
        removed.triangles = count - self.triangle_count();
        removed.area = area - self.area();
        removed
    }

    /// The nodes of the domain in which triangles meet without sharing an edge, in their order.
    pub fn pinches(&self) -> Vec<NodeId> {
        // A node on the boundary has two edges there, or four and more.
        let mut boundary_edges = vec![0u8; self.nodes.len()];
        for index in 0..self.triangles.len() {
            let id = TriangleId::from_index(index);
            if !self.is_in_domain(id) {
                continue;
            }
            let sides = self.triangle(id).edge_nodes().into_iter().zip(self.neighbours(id));
            for ((from, to), _) in sides.filter(|(_, across)| across.triangle().is_none()) {
                boundary_edges[from.index()] += 1;
                boundary_edges[to.index()] += 1;
            }
        }
        let pinched = boundary_edges.iter().enumerate().filter(|&(_, &edges)| edges > 2);
        pinched.map(|(node, _)| NodeId::from_index(node)).collect()
    }

    /// The triangles of the domain at each of a few nodes. [`Mesh::triangles_around`] would not find them all
    /// where the coarse grid itself is pinched.
    fn triangles_by_node(&self, nodes: &[NodeId]) -> HashMap<NodeId, Vec<TriangleId>> {
        let mut around: HashMap<NodeId, Vec<TriangleId>> =
            nodes.iter().map(|&node| (node, Vec::new())).collect();
        let ids = (0..self.triangles.len()).map(TriangleId::from_index);
        for id in ids.filter(|&id| self.is_in_domain(id)) {
            for node in self.triangle(id).vertices {
                if let Some(triangles) = around.get_mut(&node) {
                    triangles.push(id);
                }
            }
        }
        around
    }

    /// The triangles `around` a node, except for the fan that stays: the one of the largest part, then the
    /// one with the widest angle, then the one at the lowest place.
    fn smaller_fans(&self, node: NodeId, around: &[TriangleId], parts: &Parts) -> Vec<TriangleId> {
        let mut fans = self.fans(around);
        fans.sort_by_key(|fan| {
            let eighths: u32 =
                fan.iter().map(|&id| if self.triangle(id).apex() == node { 2 } else { 1 }).sum();
            let place = fan.iter().map(|&id| self.place_key(id)).min();
            (Reverse(parts.rank(fan[0])), Reverse(eighths), place)
        });
        fans.into_iter().skip(1).flatten().collect()
    }

    /// The triangles around a node in groups that are joined by edges.
    fn fans(&self, around: &[TriangleId]) -> Vec<Vec<TriangleId>> {
        let mut groups = Forest::new(around.len());
        for (n, &id) in around.iter().enumerate() {
            for across in self.neighbours(id).into_iter().filter_map(|across| across.triangle()) {
                if let Some(other) = around.iter().position(|&other| other == across) {
                    groups.join(n, other);
                }
            }
        }
        let mut fans: HashMap<usize, Vec<TriangleId>> = HashMap::new();
        for (n, &id) in around.iter().enumerate() {
            fans.entry(groups.root(n)).or_default().push(id);
        }
        fans.into_values().collect()
    }

    /// The area of a triangle of the deepest level, in square world units.
    fn area_of_unit(&self) -> f64 {
        let cell = self.lattice.step() * f64::from(self.lattice.cell_steps());
        0.5 * cell.x * cell.y / (1u128 << self.lattice.deepest_level()) as f64
    }

    /// The area of an entry in triangles of the deepest level; 0 outside the domain.
    fn units_of(&self, index: usize) -> u128 {
        let triangle = &self.triangles[index];
        let finer = self.lattice.deepest_level().saturating_sub(triangle.level());
        if triangle.is_outside() { 0 } else { 1 << finer }
    }

    /// Three times the centroid in lattice coordinates, y first: no two triangles of a mesh share it.
    fn place_key(&self, id: TriangleId) -> [u64; 2] {
        let corners = self.corners(id);
        [corners.iter().map(|p| u64::from(p.y)).sum(), corners.iter().map(|p| u64::from(p.x)).sum()]
    }
}

/// The parts of a mesh.
struct Parts {
    /// For each entry the entry that stands for its part; of no meaning outside the domain.
    roots: Vec<usize>,
    by_root: HashMap<usize, Part>,
}

/// Parts compare by their area, then by place.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    units: u128,
    lowest: Reverse<[u64; 2]>,
    triangles: usize,
    at: TriangleId,
}

impl Parts {
    fn of(mesh: &Mesh) -> Self {
        let mut forest = Forest::new(mesh.triangles.len());
        let in_domain = |index: &usize| mesh.is_in_domain(TriangleId::from_index(*index));
        for index in (0..mesh.triangles.len()).filter(in_domain) {
            let across = mesh.neighbours(TriangleId::from_index(index));
            across.iter().filter_map(|id| id.triangle()).for_each(|id| forest.join(index, id.index()));
        }
        let roots: Vec<usize> = (0..mesh.triangles.len()).map(|index| forest.root(index)).collect();
        let mut by_root: HashMap<usize, Part> = HashMap::new();
        for index in (0..mesh.triangles.len()).filter(in_domain) {
            let at = TriangleId::from_index(index);
            let lowest = Reverse(mesh.place_key(at));
            let part = by_root.entry(roots[index]).or_insert(Part { units: 0, lowest, triangles: 0, at });
            part.units += mesh.units_of(index);
            part.triangles += 1;
            if lowest > part.lowest {
                (part.lowest, part.at) = (lowest, at);
            }
        }
        Self { roots, by_root }
    }

    /// The part of a triangle of the domain.
    fn rank(&self, id: TriangleId) -> Part {
        self.by_root[&self.roots[id.index()]]
    }

    /// The roots of the parts that do not stay, where all parts had `whole` units at first. The largest part
    /// always stays.
    fn removed_by(&self, kept: KeptParts, whole: u128) -> Vec<usize> {
        let Some(largest) = self.by_root.values().max().copied() else { return Vec::new() };
        let stays = |part: &Part| match kept {
            KeptParts::All => true,
            KeptParts::Largest => *part == largest,
            KeptParts::Share(share) => *part == largest || part.units as f64 >= share * whole as f64,
        };
        let mut removed: Vec<usize> =
            self.by_root.iter().filter(|(_, part)| !stays(part)).map(|(&root, _)| root).collect();
        removed.sort_unstable();
        removed
    }

    fn describe(&self, mesh: &Mesh, root: usize) -> RemovedPart {
        let part = self.by_root[&root];
        RemovedPart {
            place: mesh.world_corners(part.at).iter().sum::<DVec2>() / 3.0,
            triangles: part.triangles,
            area: part.units as f64 * mesh.area_of_unit(),
        }
    }
}
