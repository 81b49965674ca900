//! The layers of the size field: the stack, the parameters of the selected layer, and the curve from risk to
//! diameter.

mod command;
mod entries;
mod execute;
mod files;
mod gradation;
mod kinds;
mod list;
mod load;
mod marks;
mod panel;
mod pictures;
mod selected;
#[cfg(test)]
pub mod tests;
mod transfer;

pub use command::LayerCommand;
use files::{OPEN_BAND, OPEN_DEPTH, OPEN_MASK, OPEN_SHAPES, REPLACE_SHAPES, ROLES};
pub use files::{OPEN_DIAMETERS, OPEN_RISK, OPEN_VALUES};
use gradation::GRADATION;
use kinds::KINDS;
use panel::LAYERS;
use pictures::LayerPictures;
pub use pictures::layer_color32;
use transfer::TRANSFER;

/// The small pictures of layers; the layers are in the document.
#[derive(Default)]
pub struct LayerEditor {
    /// Small pictures of the target diameters of each layer.
    pictures: LayerPictures,
}
