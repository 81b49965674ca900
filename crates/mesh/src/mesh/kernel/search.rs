//! The search for the triangles that touch a rectangle, which updates and forecasts start from.

use super::{Bitset, Mesh, TriangleId, WalkEnd};
use crate::geometry::{LatticePoint, LatticeRect, NumberMap};

/// For each coarse triangle, by number, where the last walk in it ended and the next one begins: it is often
/// near, and the entry of the coarse triangle is not.
#[derive(Clone, Debug, Default)]
pub(in crate::mesh) struct WalkStarts(NumberMap<usize, TriangleId>);

impl WalkStarts {
    /// Returns the triangle that contains a point of a coarse triangle, by its number and entry.
    #[inline]
    pub(in crate::mesh) fn walk(
        &mut self,
        mesh: &Mesh,
        (number, entry): (usize, TriangleId),
        point: LatticePoint,
    ) -> TriangleId {
        let start = self.0.entry(number).or_insert(entry);
        let WalkEnd::Found(id, _) = mesh.walk(*start, point.as_dvec2()) else {
            unreachable!("the walk stays in the coarse triangle that it starts in");
        };
        *start = id;
        id
    }

    /// Forgets all of them, because entries of the mesh have moved or it is another mesh.
    pub(in crate::mesh) fn clear(&mut self) {
        self.0.clear();
    }
}

/// A search for the triangles that touch a rectangle.
///
/// Within one coarse triangle, all of them can be reached from any of them across edges. The common part of
/// the coarse triangle and the rectangle is convex, so it contains the segment between any two of its points.
/// This segment passes from triangle to triangle across edges, or through nodes in the rectangle, around
/// which all triangles touch it. So the search starts from one triangle in each coarse triangle that the
/// rectangle touches, also if the domain has holes.
#[derive(Clone, Debug)]
pub(in crate::mesh) struct RectSearch {
    area: LatticeRect,
    /// Triangles of this level or a finer one are passed by.
    levels: u32,
    /// The cells that the area touches: the first and last column, and the first and last row.
    columns: [u32; 2],
    rows: [u32; 2],
    /// The next half cell, counted row by row.
    next: u64,
    /// Triangles found, whose neighbours have not been looked at.
    found: Vec<TriangleId>,
}

impl RectSearch {
    pub(in crate::mesh) fn new(mesh: &Mesh, area: LatticeRect, levels: u32) -> Self {
        let steps = mesh.lattice().cell_steps();
        let [columns, rows] = mesh.lattice().cells();
        // Closed cells: a line between two cells belongs to both.
        let touched = |low: u32, high: u32, count: u32| {
            [low.div_ceil(steps).saturating_sub(1), (high / steps).min(count - 1)]
        };
        let columns = touched(area.min.x, area.max.x, columns);
        let rows = touched(area.min.y, area.max.y, rows);
        Self { area, levels, columns, rows, next: 0, found: Vec::new() }
    }

    /// Returns a triangle that was found and from which the search has not continued yet, if there is one.
    pub(in crate::mesh) fn found(&self) -> Option<TriangleId> {
        self.found.last().copied()
    }

    /// Returns whether triangles of a level are searched for, or only passed through.
    #[inline]
    pub(in crate::mesh) fn has_level(&self, level: u32) -> bool {
        level < self.levels
    }

    /// Continues from the triangle that [`Self::found`] returned to its neighbours.
    #[inline]
    pub(in crate::mesh) fn spread_from(&mut self, mesh: &Mesh, id: TriangleId, reached: &mut Bitset) {
        self.found.pop();
        for across in mesh.triangle(id).raw_neighbours.iter().filter_map(|n| n.triangle()) {
            if !reached.contains(across.index()) && self.area.touches(mesh.corners(across)) {
                reached.insert(across.index());
                self.found.push(across);
            }
        }
    }

    /// Enters the next half cell that the area touches; false where there is none.
    #[inline]
    pub(in crate::mesh) fn enter_next(
        &mut self,
        mesh: &Mesh,
        reached: &mut Bitset,
        starts: &mut WalkStarts,
    ) -> bool {
        let Some((cell, upper)) = self.next_half_cell() else { return false };
        if let Some(start) = self.start(mesh, cell, upper, starts)
            && reached.insert(start.index())
        {
            self.found.push(start);
        }
        true
    }

    /// Returns the next cell that the area touches, by column and row, and whether it is the upper half.
    fn next_half_cell(&mut self) -> Option<([u32; 2], bool)> {
        let ([c0, c1], [r0, r1]) = (self.columns, self.rows);
        if c0 > c1 {
            return None; // beyond the grid
        }
        let (across, upper) = (u64::from(c1 - c0 + 1), self.next % 2 == 1);
        let cell = self.next / 2;
        self.next += 1;
        let row = r0 + (cell / across) as u32;
        (row <= r1).then_some(([c0 + (cell % across) as u32, row], upper))
    }

    /// Returns a triangle in the given half of a cell that touches the area, unless the half does not or is
    /// not in the domain.
    fn start(
        &self,
        mesh: &Mesh,
        [column, row]: [u32; 2],
        upper: bool,
        starts: &mut WalkStarts,
    ) -> Option<TriangleId> {
        let cell = row as usize * mesh.lattice().cells()[0] as usize + column as usize;
        let number = 2 * cell + usize::from(upper);
        let entry = mesh.coarse.get(number)?;
        let steps = mesh.lattice().cell_steps();
        let (left, bottom) = (column * steps, row * steps);
        // The corner of the common rectangle that lies deepest in the half.
        let (point, inside) = if upper {
            let x = self.area.max.x.min(left + steps);
            let y = self.area.max.y.min(bottom + steps);
            (LatticePoint::new(x, y), x - left + (y - bottom) >= steps)
        } else {
            let (x, y) = (self.area.min.x.max(left), self.area.min.y.max(bottom));
            (LatticePoint::new(x, y), x - left + (y - bottom) <= steps)
        };
        inside.then(|| starts.walk(mesh, (number, entry), point))
    }
}
