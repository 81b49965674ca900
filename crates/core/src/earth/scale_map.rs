//! The scale of a projection over a lattice.

use glam::{DVec2, dvec2};

use super::Projection;
use super::squares::SquareGrid;
use crate::geometry::{Lattice, LatticePoint, Rect};

/// Lower bounds of the scale k in the dyadic squares of a lattice.
///
/// ```text
///    larger squares         cells             within a cell
///   +-------+-------+     +---+---+---+     +-----------+
///   |       |       |     |   |   |   |     |     ___---|   k is at least an affine function: the one
///   | least of four |     +---+---+---+     |__---      |   through its values at the cell, less by
///   |       |       |     |   |   |   |     |   .   .   |   the most by which k curves away from it
///   +-------+-------+     +---+---+---+     +-----------+
/// ```
///
/// The bound of a square is never lower than that of a square around it, so that a rule which divides by it
/// stays monotone. Bounds are rounded down to one of a few *bands*, for tables.
#[derive(Debug)]
pub struct ScaleMap {
    /// Squares of 2^bits lattice steps.
    bits: u32,
    columns: u32,
    /// Row by row from the lowest.
    cells: Vec<Cell>,
    /// The first and the last band in squares of 2^bits steps, then in those twice as wide, up to one that
    /// holds the lattice.
    larger: Vec<SquareGrid<[u16; 2]>>,
    bands: Bands,
}

/// Bounds of ln k in a cell.
#[derive(Debug)]
struct Cell {
    /// The affine bound at the lower left corner.
    at_corner: f64,
    /// Its growth for each lattice step along x and y.
    slopes: [f64; 2],
    /// Never lower than this, from the closed formula.
    least: f64,
    /// Never greater than this.
    greatest: f64,
}

/// Steps of ln k.
#[derive(Clone, Copy, Debug)]
struct Bands {
    least: f64,
    step: f64,
    count: u16,
}

/// Cells along the longer side of the lattice, at least half as many.
const CELLS_BITS: u32 = 5;
/// Scales in one band differ by this share or less, where [`MOST_BANDS`] are enough.
const STEP: f64 = 5e-4;
/// The number of bands, at most.
const MOST_BANDS: f64 = 256.0;
/// All bands together are at least so wide.
const LEAST_RANGE: f64 = 1e-9;
/// Scales above this multiple of the least one are in the last band: they lie outside a domain, in a corner
/// of the lattice.
const MOST_RATIO: f64 = 8.0;
/// A cell is bounded by this multiple of the largest deviation from the affine function at nine points.
const SAFETY: f64 = 1.5;

impl ScaleMap {
    /// Returns the map of a projection whose plane has the lattice.
    pub fn new(projection: &Projection, lattice: &Lattice) -> Self {
        let extent = lattice.extent();
        let bits = (extent.x.max(extent.y).max(1).ilog2() + 1).saturating_sub(CELLS_BITS);
        let [columns, rows] = [extent.x, extent.y].map(|side| side.div_ceil(1 << bits));
        let samples = ScaleSamples::new(projection, lattice, bits, [columns, rows]);
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        let cells: Vec<Cell> =
            places.map(|place| samples.cell(place, samples.least_in(projection, place))).collect();
        let bands = Bands::of(&cells, 1 << bits);
        let mut map = Self { bits, columns, cells, larger: Vec::new(), bands };
        map.larger = map.larger_squares();
        map
    }

