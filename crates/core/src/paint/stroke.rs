use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::ops::RangeInclusive;
use std::sync::Arc;

use super::patch::range_of;
use super::resolution::Segment;
use super::{Brush, Mirror, Patch, PathPoint, Repaint};
use crate::geometry::Rect;
use crate::raster::{TILE, Tile, TilePlace, TiledRaster, ValueRange, ValueRanges};

/// One gesture with a brush, from press to release.
///
/// The pointer gives a polyline. Each of its segments covers a capsule, and the stroke covers their union:
///
/// ```text
///      .-----------.         coverage of a pixel: 1 in the core, smoothly down to 0 at the rim;
///    /  .---------.  \       where capsules overlap, the largest coverage counts
///   |  | o-------o |  |
///    \  '---------'  /       o---o  segment of the pointer's path
///      '-----------'         inner line: core (hardness × radius); outer line: rim (radius)
/// ```
///
/// A segment is painted on tiles of the smallest depth at which the brush has a radius of 32 pixels, and on
/// all deeper tiles that it reaches. A pixel's new value follows from its value before the stroke and its
/// largest coverage. So passing over a place twice within a stroke does no more than passing over it once,
/// and a stroke gives the same pixels however it is sliced.
#[derive(Clone, Debug)]
pub struct Stroke {
    brush: Brush,
    /// The largest target diameter, in world units: a painted diameter grows to it at the rim.
    h_max: f64,
    /// The rectangle that paint is limited to, in world units.
    bounds: Rect,
    mirror: Mirror,
    /// The last point of the path.
    last: Option<PathPoint>,
    /// The tiles of the raster before the stroke, and those of all segments so far.
    tiles: usize,
    /// Segments that are not drawn yet, in order.
    pending: VecDeque<Segment>,
    /// The former tile at each place that the stroke changed.
    before: Patch,
    covered: BTreeMap<TilePlace, Covered>,
}

/// A tile that the stroke covers.
#[derive(Clone, Debug)]
struct Covered {
    /// The pixels of the tile before the stroke, and the range of their values.
    before: Arc<Tile>,
    range: ValueRange,
    /// The largest coverage of each pixel so far, 0 to 1.
    coverage: Box<Tile>,
}

impl Covered {
    fn new(before: Arc<Tile>, coverage: Box<Tile>) -> Self {
        Self { range: range_of(&before), before, coverage }
    }

    /// Takes over the coverage of another segment where it is larger, and sets it to 0 elsewhere. Returns
    /// whether it is larger anywhere.
    fn grow(&mut self, coverage: &mut Tile) -> bool {
        let mut has_grown = false;
        for (so_far, coverage) in self.coverage.values_mut().iter_mut().zip(coverage.values_mut()) {
            let is_larger = *coverage > *so_far;
            has_grown |= is_larger;
            *so_far = coverage.max(*so_far);
            *coverage = if is_larger { *coverage } else { 0.0 };
        }
        has_grown
    }
}

impl Stroke {
    /// Creates a stroke that has changed nothing yet. `h_max` is the largest target diameter, in world units;
    /// paint reaches no further than `bounds`.
    pub fn new(brush: Brush, h_max: f64, bounds: Rect) -> Self {
        Self {
            brush,
            h_max,
            bounds,
            mirror: Mirror::default(),
            last: None,
            tiles: 0,
            pending: VecDeque::new(),
            before: Patch::default(),
            covered: BTreeMap::new(),
        }
    }

    /// Returns the stroke, repeated in the lines of `mirror`.
    pub fn mirrored(self, mirror: Mirror) -> Self {
        Self { mirror, ..self }
    }

    /// Returns the brush in use.
    pub fn brush(&self) -> &Brush {
        &self.brush
    }

    /// Extends the path to a point; [`Self::advance`] draws the new segment. A point that is not finite is
    /// ignored, and so is one that equals the last.
    pub fn extend(&mut self, raster: &TiledRaster, point: impl Into<PathPoint>) {
        let point = point.into();
        if point.is_finite() && self.last != Some(point) {
            if self.last.is_none() {
                self.tiles = raster.tile_count();
            }
            let from = self.last.replace(point).unwrap_or(point);
            let segments = self.mirror.segments([from, point]);
            for ends in segments {
                let most = most_tiles_beside(self.tiles);
                let segment = Segment::new(self.brush, ends, &self.bounds, raster.grid(), most);
                self.tiles += segment.as_ref().map_or(0, |segment| segment.places.len());
                self.pending.extend(segment);
            }
        }
    }

    /// Draws about `pixels` pixels of the next segment, in whole tiles. Returns the area where pixels may
    /// have changed, with their values before the stroke; `None` if nothing was left to draw.
    pub fn advance(&mut self, raster: &mut TiledRaster, pixels: usize) -> Option<Repaint> {
        let mut changed: Option<Repaint> = None;
        let mut tiles_left = pixels.div_ceil((TILE * TILE) as usize).max(1);
        while let Some(mut segment) = self.pending.pop_front() {
            while let Some(place) = segment.places.pop_if(|_| tiles_left > 0) {
                if let Some(drawn) = self.draw(raster, &mut segment, place) {
                    changed = Some(changed.map_or(drawn, |changed| changed.union(&drawn)));
                    tiles_left -= 1;
                }
            }
            if !segment.places.is_empty() {
                self.pending.push_front(segment);
            }
            // Skip segments that cover no pixel.
            if changed.is_some() {
                break;
            }
        }
        changed
    }

