//! Changes tiles and updates the pyramid of ranges.

use std::ops::Index;
use std::sync::Arc;

use super::tile::{TILE_PIXELS, index};
use super::{TILE, Tile, TileNode, TilePlace, TiledRaster};
use crate::raster::{ValueRange, ValueRanges};

/// The ranges of 32 × 32 squares of one scale, row by row from the lowest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Summary([ValueRange; TILE_PIXELS]);

impl Index<usize> for Summary {
    type Output = ValueRange;

    #[inline]
    fn index(&self, index: usize) -> &ValueRange {
        &self.0[index]
    }
}

impl Summary {
    fn of(tile: &Tile) -> Self {
        Self(std::array::from_fn(|index| ValueRange::one(tile[index])))
    }

    fn blank(value: f32) -> Self {
        Self([ValueRange::one(value); TILE_PIXELS])
    }
}

/// Minimum and maximum column and row of some tiles of depth 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileExtent {
    min: [i32; 2],
    max: [i32; 2],
}

impl TileExtent {
    fn with(extent: Option<Self>, tile: [i32; 2]) -> Self {
        let Self { min, max } = extent.unwrap_or(Self { min: tile, max: tile });
        let pick = |a: [i32; 2], pick: fn(i32, i32) -> i32| [pick(a[0], tile[0]), pick(a[1], tile[1])];
        Self { min: pick(min, i32::min), max: pick(max, i32::max) }
    }

    /// Returns first and last square of a scale that has pixels of the tiles, [x, y] each.
    fn corners(&self, scale: i32) -> [[i32; 2]; 2] {
        let first = self.min.map(|n| (n * TILE) >> scale);
        [first, self.max.map(|n| (n * TILE + TILE - 1) >> scale)]
    }

    /// Returns the squares of a scale that have pixels of the tiles.
    pub(super) fn squares(&self, scale: i32) -> impl Iterator<Item = [i32; 2]> + use<> {
        let [[left, low], [right, high]] = self.corners(scale);
        (low..=high).flat_map(move |y| (left..=right).map(move |x| [x, y]))
    }

    /// Returns the scale at which at most 2 × 2 squares have all pixels of the tiles.
    fn coarsest(&self) -> i32 {
        let fits = |&scale: &i32| {
            let [first, last] = self.corners(scale);
            last[0] - first[0] <= 1 && last[1] - first[1] <= 1
        };
        (0..31).find(fits).expect("pixels are within ± 2³⁰")
    }
}

/// A rectangle of squares of one scale within a block of 32 × 32, beginning at [x, y].
#[derive(Clone, Copy)]
struct SquareRange {
    x: i32,
    y: i32,
    side: i32,
}

impl SquareRange {
    const WHOLE: Self = Self { x: 0, y: 0, side: TILE };

    /// Returns the squares of the next coarser scale that cover these, of the block [x, y].
    fn coarser(self, [x, y]: [i32; 2]) -> Self {
        let half = TILE / 2;
        let side = (self.side / 2).max(1);
        Self { x: (x & 1) * half + self.x / 2, y: (y & 1) * half + self.y / 2, side }
    }

    fn squares(self) -> impl Iterator<Item = (i32, i32)> {
        let columns = self.x..self.x + self.side;
        (self.y..self.y + self.side).flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }

    /// Returns the ranges of these squares, in the order of [`Self::squares`], from those of their quarters:
    /// `quarters` has them, or values, for a block of 32 × 32.
    #[inline]
    fn joined<T: Copy>(
        self,
        quarters: &[T; TILE_PIXELS],
        range: impl Fn(T) -> ValueRange,
    ) -> Vec<ValueRange> {
        let mut ranges = Vec::with_capacity((self.side * self.side) as usize);
        for y in self.y..self.y + self.side {
            let pairs = |y| {
                let first = index(2 * self.x, y);
                quarters[first..first + 2 * self.side as usize].as_chunks().0.iter()
            };
            ranges.extend(pairs(2 * y).zip(pairs(2 * y + 1)).map(|(&[a, b], &[c, d])| {
                let [a, b, c, d] = [a, b, c, d].map(&range);
                a.union(b).union(c.union(d))
            }));
        }
        ranges
    }
}

