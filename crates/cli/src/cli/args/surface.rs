//! The options on a surface that the mesh is to be close to.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use meshbrush_io::io::RasterFormat;
use meshbrush_io::io::layers::{GoalKeys, GridKeys, SavedLayer, SavedNorm, SurfaceKeys};

/// A surface, and how close the mesh is to be to it.
#[derive(Debug, Args)]
pub struct SurfaceArguments {
    /// A surface: a grid or a formula in x and y; with it the mesh is the smallest within --max-error, or the
    /// closest with --at-most triangles; may be repeated, the first that has a value at a place counts
    ///
    /// The error of a triangle is the largest difference between a sample in it, such as the centre of a
    /// pixel, and the plane through the surface at its corners. Where no file has a value, the mesh is not
    /// refined. What other options ask for counts as well. A formula has 1024 samples or more along the
    /// longer side of the domain.
    #[arg(long, value_name = "FILE|EXPR", allow_hyphen_values = true, requires = "goal")]
    pub surface: Vec<String>,

    /// Error that is meant: the largest difference, the root mean square of the differences (l2), or of the
    /// differences of the gradient (h1)
    ///
    /// For max the mesh is the smallest one, or the closest, exactly. For l2 and h1, which are sums over the
    /// whole mesh, it is near the smallest one. l2 is the norm of L² over the root of the area, in the unit
    /// of the surface; h1 is the seminorm of H¹ over the root of the area, in the unit of the surface by unit
    /// of length of the plane.
    #[arg(long, value_name = "NORM", requires = "surface", default_value = "max")]
    pub norm: NormArgument,

    /// Largest error, in the unit of the surface
    #[arg(
        long,
        value_name = "E",
        requires = "surface",
        conflicts_with = "at_most",
        group = "goal",
        allow_hyphen_values = true
    )]
    pub max_error: Option<f64>,

    /// Largest errors by place, in the unit of the surface: a grid, which counts in place of --max-error
    /// where it has a value; may be repeated, the last that has a value at a place counts
    ///
    /// Samples with such an error meet it with --at-most, too.
    #[arg(long, value_name = "FILE", requires = "surface")]
    pub error_raster: Vec<PathBuf>,

    /// Largest number of triangles: the mesh has the least error that is possible with them
    #[arg(long, value_name = "N", requires = "surface", group = "goal")]
    pub at_most: Option<usize>,
}

/// See [`SavedNorm`].
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum NormArgument {
    /// The largest difference of a sample
    Max,
    /// The root mean square of the differences
    L2,
    /// The root mean square of the differences of the gradient
    H1,
}

impl NormArgument {
    /// Returns the key of a layer; none for the one that counts without it.
    fn saved(self) -> Option<SavedNorm> {
        match self {
            Self::Max => None,
            Self::L2 => Some(SavedNorm::L2),
            Self::H1 => Some(SavedNorm::H1),
        }
    }
}

impl SurfaceArguments {
    /// Returns the layers of the surfaces, from the bottom of the stack to its top, each with its option as
    /// typed. The last surface is the lowest.
    pub fn layers(&self) -> impl Iterator<Item = (String, SavedLayer)> {
        self.surface.iter().rev().map(|text| {
            let is_raster = RasterFormat::from_path(Path::new(text)).is_ok();
            let file = is_raster.then(|| PathBuf::from(text));
            let goal = GoalKeys {
                formula: (!is_raster).then(|| text.clone()),
                within: self.max_error,
                at_most: self.at_most,
                norm: self.norm.saved(),
            };
            let layer = SurfaceKeys { grid: GridKeys { file, bounds: None }, goal }.into();
            (format!("--surface {text}"), layer)
        })
    }
}
