//! How a locator is built.
//!
//! ```text
//!   sort     triangles by the size of their squares; small ones by bands of the table     all threads
//!   table    the large triangles, from the largest, with a division for each size         one thread
//!   bands    the small ones, in quarters below the squares of each band                   all threads
//!   join     the quarters of all bands in one array                                       all threads
//! ```

use std::ops::Range;

use rayon::prelude::*;

use super::{Half, Locator, LocatorSquare, Table, quarter};
use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Mesh, TriangleId, make_room};

/// Triangles that one thread sorts at a time, at least.
const TRIANGLES: usize = 1 << 16;

/// The rows of the table of small triangles, in bands of which each thread fills one at a time.
#[derive(Clone, Copy)]
struct Bands {
    /// How often the coarse cells are divided into the squares of the table.
    divisions: usize,
    /// Binary logarithm of the side of these squares, in lattice steps.
    side_bits: u32,
    rows: usize,
    rows_of_band: usize,
}

/// Some triangles, sorted by depth. The depth of a triangle is the number of times that the coarse cell is
/// halved for its squares.
struct Sorted {
    /// Triangles in squares of the table or in larger squares, by depth.
    large: Vec<Vec<TriangleId>>,
    /// The others by band, and there by depth. Some are in two bands.
    small: Vec<Vec<Vec<TriangleId>>>,
}

impl<'m> Locator<'m> {
    /// Builds the tree on all threads, in time proportional to the mesh.
    pub fn new(mesh: &'m Mesh) -> Self {
        let mut table = Table::of_coarse_cells(&mesh.lattice);
        let bands = Bands::new(mesh, table.squares.len());
        let count = mesh.triangles.len();
        let step = TRIANGLES.max(count.div_ceil(4 * rayon::current_num_threads()));
        let starts: Vec<usize> = (0..count).step_by(step).collect();
        let chunk = |&start: &usize| start..count.min(start + step);
        let sorted: Vec<Sorted> = starts.par_iter().map(|start| bands.sort(mesh, chunk(start))).collect();
        // Larger triangles come first: a square is divided only for a smaller triangle, and its parts inherit
        // its contents.
        for depth in 0..=bands.divisions {
            if depth > 0 {
                table.divide();
            }
            for &id in sorted.iter().flat_map(|sorted| &sorted.large[depth]) {
                for half in halves(mesh, id) {
                    let number = table.number(half.origin.x, half.origin.y);
                    table.squares[number].cover(&half, id);
                }
            }
        }
        let quarters = bands.quarters(mesh, &mut table, &sorted);
        Self { mesh, table, quarters }
    }
}

/// Returns how often the coarse cell is halved for the squares of a triangle: of level 0; 1 and 2; 3 and 4; …
fn depth_of(level: u32) -> usize {
    level.div_ceil(2) as usize
}

impl Bands {
    /// Chooses the divisions so that the table has at most one square for eight triangles.
    fn new(mesh: &Mesh, coarse_cells: usize) -> Self {
        let deepest = depth_of(mesh.level_counts().len().saturating_sub(1) as u32);
        let is_wanted = |&n: &usize| 8 * (coarse_cells << (2 * (n - 1))) <= mesh.triangles.len();
        let divisions = (1..=deepest).take_while(is_wanted).count();
        let rows = (mesh.lattice.cells()[1] as usize) << divisions;
        let count = if mesh.triangles.len() < TRIANGLES { 1 } else { 4 * rayon::current_num_threads() };
        let side_bits = mesh.lattice.halvings() - divisions as u32;
        Self { divisions, side_bits, rows, rows_of_band: rows.div_ceil(count).max(1) }
    }

    fn count(&self) -> usize {
        self.rows.div_ceil(self.rows_of_band)
    }

    /// Returns the band with a square.
    fn of(&self, half: &Half) -> usize {
        (half.origin.y >> self.side_bits) as usize / self.rows_of_band
    }

    /// Sorts some triangles of the mesh.
    fn sort(&self, mesh: &Mesh, ids: Range<usize>) -> Sorted {
        let depths = depth_of(mesh.level_counts().len() as u32) + 1;
        let mut sorted = Sorted {
            large: vec![Vec::new(); self.divisions + 1],
            small: vec![vec![Vec::new(); depths.saturating_sub(self.divisions)]; self.count()],
        };
        // Walks examine the squares without a triangle once more, to find those outside the domain.
        for id in ids.map(TriangleId::from_index).filter(|&id| !mesh.triangle(id).is_outside()) {
            let depth = depth_of(mesh.triangle(id).level());
            if depth <= self.divisions {
                sorted.large[depth].push(id);
                continue;
            }
            let mut last = None;
            for band in halves(mesh, id).map(|half| self.of(&half)) {
                if last.replace(band) != Some(band) {
                    sorted.small[band][depth - self.divisions - 1].push(id);
                }
            }
        }
        sorted
    }

    /// Puts the small triangles into quarters below the squares of the table.
    fn quarters(&self, mesh: &Mesh, table: &mut Table, sorted: &[Sorted]) -> Vec<[LocatorSquare; 4]> {
        let (columns, side_bits) = (table.columns, table.side_bits);
        let squares_of_band = columns * self.rows_of_band;
        let bands = table.squares.par_chunks_mut(squares_of_band).enumerate();
        let parts: Vec<Vec<[LocatorSquare; 4]>> = bands
            .map(|(number, squares)| {
                let first = number * squares_of_band;
                let mut band = Band { columns, side_bits, first, squares, quarters: Vec::new() };
                self.fill(mesh, &mut band, number, sorted);
                band.quarters
            })
            .collect();
        join(table, squares_of_band, parts)
    }

