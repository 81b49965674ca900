//! Settings as texts have them: recipes (TOML), projects and recordings (JSON), and the options of the
//! command line.
//!
//! [`SavedSettings`] has a struct for each table; what is missing has its default value.
//! [`SavedSettings::load`] makes the settings of a document from it, and [`SavedSettings::of`] is the way
//! back. A [`Storage`] reads what tables and layers name: files beside a recipe, or parts of a project.

mod check;
mod cut_off;
mod lines;
mod load;
mod of_settings;
mod opening;
mod overrides;
mod parts;
mod paths;
mod problem;
mod tables;
mod weirs;
mod words;

pub use cut_off::{SavedRing, written_ring};
pub use load::{LoadingDefaults, ReadRegion, RegionCoordinates, Storage};
pub use opening::{SavedOpen, SavedOpenings};
pub use parts::SavedParts;
pub use problem::{SavedFormula, SavedProblem};
pub use tables::{
    SavedDomain, SavedKeepOut, SavedLimits, SavedLine, SavedMesh, SavedOutput, SavedPaths, SavedPins,
    SavedQuantityGrid, SavedSettings, SavedTreatment,
};
pub use weirs::{SavedCrest, SavedLineType};
pub use words::{
    SavedBoundaryType, SavedName, SavedPieceType, SavedRule, SavedUnit, marks_of, saved_marks, word_of,
};
