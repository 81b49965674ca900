use std::collections::BTreeMap;
use std::sync::Arc;

use crate::geometry::Rect;
use crate::mesh::TargetChange;
use crate::raster::{Tile, TilePlace, TiledRaster, ValueRange, ValueRanges};

/// What was before a stroke at each place that it changed: enough to undo the stroke and to redo it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// `None` where there was no tile.
    tiles: BTreeMap<TilePlace, Option<Arc<Tile>>>,
}

/// A part of a painted raster that changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repaint {
    /// Where values may have changed, in world units.
    pub area: Rect,
    /// The range of the values before, there and perhaps around it.
    pub before: ValueRange,
    /// What happened to the diameters that the pixels ask for.
    pub change: TargetChange,
}

impl Repaint {
    /// Both changes as one.
    pub(super) fn union(&self, other: &Self) -> Self {
        let change = if self.change == other.change { self.change } else { TargetChange::Any };
        Self { area: self.area.union(&other.area), before: self.before.union(other.before), change }
    }
}

impl Patch {
    /// The patch that removes all tiles of a raster.
    pub fn clearing(raster: &TiledRaster) -> Self {
        Self { tiles: raster.tiles().map(|(place, _)| (place, None)).collect() }
    }

    /// Keeps what is at a place now, unless something is kept for it already.
    pub(super) fn keep(&mut self, raster: &TiledRaster, place: TilePlace) {
        self.tiles.entry(place).or_insert_with(|| raster.tile(place).cloned());
    }

    /// Exchanges the kept tiles with those of the raster: the first call undoes the stroke, the second redoes
    /// it.
    ///
    /// Returns where values may have changed, at most one rectangle for each tile: a long stroke touches far
    /// less than its bounding rectangle.
    pub fn exchange(&mut self, raster: &mut TiledRaster) -> Vec<Repaint> {
        let (new, gone): (Vec<_>, Vec<_>) = self.tiles.iter_mut().partition(|(_, tile)| tile.is_some());
        let mut changed = Vec::new();
        // Parents appear before their children, and disappear after them.
        for (&place, tile) in new.into_iter().chain(gone.into_iter().rev()) {
            let [kept, present] = [tile.take(), raster.tile(place).cloned()];
            // Where there is no tile, the parent counts; where the parent changes, it has its own rectangle.
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

    /// The places at which the stroke changed tiles, in order.
    pub fn places(&self) -> impl Iterator<Item = TilePlace> {
        self.tiles.keys().copied()
    }

    /// Whether the stroke touched nothing.
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Memory of the tiles, in bytes.
    pub fn bytes(&self) -> usize {
        self.tiles.values().flatten().count() * size_of::<Tile>()
    }
}

/// The range of the values of those pixels that change, before they do, and what happens to the diameters
/// that they ask for; `None` if no pixel changes.
///
/// The blank value asks for nothing, and all others lie on one side of it: the farther a value is from it,
/// the smaller is the diameter that it asks for.
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

/// The range of the values of a tile.
pub(super) fn range_of(tile: &Tile) -> ValueRange {
    tile.values()
        .iter()
        .map(|&value| ValueRange::one(value))
        .reduce(ValueRange::union)
        .unwrap_or(ValueRange::one(0.0))
}
