//! Turns sharp corners of the outline into nodes.

use std::f64::consts::SQRT_2;

use glam::DVec2;
use rayon::prelude::*;

use super::angles::Angles;
use super::band::{Band, GRAIN};
use super::flat::has_sector;
use super::snap::OutlineSide;
use super::stencil::NodePlacement;
use super::triangulation::NONE;
use crate::domain::{COS_30, RegionOnLattice};
use crate::geometry::LatticePoint;
use crate::mesh::Mesh;

/// The cotangent of 12°, the smallest angle that is accepted beside a corner.
const COT_12: f64 = 4.704_630_109_478_455;
/// A node that moves to a corner is at most a leg away from it, after it moved to the outline by at most half
/// an edge. This many legs allow for an adjacent triangle that is one level coarser.
const CORNER_LEGS: f64 = 2.5;
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
    pub(super) fn apply(&self, placement: &mut NodePlacement) {
        placement.goals[self.node as usize] = self.at;
        placement.pinned[self.node as usize] = true;
    }

    /// Moves the node back to its former position.
    pub(super) fn undo(&self, placement: &mut NodePlacement) {
        placement.goals[self.node as usize] = self.former;
        placement.pinned[self.node as usize] = false;
        placement.acted[self.node as usize] = true;
    }
}

/// A node on the boundary of the domain, with the leg of its triangles in world units.
struct CornerCandidate {
    point: LatticePoint,
    node: u32,
    leg: f64,
}

/// The corners at which an outline turns by more than 30°, but for those along the sides of the grid.
#[derive(Clone, Debug)]
pub(super) struct TurningCorners {
    rings: Vec<Vec<LatticePoint>>,
    /// Sorted by their rows, and in a row by their points, each with the number of its ring and its place
    /// there.
    turning: Vec<(LatticePoint, [u32; 2])>,
    /// Points whose y is the same without this many last bits are in one row. There are about as many rows as
    /// corners in a row.
    row_bits: u32,
    /// The upper right corner of the lattice.
    extent: LatticePoint,
}

impl TurningCorners {
    pub(super) fn new(region: &RegionOnLattice, extent: LatticePoint, angles: &Angles) -> Self {
        let rings = region.outline_rings();
        let along_frame =
            |p, q| on_sides(p, extent).into_iter().zip(on_sides(q, extent)).any(|both| both == (true, true));
        let all = rings.par_iter().enumerate().flat_map_iter(|(n, ring)| {
            let corners = (0..ring.len()).map(move |place| RingCorner { ring, place });
            corners.filter(|corner| corner.turns(angles)).map(move |corner| (n, corner))
        });
        let is_free = |(_, corner): &(usize, RingCorner)| {
            ![false, true].into_iter().any(|forwards| along_frame(corner.at(), corner.next(forwards).at()))
        };
        let all = all.filter(is_free).map(|(n, corner)| (corner.at(), [n as u32, corner.place as u32]));
        let mut turning: Vec<_> = all.collect();
        let row_bits = (extent.y / turning.len().isqrt().max(1) as u32).max(1).ilog2();
        turning.par_sort_unstable_by_key(|&(point, place)| (point.y >> row_bits, point, place));
        Self { rings, turning, row_bits, extent }
    }

    /// Marks the nodes at a sharp corner near which a node acted: what acted decides which of them goes to
    /// the corner.
    pub(super) fn spread_actions(
        &self,
        mesh: &Mesh,
        band: &Band,
        placement: &mut NodePlacement,
        angles: &Angles,
    ) {
        let all = (0..band.points.len() as u32).into_par_iter().with_min_len(GRAIN);
        let acted = all.filter(|&v| placement.acted[v as usize]);
        let at_corners =
            acted.flat_map_iter(|v| self.nodes_at_corners_near(mesh, band, placement, angles, v));
        let at_corners: Vec<u32> = at_corners.collect();
        at_corners.into_iter().for_each(|v| placement.acted[v as usize] = true);
    }

