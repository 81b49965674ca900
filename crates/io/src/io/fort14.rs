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
//! Weirs are cracks in the mesh (`weirs`), of IBTYPE 24: after a node at the front of a weir comes the one at
//! its back, the height of the crest, and the coefficients of subcritical and supercritical flow. Of the two
//! types of internal barriers, 24 has the flow across the weir as a natural condition. 4 sets the velocity at
//! its nodes, and ADCIRC's manual advises against it: it can make a run unstable. The number of nodes of the
//! string counts pairs, and the total counts both nodes of a pair.
//!
//! Strings that are not open have ADCIRC's number (IBTYPE) of their [`BoundaryType`]: 0 for land, 1 for an
//! island and 2 for an inflow, where the flow across the boundary is an essential condition and the flow
//! along it is free; 10 more without slip, and 20 more where it is a natural condition.

use std::io::{self, Write};

use super::boundary_strings::{BoundaryString, BoundaryStrings, StringKind};
use super::format_spec::SquareCells;
use super::weirs::{WeirCracks, WeirPair, WeirString};
use super::written_cells::{CellShape, WrittenCells};
use super::{FormatSpec, MeshData, Number, QuantityPlaces, TypicalSize, fort13, write_rows};
use meshbrush_core::domain::BoundaryType;
use meshbrush_mesh::mesh::{Extract, NodeId};

/// ADCIRC.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "ADCIRC (fort.14): open boundaries, land and islands",
    size: SIZE,
    has_open_boundary: true,
    has_weirs: true,
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
/// Its number for a weir inside the domain.
const WEIR: u32 = 24;

/// Writes title, nodes with depths, triangles, open boundaries, and land with inflows, islands and weirs.
///
/// # Errors
/// Fails with the errors of `out`, where the boundary touches itself in a node, and where the crest of a weir
/// is not above the ground.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let dialect = Dialect {
        format: "fort.14",
        is_open: BoundaryType::is_open,
        joins_open: true,
        number_of_closed: adcirc_number,
    };
    // ADCIRC has no quadrilaterals.
    let data = MeshData { cells: CellShape::Triangles, ..*data };
    let cracks = WeirCracks::new(mesh, &data);
    check_crests(mesh, &data, &cracks.strings)?;
    write_dialect(out, mesh, &data, &dialect, &cracks)
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

/// Fails where the crest of a weir is not above the ground at its nodes: ADCIRC ends there.
fn check_crests(mesh: &Extract, data: &MeshData, weirs: &[WeirString<'_>]) -> io::Result<()> {
    for WeirString { line, pairs, .. } in weirs {
        let is_low = |pair: &&WeirPair| pair.crest <= data.ground(pair.nodes[0].min(pair.nodes[1]));
        let Some(WeirPair { nodes, crest }) = pairs.iter().find(is_low) else { continue };
        // The smaller number is that of the mesh.
        let node = nodes[0].min(nodes[1]);
        let (p, low) = (mesh.world(NodeId::from_index(node)), pairs.iter().filter(is_low).count());
        return Err(io::Error::other(format!(
            "ADCIRC ends where the crest of a weir is not above the ground, and that of \"{}\" is {} and the ground {} at \
             x = {}, y = {}, as at {low} of its {} pairs of nodes; raise the crest, or check depths and their sign",
            line.name,
            Number(*crest),
            Number(data.ground(node)),
            Number(p.x),
            Number(p.y),
            pairs.len()
        )));
    }
    Ok(())
}

/// Writes as [`write()`] does, with the mesh opened along `cracks`.
pub(super) fn write_dialect(
    out: &mut impl Write,
    mesh: &Extract,
    data: &MeshData,
    dialect: &Dialect,
    cracks: &WeirCracks<'_>,
) -> io::Result<()> {
    let strings = BoundaryStrings::new(mesh, data, dialect.format, dialect.is_open)?;
    let strings = if dialect.joins_open { strings.with_open_joined() } else { strings };
    writeln!(out, "{}", data.provenance.line())?;
    let cells = WrittenCells::new(mesh, data, SquareCells::Possible);
    writeln!(out, "{} {}", cells.count(), cracks.node_count())?;
    write_rows(out, cracks.node_count(), |out, id| {
        let node = cracks.origin(id);
        let p = mesh.world(NodeId::from_index(node));
        writeln!(out, "{} {} {} {}", id + 1, Number(p.x), Number(p.y), Number(data.depth(node)))
    })?;
    write_rows(out, cells.count(), |out, id| {
        let (corners, fourth) = cells.corners(id);
        match fourth {
            None => {
                let [a, b, c] = cracks.corners(id, corners).map(|node| node + 1);
                writeln!(out, "{} 3 {a} {b} {c}", id + 1)
            }
            Some(d) => {
                let [a, b, c] = corners.map(|node| node + 1);
                writeln!(out, "{} 4 {a} {b} {c} {}", id + 1, d + 1)
            }
        }
    })?;
    let parts = |string: &BoundaryString| cracks.opened(mesh, string);
    let open: Vec<BoundaryString> = strings.open().flat_map(parts).collect();
    write_head(out, "open", open.len(), open.iter().map(|string| string.distinct().len()).sum())?;
    write_strings(out, "open", &open, |_| 0)?;
    let closed: Vec<BoundaryString> = strings.closed().flat_map(parts).collect();
    let of_weirs: usize = cracks.strings.iter().map(|string| 2 * string.pairs.len()).sum();
    let nodes = closed.iter().map(|string| string.distinct().len()).sum::<usize>() + of_weirs;
    write_head(out, "land", closed.len() + cracks.strings.len(), nodes)?;
    write_strings(out, "land", &closed, dialect.number_of_closed)?;
    let numbers = closed.len() + 1..;
    numbers.zip(&cracks.strings).try_for_each(|(number, weir)| write_weir(out, number, weir))
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

/// Writes how many strings of a kind there are, and the nodes of all together.
fn write_head(out: &mut impl Write, kind: &str, strings: usize, nodes: usize) -> io::Result<()> {
    writeln!(out, "{strings} = Number of {kind} boundaries")?;
    writeln!(out, "{nodes} = Total number of {kind} boundary nodes")
}

/// Writes the strings of a kind, one after the other.
fn write_strings(
    out: &mut impl Write,
    kind: &str,
    strings: &[BoundaryString],
    number_of: impl Fn(&BoundaryString) -> u32,
) -> io::Result<()> {
    for (number, string) in (1..).zip(strings) {
        let (count, code) = (string.distinct().len(), number_of(string));
        writeln!(out, "{count} {code} = Number of nodes for {kind} boundary {number}: {}", string.name)?;
        string.distinct().iter().try_for_each(|node| writeln!(out, "{}", node + 1))?;
    }
    Ok(())
}

/// Writes the pairs of a weir, the node at its front first.
fn write_weir(out: &mut impl Write, number: usize, weir: &WeirString<'_>) -> io::Result<()> {
    let (count, name) = (weir.pairs.len(), &weir.line.name);
    writeln!(out, "{count} {WEIR} = Number of node pairs for weir (land boundary {number}): {name}")?;
    let coefficients = [weir.weir.subcritical, weir.weir.supercritical].map(Number);
    for WeirPair { nodes, crest } in &weir.pairs {
        let ([front, back], [low, high]) = (nodes.map(|node| node + 1), &coefficients);
        writeln!(out, "{front} {back} {} {low} {high}", Number(*crest))?;
    }
    Ok(())
}
