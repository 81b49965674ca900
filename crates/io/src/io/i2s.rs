//! `.i2s`: the lines of a document as a line set of BlueKenue, beside the mesh of TELEMAC.
//!
//! After a header each line has the number of its points and a value, and then x and y of each point, those
//! of the nodes of the mesh to the last digit. A closed line ends with its first point, and one that is not
//! on edges somewhere has several parts. The format has no place for names: the value is the number of the
//! line, from 1, and comments in the header give the names by these numbers.

use std::io::{self, Write};

use super::{MeshData, Number};
use meshbrush_mesh::mesh::{Extract, NodeId};

/// Writes the header, and the lines.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, ":FileType i2s ASCII EnSim 1.0")?;
    data.write_comments(out)?;
    for (number, line) in (1..).zip(data.lines) {
        writeln!(out, "# line {number}: {}", line.name)?;
    }
    writeln!(out, ":AttributeName 1 line\n:EndHeader")?;
    for (number, line) in (1..).zip(data.lines) {
        for nodes in line.runs() {
            writeln!(out, "{} {number}", nodes.len())?;
            write_points(out, mesh, &nodes)?;
        }
    }
    Ok(())
}

/// Writes x and y of each node in a line of its own.
pub(super) fn write_points(out: &mut impl Write, mesh: &Extract, nodes: &[usize]) -> io::Result<()> {
    nodes.iter().try_for_each(|&node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {}", Number(p.x), Number(p.y))
    })
}