impl TiledRaster {
    /// Puts a tile at a place, or removes the tile there, and returns the former one.
    ///
    /// # Panics
    /// Panics when the place is beyond the limits of `TilePlace::is_valid`, a new tile has no parent, or a
    /// tile to remove has children.
    pub fn exchange(&mut self, place: TilePlace, tile: Option<Arc<Tile>>) -> Option<Arc<Tile>> {
        assert!(place.is_valid(), "{place:?} is checked where it is read");
        let is_new = tile.is_some();
        let old = match tile {
            Some(tile) => self.put(place, tile),
            None => self.remove(place),
        };
        if old.is_none() && !is_new {
            return None;
        }
        if place.depth == 0 {
            self.fit_scales([place.x, place.y]);
        }
        self.summarize_above(place);
        self.whole = self.range_of_all();
        old
    }

    /// Changes the pixels of the tile at a place. Does nothing if there is no tile.
    pub fn change(&mut self, place: TilePlace, change: impl FnOnce(&mut Tile)) {
        if self.tile(place).is_none() {
            return;
        }
        if let Some(node) = self.node_mut(usize::from(place.depth), [place.x, place.y]) {
            change(Arc::make_mut(&mut node.tile));
        }
        self.summarize(place);
        self.summarize_above(place);
        self.whole = self.range_of_all();
    }

    fn put(&mut self, place: TilePlace, tile: Arc<Tile>) -> Option<Arc<Tile>> {
        assert!(place.parent().is_none_or(|parent| self.tile(parent).is_some()), "{place:?} has no parent");
        let depth = usize::from(place.depth);
        if self.depths.len() == depth {
            self.depths.push(Arc::default());
        }
        if let Some(node) = self.node_mut(depth, [place.x, place.y]) {
            let old = std::mem::replace(&mut node.tile, tile);
            self.summarize(place);
            return Some(old);
        }
        let tiles = Arc::make_mut(&mut self.depths[depth]);
        tiles.get_or_insert(place.x, place.y, || TileNode { tile, summary: None });
        None
    }

    fn remove(&mut self, place: TilePlace) -> Option<Arc<Tile>> {
        let depth = usize::from(place.depth);
        let removed = Arc::make_mut(self.depths.get_mut(depth)?).remove(place.x, place.y)?;
        assert!(removed.summary.is_none(), "the children of {place:?} are removed first");
        while self.depths.last().is_some_and(|tiles| tiles.is_empty()) {
            self.depths.pop();
        }
        Some(removed.tile)
    }

    /// Adjusts the number of scales to the tiles of depth 0, after the tile [x, y] of depth 0 changed.
    ///
    /// Scales that are no longer needed stay until the last tile is removed: finding the extent again would
    /// take a pass over all tiles.
    fn fit_scales(&mut self, tile: [i32; 2]) {
        if self.depths.is_empty() {
            self.extent = None;
            self.scales.clear();
        } else if self.tile(TilePlace { depth: 0, x: tile[0], y: tile[1] }).is_some() {
            let extent = TileExtent::with(self.extent, tile);
            self.extent = Some(extent);
            while self.coarsest() < extent.coarsest() {
                self.add_scale();
            }
        }
    }

    fn add_scale(&mut self) {
        let scale = self.coarsest();
        let blocks: Vec<[i32; 2]> = match scale {
            0 => self.depths[0].iter().map(|(block, _)| block).collect(),
            _ => self.scales[scale as usize - 1].iter().map(|(block, _)| block).collect(),
        };
        self.scales.push(Arc::default());
        for block in blocks {
            self.summarize_part(scale, block, SquareRange::WHOLE);
        }
    }

    /// Computes the ranges of a tile's own pixels again, if it has children.
    fn summarize(&mut self, place: TilePlace) {
        let children = place.children().into_iter().filter(|child| self.tile(*child).is_some());
        let children: Vec<TilePlace> = children.collect();
        if let Some(node) = self.node_mut(usize::from(place.depth), [place.x, place.y]) {
            node.summary = None;
        }
        for child in children {
            self.summarize_part(-i32::from(child.depth), [child.x, child.y], SquareRange::WHOLE);
        }
    }

    /// Updates the ranges of all coarser scales after a tile changed.
    fn summarize_above(&mut self, place: TilePlace) {
        let (mut scale, mut block, mut part) =
            (-i32::from(place.depth), [place.x, place.y], SquareRange::WHOLE);
        while scale < self.coarsest() && self.summarize_part(scale, block, part) {
            part = part.coarser(block);
            block = block.map(|n| n >> 1);
            scale += 1;
        }
    }

