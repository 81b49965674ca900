//! Changes triangles around defects until none can be removed.

use super::census::{BoundaryCensus, MOST_AT_A_NODE};
use crate::domain::RegionOnLattice;
use crate::geometry::{LatticePoint, LatticeRect};
use crate::outline::angles::{Angles, COT_25};
use crate::outline::lengths::{AskedArea, LengthRule};
use crate::outline::local::{Improver, LineNodeState, LocalMesh};
use crate::outline::triangulation::NONE;

/// Changes of an island at most: each removes a defect.
const MOST_CHANGES: usize = 1000;

/// How much flatter than the mesh a triangle may be right after a flip, as a factor of the cotangent.
const FLATTEST: f64 = 4.0;

/// What is the same for all islands.
pub(in crate::outline) struct RepairRules<'a> {
    pub(super) angles: Angles,
    pub(super) lengths: LengthRule<'a>,
    pub(super) region: &'a RegionOnLattice,
    /// The upper right corner of the lattice.
    pub(super) extent: LatticePoint,
}

/// Triangles around some defects.
#[derive(Clone)]
struct DefectTriangles {
    local: LocalMesh,
    /// For each node, whether it is on the boundary.
    is_on_boundary: Vec<bool>,
    /// For each node of the start, the number of its triangles that are not here.
    elsewhere: Vec<usize>,
}

/// The number of defects, and the cotangent of the smallest angle.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Badness {
    defects: usize,
    worst: f64,
}

/// A change that the improver would not make by itself, as angles become smaller at first. Edges are named by
/// their nodes.
#[derive(Clone, Copy)]
enum Attempt {
    /// Flips an edge.
    Flip([u32; 2]),
    /// Puts a node into the middle of an edge.
    Halve([u32; 2]),
    /// Puts nodes into the middles of two edges.
    HalveBoth([[u32; 2]; 2]),
}

pub(super) struct DefectIsland<'a> {
    now: DefectTriangles,
    badness: Badness,
    rules: &'a RepairRules<'a>,
    asked: AskedArea,
}

impl<'a> DefectIsland<'a> {
    pub(super) fn new(local: LocalMesh, census: &BoundaryCensus, rules: &'a RepairRules<'a>) -> Self {
        let is_on_boundary = local.ids.iter().map(|id| census.is_on_boundary(id.index())).collect();
        let mut elsewhere: Vec<usize> = local.ids.iter().map(|id| census.count(id.index())).collect();
        local.triangles.corners.iter().flatten().for_each(|&v| elsewhere[v as usize] -= 1);
        let now = DefectTriangles { local, is_on_boundary, elsewhere };
        let badness = now.badness(&rules.angles);
        Self { now, badness, rules, asked: AskedArea::default() }
    }

    /// Returns the triangles with fewer defects, and the area in which targets were asked for.
    pub(super) fn repaired(mut self) -> (LocalMesh, Option<LatticeRect>) {
        let mut improved = self.now.clone();
        self.improve(&mut improved);
        let badness = improved.badness(&self.rules.angles);
        self.take(improved, badness);
        for _ in 0..MOST_CHANGES {
            let attempts = self.now.attempts(&self.rules.angles);
            if !attempts.into_iter().any(|attempt| self.try_out(attempt)) {
                break;
            }
        }
        (self.now.local, self.asked.rect())
    }

    fn improve(&self, triangles: &mut DefectTriangles) {
        let RepairRules { angles, lengths, region, extent } = self.rules;
        let mut improver = Improver {
            angles,
            answers: lengths.answers_noted(&self.asked),
            extent: *extent,
            segments: &[],
            slides_along: Some(region),
        };
        improver.run(&mut triangles.local);
    }

    /// Takes triangles in the place of those now, if they are better.
    fn take(&mut self, triangles: DefectTriangles, badness: Badness) -> bool {
        let is_better = badness.defects < self.badness.defects
            || (badness.defects == self.badness.defects && badness.worst < self.badness.worst);
        if is_better && badness.worst <= self.badness.worst.max(COT_25) {
            (self.now, self.badness) = (triangles, badness);
            return true;
        }
        false
    }

    /// Makes a change if that leads to fewer defects.
    fn try_out(&mut self, attempt: Attempt) -> bool {
        let mut triangles = self.now.clone();
        if !triangles.apply(attempt, self.rules, &self.asked) {
            return false;
        }
        self.improve(&mut triangles);
        let badness = triangles.badness(&self.rules.angles);
        badness.defects < self.badness.defects && self.take(triangles, badness)
    }
}