    /// Returns the nodes at the outline around each corner near a node that may count as sharp.
    fn nodes_at_corners_near(
        &self,
        mesh: &Mesh,
        band: &Band,
        placement: &NodePlacement,
        angles: &Angles,
        node: u32,
    ) -> Vec<u32> {
        let mut star = Vec::new();
        band.triangles.star(node, &mut star);
        let levels = star.iter().map(|&(t, _)| mesh.triangle(band.ids[t as usize]).level());
        let Some(level) = levels.min() else { return Vec::new() };
        // Those of triangles beside this one, too.
        let legs = [-2, -1, 0, 1, 2].map(|n| mesh.diameter(level.saturating_add_signed(n)) / SQRT_2);
        let reach = CORNER_LEGS * legs[2];
        let is_sharp =
            |&at: &[u32; 2]| legs.iter().any(|&leg| self.corner(at).limit_if_sharp(leg, angles).is_some());
        let corners = self.within(band.points[node as usize], reach, angles).filter(is_sharp);
        let corners: Vec<LatticePoint> = corners.map(|place| self.corner(place).at()).collect();
        if corners.is_empty() {
            return Vec::new();
        }
        // Nodes are sorted by their points.
        let steps = 2.0 * (reach / angles.step().x).ceil();
        let x = f64::from(band.points[node as usize].x);
        let [first, last] = [(x - steps).max(0.0) as u32, (x + steps) as u32];
        let first = band.points.partition_point(|point| point.x < first) as u32;
        let strip = (first..).zip(&band.points[first as usize..]).take_while(|(_, point)| point.x <= last);
        let is_near =
            |point: LatticePoint| corners.iter().any(|&at| angles.vector(at, point).length() <= reach);
        let near = strip.filter(|(_, point)| is_near(**point)).map(|(v, _)| v);
        near.filter(|&v| placement.is_at_outline(band, v, &mut star)).collect()
    }

    fn corner(&self, [ring, place]: [u32; 2]) -> RingCorner<'_> {
        RingCorner { ring: &self.rings[ring as usize], place: place as usize }
    }

    /// Returns the corners at most so far from a point, in world units.
    fn within(&self, at: LatticePoint, reach: f64, angles: &Angles) -> impl Iterator<Item = [u32; 2]> {
        let angles = *angles;
        let steps = (reach / angles.step()).ceil();
        let [first, last] = [at.as_dvec2() - steps, at.as_dvec2() + steps];
        // Conversions saturate.
        let rows = (first.y as u32) >> self.row_bits..=(last.y as u32) >> self.row_bits;
        let rows = rows.flat_map(move |row| {
            let key = (row, first.x as u32);
            let start = self.turning.partition_point(|(point, _)| (point.y >> self.row_bits, point.x) < key);
            let is_in_strip = move |(point, _): &&(LatticePoint, [u32; 2])| {
                point.y >> self.row_bits == row && f64::from(point.x) <= last.x
            };
            self.turning[start..].iter().take_while(is_in_strip)
        });
        let near = rows.filter(move |(point, _)| angles.vector(*point, at).length() <= reach);
        near.map(|(_, place)| *place)
    }

    /// Returns the corners that are within the leg of a candidate, in the order of the outline.
    fn near(&self, candidates: &[CornerCandidate], angles: &Angles) -> Vec<RingCorner<'_>> {
        let near = candidates.par_iter().with_min_len(GRAIN);
        let near = near.flat_map_iter(|candidate| self.within(candidate.point, candidate.leg, angles));
        let mut near: Vec<[u32; 2]> = near.collect();
        near.par_sort_unstable();
        near.dedup();
        near.into_iter().map(|place| self.corner(place)).collect()
    }
}

/// Returns on which sides of the grid a point lies.
fn on_sides(p: LatticePoint, extent: LatticePoint) -> [bool; 4] {
    [p.x == 0, p.x == extent.x, p.y == 0, p.y == extent.y]
}

