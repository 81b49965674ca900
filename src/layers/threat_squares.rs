//! Models of the risk of many threats in a square, from those of the squares around it.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::rc::Rc;

use super::Threats;
use super::models::{ModelId, Square};
use super::threats::NO_SURVIVAL;
use crate::field::Quadratic;
use crate::geometry::Lattice;

/// What is known of the threats that are felt in a square.
///
/// ```text
///   +-------+-------+     Most threats are smooth in a square: their part of what is survived is one model,
///   |    _..|..     |     which the squares within take over. Only threats with a kink in the square, as at
///   | ,-'   |  `-.  |     their range, are looked at again in its quarters.
///   +/------+-----\-+
///   ||      |      ||
///   +-------+-------+
/// ```
struct Known {
    function: ModelId,
    square: Square,
    /// The share that is survived of the threats that are smooth here.
    smooth: Quadratic,
    /// The threats that are not, by their numbers.
    open: Vec<u32>,
    /// A model of the combined risk. It is 1 where nothing is survived; then the others do not count.
    risk: Quadratic,
}

/// Where the rest of the smooth threats is more than this share of what the model changes by, it is worth
/// looking at all of them again: with half the side, the rest is an eighth.
const COARSE: f64 = 1.0 / 16.0;

/// The number of squares of each size that a thread keeps.
const KEPT: usize = 8;

/// Squares have up to 2^31 cells along each side.
const SIZES: usize = 32;

thread_local! {
    /// By size, and by a hash of the place. What is known of a square is the same whenever it is made.
    static SQUARES: RefCell<Vec<Option<Rc<Known>>>> = const { RefCell::new(Vec::new()) };
}

impl Threats {
    /// A model of the combined risk in a square of a lattice.
    pub(super) fn model_in(&self, function: ModelId, square: Square, lattice: &Lattice) -> Quadratic {
        let widest = (self.mean_range() / lattice.step().min_element()).max(1.0) as u64;
        let widest = widest.ilog2();
        if square.bits > widest {
            return self.model(&square.place(lattice));
        }
        self.known(function, square, lattice, widest).risk
    }

    fn known(&self, function: ModelId, square: Square, lattice: &Lattice, widest: u32) -> Rc<Known> {
        let [x, y] = square.at.map(|v| v as u64);
        let key = (x << 29 ^ y).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let place = square.bits as usize % SIZES * KEPT + (key >> 32) as usize % KEPT;
        let found = SQUARES.with_borrow(|squares| squares.get(place).cloned().flatten());
        if let Some(found) = found.filter(|found| found.function == function && found.square == square) {
            return found;
        }
        let around =
            (square.bits < widest).then(|| self.known(function, square.around(), lattice, widest));
        let inherited = around.and_then(|around| self.within(&around, square, lattice));
        let known = inherited.unwrap_or_else(|| {
            let mut all = Vec::new();
            let _ = self.visit_numbers_meeting(&square.place(lattice).rect(), |number| {
                all.push(number);
                ControlFlow::Continue(())
            });
            self.of(function, square, lattice, Quadratic::constant(1.0), &all)
        });
        let known = Rc::new(known);
        SQUARES.with_borrow_mut(|squares| {
            if squares.is_empty() {
                squares.resize(SIZES * KEPT, None);
            }
            squares[place] = Some(known.clone());
        });
        known
    }

    /// What is known of a quarter of a square. `None` where all threats should be looked at again.
    fn within(&self, around: &Known, quarter: Square, lattice: &Lattice) -> Option<Known> {
        let function = around.function;
        if around.risk == Quadratic::constant(1.0) {
            let (smooth, open, risk) = (around.smooth, Vec::new(), around.risk);
            return Some(Known { function, square: quarter, smooth, open, risk });
        }
        let (center, half) = quarter.in_square_around();
        let smooth = around.smooth.part(center, half);
        let known = self.of(function, quarter, lattice, smooth, &around.open);
        let rest = smooth.rest();
        let is_coarse = rest > COARSE * known.risk.change() && rest > known.risk.rest() - rest;
        (!is_coarse).then_some(known)
    }

    /// Adds threats to what is known of others, which are smooth.
    fn of(
        &self,
        function: ModelId,
        square: Square,
        lattice: &Lattice,
        mut smooth: Quadratic,
        numbers: &[u32],
    ) -> Known {
        let (place, one) = (square.place(lattice), Quadratic::constant(1.0));
        let rect = place.rect();
        let (mut kinked, mut open) = (one, Vec::new());
        for &number in numbers {
            let threat = &self.list()[number as usize];
            if threat.reach().intersection(&rect).is_none() {
                continue;
            }
            let (risk, is_smooth) = threat.model(&place);
            if risk == Quadratic::constant(0.0) {
                continue;
            }
            let survived = one.minus(&risk);
            if is_smooth {
                smooth = smooth.times(&survived);
            } else {
                kinked = kinked.times(&survived);
                open.push(number);
            }
            if smooth.size() * kinked.size() < NO_SURVIVAL {
                return Known { function, square, smooth, open: Vec::new(), risk: one };
            }
        }
        let risk = one.minus(&smooth.times(&kinked));
        Known { function, square, smooth, open, risk }
    }
}
