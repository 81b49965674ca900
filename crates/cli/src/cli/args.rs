//! Arguments as typed. [`Input`](super::input::Input) interprets and checks those on what to mesh.

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory as _, Parser, Subcommand, ValueEnum};

use super::distance_args::DistanceArguments;
use super::earth_args::{EarthArguments, OutputCoordinates};
use super::error_curve::ErrorCurveArguments;
use super::help::{
    file_help, format_help, format_long_help, output_help, output_long_help, risk_raster_help,
    target_raster_help, target_raster_long_help,
};
#[cfg(feature = "man")]
use super::more_args::ManArguments;
use super::more_args::{
    CompletionsArguments, RecipeArguments, ReplayArguments, ReportArguments, ScreenshotsArguments,
    ThumbnailArguments,
};
use super::path_args::PathArguments;
use super::picture_args::PictureArguments;
use super::space_look::SpaceArguments;
use super::surface_args::SurfaceArguments;
use super::water::WaterArguments;
use meshbrush_core::field::RefinementRule;
use meshbrush_mesh::text::Length;

/// Paint where detail matters; the mesh follows the brush.
///
/// Without a command the window opens.
#[derive(Debug, Parser)]
#[command(name = "meshbrush", version, max_term_width = 100)]
pub struct Arguments {
    #[arg(help = file_help())]
    pub file: Option<PathBuf>,

    /// Most threads that refine a mesh [default: one for each core]; the mesh is the same with any number
    #[arg(long, value_name = "N", global = true)]
    pub threads: Option<NonZeroUsize>,

    #[command(subcommand)]
    pub command: Option<Command>,
}

impl Arguments {
    /// Returns the arguments as typed, the name of the program first. (clap can forbid a file before a
    /// command only together with all options, and `--threads` may stand on either side.)
    ///
    /// # Errors
    /// Fails on wrong usage, and also for help and version, which clap returns as errors.
    pub fn read(typed: &[OsString]) -> Result<Self, clap::Error> {
        let arguments = Self::try_parse_from(typed)?;
        if let (Some(file), Some(_)) = (&arguments.file, &arguments.command) {
            let sentence = format!(
                "'{}' stands before the command; write files and options of a command after its name",
                file.display()
            );
            return Err(Self::command().error(clap::error::ErrorKind::ArgumentConflict, sentence));
        }
        Ok(arguments)
    }
}

/// What to do without a window.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Build a mesh, write it to files, print a summary
    #[command(after_help = MESH_EXAMPLES)]
    Mesh(MeshArguments),
    /// Build a mesh and find the triangle that contains each of a list of points
    ///
    /// Numbers of triangles and vertices start at 0, and the order of the vertices is anticlockwise, first
    /// the ends of the bisection edge: as in the .csv file that `mesh` writes from the same options. In .node
    /// and .ele files numbers are one higher.
    #[command(after_help = LOCATE_EXAMPLES)]
    Locate(LocateArguments),
    /// Build a mesh and say why the triangle at a point is there
    ///
    /// Either its parent exceeds its target, and then the layer and the place that decide are named; or it
    /// was bisected to keep the mesh compatible, and then the triangle that required it is, with the chain of
    /// triangles between them.
    #[command(after_help = WHY_EXAMPLES)]
    Why(WhyArguments),
    /// Build a mesh, find the path of least cost through it, and say how far from the best it can be
    ///
    /// The cost per unit of length is --length-weight plus --risk-weight times the risk of the layers, or a
    /// formula. No path costs less than the lower bound that is printed.
    #[command(after_help = PATH_EXAMPLES)]
    Path(PathArguments),
    /// Write a project as a recipe, with the files that it names beside it
    ///
    /// The recipe gives the mesh of the project. Existing files are replaced.
    Recipe(RecipeArguments),
    /// Draw a small picture of a project, in at most 2 s and 256 MB
    ///
    /// File managers run this on every project that they show. Where it would take longer or more, or the
    /// mesh has more than a million triangles, there is no picture, and the exit status is 1.
    Thumbnail(ThumbnailArguments),
    /// Do the edits of a recorded session again, and compare the mesh after each
    ///
    /// *Export as test…* in the window writes the file. The exit status is 1 if a mesh is not the recorded
    /// one.
    Replay(ReplayArguments),
    /// Repeat the experiment of Section 5.4 of the report, and print its numbers beside those of this machine
    ///
    /// Thirteen meshes of the report's diamond, with 1,088 to 2,113,944 triangles, each made on one thread as
    /// in the report, whatever --threads says. Needs 250 MB of memory.
    Report(ReportArguments),
    /// Print a script that lets a shell complete the program's options
    ///
    /// For bash: meshbrush completions bash > ~/.local/share/bash-completion/completions/meshbrush
    Completions(CompletionsArguments),
    /// Write the man pages of the program and of its commands
    #[cfg(feature = "man")]
    #[command(hide = true)]
    Man(ManArguments),
    /// Write the pictures of the window that the documentation shows
    ///
    /// They are painted without a display, by the program's own commands.
    Screenshots(ScreenshotsArguments),
}

