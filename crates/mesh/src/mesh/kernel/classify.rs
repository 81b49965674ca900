//! Triangles outside the domain.
//!
//! Where the boundary is met by refinement, the coarse grid covers the whole rectangle, and triangles outside
//! the domain are found once the mesh is refined. They are not removed, so that their neighbours stay
//! conforming: the mesh is updated in place, and points are located in it, as if there were no boundary.
//! These triangles are only marked, and counts, fingerprint, location and exports leave them out.

use std::ops::Range;

use rayon::prelude::*;

use super::{Diameters, Element, LevelAndSide, Mesh, Neighbour, Triangle, TriangleId};

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

    /// Classifies the entries `ids` as inside or outside the domain, on the threads of the current pool of
    /// rayon where they are many. New triangles have the class of their parent until then.
    pub fn classify(&mut self, ids: Range<usize>, is_outside: impl Fn(&Element) -> bool + Sync) {
        let diameters = Diameters::of(self);
        let Self { lattice, nodes, triangles, .. } = self;
        let classify = |part: &mut [Triangle]| {
            let mut moves = [0i32; LevelAndSide::COUNT];
            for triangle in part {
                let corners = triangle.vertices.map(|node| nodes[node.index()]);
                let element = Element::new(triangle, corners, lattice, &diameters);
                let (before, outside) = (triangle.level_and_side(), is_outside(&element));
                triangle.set_outside(outside);
                moves[before.index()] -= 1;
                moves[triangle.level_and_side().index()] += 1;
            }
            moves
        };
        let ids = &mut triangles[ids];
        let moves = if ids.len() <= PART {
            vec![classify(ids)]
        } else {
            ids.par_chunks_mut(PART).map(classify).collect()
        };
        moves.iter().for_each(|moves| self.counts.add_moves(moves));
    }
}

/// Triangles that one thread classifies at a time.
const PART: usize = 1 << 14;
