//! `.2dm`: the mesh format of SMS, read by TUFLOW, BASEMENT, QGIS and other programs for hydraulics.
//!
//! z is the first quantity, such as a depth, else the height of the surface, and 0 without both. All elements
//! have material 1: a solver needs a description of each material, so levels are not written as materials.
//!
//! Nodestrings are the pieces of the boundary with the domain on the left, and then the lines of the
//! document. One of a whole ring ends with its first node. A piece that is interrupted in the mesh has
//! several nodestrings. The format has no place for names: comments give them by the numbers of the
//! nodestrings. Numbers start at one.

use std::io::{self, Write};

use super::written_cells::WrittenCells;
use super::{
    FormatSpec, MeshData, Number, QuantityPlaces, SURFACE, SquareCells, ThirdCoordinate, TypicalSize,
    write_rows,
};
use meshbrush_mesh::mesh::{Extract, NodeId};

/// SMS.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "SMS, TUFLOW, BASEMENT, QGIS: the boundary as nodestrings",
    size: TypicalSize { bytes: 44.0, bytes_per_digit: 4.5 },
    has_open_boundary: true,
    squares: SquareCells::Possible,
    third: ThirdCoordinate::Height,
    quantities: QuantityPlaces::First,
    ..FormatSpec::new("2dm", &["2dm"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// Nodes of a nodestring in one line.
const NODES_A_LINE: usize = 10;

/// Writes elements, nodes, and a nodestring for each piece of the boundary and each line.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "MESH2D\nMESHNAME \"Meshbrush\"\nNUM_MATERIALS_PER_ELEM 1")?;
    data.write_comments(out)?;
    let cells = WrittenCells::new(mesh, data, FORMAT.squares);
    write_rows(out, cells.count(), |out, id| {
        let ([a, b, c], fourth) = cells.corners(id);
        let (id, [a, b, c]) = (id + 1, [a, b, c].map(|node| node + 1));
        match fourth {
            None => writeln!(out, "E3T {id} {a} {b} {c} 1"),
            Some(d) => writeln!(out, "E4Q {id} {a} {b} {c} {} 1", d + 1),
        }
    })?;
    let quantity = data.quantities.iter().find(|quantity| quantity.name != SURFACE);
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        let z = quantity.map_or_else(|| data.height(node), |quantity| quantity.values[node]);
        writeln!(out, "ND {} {} {} {}", node + 1, Number(p.x), Number(p.y), Number(z))
    })?;
    let runs = data.boundary.runs(mesh);
    let of_boundary =
        runs.iter().map(|run| (&data.boundary.pieces().list()[run.piece].name, run.nodes.clone()));
    let of_lines =
        data.lines.iter().flat_map(|line| line.runs().into_iter().map(|nodes| (&line.name, nodes)));
    let strings: Vec<(&String, Vec<usize>)> = of_boundary.chain(of_lines).collect();
    for (id, (name, _)) in (1..).zip(&strings) {
        writeln!(out, "# nodestring {id}: {name}")?;
    }
    (1..).zip(&strings).try_for_each(|(id, (_, nodes))| write_nodestring(out, id, nodes))
}

/// The last node is negative, and the number of the nodestring follows it. py2dm requires two nodes in the
/// first line.
fn write_nodestring(out: &mut impl Write, id: usize, nodes: &[usize]) -> io::Result<()> {
    let lines = nodes.len().div_ceil(NODES_A_LINE);
    for (number, line) in (1..).zip(nodes.chunks(NODES_A_LINE)) {
        let Some((last, others)) = line.split_last() else { continue };
        write!(out, "NS")?;
        others.iter().try_for_each(|node| write!(out, " {}", node + 1))?;
        match number == lines {
            true => writeln!(out, " -{} {id}", last + 1)?,
            false => writeln!(out, " {}", last + 1)?,
        }
    }
    Ok(())
}