/// A corner of the outline, given by the index of a point in a ring.
#[derive(Clone, Copy)]
struct RingCorner<'a> {
    ring: &'a [LatticePoint],
    place: usize,
}

impl<'a> RingCorner<'a> {
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
    placement: &NodePlacement,
    corners: &TurningCorners,
    angles: &Angles,
) -> Vec<Pin> {
    let on_frame = |p: LatticePoint| on_sides(p, corners.extent).contains(&true);
    let candidates = candidates(mesh, band, placement);
    let longest = candidates.iter().map(|candidate| candidate.leg).fold(0.0, f64::max);
    let pin = |corner: &RingCorner| {
        let at = corner.at();
        // Nodes of the frame stay there.
        let may_move = |candidate: &&CornerCandidate| {
            on_frame(at) || !on_frame(placement.homes[candidate.node as usize])
        };
        let (distance, nearest) = nearest(&candidates, at, longest, angles, may_move)?;
        let limit = corner.limit_if_sharp(nearest.leg, angles).filter(|_| distance <= nearest.leg)?;
        let former = placement.goals[nearest.node as usize];
        Some((nearest.node, distance, Pin { node: nearest.node, at, former, limit }))
    };
    let corners = corners.near(&candidates, angles);
    let mut found: Vec<(u32, f64, Pin)> = corners.par_iter().with_min_len(GRAIN).filter_map(pin).collect();
    found.sort_by(|a, b| (a.0, a.1, a.2.at).partial_cmp(&(b.0, b.1, b.2.at)).expect("no NaN"));
    found.dedup_by_key(|(node, ..)| *node);
    found.into_iter().map(|(_, _, pin)| pin).collect()
}

/// Returns the nodes on the boundary, sorted by their present positions; [`nearest`] relies on this order.
fn candidates(mesh: &Mesh, band: &Band, placement: &NodePlacement) -> Vec<CornerCandidate> {
    let mut legs = vec![0.0f64; placement.homes.len()];
    for (t, &id) in band.ids.iter().enumerate() {
        let leg = mesh.diameter(mesh.triangle(id).level()) / SQRT_2;
        let corners =
            band.triangles.corners[t].iter().filter(|v| placement.sides[**v as usize] == OutlineSide::On);
        for &v in corners.chain(placement.cuts[t].iter().filter(|&&v| v != NONE)) {
            legs[v as usize] = legs[v as usize].max(leg);
        }
    }
    let on_boundary = |v: u32| {
        let is_cut = v as usize >= band.points.len();
        is_cut || [true, false].iter().all(|&inside| has_sector(band, placement, v, inside))
    };
    let all = (0..legs.len() as u32).into_par_iter().with_min_len(GRAIN);
    let mut candidates: Vec<CornerCandidate> = all
        .filter(|&v| legs[v as usize] > 0.0 && on_boundary(v))
        .map(|node| CornerCandidate { point: placement.goals[node as usize], node, leg: legs[node as usize] })
        .collect();
    candidates.par_sort_unstable_by_key(|candidate| (candidate.point, candidate.node));
    candidates
}

/// Returns, of the candidates that may move and are at most `reach` away along x (in world units), the
/// nearest one to a point, with its distance. The candidates must be sorted by their points.
fn nearest<'a>(
    candidates: &'a [CornerCandidate],
    at: LatticePoint,
    reach: f64,
    angles: &Angles,
    may_move: impl Fn(&&'a CornerCandidate) -> bool,
) -> Option<(f64, &'a CornerCandidate)> {
    let steps = (reach / angles.step().x).ceil();
    let first = (f64::from(at.x) - steps).max(0.0) as u32;
    let start = candidates.partition_point(|candidate| candidate.point.x < first);
    let within = candidates[start..].iter().take_while(|c| f64::from(c.point.x) <= f64::from(at.x) + steps);
    let measured =
        within.filter(may_move).map(|candidate| (angles.vector(candidate.point, at).length(), candidate));
    measured.min_by(|a, b| (a.0, a.1.point).partial_cmp(&(b.0, b.1.point)).expect("no NaN"))
}
