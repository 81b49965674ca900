//! Files, one module per format.
//!
//! A mesh writer is a function `write(out, mesh, data)`; the mesh is an
//! [`Extract`](meshbrush_mesh::mesh::Extract).
//! All formats agree on this:
//!
//! - nodes and triangles are in the order of the extract, unless the format says otherwise;
//! - a triangle's vertices run anticlockwise, the first two being the ends of its bisection edge;
//! - coordinates and h̄ are in world units; a number is the shortest text that reads back as the same f64;
//! - the third coordinate of a node is the height of a surface, [`MeshData::heights`], or 0, where a format
//!   has one that is no depth;
//! - numbers of nodes and triangles start at zero, except in `.msh`, `.obj`, `.2dm` and the formats of
//!   coastal solvers, which start at one.
//!
//! The formats of coastal solvers (`fort14`, `gr3`, `selafin`, `mike`, `msh2`, `fvcom`, `ugrid`) have a depth
//! at each node, [`MeshData::depths`], and most of them the boundary as strings of nodes
//! (`boundary_strings`).
//!
//! A function that can take longer than a frame takes a [`Meter`], or has a variant `…_metered` that does: it
//! counts bytes, and fails with [`Cancelled`] once the meter is cancelled.

pub mod asc;
mod atomic;
mod blocks;
mod boundary_strings;
pub mod certificate;
mod claim;
mod coordinate_system;
mod coordinates;
pub mod csv;
pub mod disk;
mod error;
mod fault;
mod features;
mod folder;
pub mod fort14;
pub mod fvcom;
mod gdal_metadata;
mod given;
pub mod gr3;
mod interrupt;
pub mod link;
mod mesh_file;
mod meter;
pub mod mike;
pub mod geojson;
pub mod geotiff;
pub mod glb;
pub mod gpkg;
pub mod gpx;
pub mod journal;
mod json;
pub mod kml;
pub mod layers;
pub mod located;
pub mod msh;
pub mod msh2;
pub mod netcdf;
mod netcdf_writer;
pub mod node;
pub mod npy;
pub mod obj;
mod parallel_rows;
pub mod path;
mod pipe;
pub mod ply;
pub mod png;
pub mod points;
mod positions;
pub mod project;
mod provenance;
mod raster_file;
pub mod recipe;
pub mod recording;
mod route_on_earth;
mod rows;
mod samples;
pub mod selafin;
pub mod settings;
pub mod shape_format;
pub mod shapes;
pub mod shp;
pub mod sms;
mod stamp;
pub mod stl;
pub mod svg;
mod table;
mod text_file;
pub mod threats;
mod triangle_pieces;
pub mod ugrid;
mod values;
mod vertical;
pub mod vtu;
#[cfg(feature = "gpkg")]
mod wkb;
mod wkt_projection;
pub mod world_file;

use std::io::{self, Write};

pub use atomic::{exists, is_read_only, make_folder, obstacle, remove_new, write_file, write_file_metered};
pub use claim::Claim;
pub use coordinate_system::{CoordinateKind, CoordinateSystem};
pub use coordinates::{DocumentPlane, FileCoordinates};
pub use error::{Flaw, PlaceInFile, ReadError};
pub use fault::{KeyFault, KeyStep, Mark, nearest_word};
pub use folder::{FolderEntry, FolderListing, MOST_ENTRIES, is_folder, list_folder, resolve};
pub use given::{Given, GivenGrid};
pub use interrupt::Interruption;
pub use mesh_file::{FormatSpec, MeshFormat, ThirdCoordinate, TypicalSize};
use meshbrush_core::domain::MeshBoundary;
pub use meshbrush_mesh::text::Number;
pub use meter::{Cancelled, Counted, Meter};
use parallel_rows::write_rows;
pub use provenance::{MeshSource, Provenance};
pub use raster_file::{FileGrid, GridPlace, GridWindow, RasterFormat, RasterFormatSpec, ReadRaster};
pub use route_on_earth::RouteOnEarth;
use shape_format::ShapeFormatSpec;
pub use stamp::{FileStamp, Stamping};
pub use text_file::read_text;
pub use values::TextValue;
pub use vertical::{UnitOfLength, ValueFacts, ValueUnit, VerticalSystem};

