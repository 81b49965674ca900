//! What the module of a format says about it.

use std::io::{self, Write};
use std::path::Path;

use super::coordinate_system::{CoordinateKind, CoordinateSystem};
use super::geojson::Outline;
use super::mesh_data::MeshData;
use super::png::Behind;
use super::shapes::ShapeFile;
use super::{DocumentPlane, FileCoordinates, Meter, ReadError, ValueFacts};
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::LengthUnit;

/// A file format, as its module describes it.
pub struct FormatSpec {
    /// The name of the format: the usual extension, or another word.
    pub name: &'static str,
    /// The file name extensions that the format may have, in lower case and without the dot, the usual one
    /// first. Of several formats with one extension, the first in the list has it, and the others are chosen
    /// by their names.
    pub endings: &'static [&'static str],
    /// What the name of the first file ends with, as in `_grd.dat`; empty where an extension is enough.
    pub tail: &'static str,
    /// The programs that read the format, and its contents, in a few words for a list of formats.
    pub purpose: &'static str,
    /// How long its files are.
    pub size: TypicalSize,
    /// Whether h̄ at the nodes is in its files: [`MeshData::target_diameter`].
    pub has_targets: bool,
    /// Whether a coastal solver finds its open boundary in the files.
    pub has_open_boundary: bool,
    /// Whether weirs are in its files, as cracks with crests.
    pub has_weirs: bool,
    /// Whether coordinates have to be lengths: degrees are refused.
    pub needs_lengths: bool,
    /// Whether its files can have quadrilaterals.
    pub squares: SquareCells,
    /// The name of the file in which its solver looks for the part of each cell, if it has one.
    pub parts_file: Option<&'static str>,
    /// What the third coordinate of its nodes is.
    pub third: ThirdCoordinate,
    /// Which quantities have a place in the files.
    pub quantities: QuantityPlaces,
    /// The file beside the mesh with the quantities that have no place in it, if there are any: its extension
    /// and its writer.
    pub attributes: Option<(&'static str, WriteMesh)>,
    /// The files with the lines of the document, which are written where the mesh has edges along some: what
    /// follows the name of the mesh without its extension, as in `.i2s` and `_thd.pli`, and writers.
    pub beside_lines: &'static [(&'static str, WriteMesh)],
    /// The further files of the format: their extensions, or what takes the place of `tail`, and writers.
    pub beside: &'static [(&'static str, WriteMesh)],
    /// Writes a mesh.
    pub write: WriteMesh,
    /// Writes a mesh in binary form, if the format has a form of either kind.
    pub write_binary: Option<WriteMesh>,
}

impl FormatSpec {
    /// Returns a format of one file with this name and these extensions. It has neither h̄ nor open
    /// boundaries nor a third coordinate: a format says what it has beyond that, with `..FormatSpec::new(…)`.
    pub const fn new(name: &'static str, endings: &'static [&'static str], write: WriteMesh) -> Self {
        Self {
            name,
            endings,
            tail: "",
            purpose: "",
            size: TypicalSize { bytes: 50.0, bytes_per_digit: 5.0 },
            has_targets: false,
            has_open_boundary: false,
            has_weirs: false,
            needs_lengths: false,
            squares: SquareCells::Impossible,
            parts_file: None,
            third: ThirdCoordinate::None,
            quantities: QuantityPlaces::Depth,
            attributes: None,
            beside_lines: &[],
            beside: &[],
            write,
            write_binary: None,
        }
    }
}

/// Whether the files of a format can have quadrilaterals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SquareCells {
    /// There are triangles only.
    Impossible,
    /// They can, and have triangles unless a person wants squares.
    Possible,
    /// The solver wants them: pairs are joined unless a person wants triangles.
    Usual,
}

/// The third coordinate of nodes in the files of a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThirdCoordinate {
    /// There is none, or it is a depth for a solver.
    None,
    /// The height of a surface, [`MeshData::heights`].
    Height,
    /// The height of a surface, in a format of models in space, where all coordinates are lengths.
    Model,
}

/// Which quantities, beside the height of a surface, have a place in the files of a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuantityPlaces {
    /// At most the depth.
    Depth,
    /// The first one.
    First,
    /// All, some of them in a file of attributes.
    All,
}

/// How long the files of a format are, all together, as measured on graded meshes and coasts.
#[derive(Clone, Copy, Debug)]
pub struct TypicalSize {
    /// Bytes for each triangle of a mesh of 10,000 triangles.
    pub bytes: f64,
    /// Further bytes for each triangle of a mesh ten times as large: its numbers have one more digit.
    pub bytes_per_digit: f64,
}

