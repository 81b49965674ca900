//! Whether some cell that touches a triangle asks for more than its level.

use std::collections::BinaryHeap;

use crate::geometry::Octagon;
use crate::raster::{ValueRange, ValueRanges};

use super::asked::Ternary;
use super::cells::{Cells, Cut, GridOnLattice};
use super::pixels::range_touching;
use super::reading::ValueTest;

/// Returns whether a cell of `cells` that touches the closed triangle asks, by dividing the rectangle where
/// `ask` says so.
///
/// `ask` answers for all cells of a rectangle: where they ask for more, and where to divide the rectangle to
/// know more. It must give a cut wherever the answer is [`Ternary::Maybe`].
///
/// Where two layers change along one line, as at the rim of a mask that they share, cells on the line can
/// stay undecided to the last. So after [`MOST_IN_ORDER`] rectangles, each within or beside the one before,
/// it goes on with the largest that is left, and it ends after [`MOST_BY_SIZE`] of those, with no cell found.
pub fn any_cell(
    triangle: &Octagon,
    cells: Cells,
    ask: &mut impl FnMut(&Cells) -> (Ternary, Option<Cut>),
) -> bool {
    let mut left = vec![cells];
    for _ in 0..MOST_IN_ORDER {
        let Some(cells) = left.pop() else { return false };
        match look(triangle, cells, ask) {
            RectangleVerdict::Asks => return true,
            RectangleVerdict::DoesNot => {}
            RectangleVerdict::Undecided([low, high]) => left.extend([high, low]),
        }
    }
    any_cell_by_size(triangle, left, ask)
}

/// Continues [`any_cell`] in the rectangles that are left, the largest first.
#[cold]
fn any_cell_by_size(
    triangle: &Octagon,
    left: Vec<Cells>,
    ask: &mut impl FnMut(&Cells) -> (Ternary, Option<Cut>),
) -> bool {
    let by_size = |Cells { min, max }: Cells| ((max[0] - min[0]).max(max[1] - min[1]), min, max);
    let mut left: BinaryHeap<_> = left.into_iter().map(by_size).collect();
    for _ in 0..MOST_BY_SIZE {
        let Some((_, min, max)) = left.pop() else { return false };
        match look(triangle, Cells { min, max }, ask) {
            RectangleVerdict::Asks => return true,
            RectangleVerdict::DoesNot => {}
            RectangleVerdict::Undecided(parts) => left.extend(parts.map(by_size)),
        }
    }
    false
}

/// The number of rectangles that [`any_cell`] looks at one beside the other.
const MOST_IN_ORDER: usize = 1 << 15;
/// The number of rectangles that it looks at afterwards, from the largest on.
const MOST_BY_SIZE: usize = 1 << 15;

/// What is known of the cells of a rectangle that touch a triangle.
enum RectangleVerdict {
    Asks,
    DoesNot,
    /// These parts tell more.
    Undecided([Cells; 2]),
}

