//! The pieces of the triangles near the outline, whose nodes and edges are improved.

use super::angles::{Angles, COT_5, COT_30};
use super::band::Band;
use super::flat::{boundary_edges, has_sector};
use super::stencil::Placement;
use super::triangulation::{NONE, Triangulation};
use crate::geometry::LatticePoint;

/// Number of passes in which edges are flipped.
const PASSES: usize = 6;

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
    /// The nodes of the band, then the nodes in cut edges.
    pub(super) points: Vec<LatticePoint>,
    /// For each node, whether it was moved onto the outline.
    pub(super) on_outline: Vec<bool>,
    /// For each node, whether it is at a corner of the outline.
    pub(super) pinned: Vec<bool>,
    /// For each node, whether anything around it changed since the last search for a better position failed.
    pub(super) may_move: Vec<bool>,
}

impl Patchwork {
    pub(super) fn new(band: &Band, placement: &Placement, angles: &Angles) -> Self {
        let nodes = 0..placement.homes.len() as u32;
        let (mut corners, mut inside, mut owners, mut gaps) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for t in 0..band.triangles.len() as u32 {
            for piece in placement.pieces(band, t, angles).into_iter().flatten() {
                corners.push(piece.corners);
                inside.push(piece.inside);
                owners.push(t);
                gaps.push(gap(band, placement, t));
            }
        }
        Self {
            triangles: Triangulation::joined(nodes.len(), corners),
            inside,
            gaps,
            owners,
            points: nodes.clone().map(|v| placement.point(v)).collect(),
            on_outline: nodes.map(|v| placement.is_on_outline(v)).collect(),
            pinned: placement.pinned.clone(),
            may_move: vec![true; placement.homes.len()],
        }
    }

    /// Notes that triangles get other corners, or that a corner moved.
    pub(super) fn note_change(&mut self, triangles: impl IntoIterator<Item = u32>) {
        for t in triangles {
            self.triangles.corners[t as usize].iter().for_each(|&v| self.may_move[v as usize] = true);
        }
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

    /// Returns the pieces inside that have an angle below 30°.
    pub(super) fn poor<'a>(&'a self, angles: &'a Angles) -> impl Iterator<Item = u32> + 'a {
        let inside = (0..self.inside.len() as u32).filter(|&t| self.inside[t as usize]);
        inside.filter(|&t| self.worst(angles, t) > COT_30)
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
    pub(super) fn flip_edges(&mut self, angles: &Angles) {
        for _ in 0..PASSES {
            let mut flips: Vec<(f64, u32, usize)> = self
                .poor(angles)
                .flat_map(|t| [0, 1, 2].map(|i| (t, i)))
                .filter_map(|(t, i)| {
                    let gain = self.gain_of_flip(angles, t, i)?;
                    Some((gain, t, i))
                })
                .collect();
            flips.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            if flips.is_empty() {
                return;
            }
            let mut taken = vec![false; self.inside.len()];
            for (_, t, i) in flips {
                let across = self.triangles.across[t as usize][i];
                if !taken[t as usize] && !taken[across as usize] {
                    (taken[t as usize], taken[across as usize]) = (true, true);
                    self.note_change([t, across]);
                    self.triangles.flip(t, i);
                }
            }
        }
    }

    /// Returns by how much the flip of an edge lowers the larger cotangent of the two pieces, or `None` if it
    /// does not.
    fn gain_of_flip(&self, angles: &Angles, t: u32, i: usize) -> Option<f64> {
        let across = self.triangles.across[t as usize][i];
        if across == NONE || !self.inside[across as usize] {
            return None;
        }
        let [a, b, c] = self.triangles.starting_at(t, i);
        let j = 3 - self.triangles.place(across, b) - self.triangles.place(across, c);
        let d = self.triangles.corners[across as usize][j];
        let [after, before] = angles.diagonals([a, b, d, c].map(|v| self.points[v as usize]));
        let gain = before - after;
        (after.is_finite() && gain > 1e-9).then_some(gain)
    }
}

/// Returns the condition for the pieces outside of a triangle of the band.
pub(super) fn gap(band: &Band, placement: &Placement, triangle: u32) -> Gap {
    let corners = band.triangles.corners[triangle as usize];
    if !placement.is_all_on(band, triangle) {
        return Gap::Full;
    }
    let used = corners.map(|v| has_sector(band, placement, v, true));
    Gap::between(corners, boundary_edges(band, placement, triangle, false), used)
}
