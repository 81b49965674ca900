//! The segments nearest to a point, of many.

use std::borrow::Cow;

use glam::DVec2;

use crate::geometry::{Rect, nearest_on_segment};

/// Segments in a grid of square cells, about one cell for each segment.
#[derive(Clone, Debug)]
pub struct SegmentGrid<'a> {
    segments: Cow<'a, [[DVec2; 2]]>,
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
    pub fn new(segments: impl Into<Cow<'a, [[DVec2; 2]]>>) -> Option<Self> {
        let segments = segments.into();
        let bounds =
            segments.iter().map(|&[a, b]| Rect::new(a.min(b), a.max(b))).reduce(|a, b| a.union(&b))?;
        let extent = bounds.size();
        let longer = extent.max_element();
        let across = (segments.len() as f64).sqrt().clamp(1.0, MOST_CELLS);
        let cell = if longer > 0.0 { longer / across } else { 1.0 };
        let size = [extent.x, extent.y].map(|side| (side / cell) as usize + 1);
        let mut cells = vec![Vec::new(); size[0] * size[1]];
        let mut grid = Self { segments, min: bounds.min, cell, size, cells: Vec::new() };
        for (n, &[a, b]) in grid.segments.iter().enumerate() {
            for cell in grid.cells_touching(a.min(b), a.max(b)) {
                cells[cell].push(n as u32);
            }
        }
        grid.cells = cells;
        Some(grid)
    }

    /// A segment, by its number in the list.
    pub fn segment(&self, number: u32) -> [DVec2; 2] {
        self.segments[number as usize]
    }

    /// The distance from `p` to the nearest segment.
    pub fn distance(&self, p: DVec2) -> f64 {
        self.nearest(p, |_| true).map_or(f64::INFINITY, |(_, distance)| distance)
    }

    /// The nearest of the segments that `counts` accepts, with its distance from `p`. Of several, the first.
    pub fn nearest(&self, p: DVec2, counts: impl Fn(u32) -> bool) -> Option<(u32, f64)> {
        let [column, row] = self.cell_of(p);
        let mut nearest = (f64::INFINITY, u32::MAX);
        let rings = self.size[0].max(self.size[1]);
        // Rings of cells around that of the point. A point outside the grid is farther from every cell.
        for ring in 0..=rings {
            if nearest.0 <= (ring as f64 - 1.0) * self.cell {
                break;
            }
            self.visit_ring([column, row], ring, |segment| {
                let distance = distance_to_segment(p, self.segment(segment));
                if (distance, segment) < nearest && counts(segment) {
                    nearest = (distance, segment);
                }
            });
        }
        let (distance, segment) = nearest;
        distance.is_finite().then_some((segment, distance))
    }

    /// Calls `found` for each segment within a distance of `p`, with its distance: at least once.
    pub fn visit_within(&self, p: DVec2, reach: f64, mut found: impl FnMut(u32, f64)) {
        for cell in self.cells_touching(p - reach, p + reach) {
            for &segment in &self.cells[cell] {
                let distance = distance_to_segment(p, self.segment(segment));
                if distance <= reach {
                    found(segment, distance);
                }
            }
        }
    }

    /// The numbers of the cells that touch a rectangle; those at the rim stand for what is beyond.
    fn cells_touching(&self, min: DVec2, max: DVec2) -> impl Iterator<Item = usize> + use<> {
        let ([left, low], [right, high], columns) = (self.cell_of(min), self.cell_of(max), self.size[0]);
        (low..=high).flat_map(move |row| (left..=right).map(move |column| row * columns + column))
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

fn distance_to_segment(p: DVec2, segment: [DVec2; 2]) -> f64 {
    p.distance(nearest_on_segment(p, segment))
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
                let distances: Vec<f64> =
                    segments.iter().map(|&segment| distance_to_segment(p, segment)).collect();
                let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
                assert_eq!(grid.distance(p), nearest, "{count} segments, {p}");
                let odd = (1..count).step_by(2).map(|n| distances[n]).reduce(f64::min);
                let found = grid.nearest(p, |segment| segment % 2 == 1);
                assert_eq!(found.map(|(_, distance)| distance), odd, "{count} segments, {p}");
                let mut within = Vec::new();
                grid.visit_within(p, 1.5 * nearest, |segment, _| within.push(segment as usize));
                within.sort_unstable();
                within.dedup();
                let expected: Vec<usize> = (0..count).filter(|&n| distances[n] <= 1.5 * nearest).collect();
                assert_eq!(within, expected, "{count} segments, {p}");
            }
        }
        let none: &[[DVec2; 2]] = &[];
        assert!(SegmentGrid::new(none).is_none());
    }
}
