//! `.csv`: a table with one row for each triangle that contains all data of the triangle.
//!
//! Columns: `triangle` and its `level`; its nodes `v1,v2,v3`, anticlockwise, the first two are the ends of
//! the bisection edge; the triangles `n1,n2,n3` across its edges, first across the bisection edge and then
//! anticlockwise, empty at the boundary; its corners `x1,y1,x2,y2,x3,y3`; and h̄ at the corners,
//! `target1,target2,target3`. Numbers start at zero.

use std::io::{self, Write};

use super::{FormatSpec, MeshData, NodeValues, Number};
use crate::mesh::{Extract, NodeId};

/// A table with a row for each triangle.
pub static FORMAT: FormatSpec = FormatSpec {
    ending: "csv",
    beside: &[],
    write: |out, mesh, data, meter| write(&mut meter.count(out), mesh, data),
};

const HEADER: &str = "triangle,level,v1,v2,v3,n1,n2,n3,x1,y1,x2,y2,x3,y3,target1,target2,target3";

/// Writes the table. Quantities other than h̄ follow as columns `name1,name2,name3`.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    write!(out, "{HEADER}")?;
    for NodeValues { name, .. } in data.quantities {
        write!(out, ",{name}1,{name}2,{name}3")?;
    }
    writeln!(out)?;
    for (id, cell) in mesh.cells().enumerate() {
        let [a, b, c] = cell.corners;
        write!(out, "{id},{},{a},{b},{c}", cell.level)?;
        let [second, third, bisection] = cell.opposite;
        for neighbour in [bisection, second, third] {
            match neighbour {
                Some(across) => write!(out, ",{across}")?,
                None => write!(out, ",")?,
            }
        }
        for node in cell.corners {
            let p = mesh.world(NodeId::from_index(node));
            write!(out, ",{},{}", Number(p.x), Number(p.y))?;
        }
        for (_, values) in data.node_values() {
            for node in cell.corners {
                write!(out, ",{}", Number(values[node]))?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
