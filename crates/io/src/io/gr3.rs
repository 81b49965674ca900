//! `hgrid.gr3` and `hgrid.ll`: the mesh of SCHISM.
//!
//! The contents are those of ADCIRC's [`fort14`], but for the boundary: SCHISM reads the type of land as 0 on
//! the outer boundary and 1 for islands, and takes a given flow at open boundaries. So inflows are open
//! strings, and how land treats the flow is not written. Neighbouring open pieces stay strings of their own,
//! each with its line in `bctides.in`: SCHISM takes a node that is in two of them. `hgrid.ll` is the same
//! file in degrees of longitude and latitude. A mesh that is known to be in metres or kilometres is refused
//! as `.ll`.

use std::io::{self, Write};

use super::fort14::{self, Dialect, number_of_land, write_dialect};
use super::weirs::WeirCracks;
use super::{FormatSpec, MeshData, SquareCells};
use meshbrush_core::domain::BoundaryType;
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::LengthUnit;

/// SCHISM.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "SCHISM (hgrid.gr3): open boundaries, land and islands",
    size: fort14::SIZE,
    has_open_boundary: true,
    squares: SquareCells::Possible,
    parts_file: Some("partition.prop"),
    ..FormatSpec::new("gr3", &["gr3"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// SCHISM, with longitudes and latitudes.
pub static FORMAT_IN_DEGREES: FormatSpec = FormatSpec {
    purpose: "SCHISM (hgrid.ll): the same in degrees",
    size: fort14::SIZE,
    has_open_boundary: true,
    squares: SquareCells::Possible,
    parts_file: Some("partition.prop"),
    ..FormatSpec::new("ll", &["ll"], |out, mesh, data, meter| {
        write_in_degrees(&mut meter.count(out), mesh, data)
    })
};

/// Writes `hgrid.gr3`.
///
/// # Errors
/// Fails as [`fort14::write`] does.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    write_dialect(out, mesh, data, &dialect("hgrid.gr3"), &WeirCracks::none(mesh))
}

/// Writes `hgrid.ll`.
///
/// # Errors
/// Fails as [`fort14::write`] does, and when the unit of the mesh is a length.
pub fn write_in_degrees(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    match data.provenance.unit() {
        LengthUnit::Degree | LengthUnit::None => {
            write_dialect(out, mesh, data, &dialect("hgrid.ll"), &WeirCracks::none(mesh))
        }
        unit @ (LengthUnit::Metre | LengthUnit::Kilometre) => Err(io::Error::other(format!(
            "hgrid.ll holds longitudes and latitudes in degrees, and the coordinates of this mesh are in {}; write \
             hgrid.gr3, or set the unit of the document to degrees",
            unit.symbol()
        ))),
    }
}

fn dialect(format: &'static str) -> Dialect {
    Dialect {
        format,
        is_open: BoundaryType::lets_water_through,
        joins_open: false,
        number_of_closed: number_of_land,
    }
}
