//! The equations of the nodes.

use rayon::prelude::*;

use super::boundary_data::BoundaryData;
use super::element::{ElementData, ElementShape};
use super::fem_mesh::{FemMesh, NONE};
use super::matrix::Matrix;
use crate::geometry::NumberMap;

/// The equations of the nodes where u is not given; rows of the others are those of u = 0.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    /// The part of diffusion, reaction and boundary, which is symmetric.
    pub symmetric: Matrix,
    /// The whole, where there is convection.
    pub whole: Option<Matrix>,
    /// The right side, with the values that are given.
    pub right: Vec<f64>,
}

/// Nodes that a thread assembles at a time.
const CHUNK: usize = 4096;

impl Equations {
    /// Assembles them. Every entry is a sum over triangles in ascending order, so neither the number of
    /// threads nor the order of the mesh changes a bit.
    pub fn of(mesh: &FemMesh, data: &[ElementData], boundary: &BoundaryData) -> Self {
        let edges = mesh.edges.iter().enumerate();
        let edge_at = edges.map(|(n, edge)| ((edge.triangle, edge.opposite as u32), n)).collect();
        let assembly = Assembly { mesh, data, boundary, edge_at };
        let has_convection = data.iter().any(|data| data.convection != glam::DVec2::ZERO);
        let (symmetric, right) = assembly.matrix(false);
        if !has_convection {
            return Self { symmetric, whole: None, right };
        }
        let (whole, right) = assembly.matrix(true);
        Self { symmetric, whole: Some(whole), right }
    }

    /// Returns the matrix of the equations.
    pub fn matrix(&self) -> &Matrix {
        self.whole.as_ref().unwrap_or(&self.symmetric)
    }
}

struct Assembly<'a> {
    mesh: &'a FemMesh,
    data: &'a [ElementData],
    boundary: &'a BoundaryData,
    /// Boundary edges by triangle and opposite corner.
    edge_at: NumberMap<(u32, u32), usize>,
}

/// Rows of some nodes.
#[derive(Default)]
struct Rows {
    diagonal: Vec<f64>,
    lengths: Vec<u32>,
    entries: Vec<(u32, f64)>,
    right: Vec<f64>,
}

/// One row, while it grows.
#[derive(Default)]
struct Row {
    diagonal: f64,
    right: f64,
    entries: Vec<(u32, f64)>,
}

impl Row {
    #[inline]
    fn add(&mut self, column: u32, value: f64) {
        match self.entries.iter_mut().find(|(known, _)| *known == column) {
            Some((_, sum)) => *sum += value,
            None => self.entries.push((column, value)),
        }
    }
}

impl Assembly<'_> {
    fn matrix(&self, with_convection: bool) -> (Matrix, Vec<f64>) {
        let count = self.mesh.node_count();
        let chunk = |chunk: usize| {
            let mut rows = Rows::default();
            let mut row = Row::default();
            for node in CHUNK * chunk..count.min(CHUNK * (chunk + 1)) {
                self.fill(&mut row, node, with_convection);
                rows.diagonal.push(row.diagonal);
                rows.right.push(row.right);
                rows.lengths.push(row.entries.len() as u32);
                rows.entries.extend_from_slice(&row.entries);
            }
            rows
        };
        let chunks: Vec<Rows> = (0..count.div_ceil(CHUNK)).into_par_iter().map(chunk).collect();
        let diagonal = chunks.iter().flat_map(|rows| &rows.diagonal).copied().collect();
        let lengths: Vec<u32> = chunks.iter().flat_map(|rows| &rows.lengths).copied().collect();
        let right = chunks.iter().flat_map(|rows| &rows.right).copied().collect();
        let entries = chunks.into_iter().map(|rows| rows.entries).collect();
        (Matrix::of_rows(diagonal, &lengths, entries), right)
    }

    /// Makes the row of a node.
    fn fill(&self, row: &mut Row, node: usize, with_convection: bool) {
        row.entries.clear();
        (row.diagonal, row.right) = (0.0, 0.0);
        if self.boundary.is_fixed(node) {
            row.diagonal = 1.0;
            return;
        }
        for &triangle in self.mesh.fan(node) {
            self.add_triangle(row, node, triangle as usize, with_convection);
        }
        let fixed = &self.boundary.fixed;
        let known = row.entries.iter().filter(|(column, _)| !fixed[*column as usize].is_nan());
        row.right -= known.map(|(column, value)| value * fixed[*column as usize]).sum::<f64>();
        // A third of the entries are zero: those beside the right angles.
        row.entries.retain(|(column, value)| *value != 0.0 && fixed[*column as usize].is_nan());
        row.entries.sort_unstable_by_key(|(column, _)| *column);
    }

    fn add_triangle(&self, row: &mut Row, node: usize, triangle: usize, with_convection: bool) {
        let (corners, data) = (self.mesh.corners[triangle], &self.data[triangle]);
        let shape = ElementShape::of(self.mesh, triangle);
        let own = (0..3).find(|&k| corners[k] as usize == node).unwrap_or(0);
        let mass = shape.measure() * data.reaction / 12.0;
        row.right += data.loads[own];
        for (k, &column) in corners.iter().enumerate() {
            let mut value = data.diffusion * coupling(&shape, own, k) + mass;
            if with_convection {
                value += shape.drift(data.convection, shape.gradients[k]) / 3.0;
            }
            match k == own {
                true => row.diagonal += value + mass,
                false => row.add(column, value),
            }
        }
        for opposite in (0..3).filter(|&k| k != own && self.mesh.across[triangle][k] == NONE) {
            self.add_edge(row, node, triangle, opposite);
        }
    }

    fn add_edge(&self, row: &mut Row, node: usize, triangle: usize, opposite: usize) {
        let Some(&number) = self.edge_at.get(&(triangle as u32, opposite as u32)) else { return };
        let (edge, data) = (&self.mesh.edges[number], &self.boundary.edges[number]);
        let own = usize::from(edge.ends[1] as usize == node);
        let mass = data.transfer * edge.length / 6.0;
        row.right += data.loads[own];
        row.diagonal += 2.0 * mass;
        if mass != 0.0 {
            row.add(edge.ends[1 - own], mass);
        }
    }
}

/// Returns the integral of the product of the gradients of two hat functions: 0 where they are orthogonal up
/// to rounding.
fn coupling(shape: &ElementShape, i: usize, j: usize) -> f64 {
    let [v, w] = [shape.gradients[i], shape.gradients[j]];
    let value = shape.energy(v, w);
    let is_rounding = value.abs() <= 1e-14 * (shape.energy(v, v) + shape.energy(w, w));
    if is_rounding { 0.0 } else { value }
}
