mod build;

use glam::DVec2;

use super::Location;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::kernel::{Mesh, TriangleId, WalkEnd};

/// A search tree over a mesh, for many queries: the report's virtual buckets (Section 7.1), carried on until
/// no walk is left.
///
/// Every triangle of a mesh is half a square of the lattice (at even levels) or half of each of two squares
/// (at odd levels). The tree divides the coarse cells into quarters until each square is cut by at most one
/// diagonal, and keeps the triangle on either side. A query goes down to its square and compares with the
/// diagonal, exactly, and never touches the mesh. The uppermost divisions are made everywhere at once, as a
/// table. Together they take about 5 bytes a triangle at even levels and 10 at odd ones.
///
/// Points on the rim of a square or on its diagonal are found by a walk from there, and those outside by the
/// plain walk.
pub struct Locator<'m> {
    mesh: &'m Mesh,
    table: Table,
    quarters: Vec<[LocatorSquare; 4]>,
}

/// Squares of one size that cover the grid, row by row from the lower left.
struct Table {
    /// Squares along a row.
    columns: usize,
    /// Binary logarithm of the side of a square, in lattice steps.
    side_bits: u32,
    squares: Vec<LocatorSquare>,
}

/// A square of the lattice, with a triangle on either side of a diagonal; or the place of its quarters.
///
/// ```text
///     o-------o      o-------o
///     | \above|      |above/ |      falling and rising diagonal
///     |below\ |      | /below|
///     o-------o      o-------o
/// ```
#[derive(Clone, Copy)]
struct LocatorSquare {
    /// The triangle below the diagonal, or `NOTHING`; or with the `FLAG` the place of the quarters.
    below: u32,
    /// The triangle above it, or `NOTHING`; with the `FLAG` where the diagonal rises.
    above: u32,
}

/// Triangles take 32 bytes: their numbers leave the highest bit free.
const FLAG: u32 = 1 << 31;
const NOTHING: u32 = FLAG - 1;

/// Half of a square that a triangle covers.
struct Half {
    /// Lower left corner of the square.
    origin: LatticePoint,
    rising: bool,
    above: bool,
}

impl LocatorSquare {
    const EMPTY: Self = Self { below: NOTHING, above: NOTHING };

    fn divided(place: usize) -> Self {
        Self { below: place as u32 | FLAG, above: NOTHING }
    }

    #[inline]
    fn place_of_quarters(self) -> Option<usize> {
        (self.below & FLAG != 0).then_some((self.below & !FLAG) as usize)
    }

    /// Returns the lower left, lower right, upper left, upper right.
    fn quarters(self) -> [Self; 4] {
        let all_below = Self { below: self.below, above: self.below };
        let all_above = Self { below: self.above & !FLAG, above: self.above & !FLAG };
        if self.above & FLAG == 0 {
            [all_below, self, self, all_above]
        } else {
            [self, all_below, all_above, self]
        }
    }

    /// Notes that the quarters of a divided square were moved on by `places`.
    fn move_quarters(&mut self, places: usize) {
        if let Some(place) = self.place_of_quarters() {
            *self = Self::divided(place + places);
        }
    }

    fn cover(&mut self, half: &Half, id: TriangleId) {
        if half.above {
            self.above = id.0;
        } else {
            self.below = id.0;
        }
        self.above = (self.above & !FLAG) | if half.rising { FLAG } else { 0 };
    }

    /// Returns the triangle at offset (u, v) from the lower left corner, both strictly between 0 and `side`;
    /// `None` for a hole, and on the diagonal.
    #[inline]
    fn at(self, u: f64, v: f64, side: f64) -> Option<TriangleId> {
        // A rounded sum lies on the true side of `side`, or on it.
        let (a, b) = if self.above & FLAG == 0 { (u + v, side) } else { (v, u) };
        let id = if a < b { self.below } else { self.above & !FLAG };
        (a != b && id != NOTHING).then_some(TriangleId(id))
    }
}

