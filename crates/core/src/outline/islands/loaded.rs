//! Some triangles of a mesh, loaded where a walk comes to them.

use crate::geometry::{LatticePoint, NumberMap, NumberSet};
use crate::mesh::{Mesh, NodeId, TriangleId};
use crate::outline::local::PatchedTriangle;
use crate::outline::quality::BoundaryCensus;

use super::PieceSource;

/// Rings of triangles of the mesh in which the other triangles at a node are looked for. The triangles that
/// take the place of one of the mesh lie there or beside it, as edges were flipped.
const MOST_RINGS: usize = 4;

/// A triangle that was loaded.
struct LoadedTriangle {
    patched: PatchedTriangle,
    /// Whether the edges from each corner to the next are on the boundary.
    on_boundary: [bool; 3],
}

/// Triangles that take the place of some triangles of a mesh, and their nodes, numbered as they come.
pub(super) struct LoadedMesh<'a> {
    mesh: &'a Mesh,
    source: &'a dyn PieceSource,
    /// For triangles of the mesh that were loaded, those in their place.
    owners: NumberMap<u32, Vec<u32>>,
    /// Triangles of the mesh around which all others are loaded.
    surrounded: NumberSet<u32>,
    triangles: Vec<LoadedTriangle>,
    pub(super) places: Vec<LatticePoint>,
    numbers: NumberMap<LatticePoint, u32>,
    /// For each node, the triangles at it that are loaded, and whether these are all.
    at: Vec<Vec<u32>>,
    is_complete: Vec<bool>,
    pub(super) census: BoundaryCensus,
}

impl<'a> LoadedMesh<'a> {
    pub(super) fn new(mesh: &'a Mesh, source: &'a dyn PieceSource) -> Self {
        Self {
            mesh,
            source,
            owners: NumberMap::default(),
            surrounded: NumberSet::default(),
            triangles: Vec::new(),
            places: Vec::new(),
            numbers: NumberMap::default(),
            at: Vec::new(),
            is_complete: Vec::new(),
            census: BoundaryCensus::default(),
        }
    }

    /// Returns the triangles that take the place of one of the mesh.
    pub(super) fn load(&mut self, owner: TriangleId) -> &[u32] {
        let key = owner.index() as u32;
        if !self.owners.contains_key(&key) {
            let pieces = self.source.pieces(self.mesh, owner);
            let numbers = pieces.into_iter().map(|piece| self.add(owner, piece.corners, piece.on_boundary));
            let numbers = numbers.collect();
            self.owners.insert(key, numbers);
        }
        &self.owners[&key]
    }

    fn add(&mut self, owner: TriangleId, corners: [LatticePoint; 3], on_boundary: [bool; 3]) -> u32 {
        let number = self.triangles.len() as u32;
        let nodes = corners.map(|at| self.node(at));
        nodes.iter().for_each(|&v| self.at[v as usize].push(number));
        self.census.add(nodes.map(|v| v as usize));
        let corners = nodes.map(|v| NodeId::from_index(v as usize));
        self.triangles.push(LoadedTriangle { patched: PatchedTriangle { owner, corners }, on_boundary });
        number
    }

    fn node(&mut self, at: LatticePoint) -> u32 {
        *self.numbers.entry(at).or_insert_with(|| {
            self.places.push(at);
            self.at.push(Vec::new());
            self.is_complete.push(false);
            self.places.len() as u32 - 1
        })
    }

    pub(super) fn triangle(&self, number: u32) -> PatchedTriangle {
        self.triangles[number as usize].patched
    }

    pub(super) fn nodes(&self, number: u32) -> [u32; 3] {
        self.triangle(number).corners.map(|v| v.index() as u32)
    }

    /// Returns the places of the corners of a triangle.
    pub(super) fn corners(&self, number: u32) -> [LatticePoint; 3] {
        self.triangle(number).corners.map(|v| self.places[v.index()])
    }

    /// Returns whether the edges of a triangle from each corner to the next are on the boundary.
    pub(super) fn on_boundary(&self, number: u32) -> [bool; 3] {
        self.triangles[number as usize].on_boundary
    }

    /// Returns all triangles at a node.
    pub(super) fn around(&mut self, node: u32) -> &[u32] {
        if !self.is_complete[node as usize] {
            self.complete(node);
        }
        &self.at[node as usize]
    }

    fn complete(&mut self, node: u32) {
        let of_node = |t: &u32| self.triangles[*t as usize].patched.owner;
        let mut owners: Vec<TriangleId> = self.at[node as usize].iter().map(of_node).collect();
        for _ in 0..MOST_RINGS {
            let mut beside = Vec::new();
            for owner in owners {
                self.surround(owner, &mut beside);
            }
            if self.is_closed(node) {
                break;
            }
            owners = beside;
        }
        self.is_complete[node as usize] = true;
    }

    /// Loads what has a node in common with a triangle of the mesh.
    fn surround(&mut self, owner: TriangleId, beside: &mut Vec<TriangleId>) {
        let is_new = self.surrounded.insert(owner.index() as u32);
        for node in self.mesh.triangle(owner).vertices {
            for id in self.mesh.all_triangles_around(node) {
                beside.push(id);
                if is_new {
                    self.load(id);
                }
            }
        }
    }

    /// Returns whether the triangles at a node close around it, or end at the boundary.
    fn is_closed(&self, node: u32) -> bool {
        let fan = &self.at[node as usize];
        let place = |t: u32| self.nodes(t).iter().position(|&v| v == node).unwrap_or(0);
        let beside = |t: u32, by: usize| self.nodes(t)[(place(t) + by) % 3];
        fan.iter().all(|&t| {
            let on_boundary = self.on_boundary(t);
            let (next, last) = (beside(t, 1), beside(t, 2));
            (on_boundary[place(t)] || fan.iter().any(|&other| beside(other, 2) == next))
                && (on_boundary[(place(t) + 2) % 3] || fan.iter().any(|&other| beside(other, 1) == last))
        })
    }
}
