//! A tree of parts of the lattice, and what h̄ before gradation is known to be in them.
//!
//! ```text
//!   +-------+-------+        whole lattice        A square is divided in quarters as long as a search wants
//!   |       |   |   |         /  |  |  \          squares, and then in halves, where the layers say so.
//!   |       +---+---+        q   q  q   q
//!   |       |   ||  |                 / | \
//!   +-------+-------+                q  q  q
//!   |       |       |                  / \
//!   |       |       |            half      half
//!   +-------+-------+
//! ```

use crate::geometry::LatticePoint;
use crate::layers::PaintLayers;

use super::cells::{Cells, Cut};
use super::counting::Counting;
use super::stack::Stack;
use super::steepness::{Slopes, slopes};

/// The square of 2^bits lattice steps in a column and a row of such squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeSquare {
    pub bits: u32,
    pub column: u32,
    pub row: u32,
}

/// The smallest squares have 2^this steps.
pub const LEAST_BITS: u32 = 2;

/// A square of 2^this steps covers every lattice.
const MOST_BITS: u32 = 31;

impl LatticeSquare {
    /// Returns the cells of the square that lie on the lattice.
    #[inline]
    pub fn cells(&self, extent: LatticePoint) -> Option<Cells> {
        let min = [self.column, self.row].map(|place| i64::from(place) << self.bits);
        let max = [0, 1].map(|axis| {
            let end = if axis == 0 { extent.x } else { extent.y };
            (min[axis] + (1i64 << self.bits)).min(i64::from(end))
        });
        (min[0] < max[0] && min[1] < max[1]).then_some(Cells { min, max })
    }

    /// Returns the smallest square that covers a whole lattice.
    pub fn whole(extent: LatticePoint) -> Self {
        let bits = extent.x.max(extent.y).max(1).next_power_of_two().ilog2().max(LEAST_BITS);
        Self { bits, column: 0, row: 0 }
    }

    /// Returns the square of 2^bits steps around it.
    pub fn around(&self, bits: u32) -> Self {
        let halvings = bits.saturating_sub(self.bits);
        Self { bits, column: self.column >> halvings, row: self.row >> halvings }
    }

    /// Returns the four squares of half the side.
    #[inline]
    fn quarters(&self) -> [Self; 4] {
        let (bits, column, row) = (self.bits - 1, 2 * self.column, 2 * self.row);
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| Self { bits, column: column + x, row: row + y })
    }

    /// Returns at most four squares that cover some cells, not much larger than these.
    fn covering(cells: &Cells) -> impl Iterator<Item = Self> + use<> {
        let side = (cells.max[0] - cells.min[0]).max(cells.max[1] - cells.min[1]).max(1) as u64;
        let bits = side.next_power_of_two().ilog2().clamp(LEAST_BITS, MOST_BITS);
        let [first, last] =
            [cells.min.map(|v| (v >> bits) as u32), cells.max.map(|v| ((v - 1) >> bits) as u32)];
        (first[1]..=last[1])
            .flat_map(move |row| (first[0]..=last[0]).map(move |column| Self { bits, column, row }))
    }
}

/// A part of the lattice that a [`KnownParts`] knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartId(u32);

/// The whole lattice.
const ROOT: usize = 0;

/// Stands for no entry.
const NONE: u32 = u32::MAX;

/// The facts that are known about a part of the lattice.
#[derive(Clone, Copy, Debug)]
struct KnownPart {
    /// First column and row, and one past the last ones. Without cells beside the lattice.
    min: [u32; 2],
    max: [u32; 2],
    /// The binary logarithm of the side of a square; `None` for what squares are cut into.
    bits: Option<u8>,
    /// Whether `diameters`, `cut` and `counting` are known.
    has_diameters: bool,
    /// Whether `slopes` are those of the present values. If not, they are the former ones.
    has_slopes: bool,
    /// The least and the greatest h̄ before gradation, in world units.
    diameters: [f64; 2],
    /// Where to divide the part to know more.
    cut: Option<Cut>,
    /// The layers that can count in the part around.
    counting: Counting,
    /// The place of the slopes, or `NONE`.
    slopes: u32,
    /// The part around, or `NONE`.
    around: u32,
    /// The first of four quarters, or `NONE` as long as nobody has asked.
    quarters: u32,
    /// The first of two halves, or `NONE`.
    halves: u32,
}