/// Writes a mesh and its data, and updates the meter.
pub type WriteMesh = fn(&mut dyn Write, &Extract, &MeshData, &Meter) -> io::Result<()>;

/// A file format of rasters, as its module describes it.
pub struct RasterFormatSpec {
    /// The file name extensions, in lower case and without the dot; the usual one first.
    pub endings: &'static [&'static str],
    /// Whether a file has several variables or bands, of which one is named as in `FILE.nc#VARIABLE`.
    pub has_parts: bool,
    /// Reads a file, and counts its bytes.
    pub read: ReadRaster,
}

/// Reads a raster, and counts the bytes of its file. Pixels without a value are NaN.
#[derive(Clone, Copy)]
pub enum ReadRaster {
    /// Reads a grid that says which rectangle it covers.
    Grid(fn(&Path, &GridPlace, &Meter) -> Result<FileGrid, ReadError>),
    /// Reads a grid that does not say which rectangle it covers, over the given one, in world units.
    Array(fn(&Path, Rect, &Meter) -> Result<FileGrid, ReadError>),
    /// Reads an image over the given rectangle, in world units, as values from 0 (black) to 1 (white).
    Image(fn(&Path, Rect, Behind, &Meter) -> Result<Raster, ReadError>),
}

/// Where a grid lies, and which part of it is wanted.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridPlace {
    /// The rectangle that it covers, in world units, in place of the one that its file says.
    pub over: Option<Rect>,
    /// The part that is wanted. A reader may return more.
    pub window: Option<GridWindow>,
}

/// A part of a grid.
#[derive(Clone, Copy, Debug)]
pub struct GridWindow {
    /// The part, in world units.
    pub area: Rect,
    /// The plane of the document, if it has one.
    pub plane: Option<DocumentPlane>,
}

/// A grid as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct FileGrid {
    /// The values, where the file or [`GridPlace::over`] says.
    pub raster: Raster,
    /// What the file says about its coordinates.
    pub system: Option<CoordinateSystem>,
    /// What it says about its values.
    pub facts: ValueFacts,
}

impl FileGrid {
    /// Returns a grid in other longitudes and latitudes in degrees from Greenwich, and another one as it is.
    pub(super) fn in_degrees(mut self) -> Self {
        let stated = self.system.as_ref().map(CoordinateSystem::stated);
        self.facts.notes.extend(stated.and_then(|stated| stated.note()));
        let Some((FileCoordinates::Known(known), factor, summand)) =
            stated.and_then(FileCoordinates::in_degrees)
        else {
            return self;
        };
        let Rect { min, max } = self.raster.bounds();
        let bounds = Rect::new(factor * min + summand, factor * max + summand);
        let raster = Raster::from_values(bounds, self.raster.size(), self.raster.values().to_vec());
        let system = self.system.map(|system| CoordinateSystem {
            on_earth: Some(known),
            unit: LengthUnit::Degree,
            ..system
        });
        Self { raster, system, ..self }
    }

    /// Returns what the coordinates are. Longitudes may be from 0 to 360.
    pub fn coordinates(&self) -> FileCoordinates {
        let Rect { min, max } = self.raster.bounds();
        let pixel = self.raster.pixel_size();
        let can_be_degrees = min.y >= -90.0 - pixel.y
            && max.y <= 90.0 + pixel.y
            && min.x >= -180.0 - pixel.x
            && max.x <= 360.0 + pixel.x;
        match &self.system {
            Some(system) if system.kind != CoordinateKind::Other => system.stated(),
            _ => FileCoordinates::Unstated { can_be_degrees },
        }
    }
}

/// Reads the shapes of a file that can meet a rectangle, and counts its bytes.
pub type ReadShapesNear = fn(&Path, Rect, &Meter) -> Result<ShapeFile, ReadError>;

/// A file format of shapes, as its module describes it.
pub struct ShapeFormatSpec {
    /// The file name extensions, in lower case and without the dot; the usual one first.
    pub endings: &'static [&'static str],
    /// Reads the polygons of a file, and counts its bytes.
    pub read_outline: fn(&Path, &Meter) -> Result<Outline, ReadError>,
    /// Reads the points, lines and polygons of a file, and counts its bytes.
    pub read_shapes: fn(&Path, &Meter) -> Result<ShapeFile, ReadError>,
    /// Reads the shapes that can meet a rectangle in the coordinates of the file, after whole turns of
    /// longitudes; `None` where the format does not tell the extent of a shape before its points.
    pub read_shapes_near: Option<ReadShapesNear>,
}
