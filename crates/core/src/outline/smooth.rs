//! Moves nodes near the outline, for better angles and onto the outline.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DVec2, dvec2};
use rayon::prelude::*;

use super::angles::{Angles, COT_20};
use super::band::GRAIN;
use super::lengths::{LengthAnswers, LengthRule};
use super::patchwork::Patchwork;
use super::snap::rounded;
use crate::domain::{OutlineNearby, RegionOnLattice};
use crate::geometry::LatticePoint;

/// The directions of a search for a better position, in world units.
pub(super) const DIRECTIONS: [DVec2; 8] = [
    dvec2(1.0, 0.0),
    dvec2(FRAC_1_SQRT_2, FRAC_1_SQRT_2),
    dvec2(0.0, 1.0),
    dvec2(-FRAC_1_SQRT_2, FRAC_1_SQRT_2),
    dvec2(-1.0, 0.0),
    dvec2(-FRAC_1_SQRT_2, -FRAC_1_SQRT_2),
    dvec2(0.0, -1.0),
    dvec2(FRAC_1_SQRT_2, -FRAC_1_SQRT_2),
];
/// Number of step lengths that the search tries. The first is a fifth of the mean edge, each next one half
/// the previous one.
const STEP_LENGTHS: usize = 4;
const FIRST_STEP: f64 = 0.2;
/// Number of final rounds that move nodes to the outline.
const PULL_ROUNDS: usize = 8;
/// Fewest searches for a position that a thread takes at a time.
const FEWEST_SEARCHES: usize = 32;

/// Moves nodes of a patchwork.
pub(super) struct Smoother<'a> {
    pub(super) region: &'a RegionOnLattice,
    pub(super) angles: &'a Angles,
    pub(super) lengths: &'a LengthRule<'a>,
    /// The upper right corner of the lattice.
    pub(super) extent: LatticePoint,
}

/// What a thread uses again from search to search.
struct Scratch<'a> {
    star: Vec<(u32, usize)>,
    outline: OutlineNearby,
    answers: LengthAnswers<'a>,
}

/// A move of a node that would help.
struct Move {
    node: u32,
    to: LatticePoint,
    gain: f64,
    on_outline: bool,
}

