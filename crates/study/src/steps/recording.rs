//! A recording of a run of Algorithm 12, step by step.

use std::ops::Range;

use super::pseudo_code::{Algorithm, NeighbourCase};
use super::stages::{StageChange, StepStage};
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::{Orientation, Triangle};

/// A row of 𝒯: V(t), N(t), O(t), L(t). A neighbour is a number from 1, [`BOUNDARY`], or 0 while it is not
/// known yet.
pub type ReportRow = [i32; 8];

/// The reference β to a null boundary triangle.
pub const BOUNDARY: i32 = -1;

/// Returns a triangle as a row of 𝒯.
pub(super) fn report_row(triangle: &Triangle) -> ReportRow {
    let [a, b, c] = triangle.vertices.map(|vertex| vertex.index() as i32 + 1);
    let [p, q, r] =
        triangle.raw_neighbours.map(|across| across.triangle().map_or(BOUNDARY, |id| id.index() as i32 + 1));
    [
        a,
        b,
        c,
        p,
        q,
        r,
        i32::from(triangle.orientation() == Orientation::Anticlockwise),
        triangle.level() as i32,
    ]
}

/// The action of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepAction {
    /// Asks whether t_i exceeds its target.
    Visit {
        /// Whether it does.
        exceeds: bool,
        /// Whether this goes beyond the report: t_i was satisfied before compatibility bisected it.
        again: bool,
    },
    /// Puts t_i on the stack, as its bisection neighbour is coarser.
    Push,
    /// Finds that t_i and its bisection neighbour are compatibly divisible, or that its bisection edge is on
    /// the boundary.
    Divisible,
    /// Takes t_i from the stack.
    Pop,
    /// Bisects t_i, and its bisection neighbour if it has one: vertices, orientations and levels.
    Bisect,
    /// Updates the neighbours of the halves, and of the triangles around them.
    UpdateNeighbours(NeighbourCase),
    /// The end of the refinement: no triangle exceeds its target.
    Finish,
    /// A stage that follows: triangles outside the domain are removed, or nodes move onto its outline.
    Derive(StageChange),
}

/// A step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordedStep {
    /// The action of the step.
    pub action: StepAction,
    /// Number i of the triangle that it is about; 0 at the end.
    pub triangle: u32,
    /// Number of the triangle that Algorithm 12 visits; 0 at the end.
    pub visited: u32,
    /// Number i_b of the bisection neighbour, before the two are bisected; `None` at the boundary.
    pub across: Option<u32>,
    /// L(t_i), before it is bisected.
    pub level: u8,
    /// k(t_i), before it is bisected.
    pub k: u8,
    /// O(t_i), before it is bisected.
    pub orientation: u8,
    /// O(t_b), before it is bisected.
    pub orientation_across: Option<u8>,
    /// Number of the new node, of a step that bisects.
    pub new_node: Option<u32>,
    /// The index of the step's first change. Its changes end at the first change of the next step.
    pub(super) first_change: u32,
}

impl RecordedStep {
    /// Returns a step that is about no triangle of its own.
    pub(super) fn of_all(action: StepAction, first_change: usize) -> Self {
        Self {
            action,
            triangle: 0,
            visited: 0,
            across: None,
            level: 0,
            k: 0,
            orientation: 0,
            orientation_across: None,
            new_node: None,
            first_change: first_change as u32,
        }
    }

    /// Returns whether the mesh is another one after the step.
    pub fn changes_mesh(&self) -> bool {
        matches!(self.action, StepAction::Bisect | StepAction::Derive(_))
    }

    /// Returns the algorithm that the step belongs to, and which of its lines it runs, counted from 1.
    pub fn lines(&self) -> (Algorithm, Range<usize>) {
        use Algorithm::{
            BisectBoundaryTriangle, BisectTriangles, BisectTrianglesInStack, RefineMesh, RefineTriangle,
        };
        match (self.action, self.across.is_some(), self.k) {
            (StepAction::Visit { exceeds: true, .. }, ..) => (RefineMesh, 5..7),
            (StepAction::Visit { exceeds: false, .. }, ..) => (RefineMesh, 7..8),
            (StepAction::Push, ..) => (RefineTriangle, 8..11),
            (StepAction::Divisible, true, _) => (RefineTriangle, 5..8),
            (StepAction::Divisible, false, _) => (RefineTriangle, 2..5),
            (StepAction::Pop, ..) => (BisectTrianglesInStack, 2..4),
            (StepAction::Bisect, true, 1) => (BisectTriangles, 13..22),
            (StepAction::Bisect, true, _) => (BisectTriangles, 22..31),
            (StepAction::Bisect, false, 1) => (BisectBoundaryTriangle, 9..14),
            (StepAction::Bisect, false, _) => (BisectBoundaryTriangle, 14..19),
            (StepAction::UpdateNeighbours(case), ..) => {
                let algorithm = case.algorithm();
                (algorithm, 1..algorithm.lines().len() + 1)
            }
            (StepAction::Finish, ..) => (RefineMesh, 8..10),
            (StepAction::Derive(change), ..) => change.lines(),
        }
    }

