//! Few nodes, solved directly.

use super::growing_rows::GrowingRows;

/// The Cholesky factor of the equations of a few nodes.
#[derive(Clone, Debug)]
pub(crate) struct CoarseSolver {
    /// The nodes.
    nodes: Vec<u32>,
    /// The lower triangle, row by row.
    factor: Vec<f64>,
    /// Nodes without neighbours, with the inverse of their diagonal entries.
    alone: Vec<(u32, f64)>,
}

/// Pivots below this share of their diagonal entry are those of a constant that nothing holds.
const SINGULAR: f64 = 1e-11;

impl CoarseSolver {
    /// Factorizes the rows of nodes.
    pub fn new(rows: &GrowingRows, nodes: Vec<u32>) -> Self {
        let (alone, nodes): (Vec<u32>, Vec<u32>) =
            nodes.into_iter().partition(|&node| rows.row(node).1.is_empty());
        let alone = alone.into_iter().map(|node| (node, inverse(rows.row(node).0))).collect();
        let count = nodes.len();
        let mut factor = vec![0.0; count * count];
        for (i, &node) in nodes.iter().enumerate() {
            let (diagonal, row) = rows.row(node);
            factor[i * count + i] = diagonal;
            for (other, value) in row {
                if let Ok(j) = nodes.binary_search(other) {
                    factor[i * count + j] = *value;
                }
            }
        }
        let mut solver = Self { nodes, factor, alone };
        solver.factorize();
        solver
    }

    fn factorize(&mut self) {
        let count = self.nodes.len();
        let factor = &mut self.factor;
        for i in 0..count {
            for j in 0..=i {
                let (before, row) = factor.split_at(i * count);
                let other = if j < i { &before[j * count..j * count + j] } else { &row[..j] };
                let product: f64 = row[..j].iter().zip(other).map(|(a, b)| a * b).sum();
                let value = row[j] - product;
                factor[i * count + j] = match i == j {
                    // An infinite pivot holds a value that nothing else does at 0.
                    true if value <= SINGULAR * factor[i * count + i] => f64::INFINITY,
                    true => value.sqrt(),
                    false => value / factor[j * count + j],
                };
            }
        }
    }

    /// Replaces the residuals of the nodes in `vector` by their corrections.
    pub fn solve(&self, vector: &mut [f64]) {
        let count = self.nodes.len();
        let mut x: Vec<f64> = self.nodes.iter().map(|&node| vector[node as usize]).collect();
        for i in 0..count {
            let row = &self.factor[i * count..i * count + i];
            let known: f64 = row.iter().zip(&x).map(|(a, b)| a * b).sum();
            x[i] = (x[i] - known) / self.factor[i * count + i];
        }
        for i in (0..count).rev() {
            x[i] /= self.factor[i * count + i];
            let value = x[i];
            let row = &self.factor[i * count..i * count + i];
            x.iter_mut().zip(row).for_each(|(x, entry)| *x -= entry * value);
        }
        self.nodes.iter().zip(x).for_each(|(&node, value)| vector[node as usize] = value);
        for &(node, inverse) in &self.alone {
            vector[node as usize] *= inverse;
        }
    }
}

fn inverse(value: f64) -> f64 {
    if value > 0.0 { 1.0 / value } else { 0.0 }
}
