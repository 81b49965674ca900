//! The picture behind the mesh.

mod command;
mod corners;
mod execute;
mod files;
mod panel;
#[cfg(test)]
mod tests;
mod texture;

pub use command::PictureCommand;
pub use corners::show as show_corners;
pub use files::OPEN_PICTURE;
use files::ROLES;
pub use panel::BACKGROUND;
pub use texture::BackgroundTexture;

/// All about the picture is in the document, and its texture on the canvas.
#[derive(Default)]
pub struct BackgroundPicture;
