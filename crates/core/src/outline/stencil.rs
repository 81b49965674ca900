//! Divides the triangles of the mesh that the outline crosses.
//!
//! Nodes are inside (i), outside (o) or on the outline (•). Where an edge still joins a node inside to one
//! outside, it is cut (×). No other triangle is divided.
//!
//! ```text
//!       i                •                i                o
//!      / \              /|\              / \              / \
//!     /   \            / | \            /   \            /   \
//!    / all \          / i|o \          ×-----×          ×-----×
//!   /inside \        /   |   \        / \  o  \        / \  i  \
//!  i---------•      i----×----o      o---------o      i---------i
//! ```

use super::angles::Angles;
use super::band::Band;
use super::snap::{Crossings, OutlineSide};
use super::triangulation::NONE;
use crate::geometry::LatticePoint;

/// A triangle after cuts.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutTriangle {
    /// Nodes, anticlockwise.
    pub(super) corners: [u32; 3],
    pub(super) inside: bool,
}

/// Positions of nodes on the way from home to goal, in eighths: at first the whole way, then the steps of the
/// retreat.
const SHARES: [i64; 5] = [8, 4, 2, 1, 0];

/// The positions of the nodes of the band and of the nodes that cuts add, and the sides of the triangles.
///
/// Nodes of the band come first, then those in cut edges.
pub(super) struct NodePlacement {
    /// The side of each node of the band.
    pub(super) sides: Vec<OutlineSide>,
    /// The position of each node on the mesh; for a node in a cut edge the middle of the edge.
    pub(super) homes: Vec<LatticePoint>,
    /// The position of each node on the outline, or its home if it does not move.
    pub(super) goals: Vec<LatticePoint>,
    /// For each node, the index into [`SHARES`].
    retreats: Vec<u8>,
    /// Nodes at corners of the outline, which do not retreat.
    pub(super) pinned: Vec<bool>,
    /// For each triangle and corner, the node in the opposite edge, or [`NONE`].
    pub(super) cuts: Vec<[u32; 3]>,
    /// For each triangle with all corners on the outline, whether it is inside.
    pub(super) keeps: Vec<bool>,
    /// For each node, whether a step that depends on steps nearby did or tried anything at it. Nodes without
    /// such ones between them do not depend on each other.
    pub(super) acted: Vec<bool>,
    /// For each cut node, counted from the first, a triangle that it is in.
    cut_triangles: Vec<u32>,
}

impl NodePlacement {
    /// Puts all nodes at their goals. `sides` and `goals` are those of the nodes of the band. A triangle with
    /// all corners on the outline is inside if most of them were.
    pub(super) fn new(
        band: &Band,
        crossings: &Crossings,
        sides: Vec<OutlineSide>,
        goals: Vec<LatticePoint>,
    ) -> Self {
        let mostly_inside =
            |corners: &[u32; 3]| corners.iter().filter(|&&v| band.inside[v as usize]).count() >= 2;
        let mut placement = Self {
            sides,
            homes: band.points.clone(),
            goals,
            retreats: Vec::new(),
            pinned: Vec::new(),
            cuts: vec![[NONE; 3]; band.triangles.len()],
            keeps: band.triangles.corners.iter().map(mostly_inside).collect(),
            acted: Vec::new(),
            cut_triangles: Vec::new(),
        };
        placement.cut_edges(band, crossings);
        placement.retreats = vec![0; placement.homes.len()];
        placement.pinned = vec![false; placement.homes.len()];
        placement.acted = vec![false; placement.homes.len()];
        placement
    }

