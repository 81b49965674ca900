//! WAVEWATCH III's variant of Gmsh 2: depths as z, and the nodes of the open boundaries as points.
//!
//! WAVEWATCH III reads the version as whole numbers (`w3triamd.F90`), so the file begins with `2 0 8`, as its
//! own meshes do; Gmsh takes that, too. Then it reads nodes (number, x, y, depth), and elements: a point
//! (type 15) for each node of an open boundary, and then the triangles (type 2). Numbers start at one; depths
//! are positive downwards. The order of sections matters, so comments on the origin of the mesh come last.
//! Other programs see the depth as z. Waves do not come in at inflows, so these have no points. Named curves
//! of the boundary are in [`msh`](super::msh) and [`msh22`](super::msh22).

use std::io::{self, Write};

use super::boundary_strings::BoundaryStrings;
use super::{FormatSpec, MeshData, Number, TypicalSize, write_rows};
use meshbrush_core::domain::BoundaryType;
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// WAVEWATCH III.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "WAVEWATCH III (its Gmsh 2): open boundaries as points",
    size: TypicalSize { bytes: 47.0, bytes_per_digit: 5.5 },
    has_open_boundary: true,
    ..FormatSpec::new("ww3", &["ww3", "msh", "msh2"], |out, mesh, data, meter| {
        write(&mut meter.count(out), mesh, data)
    })
};

/// Gmsh's numbers for an element of one and of three nodes.
const POINT: u32 = 15;
const TRIANGLE: u32 = 2;

/// Writes nodes with depths, the points of the open boundaries, and triangles.
///
/// # Errors
/// Fails with the errors of `out`, and where the boundary touches itself in a node.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let strings = BoundaryStrings::new(mesh, data, "WAVEWATCH III", BoundaryType::is_open)?;
    let open = strings.open_nodes(mesh);
    writeln!(out, "$MeshFormat\n2 0 8\n$EndMeshFormat\n$Nodes\n{}", mesh.nodes().len())?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {} {}", node + 1, Number(p.x), Number(p.y), Number(data.depth(node)))
    })?;
    writeln!(out, "$EndNodes\n$Elements\n{}", open.len() + mesh.triangles().len())?;
    for (id, node) in (1..).zip(&open) {
        writeln!(out, "{id} {POINT} 2 0 0 {}", node + 1)?;
    }
    write_rows(out, mesh.triangles().len(), |out, triangle| {
        let [a, b, c] = mesh.cell(TriangleId::from_index(triangle)).corners.map(|node| node + 1);
        let id = open.len() + triangle + 1;
        writeln!(out, "{id} {TRIANGLE} 3 0 {} 0 {a} {b} {c}", triangle + 1)
    })?;
    writeln!(out, "$EndElements\n$Comments")?;
    data.provenance.lines().try_for_each(|line| writeln!(out, "{line}"))?;
    writeln!(out, "$EndComments")
}
