//! Arguments of `meshbrush solve`.

use std::path::PathBuf;

use clap::{Arg, Args, value_parser};

use super::input::InputArguments;
use super::numbers::positive;
use crate::cli::output_coordinates::OutputCoordinates;

/// `meshbrush solve`. Its --at-most is for the bound of the error; other commands have it for surfaces.
#[derive(Debug, Args)]
#[command(mut_arg("at_most", |_| at_most()))]
pub struct SolveArguments {
    #[command(flatten)]
    pub input: InputArguments,

    #[command(flatten, next_help_heading = "Problem")]
    pub problem: ProblemArguments,

    /// Bisect triangles until the bound of the energy error is at most this
    ///
    /// From the mesh of the document on, those with half of the square of the bound are bisected, again and
    /// again. The meshes follow from the document and the problem alone.
    #[arg(long, value_name = "ERROR", value_parser = positive, allow_hyphen_values = true, help_heading = "Mesh by the error")]
    pub within: Option<f64>,

    /// File to write with u at the nodes, may be repeated: .vtu, and the other formats of `meshbrush mesh`
    #[arg(short, long = "output", value_name = "FILE", help_heading = "Output")]
    pub output: Vec<PathBuf>,

    /// File to write with what proves the bound, as numbers that other programs can check (.json)
    ///
    /// For diffusion and source that are numbers, u given on the whole boundary, and neither convection nor
    /// reaction. tests/check_solution.py of the source code is such a program.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub certificate: Option<PathBuf>,

    /// Coordinates in files, as for `meshbrush mesh`
    #[arg(long, value_name = "lonlat|plane|EPSG:N|PROJ", help_heading = "Output")]
    pub out_crs: Option<OutputCoordinates>,

    /// Print the result as one JSON object on standard output
    #[arg(long, help_heading = "Output")]
    pub json: bool,
}

impl SolveArguments {
    /// Returns how many triangles there may be by the bound of the error.
    pub fn at_most(&self) -> Option<usize> {
        self.input.surfaces.at_most
    }
}

fn at_most() -> Arg {
    Arg::new("at_most")
        .long("at-most")
        .value_name("N")
        .value_parser(value_parser!(usize))
        .conflicts_with("within")
        .conflicts_with("surface")
        .help_heading("Mesh by the error")
        .help("Bisect triangles in the same way as with --within, as long as there are no more than this")
}

/// What is solved.
#[derive(Debug, Args)]
pub struct ProblemArguments {
    /// a, a formula in x and y that is positive everywhere [default: that of the recipe, or 1]
    ///
    /// Where it jumps inside triangles, that in their middles counts.
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub diffusion: Option<String>,

    /// b along x and along y, two formulas [default: that of the recipe, or none]
    #[arg(long, value_names = ["EXPR", "EXPR"], num_args = 2, allow_hyphen_values = true)]
    pub convection: Option<Vec<String>>,

    /// c, a formula that is nowhere negative [default: that of the recipe, or 0]
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub reaction: Option<String>,

    /// f [default: that of the recipe, or 0]
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub source: Option<String>,

    /// u on a piece of the boundary, as in 'open west=1 + y'; may be repeated
    ///
    /// The name “all” stands for every piece without a condition of its own. Names are those of
    /// `meshbrush mesh --json`; the sides of a rectangle are “open south”, “open east”, “open north” and
    /// “open west”, unless the recipe or project gives them others. Where pieces meet, the value of the first
    /// one by name counts.
    #[arg(long, value_name = "NAME=EXPR", allow_hyphen_values = true)]
    pub dirichlet: Vec<String>,

    /// What flows into the domain through a piece of the boundary, a ∂u/∂n; may be repeated
    ///
    /// Nothing flows through pieces without a condition.
    #[arg(long, value_name = "NAME=EXPR", allow_hyphen_values = true)]
    pub neumann: Vec<String>,

    /// α and g of a ∂u/∂n + α u = g on a piece of the boundary, with a semicolon between; may be repeated
    #[arg(long, value_name = "NAME=EXPR;EXPR", allow_hyphen_values = true)]
    pub robin: Vec<String>,

    /// A formula of the solution, where it is known: its energy error is printed beside the bound
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub exact: Option<String>,
}
