//! Regions drawn by hand: the mask of a layer, keep-out regions of paths, and shapes to measure the
//! distance to.

mod command;
mod entries;
mod execute;
mod gestures;
mod marks;
mod options;
#[cfg(test)]
mod tests;
mod tool;

pub use command::{RegionCommand, RegionShape, RegionTarget};
use options::REGION_OPTIONS;
pub use tool::{REGION, RegionTool};

/// What is drawn is in the document, and the open polygon in [`RegionTool`].
#[derive(Default)]
pub struct Regions;
