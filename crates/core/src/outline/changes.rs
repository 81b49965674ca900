//! Derives the mesh with nodes on the outline from the mesh of right-angled triangles, step by step.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::angles::Angles;
use super::band::{Band, BandPlace, GRAIN};
use super::corners::Pin;
use super::fitting::Fitting;
use super::lengths::EdgeTargets;
use super::line::OutlineOnLattice;
use super::patchwork::Patchwork;
use super::stages::Watch;
use super::stencil::NodePlacement;
use crate::domain::RegionOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, MeshPatch, NodeId, PatchTriangle, TriangleId};

/// The fit of the nodes of the boundary to the outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutlineFit {
    /// Number of nodes of the boundary along the outline.
    pub nodes: usize,
    /// Number of these nodes that lie on the outline.
    pub on_outline: usize,
    /// Largest distance of the other nodes from the outline, in world units.
    pub farthest: f64,
    /// Number of sharp corners of the outline that are nodes.
    pub corners: usize,
}

impl OutlineFit {
    /// Returns the fit of the nodes of both.
    pub(super) fn joined(self, other: Self) -> Self {
        Self {
            nodes: self.nodes + other.nodes,
            on_outline: self.on_outline + other.on_outline,
            farthest: self.farthest.max(other.farthest),
            corners: self.corners + other.corners,
        }
    }
}

/// The result of [`OutlineChanges::new`].
pub(super) struct OutlineChanges {
    /// The changes of the mesh.
    pub patch: MeshPatch,
    /// The fit of the boundary to the outline.
    pub fit: OutlineFit,
    /// The cotangent of the smallest angle that is accepted beside a corner of the outline; 0 without
    /// corners.
    pub corner_limit: f64,
}

impl OutlineChanges {
    /// Finds the changes that put the nodes of the boundary on the outline of a region, and tells `watch` of
    /// each stage.
    pub fn new(
        mesh: &Mesh,
        region: &RegionOnLattice,
        targets: Option<EdgeTargets>,
        watch: Watch<'_>,
    ) -> Self {
        let outline = OutlineOnLattice::new(mesh.lattice(), region, targets);
        let fitted = FittedBand::whole(mesh, region, &outline, watch);
        Self::from_fitted(mesh, &outline, &fitted)
    }

    /// Returns the changes of a whole band that was put on an outline.
    pub(super) fn from_fitted(mesh: &Mesh, outline: &OutlineOnLattice, fitted: &FittedBand) -> Self {
        fitted.with_patch(fitted.patch(mesh, outline), outline)
    }
}

/// A band whose nodes are on the outline.
pub(super) struct FittedBand {
    pub(super) band: Band,
    pub(super) patchwork: Patchwork,
    /// The corners of the outline that are nodes.
    pub(super) pins: Vec<Pin>,
    pub(super) placement: NodePlacement,
}

impl FittedBand {
    /// Puts the nodes of the whole band on the outline, and notifies `watch` of each stage.
    pub(super) fn whole(
        mesh: &Mesh,
        region: &RegionOnLattice,
        outline: &OutlineOnLattice,
        watch: Watch<'_>,
    ) -> Self {
        let band = Band::new(mesh, region);
        let zone = vec![true; band.points.len()];
        Self::new(mesh, band, zone, outline, watch)
    }

    /// Puts the nodes of a band on the outline, and notifies `watch` of each stage. Beginning with the
    /// retreat, only nodes of the `zone` are moved and only edges near them flipped.
    pub(super) fn new(
        mesh: &Mesh,
        band: Band,
        zone: Vec<bool>,
        outline: &OutlineOnLattice,
        watch: Watch<'_>,
    ) -> Self {
        let mut fitting = Fitting::new(band, zone);
        loop {
            match fitting.advance(mesh, outline, watch) {
                ControlFlow::Continue(next) => fitting = next,
                ControlFlow::Break(fitted) => return fitted,
            }
        }
    }

    /// Returns the differences from the mesh.
    pub(super) fn patch(&self, mesh: &Mesh, outline: &OutlineOnLattice) -> MeshPatch {
        patch(mesh, &self.band, &self.patchwork, &outline.angles)
    }

    /// Returns the changes, given the differences from the mesh.
    pub(super) fn with_patch(&self, patch: MeshPatch, outline: &OutlineOnLattice) -> OutlineChanges {
        let corner_limit = self.pins.iter().map(|pin| pin.limit).fold(0.0, f64::max);
        OutlineChanges { patch, fit: self.fit(outline), corner_limit }
    }

