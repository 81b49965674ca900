//! `.msh`: Gmsh 4.1 in text form, with the physical groups that solvers need.
//!
//! The triangles are the physical surface `domain` (1), the boundary edges the physical curve `boundary` (2)
//! with the domain on the left. h̄ and the quantities are node data, `level` is element data. Tags count from
//! one, triangles first: the tag of a triangle is its id plus one.

use std::io::{self, Write};

use super::{FormatSpec, MeshData, Number};
use crate::mesh::Extract;

/// Gmsh 4.1.
pub static FORMAT: FormatSpec = FormatSpec {
    ending: "msh",
    beside: &[],
    write: |out, mesh, data, meter| write(&mut meter.count(out), mesh, data),
};

/// Gmsh's numbers for an element of two and of three nodes.
const LINE: u8 = 1;
const TRIANGLE: u8 = 2;

/// Writes the mesh with its boundary.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "$MeshFormat\n4.1 0 8\n$EndMeshFormat")?;
    writeln!(out, "$PhysicalNames\n2\n1 2 \"boundary\"\n2 1 \"domain\"\n$EndPhysicalNames")?;
    write_entities(out, mesh)?;
    write_nodes(out, mesh)?;
    write_elements(out, mesh)?;
    for (name, values) in data.node_values() {
        write_values(out, "NodeData", name, values.iter().copied())?;
    }
    // meshio requires element data for all elements or none: a boundary edge gets the level of its triangle.
    let lines = mesh.boundary_edges().map(|edge| edge.level);
    let levels = mesh.triangles().iter().map(|triangle| triangle.level()).chain(lines).map(f64::from);
    write_values(out, "ElementData", "level", levels)
}

/// One curve (the boundary, physical group 2) and the surface that it bounds (physical group 1).
fn write_entities(out: &mut impl Write, mesh: &Extract) -> io::Result<()> {
    let bounds = mesh.lattice().bounds();
    let [x0, y0, x1, y1] = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y].map(Number);
    writeln!(out, "$Entities\n0 1 1 0")?;
    writeln!(out, "1 {x0} {y0} 0 {x1} {y1} 0 1 2 0")?;
    writeln!(out, "1 {x0} {y0} 0 {x1} {y1} 0 1 1 1 1")?;
    writeln!(out, "$EndEntities")
}

fn write_nodes(out: &mut impl Write, mesh: &Extract) -> io::Result<()> {
    let count = mesh.nodes().len();
    writeln!(out, "$Nodes\n1 {count} 1 {count}\n2 1 0 {count}")?;
    for tag in 1..=count {
        writeln!(out, "{tag}")?;
    }
    for p in mesh.world_nodes() {
        writeln!(out, "{} {} 0", Number(p.x), Number(p.y))?;
    }
    writeln!(out, "$EndNodes")
}

fn write_elements(out: &mut impl Write, mesh: &Extract) -> io::Result<()> {
    let triangles = mesh.triangles().len();
    let lines = mesh.boundary_edges().count();
    let all = triangles + lines;
    writeln!(out, "$Elements\n2 {all} 1 {all}\n2 1 {TRIANGLE} {triangles}")?;
    for (tag, cell) in (1..).zip(mesh.cells()) {
        let [a, b, c] = cell.corners.map(|node| node + 1);
        writeln!(out, "{tag} {a} {b} {c}")?;
    }
    writeln!(out, "1 1 {LINE} {lines}")?;
    for (tag, edge) in (triangles + 1..).zip(mesh.boundary_edges()) {
        let [from, to] = edge.ends.map(|node| node + 1);
        writeln!(out, "{tag} {from} {to}")?;
    }
    writeln!(out, "$EndElements")
}

/// A view of Gmsh: one number for each node or element.
fn write_values(
    out: &mut impl Write,
    section: &str,
    name: &str,
    values: impl Iterator<Item = f64> + Clone,
) -> io::Result<()> {
    // One string (the name), one real number (the time), three whole numbers (step, components, count).
    writeln!(out, "${section}\n1\n\"{name}\"\n1\n0\n3\n0\n1\n{}", values.clone().count())?;
    for (tag, value) in (1..).zip(values) {
        writeln!(out, "{tag} {}", Number(value))?;
    }
    writeln!(out, "$End{section}")
}
