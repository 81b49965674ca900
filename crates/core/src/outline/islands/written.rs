//! Writes changed islands into what is kept of them.

use super::kept::{IslandOwner, IslandTriangle, KeptIsland};
use super::{ChangedIsland, KeptIslands, PieceSource, from_lowest};
use crate::geometry::{LatticePoint, NumberMap, NumberSet};
use crate::mesh::{DrawnPiece, Mesh, TriangleId};
use crate::outline::angles::Angles;
use crate::outline::local::LocalMesh;
use crate::outline::places::{PlaceKey, triangle_place};
use crate::outline::triangulation::NONE;

/// Returns the islands that have a node in common, in groups.
pub(in crate::outline) fn in_groups(islands: Vec<ChangedIsland>) -> Vec<Vec<ChangedIsland>> {
    let mut first_at = NumberMap::<LatticePoint, usize>::default();
    let mut group_of: Vec<usize> = (0..islands.len()).collect();
    let root = |group_of: &[usize], mut n: usize| {
        while group_of[n] != n {
            n = group_of[n];
        }
        n
    };
    for (n, island) in islands.iter().enumerate() {
        for &at in &island.start.points {
            let first = root(&group_of, *first_at.entry(at).or_insert(n));
            let own = root(&group_of, n);
            group_of[first.max(own)] = first.min(own);
        }
    }
    let mut groups: Vec<Vec<ChangedIsland>> = islands.iter().map(|_| Vec::new()).collect();
    for (n, island) in islands.into_iter().enumerate() {
        groups[root(&group_of, n)].push(island);
    }
    groups.retain(|group| !group.is_empty());
    groups
}

impl KeptIslands {
    /// Keeps islands that have nodes in common, which were changed, and notes the entries that they change.
    pub(in crate::outline) fn write(
        &mut self,
        mesh: &Mesh,
        below: &dyn PieceSource,
        angles: &Angles,
        group: &[ChangedIsland],
        changed: &mut Vec<TriangleId>,
    ) {
        let starts = || group.iter().map(|island| &island.start);
        let mut owners: Vec<TriangleId> =
            starts().flat_map(|start| &start.owners).copied().flatten().collect();
        owners.sort_unstable();
        owners.dedup();
        let mut kept = KeptIsland {
            owners: owners.iter().map(|&id| triangle_place(mesh.corners(id))).collect(),
            nodes: starts().flat_map(|start| &start.points).copied().collect(),
            ..KeptIsland::default()
        };
        for island in group {
            kept.asked = kept.asked.into_iter().chain(island.asked).reduce(|a, b| a.union(&b));
            let used = island.now.used();
            let is_moved = |v: &u32| used[*v as usize] && island.now.is_moved(&island.start, *v);
            for v in (0..island.start.points.len() as u32).filter(is_moved) {
                let [from, to] = [&island.start, &island.now].map(|local| local.points[v as usize]);
                kept.moved.push(from);
                self.moved.insert(from, to);
            }
        }
        let places = owners.iter().copied().zip(kept.owners.iter().copied()).collect::<Vec<_>>();
        let number = self.keep(kept);
        for &(id, place) in &places {
            self.seats.insert(id.index() as u32, place);
            self.owners.entry(place).or_default().id = Some(id);
        }
        for island in group {
            self.write_triangles(mesh, below, angles, (number, island));
        }
        let is_changed = |(id, _): &(TriangleId, PlaceKey)| self.replaces(*id);
        changed.extend(places.into_iter().filter(is_changed).map(|(id, _)| id));
    }

    fn write_triangles(
        &mut self,
        mesh: &Mesh,
        below: &dyn PieceSource,
        angles: &Angles,
        (number, island): (u32, &ChangedIsland),
    ) {
        let (start, now) = (&island.start, &island.now);
        let mut edges = NumberSet::<[LatticePoint; 2]>::default();
        let mut known = NumberMap::<u32, Vec<DrawnPiece>>::default();
        for (t, owner) in start.owners.iter().enumerate() {
            let Some(id) = *owner else { continue };
            let (corners, _) = from_lowest(start.corners(t as u32));
            let pieces = known.entry(id.index() as u32).or_insert_with(|| below.pieces(mesh, id));
            let own = pieces.iter().find_map(|piece| {
                let (turned, lowest) = from_lowest(piece.corners);
                (turned == corners).then(|| [0, 1, 2].map(|i| piece.on_boundary[(lowest + i) % 3]))
            });
            let on_boundary = own.unwrap_or_default();
            for i in (0..3).filter(|&i| on_boundary[i]) {
                edges.insert([corners[i], corners[(i + 1) % 3]]);
            }
            let triangle = IslandTriangle { island: number, corners, on_boundary, is_gone: false };
            self.owner_mut(mesh, id).triangles.push(triangle);
        }
        for change in now.changed(start, angles) {
            if let Some(gone) = change.gone {
                let (corners, _) = from_lowest(start.corners(gone.number));
                let owner = self.owner_mut(mesh, gone.owner);
                let same = owner.triangles.iter_mut().filter(|t| t.island == number && t.corners == corners);
                same.for_each(|t| t.is_gone = true);
            }
            if let Some(piece) = change.piece {
                let on_boundary = boundary_of(now, piece.number, piece.corners, &edges);
                let corners = piece.corners.map(|v| now.points[v as usize]);
                let piece_drawn = DrawnPiece { corners, on_boundary };
                self.owner_mut(mesh, piece.owner).pieces.push((number, piece_drawn));
            }
        }
    }

    fn owner_mut(&mut self, mesh: &Mesh, id: TriangleId) -> &mut IslandOwner {
        let place = self.seats.get(&(id.index() as u32)).copied();
        let place = place.unwrap_or_else(|| triangle_place(mesh.corners(id)));
        self.owners.entry(place).or_default()
    }
}

/// Returns whether the edges from each of these corners of a triangle to the next are on the boundary.
/// `edges` are those of the island that were there before: of nodes at which triangles are missing, the
/// island does not know it.
fn boundary_of(
    local: &LocalMesh,
    triangle: u32,
    corners: [u32; 3],
    edges: &NumberSet<[LatticePoint; 2]>,
) -> [bool; 3] {
    [0, 1, 2].map(|i| {
        let opposite = local.triangles.place(triangle, corners[(i + 2) % 3]);
        let ends = [corners[i], corners[(i + 1) % 3]].map(|v| local.points[v as usize]);
        local.triangles.across[triangle as usize][opposite] == NONE
            && (local.is_boundary(triangle, opposite) || edges.contains(&ends))
    })
}
