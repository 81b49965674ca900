//! Memoizes the answers of the area rule for whole squares of triangles.

use std::sync::{Mutex, MutexGuard, PoisonError};

use super::engine::Nearby;
use super::engine::cells::Cells;
use super::engine::gradation::{GradedBounds, graded_bounds};
use super::engine::parts::{LatticeSquare, PartId};
use super::engine::{CompiledLayer, KnownParts};
use super::{PaintLayers, SizeField};
use crate::earth::LEVELS;
use crate::field::Transfer;
use crate::geometry::{Lattice, LatticePoint, Rect};
use crate::mesh::LevelsWithin;

/// A cache of the answers of a size field: the range of levels that each dyadic square of the lattice asks
/// for.
///
/// ```text
///   +-----------+     A triangle and the dyadic square around it, in which its sibling and its descendants
///   | \         |     lie too. The range of what the square and the cells beside it ask for says for most
///   |   \       |     levels whether all triangles of that level in the square exceed their target, or none.
///   |     \     |
///   |       \   |
///   +-----------+
/// ```
///
/// A mesh is made from the top of the bisection tree down. There, wider squares would leave more triangles
/// undecided. An update asks about the triangles of a finished mesh, and wide squares decide most of them.
///
/// The answers are those of one field and of paint that does not change.
#[derive(Clone, Debug)]
pub struct LevelCache {
    /// The squares, at the index from a hash; a new square replaces another one there.
    squares: Vec<Settled>,
    /// The known parts for gradation.
    pub(super) known: KnownParts,
}

#[derive(Clone, Debug)]
struct Settled {
    /// `None` before the first use.
    square: Option<LatticeSquare>,
    /// The known answers for all triangles within the square.
    levels: LevelsWithin,
    /// h̄ is between these everywhere in the square, in world units.
    bounds: [f64; 2],
    /// No point of a cell that touches a triangle within asks for less, in world units.
    least_asked: f64,
    /// The parts of the lattice from which gradation can carry to triangles within.
    sources: Vec<PartId>,
}

/// The number of squares that are kept, at least 32 KB.
const KEPT_BITS: u32 = 9;
/// Triangles are asked about themselves where the dyadic square around them has fewer than 2³ steps.
const LEAST_BITS: u32 = 3;
/// Triangles that are asked about one by one first look at squares 2⁴ times as wide, and squares look for
/// sources among those of one that is so much wider.
const WIDER_BITS: u32 = 4;

impl Settled {
    const EMPTY: Self = Self {
        square: None,
        levels: LevelsWithin::UNKNOWN,
        bounds: [0.0, f64::INFINITY],
        least_asked: 0.0,
        sources: Vec::new(),
    };
}

impl Default for LevelCache {
    fn default() -> Self {
        Self { squares: vec![Settled::EMPTY; 1 << KEPT_BITS], known: KnownParts::default() }
    }
}

impl LevelCache {
    /// Forgets everything if a lot is known.
    pub(super) fn make_room(&mut self) {
        if self.known.make_room() {
            self.squares.fill(Settled::EMPTY);
        }
    }
}

/// Caches for the threads that ask a size field at the same time. A thread takes one and puts it back, so
/// that what was found out serves the next questions.
#[derive(Debug, Default)]
pub struct LevelCachePool(Mutex<Vec<LevelCache>>);

impl LevelCachePool {
    /// Returns a cache, an empty one where all are in use.
    pub(crate) fn take(&self) -> LevelCache {
        self.squares().pop().unwrap_or_default()
    }

    /// Puts a cache back.
    pub(crate) fn put_back(&self, squares: LevelCache) {
        self.squares().push(squares);
    }

    /// Returns all caches, while no thread uses one.
    pub(crate) fn all_mut(&mut self) -> &mut [LevelCache] {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    fn squares(&self) -> MutexGuard<'_, Vec<LevelCache>> {
        // A thread that panicked left the list as it was.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Clone for LevelCachePool {
    fn clone(&self) -> Self {
        Self(Mutex::new(self.squares().clone()))
    }
}

impl SizeField {
    /// Returns how many questions to the field are worth another thread, as far as its kind says that: with
    /// gradation or formulas, a few.
    pub(crate) fn questions_per_thread(&self) -> usize {
        match self.stack.slope() {
            Some(_) => 16,
            None if self.stack.layers().iter().all(CompiledLayer::has_pixels) => 8192,
            None => 512,
        }
    }