    fn larger_squares(&self) -> Vec<SquareGrid<[u16; 2]>> {
        let side = 1 << self.bits;
        let of_cell = |cell: &Cell| {
            [self.bands.of_value(cell.least_in([0, 0], side)), self.bands.of_value(cell.greatest)]
        };
        let cells = SquareGrid::new(self.columns, self.cells.iter().map(of_cell).collect());
        cells.pyramid(|a: [u16; 2], b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Returns the number of bands.
    pub fn band_count(&self) -> usize {
        usize::from(self.bands.count)
    }

    /// Returns an upper bound of the scale, except in corners of the lattice outside a domain.
    pub fn greatest(&self) -> f64 {
        self.scale_of(self.band_count())
    }

    /// Returns the least scale of a band.
    pub fn scale_of(&self, band: usize) -> f64 {
        libm::exp(self.bands.least + band as f64 * self.bands.step)
    }

    /// Returns the band of the least scale in the square of 2^bits lattice steps that is number `place` along
    /// x and y.
    #[inline]
    pub fn band_in(&self, bits: u32, place: [u32; 2]) -> usize {
        if bits >= self.bits {
            return usize::from(self.larger_at(bits, place)[0]);
        }
        let within = self.bits - bits;
        let [column, row] = place.map(|place| place >> within);
        let cell = &self.cells[(row * self.columns + column) as usize];
        let offset = place.map(|place| (place & ((1 << within) - 1)) << bits);
        usize::from(self.bands.of_value(cell.least_in(offset, 1 << bits)))
    }

    /// Returns the bands of the minimum and the maximum scale in such a square.
    pub fn bands_in(&self, bits: u32, place: [u32; 2]) -> [usize; 2] {
        let around = self.larger_at(bits, place.map(|place| place >> self.bits.saturating_sub(bits)));
        [self.band_in(bits, place), usize::from(around[1])]
    }

    /// Returns the band of the least scale in the dyadic square around a triangle of a level.
    #[inline]
    pub fn band_around(&self, [a, b, c]: [LatticePoint; 3], level: u32, halvings: u32) -> usize {
        let bits = halvings.saturating_sub(level / 2);
        self.band_in(bits, [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)].map(|v| v >> bits))
    }

    #[inline]
    fn larger_at(&self, bits: u32, place: [u32; 2]) -> [u16; 2] {
        let larger = self.larger.get(bits.saturating_sub(self.bits) as usize);
        larger.map_or([0, self.bands.count - 1], |larger| larger.at(place))
    }
}

impl Cell {
    /// Returns the least bound in the square of `side` lattice steps at an offset in the cell.
    #[inline]
    fn least_in(&self, offset: [u32; 2], side: u32) -> f64 {
        // Each sum is rounded the same way for all squares, so a square in another one has no lower bound.
        let term = |axis: usize| {
            let low = if self.slopes[axis] > 0.0 { offset[axis] } else { offset[axis] + side };
            self.slopes[axis] * f64::from(low)
        };
        (self.at_corner + (term(0) + term(1))).max(self.least)
    }
}

impl Bands {
    /// Returns the bands for cells with sides of `side` lattice steps.
    fn of(cells: &[Cell], side: u32) -> Self {
        let least = cells.iter().map(|cell| cell.least_in([0, 0], side)).fold(f64::INFINITY, f64::min);
        let greatest = cells.iter().map(|cell| cell.greatest).fold(least, f64::max);
        let range = (greatest - least).clamp(LEAST_RANGE, libm::log(MOST_RATIO));
        let count = (range / STEP).ceil().clamp(1.0, MOST_BANDS);
        Self { least, step: range / count, count: count as u16 }
    }

    /// Returns the band of a value of ln k.
    #[inline]
    fn of_value(self, value: f64) -> u16 {
        (((value - self.least) / self.step) as u16).min(self.count - 1)
    }
}

/// ln k at the corners, the middles of the sides, and the centres of cells.
struct ScaleSamples {
    origin: DVec2,
    /// Half a cell in world units.
    half: DVec2,
    columns: usize,
    values: Vec<f64>,
    /// The sides of a cell in lattice steps.
    side: f64,
}

impl ScaleSamples {
    fn new(projection: &Projection, lattice: &Lattice, bits: u32, cells: [u32; 2]) -> Self {
        let (origin, side) = (lattice.bounds().min, f64::from(1u32 << bits));
        let half = 0.5 * side * lattice.step();
        let [columns, rows] = cells.map(|count| 2 * count as usize + 1);
        let at = |number: usize| origin + half * dvec2((number % columns) as f64, (number / columns) as f64);
        let values = (0..columns * rows).map(|number| libm::log(projection.scale_in_plane(at(number))));
        Self { origin, half, columns, values: values.collect(), side }
    }

    /// Returns a lower bound of ln k in a cell, from the closed formula.
    fn least_in(&self, projection: &Projection, place: [u32; 2]) -> f64 {
        let min = self.origin + 2.0 * self.half * DVec2::from(place.map(f64::from));
        libm::log(projection.least_scale_in(&Rect::new(min, min + 2.0 * self.half)))
    }

