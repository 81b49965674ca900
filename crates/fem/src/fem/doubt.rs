//! Why a bound is only an estimate.

use std::fmt;

use super::fem_mesh::FemMesh;
use super::problem::{BoundaryCondition, FemProblem};
use super::solution::FemSolution;
use crate::field::Formula;
use crate::geometry::Rect;

/// Why a bound is an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Doubt {
    /// There is convection.
    Convection,
    /// Lengths are those on the Earth.
    Earth,
    /// A Dirichlet condition is not linear along the edges.
    DirichletData,
    /// A flux or a transfer is not constant or linear along the edges.
    FluxData,
    /// The reaction is not a number.
    Reaction,
    /// The diffusion jumps inside triangles, or its range there is not known.
    Diffusion,
    /// The range of the source is not known, or it may jump.
    Source,
    /// Nothing but the balance of source and flux holds the solution.
    Balance,
    /// Triangles meet in a node without sharing an edge.
    Pinches,
}

impl Doubt {
    const ALL: [Self; 9] = [
        Self::Convection,
        Self::Earth,
        Self::DirichletData,
        Self::FluxData,
        Self::Reaction,
        Self::Diffusion,
        Self::Source,
        Self::Balance,
        Self::Pinches,
    ];
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Convection => {
                "with convection the energy error is bounded only up to a factor that is not known"
            }
            Self::Earth => "on the Earth the scale is taken at the middle of each triangle",
            Self::DirichletData => "a value on the boundary is not linear along its edges",
            Self::FluxData => {
                "a flux or a transfer through the boundary is not constant or linear along its edges"
            }
            Self::Reaction => "the reaction is not one number",
            Self::Diffusion => "the diffusion jumps in triangles, or intervals do not bound it there",
            Self::Source => "the source may jump in triangles, or intervals do not bound it there",
            Self::Balance => "only the balance of source and flux, which holds up to rounding, determines u",
            Self::Pinches => "triangles meet in a node without sharing an edge",
        })
    }
}

/// A set of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Doubts(u16);

impl Doubts {
    pub fn add(&mut self, doubt: Doubt) {
        self.0 |= 1 << doubt as u16;
    }

    pub fn add_all(&mut self, other: Self) {
        self.0 |= other.0;
    }

    pub fn list(self) -> Vec<Doubt> {
        Doubt::ALL.into_iter().filter(|&doubt| self.0 & (1 << doubt as u16) != 0).collect()
    }

    /// Returns those that follow from the problem as a whole.
    pub fn of_problem(
        mesh: &FemMesh,
        problem: &FemProblem,
        solution: &FemSolution,
        has_pinches: bool,
    ) -> Self {
        let mut doubts = Self::default();
        let mut add_if = |is_there: bool, doubt: Doubt| {
            if is_there {
                doubts.add(doubt);
            }
        };
        add_if(problem.convection.is_some(), Doubt::Convection);
        add_if(!mesh.metric.is_empty(), Doubt::Earth);
        add_if(problem.reaction.constant().is_none(), Doubt::Reaction);
        add_if(solution.has_mean_zero, Doubt::Balance);
        add_if(has_pinches, Doubt::Pinches);
        let bounds = Rect::holding(mesh.points.iter().copied());
        let is_linear = |formula: &Formula| bounds.as_ref().is_some_and(|rect| is_linear(formula, rect));
        for named in &problem.conditions {
            match &named.condition {
                BoundaryCondition::Dirichlet(value) => add_if(!is_linear(value), Doubt::DirichletData),
                BoundaryCondition::Neumann(flux) => add_if(!is_linear(flux), Doubt::FluxData),
                BoundaryCondition::Robin { transfer, flux } => {
                    add_if(!is_linear(flux) || transfer.constant().is_none(), Doubt::FluxData);
                }
            }
        }
        doubts
    }
}

/// Returns whether a formula is linear in a rectangle.
fn is_linear(formula: &Formula, rect: &Rect) -> bool {
    let has_one_slope =
        || formula.derivatives(rect).is_some_and(|along| along.iter().all(|slope| slope.is_one()));
    formula.constant().is_some() || has_one_slope()
}
