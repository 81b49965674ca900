//! The vocabulary of layers in text: in recipes (TOML) and in the settings of a project (JSON).
//!
//! [`SavedLayer`] is a layer as the text has it: its name, the [`SharedKeys`] of all layers, and the
//! [`LayerKeys`] of its kind, which are a struct in a file of [`kinds`]. [`SavedLayer::load`] checks the
//! values and makes a layer of the stack, with the data of a [`LayerData`]: files, or the parts of a project.

mod checks;
mod data;
mod direction;
mod key_group;
mod kinds;
mod quantity_grid;
mod rasters;
mod saved;
mod shapes;
#[cfg(test)]
mod tests;
mod words;

/// Most threats, and most points of shapes or of a mask, that stand beside the other keys of a layer. More
/// are in a file beside a recipe, and in a part of a project.
pub const MOST_IN_PLACE: usize = 20;

pub use checks::{FindFile, compiled, each, point, points, positive_length, rect_of, rings};
pub use data::{LayerData, LayerOrigin, Stored, TextError};
pub use direction::in_direction;
pub use key_group::{KeyGroup, TableEntries};
pub use kinds::{
    BandKeys, BoundaryKeys, CorridorKeys, CourantKeys, DatumKeys, DepthKeys, DepthRangeKeys, DepthSizeKeys,
    DistanceKeys, FeatureSizeKeys, FormulaKeys, GoalKeys, GridKeys, GrowthKeys, KindKeys, LayerKeys,
    LineSizeKeys, PaintKeys, RasterKeys, ReadingKeys, SavedKind, SavedKnot, ShapeKeys, SlopeKeys, StepKeys,
    StraitKeys, StripKeys, SurfaceKeys, TargetKeys, ThreatKeys, WavelengthKeys, WidthKeys,
};
pub use quantity_grid::QuantityGrid;
pub use rasters::{LoadedRaster, OwnPlace, RasterError, RasterFile, RasterFrame, RasterLoader};
pub use saved::{ListsInPlace, SavedLayer, SharedKeys};
use shapes::checked_shapes;
pub use shapes::{SavedPolygon, SavedShape, SavedThreat, saved_polygon};
pub use words::{
    SavedCombine, SavedDepthSize, SavedDistanceTo, SavedLaw, SavedNorm, SavedPositive, SavedQuantity,
};
