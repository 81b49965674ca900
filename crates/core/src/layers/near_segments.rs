//! The segments that can be nearest to the cells of a square of a lattice, memoized.
//!
//! ```text
//!   +---------------+     Those for a square are found among those for the square four times as wide. A
//!   |   |   |   |   |     mesh is made from the top of the bisection tree down: the next triangles lie in
//!   |---+---+---+---|     the same squares, and look at a few segments each, however many there are.
//!   |   | ##|   |   |
//!   |---+---+---+---|
//!   +---------------+
//! ```

use std::cell::RefCell;
use std::rc::Rc;

use super::Shapes;
use super::distance::Near;
use super::engine::cells::Cells;
use super::engine::parts::LatticeSquare;
use super::models::ModelId;
use crate::geometry::{Lattice, LatticePoint};

/// The side of a square is 4ⁿ cells.
const STRIDE: u32 = 2;

/// The number of squares that a thread keeps.
const KEPT_BITS: u32 = 9;

#[derive(Clone)]
struct CachedSegments {
    /// The function of the distance, and the square.
    key: Option<(ModelId, LatticeSquare)>,
    near: Option<Rc<Near>>,
}

thread_local! {
    /// At the index from a hash of the key. What is kept is the same whenever it is found, so an answer does
    /// not depend on it.
    static KEPT: RefCell<Vec<CachedSegments>> = const { RefCell::new(Vec::new()) };
}

/// Returns the segments of shapes that can be nearest to some cells; `None` where they are many. No other
/// shapes or lattice may have the same `function`.
pub fn near(function: ModelId, shapes: &Shapes, cells: &Cells, lattice: &Lattice) -> Option<Rc<Near>> {
    near_square(function, shapes, square_around(cells, lattice.extent())?, lattice)
}

fn near_square(
    function: ModelId,
    shapes: &Shapes,
    square: LatticeSquare,
    lattice: &Lattice,
) -> Option<Rc<Near>> {
    let (key, place) = (Some((function, square)), place_of(function, square));
    let kept = KEPT.with_borrow(|kept| kept.get(place).filter(|kept| kept.key == key).cloned());
    if let Some(CachedSegments { near, .. }) = kept {
        return near;
    }
    let bits = square.bits + STRIDE;
    let is_whole = square.bits >= LatticeSquare::whole(lattice.extent()).bits;
    let around = if is_whole { None } else { near_square(function, shapes, square.around(bits), lattice) };
    let rect = with_rim(square).world_rect(lattice);
    let near = shapes.near(&rect, around.as_deref()).map(Rc::new);
    KEPT.with_borrow_mut(|kept| {
        if kept.is_empty() {
            kept.resize(1 << KEPT_BITS, CachedSegments { key: None, near: None });
        }
        kept[place] = CachedSegments { key, near: near.clone() };
    });
    near
}

fn place_of(ModelId(function): ModelId, LatticeSquare { bits, column, row }: LatticeSquare) -> usize {
    let key = function << 54 ^ u64::from(bits) << 58 ^ u64::from(column) << 29 ^ u64::from(row);
    (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - KEPT_BITS)) as usize
}

/// Returns the smallest square whose rim holds some cells; `None` where there is no such square on the
/// lattice.
fn square_around(cells: &Cells, extent: LatticePoint) -> Option<LatticeSquare> {
    let side = (cells.max[0] - cells.min[0]).max(cells.max[1] - cells.min[1]).max(1) as u64;
    let least = side.ilog2().next_multiple_of(STRIDE);
    let most = LatticeSquare::whole(extent).bits.next_multiple_of(STRIDE);
    let around = |bits: u32| {
        let [column, row] =
            [0, 1].map(|axis: usize| (cells.min[axis].midpoint(cells.max[axis]) >> bits) as u32);
        LatticeSquare { bits, column, row }
    };
    let squares = (least..=most).step_by(STRIDE as usize).map(around);
    squares.into_iter().find(|square| with_rim(*square).intersection(cells) == Some(*cells))
}

/// Returns the cells of a square, and those of an eighth of its side around it, also beyond the lattice.
fn with_rim(LatticeSquare { bits, column, row }: LatticeSquare) -> Cells {
    let (side, rim) = (1i64 << bits, (1i64 << bits >> 3).max(1));
    let min = [column, row].map(|place| (i64::from(place) << bits) - rim);
    Cells { min, max: min.map(|min| min + side + 2 * rim) }
}