    /// Updates the ranges of the squares of the next coarser scale that cover a part of a block. Returns
    /// whether they changed.
    fn summarize_part(&mut self, scale: i32, block: [i32; 2], part: SquareRange) -> bool {
        let coarser = part.coarser(block);
        let ranges = self.coarser_ranges(scale, block, coarser);
        let above = block.map(|n| n >> 1);
        let is_covered =
            (0..4).any(|n| self.has_block(scale, [2 * above[0] + (n & 1), 2 * above[1] + (n >> 1)]));
        let blank = self.blank;
        let summary = if scale < 0 {
            let node = self.node_mut(-(scale + 1) as usize, above).expect("a tile has its ancestors");
            if !is_covered {
                return node.summary.take().is_some();
            }
            node.summary.get_or_insert_with(|| Arc::new(Summary::of(&node.tile)))
        } else {
            let blocks = Arc::make_mut(&mut self.scales[scale as usize]);
            if !is_covered {
                return blocks.remove(above[0], above[1]).is_some();
            }
            blocks.get_or_insert(above[0], above[1], || Arc::new(Summary::blank(blank)))
        };
        let differs = coarser.squares().zip(&ranges).any(|((x, y), range)| summary[index(x, y)] != *range);
        if differs {
            let summary = &mut Arc::make_mut(summary).0;
            coarser.squares().zip(ranges).for_each(|((x, y), range)| summary[index(x, y)] = range);
        }
        differs
    }

    /// Returns the ranges of the squares in `coarser` of the block above `block`, which is a block of the
    /// given scale. They are computed from this block, or without it if it does not exist.
    fn coarser_ranges(&self, scale: i32, block: [i32; 2], coarser: SquareRange) -> Vec<ValueRange> {
        let [x, y] = block;
        let at = |depth: i32, x, y| self.depths.get(depth as usize).and_then(|tiles| tiles.get(x, y));
        let node = if scale <= 0 { at(-scale, x, y) } else { None };
        let summary = if scale > 0 { self.scales[scale as usize - 1].get(x, y) } else { None };
        let parent = if scale < 0 { at(-scale - 1, x >> 1, y >> 1) } else { None };
        let blank = ValueRange::one(self.blank);
        match (node, summary) {
            (Some(TileNode { tile, summary: None }), _) => coarser.joined(tile.array(), ValueRange::one),
            (Some(TileNode { summary: Some(summary), .. }), _) | (None, Some(summary)) => {
                coarser.joined(&summary.0, |range| range)
            }
            (None, None) => {
                let without = |(x, y)| parent.map_or(blank, |node| ValueRange::one(node.tile[index(x, y)]));
                coarser.squares().map(without).collect()
            }
        }
    }

    /// Returns the range of the values in a square above the coarsest scale.
    pub(super) fn range_beyond(&self, scale: i32, x: i32, y: i32) -> ValueRange {
        let coarsest = self.coarsest();
        let up = (scale - coarsest).min(31);
        let squares = self.extent.iter().flat_map(|extent| extent.squares(coarsest));
        let within = squares.filter(|square| square.map(|n| n >> up) == [x, y]);
        let ranges = within.map(|[x, y]| (self.range(coarsest, x, y), 1));
        let found = ranges.reduce(|(a, m), (b, n)| (a.union(b), m + n));
        // At most 2 × 2 squares have pixels. They fill a square of the next scale, or they do not.
        let is_filled = up == 1 && found.is_some_and(|(_, count)| count == 4);
        let range = found.map(|(range, _)| range);
        let blank = (!is_filled).then_some(ValueRange::one(self.blank));
        range.into_iter().chain(blank).reduce(ValueRange::union).expect("a filled square has a range")
    }

    fn has_block(&self, scale: i32, [x, y]: [i32; 2]) -> bool {
        if scale > 0 {
            self.scales[scale as usize - 1].contains(x, y)
        } else {
            self.depths.get(-scale as usize).is_some_and(|tiles| tiles.contains(x, y))
        }
    }

    fn node_mut(&mut self, depth: usize, [x, y]: [i32; 2]) -> Option<&mut TileNode> {
        Arc::make_mut(self.depths.get_mut(depth)?).get_mut(x, y)
    }
}
