use std::collections::BTreeSet;

use crate::paint::{TilePlace, tiles_touching};
use crate::raster::PixelRect;

/// What was edited in a document, for whoever keeps a copy of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edits {
    /// Paint, in these tiles; there may be none.
    Tiles(BTreeSet<TilePlace>),
    /// Settings, or the layers as such.
    Everything,
}

impl Default for Edits {
    fn default() -> Self {
        Self::Tiles(BTreeSet::new())
    }
}

impl Edits {
    /// Whether nothing was edited.
    pub fn is_empty(&self) -> bool {
        matches!(self, Self::Tiles(tiles) if tiles.is_empty())
    }

    pub(super) fn add(&mut self, area: PixelRect) {
        if let Self::Tiles(tiles) = self {
            tiles.extend(tiles_touching(area));
        }
    }
}
