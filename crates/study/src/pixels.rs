//! Finds the parts of the mesh that are finer than its field requires, on a grid of pixels to be shown.

use std::collections::HashMap;

use glam::DVec2;

use crate::build::RefinementCriterion;
use crate::explain::{AgesNow, asks_to_bisect};
use crate::geometry::Rect;
use crate::mesh::{Limits, Mesh, TreeTriangle, TriangleId};
use crate::raster::Raster;

/// The triangles of a mesh at the centres of pixels.
pub struct PixelTriangles<'a> {
    mesh: &'a Mesh,
    grid: Raster<u8>,
}

impl<'a> PixelTriangles<'a> {
    /// Returns the pixels over `bounds` in world units; `size` is [columns, rows].
    pub fn new(mesh: &'a Mesh, bounds: Rect, size: [u32; 2]) -> Self {
        Self { mesh, grid: Raster::filled(bounds, size, 0) }
    }

    /// Returns the centre of each pixel in world units and the triangle there, row by row from the lowest.
    fn iter(&self) -> impl Iterator<Item = (DVec2, Option<TriangleId>)> + '_ {
        let centers = self.grid.pixel_centers();
        self.grid.all().pixels().map(move |(x, y)| {
            let center = centers(x, y);
            (center, self.mesh.locate(center).triangle())
        })
    }

    /// log₂ of h̄ / h at each pixel, at least 0: by how many halvings the mesh is finer than h̄ asks for
    /// there. NaN beyond the mesh. `target` has h̄ at the same pixels.
    pub fn slack(&self, target: &Raster) -> Vec<f32> {
        let slack = |id: TriangleId, target: f32| {
            let diameter = self.mesh.diameter(self.mesh.triangle(id).level());
            libm::log2(f64::from(target) / diameter).max(0.0) as f32
        };
        let pixels = self.iter().zip(target.values());
        pixels.map(|((_, id), &target)| id.map_or(f32::NAN, |id| slack(id, target))).collect()
    }

    /// Returns how many edits ago the triangle at each pixel came; `None` if it was there before the first,
    /// and beyond the mesh.
    pub fn ages(&self, ages: &AgesNow) -> Vec<Option<u32>> {
        self.iter().map(|(_, id)| ages.of(id?)).collect()
    }

    /// Returns whether the triangle at each pixel is there for compatibility only: its parent does not exceed
    /// its target.
    pub fn forced(&self, criterion: &RefinementCriterion<'_>, limits: &Limits) -> Vec<bool> {
        let mut known = HashMap::new();
        let mut is_forced = |id: TriangleId| {
            *known.entry(id).or_insert_with(|| {
                let parent = TreeTriangle::of(self.mesh, id).parent(self.mesh.lattice());
                parent.is_some_and(|parent| !asks_to_bisect(&parent, criterion, limits))
            })
        };
        self.iter().map(|(_, id)| id.is_some_and(&mut is_forced)).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::explain::Explanation;
    use crate::field::RefinementRule;
    use crate::fixture;
    use crate::layers::PaintLayers;
    use crate::mesh::Cause;

    #[test]
    fn forced_triangles_are_those_that_compatibility_asked_for() {
        let target = "if(hypot(x - 0.3, y - 0.4) < 0.01, 0.003, 0.3)";
        let limits = Limits::default();
        let built = fixture::built(target, RefinementRule::Area, limits);
        let size = [40, 40];
        let pixels = PixelTriangles::new(&built.mesh, Rect::UNIT, size);
        let criterion = RefinementCriterion::by_area(&built.domain, &built.field, PaintLayers::blank());
        let forced = pixels.forced(&criterion, &limits);
        let slack = pixels.slack(&built.field.sampled(PaintLayers::blank(), Rect::UNIT, size));
        let mut both = [0, 0];
        for (((point, id), forced), slack) in pixels.iter().zip(&forced).zip(&slack) {
            let triangle = TreeTriangle::of(&built.mesh, id.unwrap());
            let cause = Explanation::new(&built.mesh, triangle, &criterion, &limits).cause;
            assert_eq!(*forced, matches!(cause, Cause::Compatibility { .. }), "{point}");
            both[usize::from(*forced)] += 1;
            assert!(*slack >= 0.0);
        }
        assert!(both[0] > 100 && both[1] > 100, "{both:?}");
        // A coarse triangle has the diameter 0.14 where 0.3 is asked for.
        let corner = pixels.iter().position(|(point, _)| point.distance(dvec2(0.99, 0.99)) < 0.02).unwrap();
        assert!((f64::from(slack[corner]) - libm::log2(0.3 / 0.141_421_356)).abs() < 1e-3);
    }
}