    /// Lets squares that were used for this field forget what they know of places at which pixels have
    /// changed: `areas` are rectangles in world units.
    pub(crate) fn forget(&self, squares: &mut LevelCache, areas: impl Iterator<Item = Rect>) {
        squares.squares.iter_mut().for_each(|square| square.square = None);
        areas.filter_map(|area| self.core(&area)).for_each(|cells| squares.known.forget(&cells));
    }

    /// [`SizeField::asks_for_more`], faster for many triangles nearby. `squares` must have been used for this
    /// field and these pixels only.
    #[inline]
    pub fn asks_for_more_nearby(
        &self,
        squares: &mut LevelCache,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> bool {
        let Some(square) = self.square_around(corners, level) else {
            squares.make_room();
            return self.stack.asks_with(&mut squares.known, paint, corners, level, None);
        };
        // Most triangles of a mesh are far from any change of h̄: one answer serves hundreds of them.
        let wider = square.around((square.bits + WIDER_BITS).min(u32::BITS - 1));
        let place = self.settled(squares, paint, wider);
        squares.squares[place].levels.exceeds(level).unwrap_or_else(|| {
            self.levels_within(squares, paint, corners, level).exceeds(level) == Some(true)
        })
    }

    /// Returns the answers of the area rule for a triangle and for all triangles within it. `squares` must
    /// have been used for this field and these pixels only.
    #[inline]
    pub fn levels_within(
        &self,
        squares: &mut LevelCache,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> LevelsWithin {
        let Some(square) = self.square_around(corners, level) else {
            squares.make_room();
            return LevelsWithin::UNKNOWN
                .decided_at(level, || self.stack.asks_with(&mut squares.known, paint, corners, level, None));
        };
        if let Some(levels) = self.levels_by_pixels(squares, paint, (corners, level), square) {
            return levels;
        }
        let place = self.settled(squares, paint, square);
        let levels = squares.squares[place].levels;
        levels.decided_at(level, || self.asks_within(squares, place, paint, corners, level))
    }

    /// Returns the answers for a triangle and all triangles within it from the pixels that touch it, unless
    /// something is known of its square. `None` where pixels alone do not answer, or are too many.
    #[inline]
    fn levels_by_pixels(
        &self,
        squares: &LevelCache,
        paint: &PaintLayers,
        (corners, level): ([LatticePoint; 3], u32),
        square: LatticeSquare,
    ) -> Option<LevelsWithin> {
        if !self.stack.has_pixels_only() || squares.squares[place_of(square)].square == Some(square) {
            return None;
        }
        let (asked, exceeds) = self.stack.asked_by_pixels(paint, corners, level)?;
        Some(self.levels_between(asked, square).decided_at(level, || exceeds))
    }

    /// Returns the answers for the triangles in a square whose h̄ is between two diameters everywhere.
    fn levels_between(&self, [least, greatest]: [f64; 2], square: LatticeSquare) -> LevelsWithin {
        let Transfer { h_min, h_max, .. } = self.spec().transfer;
        let [least, greatest] = [least, greatest].map(|diameter| diameter.clamp(h_min, h_max));
        let lengths = self.edge_lengths();
        let [band, last_band] = lengths.bands_in(square.bits, [square.column, square.row]);
        LevelsWithin {
            exceed_below: lengths.first_level_within(last_band, greatest),
            satisfied_from: lengths.first_level_within(band, least),
        }
    }

    /// Returns the answer for a triangle in a square that has not settled it.
    fn asks_within(
        &self,
        squares: &mut LevelCache,
        place: usize,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> bool {
        let Settled { least_asked, sources, .. } = &squares.squares[place];
        let nearby = Nearby { least_asked: *least_asked, sources };
        self.stack.asks_with(&mut squares.known, paint, corners, level, Some(nearby))
    }

    /// Returns the dyadic square around a triangle, unless that has few lattice steps.
    #[inline]
    fn square_around(&self, [a, b, c]: [LatticePoint; 3], level: u32) -> Option<LatticeSquare> {
        let bits = self.square_bits().get(level as usize).map_or(0, |&bits| u32::from(bits));
        let [column, row] = [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)].map(|v| v.unbounded_shr(bits));
        (bits > 0).then_some(LatticeSquare { bits, column, row })
    }

    /// Returns the bounds of h̄ in a wide square around a triangle with any corners; `None` where there is
    /// none that is not much larger.
    pub(super) fn bounds_around(
        &self,
        squares: &mut LevelCache,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
    ) -> Option<[f64; 2]> {
        let [x, y] =
            [corners.map(|c| c.x), corners.map(|c| c.y)].map(|[a, b, c]| [a.min(b).min(c), a.max(b).max(c)]);
        let side = (x[1] - x[0]).max(y[1] - y[0]).max(1 << LEAST_BITS);
        let bits = side.next_power_of_two().ilog2() + WIDER_BITS;
        let [column, row] = [x, y].map(|[low, _]| low.unbounded_shr(bits));
        let is_within = [x, y].map(|[_, high]| high.unbounded_shr(bits)) == [column, row];
        (is_within && bits < u32::BITS).then(|| {
            let place = self.settled(squares, paint, LatticeSquare { bits, column, row });
            squares.squares[place].bounds
        })
    }

    /// Returns the place of what is known of all triangles in a square.
    #[inline]
    fn settled(&self, squares: &mut LevelCache, paint: &PaintLayers, square: LatticeSquare) -> usize {
        let place = place_of(square);
        if squares.squares[place].square != Some(square) {
            self.settle(squares, paint, square);
        }
        place
    }

    /// Finds out about all triangles in a square.
    #[cold]
    fn settle(&self, squares: &mut LevelCache, paint: &PaintLayers, square: LatticeSquare) {
        squares.make_room();
        let found = match self.stack.slope() {
            None => self.settle_from(&[], &mut squares.known, paint, square),
            Some(_) => {
                let bits = square.bits + WIDER_BITS;
                if bits >= LatticeSquare::whole(self.lattice().extent()).bits {
                    let whole = squares.known.whole(&self.stack);
                    self.settle_from(&[whole], &mut squares.known, paint, square)
                } else {
                    let wider = self.settled(squares, paint, square.around(bits));
                    let LevelCache { squares, known } = squares;
                    self.settle_from(&squares[wider].sources, known, paint, square)
                }
            }
        };
        squares.squares[place_of(square)] = found;
    }

    /// Finds the same, from the sources of a wider square.
    fn settle_from(
        &self,
        sources: &[PartId],
        known: &mut KnownParts,
        paint: &PaintLayers,
        square: LatticeSquare,
    ) -> Settled {
        let LatticeSquare { bits, column, row } = square;
        let extent = self.lattice().extent();
        let (min, limit) =
            ([i64::from(column) << bits, i64::from(row) << bits], [extent.x, extent.y].map(i64::from));
        // Cells beside the square touch triangles on its border.
        let cells = Cells {
            min: min.map(|v| (v - 1).max(0)),
            max: [0, 1].map(|axis: usize| (min[axis] + (1 << bits) + 1).min(limit[axis])),
        };
        let ([least, greatest], _) = self.stack.asked_diameters(paint, &cells);
        let Transfer { h_min, h_max, .. } = self.spec().transfer;
        let [least, greatest] = [least, greatest].map(|diameter| diameter.clamp(h_min, h_max));
        let lengths = self.edge_lengths();
        let [band, _] = lengths.bands_in(bits, [column, row]);
        let bounds = match self.stack.slope() {
            None => GradedBounds { least, greatest, sources: Vec::new() },
            Some(slope) => {
                let is_level = |bounds: [f64; 2]| {
                    let [low, high] = bounds.map(|diameter| lengths.first_level_within(band, diameter));
                    low == high
                };
                graded_bounds(
                    &self.stack,
                    paint,
                    known,
                    (&cells, sources),
                    slope,
                    [least, greatest],
                    is_level,
                )
            }
        };
        let between = [bounds.least, bounds.greatest];
        let levels = self.levels_between(between, square);
        let (square, sources) = (Some(square), bounds.sources);
        Settled { square, levels, bounds: between, least_asked: least, sources }
    }
}

/// Returns the place at which a square is kept.
#[inline]
fn place_of(LatticeSquare { bits, column, row }: LatticeSquare) -> usize {
    let key = u64::from(bits) << 58 | u64::from(column) << 29 | u64::from(row);
    (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - KEPT_BITS)) as usize
}

/// The logarithm of the side of the squares for triangles of each level. 0 where triangles are asked about
/// one by one, because they have few lattice steps.
///
/// A triangle of level l lies in a dyadic square of δ / 2^⌊l/2⌋.
pub(super) fn square_bits(lattice: &Lattice) -> [u8; LEVELS] {
    std::array::from_fn(|level| {
        let side = lattice.halvings().checked_sub(level as u32 / 2);
        side.filter(|&side| side >= LEAST_BITS).map_or(0, |side| side as u8)
    })
}
