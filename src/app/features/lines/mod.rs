//! Lines of the document, along which the mesh that files get has edges.

mod command;
mod entries;
mod execute;
mod files;
mod load;
mod marks;
mod panel;
mod sizes;
#[cfg(test)]
mod tests;

pub use command::LinesCommand;
use panel::LINES;
use sizes::LINE_SIZES;

/// The window keeps nothing about lines: they are in the document.
#[derive(Default)]
pub struct DocumentLines;