const MESH_EXAMPLES: &str = "\
Examples:
  meshbrush mesh --domain -10,-10,10,10 --spacing 1 --target 'if(abs(x)+abs(y)<8, 0.25, 20)' -o mesh.vtu
  meshbrush mesh --domain 0,0,4,3 --risk-raster risk.png --h-min 0.01 --h-max 0.5 -o mesh.msh -o mesh.png
  meshbrush mesh --project coast.meshbrush -o mesh.vtu
  meshbrush mesh coast.toml -o mesh.vtu
  meshbrush mesh --inside 'r < 1' --domain -1,-1,1,1 --target '0.02 + 0.1*r' --json";

const LOCATE_EXAMPLES: &str = "\
Example:
  meshbrush locate --spacing 0.1 --target '0.01 + 0.2*hypot(x - 0.5, y - 0.5)' --points points.csv -o found.csv";

const WHY_EXAMPLES: &str = "\
Examples:
  meshbrush why 0.48,0.52 --spacing 0.1 --target '0.01 + 0.2*hypot(x - 0.5, y - 0.5)'
  meshbrush why 2.5,1 --project coast.meshbrush --json";

const PATH_EXAMPLES: &str = "\
Examples:
  meshbrush path --from 0.1,0.1 --to 0.9,0.8 --risk 'exp(-20*hypot(x, y)^2)' --h-min 0.01 -o path.geojson
  meshbrush path --project coast.meshbrush --from 1,2 --via 4,4 --to 8,3 --within 1% -o path.csv -o path.png
  meshbrush path --from 0,0 --to 1,1 --cost '1 + 5*x' --json";

/// What to mesh.
#[derive(Debug, Args)]
#[command(next_help_heading = "Domain and target diameter")]
pub struct InputArguments {
    /// A recipe: a text that says what to mesh; options override its values
    ///
    /// Domain and layers are those of the recipe. docs/recipe.md lists its keys. The files of its outputs are
    /// written beside those of -o.
    #[arg(value_name = "RECIPE.toml")]
    pub recipe: Option<PathBuf>,

    /// A project saved in the window (.meshbrush); options override its settings
    ///
    /// Domain and layers are those of the project. Without options the mesh is the one that the window shows,
    /// with the same fingerprint.
    #[arg(long, value_name = "FILE", conflicts_with = "recipe")]
    pub project: Option<PathBuf>,

