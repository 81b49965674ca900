//! The contents of a file of data, as far as they are needed to ask what the file is to be.

mod preview;
mod read;

use std::path::PathBuf;

pub use preview::Preview;
pub use read::{look_at, seen_shapes};

use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// A file of data that was read, to ask what it is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct DataFile {
    /// The path of the file.
    pub path: PathBuf,
    /// The size of the file, in bytes.
    pub bytes: u64,
    /// The kind of the contents.
    pub contents: DataContents,
    /// The rectangle that the file covers, in world units; `None` if it says no place.
    pub extent: Option<Rect>,
    /// Whether it is known where on the Earth the coordinates are.
    pub is_on_earth: bool,
    /// The unit of the coordinates.
    pub unit: LengthUnit,
    /// A small picture of the contents.
    pub preview: Preview,
    /// A small picture of the water beside the shapes, if they are land or coasts; or why they cannot be.
    pub sea: Result<Preview, String>,
    /// Whether it is opened: only what becomes a document of its own is asked about.
    pub is_opened: bool,
}

/// The kind of the contents of a file of data, with what is known of them.
#[derive(Clone, Debug, PartialEq)]
pub enum DataContents {
    /// A grid of values that says which rectangle it covers.
    Grid(RasterFacts),
    /// A picture, whose grey values are from 0 (black) to 1 (white).
    Picture(RasterFacts),
    /// Points, lines and polygons.
    Shapes {
        /// The number of single points.
        points: usize,
        /// The number of lines.
        lines: usize,
        /// The number of polygons.
        polygons: usize,
    },
    /// A table of threats, with their number.
    Threats(usize),
    /// A table of points, with their number.
    Points(usize),
}

/// The facts about the pixels of a raster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterFacts {
    /// [columns, rows].
    pub size: [u32; 2],
    /// The least and the greatest finite value; `None` if no pixel has a value.
    pub values: Option<[f64; 2]>,
    /// The number of pixels without a value.
    pub missing: usize,
}

impl DataFile {
    /// Returns the facts about the pixels, if the file is a raster.
    pub fn raster(&self) -> Option<RasterFacts> {
        match self.contents {
            DataContents::Grid(facts) | DataContents::Picture(facts) => Some(facts),
            _ => None,
        }
    }

    /// Returns how many polygons the file has.
    pub fn polygons(&self) -> usize {
        if let DataContents::Shapes { polygons, .. } = self.contents { polygons } else { 0 }
    }

    /// Returns why the file cannot be used where polygons are needed.
    pub fn lacks_polygons(&self) -> Option<String> {
        (self.polygons() == 0).then(|| "The file has no polygons.".into())
    }
}
