//! Divides edges that are longer than their target, before edges are flipped and nodes shifted.
//!
//! Nodes that moved to the outline made some edges longer. Where one is now longer than h̄ at a point of a
//! triangle beside it, it gets a node in its middle, and the pieces beside it are divided:
//!
//! ```text
//!        c                 c                 c                 c
//!       / \               /|\               / \               / \
//!      /   \             / | \             /   x             x---x
//!     /     \           /  |  \           /  / |            / \ / \
//!    a-------b         a---x---b         a---x--b          a---x---b
//! ```
//!
//! Where an angle would be too small, or an edge still too long, the nodes beside it go back towards home
//! instead: there, no edge is longer than its target, since the triangles of the mesh met theirs.

use rayon::prelude::*;

use super::angles::Angles;
use super::band::{Band, GRAIN};
use super::corners::Pin;
use super::lengths::LengthAnswers;
use super::line::OutlineOnLattice;
use super::patchwork::{BandPieces, Gap, Patchwork};
use super::stencil::NodePlacement;
use super::triangulation::NONE;
use crate::geometry::{LatticePoint, NumberMap, NumberSet};
use crate::mesh::Mesh;

/// A piece beside edges that are divided.
struct DividedPiece {
    piece: u32,
    /// For each corner, the node in the opposite edge, or [`NONE`].
    middles: [u32; 3],
    /// Whether an edge is too long because of this piece.
    asks: bool,
}

/// The division of edges that are too long.
pub(super) struct Division {
    /// In ascending order.
    pieces: Vec<DividedPiece>,
    /// The ends of the edges and their middles, which are new nodes.
    edges: Vec<([u32; 2], LatticePoint)>,
}

impl Division {
    /// Finds the edges that are too long because of pieces inside and in the zone, other than `excused` ones.
    pub(super) fn new(
        mesh: &Mesh,
        (band, placement): (&Band, &NodePlacement),
        patchwork: &Patchwork,
        outline: &OutlineOnLattice,
        excused: &NumberSet<u32>,
    ) -> Self {
        let mut division = Self { pieces: Vec::new(), edges: Vec::new() };
        if !outline.lengths.is_any() {
            return division;
        }
        let all = (0..patchwork.owners.len() as u32).into_par_iter().with_min_len(GRAIN);
        let too_long = all.map_init(
            || outline.lengths.answers(),
            |answers, t| {
                let counts = patchwork.inside[t as usize] && !excused.contains(&t);
                (counts && patchwork.is_in_zone(t)).then(|| too_long(mesh, band, patchwork, answers, t))?
            },
        );
        let too_long: Vec<(u32, [bool; 3])> = too_long.flatten_iter().collect();
        let mut places = NumberMap::<u32, usize>::default();
        for (t, edges) in too_long {
            for i in (0..3).filter(|&i| edges[i]) {
                division.divide((placement, patchwork), &mut places, t, i);
            }
            let place = places[&t];
            division.pieces[place].asks = true;
        }
        division.pieces.sort_unstable_by_key(|divided| divided.piece);
        division
    }

