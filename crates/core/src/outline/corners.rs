//! Turns sharp corners of the outline into nodes.

use std::f64::consts::SQRT_2;

use glam::DVec2;

use super::angles::Angles;
use super::band::Band;
use super::flat::has_sector;
use super::snap::Side;
use super::stencil::Placement;
use super::triangulation::NONE;
use crate::domain::RegionOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::Mesh;

/// The cotangent of 12°, the smallest angle that is accepted beside a corner.
const COT_12: f64 = 4.704_630_109_478_455;
/// The cosine of 30°, the smallest turn of a sharp corner.
const COS_30: f64 = 0.866_025_403_784_438_6;
/// Smallest ratio of a chord to the length of outline along it for which the outline counts as nearly
/// straight.
const STRAIGHT: f64 = 0.97;

/// A node at a corner of the outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pin {
    pub(super) node: u32,
    at: LatticePoint,
    /// The position of the node on the outline without the pin.
    former: LatticePoint,
    /// The cotangent of the smallest angle that is accepted beside the pin: 12°, or 0.8 times the angle of
    /// the corner.
    pub(super) limit: f64,
}

impl Pin {
    /// Moves the node to the corner.
    pub(super) fn apply(&self, placement: &mut Placement) {
        placement.goals[self.node as usize] = self.at;
        placement.pinned[self.node as usize] = true;
    }

    /// Moves the node back to its former position.
    pub(super) fn undo(&self, placement: &mut Placement) {
        placement.goals[self.node as usize] = self.former;
        placement.pinned[self.node as usize] = false;
    }
}

/// A node on the boundary of the domain, with the leg of its triangles in world units.
struct Candidate {
    point: LatticePoint,
    node: u32,
    leg: f64,
}

/// A corner of the outline, given by the index of a point in a ring.
#[derive(Clone, Copy)]
struct Corner<'a> {
    ring: &'a [LatticePoint],
    place: usize,
}

impl<'a> Corner<'a> {
    fn at(self) -> LatticePoint {
        self.ring[self.place]
    }

    /// Returns the next corner along the outline, or the previous one.
    fn next(self, forwards: bool) -> Self {
        let step = if forwards { 1 } else { self.ring.len() - 1 };
        Self { place: (self.place + step) % self.ring.len(), ..self }
    }

    /// Returns the vector from the corner along the outline to the first corner that is at least `reach` away
    /// along it, if the outline is nearly straight up to there.
    fn side(self, forwards: bool, reach: f64, angles: &Angles) -> Option<DVec2> {
        let (mut end, mut length) = (self.next(forwards), 0.0);
        let mut last = self;
        loop {
            length += angles.vector(last.at(), end.at()).length();
            let chord = angles.vector(self.at(), end.at());
            if end.place == self.place || chord.length() < STRAIGHT * length {
                return None;
            }
            if length >= reach {
                return Some(chord);
            }
            (last, end) = (end, end.next(forwards));
        }
    }

    /// Returns the cotangent of the smallest angle that is accepted beside the corner, if it is sharp: if the
    /// outline is nearly straight on both sides, for the leg of a triangle, and turns by more than 30°.
    fn limit_if_sharp(self, leg: f64, angles: &Angles) -> Option<f64> {
        let (to, from) = (self.side(false, leg, angles)?, self.side(true, leg, angles)?);
        if -to.dot(from) >= COS_30 * to.length() * from.length() {
            return None;
        }
        let angle = libm::atan2(from.perp_dot(to), from.dot(to));
        // Negative angles are corners of more than 180°.
        Some(if angle > 0.0 { COT_12.max(1.0 / libm::tan(0.8 * angle)) } else { COT_12 })
    }

    /// Returns whether the outline turns by more than 30° at the corner itself.
    fn turns(self, angles: &Angles) -> bool {
        let [before, after] =
            [false, true].map(|forwards| angles.vector(self.at(), self.next(forwards).at()));
        -before.dot(after) < COS_30 * before.length() * after.length()
    }
}

/// Returns, for each sharp corner of the outline, the nearest node on the boundary, if no other corner is
/// nearer to that node.
///
/// Where the outline leaves the frame, its corner is a node anyway: a node of the frame moves along the
/// frame.
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
    let candidates = candidates(mesh, band, placement);
    let longest = candidates.iter().map(|candidate| candidate.leg).fold(0.0, f64::max);
    let rings = region.outline_rings();
    let corners = rings.iter().flat_map(|ring| (0..ring.len()).map(|place| Corner { ring, place }));
    let mut found: Vec<(u32, f64, Pin)> = Vec::new();
    for corner in corners.filter(|corner| corner.turns(angles)) {
        let at = corner.at();
        if [false, true].into_iter().any(|forwards| along_frame(at, corner.next(forwards).at())) {
            continue;
        }
        // Nodes of the frame stay there.
        let may_move =
            |candidate: &&Candidate| on_frame(at) || !on_frame(placement.homes[candidate.node as usize]);
        let Some((distance, nearest)) = nearest(&candidates, at, longest, angles, may_move) else { continue };
        let limit = corner.limit_if_sharp(nearest.leg, angles).filter(|_| distance <= nearest.leg);
        found.extend(limit.map(|limit| {
            let former = placement.goals[nearest.node as usize];
            (nearest.node, distance, Pin { node: nearest.node, at, former, limit })
        }));
    }
    found.sort_by(|a, b| (a.0, a.1, a.2.at).partial_cmp(&(b.0, b.1, b.2.at)).expect("no NaN"));
    found.dedup_by_key(|(node, ..)| *node);
    found.into_iter().map(|(_, _, pin)| pin).collect()
}

/// Returns the nodes on the boundary, sorted by their present positions; [`nearest`] relies on this order.
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
    let mut candidates: Vec<Candidate> = nodes
        .map(|node| Candidate { point: placement.goals[node as usize], node, leg: legs[node as usize] })
        .collect();
    candidates.sort_unstable_by_key(|candidate| (candidate.point, candidate.node));
    candidates
}

/// Returns, of the candidates that may move and are at most `reach` away along x (in world units), the
/// nearest one to a point, with its distance. The candidates must be sorted by their points.
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
