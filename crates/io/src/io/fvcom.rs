//! `_grd.dat`, `_dep.dat` and `_obc.dat`: the mesh, the depths and the open boundary of FVCOM.
//!
//! Triangles run anticlockwise; FVCOM turns them itself. Numbers start at one; depths are positive downwards.
//! The open boundary is a list of its nodes along the boundary, each once, all of type 1 (the elevation is
//! given). FVCOM takes an edge for open if both nodes are in the list. Inflows are not in it: FVCOM has
//! rivers in a file of their own, at nodes of the coast. The format has no place for names and for the origin
//! of the mesh.

use std::io::{self, Write};

use super::boundary_strings::{BoundaryStrings, LAND};
use super::{FormatSpec, MeshData, Number, TypicalSize, write_rows};
use meshbrush_core::domain::BoundaryType;
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// FVCOM.
pub static FORMAT: FormatSpec = FormatSpec {
    tail: "_grd.dat",
    purpose: "FVCOM: three files, mesh, depths and open boundary",
    size: TypicalSize { bytes: 48.0, bytes_per_digit: 5.0 },
    has_open_boundary: true,
    beside: &[
        ("_dep.dat", |out, mesh, data, meter| write_depths(&mut meter.count(out), mesh, data)),
        ("_obc.dat", |out, mesh, data, meter| write_open_boundary(&mut meter.count(out), mesh, data)),
    ],
    ..FormatSpec::new("fvcom", &["dat"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// FVCOM's number for an open boundary at which the elevation is given.
const ELEVATION: u32 = 1;

/// Writes `_grd.dat`: triangles, and nodes with depths.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "Node Number = {}\nCell Number = {}", mesh.nodes().len(), mesh.triangles().len())?;
    write_rows(out, mesh.triangles().len(), |out, id| {
        let [a, b, c] = mesh.cell(TriangleId::from_index(id)).corners.map(|node| node + 1);
        writeln!(out, "{} {a} {b} {c} 1", id + 1)
    })?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {} {}", node + 1, Number(p.x), Number(p.y), Number(data.depth(node)))
    })
}

/// Writes `_dep.dat`: coordinates and depth of each node.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_depths(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "Node Number = {}", mesh.nodes().len())?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {}", Number(p.x), Number(p.y), Number(data.depth(node)))
    })
}

/// Writes `_obc.dat`: the nodes of the open boundary.
///
/// # Errors
/// Fails with the errors of `out`, where the boundary touches itself in a node, and where no edge of an open
/// piece beside land of one edge would remain.
pub fn write_open_boundary(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let strings = BoundaryStrings::new(mesh, data, "FVCOM", BoundaryType::is_open)?;
    let codes = strings.node_codes(mesh, "FVCOM")?;
    let mut open = strings.open_nodes(mesh);
    open.retain(|&node| codes[node] > LAND);
    writeln!(out, "OBC Node Number = {}", open.len())?;
    (1..)
        .zip(&open)
        .try_for_each(|(number, node): (usize, _)| writeln!(out, "{number} {} {ELEVATION}", node + 1))
}
