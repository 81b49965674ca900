//! The vocabulary of layers in text: in recipes (TOML) and in the settings of a project (JSON).
//!
//! [`SavedLayer`] is a layer as the text has it, [`LayerSpec`] the same with every value checked and every
//! formula compiled. Neither reads the files that a layer names:
//! [`LayerSpec::load`] makes a layer of the stack with the data of a [`LayerData`].
//!
//! | `kind` | keys besides `name`, `visible`, `locked`, `combine`, `mask`, `mask_file` |
//! |---|---|
//! | `"paint"` | `quantity`, `file` (a project that holds the paint), `layer` (its layer there) |
//! | `"formula"` | `quantity`, `formula` |
//! | `"raster"` | `file`, `bounds`, and `as` or `curve` |
//! | `"threats"` | `file` or `threats` |
//! | `"distance"` | `to`, `file` or `shapes`; `at_zero`, `slope`, `range` |
//! | `"corridor"` | `file` or `shapes`; `width`, `at_zero`, `slope`, `range` |
//! | `"band"` | `file`, `bounds`, `between`, `diameter` |

mod check_layer;
mod checks;
mod fault;
mod files;
mod load;
mod saved;
mod spec;
#[cfg(test)]
mod tests;
mod values;

pub use check_layer::{compiled, each};
pub use checks::{point, points, positive_length, rect_of, rings};
pub use fault::{KeyFault, Mark, Step};
pub use files::{GridFiles, LayerError, LayerFiles};
pub use load::{LayerData, TextError};
pub use saved::{
    SavedCombine, SavedKind, SavedLayer, SavedPolygon, SavedQuantity, SavedShape, SavedThreat, saved_polygon,
};
pub use spec::{
    DistanceTo, FindFile, KindSpec, LayerSpec, MaskSpec, RasterFile, RasterFormat, RasterReading, ShapeSpec,
    ThreatsSpec,
};
pub use values::check_values;
