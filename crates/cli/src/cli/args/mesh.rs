//! Arguments of `meshbrush mesh`.

use std::path::PathBuf;

use clap::Args;

use super::depths::DepthArguments;
use super::error_curve::ErrorCurveArguments;
use super::help::{format_help, format_long_help, output_help, output_long_help};
use super::input::InputArguments;
use super::numbers::positive;
use super::picture::PictureArguments;
use super::quantities::QuantityArguments;
use super::space::SpaceArguments;
use crate::cli::output_coordinates::OutputCoordinates;
use meshbrush_io::io::CellShape;
use meshbrush_io::io::solver_rules::Solver;

/// `meshbrush mesh`.
#[derive(Debug, Args)]
pub struct MeshArguments {
    #[command(flatten)]
    pub input: InputArguments,

    #[arg(short, long = "output", value_name = "FILE", help_heading = "Output")]
    #[arg(help = output_help(), long_help = output_long_help())]
    pub output: Vec<PathBuf>,

    #[arg(long, value_name = "FORMAT", help_heading = "Output")]
    #[arg(help = format_help(), long_help = format_long_help())]
    pub format: Option<String>,

    /// Write .msh in its binary form, which is quicker to write and to read
    ///
    /// .vtu and .stl are always binary, and other formats are always text.
    #[arg(long, help_heading = "Output")]
    pub binary: bool,

    /// Cells in .nc, .disv, .gr3, .ll, .2dm, .mesh, .vtu and .msh: the triangles, or pairs of them joined to
    /// quadrilaterals where a solver could have no link between them [default: squares in .nc, for
    /// Delft3D-FM, and .disv, for MODFLOW, and triangles elsewhere]
    #[arg(long, value_name = "triangles|squares", help_heading = "Output")]
    pub cells: Option<CellShape>,

    /// Write z = 0 in place of the height of a surface, in .vtu, .msh, .obj, .stl, .ply, .glb and .2dm,
    /// and for the top in .disv
    ///
    /// The heights stay as values at the nodes where the format has any.
    #[arg(long, help_heading = "Output")]
    pub flat: bool,

    /// Coordinates in files of a region on the Earth: longitude and latitude (lonlat), those of the plane of
    /// --projection (plane), or those of a code or of a projection as PROJ writes it [default: those of the
    /// region's file]
    #[arg(long, value_name = "lonlat|plane|EPSG:N|PROJ", help_heading = "Output")]
    pub out_crs: Option<OutputCoordinates>,

    #[command(flatten, next_help_heading = "Output")]
    pub quantities: QuantityArguments,

    /// Multiply all sizes by this number: target diameters with their limits and gradation, and the largest
    /// diameter at the outline
    ///
    /// As in 0.5, for a study of convergence: the coarse grid stays, and off the outline the nodes of a mesh
    /// are nodes of the mesh of half its sizes. --sequence keeps those of the outline, too.
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = positive, help_heading = "Output")]
    pub scale: Option<f64>,

    /// Bisect triangles that break a rule of this solver once more, where that helps: adcirc, fvcom, telemac,
    /// delft3dfm …
    ///
    /// As a triangle at a corner, all nodes of which are on the boundary. The mesh itself is another one
    /// then, in all files and with its own fingerprint. The report says how many triangles were bisected.
    /// meshbrush check --repair prints the layers that ask for it.
    #[arg(long, value_name = "NAME", help_heading = "Output")]
    pub repair_for: Option<Solver>,

    /// Cut strips off the domain in which its frame runs along a coast, with one or two triangles between
    /// them: adcirc, schism, fvcom, telemac, delft3dfm or mike
    ///
    /// There some solvers become unstable. The mesh is made again without them, and its new edges are land; a
    /// strip that joins two parts of the sea stays, and is named. meshbrush check --cut-strips prints the
    /// rings, as a recipe has them.
    #[arg(long, value_name = "NAME", help_heading = "Output")]
    pub cut_strips_for: Option<Solver>,

    /// Write so many meshes, each with every node of the one before and four triangles for each of its: to
    /// sea_1.14, sea_2.14 … for -o sea.14
    ///
    /// The first is the mesh of the document. Nodes keep their coordinates and numbers, and the domain is
    /// that of the first mesh.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16), help_heading = "Output")]
    pub sequence: Option<u32>,

    /// Divide the mesh into so many parts for a solver on several processors, beside each file: to
    /// partition.prop for .gr3 and .ll, and sea.14.part.64 for -o sea.14
    ///
    /// Parts are halved again and again across their longer side, with few edges between two parts, and have
    /// the same number of cells, or one more. .nc has them as `idomain`, too.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Output")]
    pub parts_for: Option<u32>,

    #[command(flatten, next_help_heading = "Output")]
    pub depths: DepthArguments,

    #[command(flatten)]
    pub curve: ErrorCurveArguments,

    /// Print the summary as one JSON object on standard output
    #[arg(long, help_heading = "Output")]
    pub json: bool,

    /// Check every invariant of the finished mesh, and print what is broken
    #[arg(long, help_heading = "Output")]
    pub checks: bool,

    #[command(flatten)]
    pub picture: PictureArguments,

    #[command(flatten)]
    pub space: SpaceArguments,
}
