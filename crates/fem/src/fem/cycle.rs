//! One V-cycle: an approximate solution of the equations for a residual.

use super::hierarchy::{AgeLevel, Hierarchy};

/// Room for V-cycles.
#[derive(Clone, Debug)]
pub(crate) struct Cycle<'a> {
    hierarchy: &'a Hierarchy,
    /// Right sides and first corrections of the smoothed nodes of each level.
    levels: Vec<LevelVectors>,
}

#[derive(Clone, Debug)]
struct LevelVectors {
    right: Vec<f64>,
    first: Vec<f64>,
}

impl<'a> Cycle<'a> {
    pub fn new(hierarchy: &'a Hierarchy) -> Self {
        let vectors = |level: &AgeLevel| {
            let count = level.smoothed.len();
            LevelVectors { right: vec![0.0; count], first: vec![0.0; count] }
        };
        Self { hierarchy, levels: hierarchy.levels.iter().map(vectors).collect() }
    }

    /// Replaces a residual by a correction: a symmetric, positive map.
    ///
    /// Going down, the nodes of a level are smoothed once in their order, going up once in the opposite
    /// order.
    pub fn apply(&mut self, vector: &mut [f64]) {
        for (level, vectors) in self.hierarchy.levels.iter().zip(&mut self.levels) {
            level.go_down(vector, vectors);
        }
        self.hierarchy.coarse.solve(vector);
        for (level, vectors) in self.hierarchy.levels.iter().zip(&self.levels).rev() {
            level.go_up(vector, vectors);
        }
    }
}

impl AgeLevel {
    /// Smooths residuals, and hands on what is left to the parents.
    fn go_down(&self, residual: &mut [f64], vectors: &mut LevelVectors) {
        for (right, &node) in vectors.right.iter_mut().zip(&self.smoothed) {
            *right = residual[node as usize];
        }
        for (n, &node) in self.smoothed.iter().enumerate() {
            let correction = residual[node as usize] / self.rows.diagonal[n];
            vectors.first[n] = correction;
            residual[node as usize] = 0.0;
            for (column, value) in self.rows.row(n) {
                residual[column] -= value * correction;
            }
        }
        for (n, &node) in self.new.iter().enumerate() {
            let left = residual[node as usize];
            for &(parent, weight) in self.weights_of(n) {
                residual[parent as usize] += weight * left;
            }
        }
    }

    /// Interpolates the corrections of older nodes, and smooths.
    fn go_up(&self, correction: &mut [f64], vectors: &LevelVectors) {
        for (n, &node) in self.new.iter().enumerate().rev() {
            let mean =
                self.weights_of(n).iter().map(|&(parent, weight)| weight * correction[parent as usize]);
            correction[node as usize] = mean.sum();
        }
        for (&node, first) in self.smoothed.iter().zip(&vectors.first) {
            correction[node as usize] += first;
        }
        for (n, &node) in self.smoothed.iter().enumerate().rev() {
            let beside: f64 = self.rows.row(n).map(|(column, value)| value * correction[column]).sum();
            correction[node as usize] = (vectors.right[n] - beside) / self.rows.diagonal[n];
        }
    }

    #[inline]
    fn weights_of(&self, new: usize) -> &[(u32, f64)] {
        &self.weights[self.weight_start[new] as usize..self.weight_start[new + 1] as usize]
    }
}