    fn cut_edges(&mut self, band: &Band, crossings: &Crossings) {
        for t in 0..self.cuts.len() {
            for i in 0..3 {
                let [_, from, to] = band.starting_at(t as u32, i, &self.sides);
                let is_cut = matches!(
                    (from, to),
                    (OutlineSide::Inside, OutlineSide::Outside) | (OutlineSide::Outside, OutlineSide::Inside)
                );
                if !is_cut || self.cuts[t][i] != NONE {
                    continue;
                }
                let cut = self.homes.len() as u32;
                let [_, p, q] = band.starting_at(t as u32, i, &band.points);
                self.homes.push(LatticePoint::new((p.x + q.x) / 2, (p.y + q.y) / 2));
                self.goals.push(crossings.point(band, t as u32, i));
                self.cuts[t][i] = cut;
                self.cut_triangles.push(t as u32);
                if let Some(across) = band.triangles.across.get(band.triangles.across[t][i] as usize) {
                    let j = across.iter().position(|&n| n == t as u32).expect("neighbours know each other");
                    self.cuts[band.triangles.across[t][i] as usize][j] = cut;
                }
            }
        }
    }

    /// Returns the position of a node.
    #[inline]
    pub(super) fn point(&self, node: u32) -> LatticePoint {
        let node = node as usize;
        let (home, goal) = (self.homes[node], self.goals[node]);
        let share = SHARES[usize::from(self.retreats[node])];
        let along = |home: u32, goal: u32| {
            let (home, goal) = (i64::from(home), i64::from(goal));
            (home + (goal - home) * share / SHARES[0]) as u32
        };
        LatticePoint::new(along(home.x, goal.x), along(home.y, goal.y))
    }

    /// Returns the middle of an edge, rounded towards its home: so mirrored outlines have mirrored nodes.
    pub(super) fn middle(&self, ends: [u32; 2]) -> LatticePoint {
        let [p, q] = ends.map(|v| self.point(v));
        let home = self.home_of_middle(ends);
        let between = |p: u32, q: u32, home: u32| {
            let home = i64::from(home);
            (home + (i64::from(p) + i64::from(q) - 2 * home) / 2) as u32
        };
        LatticePoint::new(between(p.x, q.x, home.x), between(p.y, q.y, home.y))
    }

    /// Returns the middle of an edge between nodes at home.
    pub(super) fn home_of_middle(&self, ends: [u32; 2]) -> LatticePoint {
        let [p, q] = ends.map(|v| self.homes[v as usize]);
        LatticePoint::new(p.x.midpoint(q.x), p.y.midpoint(q.y))
    }

    /// Returns whether a node has arrived at its goal on the outline.
    pub(super) fn is_on_outline(&self, node: u32) -> bool {
        let can_move = self.sides.get(node as usize).is_none_or(|&side| side == OutlineSide::On);
        can_move
            && (self.retreats[node as usize] == 0 || self.goals[node as usize] == self.homes[node as usize])
    }

    /// Returns whether a node can still retreat towards its home.
    pub(super) fn can_retreat(&self, node: u32) -> bool {
        let n = node as usize;
        !self.pinned[n] && usize::from(self.retreats[n]) + 1 < SHARES.len() && self.goals[n] != self.homes[n]
    }

    pub(super) fn retreat(&mut self, node: u32) {
        self.retreats[node as usize] += 1;
        self.acted[node as usize] = true;
    }

    /// Moves all nodes to their goals again.
    pub(super) fn advance_all(&mut self) {
        self.retreats.fill(0);
    }

    /// Returns the nodes of the band at a node: itself, or the ends of the edge that it cuts.
    pub(super) fn band_nodes_at(&self, band: &Band, node: u32) -> [u32; 2] {
        let Some(cut) = (node as usize).checked_sub(band.points.len()) else { return [node; 2] };
        let t = self.cut_triangles[cut];
        let i = self.cuts[t as usize].iter().position(|&v| v == node).expect("the triangle is cut there");
        let [_, from, to] = band.triangles.starting_at(t, i);
        [from, to]
    }

    /// Returns whether a node is on the outline, or the end of an edge that is cut. Overwrites `star`.
    pub(super) fn is_at_outline(&self, band: &Band, node: u32, star: &mut Vec<(u32, usize)>) -> bool {
        band.triangles.star(node, star);
        let has_cut = |&(t, i): &(u32, usize)| {
            let cuts = self.cuts[t as usize];
            cuts[(i + 1) % 3] != NONE || cuts[(i + 2) % 3] != NONE
        };
        self.sides[node as usize] == OutlineSide::On || star.iter().any(has_cut)
    }

