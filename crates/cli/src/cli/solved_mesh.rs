//! A problem on a mesh of the document, and on meshes that its error makes.

use super::build::FinishedMesh;
use super::mesh_by_error_failure::MeshByErrorFailure;
use meshbrush_core::build::BuildError;
use meshbrush_core::field::Formula;
use meshbrush_fem::fem::{ErrorBound, FemError, FemMesh, FemProblem, FemSolution, PlaneMetric};
use meshbrush_mesh::mesh::{Extract, TriangleId};
use meshbrush_mesh::text::{Number, rounded};

/// The Péclet number of a triangle above which a person is told.
const LARGE_PECLET: f64 = 2.0;

/// A problem that was solved on a mesh.
pub struct SolvedMesh {
    /// The mesh.
    pub mesh: FemMesh,
    /// The solution.
    pub solution: FemSolution,
    /// The bound of its error.
    pub bound: ErrorBound,
    /// The energy error, where the solution is known.
    pub error: Option<f64>,
}

impl SolvedMesh {
    /// Solves a problem. `extract` is [`FinishedMesh::extract_as_made`].
    ///
    /// # Errors
    /// Fails when it has no solution.
    fn of(
        finished: &FinishedMesh,
        extract: &Extract,
        problem: &FemProblem,
        exact: Option<&Formula>,
    ) -> Result<Self, FemError> {
        let conditions = problem.conditions_on(&finished.boundary(extract))?;
        let homes = finished.mesh().homes_with(finished.derived.patch());
        let mesh = FemMesh::new(extract, &homes, &PlaneMetric::of(finished.domain(), finished.unit()));
        let solution = FemSolution::new(&mesh, problem, &conditions)?;
        let bound = ErrorBound::of(&mesh, problem, &solution);
        let error = exact.map(|exact| solution.error_from(&mesh, problem, exact)).transpose()?;
        Ok(Self { mesh, solution, bound, error })
    }

    /// Returns u at the nodes of [`FinishedMesh::extract`].
    pub fn values_in_files(&self, finished: &FinishedMesh) -> Vec<f64> {
        finished.curve_order().of_nodes(&self.mesh.values_in_extract(&self.solution.values))
    }

    /// Returns the part of the bound of each triangle of [`FinishedMesh::extract`].
    pub fn bounds_in_files(&self, finished: &FinishedMesh) -> Vec<f64> {
        finished.curve_order().of_triangles(&self.mesh.triangles_in_extract(&self.bound.of_triangles))
    }

    /// Returns what a person should know, a sentence each.
    pub fn notes(&self, problem: &FemProblem, finished: &FinishedMesh, extract: &Extract) -> Vec<String> {
        let boundary = finished.boundary(extract);
        let mut notes: Vec<String> = problem
            .conditions_without_edges(&boundary)
            .into_iter()
            .map(|piece| format!("The mesh has no edge of “{piece}”: its condition changes nothing."))
            .collect();
        if self.solution.has_mean_zero {
            notes.push("Conditions and source determine u up to a constant: its mean is 0.".into());
        }
        if let Some((peclet, at)) = self.solution.peclet.filter(|(peclet, _)| *peclet > LARGE_PECLET) {
            notes.push(format!(
                "The Péclet number |b| h / 2a is up to {}, at x = {}, y = {}: above 1, u can oscillate from node to node. \
                 Smaller triangles there, or more diffusion, help.",
                short(peclet),
                Number(at.x),
                Number(at.y)
            ));
        }
        notes
    }
}

/// When triangles are bisected no more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorGoal {
    /// The mesh is that of the document.
    Document,
    /// The bound is at most this.
    Within(f64),
    /// There are at most so many triangles.
    AtMost(usize),
}

/// One mesh of a sequence.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct ErrorRound {
    /// Its triangles.
    pub triangles: usize,
    /// Its nodes.
    pub nodes: usize,
    /// Steps of the solver.
    pub steps: usize,
    /// The bound of the energy error.
    pub energy_error_bound: f64,
    /// The energy error, where the solution is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_error: Option<f64>,
}

/// The part of the square of the bound whose triangles are bisected.
const BULK: f64 = 0.5;
/// The most meshes of a sequence.
const MOST_ROUNDS: usize = 400;
/// How often fewer triangles are tried, where those marked are too many.
const FEWER: usize = 8;

