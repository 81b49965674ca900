//! Keeps the nodes on an outline in step with a mesh that changes where it is.
//!
//! What a step of the derivation does at a node depends on the nodes around it, and on what earlier steps did
//! there. Nodes at which something was done or tried (*acting* nodes) form *islands*: those with less than
//! two triangles between them belong to one. All others stay where the first steps put them, and these steps
//! look only a few rings away. So an island does not depend on anything outside it.
//!
//! ```text
//!   ···o···o···●───●───●···o···o···o···●───●···o···o···       ● acting
//!              island          ▲       island
//!                              fresh triangles: the islands that they touch are derived again
//! ```
//!
//! After an edit, the *core* is what lies a few rings around fresh triangles. A *window* around it is derived
//! from scratch. The islands that touch the core, as they were and as they are now, and the core itself take
//! what the window has; all else stays. If one of these islands, or one beside them, comes near the edge of
//! the window, where the first steps do not see enough, a wider window is derived. So the result is the one
//! of [`DerivedMesh::new`](super::DerivedMesh::new).
//!
//! Everything is kept by its place on the lattice, since the entries of a mesh move.

use std::sync::Arc;

use rayon::prelude::*;

use super::band::{GRAIN, RINGS};
use super::changes::{FittedBand, OutlineChanges, OutlineFit, beside};
use super::corners::TurningCorners;
use super::follower_making::FollowerMaking;
use super::lengths::EdgeTargets;
use super::line::OutlineOnLattice;
use super::numbers::{Numbers, Pages};
use super::places::{PlaceKey, node_at, node_place, triangle_place};
use super::window::{LOCAL_RINGS, Rings, SLACK, Window, expected};
use super::writer::Writer;
use crate::domain::{DomainOnLattice, RegionOnLattice};
use crate::geometry::{LatticePoint, LatticeRect, NumberMap};
use crate::mesh::{Changes, DrawnPiece, Mesh, MeshPatch, NodeId, PatchTriangle, Replacement, TriangleId};

/// Returns whether the outline touches a triangle.
fn touches(mesh: &Mesh, region: &RegionOnLattice, id: TriangleId) -> bool {
    region.side_of(mesh.corners(id), mesh.triangle(id).level()).is_none()
}

/// A triangle that the derivation may change.
#[derive(Clone, Debug)]
pub(super) struct KeptTriangle {
    /// Its entry in the mesh; `None` while it is not known whether it is still there.
    pub(super) id: Option<TriangleId>,
    pub(super) corners: [PlaceKey; 3],
    /// The triangles that replace it; `None` if it stays as it is.
    pub(super) pieces: Option<Box<[KeptPiece]>>,
    pub(super) seat: Seat,
}

impl KeptTriangle {
    /// Returns its nodes and those of its pieces.
    fn nodes(&self) -> impl Iterator<Item = PlaceKey> {
        let of_pieces = self.pieces.iter().flatten().flat_map(|piece| piece.corners);
        self.corners.into_iter().chain(of_pieces)
    }
}

/// A triangle that replaces another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeptPiece {
    pub(super) corners: [PlaceKey; 3],
    /// Whether the edges from each corner to the next are on the boundary.
    pub(super) on_boundary: [bool; 3],
}

/// What is known of an entry of the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seat {
    /// The place of the triangle.
    pub(super) place: PlaceKey,
    /// Whether the outline touches it.
    pub(super) is_touched: bool,
    /// Whether the outline touches it beside the band.
    pub(super) is_beside: bool,
}

/// A node of the band, or in a cut edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeptNode {
    pub(super) home: LatticePoint,
    pub(super) at: LatticePoint,
    /// Whether it is part of an island.
    pub(super) acts: bool,
    pub(super) fit: OutlineFit,
    /// The cotangent of the smallest angle that is accepted beside it; 0 if it is not at a corner of the
    /// outline.
    pub(super) corner_limit: f64,
}

/// The nodes on the outline of a domain, for a mesh that changes where it is.
#[derive(Clone, Debug)]
pub struct OutlineFollower {
    domain: DomainOnLattice,
    corners: Arc<TurningCorners>,
    triangles: NumberMap<PlaceKey, KeptTriangle>,
    /// The triangles of `triangles`, by their entries in the mesh.
    seats: NumberMap<u32, Seat>,
    pub(super) nodes: NumberMap<PlaceKey, KeptNode>,
    /// Number of triangles of the mesh.
    count: usize,
}

impl OutlineFollower {
    /// Derives the nodes on the outline of a domain; `None` if the domain does not require them.
    pub fn new(mesh: &Mesh, domain: &DomainOnLattice, targets: Option<EdgeTargets>) -> Option<Self> {
        let region = domain.region_on_outline()?;
        let outline = OutlineOnLattice::new(mesh.lattice(), region, targets);
        let fitted = FittedBand::whole(mesh, region, &outline, &mut |_, _| {});
        let making = FollowerMaking::new(mesh, domain, &outline, &fitted);
        making.advance(mesh, &outline, &fitted, usize::MAX).break_value()
    }

