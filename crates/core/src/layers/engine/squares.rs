//! Dyadic squares of a lattice, and what h̄ before gradation is known to be in them.

use crate::geometry::LatticePoint;
use crate::layers::{PaintLayers, SizeField};

use super::cells::Cells;
use super::counting::Counting;
use super::steepness::{Slopes, slopes};

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

    /// The square of twice the side around it, unless this one covers the whole lattice.
    fn around(&self, extent: LatticePoint) -> Option<Self> {
        let covers_all = extent.x.max(extent.y) <= 1 << self.bits.min(MOST_BITS);
        let around = Self { bits: self.bits + 1, column: self.column / 2, row: self.row / 2 };
        (!covers_all).then_some(around)
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
    /// The layers that can count in the square around.
    counting: Counting,
    /// Of h̄ before gradation, and the layers that can count; `None` until somebody asks.
    slopes: Option<(Slopes, Counting)>,
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

/// For many searches: 800 KB.
impl Default for KnownSquares {
    fn default() -> Self {
        Self { squares: Vec::new(), kept_bits: 12 }
    }
}

impl KnownSquares {
    /// For a single search.
    pub fn few() -> Self {
        Self { squares: Vec::new(), kept_bits: 8 }
    }

    #[inline]
    fn known(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> &mut Known {
        let key = square.key();
        let place = (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - self.kept_bits)) as usize;
        if self.squares.get(place).is_none_or(|known| known.key != key) {
            let found = self.find(field, paint, square);
            self.squares[place] = found;
        }
        &mut self.squares[place]
    }

    #[cold]
    fn find(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> Known {
        const EMPTY: Known =
            Known { key: u64::MAX, diameters: [f64::INFINITY; 2], counting: Counting::ALL, slopes: None };
        if self.squares.is_empty() {
            self.squares = vec![EMPTY; 1 << self.kept_bits];
        }
        let extent = field.lattice().extent();
        let Some(cells) = square.cells(extent) else { return Known { key: square.key(), ..EMPTY } };
        let around = square.around(extent);
        let counting = around.map_or(Counting::ALL, |around| self.slopes(field, paint, around).1);
        let diameters = field.diameters(paint, &cells, counting).0;
        Known { key: square.key(), diameters, counting, slopes: None }
    }

    /// The least and the greatest h̄ before gradation, in world units; infinite beside the lattice.
    #[inline]
    pub fn diameters(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> [f64; 2] {
        self.known(field, paint, square).diameters
    }

    /// The layers that can count in the square around.
    pub fn counting(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> Counting {
        self.known(field, paint, square).counting
    }

    /// Bounds of the gradient of h̄ before gradation, in world units, and the layers that can count.
    pub fn slopes(&mut self, field: &SizeField, paint: &PaintLayers, square: Square) -> (Slopes, Counting) {
        let known = self.known(field, paint, square);
        let counting = known.counting;
        *known.slopes.get_or_insert_with(|| match square.cells(field.lattice().extent()) {
            Some(cells) => slopes(field, paint, &cells, counting),
            None => (Slopes::FLAT, counting),
        })
    }
}
