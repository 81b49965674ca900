//! Commands about the picture behind the mesh.

use std::path::PathBuf;

use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with the picture behind the mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum PictureCommand {
    /// Reads a picture to be shown behind the mesh.
    Open(PathBuf),
}

impl CommandSet for PictureCommand {}
