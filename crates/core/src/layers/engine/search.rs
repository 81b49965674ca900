//! Whether some cell that touches a triangle asks for more than its level.

use crate::geometry::Octagon;
use crate::raster::{ValueRange, ValueRanges};

use super::asked::Share;
use super::cells::{Cells, Cut, GridOnLattice};
use super::pixels::range_touching;
use super::reading::Question;

/// Returns whether a cell of `cells` that touches the closed triangle asks, by dividing the rectangle where
/// `ask` says so.
///
/// `ask` answers for all cells of a rectangle: where they ask for more, and where to divide the rectangle to
/// know more. It must give a cut wherever the answer is [`Share::Some`].
///
/// Where two layers change along one line, as at the rim of a mask that they share, cells on the line can
/// stay undecided to the last. So the search ends after [`MOST_ASKED`] rectangles, with no cell found.
pub fn any_cell(
    triangle: &Octagon,
    cells: Cells,
    ask: &mut impl FnMut(&Cells) -> (Share, Option<Cut>),
) -> bool {
    let mut left = vec![cells];
    for _ in 0..MOST_ASKED {
        let Some(cells) = left.pop() else { return false };
        if !triangle.meets(&cells.octagon()) {
            continue;
        }
        match ask(&cells) {
            (Share::None, _) => {}
            (Share::All, _) => return true,
            (Share::Some, cut) => {
                let [low, high] = cells.divided(cut.expect("an undecided rectangle has a cut"));
                left.extend([high, low]);
            }
        }
    }
    false
}

/// The number of rectangles after which [`any_cell`] ends.
const MOST_ASKED: usize = 1 << 16;

/// A search in one raster, square by square of its own.
pub struct RasterSearch<'a, R> {
    pub raster: &'a R,
    pub grid: &'a GridOnLattice,
    pub question: Question<'a>,
}

impl<R: ValueRanges> RasterSearch<'_, R> {
    /// Returns whether a pixel that touches the closed triangle asks for more than the level in question.
    /// `cells` are those around the triangle.
    ///
    /// It starts at the scale where the triangle spans at most two squares along both axes, skips squares
    /// whose values do not ask or that do not touch the triangle, and ends at a square that asks. Where a
    /// square does not decide and the triangle spans few pixels, it looks at all of these.
    #[inline]
    pub fn any(&self, triangle: &Octagon, cells: &Cells) -> bool {
        if self.question.asks(self.raster.whole_range()) == Share::None {
            return false;
        }
        let scale = self.grid.scale_of(cells).max(self.raster.finest());
        let [low, high] = self.grid.squares(scale, cells);
        let mut may_read_pixels = true;
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                match self.square((triangle, cells), scale, [x, y], || self.grid.square(scale, x, y)) {
                    Square::Asks => return true,
                    Square::DoesNot => {}
                    Square::Undecided(square) => {
                        if may_read_pixels && let Some(range) = self.range_touching(triangle, cells) {
                            return self.question.asks(range) != Share::None;
                        }
                        // They are those of the whole triangle: another square would not tell more.
                        may_read_pixels = false;
                        if self.any_quarter((triangle, cells), scale, [x, y], &square) {
                            return true;
                        }
                    }
                }
            }
        }
        false
    }

    /// Returns what is known of the square [x, y] at a scale, which has these cells. `around` are the cells
    /// of the lattice around the triangle: a square beside the lattice can touch the triangle, and does not
    /// count.
    #[inline]
    fn square(
        &self,
        (triangle, around): (&Octagon, &Cells),
        scale: i32,
        [x, y]: [i64; 2],
        cells: impl FnOnce() -> Cells,
    ) -> Square {
        // Most squares are decided by their values.
        let asks = self.question.asks(self.raster.range_anywhere(scale, [x, y]));
        if asks == Share::None {
            return Square::DoesNot;
        }
        let cells = cells();
        let octagon = cells.octagon();
        // A square between two lattice lines has no cell.
        if cells.intersection(around).is_none() || !triangle.meets(&octagon) {
            return Square::DoesNot;
        }
        if asks == Share::All || (self.question.is_monotone() && triangle.contains(&octagon)) {
            return Square::Asks;
        }
        Square::Undecided(cells)
    }

    /// Returns the range of the pixels that touch the triangle, where that answers the question and they are
    /// few.
    fn range_touching(&self, triangle: &Octagon, around: &Cells) -> Option<ValueRange> {
        self.question.is_monotone().then(|| range_touching(self.raster, self.grid, triangle, around))?
    }

    /// Searches the quarters of a square.
    fn any_quarter(&self, around: (&Octagon, &Cells), scale: i32, [x, y]: [i64; 2], cells: &Cells) -> bool {
        let middle = self.grid.middle(scale, [x, y]);
        [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().any(|[i, j]| {
            let (scale, place) = (scale - 1, [2 * x + i, 2 * y + j]);
            let quarter = || cells.quarter(middle, [i == 1, j == 1]);
            match self.square(around, scale, place, quarter) {
                Square::Asks => true,
                Square::DoesNot => false,
                Square::Undecided(cells) => self.any_quarter(around, scale, place, &cells),
            }
        })
    }
}

/// What is known of the pixels of a square that touch a triangle.
enum Square {
    /// One of them asks for more.
    Asks,
    /// None does.
    DoesNot,
    /// The square has these cells, and only parts of it tell.
    Undecided(Cells),
}
