use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::ops::RangeInclusive;
use std::sync::Arc;

use glam::DVec2;

use super::patch::range_of;
use super::resolution::Segment;
use super::{Brush, Mirror, Patch, PathPoint, Repaint};
use crate::geometry::Rect;
use crate::raster::{TILE, Tile, TilePlace, TiledRaster, ValueRange, ValueRanges, power_of_two};

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
    /// The pixels of the tile before the stroke.
    before: Arc<Tile>,
    /// The largest coverage of each pixel so far, 0 to 1.
    coverage: Tile,
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
    /// ignored.
    pub fn extend(&mut self, raster: &TiledRaster, point: impl Into<PathPoint>) {
        let point = point.into();
        if point.is_finite() {
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
        let coverage = coverage_of_tile(segment, place, raster)?;
        self.deepen(raster, place);
        let before = self.stamp(raster, place, &coverage)?;
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
            let covered = covered.map(|parent| Covered {
                before: Arc::new(parent.before.enlarged(&place)),
                coverage: parent.coverage.enlarged(&place),
            });
            self.covered.extend(covered.map(|covered| (place, covered)));
            raster.exchange(place, Some(Arc::new(raster.inherited(place))));
        }
    }

    /// Applies the brush to the pixels of a tile, with the coverage of one segment. Returns the range of the
    /// values of the tile before the stroke.
    fn stamp(&mut self, raster: &mut TiledRaster, place: TilePlace, coverage: &Tile) -> Option<ValueRange> {
        self.before.keep(raster, place);
        let tile = raster.tile(place)?;
        let touched = self
            .covered
            .entry(place)
            .or_insert_with(|| Covered { before: tile.clone(), coverage: Tile::filled(0.0) });
        let (brush, blank, h_max) = (self.brush, raster.blank(), self.h_max);
        raster.change(place, |tile| {
            for (index, &coverage) in coverage.values().iter().enumerate() {
                if coverage > touched.coverage[index] {
                    // The new value follows from the pixel before the stroke, not from its present value, so
                    // the order of the segments does not matter.
                    touched.coverage[index] = coverage;
                    tile[index] = brush.painted_value(coverage, touched.before[index], blank, h_max);
                }
            }
        });
        Some(range_of(&touched.before))
    }
}

/// Returns how many tiles the next segment of a stroke may have, where there are `tiles` already.
///
/// A line that is four thousand times as long as its radius has 16 pixels for the radius. Where a person
/// paints on and on with a radius that is far below a pixel of the screen, pixels get coarser: a tile and
/// what is kept of it above take 16 KB, and so a gigabyte is reached slowly. A dab always has as many pixels
/// as it needs.
fn most_tiles_beside(tiles: usize) -> usize {
    const MANY: usize = 65_536;
    const OF_A_SEGMENT: RangeInclusive<usize> = 16..=4096;
    (MANY.saturating_sub(tiles) / 16).clamp(*OF_A_SEGMENT.start(), *OF_A_SEGMENT.end())
}

/// Returns the coverage of each pixel of a tile by a segment; `None` if it is 0 everywhere.
fn coverage_of_tile(segment: &Segment, place: TilePlace, raster: &TiledRaster) -> Option<Tile> {
    let grid = raster.grid();
    let pixel = grid.pixel * power_of_two(-i32::from(place.depth));
    let first = DVec2::new(f64::from(place.x), f64::from(place.y)) * f64::from(TILE) + 0.5;
    let mut tile = Tile::filled(0.0);
    let [[left, lowest], [right, top]] = segment.pixels(place, grid);
    let mut is_covered = false;
    for (y, x) in (lowest..top).flat_map(|y| (left..right).map(move |x| (y, x))) {
        let center = grid.origin + (first + DVec2::new(f64::from(x), f64::from(y))) * pixel;
        let coverage = segment.coverage(center) as f32;
        is_covered |= coverage > 0.0;
        tile.set(x, y, coverage);
    }
    is_covered.then_some(tile)
}

#[cfg(test)]
mod tests;
