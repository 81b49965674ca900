//! The pieces of the triangles near the outline, whose nodes and edges are improved.

use rayon::prelude::*;

use super::angles::{Angles, COT_5, COT_30};
use super::band::{Band, GRAIN};
use super::flat::{boundary_edges, has_sector};
use super::lengths::LengthAnswers;
use super::line::OutlineOnLattice;
use super::stencil::NodePlacement;
use super::triangulation::{NONE, Triangulation};
use crate::geometry::{LatticePoint, NumberSet};

/// Number of passes in which edges are flipped.
const PASSES: usize = 6;
/// Triangles of the band that a thread divides at a time.
const CHUNK: u32 = 1 << 12;

/// The condition for a piece outside to be flat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Gap {
    /// The piece may be flat: nothing comes too close across it.
    Harmless,
    /// The angle at this node must not be small: it lies between two edges of the boundary.
    Angle(u32),
    /// None of the angles may be small.
    Full,
}

impl Gap {
    /// Returns the condition for a triangle with all corners on the outline. `boundary` has, for each corner,
    /// whether the opposite edge is on the boundary, and `used` whether a triangle inside has the corner.
    pub(super) fn between(corners: [u32; 3], boundary: [bool; 3], used: [bool; 3]) -> Self {
        let place = |wanted| boundary.iter().position(|&is| is == wanted).expect("counted");
        match boundary.iter().filter(|&&is| is).count() {
            0 => Self::Harmless,
            1 if !used[place(true)] => Self::Harmless,
            2 => Self::Angle(corners[place(false)]),
            _ => Self::Full,
        }
    }

    /// Returns whether a triangle with these corners at these points satisfies the condition.
    pub(super) fn is_open(self, angles: &Angles, corners: [u32; 3], points: [LatticePoint; 3]) -> bool {
        match self {
            Self::Harmless => true,
            Self::Angle(node) => {
                let i = corners.iter().position(|&v| v == node).expect("a corner of the triangle");
                angles.is_open(points[i], points[(i + 1) % 3], points[(i + 2) % 3])
            }
            Self::Full => angles.worst(points) <= COT_5,
        }
    }
}

/// Pieces inside and outside, which together cover the band.
pub(super) struct Patchwork {
    pub(super) triangles: Triangulation,
    /// For each piece, whether it is inside.
    pub(super) inside: Vec<bool>,
    /// The conditions of flat pieces outside; without meaning for pieces inside.
    gaps: Vec<Gap>,
    /// For each piece, the triangle of the band that it replaces. A flip keeps the owners of the two pieces.
    pub(super) owners: Vec<u32>,
    /// The nodes of the band, then the nodes in cut edges, then the middles of divided edges.
    pub(super) points: Vec<LatticePoint>,
    /// The ends of each divided edge.
    pub(super) divided: Vec<[u32; 2]>,
    /// For each node, whether it was moved onto the outline.
    pub(super) on_outline: Vec<bool>,
    /// For each node, whether it is at a corner of the outline.
    pub(super) pinned: Vec<bool>,
    /// For each node, what [`NodePlacement::acted`] says, with the steps since.
    pub(super) acted: Vec<bool>,
    /// For each node, whether steps that move nodes and flip edges do so at it.
    pub(super) zone: Vec<bool>,
    /// For each node, whether anything around it changed since the last search for a better position failed.
    pub(super) may_move: Vec<bool>,
    /// For each piece, whether anything changed since the last search for a flip of its edges failed.
    may_flip: Vec<bool>,
    /// The pieces inside that have an angle below 30°, in ascending order, but for changes since.
    poor: Vec<u32>,
    /// Pieces that have changed since `poor` was found.
    changed: Vec<u32>,
}

/// The pieces of some triangles of the band, in their order.
#[derive(Default)]
pub(super) struct BandPieces {
    corners: Vec<[u32; 3]>,
    inside: Vec<bool>,
    owners: Vec<u32>,
    gaps: Vec<Gap>,
}

