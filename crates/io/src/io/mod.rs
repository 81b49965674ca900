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
//! The formats of solvers (`fort14`, `gr3`, `selafin`, `mike`, `ww3`, `fvcom`, `ugrid`, `disv`) have a depth
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
pub mod class_table;
mod coordinate_system;
mod coordinates;
pub mod csv;
pub mod disk;
pub mod disv;
mod error;
mod fault;
mod features;
mod folder;
mod format_spec;
mod formats;
pub mod fort13;
pub mod fort14;
pub mod fvcom;
mod gdal_metadata;
mod given;
pub mod gr3;
pub mod i2s;
mod interrupt;
pub mod link;
mod mesh_data;
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
pub mod lengths;
pub mod located;
pub mod msh;
pub mod msh22;
pub mod netcdf;
mod netcdf_writer;
pub mod node;
pub mod npy;
pub mod obj;
mod parallel_rows;
mod partition;
pub mod path;
mod pipe;
pub mod pli;
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
pub mod solver_rules;
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
mod weirs;
mod written_cells;
#[cfg(feature = "gpkg")]
mod wkb;
mod wkt_projection;
pub mod world_file;
pub mod ww3;

pub use atomic::{exists, is_read_only, make_folder, obstacle, remove_new, write_file, write_file_metered};
pub use claim::Claim;
pub use class_table::ClassTable;
pub use coordinate_system::{CoordinateKind, CoordinateSystem};
pub use coordinates::{DocumentPlane, FileCoordinates};
pub use error::{Flaw, PlaceInFile, ReadError};
pub use fault::{FaultPart, KeyFault, KeyStep, Mark, nearest_word};
pub use folder::{FolderEntry, FolderListing, MOST_ENTRIES, is_folder, list_folder, resolve};
pub use format_spec::{
    FileGrid, FormatSpec, GridPlace, GridWindow, QuantityPlaces, RasterFormatSpec, ReadRaster, SquareCells,
    ThirdCoordinate, TypicalSize,
};
pub use given::{Given, GivenGrid};
pub use interrupt::Interruption;
pub use mesh_data::{DEPTH, MeshData, NodeValues, SURFACE};
pub use mesh_file::MeshFormat;
pub use meshbrush_mesh::text::Number;
pub use meter::{Cancelled, Counted, Meter};
use parallel_rows::write_rows;
pub use partition::PartitionFigures;
pub use provenance::{MeshSource, Provenance};
pub use raster_file::RasterFormat;
pub use route_on_earth::RouteOnEarth;
pub use stamp::{FileStamp, Stamping};
pub use text_file::read_text;
pub use values::TextValue;
pub use vertical::{UnitOfLength, ValueFacts, ValueUnit, VerticalSystem};
pub use weirs::weir_notes;
pub use written_cells::{CellShape, JoinedCells, UnknownCells, joined_cells, joined_links};
