//! The solver of cone programmes, one iteration after the other, so that a window draws between them.
//!
//! [`IPSolver::solve`](clarabel::solver::IPSolver) of clarabel does all iterations in one call, and begins
//! again when it is called again. Its parts are public, so this is the same loop, for symmetric cones: a test
//! compares every bit of both. Only the names of two types are not public, of which it takes values. The
//! version of clarabel is fixed in `Cargo.toml`, since this depends on what they are.

use std::mem::transmute;

use clarabel::algebra::CscMatrix;
use clarabel::solver::traits::{Info, KKTSystem, Residuals, Solution, Variables};
use clarabel::solver::{DefaultSettings, DefaultSolution, DefaultSolver, SolverStatus, SupportedConeT};

use crate::mesh::Progress;

/// A programme that is being solved: minimize q · x subject to b − A x in the cones.
pub(super) struct ConeSolver {
    solver: DefaultSolver<f64>,
    settings: DefaultSettings<f64>,
    /// The iterations that changed the matrix.
    iterations: u32,
    /// The share of the last step that was taken, 0 if none was.
    step: f64,
    centering: f64,
    gap: f64,
    state: State,
}

#[derive(PartialEq, Eq)]
enum State {
    New,
    Iterating,
    Done,
}

/// Returns the value of an enum of clarabel whose name is not public: `StepDirection` or `ScalingStrategy`.
macro_rules! unnamed {
    ($number:expr) => {{
        let number: u32 = $number;
        // SAFETY: each of the two enums has the layout of a u32, by `repr(u32)`, and the values 0 and 1.
        #[expect(unsafe_code, clippy::missing_transmute_annotations, reason = "the type has no public name")]
        unsafe {
            transmute(number)
        }
    }};
}
/// `ScalingStrategy::PrimalDual`, which symmetric cones allow.
const PRIMAL_DUAL: u32 = 0;
/// `StepDirection::Affine`, towards the solution.
const AFFINE: u32 = 0;
/// `StepDirection::Combined`, with a correction towards the middle of the cones.
const COMBINED: u32 = 1;

impl ConeSolver {
    /// Begins a programme with second-order cones; `None` if clarabel does not take it.
    pub fn new(
        objective: &[f64],
        matrix: &CscMatrix<f64>,
        limits: &[f64],
        cones: &[SupportedConeT<f64>],
        settings: DefaultSettings<f64>,
    ) -> Option<Self> {
        let columns = objective.len();
        let none = CscMatrix::zeros((columns, columns));
        let solver = DefaultSolver::new(&none, objective, matrix, limits, cones, settings.clone()).ok()?;
        let state = State::New;
        Some(Self { solver, settings, iterations: 0, step: 0.0, centering: 1.0, gap: 0.0, state })
    }

    /// Does an iteration.
    pub fn advance(&mut self) -> Progress {
        match self.state {
            State::New => {
                self.begin();
                self.state = State::Iterating;
            }
            State::Iterating => {
                if self.iterate().is_none() {
                    self.end();
                    self.state = State::Done;
                }
            }
            State::Done => {}
        }
        if self.state == State::Done { Progress::Done } else { Progress::More }
    }

    /// Returns the result, once it is done.
    pub fn solution(&self) -> &DefaultSolution<f64> {
        &self.solver.solution
    }

    /// Finds a point within the cones.
    fn begin(&mut self) {
        let Self { solver, settings, .. } = self;
        if let Some(timers) = &mut solver.timers {
            solver.info.reset(timers);
        }
        // With the unit of the cones everywhere, all scalings are the identity.
        solver.variables.unit_initialization(&solver.cones);
        solver.variables.scale_cones(&mut solver.cones, 1.0, unnamed!(PRIMAL_DUAL));
        solver.kktsystem.update(&solver.data, &solver.cones, settings);
        solver.kktsystem.solve_initial_point(&mut solver.variables, &solver.data, settings);
        solver.variables.symmetric_initialization(&mut solver.cones);
    }

    /// Takes a step; `None` if there is no further one.
    fn iterate(&mut self) -> Option<()> {
        self.measure();
        if self.solver.info.check_termination(&self.solver.residuals, &self.settings, self.iterations) {
            if self.solver.info.get_status() == SolverStatus::InsufficientProgress {
                // The last step made it worse.
                self.solver.info.reset_to_prev_iterate(&mut self.solver.variables, &self.solver.prev_vars);
            }
            return None;
        }
        let Self { solver, .. } = self;
        if !solver.variables.scale_cones(&mut solver.cones, self.gap, unnamed!(PRIMAL_DUAL)) {
            return self.fail(SolverStatus::NumericalError);
        }
        self.iterations += 1;
        if !self.find_direction() {
            self.step = 0.0;
            return self.fail(SolverStatus::NumericalError);
        }
        self.step = self.longest_step(COMBINED);
        if self.step <= self.settings.min_terminate_step_length.max(0.0) {
            self.step = 0.0;
            return self.fail(SolverStatus::InsufficientProgress);
        }
        let Self { solver, .. } = self;
        solver.info.save_prev_iterate(&solver.variables, &mut solver.prev_vars);
        solver.variables.add_step(&solver.step_lhs, self.step);
        Some(())
    }

