//! The pieces of the triangles near the outline, whose nodes and edges are improved.

use super::angles::{Angles, COT_30};
use super::band::Band;
use super::stencil::Placement;
use super::triangulation::{NONE, Triangulation};
use crate::geometry::LatticePoint;

/// How many times edges are flipped in a row.
const PASSES: usize = 6;

/// Pieces inside and outside, which together cover the band.
pub(super) struct Patchwork {
    pub(super) triangles: Triangulation,
    /// For each piece whether it is inside.
    pub(super) inside: Vec<bool>,
    /// For each piece the triangle of the band whose place it takes. A flip leaves it to the two pieces.
    pub(super) owners: Vec<u32>,
    /// Those of the band, then those in cut edges.
    pub(super) points: Vec<LatticePoint>,
    /// For each node whether it has been moved onto the outline.
    pub(super) on_outline: Vec<bool>,
    /// For each node whether it is at a corner of the outline.
    pub(super) pinned: Vec<bool>,
}

impl Patchwork {
    pub(super) fn new(band: &Band, placement: &Placement, angles: &Angles) -> Self {
        let nodes = 0..placement.homes.len() as u32;
        let (mut corners, mut inside, mut owners) = (Vec::new(), Vec::new(), Vec::new());
        for t in 0..band.triangles.len() as u32 {
            for piece in placement.pieces(band, t, angles).into_iter().flatten() {
                corners.push(piece.corners);
                inside.push(piece.inside);
                owners.push(t);
            }
        }
        Self {
            triangles: Triangulation::joined(nodes.len(), corners),
            inside,
            owners,
            points: nodes.clone().map(|v| placement.point(v)).collect(),
            on_outline: nodes.map(|v| placement.is_on_outline(v)).collect(),
            pinned: placement.pinned.clone(),
        }
    }

    /// The cotangent of the smallest angle of a piece.
    pub(super) fn worst(&self, angles: &Angles, triangle: u32) -> f64 {
        angles.worst(self.triangles.corners[triangle as usize].map(|v| self.points[v as usize]))
    }

    /// The pieces inside with an angle below 30°.
    pub(super) fn poor<'a>(&'a self, angles: &'a Angles) -> impl Iterator<Item = u32> + 'a {
        let inside = (0..self.inside.len() as u32).filter(|&t| self.inside[t as usize]);
        inside.filter(|&t| self.worst(angles, t) > COT_30)
    }

    /// Whether a node lies where the domain ends: around it there are pieces inside, and pieces outside or a side
    /// of the frame. `star` is that of the node.
    pub(super) fn is_on_boundary(&self, star: &[(u32, usize)]) -> bool {
        let inside = |&&(t, _): &&(u32, usize)| self.inside[t as usize];
        star.iter().any(|at| inside(&at)) && (star.iter().any(|at| !inside(&at)) || self.is_on_frame(star))
    }

    /// Whether an edge of a piece inside along the frame ends at a node, or the band ends there.
    pub(super) fn is_on_frame(&self, star: &[(u32, usize)]) -> bool {
        let ((first, i), (last, j)) = (star[0], star[star.len() - 1]);
        let ends = |t: u32, i: usize| {
            self.inside[t as usize] && self.triangles.across[t as usize][i % 3] == NONE
        };
        ends(first, i + 2) || ends(last, j + 1)
    }

    /// Flips edges between pieces inside where the smaller angle of the two becomes larger: the greatest gain
    /// first, each piece once in a pass.
    pub(super) fn flip_edges(&mut self, angles: &Angles) {
        for _ in 0..PASSES {
            let mut flips: Vec<(f64, u32, usize)> =
                self.poor(angles).flat_map(|t| [0, 1, 2].map(|i| (t, i))).filter_map(|(t, i)| {
                    let gain = self.gain_of_flip(angles, t, i)?;
                    Some((gain, t, i))
                }).collect();
            flips.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            let mut taken = Vec::new();
            for (_, t, i) in flips.iter().copied() {
                let across = self.triangles.across[t as usize][i];
                if !taken.contains(&t) && !taken.contains(&across) {
                    taken.extend([t, across]);
                    self.triangles.flip(t, i);
                }
            }
            if taken.is_empty() {
                return;
            }
        }
    }

    /// By how much the flip of an edge lowers the larger cotangent of the two pieces, if it does.
    fn gain_of_flip(&self, angles: &Angles, t: u32, i: usize) -> Option<f64> {
        let across = self.triangles.across[t as usize][i];
        if across == NONE || !self.inside[across as usize] {
            return None;
        }
        let [a, b, c] = self.triangles.from_place(t, i);
        let j = 3 - self.triangles.place(across, b) - self.triangles.place(across, c);
        let d = self.triangles.corners[across as usize][j];
        let [after, before] = angles.diagonals([a, b, d, c].map(|v| self.points[v as usize]));
        let gain = before - after;
        (after.is_finite() && gain > 1e-9).then_some(gain)
    }
}
