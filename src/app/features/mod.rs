//! The features of the window, a folder each. A feature sees the rest of the window through a
//! [`Ctx`](super::ctx::Ctx), and never another feature.
//!
//! Boundary, picture, pins and plots have everything in their folders. Of the others, only commands and kinds
//! of files are here.

pub mod boundary;
pub mod domain;
pub mod inspection;
pub mod layers;
pub mod painting;
pub mod picture;
pub mod pins;
pub mod plots;
pub mod statistics;
pub mod threats;

use super::ctx::Feature as _;
use boundary::Boundary;
use picture::BackgroundPicture;
use pins::Pins;
use plots::Plots;

/// The state of all features.
#[derive(Default)]
pub struct Features {
    /// The pieces of the boundary.
    pub boundary: Boundary,
    /// The picture behind the mesh.
    pub picture: BackgroundPicture,
    /// Points whose triangles and values are followed.
    pub pins: Pins,
    /// Plots of the mesh, and of the time that meshes take.
    pub plots: Plots,
}

impl Features {
    /// Forgets what belongs to the document: another one was opened.
    pub fn forget_document(&mut self) {
        let Self { boundary, picture, pins, plots } = self;
        boundary.forget_document();
        picture.forget_document();
        pins.forget_document();
        plots.forget_document();
    }
}