    /// Computes how far the point is from a solution.
    fn measure(&mut self) {
        let Self { solver, .. } = self;
        solver.residuals.update(&solver.variables, &solver.data);
        self.gap = solver.variables.calc_mu(&solver.residuals, &solver.cones);
        solver.info.save_scalars(self.gap, self.step, self.centering, self.iterations);
        if let Some(timers) = &solver.timers {
            solver.info.update(&mut solver.data, &solver.variables, &solver.residuals, timers);
        }
    }

    fn fail(&mut self, status: SolverStatus) -> Option<()> {
        self.solver.info.set_status(status);
        None
    }

    /// Finds the direction of the step. Returns whether there is one.
    fn find_direction(&mut self) -> bool {
        let Self { solver, settings, .. } = self;
        let is_factored = solver.kktsystem.update(&solver.data, &solver.cones, settings);
        solver.step_rhs.affine_step_rhs(&solver.residuals, &solver.variables, &solver.cones);
        if !is_factored || !self.solve_towards(AFFINE) {
            return false;
        }
        self.step = self.longest_step(AFFINE);
        let rest = 1.0 - self.step;
        self.centering = rest * rest * rest;
        // The first points may be far from the middle.
        let correction = if self.iterations > 1 { 1.0 } else { self.step };
        let Self { solver, .. } = self;
        solver.step_rhs.combined_step_rhs(
            &solver.residuals,
            &solver.variables,
            &mut solver.cones,
            &mut solver.step_lhs,
            self.centering,
            self.gap,
            correction,
        );
        self.solve_towards(COMBINED)
    }

    fn solve_towards(&mut self, direction: u32) -> bool {
        let Self { solver, settings, .. } = self;
        solver.kktsystem.solve(
            &mut solver.step_lhs,
            &solver.step_rhs,
            &solver.data,
            &solver.variables,
            &mut solver.cones,
            unnamed!(direction),
            settings,
        )
    }

    /// Returns the longest share of a step that stays within the cones.
    fn longest_step(&mut self, direction: u32) -> f64 {
        let Self { solver, settings, .. } = self;
        solver.variables.calc_step_length(&solver.step_lhs, &mut solver.cones, settings, unnamed!(direction))
    }

    fn end(&mut self) {
        let Self { solver, settings, .. } = self;
        if self.step == 0.0 {
            solver.info.save_scalars(self.gap, self.step, self.centering, self.iterations);
        }
        solver.info.post_process(&solver.residuals, settings);
        solver.solution.post_process(&solver.data, &mut solver.variables, &solver.info, settings);
    }
}

#[cfg(test)]
mod tests {
    use clarabel::solver::{DefaultSettingsBuilder, IPSolver};
    use fastrand::Rng;

    use super::*;

    /// Random programmes: most have a solution, some have none or an unbounded one, and some are not solved
    /// within the iterations.
    #[test]
    fn programmes_are_solved_bit_by_bit_as_clarabel_does_in_one_call() {
        let mut random = Rng::with_seed(7);
        let mut seen = std::collections::BTreeMap::<String, u32>::new();
        for round in 0..400 {
            let (columns, cones) = (1 + random.usize(..12), 1 + random.usize(..25));
            let rows = 3 * cones;
            let mut dense = vec![vec![0.0; columns]; rows];
            for row in &mut dense {
                for value in row {
                    *value = if random.f64() < 0.4 { random.f64() - 0.5 } else { 0.0 };
                }
            }
            let matrix = CscMatrix::from(&dense);
            let objective: Vec<f64> = (0..columns).map(|_| random.f64() - 0.5).collect();
            let least = if round % 4 == 0 { -0.5 } else { 0.5 };
            let limit =
                |row: usize, value: f64| if row.is_multiple_of(3) { least + value } else { value - 0.5 };
            let limits: Vec<f64> = (0..rows).map(|row| limit(row, random.f64())).collect();
            let kinds = vec![SupportedConeT::SecondOrderConeT(3); cones];
            let mut settings = DefaultSettingsBuilder::default()
                .verbose(false)
                .presolve_enable(false)
                .max_iter(if round % 5 == 0 { 6 } else { 60 })
                .build()
                .unwrap();
            settings.direct_solve_method = "qdldl".to_owned();
            if round % 7 == 0 {
                (settings.tol_gap_abs, settings.tol_gap_rel, settings.tol_feas) = (1e-16, 1e-16, 1e-16);
            }
            let none = CscMatrix::zeros((columns, columns));
            let mut whole =
                DefaultSolver::new(&none, &objective, &matrix, &limits, &kinds, settings.clone()).unwrap();
            whole.solve();
            let mut stepped = ConeSolver::new(&objective, &matrix, &limits, &kinds, settings).unwrap();
            while stepped.advance() == Progress::More {}
            let (expected, found) = (&whole.solution, stepped.solution());
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            assert_eq!(expected.status, found.status, "round {round}");
            assert_eq!(expected.iterations, found.iterations, "round {round}");
            for (expected, found) in
                [(&expected.x, &found.x), (&expected.z, &found.z), (&expected.s, &found.s)]
            {
                assert_eq!(bits(expected), bits(found), "round {round}: {:?}", whole.solution.status);
            }
            *seen.entry(format!("{:?}", found.status)).or_default() += 1;
        }
        assert!(seen.len() >= 4 && seen["Solved"] > 50, "{seen:?}");
    }
}
