//! `.mesh`: the mesh of MIKE 21 and MIKE 3 FM.
//!
//! Nodes have coordinates, the height of the ground in metres (positive upwards), and a code: 0 inside, 1 for
//! land, and 2, 3 … for the open pieces and the inflows of the boundary in their order. MIKE takes a boundary
//! edge for open if neither of its nodes is land, with the code of its second node; so nodes between open
//! pieces and land are open. Numbers start at one. The first line has the coordinate system: `LONG/LAT` for a
//! mesh in degrees, and `NON-UTM`, MIKE's word for a local one, otherwise. The format has no place for names
//! and for the origin of the mesh.

use std::io::{self, Write};

use super::boundary_strings::BoundaryStrings;
use super::written_cells::WrittenCells;
use super::{FormatSpec, MeshData, Number, SquareCells, TypicalSize, write_rows};
use meshbrush_core::domain::BoundaryType;
use meshbrush_mesh::mesh::{Extract, NodeId};
use meshbrush_mesh::text::LengthUnit;

/// MIKE.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "MIKE 21 and MIKE 3 FM: open boundaries and land as codes",
    size: TypicalSize { bytes: 36.0, bytes_per_digit: 4.5 },
    has_open_boundary: true,
    squares: SquareCells::Possible,
    ..FormatSpec::new("mesh", &["mesh"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// MIKE's number for the item bathymetry, and for the unit metre.
const BATHYMETRY: [u32; 2] = [100_079, 1000];
/// MIKE's number for triangles with corners only.
const TRIANGLES: u32 = 21;
/// MIKE's number for triangles and quadrilaterals.
const MIXED: u32 = 25;

/// Writes nodes with the height of the ground and their codes, and triangles.
///
/// # Errors
/// Fails with the errors of `out`, where the boundary touches itself in a node, and where no edge of an open
/// piece beside land of one edge would remain.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let strings = BoundaryStrings::new(mesh, data, ".mesh", BoundaryType::lets_water_through)?;
    let codes = strings.node_codes(mesh, ".mesh")?;
    let system = if data.provenance.unit() == LengthUnit::Degree { "LONG/LAT" } else { "NON-UTM" };
    let [item, unit] = BATHYMETRY;
    writeln!(out, "{item} {unit} {} {system}", mesh.nodes().len())?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        let (x, y, z) = (Number(p.x), Number(p.y), Number(data.ground(node)));
        writeln!(out, "{} {x} {y} {z} {}", node + 1, codes[node])
    })?;
    let cells = WrittenCells::new(mesh, data, FORMAT.squares);
    let has_fourth = cells.most_corners() == 4;
    let kind = if has_fourth { MIXED } else { TRIANGLES };
    writeln!(out, "{} {} {kind}", cells.count(), cells.most_corners())?;
    write_rows(out, cells.count(), |out, id| {
        let (corners, fourth) = cells.corners(id);
        let [a, b, c] = corners.map(|node| node + 1);
        match has_fourth {
            false => writeln!(out, "{} {a} {b} {c}", id + 1),
            // A triangle has 0 for the fourth node.
            true => writeln!(out, "{} {a} {b} {c} {}", id + 1, fourth.map_or(0, |node| node + 1)),
        }
    })
}
