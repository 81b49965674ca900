//! Commands about the figures of the mesh.

use meshbrush_io::io::solver_rules::Solver;
use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with the figures of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StatisticsCommand {
    /// Computes the figures of the mesh.
    Measure,
    /// Shows time steps for this Courant number.
    SetCourant(f64),
    /// Checks the mesh by the rules of another solver.
    ChooseSolver(Solver),
    /// Checks the mesh by the rules of the solver.
    CheckRules,
    /// Adds layers with which the mesh keeps the rules of the solver, as far as smaller triangles help.
    Repair,
    /// Gives up looking for these layers.
    StopRepair,
}

impl CommandSet for StatisticsCommand {}
