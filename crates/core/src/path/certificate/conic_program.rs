//! The dual problem as a second-order cone program (SOCP).
//!
//! ```text
//! maximize    v(goal) − v(start)
//! subject to  |∇v at corner i of t| ≤ ℓ at corner i of t     for all triangles t and their corners i
//! ```
//!
//! Gradient and bound are divided by ℓ, and v by the cost of the known path, so that all numbers are near 1.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSettingsBuilder, SupportedConeT};
use glam::DVec2;

use super::minorant::Minorant;
use super::quadratic::QuadraticSpace;
use super::solver::ConeSolver;

/// The solver's answer. It need not be optimal or feasible to be useful.
pub(super) struct ConicSolution {
    /// The values of v, in the unit of the cost.
    pub function: Vec<f64>,
    /// For each triangle and corner the multiplier of its cone in world coordinates: the amount and the
    /// direction of the path there.
    pub flows: Vec<[DVec2; 3]>,
    /// How many steps the solver took.
    pub steps: u32,
}

/// The second-order cone program of a space of functions.
pub(super) struct ConicProgram<'a> {
    pub space: &'a QuadraticSpace,
    /// ℓ in each triangle.
    pub minorants: &'a [Minorant],
    /// The functional v(goal) − v(start), as weights of values.
    pub gain: &'a [(u32, f64)],
    /// The value that is 0.
    pub pinned: u32,
    /// The cost of the known path.
    pub unit: f64,
    /// Relative accuracy that is enough.
    pub accuracy: f64,
}

impl ConicProgram<'_> {
    /// Begins to solve it. `None` where the solver does not take it.
    pub(super) fn solver(&self) -> Option<ConeSolver> {
        let rows = 9 * self.space.elements.len();
        let columns = self.space.values - 1;
        let matrix = self.matrix(rows, columns);
        let limits: Vec<f64> = (0..rows).map(|row| if row % 3 == 0 { 1.0 } else { 0.0 }).collect();
        let cones = vec![SupportedConeT::SecondOrderConeT(3); rows / 3];
        let mut objective = vec![0.0; columns];
        for &(number, weight) in self.gain {
            if let Some(column) = self.column(number) {
                objective[column] -= weight;
            }
        }
        ConeSolver::new(&objective, &matrix, &limits, &cones, self.settings())
    }

    /// Returns the solution; `None` where the solver failed without any answer.
    pub(super) fn solution(&self, solver: &ConeSolver) -> Option<ConicSolution> {
        let solution = solver.solution();
        let is_finite = solution.x.iter().all(|value| value.is_finite());
        is_finite.then(|| ConicSolution {
            function: self.function(&solution.x),
            flows: self.flows(&solution.z),
            steps: solution.iterations,
        })
    }

    fn settings(&self) -> DefaultSettings<f64> {
        DefaultSettingsBuilder::default()
            .verbose(false)
            .max_iter(60)
            .tol_gap_abs(self.accuracy)
            .tol_gap_rel(self.accuracy)
            .tol_feas(0.1 * self.accuracy)
            .presolve_enable(false)
            .iterative_refinement_max_iter(2)
            .direct_solve_method("qdldl".to_owned())
            .build()
            .expect("the settings are valid")
    }

    /// Returns the column of a value; the pinned one has none.
    fn column(&self, number: u32) -> Option<usize> {
        match number.cmp(&self.pinned) {
            std::cmp::Ordering::Less => Some(number as usize),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(number as usize - 1),
        }
    }

    /// The rows are those of s = b − A x, in the cone: for each triangle and corner 1 and the two components
    /// of the gradient.
    fn matrix(&self, rows: usize, columns: usize) -> CscMatrix<f64> {
        let mut entries = Vec::with_capacity(8 * rows / 3);
        for (index, (element, minorant)) in self.space.elements.iter().zip(self.minorants).enumerate() {
            for corner in 0..3 {
                let frame = element.frame(corner);
                let row = 9 * index + 3 * corner;
                let scale = self.unit / minorant.at_corners[corner];
                let first = scale / frame.length;
                let second = scale / frame.across;
                for (number, weight) in element.along_edge(corner, frame.step) {
                    entries.push((number, row + 1, -weight * first));
                    let skewed = weight * second * frame.skew / frame.length;
                    if frame.skew.abs() > 1e-12 * frame.length {
                        entries.push((number, row + 2, skewed));
                    }
                }
                for (number, weight) in element.along_edge(corner, 3 - frame.step) {
                    entries.push((number, row + 2, -weight * second));
                }
            }
        }
        let entries = entries.into_iter();
        let entries = entries.filter_map(|(number, row, value)| Some((self.column(number)?, row, value)));
        compressed(entries.collect(), rows, columns)
    }

    fn function(&self, solution: &[f64]) -> Vec<f64> {
        let value = |number| self.column(number).map_or(0.0, |column| self.unit * solution[column]);
        (0..self.space.values as u32).map(value).collect()
    }

    fn flows(&self, multipliers: &[f64]) -> Vec<[DVec2; 3]> {
        let of_corner = |index: usize, corner: usize| {
            let [_, first, second] = [0, 1, 2].map(|part| multipliers[9 * index + 3 * corner + part]);
            let scale = self.unit / self.minorants[index].at_corners[corner];
            self.space.elements[index].frame(corner).world([first * scale, second * scale])
        };
        (0..self.minorants.len()).map(|index| [0, 1, 2].map(|corner| of_corner(index, corner))).collect()
    }
}

/// Returns a matrix by columns from its entries (column, row, value); entries at the same place are added.
fn compressed(mut entries: Vec<(usize, usize, f64)>, rows: usize, columns: usize) -> CscMatrix<f64> {
    entries.sort_unstable_by_key(|&(column, row, _)| (column, row));
    let mut starts = vec![0; columns + 1];
    let (mut row_of, mut values): (Vec<usize>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut last = None;
    for (column, row, value) in entries {
        if last == Some((column, row)) {
            *values.last_mut().expect("there is an entry before") += value;
        } else {
            last = Some((column, row));
            row_of.push(row);
            values.push(value);
            starts[column + 1] += 1;
        }
    }
    for column in 0..columns {
        starts[column + 1] += starts[column];
    }
    CscMatrix::new(rows, columns, starts, row_of, values)
}