/// The formats of meshes. A new one is a module and an entry here.
static MESH_FORMATS: [&FormatSpec; 17] = [
    &vtu::FORMAT,
    &msh::FORMAT,
    &obj::FORMAT,
    &stl::FORMAT,
    &ply::FORMAT,
    &glb::FORMAT,
    &node::FORMAT,
    &sms::FORMAT,
    &csv::FORMAT,
    &fort14::FORMAT,
    &gr3::FORMAT,
    &gr3::FORMAT_IN_DEGREES,
    &ugrid::FORMAT,
    &selafin::FORMAT,
    &mike::FORMAT,
    &msh2::FORMAT,
    &fvcom::FORMAT,
];

/// The formats of rasters. A new one is a module and an entry here.
static RASTER_FORMATS: [&RasterFormatSpec; 5] =
    [&png::RASTER, &asc::RASTER, &geotiff::RASTER, &netcdf::RASTER, &npy::RASTER];

/// The formats of shapes. A new one is a module and an entry here.
static SHAPE_FORMATS: [&ShapeFormatSpec; 3] = [&geojson::FORMAT, &shp::FORMAT, &gpkg::FORMAT];

/// The data that is written with a mesh. The level of each triangle comes from the mesh.
///
/// In files a piece of the boundary has the marker 1 + its number.
#[derive(Clone, Copy, Debug)]
pub struct MeshData<'a> {
    /// h̄ at each node, in world units, in the order of the extract's nodes; only formats with
    /// [`MeshFormat::has_targets`] read it.
    pub target_diameter: &'a [f64],
    /// Further values at the nodes, in the same order.
    pub quantities: &'a [NodeValues],
    /// The height of each node above the plane, in the same order, for formats with a third coordinate.
    pub heights: Option<&'a [f64]>,
    /// The boundary in named pieces.
    pub boundary: &'a MeshBoundary,
    /// The number of each triangle's part, from 0 for the largest: [`Extract::part_numbers`].
    ///
    /// [`Extract::part_numbers`]: meshbrush_mesh::mesh::Extract::part_numbers
    pub parts: &'a [u32],
    /// The origin of the mesh, for all formats except `.csv`, whose readers take no comments.
    pub provenance: &'a Provenance,
}

/// A value at each node, and its name in files.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeValues {
    /// Letters, digits and underscores.
    pub name: String,
    /// One value for each node.
    pub values: Vec<f64>,
}

/// The name of the quantity that is the depth.
pub const DEPTH: &str = "depth";

/// The name of the values of surfaces at the nodes.
pub const SURFACE: &str = "surface";

impl MeshData<'_> {
    /// The depth at each node, positive downwards, for the formats of coastal solvers: the quantity with the
    /// name `depth`. Without it they have depth 0 everywhere; h̄ is a length of triangles and no depth.
    pub fn depths(&self) -> Option<&[f64]> {
        self.quantities.iter().find(|quantity| quantity.name == DEPTH).map(|depth| &*depth.values)
    }

    /// The third coordinate of a node: the height of the surface, 0 without one.
    fn height(&self, node: usize) -> f64 {
        self.heights.map_or(0.0, |heights| heights[node])
    }

    /// The depth at a node, positive downwards; 0 without depths.
    fn depth(&self, node: usize) -> f64 {
        self.depths().map_or(0.0, |depths| depths[node])
    }

    /// The height of the ground at a node, positive upwards; 0 without depths.
    fn ground(&self, node: usize) -> f64 {
        0.0 - self.depth(node) // not -0 without depths
    }

    /// Writes the origin of the mesh in lines that a format takes for comments.
    fn write_comments(&self, out: &mut impl Write) -> io::Result<()> {
        self.provenance.lines().try_for_each(|line| writeln!(out, "# {line}"))
    }

    /// h̄ and then the quantities, each with its name.
    fn node_values(&self) -> impl Iterator<Item = (&str, &[f64])> + Clone {
        let further = self.quantities.iter().map(|q| (q.name.as_str(), q.values.as_slice()));
        std::iter::once(("target_diameter", self.target_diameter)).chain(further)
    }
}
