//! Bounds of functions over rectangles of lattice cells, from memoized Taylor models.

use std::cell::RefCell;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec2;

use super::engine::cells::Cells;
use crate::field::{Bounds, TaylorModel};
use crate::geometry::{Lattice, Rect};

/// A function on one lattice, to find its models again. No two functions have the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelId(pub(super) u64);

impl ModelId {
    /// Returns one that no function has yet.
    pub fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// The part of the plane that a model is for, in world units.
pub struct ModelDomain {
    /// Models of x and y. They include what rounding changes in the coordinates of points.
    pub coordinates: [TaylorModel; 2],
    /// The middle, and half of the sides.
    pub middle: DVec2,
    pub half: DVec2,
    /// Bound of the effect of rounding on the coordinates.
    pub rest: DVec2,
}

impl ModelDomain {
    /// Returns the place of a rectangle with two sides.
    pub(crate) fn of_rectangle(rectangle: &Rect) -> Self {
        let (middle, half) = (rectangle.center(), 0.5 * rectangle.size());
        let rest = 4.0 * f64::EPSILON * (middle.abs() + half);
        Self { coordinates: coordinates(middle, half, rest), middle, half, rest }
    }

    /// Returns the coordinates of a point in models of the place, from −1 to 1.
    pub(super) fn coordinates_of(&self, point: DVec2) -> [f64; 2] {
        let from_middle = point - self.middle;
        [0, 1].map(|axis: usize| {
            let share = from_middle[axis] / self.half[axis];
            if self.half[axis] > 0.0 { share.clamp(-1.0, 1.0) } else { 0.0 }
        })
    }

    /// Returns a rectangle that holds all points of the place.
    pub fn rect(&self) -> Rect {
        let half = self.half * (1.0 + 1e-12) + 1e-15 * self.middle.abs();
        Rect::new(self.middle - half, self.middle + half)
    }
}

/// A model of a function over a place, with what else is known of its values there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundedModel {
    pub polynomial: TaylorModel,
    /// Bounds of the values anywhere in the place.
    pub bounds: Bounds,
}

impl BoundedModel {
    /// Returns a model without other bounds.
    pub const fn of(polynomial: TaylorModel) -> Self {
        Self { polynomial, bounds: Bounds::ANYTHING }
    }
}

/// A dyadic square of 2^bits cells along each side, and a rim around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct DyadicSquare {
    bits: u32,
    at: [i64; 2],
}

/// The rim as a share of the side: a rectangle around a triangle extends beyond the square by a cell.
const RIM: f64 = 0.125;

/// The largest square whose model is tried has 2^4 times the side of the rectangle in question: one model
/// then serves for hundreds of rectangles.
const WIDEST: u32 = 4;

/// A model is good enough for a rectangle where its rest is at most this multiple of the change of the
/// polynomial over the rectangle. A smaller one would need more models, a greater one more rectangles.
const GOOD: f64 = 1.0;

/// A model of the smallest square around a rectangle is good enough with this multiple: at a kink, the bounds
/// of the function itself would tell little more.
const FAIR: f64 = 8.0;

/// The number of models that a thread keeps: 56 KB.
const KEPT_BITS: u32 = 9;

#[derive(Clone, Copy)]
struct CachedModel {
    function: ModelId,
    square: DyadicSquare,
    model: BoundedModel,
}

thread_local! {
    /// The kept models, at the index from a hash of function and square. A model is the same whenever it is
    /// made, so an answer does not depend on which models are kept.
    static KEPT: RefCell<Vec<CachedModel>> = const { RefCell::new(Vec::new()) };
}

