//! `.slf` and `.cli`: SELAFIN, the mesh of TELEMAC in double precision, and its boundary conditions.
//!
//! SELAFIN is a sequence of Fortran records, big-endian: each has its length in bytes before and after it.
//! Numbers start at one. The variables, at time 0, are `BOTTOM`, the height of the ground in metres, positive
//! upwards, and the quantities other than the depth: `manning` is `BOTTOM FRICTION`, and others have their
//! own names in capitals, with blanks for `_`. IPOBO is the place of a node along the boundary: outer loops
//! anticlockwise, then holes clockwise.
//!
//! `.cli` has a line for each boundary node in that order. Open nodes are `5 4 4` (the water level is given,
//! the velocity free), those of inflows `4 5 5` (the flow is given, and tracers too), those of land without
//! slip `2 0 0`, and others `2 2 2` (a wall); the values are 0. The last two numbers are the node and its
//! place. The name of the piece follows after a `#`, where TELEMAC does not read. TELEMAC takes a
//! boundary edge for a wall if one of its nodes is; so nodes between open pieces and land are open.
//!
//! Lines of the document are in a file beside them, [`i2s`].

use std::io::{self, Write};

use super::boundary_strings::{BoundaryString, BoundaryStrings, LAND};
use super::{FormatSpec, MeshData, NodeValues, QuantityPlaces, TypicalSize, i2s, write_rows};
use meshbrush_core::domain::BoundaryType;
use meshbrush_mesh::mesh::{Extract, NodeId, TriangleId};
use meshbrush_mesh::text::Grouped;

