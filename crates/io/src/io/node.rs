//! `.node`, `.ele`, `.neigh` and `.edge`: the formats of Shewchuk's Triangle, four files that belong
//! together.
//!
//! Numbers start at one: Triangle takes both counts, solvers such as SWAN only this one. Node attributes are
//! h̄ and then the quantities. The attribute of an element is its level. Neighbour i is opposite corner i; −1
//! is the boundary. `.edge` has all edges.
//!
//! The boundary marker of edges and nodes is the marker of the piece of the boundary, the lower one for a
//! node in which pieces meet, and 0 inside. The format has no place for names. Comments at the end of each
//! file describe the origin of the mesh.

use std::io::{self, Write};

use super::triangle_pieces::TrianglePieces;
use super::{FormatSpec, MeshData, Number, QuantityPlaces, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};

/// The number of the first node, triangle and edge.
const FIRST: usize = 1;

/// Triangle's four files: nodes, elements, neighbours and edges.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "Triangle: four files, nodes, elements, neighbours and edges",
    size: TypicalSize { bytes: 93.0, bytes_per_digit: 13.0 },
    has_targets: true,
    beside: &[
        ("ele", |out, mesh, data, meter| write_elements(&mut meter.count(out), mesh, data)),
        ("neigh", |out, mesh, data, meter| write_neighbours(&mut meter.count(out), mesh, data)),
        ("edge", |out, mesh, data, meter| write_edges(&mut meter.count(out), mesh, data)),
    ],
    quantities: QuantityPlaces::All,
    ..FormatSpec::new("node", &["node"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// Writes the `.node` file: coordinates, h̄, quantities and boundary marker of each node.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let markers = data.boundary.node_markers(mesh);
    writeln!(out, "{} 2 {} 1", mesh.nodes().len(), data.node_values().count())?;
    write_rows(out, mesh.nodes().len(), |out, id| {
        let p = mesh.world(NodeId::from_index(id));
        write!(out, "{} {} {}", id + FIRST, Number(p.x), Number(p.y))?;
        for (_, values) in data.node_values() {
            write!(out, " {}", Number(values[id]))?;
        }
        writeln!(out, " {}", markers[id])
    })?;
    data.write_comments(out)
}

/// Writes the `.ele` file: corners and level of each triangle.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_elements(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "{} 3 1", mesh.triangles().len())?;
    write_rows(out, mesh.triangles().len(), |out, id| {
        let cell = mesh.cell(TriangleId::from_index(id));
        let [a, b, c] = cell.corners.map(|node| node + FIRST);
        writeln!(out, "{} {a} {b} {c} {}", id + FIRST, cell.level)
    })?;
    data.write_comments(out)
}

/// Writes the `.neigh` file: the triangle opposite each corner.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_neighbours(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    writeln!(out, "{} 3", mesh.triangles().len())?;
    write_rows(out, mesh.triangles().len(), |out, id| {
        let across = mesh.cell(TriangleId::from_index(id)).opposite;
        let [a, b, c] = across.map(|across| across.map_or(-1, |t| (t + FIRST) as i64));
        writeln!(out, "{} {a} {b} {c}", id + FIRST)
    })?;
    data.write_comments(out)
}

/// Writes the `.edge` file: the ends of each edge, and its marker.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_edges(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let mut count = 0;
    let first_ids = (0..mesh.triangles().len()).map(|triangle| {
        let first = count;
        count += mesh.first_edges_of(TriangleId::from_index(triangle)).count();
        first
    });
    let first_ids: Vec<usize> = first_ids.collect();
    let pieces = TrianglePieces::new(mesh, data.boundary);
    writeln!(out, "{count} 1")?;
    write_rows(out, first_ids.len(), |out, triangle| {
        let mut pieces = pieces.of(triangle);
        let edges = mesh.first_edges_of(TriangleId::from_index(triangle));
        for (id, edge) in (first_ids[triangle]..).zip(edges) {
            let [from, to] = edge.ends.map(|node| node + FIRST);
            let piece = if edge.on_boundary { pieces.next() } else { None };
            writeln!(out, "{} {from} {to} {}", id + FIRST, piece.map_or(0, |piece| piece + 1))?;
        }
        Ok(())
    })?;
    data.write_comments(out)
}
