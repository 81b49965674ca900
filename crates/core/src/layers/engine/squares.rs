//! Dyadic squares of a lattice, and what h̄ before gradation is known to be in them.

use crate::geometry::LatticePoint;
use crate::layers::{PaintLayers, SizeField};

use super::cells::Cells;
use super::steepness::is_steep;

/// The square of 2^bits lattice steps in a column and a row of such squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Square {
    pub bits: u32,
    pub column: u32,
    pub row: u32,
}

/// The smallest squares have 2^this steps: the number of a square fits 64 bits.
pub const LEAST_BITS: u32 = 2;

/// A square of 2^this steps covers every lattice.
const MOST_BITS: u32 = 31;

impl Square {
    /// The cells of the square that lie on the lattice.
    #[inline]
    pub fn cells(&self, extent: LatticePoint) -> Option<Cells> {
        let min = [self.column, self.row].map(|place| i64::from(place) << self.bits);
        let max = [0, 1].map(|axis| {
            let end = if axis == 0 { extent.x } else { extent.y };
            (min[axis] + (1i64 << self.bits)).min(i64::from(end))
        });
        (min[0] < max[0] && min[1] < max[1]).then_some(Cells { min, max })
    }

    /// The four squares of half the side.
    #[inline]
    pub fn quarters(&self) -> [Self; 4] {
        let (bits, column, row) = (self.bits - 1, 2 * self.column, 2 * self.row);
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| Self { bits, column: column + x, row: row + y })
    }

    /// At most four squares that cover some cells, not much larger than these.
    pub fn covering(cells: &Cells) -> impl Iterator<Item = Self> + use<> {
        let side = (cells.max[0] - cells.min[0]).max(cells.max[1] - cells.min[1]).max(1) as u64;
        let bits = side.next_power_of_two().ilog2().clamp(LEAST_BITS, MOST_BITS);
        let [first, last] =
            [cells.min.map(|v| (v >> bits) as u32), cells.max.map(|v| ((v - 1) >> bits) as u32)];
        (first[1]..=last[1])
            .flat_map(move |row| (first[0]..=last[0]).map(move |column| Self { bits, column, row }))
    }

    fn key(&self) -> u64 {
        u64::from(self.bits) << 58 | u64::from(self.column) << 29 | u64::from(self.row)
    }
}

/// What is known of a square.
#[derive(Clone, Copy, Debug)]
struct Known {
    key: u64,
    /// The least and the greatest h̄ before gradation, in world units.
    diameters: [f64; 2],
    /// Whether h̄ may change faster than the gradation; `None` until somebody asks.
    is_steep: Option<bool>,
}

/// What h̄ before gradation is known to be in dyadic squares.
///
/// Searches for places nearby look at the same large squares. The answers are those of one field and of paint
/// that does not change, and never depend on what is kept.
#[derive(Clone, Debug)]
pub struct KnownSquares {
    /// At the place that a hash of the key says; another square there is forgotten. Empty before the first
    /// use.
    squares: Vec<Known>,
    /// Binary logarithm of the number of squares that are kept.
    kept_bits: u32,
}

/// For many searches: 160 KB.
impl Default for KnownSquares {
    fn default() -> Self {
        Self { squares: Vec::new(), kept_bits: 12 }
    }
}

impl KnownSquares {
    /// For a single search.
    pub fn few() -> Self {
        Self { squares: Vec::new(), kept_bits: 6 }
    }

    #[inline]
    fn known(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> &mut Known {
        const EMPTY: Known = Known { key: u64::MAX, diameters: [0.0; 2], is_steep: None };
        if self.squares.is_empty() {
            self.squares = vec![EMPTY; 1 << self.kept_bits];
        }
        let key = square.key();
        let place = key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - self.kept_bits);
        let known = &mut self.squares[place as usize];
        if known.key != key {
            let nothing = [f64::INFINITY; 2];
            let cells = square.cells(field.lattice().extent());
            let diameters = cells.map_or(nothing, |cells| field.diameters(paint, &cells).0);
            *known = Known { key, diameters, is_steep: None };
        }
        known
    }

    /// The least and the greatest h̄ before gradation, in world units; infinite beside the lattice.
    #[inline]
    pub fn diameters(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> [f64; 2] {
        self.known(field, paint, square).diameters
    }

    /// Whether h̄ before gradation may change faster than the gradation of the field allows.
    pub fn is_steep(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> bool {
        let known = self.known(field, paint, square);
        *known.is_steep.get_or_insert_with(|| {
            square.cells(field.lattice().extent()).is_some_and(|cells| is_steep(field, paint, &cells))
        })
    }
}