    /// Lower left and upper right corner of the domain [default: 0,0,1,1, or where the grids lie]
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true)]
    pub domain: Option<String>,

    /// Keep the part of the domain where this formula in x and y is not 0
    ///
    /// A coarse triangle stays when all its corners lie there: choose --spacing to suit the shape. NaN counts
    /// as outside.
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub inside: Option<String>,

    /// Domain with holes: a GeoJSON file, shapefile (.shp) or GeoPackage (.gpkg) with polygons, in its own
    /// coordinates; - is GeoJSON from standard input. Or a grid of heights or depths: the water below
    /// --contour
    ///
    /// The coarse grid covers their bounding rectangle. The domain is the union of all polygons. In a grid,
    /// the outline runs between the centres of pixels, linear in the depth; pixels without a value are land.
    #[arg(long, value_name = "FILE.geojson", conflicts_with_all = ["domain", "inside"])]
    pub region: Option<PathBuf>,

    #[command(flatten)]
    pub earth: EarthArguments,

    /// How the mesh meets the outline of a region
    ///
    /// [default: outline]
    #[arg(long, value_enum)]
    pub boundary: Option<BoundaryArgument>,

    /// Largest diameter of triangles on the outline, before nodes move onto it [default: an eighth of the
    /// spacing]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub boundary_diameter: Option<Length>,

    /// Parts of the mesh that stay: the largest, all, or those with this share of the area [default: largest
    /// for a region, but all with --boundary report]
    ///
    /// A part is joined by edges. Narrow straits can part a mesh, and solvers need one part.
    #[arg(long, value_name = "largest|all|SHARE", allow_hyphen_values = true)]
    pub parts: Option<String>,

    /// Keep nodes in which triangles of a fitted mesh meet without sharing an edge
    ///
    /// Otherwise the smaller side of such a node is removed.
    #[arg(long)]
    pub keep_pinches: bool,

    /// Longest side of a coarse cell [default: a twentieth of the domain's longer side]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub spacing: Option<Length>,

    /// Target diameter as a formula in x and y, or as a length such as 2 km; may be repeated, the smallest
    /// wins
    ///
    /// Written as in `if(abs(x)+abs(y)<0.4, 0.0125, 1)`; there are comparisons, and, or, not, the usual
    /// functions, and the polar r and theta. With --depth, `depth` is the depth of the water in metres,
    /// positive downwards; where no file has a value, the formula asks for nothing.
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub target: Vec<String>,

    /// Risk from 0 to 1 as a formula in x and y; may be repeated
    ///
    /// Risk becomes a target diameter that falls from --h-max at 0 to --h-risk at 1, by equal factors for
    /// equal steps.
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub risk: Vec<String>,

    #[arg(long, value_name = "FILE")]
    #[arg(help = target_raster_help(), long_help = target_raster_long_help())]
    pub target_raster: Vec<PathBuf>,

    #[arg(long, value_name = "FILE", help = risk_raster_help())]
    pub risk_raster: Vec<PathBuf>,

    /// Threats, whose risks combine as independent probabilities: a table x,y,range,peak,law; may be
    /// repeated
    ///
    /// The peak is the risk at the place of a threat, the range where it ends, and the law radar, gaussian or
    /// disc.
    #[arg(long, value_name = "FILE.csv")]
    pub threats: Vec<PathBuf>,

    #[command(flatten)]
    pub distances: DistanceArguments,

    #[command(flatten)]
    pub water: WaterArguments,

    #[command(flatten)]
    pub surfaces: SurfaceArguments,

    /// Bound on the gradation: over a distance d, the target diameter changes by G times d at most
    ///
    /// It becomes the largest field that keeps the bound and nowhere exceeds what is asked for. Usual are 0.1
    /// to 0.5.
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    pub gradation: Option<f64>,

    /// Smallest target diameter; larger where less is asked for
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub h_min: Option<Length>,

    /// Target diameter where the risk is 1 [default: the smallest, --h-min]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub h_risk: Option<Length>,

    /// Largest target diameter, where the risk is 0 [default with risk: that of a coarse triangle]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub h_max: Option<Length>,

    /// Bend of the curve from risk to diameter: above 1 only high risk refines, below 1 low risk does
    ///
    /// [default: 1]
    #[arg(long, value_name = "EXPONENT", allow_hyphen_values = true)]
    pub transfer_shape: Option<f64>,

    /// Which points of a triangle decide its target diameter [default: area]
    #[arg(long)]
    pub rule: Option<RuleArgument>,

    /// Most triangles allowed [default: those of the project, else 50000000]
    #[arg(long, value_name = "N")]
    pub max_triangles: Option<usize>,

    /// Most memory allowed for the mesh, as in 500MB or 2GB: 96 bytes a triangle [default: that of the
    /// project, else what --max-triangles take]
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true)]
    pub max_memory: Option<String>,

    /// Deepest level allowed; triangles there count as satisfied
    #[arg(long, value_name = "LEVEL")]
    pub max_level: Option<u32>,
}

impl InputArguments {
    /// Returns the file of polygons, lines or a grid that gives the outline of the domain.
    pub fn outline_file(&self) -> Option<&Path> {
        self.region.as_deref().or(self.earth.land.as_deref())
    }
}

/// The boundary treatment, as typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum BoundaryArgument {
    /// A coarse triangle stays when its three nodes are inside (Appendix A of the report)
    Report,
    /// The mesh is refined along the outline; then a triangle stays when its centroid is inside
    Fitted,
    /// As fitted; then nodes along the outline move onto it
    #[default]
    Outline,
}

/// The refinement rule, as typed.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum RuleArgument {
    /// The three vertices (Eq. 12 of the report); what lies between nodes is missed
    Vertex,
    /// The whole triangle; nothing is missed
    Area,
}

impl From<RuleArgument> for RefinementRule {
    fn from(argument: RuleArgument) -> Self {
        match argument {
            RuleArgument::Vertex => Self::Vertex,
            RuleArgument::Area => Self::Area,
        }
    }
}

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

    /// Write z = 0 in place of the height of a surface, in .vtu, .msh, .obj, .stl, .ply, .glb and .2dm
    ///
    /// The heights stay as values at the nodes where the format has any.
    #[arg(long, help_heading = "Output")]
    pub flat: bool,

    /// Coordinates in files of a region on the Earth: longitude and latitude (lonlat), those of the plane of
    /// --projection (plane), or those of a code or of a projection as PROJ writes it [default: those of the
    /// region's file]
    #[arg(long, value_name = "lonlat|plane|EPSG:N|PROJ", help_heading = "Output")]
    pub out_crs: Option<OutputCoordinates>,

    /// A further value at the nodes, as a formula in x and y, with a name in .vtu, .msh and .csv; may be
    /// repeated
    ///
    /// As in `depth=20 - x`; without a name it is `quantity`. In .node the values are attributes in this
    /// order, and the first is z in .2dm. The formats of coastal solvers take the quantity `depth` as the
    /// depth, positive downwards.
    #[arg(long, value_name = "[NAME=]EXPR", allow_hyphen_values = true, help_heading = "Output")]
    pub quantity: Vec<String>,

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
