use std::collections::BTreeSet;

use crate::paint::{TilePlace, tiles_touching};
use crate::raster::PixelRect;

/// What was edited in a document, for whoever keeps a copy of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edits {
    /// Whether settings were.
    pub settings: bool,
    /// Whether the layers were replaced, and every tile may be another one.
    pub layers: bool,
    /// The tiles that were painted.
    pub tiles: BTreeSet<TilePlace>,
}

impl Edits {
    /// Whether nothing was edited.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    pub(super) fn everything() -> Self {
        Self { settings: true, layers: true, tiles: BTreeSet::new() }
    }

    pub(super) fn add(&mut self, area: PixelRect) {
        if !self.layers {
            self.tiles.extend(tiles_touching(area));
        }
    }
}
