use std::collections::BTreeMap;
use std::sync::Arc;

use crate::geometry::Rect;
use crate::mesh::TargetChange;
use crate::raster::{Tile, TilePlace, TiledRaster, ValueRange, ValueRanges};

/// The former tiles at all places that a stroke changed: enough to undo the stroke and to redo it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// The former tile at each place, or `None` if there was no tile.
    tiles: BTreeMap<TilePlace, Option<Arc<Tile>>>,
}

/// A part of a painted raster that changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repaint {
    /// The rectangle in which values may have changed, in world units.
    pub area: Rect,
    /// The range of the former values, there and perhaps around it.
    pub before: ValueRange,
    /// The change of the target diameters of the pixels.
    pub change: TargetChange,
}

impl Repaint {
    /// Returns both changes as one.
    pub(super) fn union(&self, other: &Self) -> Self {
        let change = if self.change == other.change { self.change } else { TargetChange::Any };
        Self { area: self.area.union(&other.area), before: self.before.union(other.before), change }
    }
}

impl Patch {
    /// Returns the patch that removes all tiles of a raster.
    pub fn clearing(raster: &TiledRaster) -> Self {
        Self { tiles: raster.tiles().map(|(place, _)| (place, None)).collect() }
    }

    /// Keeps the present tile at a place, unless one is kept for it already.
    pub(super) fn keep(&mut self, raster: &TiledRaster, place: TilePlace) {
        self.tiles.entry(place).or_insert_with(|| raster.tile(place).cloned());
    }

    /// Exchanges the kept tiles with those of the raster: the first call undoes the stroke, the second redoes
    /// it.
    ///
    /// Returns the rectangles in which values may have changed, at most one for each tile. A long stroke
    /// touches far less than its bounding rectangle.
    pub fn exchange(&mut self, raster: &mut TiledRaster) -> Vec<Repaint> {
        let (new, gone): (Vec<_>, Vec<_>) = self.tiles.iter_mut().partition(|(_, tile)| tile.is_some());
        let mut changed = Vec::new();
        // Parents appear before their children, and disappear after them.
        for (&place, tile) in new.into_iter().chain(gone.into_iter().rev()) {
            let [kept, present] = [tile.take(), raster.tile(place).cloned()];
            // Without a tile, the parent counts; where the parent changes, it has its own rectangle.
            let values =
                |tile: &Option<Arc<Tile>>| tile.clone().unwrap_or_else(|| Arc::new(raster.inherited(place)));
            let [before, after] = [&present, &kept].map(values);
            let pixels = after.difference(&before);
            let change = change_of_pixels(&before, &after, raster.blank());
            changed.extend(pixels.zip(change).map(|(pixels, (before, change))| Repaint {
                area: place.area_of_pixels(pixels, raster.grid()),
                before,
                change,
            }));
            *tile = raster.exchange(place, kept);
        }
        changed
    }

    /// Returns the places of the tiles that the stroke changed, in order.
    pub fn places(&self) -> impl Iterator<Item = TilePlace> {
        self.tiles.keys().copied()
    }

    /// Returns whether the stroke changed nothing.
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Returns memory of the tiles, in bytes.
    pub fn bytes(&self) -> usize {
        self.tiles.values().flatten().count() * size_of::<Tile>()
    }
}

/// Returns the range of the former values of those pixels that change, and the change of their target
/// diameters; `None` if no pixel changes.
///
/// The blank value stands for no target, and all other values lie on one side of it: the farther a value is
/// from it, the smaller is its target diameter.
fn change_of_pixels(before: &Tile, after: &Tile, blank: f32) -> Option<(ValueRange, TargetChange)> {
    let pairs = before.values().iter().zip(after.values()).filter(|(before, after)| before != after);
    let changes = pairs.map(|(&before, &after)| {
        let leaves_blank = if blank <= before.min(after) { after > before } else { after < before };
        let change = if leaves_blank { TargetChange::Finer } else { TargetChange::Coarser };
        (ValueRange::one(before), change)
    });
    changes.reduce(|(range, change), (one, other)| {
        (range.union(one), if change == other { change } else { TargetChange::Any })
    })
}

/// Returns the range of the values of a tile.
pub(super) fn range_of(tile: &Tile) -> ValueRange {
    const LANES: usize = 8;
    let (chunks, _) = tile.values().as_chunks::<LANES>();
    // Each lane by itself, so that none waits for the one before.
    let ranges = chunks.iter().fold(chunks[0].map(ValueRange::one), |mut ranges, chunk| {
        ranges.iter_mut().zip(chunk).for_each(|(range, &value)| *range = range.union(ValueRange::one(value)));
        ranges
    });
    ranges.into_iter().reduce(ValueRange::union).expect("there are lanes")
}
