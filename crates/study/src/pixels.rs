//! Finds what triangles are like on a grid of pixels to be shown: which are finer than the field requires,
//! and any number of those that files get.

use std::collections::HashMap;

use glam::DVec2;

use crate::build::RefinementCriterion;
use crate::explain::asks_to_bisect;
use crate::geometry::Rect;
use crate::layers::{LevelCache, PaintLayers, SizeField};
use crate::mesh::{Limits, Mesh, MeshView, TreeTriangle, TriangleId};
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

/// By how much rounding can make a point on an edge seem to be outside, as a share of the height.
const ROUNDING: f64 = 1e-9;

/// Returns a value at each pixel over `bounds` in world units whose centre is in a triangle of a mesh, from
/// the number of the triangle, the centre, and the weights of its vertices there; NaN at the others, and
/// where there is no value. Triangle after triangle is asked about. `size` is [columns, rows]. `None` where
/// `goes_on` says that nobody wants it any more.
pub fn values_by_pixel(
    mesh: MeshView,
    (bounds, size): (Rect, [u32; 2]),
    goes_on: &dyn Fn() -> bool,
    mut value: impl FnMut(usize, DVec2, [f64; 3]) -> Option<f64>,
) -> Option<Raster> {
    let mut values = Raster::filled(bounds, size, f32::NAN);
    let centers = values.pixel_centers();
    for (number, triangle) in mesh.triangles().iter().enumerate() {
        if number % 4096 == 0 && !goes_on() {
            return None;
        }
        let corners =
            triangle.vertices.map(|node| mesh.lattice().world_from_lattice(mesh.nodes()[node.index()]));
        let around = Rect::holding(corners)?;
        if around.intersection(&bounds).is_none() {
            continue;
        }
        for (x, y) in values.pixels_touching(&around).pixels() {
            let at = centers(x, y);
            let Some(weights) = weights(corners, at) else { continue };
            if let Some(value) = value(number, at, weights) {
                values.set(x, y, value as f32);
            }
        }
    }
    Some(values)
}

/// Returns a number of each triangle, as `of_triangle` has it for those with a pixel, at the pixels within,
/// as [`values_by_pixel`].
pub fn numbers_by_pixel(
    mesh: MeshView,
    pixels: (Rect, [u32; 2]),
    goes_on: &dyn Fn() -> bool,
    mut of_triangle: impl FnMut(usize) -> Option<f64>,
) -> Option<Raster> {
    let mut last = None;
    values_by_pixel(mesh, pixels, goes_on, |number, _, _| match last {
        Some((known, value)) if known == number => value,
        _ => {
            let value = of_triangle(number);
            last = Some((number, value));
            value
        }
    })
}

/// Returns the weights of the corners at a point in a closed triangle.
fn weights([a, b, c]: [DVec2; 3], at: DVec2) -> Option<[f64; 3]> {
    let whole = (b - a).perp_dot(c - a);
    let parts = [(b, c), (c, a), (a, b)].map(|(from, to)| (to - from).perp_dot(at - from) / whole);
    parts.iter().all(|part| *part >= -ROUNDING).then_some(parts)
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

    #[test]
    fn a_number_of_a_triangle_is_at_the_pixels_within_and_asked_for_once() {
        let built = fixture::built("0.05 + 0.4*x*y", RefinementRule::Area, Limits::default());
        let extract = built.mesh.extract();
        // No centre is on an edge.
        let bounds = Rect::new(dvec2(0.2013, 0.3007), dvec2(1.2071, 1.3039));
        let mut asked = vec![0; extract.triangles().len()];
        let found = numbers_by_pixel(extract.view(), (bounds, [37, 29]), &|| true, |number| {
            asked[number] += 1;
            (number % 5 > 0).then_some(number as f64)
        })
        .unwrap();
        let centers = found.pixel_centers();
        for (x, y) in found.all().pixels() {
            let expected = built.mesh.locate(centers(x, y)).triangle().map(TriangleId::index);
            match expected.filter(|number| number % 5 > 0) {
                Some(number) => assert_eq!(found.get(x, y), number as f32, "{x} {y}"),
                None => assert!(found.get(x, y).is_nan(), "{x} {y}"),
            }
        }
        assert!(asked.iter().all(|&times| times <= 1) && asked.iter().sum::<i32>() > 100);
        assert!(numbers_by_pixel(extract.view(), (bounds, [4, 4]), &|| false, |_| None).is_none());
    }
}