    /// Returns a follower without the triangles of a band, but with room for them.
    pub(super) fn empty(
        mesh: &Mesh,
        domain: &DomainOnLattice,
        outline: &OutlineOnLattice,
        fitted: &FittedBand,
    ) -> Self {
        let mut follower = Self {
            domain: domain.clone(),
            corners: outline.corners.clone(),
            triangles: NumberMap::default(),
            seats: NumberMap::default(),
            nodes: NumberMap::default(),
            count: mesh.raw_triangle_count(),
        };
        follower.triangles.reserve(fitted.band.ids.len());
        follower.seats.reserve(fitted.band.ids.len());
        follower.nodes.reserve(fitted.patchwork.points.len());
        follower
    }

    /// Takes in what changed in the mesh, and where targets may have changed, and returns the entries whose
    /// pieces may have changed, in ascending order.
    pub fn update(
        &mut self,
        mesh: &Mesh,
        targets: Option<EdgeTargets>,
        changes: &Changes,
    ) -> Vec<TriangleId> {
        self.update_few(mesh, targets, changes, usize::MAX).expect("there is no limit")
    }

    /// [`Self::update`], unless more triangles than `most` came near the outline. Then it returns `None`, and
    /// the nodes are no longer in step with the mesh.
    pub fn update_few(
        &mut self,
        mesh: &Mesh,
        targets: Option<EdgeTargets>,
        changes: &Changes,
        most: usize,
    ) -> Option<Vec<TriangleId>> {
        let domain = self.domain.clone();
        let Some(region) = domain.region_on_outline() else { return Some(Vec::new()) };
        let Entries { fresh, mut rewritten, mut stale } = self.follow_entries(mesh, changes);
        let fresh = fresh.into_par_iter().with_min_len(GRAIN);
        let relevant = fresh.filter(|id| self.knows(mesh, *id) || touches(mesh, region, *id));
        let mut relevant: Vec<TriangleId> = relevant.collect();
        relevant.extend(self.retargeted(mesh, &changes.retargeted));
        if relevant.len() > most {
            return None;
        }
        if !relevant.is_empty() {
            let outline =
                OutlineOnLattice::with_corners(mesh.lattice(), region, targets, self.corners.clone());
            self.derive_around(mesh, &outline, &relevant, &mut rewritten, &mut stale);
        }
        rewritten.par_sort_unstable();
        rewritten.dedup();
        Some(rewritten)
    }

    /// Returns the kept triangles in places where targets may have changed.
    fn retargeted(&self, mesh: &Mesh, areas: &[LatticeRect]) -> Vec<TriangleId> {
        if areas.is_empty() {
            return Vec::new();
        }
        let is_in_area = |id: &TriangleId| areas.iter().any(|area| area.touches(mesh.corners(*id)));
        let kept = self.seats.iter().filter(|(_, seat)| !seat.is_beside);
        let kept: Vec<_> = kept.map(|(&index, _)| TriangleId::from_index(index as usize)).collect();
        let mut found: Vec<TriangleId> = kept.into_par_iter().filter(is_in_area).collect();
        found.sort_unstable();
        found
    }

    /// Finds kept triangles at their new entries. Those that are gone are forgotten.
    fn follow_entries(&mut self, mesh: &Mesh, changes: &Changes) -> Entries {
        let count = mesh.raw_triangle_count();
        let gone = count..std::mem::replace(&mut self.count, count);
        let changed = || changes.triangles.iter().flat_map(|ids| ids.start..ids.end.min(count));
        let mut lost = Vec::new();
        for index in changed().chain(gone) {
            if let Some(seat) = self.seats.remove(&(index as u32)) {
                self.triangles.get_mut(&seat.place).expect("it was kept").id = None;
                lost.push(seat.place);
            }
        }
        let mut entries = Entries::default();
        for index in changed() {
            let id = TriangleId::from_index(index);
            let place = triangle_place(mesh.corners(id));
            match self.triangles.get_mut(&place) {
                Some(kept) => {
                    kept.id = Some(id);
                    self.seats.insert(index as u32, kept.seat);
                    entries.rewritten.push(id);
                }
                None => entries.fresh.push(id),
            }
        }
        for place in lost {
            if self.triangles[&place].id.is_none() {
                let kept = self.triangles.remove(&place).expect("it was kept");
                entries.forget(&kept);
            }
        }
        entries
    }

