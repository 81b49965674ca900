//! The picture behind the mesh.

mod command;
mod files;

pub use command::PictureCommand;
pub use files::OPEN_PICTURE;