#[cfg(test)]
thread_local! {
    /// The number of rectangles at which this thread has looked.
    pub static LOOKED_AT: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

#[inline]
fn look(
    triangle: &Octagon,
    cells: Cells,
    ask: &mut impl FnMut(&Cells) -> (Ternary, Option<Cut>),
) -> RectangleVerdict {
    if !triangle.meets(&cells.octagon()) {
        return RectangleVerdict::DoesNot;
    }
    #[cfg(test)]
    LOOKED_AT.with(|looked_at| looked_at.set(looked_at.get() + 1));
    match ask(&cells) {
        (Ternary::Never, _) => RectangleVerdict::DoesNot,
        (Ternary::Always, _) => RectangleVerdict::Asks,
        (Ternary::Maybe, cut) => {
            RectangleVerdict::Undecided(cells.divided(cut.expect("an undecided rectangle has a cut")))
        }
    }
}

/// A search in one raster, square by square of its own.
pub struct RasterSearch<'a, R> {
    pub raster: &'a R,
    pub grid: &'a GridOnLattice,
    pub question: ValueTest<'a>,
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
        if self.question.asks(self.raster.whole_range()) == Ternary::Never {
            return false;
        }
        let scale = self.grid.scale_of(cells).max(self.raster.finest());
        let [low, high] = self.grid.squares(scale, cells);
        let mut may_read_pixels = true;
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                match self.square((triangle, cells), scale, [x, y], || self.grid.square(scale, x, y)) {
                    SquareVerdict::Asks => return true,
                    SquareVerdict::DoesNot => {}
                    SquareVerdict::Undecided(square) => {
                        if may_read_pixels && let Some(range) = self.range_touching(triangle, cells) {
                            return self.question.asks(range) != Ternary::Never;
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
    ) -> SquareVerdict {
        // Most squares are decided by their values.
        let asks = self.question.asks(self.raster.range_anywhere(scale, [x, y]));
        if asks == Ternary::Never {
            return SquareVerdict::DoesNot;
        }
        let cells = cells();
        let octagon = cells.octagon();
        // A square between two lattice lines has no cell.
        if cells.intersection(around).is_none() || !triangle.meets(&octagon) {
            return SquareVerdict::DoesNot;
        }
        if asks == Ternary::Always || (self.question.is_monotone() && triangle.contains(&octagon)) {
            return SquareVerdict::Asks;
        }
        SquareVerdict::Undecided(cells)
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
                SquareVerdict::Asks => true,
                SquareVerdict::DoesNot => false,
                SquareVerdict::Undecided(cells) => self.any_quarter(around, scale, place, &cells),
            }
        })
    }
}

/// What is known of the pixels of a square that touch a triangle.
enum SquareVerdict {
    /// One of them asks for more.
    Asks,
    /// None does.
    DoesNot,
    /// The square has these cells, and only parts of it tell.
    Undecided(Cells),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::LatticePoint;

    /// Cells on a row stay undecided to the last, and only those of a small rectangle elsewhere ask.
    #[test]
    fn what_asks_is_found_beside_a_line_that_stays_undecided() {
        const SIDE: u32 = 1 << 20;
        let ask_with = |row: i64, rect: Cells| {
            move |cells: &Cells| {
                let size = [0, 1].map(|axis| cells.max[axis] - cells.min[axis]);
                let axis = usize::from(size[1] > size[0]);
                let cut = Cut { axis, at: cells.min[axis] + size[axis] / 2 };
                let is_on_row = cells.min[1] <= row && row < cells.max[1];
                let common = cells.intersection(&rect);
                match common {
                    Some(common) if common == *cells => (Ternary::Always, None),
                    None if !is_on_row || size == [1, 1] => (Ternary::Never, None),
                    _ => (Ternary::Maybe, Some(cut)),
                }
            }
        };
        let triangle =
            Octagon::triangle([[0, 0], [SIDE, 0], [0, SIDE]].map(|[x, y]| LatticePoint::new(x, y)));
        let all = Cells { min: [0; 2], max: [i64::from(SIDE); 2] };
        let mut random = fastrand::Rng::with_seed(5166);
        for _ in 0..20 {
            let row = random.i64(0..1000);
            let at = [(); 2].map(|()| random.i64(2_000..i64::from(SIDE) / 2 - 2_000));
            let rect = Cells { min: at, max: at.map(|v| v + 1_500) };
            assert!(any_cell(&triangle, all, &mut ask_with(row, rect)), "{rect:?} beside row {row}");
        }
        // It ends where there is nothing.
        let nothing = Cells { min: [-9; 2], max: [-8; 2] };
        let (mut asked, ask) = (0, ask_with(500, nothing));
        let mut counted = |cells: &Cells| {
            asked += 1;
            ask(cells)
        };
        assert!(!any_cell(&triangle, all, &mut counted));
        let most = MOST_IN_ORDER + MOST_BY_SIZE;
        assert!((most / 2..=most).contains(&asked), "{asked}");
    }
}