    /// Draws a segment on a tile, and lists the tile's children to be drawn next. Returns the area where
    /// pixels may have changed; `None` if the segment covers no pixel of the tile.
    fn draw(&mut self, raster: &mut TiledRaster, segment: &mut Segment, place: TilePlace) -> Option<Repaint> {
        // Children hide the tile, so they are drawn on as well.
        for child in place.children().into_iter().filter(|child| raster.tile(*child).is_some()) {
            if segment.reaches(child, raster.grid()) {
                segment.places.push(child);
            }
        }
        let coverage = segment.coverage_of(place, raster.grid())?;
        self.deepen(raster, place);
        let before = self.stamp(raster, place, coverage)?;
        let change = self.brush.medium.change(self.h_max);
        Some(Repaint { area: segment.area_on(place, raster.grid()), before, change })
    }

    /// Returns whether the path is drawn to its last point.
    pub fn is_drawn(&self) -> bool {
        self.pending.is_empty()
    }

    /// Ends the stroke: removes tiles that are no longer needed, and returns the former tiles. No value
    /// changes.
    pub fn finish(mut self, raster: &mut TiledRaster) -> Patch {
        let mut places: BTreeSet<TilePlace> = self.before.places().collect();
        while let Some(place) = places.pop_last() {
            if raster.is_redundant(place) {
                self.before.keep(raster, place);
                if let Some(parent) = place.parent() {
                    self.before.keep(raster, parent);
                    places.insert(parent);
                }
                raster.merge(place);
            }
        }
        self.before
    }

    /// Adds a tile at a place, and at all places above it, where there is none yet.
    fn deepen(&mut self, raster: &mut TiledRaster, place: TilePlace) {
        let above = std::iter::successors(Some(place), TilePlace::parent);
        let missing: Vec<_> = above.take_while(|place| raster.tile(*place).is_none()).collect();
        for place in missing.into_iter().rev() {
            self.before.keep(raster, place);
            let covered = place.parent().and_then(|parent| self.covered.get(&parent));
            // The effect of the stroke on the parent is applied to the new tile as well.
            let covered = covered.map(|parent| {
                let before = Arc::new(parent.before.enlarged(&place));
                Covered::new(before, Box::new(parent.coverage.enlarged(&place)))
            });
            self.covered.extend(covered.map(|covered| (place, covered)));
            raster.exchange(place, Some(Arc::new(raster.inherited(place))));
        }
    }

    /// Applies the brush to the pixels of a tile, with the coverage of one segment. Returns the range of the
    /// values of the tile before the stroke.
    fn stamp(
        &mut self,
        raster: &mut TiledRaster,
        place: TilePlace,
        mut coverage: Box<Tile>,
    ) -> Option<ValueRange> {
        self.before.keep(raster, place);
        let tile = raster.tile(place)?;
        let (covered, grown) = match self.covered.entry(place) {
            Entry::Vacant(entry) => {
                let covered = &*entry.insert(Covered::new(tile.clone(), coverage));
                (covered, &covered.coverage)
            }
            Entry::Occupied(entry) => {
                let covered = entry.into_mut();
                if !covered.grow(&mut coverage) {
                    // Nothing to paint, but the tile counts as drawn: a slice ends after a number of tiles.
                    return Some(covered.range);
                }
                (&*covered, &coverage)
            }
        };
        let (brush, blank, h_max) = (self.brush, raster.blank(), self.h_max);
        // The new value follows from the pixel before the stroke, not from its present value, so the order of
        // the segments does not matter.
        let paint = |coverage, old| brush.painted_value(coverage, old, blank, h_max);
        raster.change(place, |tile| paint_tile(tile, &covered.before, grown, paint));
        Some(covered.range)
    }
}

/// Paints the pixels of a tile whose coverage is not 0. `paint` returns the value for a coverage and the
/// value before.
fn paint_tile(tile: &mut Tile, before: &Tile, coverage: &Tile, paint: impl Fn(f32, f32) -> f32) {
    // Most pixels have the coverage and the value of the one before.
    let (mut last, mut painted) = ((0.0, f32::NAN), f32::NAN);
    let pixels = coverage.values().iter().zip(before.values());
    for (value, (&coverage, &old)) in tile.values_mut().iter_mut().zip(pixels) {
        if coverage > 0.0 {
            if last != (coverage, old) {
                (last, painted) = ((coverage, old), paint(coverage, old));
            }
            *value = painted;
        }
    }
}

/// Returns how many tiles the next segment of a stroke may have, where there are `tiles` already.
///
/// A line that is four thousand times as long as its radius has 16 pixels for the radius. If a person keeps
/// painting with a radius far below a pixel of the screen, pixels get coarser, so that memory grows slowly
/// even to a gigabyte: a tile and its share of the pyramid take 16 KB. A dab always has as many pixels as it
/// needs.
fn most_tiles_beside(tiles: usize) -> usize {
    const MANY: usize = 65_536;
    const OF_A_SEGMENT: RangeInclusive<usize> = 16..=4096;
    (MANY.saturating_sub(tiles) / 16).clamp(*OF_A_SEGMENT.start(), *OF_A_SEGMENT.end())
}

#[cfg(test)]
mod tests;
