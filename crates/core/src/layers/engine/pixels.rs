//! The range of the pixels that touch a triangle, read one by one.
//!
//! ```text
//!   +---+---+---+---+     In each row of pixels, those that touch a closed triangle are neighbours: the
//!   |   |  /|   |   |     first and the last one follow from its extents along x, x + y and x − y.
//!   +---+-/-+---+---+
//!   |   |/__|___|   |
//!   +---+---+---+---+
//! ```

use crate::geometry::Octagon;
use crate::raster::{ValueRange, ValueRanges};

use super::cells::{Cells, GridOnLattice};

/// Pixels are read one by one where a triangle spans at most 2⁴ of them, and those that it touches beside
/// them.
const FINER_SCALES: i32 = 4;
/// The most pixels along an axis that are read one by one.
const MOST_PIXELS: usize = (1 << FINER_SCALES) + 2;

/// Returns the range of the values of the pixels that touch a closed triangle; `None` where they are too
/// many, or not quick to read. `around` are the cells around the triangle.
///
/// All triangles within this one touch no other pixels.
pub fn range_touching(
    raster: &impl ValueRanges,
    grid: &GridOnLattice,
    triangle: &Octagon,
    around: &Cells,
) -> Option<ValueRange> {
    let scale = (grid.scale_of(around) - FINER_SCALES).max(raster.finest());
    // Each pixel has a cell: it is at least two lattice steps wide.
    if scale > 0 || grid.log_steps() + scale < 1 {
        return None;
    }
    let place = |[x, y]: [i64; 2]| Some([i32::try_from(x).ok()?, i32::try_from(y).ok()?]);
    let [low, high] = grid.squares(scale, around).map(place);
    let (low, high) = (low?, high?);
    let [width, height] = [0, 1].map(|axis: usize| high[axis].abs_diff(low[axis]) as usize + 1);
    if width.max(height) > MOST_PIXELS {
        return None;
    }
    let mut values = [0.0; MOST_PIXELS * MOST_PIXELS];
    if !raster.copy_values(scale, low, high, &mut values) {
        return None;
    }
    let mut lines = [[0; MOST_PIXELS + 1]; 2];
    grid.lines_from(scale, 0, low[0].into(), &mut lines[0][..=width]);
    grid.lines_from(scale, 1, low[1].into(), &mut lines[1][..=height]);
    let (columns, rows) = (&lines[0][..=width], &lines[1][..=height]);
    let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
    for (values, row) in values.chunks_exact(width).zip(rows.windows(2)) {
        let [left, right] = triangle.span_between(row[0], row[1]);
        let first = columns[1..].iter().take_while(|&&end| end < left).count();
        let behind = columns[..width].iter().rev().take_while(|&&start| start > right).count();
        for &value in &values[first..width - behind] {
            least = if value < least { value } else { least };
            greatest = if value > greatest { value } else { greatest };
        }
    }
    Some(ValueRange { least, greatest })
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Mesh};
    use crate::raster::{PixelGrid, Tile, TilePlace, TiledRaster};

    /// Returns a raster of random pixels, with finer ones in places and none in others.
    fn raster(random: &mut fastrand::Rng) -> TiledRaster {
        let origin = dvec2(random.f64() - 1.0, random.f64() - 1.0);
        let pixel = dvec2(0.01 + 0.02 * random.f64(), 0.01 + 0.02 * random.f64());
        let mut raster = TiledRaster::new(PixelGrid { origin, pixel }, f32::INFINITY);
        let mut put = |place, random: &mut fastrand::Rng| {
            let values: Vec<f32> = (0..1024).map(|_| random.f32()).collect();
            raster.exchange(place, Tile::from_values(&values).map(Into::into));
        };
        for (x, y) in (-1..4).flat_map(|y| (-1..4).map(move |x| (x, y))) {
            if random.u8(..4) == 0 {
                continue;
            }
            let place = TilePlace { depth: 0, x, y };
            put(place, random);
            let child = place.children()[random.usize(..4)];
            if random.bool() {
                put(child, random);
            }
        }
        raster
    }

    /// Returns the range of all squares at the finest scale that have a cell and touch a triangle.
    fn range_of_squares(
        raster: &TiledRaster,
        grid: &GridOnLattice,
        triangle: &Octagon,
        around: &Cells,
    ) -> ValueRange {
        let scale = raster.finest();
        let [low, high] = grid.squares(scale, around);
        let places = (low[1]..=high[1]).flat_map(|y| (low[0]..=high[0]).map(move |x| [x, y]));
        let touching = places.filter(|&[x, y]| {
            let cells = grid.square(scale, x, y);
            cells.intersection(around).is_some() && triangle.meets(&cells.octagon())
        });
        let ranges = touching.map(|place| raster.range_anywhere(scale, place));
        ranges.reduce(ValueRange::union).expect("a triangle touches a pixel")
    }

    #[test]
    fn the_range_is_that_of_all_pixels_that_touch_the_triangle() {
        let mut random = fastrand::Rng::with_seed(4);
        let [mut read, mut not_read] = [0; 2];
        for _ in 0..40 {
            let raster = raster(&mut random);
            let lattice = Lattice::covering(Rect::UNIT, 0.3, 1_000_000).expect("a lattice");
            let grid = GridOnLattice::new(raster.grid(), &lattice);
            let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).expect("a coarse grid");
            let level = random.u32(0..9);
            mesh.refine(&Limits::default(), |element| element.triangle.level() < level).expect("a mesh");
            for (id, _) in mesh.triangles().step_by(7) {
                let triangle = Octagon::triangle(mesh.corners(id));
                let around = Cells::around(&triangle, lattice.extent());
                match range_touching(&raster, &grid, &triangle, &around) {
                    Some(range) => {
                        assert_eq!(range, range_of_squares(&raster, &grid, &triangle, &around), "{id:?}");
                        read += 1;
                    }
                    None => not_read += 1,
                }
            }
        }
        assert!(read > 1_000 && not_read > 50, "{read} {not_read}");
    }
}
