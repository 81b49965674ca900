//! Lines of the document, along which the mesh that files get has edges: the tool that draws them, their
//! list, and which parts of them are on edges.

mod command;
mod corners;
mod deepest;
mod drawing_marks;
mod entries;
mod execute;
mod files;
mod gestures;
mod load;
mod marks;
mod options;
mod panel;
mod sizes;
mod places;
mod snap;
#[cfg(test)]
mod tests;
mod tool;

pub use command::{LineEnd, LineToolMode, LinesCommand};
use options::LINE_OPTIONS;
use panel::LINES;
use sizes::LINE_SIZES;
pub use tool::{LINE, LineTool};

/// The lines are in the document, and the line that is being drawn in [`LineTool`].
#[derive(Default)]
pub struct DocumentLines;
