//! The features of the window, a folder each. A feature sees the rest of the window through a
//! [`Ctx`], and never another feature: it sends the command of another one instead.

pub mod boundary;
pub mod domain;
pub mod inspection;
pub mod layers;
pub mod lines;
pub mod painting;
pub mod paths;
pub mod picture;
pub mod pins;
pub mod plots;
pub mod regions;
pub mod report;
pub mod statistics;
pub mod stepping;
pub mod threats;

use std::sync::LazyLock;

use boundary::Boundary;
use domain::DomainEditor;
use inspection::Inspector;
use layers::LayerEditor;
use lines::DocumentLines;
use meshbrush_kit::kit::{Feature, Features, LayerKindRow, Row, kinds_of_layers};
use painting::Painting;
use paths::Paths;
use picture::BackgroundPicture;
use pins::Pins;
use plots::Plots;
use regions::Regions;
use report::Report;
use statistics::Statistics;
use stepping::Stepping;
use threats::ThreatEditor;

/// The kinds of layers of all features, as menus list them.
pub static LAYER_KINDS: LazyLock<Vec<&LayerKindRow>> = LazyLock::new(|| kinds_of_layers(ROWS));

/// Writes from one list what knows all features: their state, their rows, and what runs their commands.
macro_rules! features {
    ( $( $(#[$doc:meta])* $Feature:ty, )* ) => {
        /// The parts of each feature that the window shows.
        pub static ROWS: &[Row] = &[ $( <$Feature as Feature>::ROW, )* ];

        /// Returns all features in their first state.
        pub fn all() -> Features {
            Features::default() $( .with::<$Feature>() )*
        }
    };
}

// Menus, side panel, tool strip and canvas show the features in this order.
features! {
    /// Strokes and the brush.
    Painting,
    /// The domain.
    DomainEditor,
    /// Lines inside the domain.
    DocumentLines,
    /// The layers of the size field.
    LayerEditor,
    /// Regions drawn by hand.
    Regions,
    /// The paths of the document.
    Paths,
    /// The queried point and its triangle.
    Inspector,
    /// The steps of the refinement.
    Stepping,
    /// The threats of the selected layer.
    ThreatEditor,
    /// The pieces of the boundary.
    Boundary,
    /// The picture behind the mesh.
    BackgroundPicture,
    /// Points whose triangles and values are followed.
    Pins,
    /// The figures of the mesh.
    Statistics,
    /// Plots of the mesh, and of the time that meshes take.
    Plots,
    /// The figures of the report.
    Report,
}