impl BandPieces {
    /// Divides all triangles of a band.
    fn new(band: &Band, placement: &NodePlacement, angles: &Angles) -> Self {
        let count = band.triangles.len() as u32;
        let chunks = (0..count.div_ceil(CHUNK)).into_par_iter().map(|n| {
            let mut pieces = Self::default();
            (CHUNK * n..count.min(CHUNK * (n + 1))).for_each(|t| pieces.push(band, placement, angles, t));
            pieces
        });
        let mut all = Self::default();
        for mut pieces in chunks.collect::<Vec<_>>() {
            all.corners.append(&mut pieces.corners);
            all.inside.append(&mut pieces.inside);
            all.owners.append(&mut pieces.owners);
            all.gaps.append(&mut pieces.gaps);
        }
        all
    }

    fn push(&mut self, band: &Band, placement: &NodePlacement, angles: &Angles, triangle: u32) {
        let mut gap_of_triangle = None;
        for piece in placement.pieces(band, triangle, angles).into_iter().flatten() {
            let gap = *gap_of_triangle.get_or_insert_with(|| gap(band, placement, triangle));
            self.add(piece.corners, piece.inside, triangle, gap);
        }
    }

    /// Adds a piece of a triangle of the band, after those of former triangles.
    pub(super) fn add(&mut self, corners: [u32; 3], inside: bool, owner: u32, gap: Gap) {
        self.corners.push(corners);
        self.inside.push(inside);
        self.owners.push(owner);
        self.gaps.push(gap);
    }

    /// Finds the pieces across the edges: other pieces of the same triangle, or of those across its edges.
    fn across(&self, band: &Band) -> Vec<[u32; 3]> {
        let mut first = vec![self.owners.len() as u32; band.triangles.len() + 1];
        for (piece, &owner) in self.owners.iter().enumerate().rev() {
            first[owner as usize] = piece as u32;
        }
        let pieces_of = |t: u32| first[t as usize]..first[t as usize + 1];
        let find = |among: std::ops::Range<u32>, [from, to]: [u32; 2]| {
            among.into_iter().find(|&piece| {
                let [a, b, c] = self.corners[piece as usize];
                [[b, a], [c, b], [a, c]].contains(&[from, to])
            })
        };
        let all = self.owners.par_iter().zip(&self.corners).with_min_len(GRAIN);
        all.map(|(&owner, &[a, b, c])| {
            [[b, c], [c, a], [a, b]].map(|edge| {
                let beside = band.triangles.across[owner as usize].into_iter().filter(|&t| t != NONE);
                let mut triangles = std::iter::once(owner).chain(beside);
                triangles.find_map(|t| find(pieces_of(t), edge)).unwrap_or(NONE)
            })
        })
        .collect()
    }
}

impl Patchwork {
    pub(super) fn new(band: &Band, placement: &NodePlacement, angles: &Angles) -> Self {
        Self::in_zone(band, placement, angles, vec![true; band.points.len()])
    }

    /// Does the work of [`Self::new`], for steps that change only what is at the nodes of the band in `zone`.
    pub(super) fn in_zone(
        band: &Band,
        placement: &NodePlacement,
        angles: &Angles,
        mut zone: Vec<bool>,
    ) -> Self {
        let cuts = band.points.len() as u32..placement.homes.len() as u32;
        for cut in cuts {
            let ends = placement.band_nodes_at(band, cut);
            zone.push(ends.iter().any(|&v| zone[v as usize]));
        }
        let nodes = 0..placement.homes.len() as u32;
        let mut patchwork = Self {
            triangles: Triangulation::default(),
            inside: Vec::new(),
            gaps: Vec::new(),
            owners: Vec::new(),
            points: nodes.clone().map(|v| placement.point(v)).collect(),
            divided: Vec::new(),
            on_outline: nodes.map(|v| placement.is_on_outline(v)).collect(),
            pinned: placement.pinned.clone(),
            acted: placement.acted.clone(),
            zone,
            may_move: vec![true; placement.homes.len()],
            may_flip: Vec::new(),
            poor: Vec::new(),
            changed: Vec::new(),
        };
        patchwork.set_pieces(band, BandPieces::new(band, placement, angles));
        patchwork
    }

