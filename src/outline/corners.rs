//! Sharp corners of the outline become nodes.

use std::f64::consts::SQRT_2;

use super::angles::Angles;
use super::band::Band;
use super::flat::has_sector;
use super::snap::Side;
use super::stencil::Placement;
use super::triangulation::NONE;
use crate::domain::{OutlineCorner, RegionOnLattice};
use crate::geometry::LatticePoint;
use crate::mesh::Mesh;

/// The cotangent of 12°, the smallest angle that is accepted beside a corner.
const COT_12: f64 = 4.704_630_109_478_455;
/// The cosine of 30°, the smallest turn of a sharp corner.
const COS_30: f64 = 0.866_025_403_784_438_6;

/// A node at a corner of the outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pin {
    pub(super) node: u32,
    at: LatticePoint,
    /// Where the node would be on the outline otherwise.
    former: LatticePoint,
    /// The cotangent of the smallest angle that is accepted beside it: 12°, or 0.8 times the angle of the corner.
    pub(super) limit: f64,
}

impl Pin {
    /// Puts the node at the corner.
    pub(super) fn apply(&self, placement: &mut Placement) {
        placement.goals[self.node as usize] = self.at;
        placement.pinned[self.node as usize] = true;
    }

    /// Gives the corner up.
    pub(super) fn undo(&self, placement: &mut Placement) {
        placement.goals[self.node as usize] = self.former;
        placement.pinned[self.node as usize] = false;
    }
}

/// A node on the boundary of the domain, with the leg of the triangles there in world units.
struct Candidate {
    point: LatticePoint,
    node: u32,
    leg: f64,
}

/// For each sharp corner of the outline the nearest node on the boundary, if no corner is nearer to that node.
///
/// A corner is sharp if the outline turns there by more than 30° and its edges on both sides are not shorter than
/// a triangle's leg. Where the outline leaves the frame its corner is a node without this: a node of the frame
/// moves along it.
pub(super) fn pins(
    mesh: &Mesh,
    band: &Band,
    placement: &Placement,
    region: &RegionOnLattice,
    angles: &Angles,
) -> Vec<Pin> {
    let extent = mesh.lattice().extent();
    let sides = |p: LatticePoint| [p.x == 0, p.x == extent.x, p.y == 0, p.y == extent.y];
    let on_frame = |p: LatticePoint| sides(p).contains(&true);
    let along_frame = |p, q| sides(p).into_iter().zip(sides(q)).any(|both| both == (true, true));
    let mut candidates = candidates(mesh, band, placement);
    candidates.sort_unstable_by_key(|candidate| (candidate.point, candidate.node));
    let longest = candidates.iter().map(|candidate| candidate.leg).fold(0.0, f64::max);
    let mut found: Vec<(u32, f64, Pin)> = Vec::new();
    for corner in region.outline_corners().filter(|corner| is_sharp(corner, angles)) {
        if along_frame(corner.at, corner.before) || along_frame(corner.at, corner.after) {
            continue;
        }
        // Nodes of the frame stay there.
        let may_move = |candidate: &&Candidate| {
            on_frame(corner.at) || !on_frame(placement.homes[candidate.node as usize])
        };
        let Some((distance, nearest)) = nearest(&candidates, corner.at, longest, angles, may_move) else {
            continue;
        };
        let reaches = |end| angles.vector(corner.at, end).length() >= nearest.leg;
        if distance <= nearest.leg && reaches(corner.before) && reaches(corner.after) {
            let former = placement.goals[nearest.node as usize];
            let pin = Pin { node: nearest.node, at: corner.at, former, limit: limit(&corner, angles) };
            found.push((nearest.node, distance, pin));
        }
    }
    found.sort_by(|a, b| (a.0, a.1, a.2.at).partial_cmp(&(b.0, b.1, b.2.at)).expect("no NaN"));
    found.dedup_by_key(|(node, ..)| *node);
    found.into_iter().map(|(_, _, pin)| pin).collect()
}

fn candidates(mesh: &Mesh, band: &Band, placement: &Placement) -> Vec<Candidate> {
    let mut legs = vec![0.0f64; placement.homes.len()];
    for (t, &id) in band.ids.iter().enumerate() {
        let leg = mesh.diameter(mesh.triangle(id).level()) / SQRT_2;
        let corners = band.triangles.corners[t].iter().filter(|v| placement.sides[**v as usize] == Side::On);
        for &v in corners.chain(placement.cuts[t].iter().filter(|&&v| v != NONE)) {
            legs[v as usize] = legs[v as usize].max(leg);
        }
    }
    let on_boundary = |v: u32| {
        let is_cut = v as usize >= band.points.len();
        is_cut || [true, false].iter().all(|&inside| has_sector(band, placement, v, inside))
    };
    let nodes = (0..legs.len() as u32).filter(|&v| legs[v as usize] > 0.0 && on_boundary(v));
    nodes
        .map(|node| Candidate { point: placement.goals[node as usize], node, leg: legs[node as usize] })
        .collect()
}

/// Whether the outline turns by more than 30°.
fn is_sharp(corner: &OutlineCorner, angles: &Angles) -> bool {
    let (before, after) = (angles.vector(corner.before, corner.at), angles.vector(corner.at, corner.after));
    before.dot(after) < COS_30 * before.length() * after.length()
}

/// The cotangent of the smallest angle that is accepted beside a corner.
fn limit(corner: &OutlineCorner, angles: &Angles) -> f64 {
    let (from, to) = (angles.vector(corner.at, corner.after), angles.vector(corner.at, corner.before));
    let angle = libm::atan2(from.perp_dot(to), from.dot(to));
    // Negative angles are corners of more than 180°.
    if angle > 0.0 { COT_12.max(1.0 / libm::tan(0.8 * angle)) } else { COT_12 }
}

/// The candidate nearest to a point that may move, and its distance, if that is at most `reach`, in world units.
fn nearest<'a>(
    candidates: &'a [Candidate],
    at: LatticePoint,
    reach: f64,
    angles: &Angles,
    may_move: impl Fn(&&'a Candidate) -> bool,
) -> Option<(f64, &'a Candidate)> {
    let steps = (reach / angles.step().x).ceil();
    let first = (f64::from(at.x) - steps).max(0.0) as u32;
    let start = candidates.partition_point(|candidate| candidate.point.x < first);
    let within = candidates[start..].iter().take_while(|c| f64::from(c.point.x) <= f64::from(at.x) + steps);
    let measured =
        within.filter(may_move).map(|candidate| (angles.vector(candidate.point, at).length(), candidate));
    measured.min_by(|a, b| (a.0, a.1.point).partial_cmp(&(b.0, b.1.point)).expect("no NaN"))
}
