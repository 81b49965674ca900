use std::error::Error;
use std::fmt;

use glam::DVec2;

use super::Rect;
use crate::text::{Grouped, Number};

/// Lattice coordinates stay at or below 2 to this power, so that differences fit an `i32` on the GPU.
pub const LATTICE_BITS: u32 = 30;

/// A point of the integer lattice: exact to compare, to hash and to halve.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct LatticePoint {
    /// Steps to the right of the lower left corner of the grid.
    pub x: u32,
    /// Steps upwards from the lower left corner of the grid.
    pub y: u32,
}

impl LatticePoint {
    /// Returns the point with the given lattice coordinates.
    pub const fn new(x: u32, y: u32) -> Self {
        Self { x, y }
    }

    /// Returns the point half way to `other`. Exact for the bisection edges of a mesh within its level cap.
    #[inline]
    pub fn midpoint(self, other: Self) -> Self {
        debug_assert!((self.x ^ other.x) & 1 == 0 && (self.y ^ other.y) & 1 == 0);
        // Coordinates stay below 2^31, so the sums fit.
        Self::new((self.x + other.x) / 2, (self.y + other.y) / 2)
    }

    /// Returns the lattice coordinates as real numbers; exact.
    #[inline]
    pub fn as_dvec2(self) -> DVec2 {
        DVec2::new(f64::from(self.x), f64::from(self.y))
    }
}

/// The grid of coarse cells over a rectangle, and the lattice that subdivides it
/// (Eqs. 15 and A1 to A5).
///
/// The report covers the domain with a square. Here each side has its own count of cells, so that a
/// rectangle is met exactly; cells are square to within 5 %, and exactly where the proportions
/// allow it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    bounds: Rect,
    cells: [u32; 2],
    halvings: u32,
    step: DVec2,
}

/// Why no coarse grid could be made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GridError {
    /// A corner is NaN or infinite, or a side is not positive.
    NotARectangle {
        /// The rectangle as given.
        bounds: Rect,
    },
    /// A side is so long or so short that squares of lengths are not finite and positive.
    Size {
        /// Width and height of the domain.
        size: DVec2,
    },
    /// The spacing is zero, negative, NaN or infinite.
    Spacing {
        /// The spacing as given.
        spacing: f64,
    },
    /// More coarse triangles than the budget allows.
    TooManyCells {
        /// The spacing as given.
        spacing: f64,
        /// Coarse triangles that it asks for.
        triangles: f64,
        /// Most coarse triangles allowed.
        limit: usize,
    },
    /// The domain is so narrow that too many cells of its width would be needed along the other side.
    TooNarrow {
        /// Width and height of the domain.
        size: DVec2,
        /// Coarse triangles that it asks for.
        triangles: f64,
        /// Most coarse triangles allowed.
        limit: usize,
    },
    /// The domain is so far from the origin, or so large, that f64 cannot tell its nodes apart.
    TooFarFromOrigin {
        /// The spacing as given.
        spacing: f64,
        /// The largest coordinate, as a distance from the origin.
        reach: f64,
    },
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotARectangle { bounds } => write!(
                f,
                "The domain {}, {} to {}, {} is not a rectangle: every corner must be a finite number and \
                 the second corner must lie right of and above the first.",
                Number(bounds.min.x),
                Number(bounds.min.y),
                Number(bounds.max.x),
                Number(bounds.max.y)
            ),
            Self::Size { size } => write!(
                f,
                "A domain of {} × {} cannot be meshed: its width and its height must lie between {:e} and {:e}, and no \
                 coordinate beyond that. Check the unit of the coordinates.",
                Number(size.x),
                Number(size.y),
                Rect::SHORTEST_SIDE,
                Rect::LONGEST_SIDE
            ),
            Self::Spacing { spacing } => write!(
                f,
                "A coarse spacing of {} makes no grid: it must be a positive, finite length. \
                 A twentieth of the domain's width is a good start.",
                Number(*spacing)
            ),
            Self::TooManyCells { spacing, triangles, limit } => write!(
                f,
                "A coarse spacing of {} would start with about {triangles:.3e} triangles, and the \
                 limit is {}. Choose a larger spacing.",
                Number(*spacing),
                Grouped(*limit)
            ),
            Self::TooNarrow { size, triangles, limit } => write!(
                f,
                "A domain of {} × {} is too narrow: cells nearly as long as wide would make about \
                 {triangles:.3e} triangles to start with, and the limit is {}. Choose a wider domain.",
                Number(size.x),
                Number(size.y),
                Grouped(*limit)
            ),
            Self::TooFarFromOrigin { spacing, reach } => write!(
                f,
                "The coarse spacing {} is too small for coordinates near {reach:e}: neighbouring nodes \
                 would have the same coordinates. Move the domain nearer to the origin or choose a larger spacing.",
                Number(*spacing)
            ),
        }
    }
}