    /// Divides the edge opposite the i-th corner of a piece, unless it is divided.
    fn divide(
        &mut self,
        (placement, patchwork): (&NodePlacement, &Patchwork),
        places: &mut NumberMap<u32, usize>,
        t: u32,
        i: usize,
    ) {
        let triangles = &patchwork.triangles;
        let [_, from, to] = triangles.starting_at(t, i);
        let across = triangles.across[t as usize][i];
        let opposite = |t: u32| {
            let corners = triangles.corners[t as usize];
            (t, corners.iter().position(|v| ![from, to].contains(v)).expect("three corners"))
        };
        let middle = (patchwork.points.len() + self.edges.len()) as u32;
        let mut is_new = true;
        for (t, i) in std::iter::once((t, i)).chain((across != NONE).then(|| opposite(across))) {
            let place = *places.entry(t).or_insert(self.pieces.len());
            if place == self.pieces.len() {
                self.pieces.push(DividedPiece { piece: t, middles: [NONE; 3], asks: false });
            }
            let former = &mut self.pieces[place].middles[i];
            is_new &= *former == NONE;
            if is_new {
                *former = middle;
            }
        }
        if is_new {
            let ends = [from, to];
            self.edges.push((ends, placement.middle(ends)));
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Returns the pieces whose parts would have too small an angle or too long an edge, each with those
    /// beside it that ask for the division.
    pub(super) fn failing(
        &self,
        patchwork: &Patchwork,
        outline: &OutlineOnLattice,
        pins: &[Pin],
    ) -> Vec<Vec<u32>> {
        let at = |v: u32| match (v as usize).checked_sub(patchwork.points.len()) {
            None => patchwork.points[v as usize],
            Some(middle) => self.edges[middle].1,
        };
        let limit_at = |v: &u32| pins.binary_search_by_key(v, |pin| pin.node).map_or(0.0, |n| pins[n].limit);
        let fails = |answers: &mut LengthAnswers, divided: &DividedPiece| {
            let corners = patchwork.triangles.corners[divided.piece as usize];
            let limit = corners.iter().map(limit_at).fold(outline.angles.limit(), f64::max);
            let mut parts = divided.parts(patchwork, &outline.angles, at).into_iter().flatten();
            parts.any(|part| {
                let points = part.map(at);
                outline.angles.worst(points) > limit || answers.exceed(points)
            })
        };
        let asks = |t: u32| {
            let found = self.pieces.binary_search_by_key(&t, |divided| divided.piece);
            found.is_ok_and(|place| self.pieces[place].asks)
        };
        let inside = self.pieces.par_iter().filter(|divided| patchwork.inside[divided.piece as usize]);
        let failing = inside.map_init(
            || outline.lengths.answers(),
            |answers, divided| {
                let across = patchwork.triangles.across[divided.piece as usize];
                let beside = (0..3).filter(|&i| divided.middles[i] != NONE).map(|i| across[i]);
                let asking = std::iter::once(divided.piece).chain(beside.filter(|&t| t != NONE && asks(t)));
                fails(answers, divided).then(|| asking.collect())
            },
        );
        failing.flatten_iter().collect()
    }

    /// Divides the pieces.
    pub(super) fn apply(&self, band: &Band, patchwork: &mut Patchwork, angles: &Angles) {
        for divided in &self.pieces {
            for v in patchwork.triangles.corners[divided.piece as usize] {
                patchwork.acted[v as usize] = true;
            }
        }
        self.edges.iter().for_each(|&(ends, at)| patchwork.push_middle(ends, at));
        let mut pieces = BandPieces::default();
        let mut next = self.pieces.iter().peekable();
        for t in 0..patchwork.owners.len() as u32 {
            let (inside, owner) = (patchwork.inside[t as usize], patchwork.owners[t as usize]);
            let gap = patchwork.gap(t);
            match next.next_if(|divided| divided.piece == t) {
                None => pieces.add(patchwork.triangles.corners[t as usize], inside, owner, gap),
                Some(divided) => {
                    let gap = if gap == Gap::Harmless { gap } else { Gap::Full };
                    let parts = divided.parts(patchwork, angles, |v| patchwork.points[v as usize]);
                    parts.into_iter().flatten().for_each(|part| pieces.add(part, inside, owner, gap));
                }
            }
        }
        patchwork.set_pieces(band, pieces);
    }
}

impl DividedPiece {
    /// Returns the parts of the piece.
    fn parts(
        &self,
        patchwork: &Patchwork,
        angles: &Angles,
        at: impl Fn(u32) -> LatticePoint,
    ) -> [Option<[u32; 3]>; 4] {
        let count = self.middles.iter().filter(|&&middle| middle != NONE).count();
        let place = |is_divided: bool| {
            let found = self.middles.iter().position(|&middle| (middle != NONE) == is_divided);
            found.expect("counted")
        };
        let turned = |i: usize| {
            let middles = [0, 1, 2].map(|k| self.middles[(i + k) % 3]);
            (patchwork.triangles.starting_at(self.piece, i), middles)
        };
        match count {
            1 => {
                let ([a, b, c], [bc, ..]) = turned(place(true));
                [Some([a, b, bc]), Some([a, bc, c]), None, None]
            }
            2 => {
                let ([a, b, c], [_, ca, ab]) = turned(place(false));
                let [from_ab, from_b] = angles.diagonals([ab, b, c, ca].map(at));
                let halves =
                    if from_ab <= from_b { [[ab, b, c], [ab, c, ca]] } else { [[ab, b, ca], [b, c, ca]] };
                [Some([a, ab, ca]), Some(halves[0]), Some(halves[1]), None]
            }
            _ => {
                let ([a, b, c], [bc, ca, ab]) = turned(0);
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [bc, ca, ab]].map(Some)
            }
        }
    }
}

/// Returns for each corner of a piece whether the opposite edge is too long; `None` where none is. In a
/// triangle of the mesh that is larger than its target, edges may have any length.
fn too_long(
    mesh: &Mesh,
    band: &Band,
    patchwork: &Patchwork,
    answers: &mut LengthAnswers,
    t: u32,
) -> Option<(u32, [bool; 3])> {
    let corners = patchwork.triangles.corners[t as usize];
    let is_at_home = |&v: &u32| band.points.get(v as usize) == Some(&patchwork.points[v as usize]);
    if corners.iter().all(is_at_home) || !answers.exceed(patchwork.corners(t)) {
        return None;
    }
    let owner = band.ids[patchwork.owners[t as usize] as usize];
    let is_met = !answers.ask_for_more(mesh.corners(owner), mesh.triangle(owner).level());
    is_met.then(|| (t, answers.exceeding(patchwork.corners(t))))
}
