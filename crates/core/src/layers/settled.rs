//! Answers of the area rule for whole squares of triangles.

use super::engine::cells::Cells;
use super::engine::gradation::graded_bounds;
use super::engine::{KnownSquares, LEVELS};
use super::{PaintLayers, SizeField};
use crate::field::Transfer;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::LevelsWithin;

/// What a size field asks for in squares of the lattice, as far as it was asked.
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
pub struct SettledSquares {
    /// At the place that a hash of the key says; another square there is forgotten.
    squares: Vec<Square>,
    /// For gradation.
    pub(super) known: KnownSquares,
}

#[derive(Clone, Copy, Debug)]
struct Square {
    key: u64,
    /// What is known of all triangles within.
    levels: LevelsWithin,
}

/// The number of squares that are kept: 8 KB.
const KEPT_BITS: u32 = 9;
/// Triangles are asked about themselves where the dyadic square around them has fewer than 2³ steps.
const LEAST_BITS: u32 = 3;
/// Triangles that are asked about one by one first look at squares 2⁴ times as wide.
const WIDER_BITS: u32 = 4;

impl Default for SettledSquares {
    fn default() -> Self {
        let empty = Square { key: u64::MAX, levels: LevelsWithin::UNKNOWN };
        Self { squares: vec![empty; 1 << KEPT_BITS], known: KnownSquares::default() }
    }
}

impl SizeField {
    /// [`SizeField::asks_for_more`], faster for many triangles nearby. `squares` must have been used for this
    /// field and these pixels only.
    #[inline]
    pub fn asks_for_more_nearby(
        &self,
        squares: &mut SettledSquares,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> bool {
        // Most triangles of a mesh are far from any change of h̄: one answer serves hundreds of them.
        let settled = [WIDER_BITS, 0].into_iter().find_map(|wider| {
            let levels = self.settled(squares, paint, corners, level, wider);
            levels.exceeds(level)
        });
        settled.unwrap_or_else(|| self.asks_with(&mut squares.known, paint, corners, level))
    }

    /// What the area rule says of a triangle and of all triangles within. `squares` must have been used for
    /// this field and these pixels only.
    #[inline]
    pub fn levels_within(
        &self,
        squares: &mut SettledSquares,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> LevelsWithin {
        let settled = self.settled(squares, paint, corners, level, 0);
        settled.decided_at(level, || self.asks_with(&mut squares.known, paint, corners, level))
    }

    /// What is known of all triangles in the square around one of this level, or in one that is 2^wider times
    /// as wide.
    #[inline]
    fn settled(
        &self,
        squares: &mut SettledSquares,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
        wider: u32,
    ) -> LevelsWithin {
        let bits = self.square_bits().get(level as usize).map_or(0, |&bits| u32::from(bits));
        if bits == 0 {
            return LevelsWithin::UNKNOWN;
        }
        let bits = (bits + wider).min(u32::BITS - 1);
        let [a, b, c] = corners;
        let [x, y] = [a.x.min(b.x).min(c.x) >> bits, a.y.min(b.y).min(c.y) >> bits];
        let key = u64::from(bits) << 58 | u64::from(x) << 29 | u64::from(y);
        let place = key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - KEPT_BITS);
        let SettledSquares { squares, known } = squares;
        let square = &mut squares[place as usize];
        if square.key != key {
            *square = Square { key, levels: self.levels_in_square(known, paint, bits, [x, y]) };
        }
        square.levels
    }

    /// What is known of all triangles in a dyadic square of 2^bits steps.
    #[cold]
    fn levels_in_square(
        &self,
        known: &mut KnownSquares,
        paint: &PaintLayers,
        bits: u32,
        [x, y]: [u32; 2],
    ) -> LevelsWithin {
        let extent = self.lattice().extent();
        let (min, limit) =
            ([i64::from(x) << bits, i64::from(y) << bits], [extent.x, extent.y].map(i64::from));
        // Cells beside the square touch triangles on its border.
        let cells = Cells {
            min: min.map(|v| (v - 1).max(0)),
            max: [0, 1].map(|axis: usize| (min[axis] + (1 << bits) + 1).min(limit[axis])),
        };
        let ([least, greatest], _) = self.asked_diameters(paint, &cells);
        let Transfer { h_min, h_max, .. } = self.spec().transfer;
        let [least, greatest] = [least, greatest].map(|diameter| diameter.clamp(h_min, h_max));
        let [least, greatest] = match self.spec().gradation {
            None => [least, greatest],
            Some(slope) => {
                let is_level =
                    |[low, high]: [f64; 2]| self.first_level_within(low) == self.first_level_within(high);
                graded_bounds(self, paint, known, &cells, slope, [least, greatest], is_level)
            }
        };
        LevelsWithin {
            exceed_below: self.first_level_within(greatest),
            satisfied_from: self.first_level_within(least),
        }
    }

    /// The first level whose triangles are no longer than a diameter in world units.
    fn first_level_within(&self, diameter: f64) -> u32 {
        self.lengths().partition_point(|&length| length > diameter) as u32
    }
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
