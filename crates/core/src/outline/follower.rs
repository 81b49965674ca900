//! Keeps the nodes on an outline in step with a mesh that changes where it is.
//!
//! Whatever a step of the derivation does at a node depends on the nodes around it, and on what steps did
//! there. Nodes at which something was done or tried (*acting* nodes) form *islands*: those with less than
//! two triangles between them belong to one. All others stay where the first steps put them, and these look
//! only a few rings far. So an island is the same whatever happens outside it.
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

use super::band::{Band, GRAIN, RINGS};
use super::changes::{FittedBand, Outline, OutlineChanges, OutlineFit, PiecesByTriangle, beside};
use super::corners::TurningCorners;
use super::numbers::{NumberMap, Numbers};
use super::triangulation::NONE;
use super::window::{LOCAL_RINGS, Rings, WINDOW_RINGS, Window};
use crate::domain::DomainOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Changes, Mesh, MeshPatch, NodeId, PatchTriangle, TriangleId};

/// A place on the lattice as one number: of a node, or three times the centroid of a triangle. No triangle
/// has the centroid of one that it is a part of.
type Place = u64;

fn node_place(point: LatticePoint) -> Place {
    u64::from(point.x) << 32 | u64::from(point.y)
}

fn triangle_place(corners: [LatticePoint; 3]) -> Place {
    let sum = |c: fn(&LatticePoint) -> u32| corners.iter().map(|p| u64::from(c(p))).sum::<u64>();
    sum(|p| p.x) << 32 | sum(|p| p.y)
}

/// A triangle that the derivation may change.
#[derive(Clone, Debug)]
struct KeptTriangle {
    /// Its entry in the mesh; `None` while it is not known whether it is still there.
    id: Option<TriangleId>,
    corners: [Place; 3],
    /// The triangles that replace it; `None` if it stays as it is.
    pieces: Option<Box<[[Place; 3]]>>,
    /// Whether the outline touches it beside the band.
    is_beside: bool,
}

/// A node of the band, or in a cut edge.
#[derive(Clone, Copy, Debug)]
struct KeptNode {
    home: LatticePoint,
    at: LatticePoint,
    /// Whether it is part of an island.
    acts: bool,
    fit: OutlineFit,
    /// The cotangent of the smallest angle that is accepted beside it; 0 if it is not at a corner of the
    /// outline.
    corner_limit: f64,
}

/// The nodes on the outline of a domain, for a mesh that changes where it is.
#[derive(Clone, Debug)]
pub struct OutlineFollower {
    domain: DomainOnLattice,
    corners: Arc<TurningCorners>,
    triangles: NumberMap<Place, KeptTriangle>,
    /// The places of the triangles of `triangles`, by their entries in the mesh.
    places: NumberMap<u32, Place>,
    nodes: NumberMap<Place, KeptNode>,
    /// Number of triangles of the mesh.
    count: usize,
}

impl OutlineFollower {
    /// Derives the nodes on the outline of a domain; `None` if the domain does not require them.
    pub fn new(mesh: &Mesh, domain: &DomainOnLattice) -> Option<Self> {
        let region = domain.region_on_outline()?;
        let outline = Outline::new(mesh.lattice(), region);
        let fitted = FittedBand::new(mesh, Band::new(mesh, region), &outline, &mut |_, _| {});
        let mut follower = Self {
            domain: domain.clone(),
            corners: outline.corners.clone(),
            triangles: NumberMap::default(),
            places: NumberMap::default(),
            nodes: NumberMap::default(),
            count: mesh.raw_triangle_count(),
        };
        follower.triangles.reserve(fitted.band.ids.len());
        follower.places.reserve(fitted.band.ids.len());
        follower.nodes.reserve(fitted.patchwork.points.len());
        let mut writer = Writer::new(mesh, &fitted, &outline);
        (0..fitted.band.ids.len() as u32).for_each(|t| writer.write(&mut follower, t));
        fitted.band.touched.iter().for_each(|&(id, inside)| follower.write_beside(mesh, id, inside));
        Some(follower)
    }

    /// Takes in what changed in the mesh, and returns the entries whose pieces may be others than before, in
    /// ascending order.
    pub fn update(&mut self, mesh: &Mesh, changes: &Changes) -> Vec<TriangleId> {
        let domain = self.domain.clone();
        let Some(region) = domain.region_on_outline() else { return Vec::new() };
        let Entries { fresh, mut rewritten, mut stale } = self.follow_entries(mesh, changes);
        let known =
            |id: &TriangleId| mesh.corners(*id).iter().any(|&p| self.nodes.contains_key(&node_place(p)));
        let touches =
            |id: &TriangleId| region.side_of(mesh.corners(*id), mesh.triangle(*id).level()).is_none();
        let relevant = fresh.into_par_iter().with_min_len(GRAIN).filter(|id| known(id) || touches(id));
        let relevant: Vec<TriangleId> = relevant.collect();
        if !relevant.is_empty() {
            let outline = Outline::with_corners(mesh.lattice(), region, self.corners.clone());
            self.derive_around(mesh, &outline, &relevant, &mut rewritten, &mut stale);
        }
        rewritten.par_sort_unstable();
        rewritten.dedup();
        rewritten
    }

