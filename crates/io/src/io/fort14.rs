//! `fort.14`: the mesh of ADCIRC, with open boundaries, land and islands.
//!
//! Records are numbers with blanks between them, and readers ignore the text after them, except in the second
//! line: it has the numbers of triangles and of nodes only. Numbers start at one. Depths are positive
//! downwards.
//!
//! Strings run with the domain on the left: outer boundaries anticlockwise, islands clockwise. Where open
//! boundary and land meet, they share their end node, which counts in both; an island does not repeat its
//! first node. The first line describes the origin of the mesh.
//!
//! ADCIRC adds the tide up over its list of open nodes (`gwce.F`), so each of them is in it once:
//! neighbouring open pieces are one string, with their names after its numbers, and a loop that is open all
//! around does not repeat its first node.
//!
//! Quantities other than the depth are attributes in a file beside it, [`fort13`].
//!
//! Strings that are not open have ADCIRC's number (IBTYPE) of their [`BoundaryType`]: 0 for land, 1 for an
//! island and 2 for an inflow, where the flow across the boundary is an essential condition and the flow
//! along it is free; 10 more without slip, and 20 more where it is a natural condition.

use std::io::{self, Write};

use super::boundary_strings::{BoundaryString, BoundaryStrings, StringKind};
use super::format_spec::SquareCells;
use super::written_cells::{CellShape, WrittenCells};
use super::{FormatSpec, MeshData, Number, QuantityPlaces, TypicalSize, fort13, write_rows};
use meshbrush_core::domain::BoundaryType;
use meshbrush_mesh::mesh::{Extract, NodeId};

/// ADCIRC.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "ADCIRC (fort.14): open boundaries, land and islands",
    size: SIZE,
    has_open_boundary: true,
    quantities: QuantityPlaces::All,
    attributes: Some(("13", |out, mesh, data, meter| fort13::write(&mut meter.count(out), mesh, data))),
    ..FormatSpec::new("fort14", &["14", "grd"], |out, mesh, data, meter| {
        write(&mut meter.count(out), mesh, data)
    })
};

/// The size of its files, and of those with the same contents.
pub(super) const SIZE: TypicalSize = TypicalSize { bytes: 38.0, bytes_per_digit: 4.5 };

/// ADCIRC's number for a string at which a flow comes in.
const INFLOW: u32 = 2;

/// Writes title, nodes with depths, triangles, open boundaries, and land with inflows and islands.
///
/// # Errors
/// Fails with the errors of `out`, and where the boundary touches itself in a node.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let dialect = Dialect {
        format: "fort.14",
        is_open: BoundaryType::is_open,
        joins_open: true,
        number_of_closed: adcirc_number,
    };
    // ADCIRC has no quadrilaterals.
    let data = MeshData { cells: CellShape::Triangles, ..*data };
    write_dialect(out, mesh, &data, &dialect)
}

/// What ADCIRC's file and SCHISM's differ in.
pub(super) struct Dialect {
    /// The name in errors.
    pub(super) format: &'static str,
    /// Which types are open strings.
    pub(super) is_open: fn(BoundaryType) -> bool,
    /// Whether open strings that follow one another are written as one.
    pub(super) joins_open: bool,
    /// The number of a string that is not open.
    pub(super) number_of_closed: fn(&BoundaryString) -> u32,
}

/// Writes as [`write()`] does.
pub(super) fn write_dialect(
    out: &mut impl Write,
    mesh: &Extract,
    data: &MeshData,
    dialect: &Dialect,
) -> io::Result<()> {
    let strings = BoundaryStrings::new(mesh, data, dialect.format, dialect.is_open)?;
    let strings = if dialect.joins_open { strings.with_open_joined() } else { strings };
    writeln!(out, "{}", data.provenance.line())?;
    let cells = WrittenCells::new(mesh, data, SquareCells::Possible);
    writeln!(out, "{} {}", cells.count(), mesh.nodes().len())?;
    write_rows(out, mesh.nodes().len(), |out, node| {
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {} {}", node + 1, Number(p.x), Number(p.y), Number(data.depth(node)))
    })?;
    write_rows(out, cells.count(), |out, id| {
        let ([a, b, c], fourth) = cells.corners(id);
        let (id, [a, b, c]) = (id + 1, [a, b, c].map(|node| node + 1));
        match fourth {
            None => writeln!(out, "{id} 3 {a} {b} {c}"),
            Some(d) => writeln!(out, "{id} 4 {a} {b} {c} {}", d + 1),
        }
    })?;
    write_strings(out, "open", &strings.open().collect::<Vec<_>>(), |_| 0)?;
    write_strings(out, "land", &strings.closed().collect::<Vec<_>>(), dialect.number_of_closed)
}

/// Returns ADCIRC's number for a string that is not open.
fn adcirc_number(string: &BoundaryString) -> u32 {
    let treatment = match string.boundary_type {
        BoundaryType::NoSlipLand | BoundaryType::NoSlipInflow => 10,
        BoundaryType::NaturalLand | BoundaryType::NaturalInflow => 20,
        _ => 0,
    };
    treatment + if string.boundary_type.lets_water_through() { INFLOW } else { number_of_land(string) }
}

/// Returns 1 for an island, and 0 for other land.
pub(super) fn number_of_land(string: &BoundaryString) -> u32 {
    u32::from(string.kind == StringKind::Island)
}

/// Writes the strings of a kind: how many, the nodes of all together, and then one after the other.
fn write_strings(
    out: &mut impl Write,
    kind: &str,
    strings: &[&BoundaryString],
    number_of: impl Fn(&BoundaryString) -> u32,
) -> io::Result<()> {
    let nodes: usize = strings.iter().map(|string| string.distinct().len()).sum();
    writeln!(out, "{} = Number of {kind} boundaries", strings.len())?;
    writeln!(out, "{nodes} = Total number of {kind} boundary nodes")?;
    for (number, string) in (1..).zip(strings) {
        let (count, code) = (string.distinct().len(), number_of(string));
        writeln!(out, "{count} {code} = Number of nodes for {kind} boundary {number}: {}", string.name)?;
        string.distinct().iter().try_for_each(|node| writeln!(out, "{}", node + 1))?;
    }
    Ok(())
}
