//! The features of the window, a folder each. A feature sees the rest of the window through a
//! [`Ctx`](super::ctx::Ctx), and never another feature.
//!
//! *Pins* has everything in its folder. Of the others, commands and kinds of files are here so far.

pub mod boundary;
pub mod domain;
pub mod inspection;
pub mod layers;
pub mod painting;
pub mod picture;
pub mod pins;
pub mod statistics;
pub mod threats;

use super::ctx::Feature as _;
use pins::Pins;

/// The state of all features.
#[derive(Default)]
pub struct Features {
    /// Points whose triangles and values are followed.
    pub pins: Pins,
}

impl Features {
    /// Forgets what belongs to the document: another one was opened.
    pub fn forget_document(&mut self) {
        let Self { pins } = self;
        pins.forget_document();
    }
}