impl Table {
    fn of_coarse_cells(lattice: &Lattice) -> Self {
        let [columns, rows] = lattice.cells().map(|n| n as usize);
        Self { columns, side_bits: lattice.halvings(), squares: vec![LocatorSquare::EMPTY; columns * rows] }
    }

    /// Divides all squares into quarters.
    fn divide(&mut self) {
        let mut finer = vec![LocatorSquare::EMPTY; 4 * self.squares.len()];
        for (n, square) in self.squares.iter().enumerate() {
            let lower_left = 4 * self.columns * (n / self.columns) + 2 * (n % self.columns);
            let upper_left = lower_left + 2 * self.columns;
            let quarters = square.quarters();
            finer[lower_left..lower_left + 2].copy_from_slice(&quarters[..2]);
            finer[upper_left..upper_left + 2].copy_from_slice(&quarters[2..]);
        }
        self.columns *= 2;
        self.side_bits -= 1;
        self.squares = finer;
    }

    /// Returns the number of the square with a point, in lattice steps.
    #[inline]
    fn number(&self, x: u32, y: u32) -> usize {
        (y >> self.side_bits) as usize * self.columns + (x >> self.side_bits) as usize
    }
}

impl Locator<'_> {
    /// Finds the triangle that contains a point in world coordinates. Same answers as [`Mesh::locate`].
    #[inline]
    pub fn locate(&self, point: DVec2) -> Location {
        let p = self.mesh.lattice.lattice_from_world(point);
        let Some((square, bits)) = self.square_around(p) else { return self.mesh.locate(point) };
        let corner = |x: f64| f64::from(x as u32 >> bits << bits);
        // Both differences are exact: whole numbers are taken from numbers that are larger.
        let (u, v) = (p.x - corner(p.x), p.y - corner(p.y));
        if u > 0.0
            && v > 0.0
            && let Some(triangle) = square.at(u, v, f64::from(1u32 << bits))
        {
            return Location::Inside { triangle };
        }
        self.on_a_line(square, p).unwrap_or_else(|| self.mesh.locate(point))
    }

    /// Returns the smallest square around a point in lattice coordinates, and the binary logarithm of its
    /// side.
    #[inline]
    fn square_around(&self, p: DVec2) -> Option<(LocatorSquare, u32)> {
        let extent = self.mesh.lattice.extent();
        if !(p.x >= 0.0 && p.y >= 0.0 && p.x < f64::from(extent.x) && p.y < f64::from(extent.y)) {
            return None;
        }
        let (x, y) = (p.x as u32, p.y as u32);
        let (mut square, mut bits) = (self.table.squares[self.table.number(x, y)], self.table.side_bits);
        // Ends: each turn goes down the tree, which is no deeper than the lattice.
        while let Some(place) = square.place_of_quarters() {
            bits -= 1;
            square = self.quarters[place][quarter(x, y, bits)];
        }
        Some((square, bits))
    }

    /// Returns the answer for a point on the rim or the diagonal of its square, by a short walk. `None` in
    /// and beside a hole, and at the coarse nodes, where parts of the domain may touch that no walk joins.
    fn on_a_line(&self, square: LocatorSquare, p: DVec2) -> Option<Location> {
        let at_coarse_node = p % f64::from(self.mesh.lattice.cell_steps()) == DVec2::ZERO;
        let hint = [square.below, square.above & !FLAG].into_iter().find(|&id| id != NOTHING)?;
        match self.mesh.walk(TriangleId(hint), p) {
            WalkEnd::Found(id, sides) if !at_coarse_node => Some(self.mesh.lowest_round(id, sides)),
            _ => None,
        }
    }
}

/// Which quarter of the square around it a square of side 2^`bits` is.
#[inline]
fn quarter(x: u32, y: u32, bits: u32) -> usize {
    (((y >> bits) & 1) << 1 | ((x >> bits) & 1)) as usize
}
