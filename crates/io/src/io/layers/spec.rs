use std::path::{Path, PathBuf};

use glam::DVec2;

use super::saved::SavedKind;
use meshbrush_core::domain::Polygon;
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{Combine, Quantity, Threat};
use meshbrush_mesh::geometry::Rect;

/// Finds a file by the name that a text gives it. Errors are sentences.
pub type FindFile<'a> = dyn Fn(&str) -> Result<PathBuf, String> + 'a;

/// A layer whose values are checked, before its files are read.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerSpec {
    /// What a person calls it.
    pub name: String,
    /// A hidden layer asks for nothing.
    pub visible: bool,
    /// A locked layer cannot be edited.
    pub locked: bool,
    /// How it is combined with the layers below.
    pub combine: Combine,
    /// Where it counts; everywhere without one.
    pub mask: Option<MaskSpec>,
    /// What it asks for.
    pub kind: KindSpec,
}

/// Where a layer counts.
#[derive(Clone, Debug, PartialEq)]
pub enum MaskSpec {
    /// Inside the polygons of a file.
    File(PathBuf),
    /// Inside these polygons.
    Polygons(Vec<Polygon>),
}

/// What a layer asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum KindSpec {
    /// What is painted.
    Paint {
        /// What its values mean.
        quantity: Quantity,
        /// The project that holds the paint, and the name of the layer there; `None` where the text is part
        /// of a project.
        from: Option<(PathBuf, String)>,
    },
    /// A formula in x and y.
    Formula {
        /// What its value means.
        quantity: Quantity,
        /// The formula.
        formula: Formula,
    },
    /// Values by pixel.
    Raster {
        /// The pixels.
        raster: RasterFile,
        /// What the values mean.
        reading: RasterReading,
    },
    /// Points with a range, combined as independent probabilities.
    Threats(ThreatsSpec),
    /// A diameter that grows with the distance to shapes.
    Distance {
        /// The shapes.
        to: DistanceTo,
        /// Target diameter at distance 0, in world units.
        at_zero: f64,
        /// Growth of the target diameter by unit of distance, dimensionless.
        slope: f64,
        /// The distance beyond which nothing is asked for, in world units.
        range: Option<f64>,
    },
    /// One diameter where a raster's value lies between two numbers.
    Band {
        /// The pixels.
        raster: RasterFile,
        /// The least and the greatest value.
        between: [f64; 2],
        /// Target diameter there, in world units.
        diameter: f64,
    },
}

/// The pixels of a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterFile {
    /// The file.
    pub path: PathBuf,
    /// Its format.
    pub format: RasterFormat,
    /// Where it lies; without one an image covers the bounds of the domain, and a grid lies where its header
    /// says.
    pub bounds: Option<Rect>,
}

/// The kinds of raster files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RasterFormat {
    /// A greyscale image, whose values are from 0 (black) to 1 (white).
    Png,
    /// A grid that says which rectangle it covers.
    Asc,
    /// A part of the project that the layer belongs to; the path is only a name for a person.
    Part,
}

impl RasterFormat {
    /// The format that the ending of a file name says.
    ///
    /// # Errors
    /// A sentence, when it is the ending of no raster.
    pub fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default();
        match ending {
            _ if ending.eq_ignore_ascii_case("png") => Ok(Self::Png),
            _ if ending.eq_ignore_ascii_case("asc") => Ok(Self::Asc),
            _ => Err("a raster is a .png or an .asc file.".into()),
        }
    }
}

/// What the values of a raster mean.
#[derive(Clone, Debug, PartialEq)]
pub enum RasterReading {
    /// Risk, 0 to 1.
    Risk,
    /// Target diameter in world units.
    Diameter,
    /// Values of the raster, ascending, and the target diameter at each, in world units; linear between
    /// them, constant beyond.
    Curve(Vec<[f64; 2]>),
}

/// Threats, or where they are.
#[derive(Clone, Debug, PartialEq)]
pub enum ThreatsSpec {
    /// A table.
    File(PathBuf),
    /// These.
    List(Vec<Threat>),
}