    /// Derives the surroundings of fresh triangles again.
    fn derive_around(
        &mut self,
        mesh: &Mesh,
        outline: &OutlineOnLattice,
        fresh: &[TriangleId],
        rewritten: &mut Vec<TriangleId>,
        stale: &mut Vec<PlaceKey>,
    ) {
        let seeds: Vec<NodeId> = fresh.iter().flat_map(|&id| mesh.triangle(id).vertices).collect();
        let near = Rings::around(mesh, seeds.iter().copied(), RINGS as u32, |_| true);
        // Triangles that are in the band now were there before, or are near fresh ones.
        let may_be_in_band = |id: TriangleId| {
            self.seats.contains_key(&(id.index() as u32))
                || mesh.triangle(id).vertices.iter().all(|&v| near.ring_of(v).is_some())
        };
        let mut is_fresh = Pages::for_entries(mesh.raw_triangle_count());
        fresh.iter().for_each(|id| _ = is_fresh.set(id.index(), 0));
        // What is not kept was touched without effect, and has an effect in the band only, if at all.
        let touches = |id: TriangleId| match self.seats.get(&(id.index() as u32)) {
            Some(seat) => seat.is_touched,
            None => is_fresh.get(id.index()).is_some() && touches(mesh, outline.region, id),
        };
        let acted = |point: LatticePoint| self.nodes.get(&node_place(point)).is_some_and(|node| node.acts);
        let mut core = Rings::around(mesh, seeds, LOCAL_RINGS, may_be_in_band).nodes;
        let mut slack = SLACK;
        let (window, reached) = loop {
            let sure = expected(mesh, &core, acted, may_be_in_band);
            let window = Window::new(mesh, outline, core, (sure, slack), may_be_in_band, touches);
            let reached = window.reached(&self.strangers(mesh, &window), acted);
            if reached.is_sure {
                break (window, reached.nodes);
            }
            (core, slack) = (reached.nodes, slack + SLACK);
        };
        self.take_over(mesh, outline, &window, &reached, rewritten, stale);
        drop(window);
    }

    /// Returns the nodes of triangles that came to the band or left it, in the sure part of a window.
    fn strangers(&self, mesh: &Mesh, window: &Window) -> Vec<NodeId> {
        let may_matter = |id: &TriangleId| mesh.triangle(*id).vertices.iter().any(|&v| window.is_sure(v));
        let is_stranger = |id: &TriangleId| {
            let is_in_band = window.number_of_triangle(*id).is_some();
            let seat = self.seats.get(&(id.index() as u32));
            is_in_band != seat.is_some_and(|seat| !seat.is_beside)
        };
        let strangers = window.triangles.iter().filter(|id| may_matter(id) && is_stranger(id));
        let nodes = strangers.flat_map(|&id| mesh.triangle(id).vertices);
        nodes.filter(|&node| window.is_sure(node)).collect()
    }

    /// Takes the nodes that were reached, and the triangles around them, from a window.
    fn take_over(
        &mut self,
        mesh: &Mesh,
        outline: &OutlineOnLattice,
        window: &Window,
        reached: &[NodeId],
        rewritten: &mut Vec<TriangleId>,
        stale: &mut Vec<PlaceKey>,
    ) {
        let fitted = &window.fitted;
        let mut writer = Writer::new(mesh, fitted, outline);
        let mut is_written = Pages::for_entries(mesh.raw_triangle_count());
        for &node in reached {
            if window.number_of(node).is_none() {
                stale.push(node_place(mesh.node(node)));
            }
            for id in mesh.all_triangles_around(node) {
                if !is_written.set(id.index(), 0) {
                    continue;
                }
                rewritten.push(id);
                if let Some(seat) = self.seats.remove(&(id.index() as u32)) {
                    let kept = self.triangles.remove(&seat.place).expect("it was kept");
                    stale.extend(kept.nodes());
                }
                if let Some(t) = window.number_of_triangle(id) {
                    writer.write(self, t);
                }
            }
        }
        for &(id, inside) in fitted.band.touched.iter().filter(|(id, _)| is_written.get(id.index()).is_some())
        {
            self.write_beside(mesh, id, inside);
        }
        let nodes = 0..fitted.patchwork.points.len() as u32;
        let present: NumberMap<PlaceKey, ()> = nodes.map(|v| (node_place(fitted.home(v)), ())).collect();
        for place in stale.drain(..).filter(|place| !present.contains_key(place)) {
            self.nodes.remove(&place);
        }
    }

    pub(super) fn write_beside(&mut self, mesh: &Mesh, id: TriangleId, inside: bool) {
        let Some(pieces) = beside(mesh, id, inside) else { return };
        let corners = mesh.corners(id).map(node_place);
        // The nodes of the triangles across its edges lie inside, too.
        let on_boundary = mesh.triangle(id).raw_neighbours.map(|across| across.triangle().is_none());
        let corners_of = |piece: [NodeId; 3]| piece.map(|node| node_place(mesh.node(node)));
        let kept_piece = |piece| KeptPiece { corners: corners_of(piece), on_boundary };
        let pieces = pieces.into_iter().map(kept_piece).collect();
        let seat = Seat { place: triangle_place(mesh.corners(id)), is_touched: true, is_beside: true };
        self.keep(id, KeptTriangle { id: Some(id), corners, pieces: Some(pieces), seat });
    }

