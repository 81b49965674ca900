//! Arguments of the commands that ask about a mesh: `meshbrush check`, `meshbrush locate` and `meshbrush
//! why`.

use std::path::PathBuf;

use clap::Args;

use super::depths::DepthArguments;
use super::input::InputArguments;
use super::numbers::positive;
use super::quantities::QuantityArguments;
use crate::cli::output_coordinates::OutputCoordinates;
use meshbrush_io::io::CellShape;
use meshbrush_io::io::solver_rules::Solver;

/// `meshbrush check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub input: InputArguments,

    /// The solver whose rules count: adcirc, schism, swan, telemac, fvcom, ww3, delft3dfm, mike or modflow
    #[arg(long = "for", value_name = "NAME", help_heading = "Rules")]
    pub solver: Solver,

    /// Coordinates in the file, as for `meshbrush mesh`
    #[arg(long, value_name = "lonlat|plane|EPSG:N|PROJ", help_heading = "Rules")]
    pub out_crs: Option<OutputCoordinates>,

    /// Cells in the file, as for `meshbrush mesh`
    #[arg(long, value_name = "triangles|squares", help_heading = "Rules")]
    pub cells: Option<CellShape>,

    #[command(flatten, next_help_heading = "Rules")]
    pub quantities: QuantityArguments,

    /// Multiply all sizes by this number, as for `meshbrush mesh`
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = positive, help_heading = "Rules")]
    pub scale: Option<f64>,

    #[command(flatten, next_help_heading = "Rules")]
    pub depths: DepthArguments,

    /// Bisect triangles that break a rule once more, where that helps, before the rules are checked, and
    /// print the layers that ask for it, to be added to the recipe
    #[arg(long, help_heading = "Rules")]
    pub repair: bool,

    /// Cut strips off the domain in which its frame runs along a coast, before the rules are checked, and
    /// print the rings around them, to be added to the recipe
    #[arg(long, help_heading = "Rules")]
    pub cut_strips: bool,

    /// Print the answer as one JSON object on standard output
    #[arg(long, help_heading = "Output")]
    pub json: bool,
}

/// `meshbrush locate`.
#[derive(Debug, Args)]
pub struct LocateArguments {
    #[command(flatten)]
    pub input: InputArguments,

    /// Table of points with the columns x and y, or lon and lat in degrees; - is standard input
    #[arg(long, value_name = "FILE.csv", help_heading = "Points")]
    pub points: PathBuf,

    /// Table to write, instead of standard output
    #[arg(short, long = "output", value_name = "OUT.csv", help_heading = "Points")]
    pub output: Option<PathBuf>,

    /// Interpolate this formula in x and y from the vertices, instead of the target diameter
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true, help_heading = "Points")]
    pub quantity: Option<String>,
}

/// `meshbrush why`.
#[derive(Debug, Args)]
pub struct WhyArguments {
    /// A point of the domain, in its coordinates, or as longitude and latitude, as in 24.5°,37.9°
    #[arg(value_name = "X,Y", allow_hyphen_values = true)]
    pub point: String,

    #[command(flatten)]
    pub input: InputArguments,

    /// Print the answer as one JSON object on standard output
    #[arg(long, help_heading = "Output")]
    pub json: bool,
}