    /// Puts the small triangles of a band into quarters below its squares.
    fn fill(&self, mesh: &Mesh, band: &mut Band, number: usize, sorted: &[Sorted]) {
        let depths = sorted.first().map_or(0, |sorted| sorted.small[number].len());
        for step in 0..depths {
            let bits = self.side_bits.saturating_sub(step as u32 + 1);
            for &id in sorted.iter().flat_map(|sorted| &sorted.small[number][step]) {
                for half in halves(mesh, id).filter(|half| self.of(half) == number) {
                    band.square_mut(half.origin, bits).cover(&half, id);
                }
            }
        }
    }
}

/// Returns the quarters of all bands in one array; divided squares get the places there.
fn join(
    table: &mut Table,
    squares_of_band: usize,
    mut parts: Vec<Vec<[LocatorSquare; 4]>>,
) -> Vec<[LocatorSquare; 4]> {
    let (mut firsts, mut total) = (Vec::new(), 0);
    for part in &parts {
        firsts.push(total);
        total += part.len();
    }
    let bands = table.squares.par_chunks_mut(squares_of_band).zip(&mut parts).zip(firsts);
    bands.filter(|(_, first)| *first > 0).for_each(|((squares, part), first)| {
        let below = part.iter_mut().flatten();
        squares.iter_mut().chain(below).for_each(|square| square.move_quarters(first));
    });
    if let [_] = parts[..] {
        return parts.swap_remove(0);
    }
    let mut all = Vec::new();
    make_room(&mut all, total, total);
    parts.iter().for_each(|part| all.extend_from_slice(part));
    all
}

/// Some rows of the table, and the quarters below them.
struct Band<'a> {
    columns: usize,
    side_bits: u32,
    /// The number of the first square in the table.
    first: usize,
    squares: &'a mut [LocatorSquare],
    quarters: Vec<[LocatorSquare; 4]>,
}

impl Band<'_> {
    /// Returns the square of side 2^`bits` with the given corner, after the divisions that this takes.
    fn square_mut(&mut self, origin: LatticePoint, bits: u32) -> &mut LocatorSquare {
        let row = (origin.y >> self.side_bits) as usize;
        let number = row * self.columns + (origin.x >> self.side_bits) as usize - self.first;
        let mut place = divide(&mut self.squares[number], &mut self.quarters);
        let mut side_bits = self.side_bits - 1;
        while side_bits > bits {
            let q = quarter(origin.x, origin.y, side_bits);
            let mut square = self.quarters[place][q];
            let finer = divide(&mut square, &mut self.quarters);
            self.quarters[place][q] = square;
            (place, side_bits) = (finer, side_bits - 1);
        }
        &mut self.quarters[place][quarter(origin.x, origin.y, bits)]
    }
}

fn divide(square: &mut LocatorSquare, quarters: &mut Vec<[LocatorSquare; 4]>) -> usize {
    square.place_of_quarters().unwrap_or_else(|| {
        quarters.push(square.quarters());
        *square = LocatorSquare::divided(quarters.len() - 1);
        quarters.len() - 1
    })
}

/// Returns the half squares that a triangle is made of: one at even levels, two at odd levels.
///
/// ```text
///     o                    apex
///     | \                  / | \       the right angle of each half is at the apex, or in the middle of the
///     |   \              /   |   \     bisection edge
///   apex---o            o----m----o
/// ```
fn halves(mesh: &Mesh, id: TriangleId) -> impl Iterator<Item = Half> {
    let triangle = mesh.triangle(id);
    let [a, b] = triangle.bisection_edge().map(|v| mesh.node(v));
    let apex = mesh.node(triangle.apex());
    let even = triangle.level().is_multiple_of(2);
    let halves = if even {
        [Some([apex, a, b]), None]
    } else {
        let middle = a.midpoint(b);
        [Some([middle, a, apex]), Some([middle, b, apex])]
    };
    halves.into_iter().flatten().map(|[corner, p, q]| {
        let origin = LatticePoint::new(corner.x.min(p.x).min(q.x), corner.y.min(p.y).min(q.y));
        let (right, above) = (corner.x > origin.x, corner.y > origin.y);
        Half { origin, rising: right != above, above }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::Limits;

    #[test]
    fn a_table_has_about_a_square_for_eight_triangles_and_no_more() {
        for level in 0..14 {
            let lattice = Lattice::covering(Rect::UNIT, 0.2, 100).unwrap();
            let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
            mesh.refine(&Limits::default(), |element| element.triangle.level() < level).unwrap();
            let cells = Table::of_coarse_cells(&lattice).squares.len();
            let (bands, triangles) = (Bands::new(&mesh, cells), mesh.triangles.len());
            let squares = cells << (2 * bands.divisions);
            // The last division may exceed it: it is the first whose squares before it were few enough.
            assert!(bands.divisions == 0 || 8 * squares <= 4 * triangles, "{level}: {squares}");
            assert!(8 * squares > triangles || bands.divisions == depth_of(level), "{level}: {squares}");
        }
    }
}
