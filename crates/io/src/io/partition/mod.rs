//! Parts of a mesh for a solver that runs on several processors.
//!
//! The cells are divided in two again and again, so that no part has more than one cell more than another and
//! few edges are cut ([`halves`]). Files keep their numbers of cells.
//!
//! SCHISM reads `partition.prop`: a line for each element, with its number and that of its processor, from 0.
//! For other formats there is a file in the style of METIS, named for the mesh and the number of parts, as in
//! `sea.14.part.64`: a line for each cell, with the number of its part, from 0. UGRID has the same numbers in
//! the variable `idomain`.

use std::io::{self, Write};

mod cell_graph;
mod exchange;
mod halves;

use super::format_spec::SquareCells;
use super::written_cells::WrittenCells;
use super::{MeshData, write_rows};
use cell_graph::CellGraph;
use halves::divided;
use meshbrush_mesh::mesh::Extract;

/// The lines of a file of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartLines {
    /// The number of each part, as METIS writes it.
    Parts,
    /// The number of each cell, from 1, and that of its part.
    NumbersAndParts,
}

/// How even parts are, and how much they have to exchange.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartitionFigures {
    /// The parts.
    pub parts: u32,
    /// The cells of the smallest part.
    pub smallest: usize,
    /// The cells of the largest part.
    pub largest: usize,
    /// Edges with cells of two parts.
    pub cut_edges: usize,
}

/// The part of each cell.
pub(super) struct Partition {
    owners: Vec<u32>,
    parts: u32,
}

impl Partition {
    /// Divides the cells of a file into so many parts.
    pub(super) fn new(mesh: &Extract, cells: &WrittenCells<'_>, parts: u32) -> Self {
        let (graph, numbers) = CellGraph::of_file(mesh, cells);
        let mut owners = vec![0; cells.count()];
        for (part, &cell) in divided(&graph, parts).into_iter().zip(&numbers) {
            owners[cell as usize] = part;
        }
        Self { owners, parts }
    }

    /// Returns the part of a cell, from 0.
    pub(super) fn owner(&self, cell: usize) -> u32 {
        self.owners[cell]
    }

    fn figures(&self, mesh: &Extract, cells: &WrittenCells<'_>) -> PartitionFigures {
        let mut counts = vec![0; self.parts as usize];
        self.owners.iter().for_each(|&owner| counts[owner as usize] += 1);
        let mut owner_of = vec![0; mesh.triangles().len()];
        for (cell, &owner) in self.owners.iter().enumerate() {
            cells.triangles(cell).into_iter().for_each(|triangle| owner_of[triangle] = owner);
        }
        let across = |(triangle, cell): (usize, meshbrush_mesh::mesh::Cell)| {
            let others = cell.opposite.into_iter().flatten().filter(|&other| other > triangle);
            others.filter(|&other| owner_of[other] != owner_of[triangle]).count()
        };
        PartitionFigures {
            parts: self.parts,
            smallest: counts.iter().copied().min().unwrap_or_default(),
            largest: counts.iter().copied().max().unwrap_or_default(),
            cut_edges: mesh.cells().enumerate().map(across).sum(),
        }
    }
}

/// Writes the part of each cell of a file.
///
/// # Errors
/// Fails with the errors of `out`, and where there are more parts than cells.
pub(super) fn write(
    out: &mut impl Write,
    mesh: &Extract,
    data: &MeshData,
    squares: SquareCells,
    lines: PartLines,
    parts: u32,
) -> io::Result<PartitionFigures> {
    let cells = WrittenCells::new(mesh, data, squares);
    if parts == 0 || parts as usize > cells.count() {
        let count = cells.count();
        return Err(io::Error::other(format!(
            "{parts} parts cannot be made of {count} cells; ask for fewer"
        )));
    }
    let partition = Partition::new(mesh, &cells, parts);
    write_rows(out, cells.count(), |out, cell| match lines {
        PartLines::Parts => writeln!(out, "{}", partition.owner(cell)),
        PartLines::NumbersAndParts => writeln!(out, "{} {}", cell + 1, partition.owner(cell)),
    })?;
    Ok(partition.figures(mesh, &cells))
}