impl Smoother<'_> {
    fn scratch(&self) -> Scratch<'_> {
        Scratch { star: Vec::new(), outline: OutlineNearby::default(), answers: self.lengths.answers() }
    }

    /// Moves nodes of pieces with angles below 30° to where the smallest angle around them is largest; nodes
    /// on the boundary move along the outline. Of adjacent nodes, only the one that gains most moves.
    pub(super) fn smooth(&self, patchwork: &mut Patchwork) {
        let poor = patchwork.poor(self.angles).to_vec();
        let mut nodes: Vec<u32> =
            poor.iter().flat_map(|&t| patchwork.triangles.corners[t as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes.retain(|&node| patchwork.zone[node as usize] && patchwork.may_move[node as usize]);
        let searches = nodes.par_iter().with_min_len(FEWEST_SEARCHES);
        let found =
            searches.map_init(|| self.scratch(), |scratch, &node| self.best_move(patchwork, node, scratch));
        let found: Vec<Option<Move>> = found.collect();
        for (&node, best) in nodes.iter().zip(&found) {
            patchwork.may_move[node as usize] = best.is_some();
        }
        self.apply(patchwork, &found.into_iter().flatten().collect::<Vec<_>>());
    }

    /// Moves nodes on the boundary that are off the outline to its nearest point, unless the angles around
    /// them fall below 20° or get worse. Of adjacent nodes, only the one that is farthest off moves in a
    /// round.
    pub(super) fn pull(&self, patchwork: &mut Patchwork) {
        let all = (0..patchwork.points.len() as u32).into_par_iter().with_min_len(GRAIN);
        let mut off: Vec<u32> =
            all.filter(|&v| patchwork.zone[v as usize] && !patchwork.on_outline[v as usize]).collect();
        // What is on the boundary stays there.
        let on_boundary = |star: &mut Vec<(u32, usize)>, v: u32| {
            patchwork.triangles.star(v, star);
            !star.is_empty() && patchwork.is_on_boundary(star)
        };
        let found = off.par_iter().with_min_len(GRAIN);
        let found = found.map_init(Vec::new, |star, &v| on_boundary(star, v).then_some(v));
        off = found.flatten_iter().collect();
        for _ in 0..PULL_ROUNDS {
            let searches = off.par_iter().with_min_len(FEWEST_SEARCHES);
            let moves = searches
                .map_init(|| self.scratch(), |scratch, &v| self.move_to_outline(patchwork, v, scratch));
            let moves: Vec<Move> = moves.flatten_iter().collect();
            if moves.is_empty() {
                return;
            }
            self.apply(patchwork, &moves);
            off.retain(|&v| !patchwork.on_outline[v as usize]);
        }
    }

    /// Makes the moves that gain more than those of all adjacent nodes, and of equal ones that of the node
    /// with the lowest number. `moves` are in the order of their nodes.
    fn apply(&self, patchwork: &mut Patchwork, moves: &[Move]) {
        moves.iter().for_each(|best| patchwork.acted[best.node as usize] = true);
        let gain = |v: u32| moves.binary_search_by_key(&v, |best| best.node).map_or(0.0, |n| moves[n].gain);
        let beats_neighbours = |star: &mut Vec<(u32, usize)>, best: &Move| {
            patchwork.triangles.star(best.node, star);
            let mut others = star.iter().flat_map(|&(t, _)| patchwork.triangles.corners[t as usize]);
            others.all(|v| {
                let gain = gain(v);
                v == best.node || best.gain > gain || (best.gain == gain && best.node < v)
            })
        };
        let all = moves.par_iter().with_min_len(GRAIN);
        let winners = all.map_init(Vec::new, |star, best| beats_neighbours(star, best).then_some(best));
        let winners: Vec<&Move> = winners.flatten_iter().collect();
        let mut star = Vec::new();
        for Move { node, to, on_outline, .. } in winners {
            patchwork.points[*node as usize] = *to;
            patchwork.on_outline[*node as usize] = *on_outline;
            patchwork.triangles.star(*node, &mut star);
            star.iter().for_each(|&(t, _)| patchwork.note_change(t));
        }
    }

    fn best_move(&self, patchwork: &Patchwork, node: u32, scratch: &mut Scratch) -> Option<Move> {
        let Scratch { star, outline, answers } = scratch;
        patchwork.triangles.star(node, star);
        if patchwork.pinned[node as usize] || patchwork.is_on_frame(star) {
            return None;
        }
        let (on_boundary, step) = (patchwork.is_on_boundary(star), self.angles.step());
        let home = patchwork.points[node as usize];
        let now = self.worst_around(patchwork, star, home)?;
        let mean = self.mean_edge(patchwork, star);
        let (mut best, mut length) = ((now, home), FIRST_STEP * mean);
        let mut collected_at = None;
        for _ in 0..STEP_LENGTHS {
            let from = best.1.as_dvec2();
            // Later steps are shorter.
            if on_boundary && collected_at.replace(from) != Some(from) {
                outline.collect(self.region, from, mean + length, step);
            }
            for direction in DIRECTIONS {
                let to = from + length * direction / step;
                let to = if on_boundary { outline.nearest(to, mean) } else { Some(to) };
                let Some(to) = to.map(|to| rounded(to, self.extent)) else { continue };
                if let Some(worst) = self.worst_around(patchwork, star, to).filter(|&worst| worst < best.0)
                    && allows_move(patchwork, star, to, answers)
                {
                    best = (worst, to);
                }
            }
            length /= 2.0;
        }
        let (worst, to) = best;
        (worst < now).then_some(Move { node, to, gain: now - worst, on_outline: on_boundary })
    }

    fn move_to_outline(&self, patchwork: &Patchwork, node: u32, scratch: &mut Scratch) -> Option<Move> {
        let Scratch { star, outline, answers } = scratch;
        patchwork.triangles.star(node, star);
        if star.is_empty() || patchwork.is_on_frame(star) || !patchwork.is_on_boundary(star) {
            return None;
        }
        let home = patchwork.points[node as usize];
        let now = self.worst_around(patchwork, star, home)?;
        let reach = self.mean_edge(patchwork, star);
        outline.collect(self.region, home.as_dvec2(), reach, self.angles.step());
        let to = outline.nearest(home.as_dvec2(), reach)?;
        let to = rounded(to, self.extent);
        let worst = self.worst_around(patchwork, star, to)?;
        let gain = self.angles.vector(home, to).length();
        let is_good = worst <= now.max(COT_20) && allows_move(patchwork, star, to, answers);
        is_good.then_some(Move { node, to, gain, on_outline: true })
    }

    /// Returns the cotangent of the smallest angle of the pieces inside around a node, if the node were at
    /// `to`; `None` if a piece outside would get too flat.
    fn worst_around(&self, patchwork: &Patchwork, star: &[(u32, usize)], to: LatticePoint) -> Option<f64> {
        let mut largest = 0.0f64;
        for &(t, i) in star {
            let mut points = patchwork.corners(t);
            points[i] = to;
            if patchwork.inside[t as usize] {
                largest = largest.max(self.angles.worst(points));
            } else if !patchwork.leaves_gap(self.angles, t, points)
                && self.angles.worst(points) > patchwork.worst(self.angles, t)
            {
                return None;
            }
        }
        Some(largest)
    }

    /// Returns the mean length of the edges at a node, in world units.
    fn mean_edge(&self, patchwork: &Patchwork, star: &[(u32, usize)]) -> f64 {
        let lengths = star.iter().map(|&(t, i)| {
            let [a, b, _] = patchwork.triangles.starting_at(t, i).map(|v| patchwork.points[v as usize]);
            self.angles.vector(a, b).length()
        });
        lengths.sum::<f64>() / star.len() as f64
    }
}

/// Returns whether no edge around a node would be too long if the node were at `to`.
fn allows_move(
    patchwork: &Patchwork,
    star: &[(u32, usize)],
    to: LatticePoint,
    answers: &mut LengthAnswers,
) -> bool {
    let mut inside = star.iter().filter(|(t, _)| patchwork.inside[*t as usize]);
    inside.all(|&(t, i)| {
        let former = patchwork.corners(t);
        let mut points = former;
        points[i] = to;
        answers.allow(points, former)
    })
}
