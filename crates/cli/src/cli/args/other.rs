//! Arguments of the commands that make no mesh from options.

use std::path::PathBuf;

use clap::Args;

/// `meshbrush recipe`: which project, and where the recipe goes.
#[derive(Debug, Args)]
pub struct RecipeArguments {
    /// A project saved in the window (.meshbrush)
    pub project: PathBuf,

    /// The recipe to write; the files that it names are named after it
    #[arg(short, long, value_name = "RECIPE.toml")]
    pub output: PathBuf,
}

/// `meshbrush thumbnail`.
#[derive(Debug, Args)]
pub struct ThumbnailArguments {
    /// A project saved in the window (.meshbrush)
    pub project: PathBuf,

    /// The picture to write, as PNG whatever its name
    pub output: PathBuf,

    /// Width and height, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 256, value_parser = clap::value_parser!(u32).range(16..=1024))]
    pub size: u32,
}

/// `meshbrush replay`.
#[derive(Debug, Args)]
pub struct ReplayArguments {
    /// A session exported from the window (.jsonl)
    pub file: PathBuf,

    /// Print the result as one JSON object on standard output
    #[arg(long)]
    pub json: bool,
}

/// `meshbrush report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// How often each mesh is made, in turn with the others; the least and the greatest time are printed
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub runs: u32,

    /// Highest level to refine to; the report goes to 13
    #[arg(long, value_name = "L", default_value_t = 13, value_parser = clap::value_parser!(u32).range(6..=13))]
    pub level: u32,

    /// Print the numbers as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// `meshbrush completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// `meshbrush man`.
#[cfg(feature = "man")]
#[derive(Debug, Args)]
pub struct ManArguments {
    /// Folder to write to; created if it does not exist
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// `meshbrush screenshots`.
#[derive(Debug, Args)]
pub struct ScreenshotsArguments {
    /// Folder to write to; created if it does not exist
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,

    /// Write the pictures of the manual instead of those of the README
    #[arg(long)]
    pub manual: bool,

    /// Write the steps of a first session, from opening a coast to exporting its mesh, instead
    #[arg(long, conflicts_with = "manual")]
    pub tour: bool,
}