    pub(super) fn keep(&mut self, id: TriangleId, triangle: KeptTriangle) {
        self.seats.insert(id.index() as u32, triangle.seat);
        self.triangles.insert(triangle.seat.place, triangle);
    }

    /// Returns the changes of the mesh, which must be the one of the last update.
    pub(super) fn changes(&self, mesh: &Mesh) -> OutlineChanges {
        let nodes = || self.nodes.values();
        OutlineChanges {
            patch: self.patch(mesh),
            fit: nodes().map(|node| node.fit).fold(OutlineFit::default(), OutlineFit::joined),
            corner_limit: nodes().map(|node| node.corner_limit).fold(0.0, f64::max),
        }
    }

    fn patch(&self, mesh: &Mesh) -> MeshPatch {
        let mut changed: Vec<(TriangleId, &[KeptPiece])> =
            self.triangles.values().filter_map(|kept| Some((kept.id?, kept.pieces.as_deref()?))).collect();
        changed.par_sort_unstable_by_key(|(id, _)| *id);
        // A moved node, and each corner of a piece, is the corner of a triangle that is replaced.
        let mut ids = NumberMap::<PlaceKey, NodeId>::default();
        for node in changed.iter().flat_map(|&(id, _)| mesh.triangle(id).vertices) {
            ids.insert(node_place(mesh.node(node)), node);
        }
        let kept = |place: &PlaceKey| self.nodes.get(place).filter(|node| node.at != node.home);
        let moved = ids.iter().filter_map(|(place, &id)| Some((id, kept(place)?.at)));
        let mut patch = MeshPatch { moved: moved.collect(), ..MeshPatch::default() };
        patch.moved.par_sort_unstable_by_key(|(id, _)| *id);
        for (id, pieces) in changed {
            let (first, level) = (patch.pieces.len(), mesh.triangle(id).level());
            for piece in pieces {
                let corners = piece.corners.map(|place| {
                    *ids.entry(place).or_insert_with(|| {
                        patch.added.push(self.nodes[&place].at);
                        NodeId::from_index(mesh.raw_nodes().len() + patch.added.len() - 1)
                    })
                });
                patch.pieces.push(PatchTriangle { corners, level });
            }
            patch.changed.push((id, first..patch.pieces.len()));
        }
        patch
    }

    /// Returns what is drawn in place of a triangle of the mesh, which must be the one of the last update.
    pub fn replacement(&self, mesh: &Mesh, id: TriangleId) -> Replacement {
        let kept = self.seats.get(&(id.index() as u32)).map(|seat| &self.triangles[&seat.place]);
        let drawn = |piece: &KeptPiece| DrawnPiece {
            // Beside the band, nodes are not kept: they stay where they are.
            corners: piece.corners.map(|place| self.nodes.get(&place).map_or(node_at(place), |node| node.at)),
            on_boundary: piece.on_boundary,
        };
        let shown = |home| self.nodes.get(&node_place(home)).map_or(home, |node| node.at);
        Replacement {
            id,
            nodes: mesh.corners(id).map(shown),
            pieces: kept
                .and_then(|kept| kept.pieces.as_ref())
                .map(|pieces| pieces.iter().map(drawn).collect()),
        }
    }

    /// Returns the number of triangles that replace one of the mesh; `None` if it stays as it is.
    pub(super) fn number_of_pieces(&self, id: TriangleId) -> Option<usize> {
        let seat = self.seats.get(&(id.index() as u32))?;
        Some(self.triangles[&seat.place].pieces.as_ref()?.len())
    }

    /// Returns whether a triangle of the mesh is kept, or has a node that is.
    pub(super) fn knows(&self, mesh: &Mesh, id: TriangleId) -> bool {
        self.seats.contains_key(&(id.index() as u32))
            || mesh.corners(id).iter().any(|&p| self.nodes.contains_key(&node_place(p)))
    }

    /// Returns the domain whose outline it follows.
    pub fn domain(&self) -> &DomainOnLattice {
        &self.domain
    }
}

/// What became of changed entries.
#[derive(Default)]
struct Entries {
    /// Triangles that were not kept.
    fresh: Vec<TriangleId>,
    /// New entries of kept triangles.
    rewritten: Vec<TriangleId>,
    /// Nodes of triangles that are gone.
    stale: Vec<PlaceKey>,
}

impl Entries {
    fn forget(&mut self, kept: &KeptTriangle) {
        self.stale.extend(kept.nodes());
    }
}
