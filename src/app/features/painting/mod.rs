//! Strokes and the brush.

mod brush;
mod entries;
mod eraser;
mod execute;
mod gestures;
mod limit_offer;
mod options;
#[cfg(test)]
mod tests;

pub use brush::{BRUSH, picks};
pub use eraser::ERASER;
use gestures::GESTURES;
use limit_offer::LimitOffer;
pub use limit_offer::show as show_limit_offer;
use options::{BRUSH_OPTIONS, ERASER_OPTIONS, brush_diameters};

use meshbrush_core::layers::LayerId;

/// The stroke is in the document, and the settings of the brush are in
/// [`Tools`](meshbrush_kit::kit::tools::Tools).
#[derive(Default)]
pub struct Painting {
    /// The offer that follows the current stroke.
    next_offer: Option<LimitOffer>,
    /// The offer to lower the smallest diameter.
    offer: Option<LimitOffer>,
    /// The selected layer that the kind of paint was last made to suit.
    suited: Option<Option<LayerId>>,
}
