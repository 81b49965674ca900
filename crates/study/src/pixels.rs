//! Finds the parts of the mesh that are finer than its field requires, on a grid of pixels to be shown.

use std::collections::HashMap;

use glam::DVec2;

use crate::build::RefinementCriterion;
use crate::explain::asks_to_bisect;
use crate::geometry::Rect;
use crate::layers::{LevelCache, PaintLayers, SizeField};
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

    /// Returns the colour of the triangle at each pixel, as `color` has it for each triangle once, or the one
    /// for pixels `beyond` the mesh. `None` if `goes_on` returns false at the beginning of a row, because the
    /// result is no longer wanted.
    pub fn colors(
        &self,
        goes_on: &dyn Fn() -> bool,
        beyond: [u8; 4],
        mut color: impl FnMut(TriangleId) -> [u8; 4],
    ) -> Option<Vec<[u8; 4]>> {
        let columns = self.grid.size()[0] as usize;
        let mut known = HashMap::new();
        let colors = self.iter().enumerate().map(|(place, (_, id))| {
            if place % columns == 0 && !goes_on() {
                return None;
            }
            Some(id.map_or(beyond, |id| *known.entry(id).or_insert_with(|| color(id))))
        });
        colors.collect()
    }

    /// log₂ of h̄ / h of a triangle, at least 0: by how many halvings it is finer than h̄ asks for at its
    /// middle. `squares` must have been used for this field and these pixels only.
    pub fn slack(
        &self,
        id: TriangleId,
        field: &SizeField,
        paint: &PaintLayers,
        squares: &mut LevelCache,
    ) -> f32 {
        let corners = self.mesh.corners(id);
        let diameter = field.edge_lengths().of(corners, self.mesh.triangle(id).level());
        let corners = corners.map(|corner| self.mesh.lattice().world_from_lattice(corner));
        let middle = corners.iter().sum::<DVec2>() / 3.0;
        let target = field.quick_decision_at(squares, paint, middle).target;
        libm::log2(target / diameter).max(0.0) as f32
    }

    /// Returns whether a triangle is there for compatibility only: its parent does not exceed its target.
    pub fn is_forced(&self, id: TriangleId, criterion: &RefinementCriterion<'_>, limits: &Limits) -> bool {
        let parent = TreeTriangle::from_mesh(self.mesh, id).parent(self.mesh.lattice());
        parent.is_some_and(|parent| !asks_to_bisect(&parent, criterion, limits))
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use glam::dvec2;

    use super::*;
    use crate::explain::Explanation;
    use crate::field::RefinementRule;
    use crate::fixture;
    use crate::mesh::Cause;

    #[test]
    fn forced_triangles_are_those_that_compatibility_asked_for() {
        let target = "if(hypot(x - 0.3, y - 0.4) < 0.01, 0.003, 0.3)";
        let limits = Limits::default();
        let built = fixture::built(target, RefinementRule::Area, limits);
        let size = [40, 40];
        let pixels = PixelTriangles::new(&built.mesh, Rect::UNIT, size);
        let criterion = RefinementCriterion::by_area(&built.domain, &built.field, PaintLayers::blank());
        let forced = |id| pixels.is_forced(id, &criterion, &limits);
        let mut squares = LevelCache::default();
        let mut slack = |id| pixels.slack(id, &built.field, PaintLayers::blank(), &mut squares);
        let mut both = [0, 0];
        for (point, id) in pixels.iter() {
            let id = id.unwrap();
            let triangle = TreeTriangle::from_mesh(&built.mesh, id);
            let cause = Explanation::new(&built.mesh, triangle, &criterion, &limits).cause;
            assert_eq!(forced(id), matches!(cause, Cause::Compatibility { .. }), "{point}");
            both[usize::from(forced(id))] += 1;
            assert!(slack(id) >= 0.0);
        }
        assert!(both[0] > 100 && both[1] > 100, "{both:?}");
        let mut asked = 0;
        let rows = Cell::new(0);
        let count = || {
            rows.set(rows.get() + 1);
            true
        };
        let colors = pixels.colors(&count, [9; 4], |id| {
            asked += 1;
            [u8::from(forced(id)); 4]
        });
        assert_eq!(rows.get(), 40, "asked at the beginning of each row");
        let expected: Vec<_> = pixels.iter().map(|(_, id)| [u8::from(forced(id.unwrap())); 4]).collect();
        assert_eq!(colors, Some(expected));
        assert!(asked < 1600, "each triangle once: {asked}");
        assert_eq!(pixels.colors(&|| false, [9; 4], |_| [0; 4]), None);
        // A coarse triangle has the diameter 0.14 where 0.3 is asked for.
        let corner = pixels.iter().find(|(point, _)| point.distance(dvec2(0.99, 0.99)) < 0.02).unwrap();
        assert!((f64::from(slack(corner.1.unwrap())) - libm::log2(0.3 / 0.141_421_356)).abs() < 1e-3);
    }

    #[test]
    fn the_slack_of_a_triangle_is_that_at_its_middle() {
        let built = fixture::built("0.05 + 0.4*x*y", RefinementRule::Vertex, Limits::default());
        let pixels = PixelTriangles::new(&built.mesh, Rect::UNIT, [20, 20]);
        let mut squares = LevelCache::default();
        for (_, id) in pixels.iter() {
            let id = id.unwrap();
            let corners = built.mesh.world_corners(id);
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let lengths = [0, 1, 2].map(|n| corners[n].distance(corners[(n + 1) % 3]));
            let diameter = lengths.into_iter().fold(0.0, f64::max);
            let expected = libm::log2((0.05 + 0.4 * middle.x * middle.y) / diameter).max(0.0);
            let slack = pixels.slack(id, &built.field, PaintLayers::blank(), &mut squares);
            assert!((f64::from(slack) - expected).abs() < 1e-5, "{middle}: {slack} {expected}");
        }
    }
}