/// Bounds of h̄ before gradation in parts of the lattice, kept for later questions.
///
/// Searches for places nearby look at the same parts. The answers are those of one stack, and never depend on
/// what is known. Where paint has changed, [`Self::forget`] must be called.
#[derive(Clone, Debug, Default)]
pub struct KnownParts {
    parts: Vec<KnownPart>,
    /// Bounds of the gradient of h̄ before gradation, in world units, and the layers that can count.
    slopes: Vec<(Slopes, Counting)>,
    /// The layers that are asked at all.
    counting: Counting,
}

/// With this many parts everything is forgotten before the next question: 16 MB.
const MOST_PARTS: usize = 1 << 16;

impl KnownPart {
    fn new(cells: Option<Cells>, bits: Option<u32>, around: u32) -> Self {
        let cells = cells.unwrap_or(Cells { min: [0; 2], max: [0; 2] });
        Self {
            min: cells.min.map(|v| v as u32),
            max: cells.max.map(|v| v as u32),
            bits: bits.map(|bits| bits as u8),
            has_diameters: false,
            has_slopes: false,
            diameters: [f64::INFINITY; 2],
            cut: None,
            counting: Counting::ALL,
            slopes: NONE,
            around,
            quarters: NONE,
            halves: NONE,
        }
    }

    fn cells(&self) -> Cells {
        Cells { min: self.min.map(i64::from), max: self.max.map(i64::from) }
    }
}

impl KnownParts {
    /// Returns empty parts, for questions about h̄ of some layers only.
    pub fn of(counting: Counting) -> Self {
        Self { counting, ..Self::default() }
    }

    /// Returns the layers that are asked.
    pub fn counting(&self) -> Counting {
        self.counting
    }

    /// Forgets everything if a lot is known. What was found by number is then not valid any more, and the
    /// result is true.
    pub fn make_room(&mut self) -> bool {
        let is_full = self.parts.len() > MOST_PARTS;
        if is_full {
            self.parts.clear();
            self.slopes.clear();
        }
        is_full
    }

    /// Returns the whole lattice of a stack.
    pub fn whole(&mut self, stack: &Stack) -> PartId {
        if self.parts.is_empty() {
            let extent = stack.lattice().extent();
            let square = LatticeSquare::whole(extent);
            self.parts.push(KnownPart::new(square.cells(extent), Some(square.bits), NONE));
        }
        PartId(ROOT as u32)
    }

    /// Returns at most four squares that cover some cells, not much larger than these.
    pub fn covering(
        &mut self,
        stack: &Stack,
        paint: &PaintLayers,
        cells: &Cells,
    ) -> impl Iterator<Item = PartId> + use<> {
        let mut found = [None; 4];
        for (place, square) in found.iter_mut().zip(LatticeSquare::covering(cells)) {
            *place = Some(self.square(stack, paint, square));
        }
        found.into_iter().flatten()
    }

    /// Returns a square that is not larger than the whole lattice.
    pub fn square(&mut self, stack: &Stack, paint: &PaintLayers, square: LatticeSquare) -> PartId {
        let mut part = self.whole(stack);
        let whole = LatticeSquare::whole(stack.lattice().extent());
        for bits in (square.bits..whole.bits).rev() {
            let LatticeSquare { column, row, .. } = square.around(bits);
            let quarters = self.quarters(stack, paint, part);
            part = PartId(quarters + (column & 1) + 2 * (row & 1));
        }
        part
    }

    /// Returns the first of four quarters of a square.
    fn quarters(&mut self, stack: &Stack, paint: &PaintLayers, part: PartId) -> u32 {
        // What counts here decides what is asked in the quarters.
        self.slopes(stack, paint, part);
        let KnownPart { quarters, min, bits, .. } = self.parts[part.0 as usize];
        if quarters != NONE {
            return quarters;
        }
        let bits = bits.map_or(LEAST_BITS, u32::from);
        let square = LatticeSquare { bits, column: min[0] >> bits, row: min[1] >> bits };
        let first = self.parts.len() as u32;
        let extent = stack.lattice().extent();
        let of_quarter =
            |square: LatticeSquare| KnownPart::new(square.cells(extent), Some(square.bits), part.0);
        self.parts.extend(square.quarters().map(of_quarter));
        self.parts[part.0 as usize].quarters = first;
        first
    }

    /// Returns the parts that a part is divided into: quarters of squares of more than 2^finest steps,
    /// otherwise halves where the layers say so, of which there are none where nothing more is to be known.
    pub fn divided(
        &mut self,
        stack: &Stack,
        paint: &PaintLayers,
        part: PartId,
        finest: u32,
    ) -> impl Iterator<Item = PartId> + use<> {
        let bits = self.parts[part.0 as usize].bits;
        let (first, count) = match bits {
            Some(bits) if u32::from(bits) > finest => (self.quarters(stack, paint, part), 4),
            _ => self.halves(stack, paint, part).map_or((0, 0), |first| (first, 2)),
        };
        (first..first + count).map(PartId)
    }

