//! The layers of the size field: the stack, the parameters of the selected layer, and the curve from risk to
//! diameter.

mod entries;
mod execute;
mod files;
mod gradation;
mod grid;
mod ground;
mod kinds;
mod list;
mod load;
mod marks;
mod panel;
mod pictures;
mod row_menu;
mod selected;
mod surface_fit;
#[cfg(test)]
pub mod tests;
mod transfer;

use files::{
    EXPORT_GRID, OPEN_BAND, OPEN_DEPTH, OPEN_MASK, OPEN_SHAPES, OPEN_SURFACE, REPLACE_SHAPES, ROLES,
};
pub use files::{OPEN_DIAMETERS, OPEN_RISK, OPEN_VALUES};
use gradation::GRADATION;
use kinds::KINDS;
use load::way_to_metres;
use panel::LAYERS;
use pictures::LayerPictures;
use surface_fit::MeasuredFit;
use transfer::TRANSFER;

/// The small pictures of layers; the layers are in the document.
#[derive(Default)]
pub struct LayerEditor {
    /// Small pictures of the target diameters of each layer.
    pictures: LayerPictures,
    /// How far the mesh is from surfaces.
    surface_fit: MeasuredFit,
}