    /// Writes the triangles of the band that have a node, or are cut there, into `found`.
    pub(super) fn push_triangles_at(&self, band: &Band, node: u32, found: &mut Vec<u32>) {
        let Some(cut) = (node as usize).checked_sub(band.points.len()) else {
            let mut star = Vec::new();
            band.triangles.star(node, &mut star);
            return found.extend(star.iter().map(|&(t, _)| t));
        };
        let t = self.cut_triangles[cut];
        let i = self.cuts[t as usize].iter().position(|&v| v == node).expect("the triangle is cut there");
        found.extend([t, band.triangles.across[t as usize][i]].into_iter().filter(|&t| t != NONE));
    }

    /// Returns whether all corners of a triangle are on the outline.
    pub(super) fn is_all_on(&self, band: &Band, triangle: u32) -> bool {
        band.starting_at(triangle, 0, &self.sides) == [OutlineSide::On; 3]
    }

    /// Returns the pieces into which the outline divides a triangle: up to three, where a quadrilateral is
    /// divided by the diagonal with the better angles.
    pub(super) fn pieces(&self, band: &Band, triangle: u32, angles: &Angles) -> [Option<CutTriangle>; 3] {
        let sides = band.starting_at(triangle, 0, &self.sides);
        let count = |side| sides.iter().filter(|&&s| s == side).count();
        let piece = |corners, side| Some(CutTriangle { corners, inside: side == OutlineSide::Inside });
        let whole = |side| [piece(band.triangles.corners[triangle as usize], side), None, None];
        let place = |side| sides.iter().position(|&s| s == side).expect("counted");
        let cut = |i: usize| self.cuts[triangle as usize][i % 3];
        match (count(OutlineSide::Inside), count(OutlineSide::Outside)) {
            (0, 0) => whole(OutlineSide::from_inside(self.keeps[triangle as usize])),
            (_, 0) => whole(OutlineSide::Inside),
            (0, _) => whole(OutlineSide::Outside),
            (1, 1) => {
                let i = place(OutlineSide::On);
                let [on, b, c] = band.triangles.starting_at(triangle, i);
                let [_, b_side, c_side] = band.starting_at(triangle, i, &self.sides);
                [piece([on, b, cut(i)], b_side), piece([on, cut(i), c], c_side), None]
            }
            (inside, _) => {
                let (alone, others) = if inside == 1 {
                    (OutlineSide::Inside, OutlineSide::Outside)
                } else {
                    (OutlineSide::Outside, OutlineSide::Inside)
                };
                let i = place(alone);
                let [a, b, c] = band.triangles.starting_at(triangle, i);
                let (ab, ca) = (cut(i + 2), cut(i + 1));
                let [from_ab, from_b] = angles.diagonals([ab, b, c, ca].map(|v| self.point(v)));
                let halves =
                    if from_ab <= from_b { [[ab, b, c], [ab, c, ca]] } else { [[ab, b, ca], [b, c, ca]] };
                [piece([a, ab, ca], alone), piece(halves[0], others), piece(halves[1], others)]
            }
        }
    }

    /// Returns the corners of a piece.
    pub(super) fn points(&self, corners: [u32; 3]) -> [LatticePoint; 3] {
        corners.map(|v| self.point(v))
    }

    /// Returns whether the triangle across an edge between two nodes on the outline is inside. `across` is
    /// this triangle, or [`NONE`].
    pub(super) fn is_inside_across(&self, band: &Band, across: u32, edge: [u32; 2]) -> bool {
        if across == NONE {
            return false;
        }
        let corners = band.triangles.corners[across as usize];
        let third = corners.into_iter().find(|v| !edge.contains(v)).expect("three corners");
        match self.sides[third as usize] {
            OutlineSide::Inside => true,
            OutlineSide::Outside => false,
            OutlineSide::On => self.keeps[across as usize],
        }
    }
}
