use std::collections::BTreeSet;

use crate::paint::{TilePlace, tiles_touching};
use crate::raster::PixelRect;

/// What was edited in a document, to keep a copy of it up to date.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edits {
    /// Whether settings changed.
    pub settings: bool,
    /// Whether the paint rasters were replaced, so that every tile may differ.
    pub all_paint: bool,
    /// The tiles in which pixels changed; none are listed once `all_paint` is set.
    pub tiles: BTreeSet<TilePlace>,
}

impl Edits {
    /// Whether nothing changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    pub(super) fn everything() -> Self {
        Self { settings: true, all_paint: true, tiles: BTreeSet::new() }
    }

    pub(super) fn add(&mut self, area: PixelRect) {
        if !self.all_paint {
            self.tiles.extend(tiles_touching(area));
        }
    }
}