impl Error for GridError {}

impl Lattice {
    /// Lays a grid of cells no wider than `spacing` (δ̄) over `bounds`, both in world units.
    ///
    /// # Errors
    /// Fails when `bounds` or `spacing` make no grid, or one of more than `max_triangles` coarse triangles.
    ///
    /// ```
    /// # use meshbrush_mesh::geometry::{Lattice, Rect};
    /// let lattice = Lattice::covering(Rect::UNIT, 0.3, 1000)?;
    /// assert_eq!(lattice.cells(), [4, 4]); // Eq. (15): δ = 1 / ⌈1 / 0.3⌉
    /// assert_eq!(lattice.spacing(), 0.25);
    /// # Ok::<(), meshbrush_mesh::geometry::GridError>(())
    /// ```
    pub fn covering(bounds: Rect, spacing: f64, max_triangles: usize) -> Result<Self, GridError> {
        let size = bounds.size();
        if !(size.is_finite() && size.cmpgt(DVec2::ZERO).all()) {
            return Err(GridError::NotARectangle { bounds });
        }
        if !bounds.is_proper() {
            return Err(GridError::Size { size });
        }
        if !(spacing > 0.0 && spacing.is_finite()) {
            return Err(GridError::Spacing { spacing });
        }
        let least = (size / spacing).max(DVec2::ONE);
        let triangles = 2.0 * least.x * least.y;
        // A single row may not be longer than the lattice either.
        if triangles > max_triangles as f64 || least.max_element() > f64::from(1u32 << (LATTICE_BITS - 1)) {
            return Err(GridError::TooManyCells { spacing, triangles, limit: max_triangles });
        }
        let cells = cells_per_side(size, spacing);
        let (fewest, triangles) = (triangles, 2.0 * cells[0] * cells[1]);
        if triangles > max_triangles as f64 || cells[0].max(cells[1]) > f64::from(1u32 << (LATTICE_BITS - 1))
        {
            // Rounding both sides to whole cells adds a few cells to the minimum.
            return Err(if triangles < 4.0 * fewest {
                GridError::TooManyCells { spacing, triangles, limit: max_triangles }
            } else {
                GridError::TooNarrow { size, triangles, limit: max_triangles }
            });
        }
        let cells = cells.map(|n| n as u32);
        let cell = size / DVec2::new(f64::from(cells[0]), f64::from(cells[1]));
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        let halvings = halvings_within(cells, cell, reach);
        if halvings < 1 {
            return Err(GridError::TooFarFromOrigin { spacing, reach });
        }
        // A power of two: the step is as exact as the cell.
        let step = cell / f64::from(1u32 << halvings);
        Ok(Self { bounds, cells, halvings: halvings as u32, step })
    }

    /// Returns the rectangle that the grid covers, in world units.
    pub fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Returns cells per row and rows (N_e per side).
    pub fn cells(&self) -> [u32; 2] {
        self.cells
    }

    /// Returns the side of a coarse cell δ in world units; the longer one where cells are not square.
    pub fn spacing(&self) -> f64 {
        (self.step * f64::from(self.cell_steps())).max_element()
    }

    /// Returns lattice steps along the side of a coarse cell, a power of two.
    pub fn cell_steps(&self) -> u32 {
        1 << self.halvings
    }

    /// Returns how often a coarse cell can be halved before nodes would leave the lattice.
    pub fn halvings(&self) -> u32 {
        self.halvings
    }

    /// Returns the deepest level of refinement whose nodes are lattice points.
    pub fn deepest_level(&self) -> u32 {
        2 * self.halvings
    }

    /// Returns the world length of one lattice step along x and y.
    pub fn step(&self) -> DVec2 {
        self.step
    }

    /// Returns the lattice coordinates of the upper right corner.
    pub fn extent(&self) -> LatticePoint {
        LatticePoint::new(self.cells[0] << self.halvings, self.cells[1] << self.halvings)
    }

    /// Returns the world coordinates of a lattice point (u of Eq. A2), exact at the four corners.
    #[inline]
    pub fn world_from_lattice(&self, p: LatticePoint) -> DVec2 {
        let extent = self.extent();
        DVec2::new(
            world_coordinate(self.bounds.min.x, self.bounds.max.x, self.step.x, extent.x, p.x),
            world_coordinate(self.bounds.min.y, self.bounds.max.y, self.step.y, extent.y, p.y),
        )
    }

