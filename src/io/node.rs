//! `.node`, `.ele` and `.neigh`: the formats of Shewchuk's Triangle, three files that belong together.
//!
//! Counting starts at zero. Node attributes are h̄ and then the quantities; the boundary marker is 1 on the boundary. The
//! attribute of an element is its level. Neighbour i lies opposite corner i; −1 is the boundary.

use std::io::{self, Write};

use super::{MeshData, Number, boundary_edges, cells, world_nodes};
use crate::mesh::Mesh;

/// Writes the `.node` file: coordinates, h̄, quantities and boundary marker of each node.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut impl Write, mesh: &Mesh, data: &MeshData) -> io::Result<()> {
    let mut on_boundary = vec![false; mesh.nodes().len()];
    for node in boundary_edges(mesh).flat_map(|edge| edge.ends) {
        on_boundary[node] = true;
    }
    writeln!(out, "{} 2 {} 1", mesh.nodes().len(), data.node_values().count())?;
    for (id, p) in world_nodes(mesh).enumerate() {
        write!(out, "{id} {} {}", Number(p.x), Number(p.y))?;
        for (_, values) in data.node_values() {
            write!(out, " {}", Number(values[id]))?;
        }
        writeln!(out, " {}", u8::from(on_boundary[id]))?;
    }
    Ok(())
}

/// Writes the `.ele` file: corners and level of each triangle.
///
/// # Errors
/// Those of `out`.
pub fn write_elements(out: &mut impl Write, mesh: &Mesh) -> io::Result<()> {
    writeln!(out, "{} 3 1", mesh.triangles().len())?;
    for (id, cell) in cells(mesh).enumerate() {
        let [a, b, c] = cell.corners;
        writeln!(out, "{id} {a} {b} {c} {}", cell.level)?;
    }
    Ok(())
}

/// Writes the `.neigh` file: the triangle opposite each corner.
///
/// # Errors
/// Those of `out`.
pub fn write_neighbours(out: &mut impl Write, mesh: &Mesh) -> io::Result<()> {
    writeln!(out, "{} 3", mesh.triangles().len())?;
    for (id, cell) in cells(mesh).enumerate() {
        let [a, b, c] = cell.opposite.map(|across| across.map_or(-1, |t| t as i64));
        writeln!(out, "{id} {a} {b} {c}")?;
    }
    Ok(())
}
