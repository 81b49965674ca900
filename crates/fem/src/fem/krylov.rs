//! Conjugate gradients, and GMRES where convection makes the equations unsymmetric.

use rayon::prelude::*;

use super::cycle::Cycle;
use super::fem_error::FemError;
use super::matrix::{Matrix, add_scaled, dot, scale_and_add};

/// How many steps a solver may do.
pub(crate) const MOST_STEPS: usize = 1000;
/// Directions that GMRES keeps before it begins again.
const KEPT: usize = 80;

/// What a solver did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Steps {
    pub count: usize,
    /// The last residual as a share of the first, each in the norm that the V-cycle gives.
    pub reduction: f64,
}

/// Solves by conjugate gradients with V-cycles, until the residual is `share` of the first one. `x` is where
/// it begins. `span` is what nothing determines, a constant: residuals have no part in it.
///
/// # Errors
/// Fails when that takes too many steps.
pub(crate) fn conjugate_gradients(
    matrix: &Matrix,
    right: &[f64],
    x: &mut [f64],
    cycle: &mut Cycle,
    share: f64,
) -> Result<Steps, FemError> {
    let mut residual = residual(matrix, right, x);
    let mut corrected = residual.clone();
    cycle.apply(&mut corrected);
    let mut direction = corrected.clone();
    let mut product = vec![0.0; x.len()];
    let first = reference(right, cycle);
    let mut size = dot(&residual, &corrected);
    let mut count = 0;
    while size > share * share * first && count < MOST_STEPS {
        matrix.multiply(&direction, &mut product);
        let step = size / dot(&direction, &product);
        if !step.is_finite() {
            break;
        }
        add_scaled(x, step, &direction);
        add_scaled(&mut residual, -step, &product);
        corrected.copy_from_slice(&residual);
        cycle.apply(&mut corrected);
        let next = dot(&residual, &corrected);
        scale_and_add(&mut direction, next / size, &corrected);
        size = next;
        count += 1;
    }
    let reduction = if first > 0.0 { (size.max(0.0) / first).sqrt() } else { 0.0 };
    finished(count, reduction, share)
}

/// Returns the square of the norm of the right side that residuals are compared with.
fn reference(right: &[f64], cycle: &mut Cycle) -> f64 {
    let mut corrected = right.to_vec();
    cycle.apply(&mut corrected);
    dot(right, &corrected)
}

fn finished(count: usize, reduction: f64, share: f64) -> Result<Steps, FemError> {
    // Near the accuracy of the arithmetic the last digits may not come.
    if reduction <= 1e3 * share {
        Ok(Steps { count, reduction })
    } else {
        Err(FemError::NoConvergence { steps: count, reduction })
    }
}

fn residual(matrix: &Matrix, right: &[f64], x: &[f64]) -> Vec<f64> {
    let mut residual = vec![0.0; x.len()];
    matrix.multiply(x, &mut residual);
    residual.par_iter_mut().zip(right).for_each(|(product, right)| *product = right - *product);
    residual
}

/// Solves by GMRES with V-cycles before the product, until the residual is `share` of the right side.
///
/// # Errors
/// Fails when that takes too many steps.
pub(crate) fn gmres(
    matrix: &Matrix,
    right: &[f64],
    x: &mut [f64],
    cycle: &mut Cycle,
    share: f64,
) -> Result<Steps, FemError> {
    let first = dot(right, right).sqrt();
    let mut count = 0;
    let mut size = f64::INFINITY;
    while count < MOST_STEPS {
        let residual = residual(matrix, right, x);
        let before = size;
        size = dot(&residual, &residual).sqrt();
        // Once a round gains nothing, the arithmetic has no more.
        if size <= share * first || size > 0.9 * before {
            break;
        }
        let mut round = Round::new(residual, size);
        while round.count() < KEPT && count < MOST_STEPS && round.left() > 0.3 * share * first {
            round.advance(matrix, cycle);
            count += 1;
        }
        add_scaled(x, 1.0, &round.correction(cycle));
    }
    let reduction = if first > 0.0 { size / first } else { 0.0 };
    finished(count, reduction, share)
}

/// Steps of GMRES from one residual.
struct Round {
    /// Orthonormal directions.
    basis: Vec<Vec<f64>>,
    /// The triangular factor, column by column.
    columns: Vec<Vec<f64>>,
    /// Rotations that made it triangular: cosines and sines.
    rotations: Vec<[f64; 2]>,
    /// The rotated right side.
    right: Vec<f64>,
}

impl Round {
    fn new(mut residual: Vec<f64>, size: f64) -> Self {
        residual.par_iter_mut().for_each(|value| *value /= size);
        Self { basis: vec![residual], columns: Vec::new(), rotations: Vec::new(), right: vec![size] }
    }

    fn count(&self) -> usize {
        self.columns.len()
    }

    /// Returns the norm of the residual after the steps so far.
    fn left(&self) -> f64 {
        self.right[self.count()].abs()
    }

    fn advance(&mut self, matrix: &Matrix, cycle: &mut Cycle) {
        let mut corrected = self.basis[self.count()].clone();
        cycle.apply(&mut corrected);
        let mut next = vec![0.0; corrected.len()];
        matrix.multiply(&corrected, &mut next);
        let mut column = Vec::with_capacity(self.count() + 2);
        for known in &self.basis {
            let share = dot(known, &next);
            add_scaled(&mut next, -share, known);
            column.push(share);
        }
        let size = dot(&next, &next).sqrt();
        if size > 0.0 {
            next.par_iter_mut().for_each(|value| *value /= size);
        }
        for (n, [cosine, sine]) in self.rotations.iter().enumerate() {
            let [a, b] = [column[n], column[n + 1]];
            [column[n], column[n + 1]] = [cosine * a + sine * b, cosine * b - sine * a];
        }
        let last = column.len() - 1;
        let radius = (column[last] * column[last] + size * size).sqrt();
        let [cosine, sine] = if radius > 0.0 { [column[last] / radius, size / radius] } else { [1.0, 0.0] };
        column[last] = radius;
        let right = self.right[last];
        self.right[last] = cosine * right;
        self.right.push(-sine * right);
        self.rotations.push([cosine, sine]);
        self.columns.push(column);
        self.basis.push(next);
    }

    /// Returns what the steps add to the solution.
    fn correction(&self, cycle: &mut Cycle) -> Vec<f64> {
        let mut shares = self.right[..self.count()].to_vec();
        for n in (0..self.count()).rev() {
            shares[n] = if self.columns[n][n] > 0.0 { shares[n] / self.columns[n][n] } else { 0.0 };
            for before in 0..n {
                shares[before] -= self.columns[n][before] * shares[n];
            }
        }
        let mut sum = vec![0.0; self.basis[0].len()];
        shares.iter().zip(&self.basis).for_each(|(share, direction)| add_scaled(&mut sum, *share, direction));
        cycle.apply(&mut sum);
        sum
    }
}
