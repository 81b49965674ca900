//! `.obj`: Wavefront, for modelling and drawing programs. The mesh lies in the plane z = 0, facing up.
//!
//! Triangles are grouped by level (`g level_3`), within a group in the order of the mesh. h̄ is the texture
//! coordinate u of a node. Numbers start at one. The format has no place for further quantities.

use std::io::{self, Write};

use super::{FormatSpec, MeshData, Number, TypicalSize};
use crate::mesh::Extract;

/// Wavefront.
pub static FORMAT: FormatSpec = FormatSpec {
    ending: "obj",
    purpose: "Blender and other 3D programs: a group for each level",
    size: TypicalSize { bytes: 58.0, bytes_per_digit: 3.5 },
    beside: &[],
    write: |out, mesh, data, meter| write(&mut meter.count(out), mesh, data),
    write_binary: None,
};

/// Writes the mesh, one group for each level.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    data.write_comments(out)?;
    writeln!(out, "# {} nodes, {} triangles", mesh.nodes().len(), mesh.triangles().len())?;
    writeln!(out, "# texture coordinate u: target diameter; groups: level")?;
    for p in mesh.world_nodes() {
        writeln!(out, "v {} {} 0", Number(p.x), Number(p.y))?;
    }
    for &target in data.target_diameter {
        writeln!(out, "vt {} 0", Number(target))?;
    }
    // One pass over the mesh for each level: lists by level would be a second copy of it.
    for (level, _) in mesh.level_counts().into_iter().enumerate().filter(|(_, count)| *count > 0) {
        writeln!(out, "g level_{level}")?;
        for cell in mesh.cells().filter(|cell| cell.level as usize == level) {
            let [a, b, c] = cell.corners.map(|node| node + 1);
            writeln!(out, "f {a}/{a} {b}/{b} {c}/{c}")?;
        }
    }
    Ok(())
}
