//! The picture behind the mesh.

mod command;

pub use command::PictureCommand;
