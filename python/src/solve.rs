//! Finite elements on a mesh.

use meshbrush_cli::cli::solved_mesh::{ErrorGoal, ErrorRound, MeshByError};
use meshbrush_core::field::Formula;
use meshbrush_fem::fem::FemProblem;
use meshbrush_io::io::settings::SavedSettings;
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{fault_in, mesh_error};
use crate::mesh::{Mesh, Shared};
use crate::values::text_value;
use crate::work::{Watching, run};

/// The mesh where it is another one, u at its nodes, the part of the bound of each triangle, the figures, why
/// the bound is an estimate, and the meshes by the error.
type SolutionArrays<'py> = (
    Option<Py<Mesh>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    SolutionFigures,
    Vec<String>,
    Vec<(usize, f64)>,
);

/// The bound, the energy error where the solution is known, the energy norm, the steps of the solver, and
/// whether the mean is set to 0.
type SolutionFigures = (f64, Option<f64>, f64, usize, bool);

#[pymethods]
impl Mesh {
    /// Solves a problem, whose table has the keys of the table `problem` of a recipe. Triangles are bisected
    /// until the bound of the error is `within`, or there are `at_most` triangles, if one of them is given.
    fn solve<'py>(
        slf: &Bound<'py, Self>,
        table: &Bound<'py, PyDict>,
        within: Option<f64>,
        at_most: Option<usize>,
        watching: Watching,
    ) -> PyResult<SolutionArrays<'py>> {
        let (problem, exact) = problem_of(table, slf)?;
        let goal = goal(within, at_most)?;
        let shared = slf.get().0.clone();
        let found = run(slf.py(), &watching, move |watch| {
            let goes_on = |triangles: usize| {
                watch.tell("solving", triangles as u64);
                !watch.is_cancelled()
            };
            let solved = MeshByError::new(&shared.finished, &problem, exact.as_ref(), goal, goes_on);
            solved.map(|solved| (solved, shared.name.clone()))
        })?;
        let (by_error, name) = found.map_err(|error| mesh_error(error.to_string()))?;
        let (finished, solved, rounds) = by_error.into_parts();
        let py = slf.py();
        let of_mesh = finished.as_ref().unwrap_or(&slf.get().0.finished);
        let [u, bounds] = [solved.values_in_files(of_mesh), solved.bounds_in_files(of_mesh)];
        let mesh = finished.map(|finished| Py::new(py, Mesh(Shared::new(finished, name)))).transpose()?;
        let (solution, bound) = (&solved.solution, &solved.bound);
        let norm = solution.energy_norm(&solved.mesh);
        let figures = (bound.total, solved.error, norm, solution.steps, solution.has_mean_zero);
        let round = |round: ErrorRound| (round.triangles, round.energy_error_bound);
        Ok((
            mesh,
            u.into_pyarray(py),
            bounds.into_pyarray(py),
            figures,
            bound.doubts.iter().map(ToString::to_string).collect(),
            rounds.into_iter().map(round).collect(),
        ))
    }
}

/// Returns the problem of a table, and the formula of its solution.
fn problem_of(table: &Bound<'_, PyDict>, mesh: &Bound<'_, Mesh>) -> PyResult<(FemProblem, Option<Formula>)> {
    let tables = PyDict::new(table.py());
    tables.set_item("problem", table)?;
    let tables = text_value(&tables)?;
    let unit = mesh.get().0.finished.unit();
    let saved = SavedSettings::of_value_for(&tables, unit).map_err(|fault| fault_in(&tables, &fault))?;
    let of_table = |fault: meshbrush_io::io::KeyFault| fault_in(&tables, &fault.within("problem"));
    Ok((saved.problem.problem().map_err(of_table)?, saved.problem.solution().map_err(of_table)?))
}

fn goal(within: Option<f64>, at_most: Option<usize>) -> PyResult<ErrorGoal> {
    match (within, at_most) {
        (Some(_), Some(_)) => {
            let sentence =
                "within and at_most both say when triangles are bisected no more. Give one of them.";
            Err(mesh_error(sentence.to_owned()))
        }
        (Some(within), None) if !(within > 0.0 && within.is_finite()) => {
            Err(mesh_error(format!("within = {within}: give a bound of the energy error above 0, as 0.01.")))
        }
        (Some(within), None) => Ok(ErrorGoal::Within(within)),
        (None, Some(most)) => Ok(ErrorGoal::AtMost(most)),
        (None, None) => Ok(ErrorGoal::Document),
    }
}
