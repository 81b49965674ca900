//! `.disv`: the grid of MODFLOW 6, discretization by vertices (the DISV package) in one layer.
//!
//! Cells are quadrilaterals and triangles, as for Delft3D-FM: MODFLOW takes the flow between two cells for
//! that along the line between their centres, which should cross the edge at a right angle, and divides by
//! its length, so no two centres may be at one place. The centre of a cell is
//! [`MeshCells::centers`](meshbrush_core::cells::MeshCells::centers). Vertices of a cell run clockwise, and
//! numbers start at one.
//!
//! The top of a cell is the height of the surface at its centre, 0 without one; the bottom is minus the depth
//! there, and without depths 1 below the top, for a person to replace: the header says which. Values between
//! nodes are those of the triangle that the centre is in. MODFLOW refuses cells without thickness, and so
//! does the writer, with the place. Its lengths are metres: coordinates in kilometres are multiplied by 1000,
//! degrees are refused, and where the unit of the mesh is not known none is written.

use std::io::{self, Write};

use glam::DVec2;

use super::written_cells::WrittenCells;
use super::{FormatSpec, MeshData, Number, SquareCells, ThirdCoordinate, TypicalSize, write_rows};
use meshbrush_mesh::mesh::{Extract, NodeId};
use meshbrush_mesh::text::{LengthUnit, digits};

/// MODFLOW 6.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "MODFLOW 6 (DISV): squares and triangles, with top and bottom at their centres",
    size: TypicalSize { bytes: 50.0, bytes_per_digit: 5.0 },
    needs_lengths: true,
    squares: SquareCells::Usual,
    third: ThirdCoordinate::Height,
    ..FormatSpec::new("disv", &["disv"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// How far below the top the bottom is where there are no depths.
const THICKNESS_WITHOUT_DEPTHS: f64 = 1.0;

/// Writes vertices and cells, with the top and bottom of the one layer.
///
/// # Errors
/// Fails with the errors of `out`, for a mesh in degrees, and where a cell has no thickness.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let scale = metres(data.provenance.unit())?;
    let cells = WrittenCells::new(mesh, data, FORMAT.squares);
    let layer = OneLayer::new(data, &cells)?;
    write_header(out, data, scale)?;
    if data.provenance.unit() != LengthUnit::None {
        writeln!(out, "BEGIN OPTIONS\n  LENGTH_UNITS METERS\nEND OPTIONS\n")?;
    }
    let (count, nodes) = (cells.count(), mesh.nodes().len());
    writeln!(out, "BEGIN DIMENSIONS\n  NLAY 1\n  NCPL {count}\n  NVERT {nodes}\nEND DIMENSIONS\n")?;
    writeln!(out, "BEGIN GRIDDATA\n  TOP\n    INTERNAL FACTOR 1.0")?;
    write_rows(out, count, |out, cell| writeln!(out, "{}", Number(layer.top[cell])))?;
    writeln!(out, "  BOTM LAYERED\n    INTERNAL FACTOR 1.0")?;
    write_rows(out, count, |out, cell| writeln!(out, "{}", Number(layer.bottom[cell])))?;
    writeln!(out, "END GRIDDATA\n\nBEGIN VERTICES")?;
    write_rows(out, nodes, |out, node| {
        let p = scale * mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {}", node + 1, Number(p.x), Number(p.y))
    })?;
    writeln!(out, "END VERTICES\n\nBEGIN CELL2D")?;
    write_rows(out, count, |out, cell| {
        let center = scale * layer.centers[cell];
        let ([a, b, c], fourth) = cells.corners(cell);
        write!(out, "{} {} {}", cell + 1, Number(center.x), Number(center.y))?;
        let [a, b, c] = [a, b, c].map(|node| node + 1);
        match fourth {
            None => writeln!(out, " 3 {c} {b} {a}"),
            Some(d) => writeln!(out, " 4 {} {c} {b} {a}", d + 1),
        }
    })?;
    writeln!(out, "END CELL2D")
}

/// Returns what coordinates are multiplied by to be in metres.
fn metres(unit: LengthUnit) -> io::Result<f64> {
    match unit {
        LengthUnit::Metre | LengthUnit::None => Ok(1.0),
        LengthUnit::Kilometre => Ok(1000.0),
        LengthUnit::Degree => Err(io::Error::other(
            "MODFLOW needs lengths, and the coordinates of this mesh are degrees; write those of the plane \
             (--out-crs plane), or choose a projection for the document",
        )),
    }
}

/// Writes in comments where the mesh comes from, and what top, bottom and centres are.
fn write_header(out: &mut impl Write, data: &MeshData, scale: f64) -> io::Result<()> {
    data.write_comments(out)?;
    if scale != 1.0 {
        writeln!(out, "# coordinates in this file are in metres, {scale} times those of the mesh")?;
    }
    let top = if data.heights.is_some() { "the height of the surface" } else { "0: there is no surface" };
    writeln!(out, "# top: {top}")?;
    match data.depths() {
        Some(_) => writeln!(out, "# botm: minus the depth at the centre of each cell")?,
        None => writeln!(
            out,
            "# botm: there is no depth; {THICKNESS_WITHOUT_DEPTHS} below the top, to be replaced"
        )?,
    }
    writeln!(out, "# centres: as far from all corners as the cell allows\n")
}

/// The centre, the top and the bottom of each cell.
struct OneLayer {
    centers: Vec<DVec2>,
    top: Vec<f64>,
    bottom: Vec<f64>,
}

impl OneLayer {
    fn new(data: &MeshData, cells: &WrittenCells<'_>) -> io::Result<Self> {
        let unit = data.provenance.unit();
        let (centers, [top, ground]) =
            cells.centers(unit, [&|node| data.height(node), &|node| data.ground(node)]);
        let bottom = match data.depths() {
            Some(_) => ground,
            None => top.iter().map(|top| top - THICKNESS_WITHOUT_DEPTHS).collect(),
        };
        match (0..centers.len()).find(|&cell| bottom[cell] >= top[cell]) {
            Some(cell) => Err(no_thickness(centers[cell], top[cell], bottom[cell])),
            None => Ok(Self { centers, top, bottom }),
        }
    }
}

fn no_thickness(at: DVec2, top: f64, bottom: f64) -> io::Error {
    io::Error::other(format!(
        "MODFLOW refuses cells without thickness: at x = {}, y = {} the bottom {} is not below the top {}; write a least \
         depth (--least-depth 1), or another surface",
        digits(at.x, 9),
        digits(at.y, 9),
        digits(bottom, 4),
        digits(top, 4),
    ))
}
