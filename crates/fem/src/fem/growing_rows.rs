//! Rows of a symmetric matrix from which nodes are eliminated.

use super::matrix::Matrix;

/// Rows in one array, with room to grow.
#[derive(Clone, Debug)]
pub(crate) struct GrowingRows {
    diagonal: Vec<f64>,
    rows: Vec<Span>,
    entries: Vec<(u32, f64)>,
    /// The row that is being eliminated.
    scratch: Vec<(u32, f64)>,
}

/// The entries of a row.
#[derive(Clone, Copy, Debug)]
struct Span {
    start: usize,
    length: u32,
    room: u32,
}

/// Entries that a row may gain before it moves.
const SPARE: u32 = 2;

impl GrowingRows {
    pub fn of(matrix: &Matrix) -> Self {
        let count = matrix.diagonal.len();
        let mut rows = Vec::with_capacity(count);
        let mut entries = Vec::with_capacity(matrix.columns.len() + SPARE as usize * count);
        for row in 0..count {
            let start = entries.len();
            entries.extend(matrix.row(row).map(|(column, value)| (column as u32, value)));
            let length = (entries.len() - start) as u32;
            entries.resize(entries.len() + SPARE as usize, (0, 0.0));
            rows.push(Span { start, length, room: length + SPARE });
        }
        Self { diagonal: matrix.diagonal.clone(), rows, entries, scratch: Vec::new() }
    }

    /// Returns the diagonal entry of a node, and its others.
    pub fn row(&self, node: u32) -> (f64, &[(u32, f64)]) {
        let span = self.rows[node as usize];
        let entries = &self.entries[span.start..span.start + span.length as usize];
        (self.diagonal[node as usize], entries)
    }

    /// Returns copies of rows.
    pub fn copied(&self, nodes: &[u32]) -> Matrix {
        let mut copy = Matrix { start: vec![0], ..Matrix::default() };
        let total = nodes.iter().map(|&node| self.rows[node as usize].length as usize).sum();
        copy.columns.reserve_exact(total);
        copy.values.reserve_exact(total);
        for &node in nodes {
            let (diagonal, row) = self.row(node);
            copy.diagonal.push(diagonal);
            copy.columns.extend(row.iter().map(|(column, _)| *column));
            copy.values.extend(row.iter().map(|(_, value)| *value));
            copy.start.push(copy.columns.len() as u32);
        }
        copy
    }

    /// Eliminates a node whose value is the sum of those of other nodes by `weights`.
    pub fn eliminate(&mut self, node: u32, weights: &[(u32, f64)]) {
        let mut row = std::mem::take(&mut self.scratch);
        let (diagonal, entries) = self.row(node);
        row.clear();
        row.extend_from_slice(entries);
        self.rows[node as usize].length = 0;
        for &(other, _) in &row {
            self.remove(other, node);
        }
        for &(parent, weight) in weights {
            for &(other, value) in &row {
                if other == parent {
                    self.diagonal[parent as usize] += 2.0 * weight * value;
                } else {
                    self.add(parent, other, weight * value);
                }
            }
        }
        for (n, &(parent, weight)) in weights.iter().enumerate() {
            self.diagonal[parent as usize] += weight * weight * diagonal;
            for &(other, share) in &weights[..n] {
                self.add(parent, other, weight * share * diagonal);
            }
        }
        self.scratch = row;
    }

    fn remove(&mut self, row: u32, column: u32) {
        let span = &mut self.rows[row as usize];
        let entries = &mut self.entries[span.start..span.start + span.length as usize];
        if let Some(place) = entries.iter().position(|(known, _)| *known == column) {
            entries.swap(place, span.length as usize - 1);
            span.length -= 1;
        }
    }

    /// Adds to the entries of two nodes.
    fn add(&mut self, a: u32, b: u32, value: f64) {
        self.add_to(a, b, value);
        self.add_to(b, a, value);
    }

    fn add_to(&mut self, row: u32, column: u32, value: f64) {
        let span = self.rows[row as usize];
        let entries = &mut self.entries[span.start..span.start + span.length as usize];
        if let Some((_, known)) = entries.iter_mut().find(|(known, _)| *known == column) {
            *known += value;
            return;
        }
        if span.length == span.room {
            let start = self.entries.len();
            self.entries.extend_from_within(span.start..span.start + span.length as usize);
            self.entries.resize(start + 2 * span.room as usize + 2, (0, 0.0));
            self.rows[row as usize] = Span { start, room: 2 * span.room + 2, ..span };
        }
        let span = &mut self.rows[row as usize];
        self.entries[span.start + span.length as usize] = (column, value);
        span.length += 1;
    }
}