    /// Returns the lattice coordinates of any point of the plane (u⁻¹ of Eq. A3), as real numbers.
    ///
    /// Consistent with [`Self::world_from_lattice`] in order, not only to rounding: a point with the x of a
    /// node gets the node's lattice x, and one ulp to its right gets more. NaN stays NaN.
    ///
    /// ```
    /// # use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
    /// let lattice = Lattice::covering(Rect::UNIT, 0.1, 1000)?;
    /// let node = LatticePoint::new(7 * lattice.cell_steps() / 4, 3);
    /// let world = lattice.world_from_lattice(node);
    /// assert_eq!(lattice.lattice_from_world(world), node.as_dvec2());
    /// # Ok::<(), meshbrush_mesh::geometry::GridError>(())
    /// ```
    #[inline]
    pub fn lattice_from_world(&self, p: DVec2) -> DVec2 {
        let extent = self.extent();
        DVec2::new(
            lattice_coordinate(self.bounds.min.x, self.bounds.max.x, self.step.x, extent.x, p.x),
            lattice_coordinate(self.bounds.min.y, self.bounds.max.y, self.step.y, extent.y, p.y),
        )
    }

    /// Returns the lattice point nearest to a point in world units; one of the rim for a point beyond.
    pub fn nearest(&self, p: DVec2) -> LatticePoint {
        let (p, extent) = (self.lattice_from_world(p), self.extent());
        let nearest = (p + DVec2::splat(0.5)).floor().clamp(DVec2::ZERO, extent.as_dvec2());
        LatticePoint::new(nearest.x as u32, nearest.y as u32)
    }
}

#[inline]
fn world_coordinate(min: f64, max: f64, step: f64, extent: u32, lattice: u32) -> f64 {
    if lattice == extent { max } else { min + f64::from(lattice) * step }
}

#[inline]
fn lattice_coordinate(min: f64, max: f64, step: f64, extent: u32, world: f64) -> f64 {
    let estimate = (world - min) / step;
    if !(estimate > -0.5 && estimate < f64::from(extent) + 0.5) {
        return estimate;
    }
    let nearest = (estimate + 0.5) as u32; // `round` is a call of a function on most machines
    let line = world_coordinate(min, max, step, extent, nearest);
    let nearest = f64::from(nearest);
    if world == line {
        nearest
    } else if world > line {
        estimate.max(nearest.next_up())
    } else {
        estimate.min(nearest.next_down())
    }
}

/// Returns cells along x and y: at least ⌈side / spacing⌉ each (Eq. A4), with the smallest counts that make
/// the cells square to within 5 %.
fn cells_per_side(size: DVec2, spacing: f64) -> [f64; 2] {
    let wide = size.x >= size.y;
    let (long, short) = if wide { (size.x, size.y) } else { (size.y, size.x) };
    let [fewest_long, fewest_short] = [long, short].map(|side| fewest_cells(side, spacing));
    let mut best = (f64::INFINITY, fewest_long, fewest_short);
    // With n cells on the short side the best proportion is within about 1 / 2n of square: 24 more suffice.
    for extra in 0..24 {
        let short_cells = fewest_short + f64::from(extra);
        let long_cells = (long * short_cells / short).round().max(fewest_long);
        let proportion = (long / long_cells) / (short / short_cells);
        let misfit = proportion.max(1.0 / proportion) - 1.0;
        if misfit < best.0 {
            best = (misfit, long_cells, short_cells);
        }
        if misfit <= 0.05 {
            break;
        }
    }
    let (_, long_cells, short_cells) = best;
    if wide { [long_cells, short_cells] } else { [short_cells, long_cells] }
}

/// Returns the least number of cells no wider than `spacing` along a side. The quotient of a side that is a
/// whole number of spacings may be rounded up beyond that number: 1 / (1 / 49) is above 49.
fn fewest_cells(side: f64, spacing: f64) -> f64 {
    let cells = (side / spacing).ceil().max(1.0);
    if cells > 1.0 && side / (cells - 1.0) <= spacing { cells - 1.0 } else { cells }
}

/// Returns how often a cell can be halved: the lattice must fit its bits, and its step must span several ulps
/// of the largest coordinate, so that distinct nodes have distinct world coordinates.
fn halvings_within(cells: [u32; 2], cell: DVec2, reach: f64) -> i32 {
    let by_bits = LATTICE_BITS as i32 - ceil_log2(cells[0].max(cells[1]));
    let ulp = reach.next_up() - reach;
    let mut halvings = 0;
    let mut step = cell.min_element();
    while halvings < by_bits && step / 2.0 >= 4.0 * ulp {
        step /= 2.0;
        halvings += 1;
    }
    halvings
}