    /// Returns the fit of all nodes.
    fn fit(&self, outline: &OutlineOnLattice) -> OutlineFit {
        let all = (0..self.patchwork.points.len() as u32).into_par_iter().with_min_len(GRAIN);
        let fits = all.map_init(Vec::new, |star, v| self.fit_of(outline, v, star));
        fits.reduce(OutlineFit::default, OutlineFit::joined)
    }

    /// Returns the fit of one node: of none, if it is not on the boundary.
    pub(super) fn fit_of(
        &self,
        outline: &OutlineOnLattice,
        node: u32,
        star: &mut Vec<(u32, usize)>,
    ) -> OutlineFit {
        let (patchwork, v) = (&self.patchwork, node as usize);
        patchwork.triangles.star(node, star);
        // Nodes that lie only along the frame have no triangles outside around them.
        let has_outside = star.iter().any(|&(t, _)| !patchwork.inside[t as usize]);
        let on_outline = patchwork.on_outline[v];
        if star.is_empty() || !patchwork.is_on_boundary(star) || !(has_outside || on_outline) {
            return OutlineFit::default();
        }
        OutlineFit {
            nodes: 1,
            on_outline: usize::from(on_outline),
            farthest: if on_outline { 0.0 } else { distance(patchwork.points[v], outline) },
            corners: usize::from(patchwork.pinned[v]),
        }
    }

    /// Returns, for each node of the band, whether a step that depends on steps nearby did or tried anything
    /// at it or in an edge of it.
    pub(super) fn acted(&self) -> Vec<bool> {
        let mut acted = self.patchwork.acted[..self.band.points.len()].to_vec();
        let added = self.band.points.len() as u32..self.patchwork.acted.len() as u32;
        for v in added.filter(|&v| self.patchwork.acted[v as usize]) {
            for end in self.ends_of(v) {
                let ends = self.placement.band_nodes_at(&self.band, end);
                ends.into_iter().for_each(|v| acted[v as usize] = true);
            }
        }
        acted
    }

    /// Returns the ends of the divided edge whose middle a node is; the node itself, if it is none.
    fn ends_of(&self, node: u32) -> [u32; 2] {
        let middle = (node as usize).checked_sub(self.placement.homes.len());
        middle.map_or([node; 2], |middle| self.patchwork.divided[middle])
    }

    /// Returns the position of a node on the mesh: of one in a cut or divided edge, the middle of that.
    pub(super) fn home(&self, node: u32) -> LatticePoint {
        self.placement.home_of_middle(self.ends_of(node))
    }
}

/// Returns the nodes of the band that are not at home, in ascending order, with their positions.
pub(super) fn moved<'a>(
    band: &Band,
    positions: impl Iterator<Item = &'a LatticePoint>,
) -> Vec<(NodeId, LatticePoint)> {
    let nodes = band.node_ids.iter().zip(&band.points).zip(positions);
    let mut moved: Vec<_> =
        nodes.filter(|((_, home), point)| home != point).map(|((&id, _), &point)| (id, point)).collect();
    moved.sort_unstable_by_key(|(id, _)| *id);
    moved
}

/// Returns the distance of a point from the outline, in world units.
///
/// The outline is searched within a lattice step first, then within four times as much, up to more than the
/// diagonal of the lattice. The search finds an edge: a node that can be off the outline is at an edge that
/// the outline crosses, and an edge of the outline along a side of the grid crosses none.
fn distance(point: LatticePoint, outline: &OutlineOnLattice) -> f64 {
    let (p, step) = (point.as_dvec2(), outline.angles.step());
    let diagonal = (outline.lattice.extent().as_dvec2() * step).length();
    let reaches =
        std::iter::successors(Some(step.max_element()), |reach| (*reach <= diagonal).then_some(4.0 * reach));
    let mut nearest = reaches.filter_map(|reach| outline.region.nearest_on_outline(p, reach, step));
    nearest.next().map_or(0.0, |nearest| ((nearest - p) * step).length())
}

/// Collects the differences from the mesh.
pub(super) fn patch(mesh: &Mesh, band: &Band, patchwork: &Patchwork, angles: &Angles) -> MeshPatch {
    let added = patchwork.points[band.points.len()..].to_vec();
    let moved = moved(band, patchwork.points.iter());
    let mut places = band.triangles_by_id();
    places.par_sort_unstable_by_key(|(id, _)| *id);
    let pieces = PiecesByTriangle::new(band, patchwork);
    let in_band = |t: u32| pieces.replacement(mesh, band, patchwork, angles, t);
    let found = places.into_par_iter().with_min_len(GRAIN).filter_map(|(id, place)| match place {
        BandPlace::InBand(t) => {
            let corners = |(_, corners): (u32, [u32; 3])| corners.map(|v| node_id(mesh, band, v));
            Some((id, in_band(t)?.into_iter().map(corners).collect()))
        }
        BandPlace::Beside { inside } => Some((id, beside(mesh, id, inside)?)),
    });
    let found: Vec<(TriangleId, Vec<[NodeId; 3]>)> = found.collect();
    let mut patch = MeshPatch { added, moved, ..MeshPatch::default() };
    for (id, pieces) in found {
        let (first, level) = (patch.pieces.len(), mesh.triangle(id).level());
        patch.pieces.extend(pieces.into_iter().map(|corners| PatchTriangle { corners, level }));
        patch.changed.push((id, first..patch.pieces.len()));
    }
    patch
}