/// TELEMAC.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "TELEMAC (SELAFIN): two files, mesh and boundary conditions",
    size: TypicalSize { bytes: 33.0, bytes_per_digit: 0.0 },
    has_open_boundary: true,
    quantities: QuantityPlaces::All,
    beside: &[("cli", |out, mesh, data, meter| write_conditions(&mut meter.count(out), mesh, data))],
    beside_lines: &[(".i2s", |out, mesh, data, meter| i2s::write(&mut meter.count(out), mesh, data))],
    ..FormatSpec::new("slf", &["slf"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// Bytes of the title, and the word after it that says that real numbers have eight bytes.
const TITLE: usize = 72;
const DOUBLE: &[u8; 8] = b"SERAFIND";
/// Bytes of the name of a variable, and of its unit.
const NAME: usize = 16;
/// The names of quantities that TELEMAC calls otherwise.
const NAMES: [(&str, &str); 1] = [("manning", "BOTTOM FRICTION")];
/// Most bytes of a record.
const LONGEST_RECORD: usize = i32::MAX as usize;

/// Writes `.slf`.
///
/// # Errors
/// Fails with the errors of `out`, where the boundary touches itself in a node, for a mesh with more nodes or
/// triangles than a record can hold, and where two quantities have one name in 16 letters.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let (nodes, triangles) = (mesh.nodes().len(), mesh.triangles().len());
    check_size(nodes, triangles)?;
    let strings = BoundaryStrings::new(mesh, data, "SELAFIN", BoundaryType::lets_water_through)?;
    let mut places = vec![0_i32; nodes];
    for (place, (node, _)) in (1..).zip(strings.ring_nodes()) {
        places[node] = place;
    }
    let title = data.provenance.title::<TITLE>();
    write_record(out, TITLE + DOUBLE.len(), |out| {
        out.write_all(&title)?;
        out.write_all(DOUBLE)
    })?;
    let names = variables(data)?;
    write_integers(out, &[names.len() as i32, 0])?; // none in quadratic elements
    for (name, unit) in names.iter().zip(["M"].into_iter().chain(std::iter::repeat(""))) {
        write_record(out, 2 * NAME, |out| write!(out, "{name:NAME$}{unit:NAME$}"))?;
    }
    // No origin, one plane, no date.
    write_integers(out, &[1, 0, 0, 0, 0, 0, 0, 0, 0, 0])?;
    write_integers(out, &[triangles as i32, nodes as i32, 3, 1])?;
    write_record(out, 3 * size_of::<i32>() * triangles, |out| {
        write_rows(out, triangles, |out, id| {
            let corners = mesh.cell(TriangleId::from_index(id)).corners;
            corners.iter().try_for_each(|&node| out.write_all(&(node as i32 + 1).to_be_bytes()))
        })
    })?;
    write_record(out, size_of::<i32>() * nodes, |out| {
        write_rows(out, nodes, |out, node| out.write_all(&places[node].to_be_bytes()))
    })?;
    write_reals(out, nodes, |node| mesh.world(NodeId::from_index(node)).x)?;
    write_reals(out, nodes, |node| mesh.world(NodeId::from_index(node)).y)?;
    write_reals(out, 1, |_| 0.0)?; // the time
    write_reals(out, nodes, |node| data.ground(node))?;
    data.attributes().try_for_each(|of| write_reals(out, nodes, |node| of.values[node]))
}

/// Returns the names of the variables: the ground, and the quantities.
fn variables(data: &MeshData) -> io::Result<Vec<String>> {
    let mut names = vec!["BOTTOM".to_owned()];
    for NodeValues { name, .. } in data.attributes() {
        let known = NAMES.iter().find(|(own, _)| own == name).map(|(_, known)| (*known).to_owned());
        let own = || name.to_uppercase().replace('_', " ").trim().chars().take(NAME).collect::<String>();
        let variable = known.unwrap_or_else(own);
        if names.contains(&variable) {
            return Err(io::Error::other(format!(
                "SELAFIN has names of {NAME} letters, and the quantity {name} would be {variable} there, as another \
                 variable is; give it another name"
            )));
        }
        names.push(variable);
    }
    Ok(names)
}

/// Writes `.cli`.
///
/// # Errors
/// Fails with the errors of `out`, where the boundary touches itself in a node, and where no edge of an open
/// piece beside land of one edge would remain.
pub fn write_conditions(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let strings = BoundaryStrings::new(mesh, data, ".cli", BoundaryType::lets_water_through)?;
    let codes = strings.node_codes(mesh, ".cli")?;
    let open: Vec<&BoundaryString> = strings.open().collect();
    for (place, (node, string)) in (1_usize..).zip(strings.ring_nodes()) {
        let open = codes[node].checked_sub(LAND + 1).map(|number| open[number as usize]);
        let (kinds, tracer) = match open.map(|open| open.boundary_type) {
            Some(BoundaryType::Open) => ("5 4 4", 4),
            Some(_) => ("4 5 5", 5),
            None if string.boundary_type == BoundaryType::NoSlipLand => ("2 0 0", 2),
            None => ("2 2 2", 2),
        };
        let name = &open.unwrap_or(string).name;
        writeln!(out, "{kinds} 0.0 0.0 0.0 0.0 {tracer} 0.0 0.0 0.0 {} {place} # {name}", node + 1)?;
    }
    Ok(())
}

fn check_size(nodes: usize, triangles: usize) -> io::Result<()> {
    let most_nodes = LONGEST_RECORD / size_of::<f64>();
    let most_triangles = LONGEST_RECORD / (3 * size_of::<i32>());
    if nodes <= most_nodes && triangles <= most_triangles {
        return Ok(());
    }
    Err(io::Error::other(format!(
        "SELAFIN holds {} nodes and {} triangles at most, and the mesh has {} and {}; choose a larger diameter, or .nc",
        Grouped(most_nodes),
        Grouped(most_triangles),
        Grouped(nodes),
        Grouped(triangles)
    )))
}

/// Writes a record of `bytes` bytes, which [`check_size`] limits.
fn write_record<W: Write>(
    out: &mut W,
    bytes: usize,
    write: impl FnOnce(&mut W) -> io::Result<()>,
) -> io::Result<()> {
    let length = (bytes as i32).to_be_bytes();
    out.write_all(&length)?;
    write(out)?;
    out.write_all(&length)
}

fn write_integers(out: &mut impl Write, values: &[i32]) -> io::Result<()> {
    write_record(out, size_of_val(values), |out| {
        values.iter().try_for_each(|value| out.write_all(&value.to_be_bytes()))
    })
}

fn write_reals(out: &mut impl Write, count: usize, value: impl Fn(usize) -> f64 + Sync) -> io::Result<()> {
    write_record(out, size_of::<f64>() * count, |out| {
        write_rows(out, count, |out, number| out.write_all(&value(number).to_be_bytes()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_that_is_too_large_for_a_record_is_refused() {
        assert!(check_size(268_435_455, 178_956_970).is_ok());
        for (nodes, triangles) in [(268_435_456, 3), (3, 178_956_971)] {
            let error = check_size(nodes, triangles).unwrap_err().to_string();
            assert!(
                error.starts_with("SELAFIN holds 268,435,455 nodes and 178,956,970 triangles"),
                "{error}"
            );
        }
    }
}
