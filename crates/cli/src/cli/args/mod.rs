//! Arguments as typed. [`Input`](super::input::Input) interprets and checks those on what to mesh.
//!
//! Each file has the options of a command, or of one matter of several commands. None runs anything.

mod depths;
mod distances;
mod earth;
mod error_curve;
mod help;
mod input;
mod mesh;
mod numbers;
mod other;
mod path;
mod picture;
mod quantities;
mod query;
mod solve;
mod space;
mod surface;
mod water;

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{CommandFactory as _, Parser, Subcommand};

pub use depths::DepthArguments;
pub use earth::EarthArguments;
pub use error_curve::ErrorCurveArguments;
pub use input::{BoundaryArgument, InputArguments};
pub use mesh::MeshArguments;
#[cfg(feature = "man")]
use other::ManArguments;
use other::{CompletionsArguments, ScreenshotsArguments};
pub use other::{RecipeArguments, ReplayArguments, ReportArguments, ThumbnailArguments};
pub use path::PathArguments;
pub use picture::{PICTURE_COLORMAP, PICTURE_SIZE, PictureArguments};
pub use quantities::QuantityArguments;
pub use query::{CheckArguments, LocateArguments, WhyArguments};
pub use solve::{ProblemArguments, SolveArguments};
pub use space::{PictureView, SpaceArguments};

use help::file_help;

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
    /// Build a mesh and say where it breaks the rules of a solver, as its file would have it
    ///
    /// Rules look at what is in the file: angles are those of its coordinates, and open nodes those that it
    /// marks. The exit status is 1 if the mesh breaks a rule; notes do not count.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckArguments),
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
    /// Build a mesh, solve −∇·(a∇u) + b·∇u + c u = f on it by linear finite elements, and bound the error
    ///
    /// Lengths are world units; on the Earth, metres on the ellipsoid, with b along x and y of the plane. The
    /// bound is one of the energy error: the root of the integral of a |∇e|² + c e². Without convection it is
    /// proved, unless data vary in a way that the answer names.
    #[command(after_help = SOLVE_EXAMPLES)]
    Solve(SolveArguments),
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

const CHECK_EXAMPLES: &str = "\
Examples:
  meshbrush check coast.toml --for fvcom
  meshbrush check coast.toml --for swan --out-crs plane --json
  meshbrush check --domain 0,0,40000,40000 --spacing 10000 --quantity depth=50 --for adcirc";

const LOCATE_EXAMPLES: &str = "\
Example:
  meshbrush locate --spacing 0.1 --target '0.01 + 0.2*hypot(x - 0.5, y - 0.5)' --points points.csv -o found.csv";

const WHY_EXAMPLES: &str = "\
Examples:
  meshbrush why 0.48,0.52 --spacing 0.1 --target '0.01 + 0.2*hypot(x - 0.5, y - 0.5)'
  meshbrush why 2.5,1 --project coast.meshbrush --json";

const SOLVE_EXAMPLES: &str = "\
Examples:
  meshbrush solve --spacing 0.1 --target 0.02 --source 1 --dirichlet all=0 -o u.vtu
  meshbrush solve --spacing 0.1 --target 0.03 --diffusion 'if(x<0.5, 1, 100)' --dirichlet 'open west=0' --neumann 'open east=1' --json
  meshbrush solve --spacing 0.1 --source 1 --dirichlet all=0 --within 0.01 --json
  meshbrush solve harbour.toml --reaction 0.5 -o u.vtu";

const PATH_EXAMPLES: &str = "\
Examples:
  meshbrush path --from 0.1,0.1 --to 0.9,0.8 --risk 'exp(-20*hypot(x, y)^2)' --h-min 0.01 -o path.geojson
  meshbrush path --project coast.meshbrush --from 1,2 --via 4,4 --to 8,3 --within 1% -o path.csv -o path.png
  meshbrush path --from 0,0 --to 1,1 --cost '1 + 5*x' --json";
