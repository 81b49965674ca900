//! `.obj`: Wavefront, for modelling and drawing programs. The mesh lies in the plane z = 0, facing up.
//!
//! Triangles are grouped by level (`g level_3`), within a group in the mesh's order. h̄ is the texture coordinate u of its
//! node. Counting starts at one. The format has no place for further quantities.

use std::io::{self, Write};

use super::{MeshData, Number};
use crate::mesh::Extract;

/// Writes the mesh, one group for each level.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "# Meshbrush: {} nodes, {} triangles", mesh.nodes().len(), mesh.triangles().len())?;
    writeln!(out, "# texture coordinate u: target diameter; groups: level")?;
    for p in mesh.world_nodes() {
        writeln!(out, "v {} {} 0", Number(p.x), Number(p.y))?;
    }
    for &target in data.target_diameter {
        writeln!(out, "vt {} 0", Number(target))?;
    }
    let mut by_level = vec![Vec::new(); mesh.level_counts().len()];
    for cell in mesh.cells() {
        by_level[cell.level as usize].push(cell.corners);
    }
    for (level, triangles) in by_level.iter().enumerate().filter(|(_, triangles)| !triangles.is_empty()) {
        writeln!(out, "g level_{level}")?;
        for corners in triangles {
            let [a, b, c] = corners.map(|node| node + 1);
            writeln!(out, "f {a}/{a} {b}/{b} {c}/{c}")?;
        }
    }
    Ok(())
}