#[cfg(test)]
thread_local! {
    /// How often this thread has evaluated a whole function to bound it.
    pub(super) static MADE: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// Returns bounds of a function at the centres of the cells in a rectangle.
///
/// ```text
///   +---------------+     Models of squares around the rectangle are tried from the widest down, until
///   |       |       |     one is good enough. Where none is, as at jumps, the bounds of the function
///   |   +---+---+   |     itself over the rectangle count as well.
///   |   | ##|   |   |
///   |---+---+---+---|
///   |       |       |
///   +---------------+
/// ```
///
/// `model` gives the model of the function over a place, and `bounds` its bounds over the rectangle, from
/// those of a model.
pub fn bounds(
    function: ModelId,
    cells: &Cells,
    lattice: &Lattice,
    model: impl Fn(&ModelDomain) -> BoundedModel,
    bounds: impl FnOnce(Bounds) -> Bounds,
) -> Bounds {
    let middle = [0, 1].map(|axis: usize| 0.5 * (cells.min[axis] + cells.max[axis]) as f64);
    let half = [0, 1].map(|axis: usize| 0.5 * (cells.max[axis] - cells.min[axis]) as f64 - 0.5);
    let side = (2.0 * half[0].max(half[1])).max(1.0) as u64;
    let extent = lattice.extent();
    let whole = extent.x.max(extent.y).next_power_of_two().ilog2();
    let around = |bits: u32| DyadicSquare { bits, at: middle.map(|v| v as i64 >> bits) };
    let fits = |bits: &u32| around(*bits).part(middle, half).is_some();
    let Some(least_bits) = (side.ilog2()..=whole).find(fits) else {
        return bounds(Bounds::ANYTHING);
    };
    let mut square_bits = (least_bits + WIDEST).min(whole);
    loop {
        let (square, mut skipped) = (around(square_bits), 1);
        if let Some((center, half)) = square.part(middle, half) {
            let model = kept(function, square, || model(&square.place(lattice)));
            let (found, rest) = (model.polynomial.bounds_over(center, half), model.polynomial.remainder());
            let change = found.greatest - found.least - 2.0 * rest;
            let found = found.intersection(model.bounds);
            let is_least = square_bits == least_bits;
            if rest <= if is_least { FAIR } else { GOOD } * change || rest == 0.0 {
                return found;
            }
            if is_least {
                #[cfg(test)]
                MADE.with(|made| made.set(made.get() + 1));
                let own = bounds(found);
                return Bounds { valid: own.valid || found.valid, ..own.intersection(found) };
            }
            skipped = halvings(rest / (GOOD * change));
        }
        square_bits = square_bits.saturating_sub(skipped).max(least_bits);
    }
}

/// Returns how often a square is halved until its rest, which shrinks with the third power of the side, has
/// shrunk by a factor: at least once.
fn halvings(factor: f64) -> u32 {
    let exponent = (factor.to_bits() >> 52 & 0x7ff) as u32;
    (exponent.saturating_sub(1023) / 3).max(1)
}

fn kept(function: ModelId, square: DyadicSquare, model: impl FnOnce() -> BoundedModel) -> BoundedModel {
    let DyadicSquare { bits, at: [x, y] } = square;
    let key = function.0 << 54 ^ u64::from(bits) << 58 ^ (x as u64) << 29 ^ y as u64;
    let place = (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - KEPT_BITS)) as usize;
    let found = KEPT.with_borrow(|kept| kept.get(place).copied());
    if let Some(found) = found.filter(|found| found.function == function && found.square == square) {
        return found.model;
    }
    #[cfg(test)]
    MADE.with(|made| made.set(made.get() + 1));
    let new = CachedModel { function, square, model: model() };
    KEPT.with_borrow_mut(|kept| {
        if kept.is_empty() {
            let none = CachedModel { function: ModelId(u64::MAX), ..new };
            kept.resize(1 << KEPT_BITS, none);
        }
        kept[place] = new;
    });
    new.model
}

impl DyadicSquare {
    /// Returns a rectangle, by its middle and half of its sides in cells, in the coordinates of a model of
    /// the square. `None` where it extends beyond the rim.
    fn part(&self, middle: [f64; 2], half: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        let side = (1u64 << self.bits) as f64;
        let reach = (0.5 + RIM) * side;
        let from = [0, 1].map(|axis: usize| middle[axis] - (self.at[axis] as f64 + 0.5) * side);
        let fits = (0..2).all(|axis: usize| from[axis].abs() + half[axis] <= reach);
        let rounded_up = |share: f64| share * (1.0 + 4.0 * f64::EPSILON) + 4.0 * f64::EPSILON;
        fits.then(|| (from.map(|v| v / reach), half.map(|v| rounded_up(v / reach))))
    }

    fn place(&self, lattice: &Lattice) -> ModelDomain {
        let side = (1u64 << self.bits) as f64;
        let (origin, step) = (lattice.bounds().min, lattice.step());
        let middle = origin + (DVec2::from(self.at.map(|v| v as f64)) + 0.5) * side * step;
        let half = (0.5 + RIM) * side * step;
        let rest = 4.0 * f64::EPSILON * (origin.abs() + middle.abs() + half);
        ModelDomain { coordinates: coordinates(middle, half, rest), middle, half, rest }
    }
}

fn coordinates(middle: DVec2, half: DVec2, rest: DVec2) -> [TaylorModel; 2] {
    [0, 1].map(|axis: usize| TaylorModel::coordinate(axis, middle[axis], half[axis], rest[axis]))
}
