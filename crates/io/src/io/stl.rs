//! `.stl` in binary form, for printing and for programs that read only this. z is the height of the surface,
//! or 0 without one; triangles face up.
//!
//! The format has triangles only: no shared nodes, no level, no h̄. Its numbers have seven digits; a mesh
//! with triangles too small for that is refused.

use std::io::{self, Write};

use glam::Vec3;

use super::{FormatSpec, MeshData, ThirdCoordinate, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// Triangles without shared nodes.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "CAD and 3D printing: triangles only, without h̄",
    size: TypicalSize { bytes: 50.0, bytes_per_digit: 0.0 },
    third: ThirdCoordinate::Model,
    ..FormatSpec::new("stl", &["stl"], |out, mesh, data, meter| {
        meter.expect(bytes(mesh));
        write(&mut meter.count(out), mesh, data)
    })
};

/// Bytes of the header (title and number of triangles), and of a triangle.
const HEAD: u64 = 84;
const TRIANGLE: u64 = 50;

/// Returns the size of the file in bytes.
pub fn bytes(mesh: &Extract) -> u64 {
    HEAD + TRIANGLE * mesh.triangles().len() as u64
}

/// Writes the triangles, in the mesh's order, each anticlockwise.
///
/// # Errors
/// Fails with the errors of `out`, when f32 is too coarse for the coordinates, and when there are more
/// triangles than `u32` counts.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let count = u32::try_from(mesh.triangles().len()).map_err(io::Error::other)?;
    // The title must not begin with "solid", which marks the text form.
    out.write_all(&data.provenance.title::<80>())?;
    out.write_all(&count.to_le_bytes())?;
    write_rows(out, mesh.triangles().len(), |out, id| {
        let corners = mesh.cell(TriangleId::from_index(id)).corners;
        let place = |node: usize| mesh.world(NodeId::from_index(node)).extend(data.height(node)).as_vec3();
        write_triangle(out, corners.map(place))
    })
}

fn write_triangle(out: &mut impl Write, corners: [Vec3; 3]) -> io::Result<()> {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let normal = (b - a).cross(c - a);
    if normal.z <= 0.0 {
        let problem =
            format!("the numbers of .stl have seven digits, and the triangle near x = {}, y = {}", a.x, a.y);
        return Err(io::Error::other(
            problem + " would vanish; choose another format, or move the domain to the origin",
        ));
    }
    for values in [normal.normalize().as_vec3()].into_iter().chain(corners) {
        out.write_all(bytemuck::bytes_of(&values.to_array().map(f32::to_le_bytes)))?;
    }
    out.write_all(&[0, 0]) // no attributes
}
