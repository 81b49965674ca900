//! `fort.14`: the mesh of ADCIRC, with open boundaries, land and islands.
//!
//! Records are numbers with blanks between them, and readers ignore the text after them, except in the second
//! line: it has the numbers of triangles and of nodes only. Numbers start at one. Depths are positive
//! downwards.
//!
//! Strings run with the domain on the left: outer boundaries anticlockwise, islands clockwise. Neighbouring
//! strings share their end node, which counts in both; an island does not repeat its first node. Land has the
//! type 0 (mainland) or 1 (island), both with essential normal flow. The first line describes the origin of
//! the mesh.

use std::io::{self, Write};

use super::boundary_strings::{BoundaryString, BoundaryStrings, StringKind};
use super::{FormatSpec, MeshData, Number, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// ADCIRC.
pub static FORMAT: FormatSpec = FormatSpec {
    name: "fort14",
    endings: &["14", "grd"],
    tail: "",
    purpose: "ADCIRC (fort.14): open boundaries, land and islands",
    size: SIZE,
    beside: &[],
    write: |out, mesh, data, meter| write(&mut meter.count(out), mesh, data),
    write_binary: None,
};

/// The size of its files, and of those with the same contents.
pub(super) const SIZE: TypicalSize = TypicalSize { bytes: 38.0, bytes_per_digit: 4.5 };

/// Writes title, nodes with depths, triangles, open boundaries, and land with islands.
///
/// # Errors
/// Fails with the errors of `out`, and where the boundary touches itself in a node.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    write_named(out, mesh, data, "fort.14")
}

/// Writes as [`write()`] does; `format` is the name in errors.
pub(super) fn write_named(
    out: &mut impl Write,
    mesh: &Extract,
    data: &MeshData,
    format: &str,
) -> io::Result<()> {
    let strings = BoundaryStrings::new(mesh, data, format)?;
    writeln!(out, "{}", data.provenance.line())?;
    writeln!(out, "{} {}", mesh.triangles().len(), mesh.nodes().len())?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {} {}", node + 1, Number(p.x), Number(p.y), Number(data.depth(node)))
    })?;
    write_rows(out, mesh.triangles().len(), |out, id| {
        let [a, b, c] = mesh.cell(TriangleId::from_index(id)).corners.map(|node| node + 1);
        writeln!(out, "{} 3 {a} {b} {c}", id + 1)
    })?;
    write_strings(out, "open", &strings.open().collect::<Vec<_>>())?;
    write_strings(out, "land", &strings.closed().collect::<Vec<_>>())
}

/// Writes the strings of a kind: how many, the nodes of all together, and then one after the other.
fn write_strings(out: &mut impl Write, kind: &str, strings: &[&BoundaryString]) -> io::Result<()> {
    let nodes: usize = strings.iter().map(|string| string.distinct().len()).sum();
    writeln!(out, "{} = Number of {kind} boundaries", strings.len())?;
    writeln!(out, "{nodes} = Total number of {kind} boundary nodes")?;
    for (number, string) in (1..).zip(strings) {
        let (count, island) = (string.distinct().len(), i32::from(string.kind == StringKind::Island));
        writeln!(out, "{count} {island} = Number of nodes for {kind} boundary {number}: {}", string.name)?;
        string.distinct().iter().try_for_each(|node| writeln!(out, "{}", node + 1))?;
    }
    Ok(())
}