fn ceil_log2(n: u32) -> i32 {
    (u32::BITS - (n - 1).leading_zeros()) as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn a_square_gets_the_reports_cell_count() {
        let mut random = fastrand::Rng::with_seed(35);
        for _ in 0..2_000 {
            let spacing = 0.02 + 1.5 * random.f64();
            // Eq. (15), but for a side that is a whole number of spacings up to rounding.
            let cells = ((1.0 / spacing) * (1.0 - 1e-12)).ceil() as u32;
            assert_eq!(
                Lattice::covering(Rect::UNIT, spacing, 10_000).unwrap().cells(),
                [cells; 2],
                "{spacing}"
            );
        }
        for cells in 1..60u32 {
            let spacing = 1.0 / f64::from(cells);
            assert_eq!(Lattice::covering(Rect::UNIT, spacing, 10_000).unwrap().cells(), [cells; 2]);
        }
    }

    #[test]
    fn a_rectangle_is_met_exactly_with_nearly_square_cells() {
        let mut random = fastrand::Rng::with_seed(36);
        let mut refused = 0;
        for _ in 0..2_000 {
            let [w, h, spacing] = [(); 3].map(|()| libm::exp10(4.0 * random.f64() - 2.0));
            let bounds = Rect::new(dvec2(-3.0, 5.0), dvec2(-3.0 + w, 5.0 + h));
            let Ok(lattice) = Lattice::covering(bounds, spacing, 1_000_000) else {
                refused += 1;
                continue;
            };
            let cell = lattice.step() * f64::from(lattice.cell_steps());
            assert!(cell.max_element() <= spacing * (1.0 + 1e-12), "{w} x {h}: {cell}");
            assert!(cell.max_element() / cell.min_element() <= 1.0501, "{w} x {h}: {cell}");
            assert_eq!(lattice.world_from_lattice(lattice.extent()), bounds.max);
        }
        assert!((10..1_000).contains(&refused), "{refused}");
    }

    #[test]
    fn world_and_lattice_agree_in_order_far_from_the_origin() {
        let bounds = Rect::new(dvec2(4.0e6 + 0.1, -7.7e6), dvec2(4.0e6 + 3.3, -7.7e6 + 3.2));
        let lattice = Lattice::covering(bounds, 0.7, 1000).unwrap();
        let extent = lattice.extent();
        for k in 0..1000u32 {
            let p = LatticePoint::new((extent.x / 1000) * k + k % 7, (extent.y / 1000) * k + k % 5);
            let world = lattice.world_from_lattice(p);
            assert_eq!(lattice.lattice_from_world(world), p.as_dvec2());
            let right = lattice.lattice_from_world(dvec2(world.x.next_up(), world.y));
            let left = lattice.lattice_from_world(dvec2(world.x.next_down(), world.y));
            assert!(left.x < f64::from(p.x) && f64::from(p.x) < right.x);
        }
    }

    #[test]
    fn hopeless_input_is_refused_with_the_rule() {
        let nan = Rect::new(dvec2(f64::NAN, 0.0), DVec2::ONE);
        assert!(matches!(Lattice::covering(nan, 0.1, 10), Err(GridError::NotARectangle { .. })));
        let huge = Rect::new(DVec2::splat(-f64::MAX), DVec2::splat(f64::MAX));
        assert!(matches!(Lattice::covering(huge, 0.1, 10), Err(GridError::NotARectangle { .. })));
        for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(Lattice::covering(Rect::UNIT, spacing, 10), Err(GridError::Spacing { .. })));
        }
        assert!(matches!(Lattice::covering(Rect::UNIT, 1e-300, 10), Err(GridError::TooManyCells { .. })));
        assert!(matches!(Lattice::covering(Rect::UNIT, 1e-5, 10), Err(GridError::TooManyCells { .. })));
        // One row of cells as narrow as the domain is a grid, but only within the budget.
        let narrow =
            |width: f64| Lattice::covering(Rect::new(DVec2::ZERO, dvec2(width, 1e-3)), width / 5.0, 1000);
        assert_eq!(narrow(0.4).unwrap().cells(), [400, 1]);
        for width in [1.0, 1e3, 1e9, 1e150] {
            assert!(matches!(narrow(width), Err(GridError::TooNarrow { .. })), "{width}");
        }
        for (x, y) in [(1e300, 1e-3), (1e300, 1e300), (1.0, 1e-121)] {
            let rect = Rect::new(DVec2::ZERO, dvec2(x, y));
            assert!(matches!(Lattice::covering(rect, x, 1000), Err(GridError::Size { .. })), "{x} {y}");
        }
        let far = Rect::new(dvec2(1e16, 0.0), dvec2(1e16 + 8.0, 8.0));
        assert!(matches!(Lattice::covering(far, 1.0, 1000), Err(GridError::TooFarFromOrigin { .. })));
    }
}
