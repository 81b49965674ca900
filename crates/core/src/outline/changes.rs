//! Derives the mesh with nodes on the outline from the mesh of right-angled triangles, step by step.

use super::angles::Angles;
use super::band::{Band, signs};
use super::corners::{Pin, pins};
use super::flat::{drop_flat, pinched};
use super::guard::Guard;
use super::patchwork::Patchwork;
use super::smooth::Smoother;
use super::snap::{Crossings, Side, snapped};
use super::stages::{DerivationAction, Watch, without_outside};
use super::stencil::Placement;
use super::triangulation::NONE;
use crate::domain::RegionOnLattice;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::{Mesh, MeshPatch, NodeId, PatchTriangle, TriangleId};

/// Number of rounds of flips and moves that improve the angles.
const ROUNDS: usize = 8;

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
    pub fn new(mesh: &Mesh, region: &RegionOnLattice, watch: Watch<'_>) -> Self {
        let angles = Angles::new(mesh.lattice().step());
        let signs = signs(mesh, region);
        let band = Band::new(mesh, &signs);
        let as_patch = |patchwork: &Patchwork| patch(mesh, &signs, &band, patchwork, &angles);
        let with_cuts = |placement: &Placement| as_patch(&Patchwork::new(&band, placement, &angles));
        watch(DerivationAction::RemoveByCorners, &|| without_outside(mesh, &signs, Vec::new()));
        let mut placement = placed(&band, region, mesh.lattice(), &angles);
        watch(DerivationAction::MoveToOutline, &|| {
            without_outside(mesh, &signs, moved(&band, placement.goals.iter()))
        });
        watch(DerivationAction::CutEdges, &|| with_cuts(&placement));
        let pins = pins(mesh, &band, &placement, region, &angles);
        pins.iter().for_each(|pin| pin.apply(&mut placement));
        watch(DerivationAction::MoveToCorners, &|| with_cuts(&placement));
        let corner_limit = retreat(&band, &mut placement, pins, &angles);
        watch(DerivationAction::Retreat, &|| with_cuts(&placement));
        let mut patchwork = Patchwork::new(&band, &placement, &angles);
        let smoother = Smoother { region, angles: &angles, extent: mesh.lattice().extent() };
        for _ in 0..ROUNDS {
            patchwork.flip_edges(&angles);
            watch(DerivationAction::FlipEdges, &|| as_patch(&patchwork));
            smoother.smooth(&mut patchwork);
            watch(DerivationAction::ShiftNodes, &|| as_patch(&patchwork));
        }
        smoother.pull(&mut patchwork);
        watch(DerivationAction::PullToOutline, &|| as_patch(&patchwork));
        let fit = fit(&patchwork, region, mesh.lattice().extent(), &angles);
        Self { patch: as_patch(&patchwork), fit, corner_limit }
    }
}

/// Returns the nodes of the band that are not at home, in ascending order, with their positions.
fn moved<'a>(band: &Band, positions: impl Iterator<Item = &'a LatticePoint>) -> Vec<(NodeId, LatticePoint)> {
    let nodes = band.node_ids.iter().zip(&band.points).zip(positions);
    let mut moved: Vec<_> =
        nodes.filter(|((_, home), point)| home != point).map(|((&id, _), &point)| (id, point)).collect();
    moved.sort_unstable_by_key(|(id, _)| *id);
    moved
}

/// Moves nodes onto the outline, all at once. Nodes at which the domain would touch itself stay.
fn placed(band: &Band, region: &RegionOnLattice, lattice: &Lattice, angles: &Angles) -> Placement {
    let crossings = Crossings::new(band, region, lattice);
    let (mut sides, mut goals) = snapped(band, &crossings, angles);
    loop {
        let mut placement = Placement::new(band, &crossings, sides.clone(), goals.clone());
        drop_flat(band, &mut placement, angles, angles.limit());
        let pinched = pinched(band, &placement);
        if pinched.is_empty() {
            return placement;
        }
        for v in pinched {
            let v = v as usize;
            (sides[v], goals[v]) = (Side::of(band.inside[v]), band.points[v]);
        }
    }
}

/// Lets nodes retreat where angles are too small. Corners with their nodes, the `pins`, where retreats do not
/// help are given up. Returns the cotangent of the smallest angle that is accepted beside the other corners.
fn retreat(band: &Band, placement: &mut Placement, mut pins: Vec<Pin>, angles: &Angles) -> f64 {
    loop {
        let pin_limits = pins.iter().map(|pin| (pin.node, pin.limit)).collect();
        let stuck = Guard { band, angles, limit: angles.limit(), pin_limits }.run(placement);
        if stuck.is_empty() {
            return pins.iter().map(|pin| pin.limit).fold(0.0, f64::max);
        }
        let (given_up, kept) = pins.into_iter().partition(|pin| stuck.binary_search(&pin.node).is_ok());
        pins = kept;
        let given_up: Vec<_> = given_up;
        given_up.iter().for_each(|pin| pin.undo(placement));
        placement.advance_all();
    }
}

