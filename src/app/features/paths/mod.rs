//! Paths of least cost: the tool for them, the search for them and for others, regions that they stay out of,
//! corridors along them, and their files.

mod alternatives;
mod colors;
mod command;
mod corridor;
mod corridor_layer;
mod corridor_marks;
mod entries;
mod execute;
mod export;
mod files;
mod finder;
mod front;
mod keep_out;
mod keep_out_marks;
mod layer_kind;
mod marks;
mod options;
mod panel;
mod prover;
#[cfg(test)]
mod tests;
mod tool;
mod work;

pub use alternatives::AlternativesCommand;
use alternatives::MOST_ALTERNATIVES;
pub use colors::ALTERNATIVE_COLOR;
use command::NO_PATH;
pub use command::{CostKind, PathCommand};
pub use corridor_marks::FILL as CORRIDOR_COLOR;
pub use files::EXPORT_PATH;
use files::{OPEN_KEEP_OUT, ROLES};
pub use finder::PathFinder;
use front::FRONT_PATHS;
pub use front::FrontCommand;
pub use keep_out::KeepOutCommand;
use layer_kind::CORRIDOR;
use options::PATH_OPTIONS;
use panel::{OTHER_PATHS, PATH_COST, PATH_PANEL};
pub use tool::PATH;
use tool::PathTool;
use work::{FoundPath, ShownPath};

/// What the window keeps of paths; their places and their cost are in the document.
#[derive(Default)]
pub struct Paths {
    /// Finds the paths, and keeps the last ones.
    pub finder: PathFinder,
    /// The state of the tool.
    tool: PathTool,
}
