//! Sparse matrices over nodes, and sums that do not depend on the number of threads.

use rayon::prelude::*;

/// Numbers that one thread adds up: sums are those of such pieces, in order.
const PIECE: usize = 4096;

/// A square matrix, with the diagonal apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matrix {
    pub diagonal: Vec<f64>,
    /// The entries of row i are those from `start[i]` to `start[i + 1]`.
    pub start: Vec<u32>,
    pub columns: Vec<u32>,
    pub values: Vec<f64>,
}

impl Matrix {
    /// Puts rows together: how many entries each has, and all entries in order.
    pub fn of_rows(diagonal: Vec<f64>, lengths: &[u32], entries: Vec<Vec<(u32, f64)>>) -> Self {
        let mut start = Vec::with_capacity(lengths.len() + 1);
        let mut end = 0;
        start.push(0);
        for length in lengths {
            end += length;
            start.push(end);
        }
        let columns = entries.iter().flatten().map(|(column, _)| *column).collect();
        let values = entries.iter().flatten().map(|(_, value)| *value).collect();
        Self { diagonal, start, columns, values }
    }

    /// Returns the entries of a row beside the diagonal.
    #[inline]
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[row] as usize..self.start[row + 1] as usize;
        let columns = self.columns[range.clone()].iter().map(|&column| column as usize);
        columns.zip(self.values[range].iter().copied())
    }

    /// Stores the product with a vector.
    pub fn multiply(&self, vector: &[f64], product: &mut [f64]) {
        product.par_chunks_mut(PIECE).enumerate().for_each(|(piece, product)| {
            for (row, product) in (PIECE * piece..).zip(product) {
                let beside: f64 = self.row(row).map(|(column, value)| value * vector[column]).sum();
                *product = self.diagonal[row] * vector[row] + beside;
            }
        });
    }
}

/// Returns the sum of f over 0..count, the same for any number of threads.
pub(crate) fn sum_of(count: usize, f: impl Fn(usize) -> f64 + Sync) -> f64 {
    let pieces: Vec<f64> = (0..count.div_ceil(PIECE))
        .into_par_iter()
        .map(|piece| (PIECE * piece..count.min(PIECE * (piece + 1))).map(&f).sum())
        .collect();
    pieces.into_iter().sum()
}

/// Returns the scalar product of two vectors.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    sum_of(a.len(), |n| a[n] * b[n])
}

/// Adds a multiple of a vector to another.
pub(crate) fn add_scaled(target: &mut [f64], factor: f64, vector: &[f64]) {
    target.par_chunks_mut(PIECE).zip(vector.par_chunks(PIECE)).for_each(|(target, vector)| {
        target.iter_mut().zip(vector).for_each(|(target, value)| *target += factor * value);
    });
}

/// Replaces a vector by itself times a factor plus another.
pub(crate) fn scale_and_add(target: &mut [f64], factor: f64, vector: &[f64]) {
    target.par_chunks_mut(PIECE).zip(vector.par_chunks(PIECE)).for_each(|(target, vector)| {
        target.iter_mut().zip(vector).for_each(|(target, value)| *target = factor * *target + value);
    });
}