/// What a distance is to.
#[derive(Clone, Debug, PartialEq)]
pub enum DistanceTo {
    /// The boundary of the domain.
    Outline,
    /// The shapes of a file.
    File(PathBuf),
    /// Shapes in place.
    Shapes {
        /// The name of the file that they come from, for a person; empty where there is none.
        name: String,
        /// The shapes.
        shapes: Vec<ShapeSpec>,
    },
    /// A strip of a width around shapes.
    Corridor {
        /// The shapes.
        along: Box<DistanceTo>,
        /// Its width in world units.
        width: f64,
    },
}

impl DistanceTo {
    /// The file that it names.
    fn file(&self) -> Option<&PathBuf> {
        match self {
            Self::File(file) => Some(file),
            Self::Corridor { along, .. } => along.file(),
            Self::Outline | Self::Shapes { .. } => None,
        }
    }
}

/// A point, line or polygon in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeSpec {
    /// A point.
    Point(DVec2),
    /// Points joined by segments.
    Line(Vec<DVec2>),
    /// Rings, the outer one first, without the repeated last point.
    Polygon(Polygon),
}

impl LayerSpec {
    /// A visible layer over everything, named after its kind.
    pub fn of_kind(kind: KindSpec) -> Self {
        let name = usual_name(kind.saved_kind()).to_owned();
        Self { name, visible: true, locked: false, combine: Combine::Finest, mask: None, kind }
    }

    /// Whether it needs both ends of the scale from the smallest to the largest target diameter.
    pub fn uses_scale(&self) -> bool {
        match &self.kind {
            KindSpec::Paint { quantity, .. } | KindSpec::Formula { quantity, .. } => {
                *quantity == Quantity::Risk
            }
            KindSpec::Raster { raster, reading: RasterReading::Diameter } => {
                raster.format == RasterFormat::Png
            }
            KindSpec::Raster { reading, .. } => *reading == RasterReading::Risk,
            KindSpec::Threats(_) => true,
            KindSpec::Distance { .. } | KindSpec::Band { .. } => false,
        }
    }

    /// Whether it asks for risk.
    pub fn is_risk(&self) -> bool {
        let is_image = matches!(self.kind, KindSpec::Raster { reading: RasterReading::Diameter, .. });
        self.uses_scale() && !is_image
    }

    /// The pixels, if it has some.
    pub fn raster_file(&self) -> Option<&RasterFile> {
        match &self.kind {
            KindSpec::Raster { raster, .. } | KindSpec::Band { raster, .. } => Some(raster),
            _ => None,
        }
    }

    /// The files that it names.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let data = match &self.kind {
            KindSpec::Paint { from, .. } => from.as_ref().map(|(project, _)| project),
            KindSpec::Raster { raster, .. } | KindSpec::Band { raster, .. } => Some(&raster.path),
            KindSpec::Threats(ThreatsSpec::File(file)) => Some(file),
            KindSpec::Distance { to, .. } => to.file(),
            KindSpec::Formula { .. } | KindSpec::Threats(_) => None,
        };
        let mask = match &self.mask {
            Some(MaskSpec::File(file)) => Some(file),
            Some(MaskSpec::Polygons(_)) | None => None,
        };
        data.into_iter().chain(mask).map(PathBuf::as_path)
    }
}

impl KindSpec {
    /// Which kind it is.
    pub fn saved_kind(&self) -> SavedKind {
        match self {
            Self::Paint { .. } => SavedKind::Paint,
            Self::Formula { .. } => SavedKind::Formula,
            Self::Raster { .. } => SavedKind::Raster,
            Self::Threats(_) => SavedKind::Threats,
            Self::Distance { to: DistanceTo::Corridor { .. }, .. } => SavedKind::Corridor,
            Self::Distance { .. } => SavedKind::Distance,
            Self::Band { .. } => SavedKind::Band,
        }
    }
}

/// The name of a layer that is given none.
pub(super) fn usual_name(kind: SavedKind) -> &'static str {
    match kind {
        SavedKind::Paint => "Paint",
        SavedKind::Formula => "Formula",
        SavedKind::Raster => "Raster",
        SavedKind::Threats => "Threats",
        SavedKind::Distance => "Distance",
        SavedKind::Corridor => "Corridor",
        SavedKind::Band => "Band",
    }
}