    fn halves(&mut self, stack: &Stack, paint: &PaintLayers, part: PartId) -> Option<u32> {
        let counting = self.slopes(stack, paint, part).1;
        let known = &self.parts[part.0 as usize];
        if known.halves != NONE {
            return Some(known.halves);
        }
        let cells = known.cells();
        let cut = match known.bits {
            Some(_) if counting != known.counting => stack.diameters(paint, &cells, counting).1,
            _ => known.cut,
        };
        let halves = cells.divided(cut?);
        let first = self.parts.len() as u32;
        self.parts.extend(halves.map(|cells| KnownPart::new(Some(cells), None, part.0)));
        self.parts[part.0 as usize].halves = first;
        Some(first)
    }

    /// Returns whether a part is a square of more than 2^bits steps.
    pub fn is_square_above(&self, part: PartId, bits: u32) -> bool {
        self.parts[part.0 as usize].bits.is_some_and(|own| u32::from(own) > bits)
    }

    /// Returns the cells of a part; `None` where a square lies beside the lattice.
    #[inline]
    pub fn cells(&self, part: PartId) -> Option<Cells> {
        let known = &self.parts[part.0 as usize];
        (known.min[0] < known.max[0] && known.min[1] < known.max[1]).then(|| known.cells())
    }

    /// Returns the least and the greatest h̄ before gradation, in world units; infinite beside the lattice.
    #[inline]
    pub fn diameters(&mut self, stack: &Stack, paint: &PaintLayers, part: PartId) -> [f64; 2] {
        let known = &self.parts[part.0 as usize];
        if known.has_diameters {
            return known.diameters;
        }
        self.find(stack, paint, part);
        self.parts[part.0 as usize].diameters
    }

    #[cold]
    fn find(&mut self, stack: &Stack, paint: &PaintLayers, part: PartId) {
        let KnownPart { around, .. } = self.parts[part.0 as usize];
        let counting =
            if around == NONE { self.counting } else { self.slopes(stack, paint, PartId(around)).1 };
        let found = self.cells(part).map(|cells| stack.diameters(paint, &cells, counting));
        let known = &mut self.parts[part.0 as usize];
        (known.diameters, known.cut) = found.unwrap_or(([f64::INFINITY; 2], None));
        (known.counting, known.has_diameters) = (counting, true);
    }

    /// Returns bounds of the gradient of h̄ before gradation, in world units, and the layers that can count.
    #[inline]
    pub fn slopes(&mut self, stack: &Stack, paint: &PaintLayers, part: PartId) -> (&Slopes, Counting) {
        if !self.parts[part.0 as usize].has_slopes {
            self.find_slopes(stack, paint, part);
        }
        let (slopes, counting) = &self.slopes[self.parts[part.0 as usize].slopes as usize];
        (slopes, *counting)
    }

    #[cold]
    fn find_slopes(&mut self, stack: &Stack, paint: &PaintLayers, part: PartId) {
        self.diameters(stack, paint, part);
        let counting = self.parts[part.0 as usize].counting;
        let found = match self.cells(part) {
            Some(cells) => slopes(stack, paint, &cells, counting),
            None => (Slopes::FLAT, counting),
        };
        let known = &mut self.parts[part.0 as usize];
        known.has_slopes = true;
        match self.slopes.get_mut(known.slopes as usize) {
            Some(former) => {
                if former.1 != found.1 {
                    // Other layers are to be asked in its parts.
                    (known.quarters, known.halves) = (NONE, NONE);
                }
                *former = found;
            }
            None => {
                known.slopes = self.slopes.len() as u32;
                self.slopes.push(found);
            }
        }
    }

    /// Forgets what is known of parts in which h̄ before gradation has changed: those that have cells of a
    /// rectangle, or cells that touch it.
    pub fn forget(&mut self, changed: &Cells) {
        if !self.parts.is_empty() {
            self.forget_within(ROOT, changed);
        }
    }

    fn forget_within(&mut self, place: usize, changed: &Cells) {
        let known = &mut self.parts[place];
        let meets = |axis: usize| {
            i64::from(known.min[axis]) <= changed.max[axis] && changed.min[axis] <= i64::from(known.max[axis])
        };
        if !(meets(0) && meets(1)) {
            return;
        }
        (known.has_diameters, known.has_slopes, known.halves) = (false, false, NONE);
        let quarters = known.quarters;
        if quarters != NONE {
            (0..4).for_each(|number| self.forget_within(quarters as usize + number, changed));
        }
    }
}
