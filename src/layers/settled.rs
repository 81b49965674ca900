//! Answers of the area rule for whole squares of triangles.

use super::engine::LEVELS;
use super::engine::asked::Share;
use super::engine::cells::Cells;
use super::{PaintLayers, SizeField};
use crate::geometry::{Lattice, LatticePoint};

/// What a size field asks for in squares of the lattice, as far as it was asked.
///
/// ```text
///   +-------------------+     a triangle and the dyadic square around it, four or eight times as wide:
///   |                   |     where all cells of the square and beside it ask for more than a level, or none
///   |      +----+       |     do, the same is true of every triangle of that level in the square
///   |      | \  |       |
///   |      +----+-------|
///   +-------------------+
/// ```
///
/// Triangles are asked about in the order of the bisection tree, so that one answer serves many of them. The
/// answers are those of one field and of paint that does not change.
#[derive(Clone, Debug)]
pub struct SettledSquares {
    /// At the place that a hash of the key says; another square there is forgotten.
    squares: Vec<Square>,
}

#[derive(Clone, Copy, Debug)]
struct Square {
    key: u64,
    /// Levels that were asked about, or follow from those.
    asked: u64,
    /// Levels than which all cells ask for more.
    all: u64,
    /// Levels than which no cell asks for more.
    none: u64,
}

/// The number of squares that are kept: 16 KB.
const KEPT_BITS: u32 = 9;
/// Triangles are asked about themselves where the least dyadic square around them has fewer than 2³ steps.
const LEAST_BITS: u32 = 3;
const EMPTY: Square = Square { key: u64::MAX, asked: 0, all: 0, none: 0 };

impl Default for SettledSquares {
    fn default() -> Self {
        Self { squares: vec![EMPTY; 1 << KEPT_BITS] }
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
        match self.settled(squares, paint, corners, level) {
            Share::All => true,
            Share::None => false,
            Share::Some => self.asks_for_more(paint, corners, level),
        }
    }

    /// Whether all or no triangles of the level around this one ask for more; [`Share::Some`] if that is not
    /// known.
    #[inline]
    fn settled(
        &self,
        squares: &mut SettledSquares,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> Share {
        let bits = self.square_bits().get(level as usize).map_or(0, |&bits| u32::from(bits));
        if bits == 0 {
            return Share::Some;
        }
        let [a, b, c] = corners;
        let [x, y] = [a.x.min(b.x).min(c.x) >> bits, a.y.min(b.y).min(c.y) >> bits];
        let key = u64::from(bits) << 58 | u64::from(x) << 29 | u64::from(y);
        let place = key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - KEPT_BITS);
        let square = &mut squares.squares[place as usize];
        if square.key != key {
            *square = Square { key, ..EMPTY };
        }
        let of_level = 1 << level;
        if square.asked & of_level == 0 {
            self.ask_about(square, paint, (bits, [x, y]), level);
        }
        if square.all & of_level != 0 {
            Share::All
        } else if square.none & of_level != 0 {
            Share::None
        } else {
            Share::Some
        }
    }

    #[cold]
    fn ask_about(
        &self,
        square: &mut Square,
        paint: &PaintLayers,
        (bits, [x, y]): (u32, [u32; 2]),
        level: u32,
    ) {
        let extent = self.lattice().extent();
        let (min, limit) =
            ([i64::from(x) << bits, i64::from(y) << bits], [extent.x, extent.y].map(i64::from));
        // Cells beside the square touch triangles on its border.
        let cells = Cells {
            min: min.map(|v| (v - 1).max(0)),
            max: [0, 1].map(|axis: usize| (min[axis] + (1 << bits) + 1).min(limit[axis])),
        };
        let (up_to, from) = ((2 << level) - 1, u64::MAX << level);
        square.asked |= 1 << level;
        match self.share_below(paint, &cells, level) {
            // Coarser levels are longer, finer ones shorter.
            Share::All => (square.all, square.asked) = (square.all | up_to, square.asked | up_to),
            Share::None => (square.none, square.asked) = (square.none | from, square.asked | from),
            Share::Some => {}
        }
    }

    /// Where some cells ask for more than a level, with gradation.
    fn share_below(&self, paint: &PaintLayers, cells: &Cells, level: u32) -> Share {
        if let Some(asks) = self.limits_decide(level) {
            return if asks { Share::All } else { Share::None };
        }
        match self.asks_in(paint, cells, level as usize) {
            // What is near can ask for more by gradation.
            Share::None if self.spec().gradation.is_some() => Share::Some,
            share => share,
        }
    }
}

/// The logarithm of the side of the squares for triangles of each level. 0 where triangles are asked about
/// one by one: those of few lattice steps, and those whose square would be wider than 2³¹ steps.
///
/// A triangle of level l lies in a dyadic square of δ / 2^⌊l/2⌋. There are few sizes, so that triangles of
/// several levels share squares.
pub(super) fn square_bits(lattice: &Lattice) -> [u8; LEVELS] {
    std::array::from_fn(|level| {
        let side = lattice.halvings().checked_sub(level as u32 / 2);
        let bits = side.filter(|&side| side >= LEAST_BITS).map_or(0, |side| (side / 2 + 1) * 2 + 1);
        if bits < u32::BITS { bits as u8 } else { 0 }
    })
}
