//! The cells of a file as a graph: their places and their neighbours.

use crate::io::written_cells::WrittenCells;
use meshbrush_mesh::mesh::{Extract, TriangleId};

/// Cells, each joined with those beside it, in the order of their places: so the graph does not depend on the
/// numbers of the cells in the file.
pub struct CellGraph {
    /// The sums of the coordinates of three corners of each cell, on the lattice.
    places: Vec<[i64; 2]>,
    /// Where the neighbours of each cell begin, and where those of the last one end.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

impl CellGraph {
    /// Returns the cells of a file, and the number of each of them there.
    pub fn of_file(mesh: &Extract, cells: &WrittenCells<'_>) -> (Self, Vec<u32>) {
        let place = |cell: usize| {
            let [first, second] = cells.triangles(cell).map(|triangle| place_of(mesh, triangle));
            first.min(second)
        };
        let mut order: Vec<([i64; 2], u32)> =
            (0..cells.count()).map(|cell| (place(cell), cell as u32)).collect();
        order.sort_unstable();
        let numbers: Vec<u32> = order.iter().map(|&(_, number)| number).collect();
        let mut cell_of = vec![0; mesh.triangles().len()];
        for (cell, &number) in numbers.iter().enumerate() {
            cells.triangles(number as usize).into_iter().for_each(|triangle| cell_of[triangle] = cell as u32);
        }
        let mut graph = Self::with_places(order.into_iter().map(|(place, _)| place).collect());
        for (cell, &number) in numbers.iter().enumerate() {
            let [first, second] = cells.triangles(number as usize);
            let triangles = [first, second].into_iter().take(if first == second { 1 } else { 2 });
            let beside = triangles
                .flat_map(|triangle| mesh.cell(TriangleId::from_index(triangle)).opposite)
                .flatten()
                .map(|triangle| cell_of[triangle])
                .filter(|&other| other as usize != cell);
            graph.push(beside);
        }
        (graph, numbers)
    }

    fn with_places(places: Vec<[i64; 2]>) -> Self {
        Self { starts: vec![0], neighbours: Vec::with_capacity(4 * places.len()), places }
    }

    /// Adds the neighbours of the next cell.
    fn push(&mut self, neighbours: impl Iterator<Item = u32>) {
        self.neighbours.extend(neighbours);
        self.starts.push(self.neighbours.len() as u32);
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Returns the place of a cell.
    pub fn place(&self, cell: u32) -> [i64; 2] {
        self.places[cell as usize]
    }

    /// Returns the cells beside a cell: twice where two edges lead there.
    pub fn beside(&self, cell: usize) -> &[u32] {
        &self.neighbours[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Returns some of the cells as a graph of their own, in the same order.
    pub fn some(&self, cells: &[u32]) -> Self {
        let mut place_in = vec![None; self.len()];
        for (number, &cell) in (0..).zip(cells) {
            place_in[cell as usize] = Some(number);
        }
        let mut graph = Self::with_places(cells.iter().map(|&cell| self.place(cell)).collect());
        for &cell in cells {
            graph.push(self.beside(cell as usize).iter().filter_map(|&other| place_in[other as usize]));
        }
        graph
    }
}

fn place_of(mesh: &Extract, triangle: usize) -> [i64; 2] {
    let corners = mesh.triangles()[triangle].vertices.map(|vertex| mesh.node(vertex));
    [corners.iter().map(|at| i64::from(at.x)).sum(), corners.iter().map(|at| i64::from(at.y)).sum()]
}