fn fit(patchwork: &Patchwork, region: &RegionOnLattice, extent: LatticePoint, angles: &Angles) -> OutlineFit {
    let mut fit = OutlineFit::default();
    let mut star = Vec::new();
    for (v, &point) in patchwork.points.iter().enumerate() {
        patchwork.triangles.star(v as u32, &mut star);
        // Nodes that lie only along the frame have no triangles outside around them.
        let has_outside = star.iter().any(|&(t, _)| !patchwork.inside[t as usize]);
        if star.is_empty() || !patchwork.is_on_boundary(&star) || !(has_outside || patchwork.on_outline[v]) {
            continue;
        }
        fit.nodes += 1;
        fit.corners += usize::from(patchwork.pinned[v]);
        if patchwork.on_outline[v] {
            fit.on_outline += 1;
        } else {
            fit.farthest = fit.farthest.max(distance(point, region, extent, angles));
        }
    }
    fit
}

/// Returns the distance of a point from the outline, in world units.
///
/// The outline is searched within a lattice step first, then within four times as much, up to more than the
/// diagonal of the lattice. The search finds an edge: a node that can be off the outline is at an edge that
/// the outline crosses, and an edge of the outline along a side of the grid crosses none.
fn distance(point: LatticePoint, region: &RegionOnLattice, extent: LatticePoint, angles: &Angles) -> f64 {
    let (p, step) = (point.as_dvec2(), angles.step());
    let diagonal = (extent.as_dvec2() * step).length();
    let reaches =
        std::iter::successors(Some(step.max_element()), |reach| (*reach <= diagonal).then_some(4.0 * reach));
    let mut nearest = reaches.filter_map(|reach| region.nearest_on_outline(p, reach, step));
    nearest.next().map_or(0.0, |nearest| ((nearest - p) * step).length())
}

/// Collects the differences from the mesh.
fn patch(mesh: &Mesh, signs: &[bool], band: &Band, patchwork: &Patchwork, angles: &Angles) -> MeshPatch {
    let added = patchwork.points[band.points.len()..].to_vec();
    let moved = moved(band, patchwork.points.iter());
    let mut patch = MeshPatch { added, moved, ..MeshPatch::default() };
    let pieces = PiecesByTriangle::new(mesh, band, patchwork);
    for (index, triangle) in mesh.raw_triangles().iter().enumerate() {
        let id = TriangleId::from_index(index);
        let (first, level) = (patch.pieces.len(), triangle.level());
        match pieces.of(id) {
            Some(pieces) if is_unchanged(band, patchwork, !triangle.is_outside(), pieces) => continue,
            Some(pieces) => patch.pieces.extend(pieces.iter().map(|&piece| {
                let corners = longest_edge_first(patchwork, angles, piece);
                PatchTriangle { corners: corners.map(|v| node_id(mesh, band, v)), level }
            })),
            // The triangle is far from the outline, or around a part of it that passes between all nodes.
            None => {
                let inside = signs[triangle.vertices[0].index()];
                if inside != triangle.is_outside() {
                    continue;
                }
                let corners = triangle.edge_nodes().map(|(from, _)| from);
                patch.pieces.extend(inside.then_some(PatchTriangle { corners, level }));
            }
        }
        patch.changed.push((id, first..patch.pieces.len()));
    }
    patch
}

/// The pieces inside of each triangle of the band.
struct PiecesByTriangle {
    /// For each triangle of the mesh, its number in the band, or [`NONE`].
    numbers: Vec<u32>,
    /// For each triangle of the band, the end of its range in `pieces`; the range begins at the end of the
    /// previous one.
    ends: Vec<usize>,
    pieces: Vec<u32>,
}

impl PiecesByTriangle {
    fn new(mesh: &Mesh, band: &Band, patchwork: &Patchwork) -> Self {
        let mut numbers = vec![NONE; mesh.raw_triangle_count()];
        for (t, id) in band.ids.iter().enumerate() {
            numbers[id.index()] = t as u32;
        }
        let inside =
            patchwork.owners.iter().zip(0u32..).filter(|(_, piece)| patchwork.inside[*piece as usize]);
        // Pieces are in the order of their triangles.
        let (owners, pieces): (Vec<u32>, Vec<u32>) = inside.unzip();
        let ends = (0..band.ids.len() as u32).map(|t| owners.partition_point(|&owner| owner <= t)).collect();
        Self { numbers, ends, pieces }
    }

    /// Returns the pieces of a triangle of the mesh, or `None` if it is not in the band.
    fn of(&self, id: TriangleId) -> Option<&[u32]> {
        let t = self.numbers[id.index()] as usize;
        let end = *self.ends.get(t)?;
        let start = if t == 0 { 0 } else { self.ends[t - 1] };
        Some(&self.pieces[start..end])
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