    fn cell(&self, [column, row]: [u32; 2], least: f64) -> Cell {
        let first = 2 * (row as usize * self.columns + column as usize);
        let at = |x: usize, y: usize| self.values[first + y * self.columns + x];
        let middle = at(1, 1);
        let growth = [at(2, 1) - at(0, 1), at(1, 2) - at(1, 0)];
        let affine =
            |x: usize, y: usize| middle + 0.5 * (growth[0] * (x as f64 - 1.0) + growth[1] * (y as f64 - 1.0));
        let places = (0..9).map(|n| (n % 3, n / 3));
        let (mut deviation, mut greatest) = (0.0_f64, f64::NEG_INFINITY);
        for (x, y) in places {
            deviation = deviation.max((at(x, y) - affine(x, y)).abs());
            greatest = greatest.max(at(x, y));
        }
        let margin = SAFETY * deviation;
        if !margin.is_finite() {
            // Beyond the edge of the projection, or at the tip of a cone.
            return Cell { at_corner: least, slopes: [0.0; 2], least, greatest: f64::MAX };
        }
        Cell {
            at_corner: affine(0, 0) - margin,
            slopes: growth.map(|growth| growth / self.side),
            least,
            greatest: greatest + margin,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A projection, and a rectangle of its plane; with the tip of the cone, where the scale is infinite.
    fn planes() -> Vec<(Projection, Rect, bool)> {
        let rect =
            |x: f64, y: f64, width: f64, height: f64| Rect::new(dvec2(x, y), dvec2(x + width, y + height));
        let planes = [
            ("+proj=merc +lat_ts=0 +ellps=WGS84 +units=m", rect(-3e6, -2e6, 5e6, 9e6)),
            ("+proj=merc +lat_ts=60 +lon_0=20 +ellps=WGS84 +units=m", rect(-8e5, 3.5e6, 1.6e6, 1.5e6)),
            ("+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m", rect(-2.5e5, 4e6, 9e5, 1.3e6)),
            ("+proj=stere +lat_0=90 +lat_ts=70 +lon_0=-45 +ellps=WGS84 +units=m", rect(-2e6, -1e6, 5e6, 3e6)),
            (
                "+proj=lcc +lat_1=35 +lat_2=65 +lat_0=52 +lon_0=10 +ellps=WGS84 +units=m",
                rect(-2e6, -2e6, 4e6, 3e6),
            ),
            (
                "+proj=lcc +lat_1=60 +lat_2=60 +lat_0=60 +lon_0=0 +ellps=WGS84 +units=m",
                rect(-3e6, 0.0, 5e6, 5e6),
            ),
        ];
        planes.map(|(text, rect)| (text.parse().unwrap(), rect, text.contains("lat_0=60"))).to_vec()
    }

    /// Returns a random dyadic square that lies on the lattice, as bits and place.
    fn square(lattice: &Lattice, random: &mut fastrand::Rng) -> (u32, [u32; 2]) {
        let bits = random.u32(0..=lattice.halvings());
        let LatticePoint { x, y } = lattice.extent();
        (bits, [x, y].map(|side| random.u32(0..side >> bits)))
    }

    #[test]
    fn the_scale_in_a_square_is_between_its_bands() {
        let mut random = fastrand::Rng::with_seed(5);
        for (projection, bounds, has_tip) in planes() {
            let lattice = Lattice::covering(bounds, bounds.size().max_element() / 24.0, 100_000).unwrap();
            let map = ScaleMap::new(&projection, &lattice);
            let mut loosest = 1.0_f64;
            for _ in 0..4000 {
                let (bits, place) = square(&lattice, &mut random);
                let corner = bounds.min + lattice.step() * DVec2::from(place.map(|n| f64::from(n << bits)));
                let side = lattice.step() * f64::from(1u32 << bits);
                let scales = (0..30).map(|n| {
                    // Corners too: there, most scales are the least or the greatest.
                    let share = dvec2(random.f64(), random.f64());
                    let share = if n < 4 { dvec2(f64::from(n % 2), f64::from(n / 2)) } else { share };
                    projection.scale_in_plane(corner + share * side)
                });
                let [least, greatest] =
                    scales.fold([f64::INFINITY, 0.0], |[a, b], k: f64| [a.min(k), b.max(k)]);
                let bands = map.bands_in(bits, place);
                let bound = map.scale_of(bands[0]);
                assert!(bound <= least * (1.0 + 1e-12), "{projection}: {bound} in a square with {least}");
                let is_last = bands[1] + 1 == map.band_count();
                assert!(is_last || map.scale_of(bands[1] + 1) >= greatest * (1.0 - 1e-12), "{projection}");
                if !has_tip {
                    loosest = loosest.max(least / bound);
                }
            }
            // A band is up to 0.8 % wide where scales range up to the eightfold.
            assert!(loosest < 1.01, "{projection}: {loosest}");
        }
    }

    #[test]
    fn a_square_in_another_one_has_no_lower_band() {
        let mut random = fastrand::Rng::with_seed(6);
        for (projection, bounds, _) in planes() {
            let lattice = Lattice::covering(bounds, bounds.size().max_element() / 7.0, 100_000).unwrap();
            let map = ScaleMap::new(&projection, &lattice);
            for _ in 0..20_000 {
                let (bits, place) = square(&lattice, &mut random);
                let band = map.band_in(bits, place);
                let up = random.u32(1..8);
                let around = map.band_in(bits + up, place.map(|n| n >> up));
                assert!(around <= band, "{projection}: {around} around {band}");
            }
        }
    }

    #[test]
    fn a_plane_that_is_true_to_scale_where_it_begins_has_no_scale_below_one() {
        for (text, bounds) in [
            ("+proj=merc +lat_ts=54 +lon_0=20 +ellps=WGS84 +units=m", dvec2(-4e5, 4.2e6)),
            ("+proj=lcc +lat_1=50 +lat_2=50 +lat_0=50 +lon_0=10 +ellps=WGS84 +units=m", dvec2(-4e5, -3e5)),
        ] {
            let projection: Projection = text.parse().unwrap();
            let begin = match projection.kind() {
                super::super::ProjectionKind::Mercator => projection.plane_from_geographic(dvec2(10.0, 54.0)),
                _ => bounds,
            };
            let bounds = Rect::new(begin, begin + dvec2(9e5, 6e5));
            let map = ScaleMap::new(&projection, &Lattice::covering(bounds, 3e4, 100_000).unwrap());
            assert!((map.scale_of(0) - 1.0).abs() < 1e-13, "{text}: {}", map.scale_of(0));
        }
    }
}