    /// Takes other pieces, of the same nodes.
    pub(super) fn set_pieces(&mut self, band: &Band, pieces: BandPieces) {
        let (across, count) = (pieces.across(band), pieces.owners.len());
        self.triangles = Triangulation::new(self.points.len(), pieces.corners, across);
        (self.inside, self.gaps, self.owners) = (pieces.inside, pieces.gaps, pieces.owners);
        self.may_flip = vec![true; count];
        self.changed = (0..count as u32).collect();
    }

    /// Adds a node in the middle of an edge.
    pub(super) fn push_middle(&mut self, ends: [u32; 2], at: LatticePoint) {
        let zone = ends.iter().any(|&v| self.zone[v as usize]);
        self.points.push(at);
        self.divided.push(ends);
        self.on_outline.push(false);
        self.pinned.push(false);
        self.acted.push(true);
        self.zone.push(zone);
        self.may_move.push(true);
    }

    /// Returns the condition for a piece outside.
    pub(super) fn gap(&self, piece: u32) -> Gap {
        self.gaps[piece as usize]
    }

    /// Returns whether a piece has a node where steps move nodes and flip edges.
    pub(super) fn is_in_zone(&self, piece: u32) -> bool {
        self.triangles.corners[piece as usize].iter().any(|&v| self.zone[v as usize])
    }

    /// Notes that a piece got other corners, or that one of its corners moved.
    pub(super) fn note_change(&mut self, piece: u32) {
        self.changed.push(piece);
        self.triangles.corners[piece as usize].iter().for_each(|&v| self.may_move[v as usize] = true);
        self.may_flip[piece as usize] = true;
        let across = self.triangles.across[piece as usize].into_iter().filter(|&other| other != NONE);
        across.for_each(|other| self.may_flip[other as usize] = true);
    }

    /// Returns the cotangent of the smallest angle of a piece.
    pub(super) fn worst(&self, angles: &Angles, triangle: u32) -> f64 {
        angles.worst(self.corners(triangle))
    }

    /// Returns the positions of the corners of a piece.
    pub(super) fn corners(&self, triangle: u32) -> [LatticePoint; 3] {
        self.triangles.corners[triangle as usize].map(|v| self.points[v as usize])
    }

    /// Returns whether a piece outside satisfies its condition with its corners at these points.
    pub(super) fn leaves_gap(&self, angles: &Angles, triangle: u32, points: [LatticePoint; 3]) -> bool {
        self.gaps[triangle as usize].is_open(angles, self.triangles.corners[triangle as usize], points)
    }

    /// Returns the pieces inside and in the zone that have an angle below 30°, in ascending order.
    pub(super) fn poor(&mut self, angles: &Angles) -> &[u32] {
        let mut poor = std::mem::take(&mut self.poor);
        poor.append(&mut self.changed);
        poor.sort_unstable();
        poor.dedup();
        let is_poor =
            |&t: &u32| self.inside[t as usize] && self.is_in_zone(t) && self.worst(angles, t) > COT_30;
        self.poor = poor.into_par_iter().with_min_len(GRAIN).filter(is_poor).collect();
        &self.poor
    }

    /// Returns whether a node is on the boundary of the domain: around it there are pieces inside, and pieces
    /// outside or a side of the frame. `star` is the star of the node.
    pub(super) fn is_on_boundary(&self, star: &[(u32, usize)]) -> bool {
        let inside = |&&(t, _): &&(u32, usize)| self.inside[t as usize];
        star.iter().any(|at| inside(&at)) && (star.iter().any(|at| !inside(&at)) || self.is_on_frame(star))
    }

