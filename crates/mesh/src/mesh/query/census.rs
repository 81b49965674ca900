//! Estimates the size of a mesh that has not been made, from a sample of its bisection tree.
//!
//! The tree is walked level by level, from the coarse grid. Of the triangles that are bisected on a level, at
//! most [`Census::SAMPLE`] are followed: evenly spaced ones in the order of the tree, which runs through the
//! domain along a curve without jumps, so the sample is spread over all fine places by their share of
//! triangles. Each then stands for more triangles than itself. Nothing is random: the same question has the
//! same answer.
//!
//! ```text
//!        ▲           a coarse triangle
//!       ╱ ╲          bisected: both halves are followed
//!      ▲   ▲
//!     ╱ ╲   ·        satisfied: a triangle of the mesh, counted with the weight of the level
//!    ▲   ▲
//!    ┆              too many on this level: every k-th is followed, with k times the weight
//! ```

use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Limits, Mesh, Progress, TreeTriangle, TriangleId};

/// Estimates in slices how many triangles the mesh of a rule would have on the coarse grid of another mesh,
/// in time that does not grow with that number. Up to [`Self::SAMPLE`] triangles a level, all are looked at.
#[derive(Clone, Debug)]
pub struct Census {
    max_level: u32,
    /// The triangles of this level that are followed, in the order of the tree.
    followed: Vec<TreeTriangle>,
    /// How many of them were looked at.
    next: usize,
    /// How many triangles each of them stands for.
    weight: f64,
    /// The halves of those that are bisected.
    halves: Vec<TreeTriangle>,
    triangles: f64,
}

/// How far a bisection is followed to the triangles that it needs: each step is one level coarser.
const CHAIN: u32 = 2;

impl Census {
    /// The most triangles of a level that are followed.
    pub const SAMPLE: usize = 2048;

    /// Creates a census of the mesh of another rule on the coarse grid of `mesh`.
    pub fn new(mesh: &Mesh, limits: &Limits) -> Self {
        let max_level = limits.level_cap().min(mesh.lattice().deepest_level());
        let halves = coarse_triangles(mesh).collect();
        let mut census =
            Self { max_level, followed: Vec::new(), next: 0, weight: 1.0, halves, triangles: 0.0 };
        census.go_down();
        census
    }

    /// Returns the number of triangles in the domain: an estimate once done, and before that the part of it
    /// that was looked at.
    pub fn triangles(&self) -> f64 {
        self.triangles
    }

    /// Looks at triangles until done or until `visits` were looked at.
    ///
    /// `exceeds` is the rule, by corners and level; it must be monotone. `is_in_domain` returns whether a
    /// triangle, by corners and level, lies in the domain. `mesh` is that of [`Self::new`]; only its coarse
    /// grid is used.
    pub fn advance(
        &mut self,
        mesh: &Mesh,
        exceeds: impl Fn([LatticePoint; 3], u32) -> bool,
        is_in_domain: impl Fn([LatticePoint; 3], u32) -> bool,
        visits: usize,
    ) -> Progress {
        let exceeds = |triangle: &TreeTriangle| exceeds(triangle.corners(), triangle.level());
        for _ in 0..visits {
            let Some(&triangle) = self.followed.get(self.next) else { return Progress::Done };
            self.next += 1;
            if triangle.level() < self.max_level && self.is_bisected(mesh, &triangle, &exceeds, CHAIN) {
                self.halves.extend(triangle.children());
            } else if is_in_domain(triangle.corners(), triangle.level()) {
                self.triangles += self.weight;
            }
            if self.next == self.followed.len() {
                self.go_down();
            }
        }
        if self.next < self.followed.len() { Progress::More } else { Progress::Done }
    }

    /// Goes to the next level, with a sample of its triangles.
    fn go_down(&mut self) {
        self.next = 0;
        self.followed.clear();
        let count = self.halves.len();
        if count <= Self::SAMPLE {
            std::mem::swap(&mut self.followed, &mut self.halves);
            return;
        }
        // In the middle of equal parts: neither first nor second halves are preferred.
        let place = |n: usize| (2 * n + 1) * count / (2 * Self::SAMPLE);
        self.followed.extend((0..Self::SAMPLE).map(|n| self.halves[place(n)]));
        self.halves.clear();
        self.weight *= count as f64 / Self::SAMPLE as f64;
    }

    /// Returns whether a triangle of the tree exceeds its target, or must be bisected because one across its
    /// edges does: across the bisection edge one of the same level, across the legs finer ones.
    fn is_bisected(
        &self,
        mesh: &Mesh,
        triangle: &TreeTriangle,
        exceeds: &impl Fn(&TreeTriangle) -> bool,
        chain: u32,
    ) -> bool {
        if exceeds(triangle) || triangle.across(mesh).is_some_and(|across| exceeds(&across)) {
            return true;
        }
        if chain == 0 || triangle.level() + 1 >= self.max_level {
            return false;
        }
        let across_legs = triangle.children().map(|half| half.across(mesh));
        across_legs.iter().flatten().any(|finer| self.is_bisected(mesh, finer, exceeds, chain - 1))
    }
}

/// Returns the coarse triangles of a mesh, row by row.
fn coarse_triangles(mesh: &Mesh) -> impl Iterator<Item = TreeTriangle> + '_ {
    // The entry of a coarse triangle is one of its parts.
    let entry = |number| TreeTriangle::from_mesh(mesh, TriangleId::from_index(number));
    (0..mesh.coarse_triangles()).map(move |number| {
        let mut triangle = entry(number);
        while let Some(parent) = triangle.parent(mesh.lattice()) {
            triangle = parent;
        }
        triangle
    })
}
