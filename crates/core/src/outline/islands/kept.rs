//! Islands that are kept by their places.

use super::from_lowest;
use crate::geometry::{LatticePoint, LatticeRect, NumberMap};
use crate::mesh::{DrawnPiece, Mesh, TriangleId};
use crate::outline::places::PlaceKey;

/// A triangle of an island as it was, before the island was changed.
#[derive(Clone, Copy, Debug)]
pub(super) struct IslandTriangle {
    pub(super) island: u32,
    /// From the lowest one on.
    pub(super) corners: [LatticePoint; 3],
    /// Whether the edges from each corner to the next are on the boundary.
    pub(super) on_boundary: [bool; 3],
    /// Whether others take its place.
    pub(super) is_gone: bool,
}

/// A triangle of the mesh in whose place islands have triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct IslandOwner {
    /// Its entry in the mesh; `None` while it is not known whether it is still there.
    pub(super) id: Option<TriangleId>,
    pub(super) triangles: Vec<IslandTriangle>,
    /// The triangles that islands put in its place, with the numbers of the islands.
    pub(super) pieces: Vec<(u32, DrawnPiece)>,
}

impl IslandOwner {
    fn is_changed_by(&self, island: u32) -> bool {
        self.triangles.iter().any(|t| t.island == island && t.is_gone)
            || self.pieces.iter().any(|(other, _)| *other == island)
    }
}

/// What is kept of an island.
#[derive(Clone, Debug, Default)]
pub(super) struct KeptIsland {
    pub(super) owners: Vec<PlaceKey>,
    pub(super) nodes: Vec<LatticePoint>,
    /// Nodes that are elsewhere now.
    pub(super) moved: Vec<LatticePoint>,
    /// The area in which targets were asked for.
    pub(super) asked: Option<LatticeRect>,
}

/// Islands that are kept in step with a mesh.
#[derive(Clone, Debug)]
pub(in crate::outline) struct KeptIslands {
    pub(super) owners: NumberMap<PlaceKey, IslandOwner>,
    /// The places of these, by their entries in the mesh.
    pub(super) seats: NumberMap<u32, PlaceKey>,
    islands: Vec<Option<KeptIsland>>,
    free: Vec<u32>,
    /// The island of each node.
    pub(super) island_at: NumberMap<LatticePoint, u32>,
    /// Where nodes of islands are now.
    pub(super) moved: NumberMap<LatticePoint, LatticePoint>,
    /// Number of triangles of the mesh.
    pub(super) count: usize,
}

impl KeptIslands {
    /// Returns none yet.
    pub(in crate::outline) fn none(mesh: &Mesh) -> Self {
        Self {
            owners: NumberMap::default(),
            seats: NumberMap::default(),
            islands: Vec::new(),
            free: Vec::new(),
            island_at: NumberMap::default(),
            moved: NumberMap::default(),
            count: mesh.raw_triangle_count(),
        }
    }

    pub(super) fn owner(&self, id: TriangleId) -> Option<&IslandOwner> {
        self.owners.get(self.seats.get(&(id.index() as u32))?)
    }

    /// Returns whether islands change what takes the place of a triangle of the mesh.
    pub(in crate::outline) fn replaces(&self, id: TriangleId) -> bool {
        let is_changed =
            |owner: &IslandOwner| !owner.pieces.is_empty() || owner.triangles.iter().any(|t| t.is_gone);
        self.owner(id).is_some_and(is_changed)
    }

    /// Returns what takes the place of a triangle of the mesh, of which this was the place before.
    pub(in crate::outline) fn pieces_of(
        &self,
        id: TriangleId,
        mut before: Vec<DrawnPiece>,
    ) -> Vec<DrawnPiece> {
        let Some(owner) = self.owner(id) else { return before };
        before.retain(|piece| {
            let corners = from_lowest(piece.corners).0;
            !owner.triangles.iter().any(|t| t.is_gone && t.corners == corners)
        });
        before.extend(owner.pieces.iter().map(|(_, piece)| *piece));
        before
    }

    /// Returns where a node is now.
    pub(in crate::outline) fn moved_to(&self, at: LatticePoint) -> LatticePoint {
        self.moved.get(&at).copied().unwrap_or(at)
    }

    pub(super) fn island(&self, number: u32) -> &KeptIsland {
        self.islands[number as usize].as_ref().expect("only islands that are kept have numbers")
    }

    /// Returns the islands that asked for targets in one of these areas.
    pub(super) fn asked_in(&self, areas: &[LatticeRect]) -> Vec<u32> {
        if areas.is_empty() {
            return Vec::new();
        }
        let is_in = |asked: LatticeRect| areas.iter().any(|area| area.meets(&asked));
        let asked = |island: &Option<KeptIsland>| island.as_ref().and_then(|island| island.asked);
        let found = self.islands.iter().enumerate().filter(|(_, island)| asked(island).is_some_and(is_in));
        found.map(|(number, _)| number as u32).collect()
    }

    /// Keeps an island, and returns its number.
    pub(super) fn keep(&mut self, island: KeptIsland) -> u32 {
        let number = self.free.pop().unwrap_or_else(|| {
            self.islands.push(None);
            self.islands.len() as u32 - 1
        });
        island.nodes.iter().for_each(|&at| _ = self.island_at.insert(at, number));
        self.islands[number as usize] = Some(island);
        number
    }

    /// Forgets an island, and notes the entries that it changed.
    pub(super) fn forget(&mut self, number: u32, changed: &mut Vec<TriangleId>) {
        let Some(island) = self.islands[number as usize].take() else { return };
        self.free.push(number);
        island.nodes.iter().for_each(|at| _ = self.island_at.remove(at));
        island.moved.iter().for_each(|at| _ = self.moved.remove(at));
        for place in island.owners {
            let Some(owner) = self.owners.get_mut(&place) else { continue };
            changed.extend(owner.id.filter(|_| owner.is_changed_by(number)));
            owner.triangles.retain(|t| t.island != number);
            owner.pieces.retain(|(other, _)| *other != number);
            if owner.triangles.is_empty() {
                if let Some(id) = owner.id {
                    self.seats.remove(&(id.index() as u32));
                }
                self.owners.remove(&place);
            }
        }
    }
}
