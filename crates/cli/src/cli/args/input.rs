//! Arguments on what to mesh.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::distances::DistanceArguments;
use super::earth::EarthArguments;
use super::help::{risk_raster_help, target_raster_help, target_raster_long_help};
use super::surface::SurfaceArguments;
use super::water::WaterArguments;
use meshbrush_core::field::RefinementRule;
use meshbrush_mesh::text::Length;

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
    /// Nodes lie on the line where it becomes 0 or NaN, unless --boundary says otherwise. Parts and holes
    /// that are narrower than a 4,096th of the longer side of the domain can be missed.
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

    /// Lines along which the mesh has edges, as a breakwater or a thalweg: a GeoJSON file, shapefile (.shp)
    /// or GeoPackage (.gpkg) with lines or polygons; may be repeated
    ///
    /// Where triangles are too coarse for them, --json says where, and which diameter would do.
    #[arg(long, value_name = "FILE")]
    pub lines: Vec<PathBuf>,

    /// Triangles as small as the lines need: this many across the gap between two parts of lines, down to
    /// --h-min
    ///
    /// With 1, nearly all parts of lines get edges.
    #[arg(long, value_name = "N", requires = "lines", requires = "h_min", allow_hyphen_values = true)]
    pub line_sizes: Option<f64>,

    /// How the mesh meets the outline of a region, or the line where the formula of --inside becomes 0
    ///
    /// [default: outline]
    #[arg(long, value_enum)]
    pub boundary: Option<BoundaryArgument>,

    /// Largest diameter of triangles on the outline, before nodes move onto it [default: an eighth of the
    /// spacing]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub boundary_diameter: Option<Length>,

    /// Parts of the mesh that stay: the largest, all, or those with this share of the area [default: largest
    /// for a region or a formula, but all with --boundary report]
    ///
    /// A part is joined by edges. Narrow straits can part a mesh, and solvers need one part.
    #[arg(long, value_name = "largest|all|SHARE", allow_hyphen_values = true)]
    pub parts: Option<String>,

    /// Keep nodes in which triangles of a fitted mesh meet without sharing an edge
    ///
    /// Otherwise the smaller side of such a node is removed.
    #[arg(long)]
    pub keep_pinches: bool,

    /// Improve triangles along the outline: angles of at least 25° where it allows them, no triangle with all
    /// three nodes on the boundary, and at most 8 triangles at a node
    ///
    /// Nodes slide along the outline, edges flip, and nodes are put between those of the boundary.
    #[arg(long)]
    pub improve_boundary: bool,

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
    /// As fitted; then nodes along the outline move onto it, and edges that become longer than their target
    /// are halved
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
