//! What the numbers of nodes are worth to a solver: products with a matrix of linear elements.

use std::hint::black_box;
use std::time::{Duration, Instant};

use meshbrush_core::document::{Document, Follower};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::mesh::Extract;

use crate::window::{Slices, median_ms};

/// Products that are measured, each with both numberings.
const PRODUCTS: usize = 15;

/// A mesh as files get it, by its own numbers and by those of files.
pub struct Numberings {
    /// Number of nodes.
    pub nodes: usize,
    /// Milliseconds of a product by the numbers of the mesh, and by those of files.
    pub products: [f64; 2],
    /// Milliseconds to number the mesh for files.
    pub numbering: f64,
}

impl Numberings {
    /// Makes the mesh of a document, and measures. Products are on one thread.
    pub fn of(mut document: Document) -> Self {
        let mut follower = Follower::new(&mut document).expect("it has a mesh");
        Slices::default().follow(&mut document, &mut follower);
        let targets = follower.edge_targets(document.paint());
        let cleaning = document.settings().derived_cleaning();
        let derived = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning);
        let made = derived.extract(follower.mesh());
        let began = Instant::now();
        let in_files = made.clone().along_curve();
        let numbering = 1e3 * began.elapsed().as_secs_f64();
        let mut systems = [&made, &in_files].map(Laplacian::new);
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..PRODUCTS {
            for (system, times) in systems.iter_mut().zip(&mut times) {
                times.push(system.multiply());
            }
        }
        Self { nodes: made.nodes().len(), products: times.map(median_ms), numbering }
    }
}

/// A matrix with the pattern of linear elements, by rows, and two vectors.
struct Laplacian {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    given: Vec<f64>,
    product: Vec<f64>,
}

impl Laplacian {
    fn new(mesh: &Extract) -> Self {
        let count = mesh.nodes().len();
        let mut neighbours: Vec<[u32; 2]> = (0..count as u32).map(|node| [node, node]).collect();
        for edge in mesh.edges() {
            let [a, b] = edge.ends.map(|node| node as u32);
            neighbours.extend([[a, b], [b, a]]);
        }
        neighbours.sort_unstable();
        let mut starts = vec![0; count + 1];
        neighbours.iter().for_each(|[row, _]| starts[*row as usize + 1] += 1);
        (0..count).for_each(|row| starts[row + 1] += starts[row]);
        let value = |&[row, column]: &[u32; 2]| if row == column { 4.0 } else { -0.5 };
        Self {
            values: neighbours.iter().map(value).collect(),
            columns: neighbours.iter().map(|[_, column]| *column).collect(),
            starts,
            given: vec![1.0; count],
            product: vec![0.0; count],
        }
    }

    fn multiply(&mut self) -> Duration {
        let began = Instant::now();
        for (sum, ends) in self.product.iter_mut().zip(self.starts.windows(2)) {
            let row = ends[0] as usize..ends[1] as usize;
            let terms = self.columns[row.clone()].iter().zip(&self.values[row]);
            *sum = terms.map(|(&column, value)| value * self.given[column as usize]).sum();
        }
        black_box(&mut self.product);
        began.elapsed()
    }
}
