//! `.obj`: Wavefront, for modelling and drawing programs. z is the height of the surface, or 0 without one;
//! triangles face up.
//!
//! Triangles are grouped by level (`g level_3`), within a group in the order of the mesh. h̄ is the texture
//! coordinate u of a node. Numbers start at one. The format has no place for further quantities.

use std::io::{self, Write};

use super::{FormatSpec, MeshData, Number, ThirdCoordinate, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// Wavefront.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "Blender and other 3D programs: a group for each level",
    size: TypicalSize { bytes: 58.0, bytes_per_digit: 3.5 },
    has_targets: true,
    third: ThirdCoordinate::Model,
    ..FormatSpec::new("obj", &["obj"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// Writes the mesh, one group for each level.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    data.write_comments(out)?;
    writeln!(out, "# {} nodes, {} triangles", mesh.nodes().len(), mesh.triangles().len())?;
    writeln!(out, "# texture coordinate u: target diameter; groups: level")?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "v {} {} {}", Number(p.x), Number(p.y), Number(data.height(node)))
    })?;
    write_rows(out, data.target_diameter.len(), |out, node| {
        writeln!(out, "vt {} 0", Number(data.target_diameter[node]))
    })?;
    // One pass over the mesh for each level: lists by level would be a second copy of it.
    for (level, _) in mesh.level_counts().into_iter().enumerate().filter(|(_, count)| *count > 0) {
        writeln!(out, "g level_{level}")?;
        write_rows(out, mesh.triangles().len(), |out, id| {
            if mesh.triangles()[id].level() as usize != level {
                return Ok(());
            }
            let [a, b, c] = mesh.cell(TriangleId::from_index(id)).corners.map(|node| node + 1);
            writeln!(out, "f {a}/{a} {b}/{b} {c}/{c}")
        })?;
    }
    Ok(())
}
