//! Why a triangle is in a mesh: the cause, and what asked for it.

mod ages;
mod bisections;
mod node;
mod sentences;

use crate::build::RefinementCriterion;
use crate::layers::LeastTarget;
use crate::mesh::{Cause, Limits, Mesh, TreeTriangle};
use crate::surface::SurfaceDemand;

pub use ages::{Ages, AgesNow};
pub use bisections::{Bisections, Witness};
pub use node::NodeFacts;
pub use sentences::Words;

/// Why a triangle is in a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The triangle.
    pub triangle: TreeTriangle,
    /// The cause of its existence.
    pub cause: Cause,
    /// Why [`Cause::required_by`] exceeds its target.
    pub demand: Option<Demand>,
}

/// Why a triangle exceeds its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Demand {
    /// The outline of the domain passes through it, and its diameter exceeds that of the boundary.
    Outline,
    /// h̄ is below its diameter at some point.
    Target(LeastTarget),
    /// A surface is farther from it than a layer allows.
    Surface(SurfaceDemand),
}

impl Demand {
    /// Returns why a triangle exceeds its target, if it does.
    fn of(triangle: &TreeTriangle, criterion: &RefinementCriterion<'_>) -> Self {
        let (corners, level) = (triangle.corners(), triangle.level());
        if criterion.outline_asks(corners, level) {
            return Self::Outline;
        }
        let target = || Self::Target(criterion.least_within(corners));
        criterion.surface_demand(corners).map_or_else(target, Self::Surface)
    }
}

impl Explanation {
    /// Returns why a triangle of the bisection tree is in a mesh that is up to date with a criterion and
    /// limits.
    ///
    /// Time grows with the number of levels, not with the mesh.
    pub fn new(
        mesh: &Mesh,
        triangle: TreeTriangle,
        criterion: &RefinementCriterion<'_>,
        limits: &Limits,
    ) -> Self {
        let cause = mesh.cause_of(&triangle, |one| asks_to_bisect(one, criterion, limits));
        let demand = cause.required_by().map(|one| Demand::of(one, criterion));
        Self { triangle, cause, demand }
    }

    /// Returns how many bisections lie between the triangle that exceeds its target and the parent of the
    /// triangle.
    pub fn steps(&self) -> usize {
        match &self.cause {
            Cause::Compatibility { chain } => chain.len() - 1,
            _ => 0,
        }
    }
}

/// Returns whether a triangle exceeds its target, and may be bisected.
pub fn asks_to_bisect(triangle: &TreeTriangle, criterion: &RefinementCriterion<'_>, limits: &Limits) -> bool {
    let is_deepest = limits.max_level.is_some_and(|deepest| triangle.level() >= deepest);
    !is_deepest && criterion.asks_to_bisect(triangle.corners(), triangle.level())
}
