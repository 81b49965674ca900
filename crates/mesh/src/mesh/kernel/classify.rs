//! Triangles outside the domain.
//!
//! Where the boundary is met by refinement, the coarse grid covers the whole rectangle, and what lies outside
//! the domain is sorted out when all is refined. Those triangles are not removed: they hold up their
//! neighbours. So the mesh is updated in place, and a point is located in it, as if there were no boundary.
//! They only bear a mark, and counts, fingerprint, location and exports leave them out.

use std::ops::Range;

use super::{Diameters, Element, Mesh, Neighbour, TriangleId};

impl Mesh {
    /// Returns how many triangles belong to the domain.
    pub fn triangle_count(&self) -> usize {
        self.raw_triangle_count() - self.outside_count()
    }

    /// Returns how many triangles lie outside the domain.
    pub fn outside_count(&self) -> usize {
        self.counts.outside().map(|n| n as usize).sum()
    }

    /// Returns whether a triangle belongs to the domain.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    #[inline]
    pub fn is_in_domain(&self, id: TriangleId) -> bool {
        !self.triangle(id).is_outside()
    }

    /// Returns the neighbours of a triangle in the domain, anticlockwise, the one across the bisection edge
    /// first. A triangle outside the domain counts as boundary.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    pub fn neighbours(&self, id: TriangleId) -> [Neighbour; 3] {
        self.triangle(id).raw_neighbours.map(|across| match across.triangle() {
            Some(other) if self.is_in_domain(other) => across,
            _ => Neighbour::BOUNDARY,
        })
    }

    /// Returns the area of the triangles that belong to the domain, in square world units.
    ///
    /// Exact also where cells are not quite square.
    pub fn area(&self) -> f64 {
        let cell = self.lattice.step() * f64::from(self.lattice.cell_steps());
        let share = |level: usize| 0.5 * cell.x * cell.y / (1u64 << level) as f64;
        self.level_counts().iter().enumerate().map(|(level, &count)| count as f64 * share(level)).sum()
    }

    /// Classifies the entries `ids` as inside or outside the domain. New triangles have the class of their
    /// parent until then.
    pub fn classify(&mut self, ids: Range<usize>, mut is_outside: impl FnMut(&Element) -> bool) {
        let diameters = Diameters::of(self);
        for index in ids {
            let outside = is_outside(&self.element_with(TriangleId::from_index(index), &diameters));
            let triangle = &mut self.triangles[index];
            let before = triangle.kind();
            triangle.set_outside(outside);
            self.counts.moved(before, triangle.kind());
        }
    }
}
