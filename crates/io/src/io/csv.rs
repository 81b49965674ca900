//! `.csv`: a table with one row for each triangle that contains all data of the triangle.
//!
//! Columns: `triangle` and its `level`; its nodes `v1,v2,v3`, anticlockwise, the first two are the ends of
//! the bisection edge; the triangles `n1,n2,n3` across its edges, first across the bisection edge and then
//! anticlockwise, empty at the boundary; its corners `x1,y1,x2,y2,x3,y3`; h̄ at the corners,
//! `target1,target2,target3`; the number of its `part`, from 0 for the largest; and the markers of its edges
//! in the order of n1, n2 and n3, `b1,b2,b3`: of the piece of the boundary, and 0 inside. Other numbers start
//! at zero.

use std::io::{self, Write};

use super::triangle_pieces::TrianglePieces;
use super::{FormatSpec, MeshData, NodeValues, Number, QuantityPlaces, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// A table with a row for each triangle.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "Spreadsheets and scripts: a row for each triangle",
    size: TypicalSize { bytes: 164.0, bytes_per_digit: 7.0 },
    has_targets: true,
    quantities: QuantityPlaces::All,
    ..FormatSpec::new("csv", &["csv"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

const HEADER: &str = "triangle,level,v1,v2,v3,n1,n2,n3,x1,y1,x2,y2,x3,y3,target1,target2,target3,\
                      part,b1,b2,b3";

/// Writes the table. Quantities other than h̄ follow as columns `name1,name2,name3`.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    write!(out, "{HEADER}")?;
    for NodeValues { name, .. } in data.quantities {
        write!(out, ",{name}1,{name}2,{name}3")?;
    }
    writeln!(out)?;
    let pieces = TrianglePieces::new(mesh, data.boundary);
    write_rows(out, mesh.triangles().len(), |out, id| write_row(out, mesh, data, &pieces, id))
}

fn write_row(
    out: &mut impl Write,
    mesh: &Extract,
    data: &MeshData,
    pieces: &TrianglePieces,
    id: usize,
) -> io::Result<()> {
    let mut pieces = pieces.of(id);
    let cell = mesh.cell(TriangleId::from_index(id));
    let [a, b, c] = cell.corners;
    write!(out, "{id},{},{a},{b},{c}", cell.level)?;
    let [second, third, bisection] = cell.opposite;
    let across = [bisection, second, third];
    for neighbour in across {
        match neighbour {
            Some(across) => write!(out, ",{across}")?,
            None => write!(out, ",")?,
        }
    }
    for node in cell.corners {
        let p = mesh.world(NodeId::from_index(node));
        write!(out, ",{},{}", Number(p.x), Number(p.y))?;
    }
    for node in cell.corners {
        write!(out, ",{}", Number(data.target_diameter[node]))?;
    }
    write!(out, ",{}", data.parts[id])?;
    for neighbour in across {
        let piece = if neighbour.is_none() { pieces.next() } else { None };
        write!(out, ",{}", piece.map_or(0, |piece| piece + 1))?;
    }
    for NodeValues { values, .. } in data.quantities {
        for node in cell.corners {
            write!(out, ",{}", Number(values[node]))?;
        }
    }
    writeln!(out)
}
