//! The pieces of the boundary.

mod command;
mod entries;
mod execute;
mod files;
mod opening;
mod options;
mod panel;
#[cfg(test)]
mod tests;
mod tool;

pub use command::BoundaryCommand;
pub use entries::entries;
use files::OPEN_IN_POLYGONS;
use opening::OpenedBoundary;
use options::BOUNDARY_OPTIONS;
use panel::PIECES;
pub use tool::{BOUNDARY, BoundaryTool, BoundaryToolMode};

/// The names and types of pieces are in the document, and the selected piece is in [`BoundaryTool`].
#[derive(Default)]
pub struct Boundary;