    /// Returns whether an edge of a piece inside along the frame ends at a node, or the band ends there.
    /// `star` is the star of the node.
    pub(super) fn is_on_frame(&self, star: &[(u32, usize)]) -> bool {
        let ((first, i), (last, j)) = (star[0], star[star.len() - 1]);
        let ends =
            |t: u32, i: usize| self.inside[t as usize] && self.triangles.across[t as usize][i % 3] == NONE;
        ends(first, i + 2) || ends(last, j + 1)
    }

    /// Flips edges between pieces inside where the smaller angle of the two becomes larger. The flip with the
    /// greatest gain comes first, and each piece is flipped once in a pass.
    pub(super) fn flip_edges(&mut self, outline: &OutlineOnLattice) {
        for _ in 0..PASSES {
            let flips = self.flips(outline);
            if flips.is_empty() {
                return;
            }
            for (_, t, i) in &flips {
                for piece in [*t, self.triangles.across[*t as usize][*i]] {
                    self.triangles.corners[piece as usize]
                        .iter()
                        .for_each(|&v| self.acted[v as usize] = true);
                }
            }
            let mut taken = NumberSet::default();
            for (_, t, i) in flips {
                let across = self.triangles.across[t as usize][i];
                if !taken.contains(&t) && !taken.contains(&across) {
                    taken.extend([t, across]);
                    self.triangles.flip(t, i);
                    self.note_change(t);
                    self.note_change(across);
                }
            }
        }
    }

    /// Returns the flips that help, the greatest gain first: the gain, the piece, and the place of the edge.
    fn flips(
        &mut self,
        OutlineOnLattice { angles, lengths, .. }: &OutlineOnLattice,
    ) -> Vec<(f64, u32, usize)> {
        self.poor(angles);
        let gains_of = |answers: &mut LengthAnswers, t: u32| {
            (t, [0, 1, 2].map(|i| self.gain_of_flip(angles, answers, t, i)))
        };
        let tried = self.poor.par_iter().with_min_len(GRAIN).filter(|&&t| self.may_flip[t as usize]);
        let tried = tried.map_init(|| lengths.answers(), |answers, &t| gains_of(answers, t));
        let tried: Vec<(u32, [Option<f64>; 3])> = tried.collect();
        let mut flips = Vec::new();
        for (t, gains) in tried {
            self.may_flip[t as usize] = gains.iter().any(Option::is_some);
            flips.extend(gains.iter().enumerate().filter_map(|(i, gain)| Some(((*gain)?, t, i))));
        }
        flips.par_sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        flips
    }

    /// Returns by how much the flip of an edge lowers the larger cotangent of the two pieces, or `None` if it
    /// does not.
    fn gain_of_flip(&self, angles: &Angles, answers: &mut LengthAnswers, t: u32, i: usize) -> Option<f64> {
        let across = self.triangles.across[t as usize][i];
        if across == NONE || !self.inside[across as usize] {
            return None;
        }
        let [a, b, c] = self.triangles.starting_at(t, i);
        let j = 3 - self.triangles.place(across, b) - self.triangles.place(across, c);
        let d = self.triangles.corners[across as usize][j];
        let [a, b, d, c] = [a, b, d, c].map(|v| self.points[v as usize]);
        let [after, before] = angles.diagonals([a, b, d, c]);
        let gain = before - after;
        let former = [[a, b, c], [b, d, c]];
        let mut allowed = |piece| former.iter().any(|&former| answers.allow(piece, former));
        let helps = after.is_finite() && gain > 1e-9;
        (helps && allowed([a, b, d]) && allowed([a, d, c])).then_some(gain)
    }
}

/// Returns the condition for the pieces outside of a triangle of the band.
pub(super) fn gap(band: &Band, placement: &NodePlacement, triangle: u32) -> Gap {
    let corners = band.triangles.corners[triangle as usize];
    if !placement.is_all_on(band, triangle) {
        return Gap::Full;
    }
    let used = corners.map(|v| has_sector(band, placement, v, true));
    Gap::between(corners, boundary_edges(band, placement, triangle, false), used)
}
