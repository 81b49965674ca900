//! The distance from a point to the nearest of many segments.

use glam::DVec2;

use crate::geometry::Rect;

/// Segments in a grid of square cells, about one cell for each segment.
pub struct SegmentGrid<'a> {
    segments: &'a [[DVec2; 2]],
    min: DVec2,
    /// Side of a cell, in world units.
    cell: f64,
    /// [columns, rows].
    size: [usize; 2],
    /// For each cell, row by row, the segments whose bounding box touches it.
    cells: Vec<Vec<u32>>,
}

/// Most cells along a side.
const MOST_CELLS: f64 = 2048.0;

impl<'a> SegmentGrid<'a> {
    /// Sorts segments into a grid; `None` without segments.
    pub fn new(segments: &'a [[DVec2; 2]]) -> Option<Self> {
        let bounds =
            segments.iter().map(|&[a, b]| Rect::new(a.min(b), a.max(b))).reduce(|a, b| a.union(&b))?;
        let extent = bounds.size();
        let longer = extent.max_element();
        let across = (segments.len() as f64).sqrt().clamp(1.0, MOST_CELLS);
        let cell = if longer > 0.0 { longer / across } else { 1.0 };
        let size = [extent.x, extent.y].map(|side| (side / cell) as usize + 1);
        let mut grid =
            Self { segments, min: bounds.min, cell, size, cells: vec![Vec::new(); size[0] * size[1]] };
        for (n, &[a, b]) in segments.iter().enumerate() {
            let ([left, low], [right, high]) = (grid.cell_of(a.min(b)), grid.cell_of(a.max(b)));
            for (row, column) in (low..=high).flat_map(|row| (left..=right).map(move |column| (row, column)))
            {
                grid.cells[row * size[0] + column].push(n as u32);
            }
        }
        Some(grid)
    }

    /// The distance from `p` to the nearest segment.
    pub fn distance(&self, p: DVec2) -> f64 {
        let [column, row] = self.cell_of(p);
        let mut nearest = f64::INFINITY;
        let rings = self.size[0].max(self.size[1]);
        // Rings of cells around that of the point. A point outside the grid is farther from every cell.
        for ring in 0..=rings {
            if nearest <= (ring as f64 - 1.0) * self.cell {
                break;
            }
            self.visit_ring([column, row], ring, |segment| {
                nearest = nearest.min(distance_to_segment(p, self.segments[segment as usize]));
            });
        }
        nearest
    }

    fn visit_ring(&self, [column, row]: [usize; 2], ring: usize, mut visit: impl FnMut(u32)) {
        let range = |middle: usize, size: usize| middle.saturating_sub(ring)..=(middle + ring).min(size - 1);
        for y in range(row, self.size[1]) {
            let whole_row = y.abs_diff(row) == ring;
            for x in range(column, self.size[0]).filter(|x| whole_row || x.abs_diff(column) == ring) {
                self.cells[y * self.size[0] + x].iter().for_each(|&segment| visit(segment));
            }
        }
    }

    /// The cell of a point, or the nearest one.
    fn cell_of(&self, p: DVec2) -> [usize; 2] {
        let at = ((p - self.min) / self.cell).max(DVec2::ZERO);
        [(at.x as usize).min(self.size[0] - 1), (at.y as usize).min(self.size[1] - 1)]
    }
}

fn distance_to_segment(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let share = if along == DVec2::ZERO {
        0.0
    } else {
        ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0)
    };
    p.distance(a + share * along)
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn the_nearest_of_all_segments_is_found() {
        let mut random = fastrand::Rng::with_seed(3);
        for count in [1, 2, 7, 500] {
            let mut place = || dvec2(random.f64(), 0.3 * random.f64());
            let segments: Vec<[DVec2; 2]> = (0..count)
                .map(|_| {
                    let a = place();
                    [a, a + 0.1 * (place() - dvec2(0.5, 0.1))]
                })
                .collect();
            let grid = SegmentGrid::new(&segments).unwrap();
            for _ in 0..300 {
                let p = 3.0 * (place() - dvec2(0.3, 0.1));
                let nearest = segments
                    .iter()
                    .map(|&segment| distance_to_segment(p, segment))
                    .fold(f64::INFINITY, f64::min);
                assert_eq!(grid.distance(p), nearest, "{count} segments, {p}");
            }
        }
        assert!(SegmentGrid::new(&[]).is_none());
    }
}