    /// Finds kept triangles at their new entries. Those that are gone are forgotten.
    fn follow_entries(&mut self, mesh: &Mesh, changes: &Changes) -> Entries {
        let count = mesh.raw_triangle_count();
        let gone = count..std::mem::replace(&mut self.count, count);
        let changed = || changes.triangles.iter().flat_map(|ids| ids.start..ids.end.min(count));
        let mut lost = Vec::new();
        for index in changed().chain(gone) {
            if let Some(place) = self.places.remove(&(index as u32)) {
                self.triangles.get_mut(&place).expect("it was kept").id = None;
                lost.push(place);
            }
        }
        let mut entries = Entries::default();
        for index in changed() {
            let id = TriangleId::from_index(index);
            let place = triangle_place(mesh.corners(id));
            match self.triangles.get_mut(&place) {
                Some(kept) => {
                    kept.id = Some(id);
                    self.places.insert(index as u32, place);
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
        outline: &Outline,
        fresh: &[TriangleId],
        rewritten: &mut Vec<TriangleId>,
        stale: &mut Vec<Place>,
    ) {
        let seeds: Vec<NodeId> = fresh.iter().flat_map(|&id| mesh.triangle(id).vertices).collect();
        let near = Rings::around(mesh, seeds.iter().copied(), RINGS as u32, |_| true);
        // Triangles that are in the band now were there before, or are near fresh ones.
        let may_be_in_band = |id: TriangleId| {
            self.places.contains_key(&(id.index() as u32))
                || mesh.triangle(id).vertices.iter().all(|&v| near.ring_of(v).is_some())
        };
        let mut core = Rings::around(mesh, seeds, LOCAL_RINGS, may_be_in_band).nodes;
        let mut reach = WINDOW_RINGS;
        let (window, reached) = loop {
            let window = Window::new(mesh, outline, core, reach, may_be_in_band);
            let acted =
                |point: LatticePoint| self.nodes.get(&node_place(point)).is_some_and(|node| node.acts);
            let reached = window.reached(&self.strangers(mesh, &window), acted);
            if reached.is_sure {
                break (window, reached.nodes);
            }
            (core, reach) = (reached.nodes, reach + WINDOW_RINGS / 2);
        };
        self.take_over(mesh, outline, &window, &reached, rewritten, stale);
    }

    /// Returns the nodes of triangles that came to the band or left it, in the sure part of a window.
    fn strangers(&self, mesh: &Mesh, window: &Window) -> Vec<NodeId> {
        let is_stranger = |id: &TriangleId| {
            let key = id.index() as u32;
            let is_in_band = window.numbers_of_triangles.contains_key(&key);
            let was_in_band = self.places.get(&key).is_some_and(|place| !self.triangles[place].is_beside);
            is_in_band != was_in_band
        };
        let strangers = window.triangles.iter().filter(|id| is_stranger(id));
        let nodes = strangers.flat_map(|&id| mesh.triangle(id).vertices);
        nodes.filter(|&node| window.is_sure(node)).collect()
    }

    /// Takes the nodes that were reached, and the triangles around them, from a window.
    fn take_over(
        &mut self,
        mesh: &Mesh,
        outline: &Outline,
        window: &Window,
        reached: &[NodeId],
        rewritten: &mut Vec<TriangleId>,
        stale: &mut Vec<Place>,
    ) {
        let fitted = &window.fitted;
        let mut writer = Writer::new(mesh, fitted, outline);
        let mut is_written = NumberMap::<u32, u32>::default();
        for &node in reached {
            if window.number_of(node).is_none() {
                stale.push(node_place(mesh.node(node)));
            }
            for id in mesh.all_triangles_around(node) {
                if !is_written.set(id.index(), 0) {
                    continue;
                }
                rewritten.push(id);
                if let Some(place) = self.places.remove(&(id.index() as u32)) {
                    let kept = self.triangles.remove(&place).expect("it was kept");
                    stale.extend(kept.corners.iter().chain(kept.pieces.iter().flatten().flatten()));
                }
                if let Some(t) = window.numbers_of_triangles.get(&(id.index() as u32)) {
                    writer.write(self, *t);
                }
            }
        }
        for &(id, inside) in
            fitted.band.touched.iter().filter(|(id, _)| Numbers::get(&is_written, id.index()).is_some())
        {
            self.write_beside(mesh, id, inside);
        }
        let homes = fitted.band.points.iter().chain(&fitted.placement.homes[fitted.band.points.len()..]);
        let present: NumberMap<Place, ()> = homes.map(|&home| (node_place(home), ())).collect();
        for place in stale.drain(..).filter(|place| !present.contains_key(place)) {
            self.nodes.remove(&place);
        }
    }

    fn write_beside(&mut self, mesh: &Mesh, id: TriangleId, inside: bool) {
        let Some(pieces) = beside(mesh, id, inside) else { return };
        let corners = mesh.corners(id).map(node_place);
        let pieces = pieces.into_iter().map(|piece| piece.map(|node| node_place(mesh.node(node)))).collect();
        let kept = KeptTriangle { id: Some(id), corners, pieces: Some(pieces), is_beside: true };
        self.keep(id, triangle_place(mesh.corners(id)), kept);
    }

    fn keep(&mut self, id: TriangleId, place: Place, triangle: KeptTriangle) {
        self.places.insert(id.index() as u32, place);
        self.triangles.insert(place, triangle);
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
        let mut changed: Vec<(TriangleId, &[[Place; 3]])> =
            self.triangles.values().filter_map(|kept| Some((kept.id?, kept.pieces.as_deref()?))).collect();
        changed.par_sort_unstable_by_key(|(id, _)| *id);
        // A moved node, and each corner of a piece, is the corner of a triangle that is replaced.
        let mut ids = NumberMap::<Place, NodeId>::default();
        for node in changed.iter().flat_map(|&(id, _)| mesh.triangle(id).vertices) {
            ids.insert(node_place(mesh.node(node)), node);
        }
        let kept = |place: &Place| self.nodes.get(place).filter(|node| node.at != node.home);
        let moved = ids.iter().filter_map(|(place, &id)| Some((id, kept(place)?.at)));
        let mut patch = MeshPatch { moved: moved.collect(), ..MeshPatch::default() };
        patch.moved.par_sort_unstable_by_key(|(id, _)| *id);
        for (id, pieces) in changed {
            let (first, level) = (patch.pieces.len(), mesh.triangle(id).level());
            for piece in pieces {
                let corners = piece.map(|place| {
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
    stale: Vec<Place>,
}

impl Entries {
    fn forget(&mut self, kept: &KeptTriangle) {
        self.stale.extend(kept.corners.iter().chain(kept.pieces.iter().flatten().flatten()));
    }
}

/// Writes triangles of a band, with their nodes.
struct Writer<'a> {
    mesh: &'a Mesh,
    fitted: &'a FittedBand,
    outline: &'a Outline<'a>,
    pieces: PiecesByTriangle,
    acted: Vec<bool>,
    is_node_written: Vec<bool>,
    star: Vec<(u32, usize)>,
}

impl<'a> Writer<'a> {
    fn new(mesh: &'a Mesh, fitted: &'a FittedBand, outline: &'a Outline<'a>) -> Self {
        Self {
            pieces: PiecesByTriangle::new(&fitted.band, &fitted.patchwork),
            acted: fitted.acted(),
            is_node_written: vec![false; fitted.patchwork.points.len()],
            star: Vec::new(),
            mesh,
            fitted,
            outline,
        }
    }

    /// Writes a triangle of the band, and its nodes.
    fn write(&mut self, follower: &mut OutlineFollower, triangle: u32) {
        let FittedBand { band, patchwork, placement, .. } = self.fitted;
        let home = |v: u32| node_place(placement.homes[v as usize]);
        let pieces = self.pieces.replacement(self.mesh, band, patchwork, &self.outline.angles, triangle);
        let pieces = pieces.map(|pieces| pieces.into_iter().map(|piece| piece.map(home)).collect());
        let id = band.ids[triangle as usize];
        let corners = band.triangles.corners[triangle as usize];
        let place = triangle_place(self.mesh.corners(id));
        follower.keep(
            id,
            place,
            KeptTriangle { id: Some(id), corners: corners.map(home), pieces, is_beside: false },
        );
        let cuts = placement.cuts[triangle as usize];
        for v in corners.into_iter().chain(cuts).filter(|&v| v != NONE) {
            self.write_node(follower, v);
        }
    }

    fn write_node(&mut self, follower: &mut OutlineFollower, node: u32) {
        let v = node as usize;
        if std::mem::replace(&mut self.is_node_written[v], true) {
            return;
        }
        let FittedBand { patchwork, placement, pins, .. } = self.fitted;
        let pin = pins.binary_search_by_key(&node, |pin| pin.node);
        let kept = KeptNode {
            home: placement.homes[v],
            at: patchwork.points[v],
            acts: self.acted.get(v).is_some_and(|&acts| acts),
            fit: self.fitted.fit_of(self.outline, node, &mut self.star),
            corner_limit: pin.map_or(0.0, |n| pins[n].limit),
        };
        follower.nodes.insert(node_place(kept.home), kept);
    }
}