impl DefectTriangles {
    fn alive(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.local.triangles.len() as u32).filter(|&t| self.local.is_alive(t))
    }

    /// Returns the number of triangles at each node, with those elsewhere.
    fn counts(&self) -> Vec<usize> {
        let mut counts = self.elsewhere.clone();
        counts.resize(self.local.points.len(), 0);
        self.alive()
            .flat_map(|t| self.local.triangles.corners[t as usize])
            .for_each(|v| counts[v as usize] += 1);
        counts
    }

    fn is_between(&self, t: u32) -> bool {
        self.local.triangles.corners[t as usize].iter().all(|&v| self.is_on_boundary[v as usize])
    }

    fn badness(&self, angles: &Angles) -> Badness {
        let (mut defects, mut worst) = (0, 0.0f64);
        for t in self.alive() {
            let own = angles.worst(self.local.corners(t));
            worst = worst.max(own);
            defects += usize::from(own > COT_25) + usize::from(self.is_between(t));
        }
        defects += self.counts().iter().map(|count| count.saturating_sub(MOST_AT_A_NODE)).sum::<usize>();
        Badness { defects, worst }
    }

    /// Returns changes that may remove a defect.
    fn attempts(&self, angles: &Angles) -> Vec<Attempt> {
        let (mut attempts, mut pairs, counts) = (Vec::new(), Vec::new(), self.counts());
        let is_crowded = |ends: &[u32; 2]| ends.iter().any(|&v| counts[v as usize] > MOST_AT_A_NODE);
        for t in self.alive() {
            let is_inner = |i: &usize| self.local.triangles.across[t as usize][*i] != NONE;
            let ends = |i: usize| {
                let [_, b, c] = self.local.triangles.starting_at(t, i);
                [b, c]
            };
            let edges: Vec<[u32; 2]> = (0..3).filter(is_inner).map(ends).collect();
            if angles.worst(self.local.corners(t)) > COT_25 || self.is_between(t) {
                attempts.extend(edges.iter().flat_map(|&ends| [Attempt::Flip(ends), Attempt::Halve(ends)]));
                let others = |n: usize| edges[..n].iter().map(move |&other| (n, other));
                let both = (0..edges.len()).flat_map(others);
                pairs.extend(both.map(|(n, other)| Attempt::HalveBoth([edges[n], other])));
            } else {
                attempts.extend(edges.into_iter().filter(is_crowded).map(Attempt::Flip));
            }
        }
        attempts.append(&mut pairs);
        attempts
    }

    /// Makes a change. Returns whether it was possible.
    fn apply(&mut self, attempt: Attempt, rules: &RepairRules, asked: &AskedArea) -> bool {
        match attempt {
            Attempt::Flip(ends) => self.flip(ends, rules, asked),
            Attempt::Halve(ends) => self.halve(ends),
            Attempt::HalveBoth([first, second]) => self.halve(first) && self.halve(second),
        }
    }

    /// Returns the triangle to the left of an edge within, and its corner opposite the edge.
    fn beside(&self, [from, to]: [u32; 2]) -> Option<(u32, usize)> {
        let (triangles, mut star) = (&self.local.triangles, Vec::new());
        triangles.star(from, &mut star);
        let (t, i) = star.into_iter().find(|&(t, i)| triangles.starting_at(t, i)[1] == to)?;
        let opposite = (i + 2) % 3;
        (triangles.across[t as usize][opposite] != NONE).then_some((t, opposite))
    }

    fn flip(&mut self, ends: [u32; 2], rules: &RepairRules, asked: &AskedArea) -> bool {
        let Some((t, i)) = self.beside(ends) else { return false };
        let Some((d, _)) = self.local.opposite(t, i) else { return false };
        let [a, b, c] = self.local.triangles.starting_at(t, i);
        let [a, b, c, d] = [a, b, c, d].map(|v| self.local.points[v as usize]);
        let (new, former, mut answers) =
            ([[a, b, d], [a, d, c]], [a, b, c], rules.lengths.answers_noted(asked));
        let may = new.iter().all(|&points| {
            rules.angles.worst(points) < FLATTEST * rules.angles.limit() && answers.allow(points, former)
        });
        if may {
            self.local.flip(t, i);
        }
        may
    }

    fn halve(&mut self, ends: [u32; 2]) -> bool {
        let Some((t, i)) = self.beside(ends) else { return false };
        let [a, b] = ends.map(|v| self.local.points[v as usize]);
        let middle = LatticePoint::new((a.x + b.x) / 2, (a.y + b.y) / 2);
        if middle == a || middle == b {
            return false;
        }
        let x = self.local.add_node(middle, LineNodeState::Free, false);
        self.local.split_edge(t, i, x);
        self.is_on_boundary.push(false);
        true
    }
}