/// Returns what replaces a triangle that the outline touches beside the band, if its centroid is on the other
/// side than its nodes.
pub(super) fn beside(mesh: &Mesh, id: TriangleId, inside: bool) -> Option<Vec<[NodeId; 3]>> {
    let corners = || mesh.triangle(id).edge_nodes().map(|(from, _)| from);
    (inside != mesh.is_in_domain(id)).then(|| inside.then(corners).into_iter().collect())
}

/// The pieces inside of each triangle of the band.
pub(super) struct PiecesByTriangle {
    /// For each triangle of the band, the end of its range in `pieces`; the range begins at the end of the
    /// previous one.
    ends: Vec<u32>,
    pieces: Vec<u32>,
}

impl PiecesByTriangle {
    pub(super) fn new(band: &Band, patchwork: &Patchwork) -> Self {
        let inside = (0..patchwork.owners.len() as u32).filter(|&piece| patchwork.inside[piece as usize]);
        let (mut ends, pieces) = (vec![0; band.ids.len()], inside.collect::<Vec<u32>>());
        // Pieces are in the order of their triangles.
        for (end, &piece) in (1..).zip(&pieces) {
            ends[patchwork.owners[piece as usize] as usize] = end;
        }
        let mut last = 0;
        for end in &mut ends {
            last = last.max(*end);
            *end = last;
        }
        Self { ends, pieces }
    }

    /// Returns the pieces that replace a triangle of the band, with their nodes; `None` if it stays as it is.
    pub(super) fn replacement(
        &self,
        mesh: &Mesh,
        band: &Band,
        patchwork: &Patchwork,
        angles: &Angles,
        triangle: u32,
    ) -> Option<Vec<(u32, [u32; 3])>> {
        let (pieces, in_domain) = (self.of(triangle), mesh.is_in_domain(band.ids[triangle as usize]));
        let corners = |&piece: &u32| (piece, longest_edge_first(patchwork, angles, piece));
        (!is_unchanged(band, patchwork, in_domain, pieces)).then(|| pieces.iter().map(corners).collect())
    }

    /// Returns the pieces of a triangle of the band.
    fn of(&self, triangle: u32) -> &[u32] {
        let t = triangle as usize;
        let start = if t == 0 { 0 } else { self.ends[t - 1] };
        &self.pieces[start as usize..self.ends[t] as usize]
    }
}

/// Returns whether the pieces of a triangle are equal to the triangle of the mesh.
fn is_unchanged(band: &Band, patchwork: &Patchwork, in_domain: bool, pieces: &[u32]) -> bool {
    let &[piece] = pieces else { return pieces.is_empty() && !in_domain };
    let owner = patchwork.owners[piece as usize];
    let corners = patchwork.triangles.corners[piece as usize];
    let is_at_home = |&v: &u32| band.points.get(v as usize) == Some(&patchwork.points[v as usize]);
    let same = band.triangles.corners[owner as usize].iter().all(|v| corners.contains(v));
    in_domain && same && corners.iter().all(is_at_home)
}

/// Returns the corners of a piece, anticlockwise, beginning with the two ends of its longest edge.
fn longest_edge_first(patchwork: &Patchwork, angles: &Angles, piece: u32) -> [u32; 3] {
    let turned = [0, 1, 2].map(|i| patchwork.triangles.starting_at(piece, i));
    let length = |[a, b, _]: [u32; 3]| {
        angles.vector(patchwork.points[a as usize], patchwork.points[b as usize]).length_squared()
    };
    turned.into_iter().reduce(|a, b| if length(b) > length(a) { b } else { a }).expect("three edges")
}

/// Returns the node of the mesh, or the added node, that has this number in the band.
fn node_id(mesh: &Mesh, band: &Band, v: u32) -> NodeId {
    let added = |v: usize| NodeId::from_index(mesh.raw_nodes().len() + v - band.points.len());
    band.node_ids.get(v as usize).copied().unwrap_or_else(|| added(v as usize))
}
