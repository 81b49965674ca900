//! `.msh2`: Gmsh 2.2 as text, with the physical groups of [`msh`](super::msh), for FreeFEM, MFEM, Elmer and
//! others that do not read Gmsh 4.1.
//!
//! Names, numbers and values are those of `.msh`: the triangles are the physical surface `domain` (1), each
//! piece of the boundary is a physical curve with its name and marker, h̄ and the quantities are views, z is
//! the height of the surface or 0. `level` and `part` are left out: meshio 5.3 fails on files of Gmsh 2.2
//! with element data beside more than one kind of element. An element has two tags, its group and its entity,
//! which have one number. Some readers take the sections by their order, so comments on the origin of the
//! mesh come last.

use std::io::{self, Write};

use super::msh::{Curve, LINE, SURFACE, TRIANGLE, write_names, write_text_views};
use super::{FormatSpec, MeshData, Number, QuantityPlaces, ThirdCoordinate, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// Gmsh 2.2.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "Gmsh 2.2 for FreeFEM, MFEM, Elmer: the boundary as named groups",
    size: TypicalSize { bytes: 70.0, bytes_per_digit: 5.5 },
    has_targets: true,
    third: ThirdCoordinate::Height,
    quantities: QuantityPlaces::All,
    ..FormatSpec::new("msh22", &["msh2", "msh"], |out, mesh, data, meter| {
        write(&mut meter.count(out), mesh, data)
    })
};

/// Writes the names of the groups, nodes, triangles, the edges of the boundary, and values.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let curves = Curve::all(mesh, data);
    writeln!(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat")?;
    write_names(out, &curves)?;
    writeln!(out, "$Nodes\n{}", mesh.nodes().len())?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {} {}", node + 1, Number(p.x), Number(p.y), Number(data.height(node)))
    })?;
    writeln!(out, "$EndNodes")?;
    write_elements(out, mesh, &curves)?;
    write_text_views(out, data)?;
    writeln!(out, "$Comments")?;
    data.provenance.lines().try_for_each(|line| writeln!(out, "{line}"))?;
    writeln!(out, "$EndComments")
}

/// Triangles, and then the edges of the curves.
fn write_elements(out: &mut impl Write, mesh: &Extract, curves: &[Curve<'_>]) -> io::Result<()> {
    let triangles = mesh.triangles().len();
    let lines: usize = curves.iter().map(|curve| curve.edges.len()).sum();
    writeln!(out, "$Elements\n{}", triangles + lines)?;
    write_rows(out, triangles, |out, triangle| {
        let [a, b, c] = mesh.cell(TriangleId::from_index(triangle)).corners.map(|node| node + 1);
        writeln!(out, "{} {TRIANGLE} 2 {SURFACE} {SURFACE} {a} {b} {c}", triangle + 1)
    })?;
    let edges = curves.iter().flat_map(|curve| curve.edges.iter().map(|edge| (curve.tag(), edge.ends)));
    for (number, (tag, [from, to])) in (triangles + 1..).zip(edges) {
        writeln!(out, "{number} {LINE} 2 {tag} {tag} {} {}", from + 1, to + 1)?;
    }
    writeln!(out, "$EndElements")
}
