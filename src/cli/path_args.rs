//! Arguments of `meshbrush path`.

use std::path::PathBuf;

use clap::Args;

use super::args::{InputArguments, PictureArguments};

/// `meshbrush path`.
#[derive(Debug, Args)]
pub struct PathArguments {
    #[command(flatten)]
    pub input: InputArguments,

    /// Where the path begins
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, help_heading = "Path")]
    pub from: String,

    /// Where the path ends
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, help_heading = "Path")]
    pub to: String,

    /// A place that the path visits on the way; may be repeated, in order
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, help_heading = "Path")]
    pub via: Vec<String>,

    /// Polygons that the path stays out of; may be repeated
    #[arg(long, value_name = "FILE.geojson", help_heading = "Path")]
    pub keep_out: Vec<PathBuf>,

    /// Cost per unit of length as a formula of x, y and risk, in place of the weights
    #[arg(
        long,
        value_name = "EXPR",
        allow_hyphen_values = true,
        conflicts_with_all = ["length_weight", "risk_weight"],
        help_heading = "Path"
    )]
    pub cost: Option<String>,

    /// What a unit of length costs where there is no risk [default: 1]
    #[arg(long, value_name = "L", allow_hyphen_values = true, help_heading = "Path")]
    pub length_weight: Option<f64>,

    /// What a unit of length costs at risk 1, beside that [default: 10]
    #[arg(long, value_name = "K", allow_hyphen_values = true, help_heading = "Path")]
    pub risk_weight: Option<f64>,

    /// Prove that the path costs at most this much more than the best, as in 1% or 0.01
    ///
    /// Raises the lower bound until the interval is that narrow, which can take seconds, or until the work
    /// gains nothing more.
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, help_heading = "Path")]
    pub within: Option<String>,

    /// Leave out points that are no farther than this from the path
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, help_heading = "Output")]
    pub simplify: Option<f64>,

    /// File to write, may be repeated: .geojson .csv .svg .png
    ///
    /// A .csv has the cost up to each point. A picture has the mesh, with the path over it.
    #[arg(short, long = "output", value_name = "FILE", help_heading = "Output")]
    pub output: Vec<PathBuf>,

    /// Print the result as one JSON object on standard output
    #[arg(long, help_heading = "Output")]
    pub json: bool,

    #[command(flatten)]
    pub picture: PictureArguments,
}
