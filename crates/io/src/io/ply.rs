//! `.ply`: the Stanford format, for programs for point clouds and surfaces, in binary form (little-endian).
//!
//! z is the height of the surface, or 0 without one. Coordinates and values are doubles. h̄ is `quality` at
//! the vertices, as MeshLab calls its values; the quantities follow with their names. Faces have nothing but
//! their vertices, because meshio (up to 5.3.5) reads no file in which they do. Numbers of vertices start at
//! zero; triangles face up.

use std::io::{self, Write};

use super::{FormatSpec, MeshData, QuantityPlaces, ThirdCoordinate, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// Stanford's format.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "MeshLab, CloudCompare, Blender: with h̄ and values at nodes",
    size: TypicalSize { bytes: 30.0, bytes_per_digit: 0.0 },
    has_targets: true,
    third: ThirdCoordinate::Model,
    quantities: QuantityPlaces::All,
    ..FormatSpec::new("ply", &["ply"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// Writes vertices with their values, and triangles.
///
/// # Errors
/// Fails with the errors of `out`, and when there are more nodes than `u32` counts.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    u32::try_from(mesh.nodes().len()).map_err(io::Error::other)?;
    write_header(out, mesh, data)?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        let place = [p.x, p.y, data.height(node), data.target_diameter[node]];
        let values = data.quantities.iter().map(|quantity| quantity.values[node]);
        place.into_iter().chain(values).try_for_each(|value| out.write_all(&value.to_le_bytes()))
    })?;
    write_rows(out, mesh.triangles().len(), |out, id| {
        out.write_all(&[3])?;
        let corners = mesh.cell(TriangleId::from_index(id)).corners;
        corners.iter().try_for_each(|node| out.write_all(&(*node as u32).to_le_bytes()))
    })
}

fn write_header(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    data.provenance.lines().try_for_each(|line| writeln!(out, "comment {line}"))?;
    writeln!(out, "comment quality: target diameter")?;
    writeln!(out, "element vertex {}", mesh.nodes().len())?;
    let names = data.quantities.iter().map(|quantity| property(&quantity.name));
    for name in ["x", "y", "z", "quality"].map(str::to_owned).into_iter().chain(names) {
        writeln!(out, "property double {name}")?;
    }
    writeln!(out, "element face {}", mesh.triangles().len())?;
    writeln!(out, "property list uchar uint vertex_indices\nend_header")
}

/// Returns the name of a quantity, other than those of the coordinates and of h̄.
fn property(name: &str) -> String {
    match name {
        "x" | "y" | "z" | "quality" => format!("quantity_{name}"),
        other => other.to_owned(),
    }
}
