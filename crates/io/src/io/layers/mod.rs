//! The vocabulary of layers in text: in recipes (TOML) and in the settings of a project (JSON).
//!
//! [`SavedLayer`] is a layer as the text has it. [`SavedLayer::load`] checks its values and makes a layer of
//! the stack, with the data of a [`LayerData`]: files, or the parts of a project.
//!
//! | `kind` | keys besides `name`, `visible`, `locked`, `combine`, `mask`, `mask_file` |
//! |---|---|
//! | `"paint"` | `quantity`, `file` (a project that holds the paint), `layer` (its layer there) |
//! | `"formula"` | `quantity`, `formula` |
//! | `"raster"` | `file`, `bounds`, and `as` or `curve` |
//! | `"threats"` | `file` or `threats` |
//! | `"distance"` | `to`, `file`, `shapes`, or `pieces` and `types`; `at_zero`, `slope`, `range` |
//! | `"corridor"` | `file` or `shapes`; `width`, `at_zero`, `slope`, `range` |
//! | `"straits"`, `"feature-size"` | `across`, `width_from`, `width_to` |
//! | `"band"` | `file`, `bounds`, `between`, `diameter` |
//! | `"surface"` | `file` and `bounds`, or `formula`; `within` or `at_most`; `norm` |

mod check_layer;
mod checks;
mod depth;
mod fill;
mod keys;
mod rasters;
mod saved;
mod saved_lists;
mod surface;
#[cfg(test)]
mod tests;
mod words;

/// Most threats, and most points of shapes or of a mask, that stand beside the other keys of a layer. More
/// are in a file beside a recipe, and in a part of a project.
pub const MOST_IN_PLACE: usize = 20;

pub use check_layer::{CheckedKind, CheckedShapes, FindFile, Growth, Stored, compiled, each};
pub use checks::{point, points, positive_length, rect_of, rings};
pub use fill::{LayerData, TextError, in_direction};
pub use keys::{check_keys, check_keys_of_all, kinds_with};
pub use rasters::{LoadedRaster, OwnPlace, RasterError, RasterFile, RasterFrame, RasterLoader};
pub use saved::{SavedLayer, SavedPolygon, SavedShape, SavedThreat};
pub use saved_lists::saved_polygon;
pub use words::{
    SavedCombine, SavedDepthSize, SavedDistanceTo, SavedKind, SavedLaw, SavedNorm, SavedPositive,
    SavedQuantity,
};