/// A mesh by the error, and how it came about.
pub struct MeshByError {
    /// The last mesh; `None` where it is that of the document.
    finished: Option<FinishedMesh>,
    /// The solution on it.
    pub solved: SolvedMesh,
    /// All meshes, from that of the document.
    pub rounds: Vec<ErrorRound>,
}

impl MeshByError {
    /// Solves, and bisects the triangles with the largest parts of the bound, until the goal is reached. The
    /// meshes are a function of the mesh of the document, the problem and the goal. `goes_on` is called with
    /// the number of triangles before each solution.
    ///
    /// # Errors
    /// Fails when the problem has no solution, a limit is reached before the bound is, or nobody wants the
    /// result any more.
    pub fn new(
        document: &FinishedMesh,
        problem: &FemProblem,
        exact: Option<&Formula>,
        goal: ErrorGoal,
        mut goes_on: impl FnMut(usize) -> bool,
    ) -> Result<Self, MeshByErrorFailure> {
        let mut finished: Option<FinishedMesh> = None;
        let mut rounds = Vec::new();
        loop {
            let current = finished.as_ref().unwrap_or(document);
            let extract = current.extract_as_made();
            if !goes_on(extract.triangles().len()) {
                return Err(MeshByErrorFailure::Cancelled);
            }
            let solved = SolvedMesh::of(current, &extract, problem, exact)?;
            rounds.push(solved.round());
            let next = if rounds.len() < MOST_ROUNDS { solved.next(current, goal)? } else { None };
            match next {
                Some(next) => finished = Some(next),
                None => return Ok(Self { finished, solved, rounds }),
            }
        }
    }

    /// Returns the last mesh; `document` is the first.
    pub fn finished<'a>(&'a self, document: &'a FinishedMesh) -> &'a FinishedMesh {
        self.finished.as_ref().unwrap_or(document)
    }

    /// Returns the last mesh where it is not that of the document.
    pub fn into_parts(self) -> (Option<FinishedMesh>, SolvedMesh, Vec<ErrorRound>) {
        (self.finished, self.solved, self.rounds)
    }
}

impl SolvedMesh {
    fn round(&self) -> ErrorRound {
        ErrorRound {
            triangles: self.mesh.triangle_count(),
            nodes: self.mesh.node_count(),
            steps: self.solution.steps,
            energy_error_bound: self.bound.total,
            energy_error: self.error,
        }
    }

    /// Returns the triangles to bisect, the worst first.
    fn marked(&self, finished: &FinishedMesh) -> Vec<TriangleId> {
        let sources = finished.mesh().sources_with(finished.derived.patch());
        self.bound.marked(&self.mesh, &sources, BULK)
    }

    /// Returns the next mesh, if there is one.
    fn next(
        &self,
        finished: &FinishedMesh,
        goal: ErrorGoal,
    ) -> Result<Option<FinishedMesh>, MeshByErrorFailure> {
        let bound = self.bound.total;
        match goal {
            ErrorGoal::Within(asked) if bound > asked => {
                let triangles = self.mesh.triangle_count();
                let limit = |error| MeshByErrorFailure::Limit { asked, bound, triangles, error };
                finished.bisected(&self.marked(finished)).map(Some).map_err(limit)
            }
            ErrorGoal::AtMost(most) => Ok(self.bisected_to(finished, most)?),
            ErrorGoal::Document | ErrorGoal::Within(_) => Ok(None),
        }
    }

    /// Returns the mesh with as many of the marked triangles bisected as there is room for; `None` if there
    /// is none for any.
    fn bisected_to(&self, finished: &FinishedMesh, most: usize) -> Result<Option<FinishedMesh>, BuildError> {
        let mut marked = self.marked(finished);
        for _ in 0..FEWER {
            if marked.is_empty() || self.mesh.triangle_count() >= most {
                break;
            }
            let next = finished.bisected(&marked)?;
            if next.extract_as_made().triangles().len() <= most {
                return Ok(Some(next));
            }
            marked.truncate(marked.len() / 2);
        }
        Ok(None)
    }
}

/// Six significant digits.
pub fn short(value: f64) -> Number {
    Number(rounded(value, 6))
}