    /// Describes the step in a sentence.
    pub fn sentence(&self) -> String {
        let i = self.triangle;
        match (self.action, self.across) {
            (StepAction::Visit { exceeds: true, again: false }, _) => {
                format!("Triangle {i} exceeds its target: RefineTriangle({i}).")
            }
            (StepAction::Visit { exceeds: true, again: true }, _) => {
                format!(
                    "Triangle {i} was satisfied, but this half of it exceeds its target: RefineTriangle({i})."
                )
            }
            (StepAction::Visit { exceeds: false, .. }, _) => {
                format!("Triangle {i} satisfies the rule: on to the next one.")
            }
            (StepAction::Push, Some(across)) => {
                format!(
                    "Triangle {across} across the bisection edge is coarser: triangle {i} waits on the stack."
                )
            }
            (StepAction::Divisible, Some(across)) => {
                format!("Triangles {i} and {across} have the same level: they are compatibly divisible.")
            }
            (StepAction::Divisible | StepAction::Push, None) => {
                format!("The bisection edge of triangle {i} is on the boundary: it is bisected alone.")
            }
            (StepAction::Pop, _) => format!("Triangle {i} is taken from the stack."),
            (StepAction::Bisect, Some(across)) => format!("Triangles {i} and {across} are bisected."),
            (StepAction::Bisect, None) => format!("Triangle {i} is bisected."),
            (StepAction::UpdateNeighbours(case), _) => {
                format!("The neighbours of the halves are updated: {}.", case.algorithm().name())
            }
            (StepAction::Finish, _) => "No triangle exceeds its target.".into(),
            (StepAction::Derive(change), _) => change.sentence(),
        }
    }
}

/// A row of 𝒯 before and after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowChange {
    /// Number of the triangle.
    pub number: u32,
    /// The row before; `None` of a new row.
    pub before: Option<ReportRow>,
    /// The row after.
    pub after: ReportRow,
}

/// All steps of a run of Algorithm 12, and of what follows it.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The grid and lattice of the mesh.
    pub lattice: Lattice,
    /// 𝒩 at the end. At an earlier step it has fewer nodes, but the same ones.
    pub nodes: Vec<LatticePoint>,
    /// How many nodes the coarse grid has.
    pub coarse_nodes: usize,
    /// 𝒯 before the first step.
    pub coarse_rows: Vec<ReportRow>,
    /// Whether the run was stopped because the mesh became too large.
    pub is_cut_short: bool,
    pub(super) steps: Vec<RecordedStep>,
    pub(super) changes: Vec<RowChange>,
    /// What follows the refinement; the last steps, one for each.
    pub(super) stages: Vec<StepStage>,
}

impl Recording {
    /// Returns the steps, in order.
    pub fn steps(&self) -> &[RecordedStep] {
        &self.steps
    }

    /// Returns the stages that follow the refinement.
    pub fn stages(&self) -> &[StepStage] {
        &self.stages
    }

    /// Adds what follows the refinement.
    pub(super) fn with_stages(mut self, stages: Vec<StepStage>) -> Self {
        let step =
            |stage: &StepStage| RecordedStep::of_all(StepAction::Derive(stage.change), self.changes.len());
        self.steps.extend(stages.iter().map(step));
        self.stages = stages;
        self
    }

    /// Returns the rows that step `index` changes, counted from 0, in the order in which they are written.
    pub fn changes(&self, index: usize) -> &[RowChange] {
        let end = self.steps.get(index + 1).map_or(self.changes.len(), |next| next.first_change as usize);
        &self.changes[self.steps[index].first_change as usize..end]
    }
}
