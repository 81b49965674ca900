//! Finds the point of a surface that a pixel shows.

use glam::{DVec2, DVec3, dvec2};
use rayon::prelude::*;

use super::{NO_HEIGHT, ViewRay};
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::Triangle;

/// Triangles in a box, and boxes in a box around them.
const GROUP: usize = 64;
/// How far beyond its edges a triangle is met, as a share of its size: more than rounding errors, so that no
/// ray passes between two triangles.
const CLOSED: f64 = 1e-9;

/// Triangles with the heights of their nodes, as an index is made of them.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceArrays<'a> {
    /// The nodes.
    pub nodes: &'a [LatticePoint],
    /// The triangles.
    pub triangles: &'a [Triangle],
    /// For each node its height in steps.
    pub heights: &'a [u32],
}

/// Boxes around groups of triangles, and around groups of boxes.
#[derive(Clone, Debug, Default)]
pub struct SurfaceIndex {
    groups: Vec<Bounds>,
    parents: Vec<Bounds>,
}

/// A box in steps; empty where the least is above the greatest.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    min: DVec3,
    max: DVec3,
}

impl Bounds {
    const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    fn joined(self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns whether a ray goes through the box.
    fn meets(&self, ray: &ViewRay) -> bool {
        let (mut low, mut high) = (self.min.z, self.max.z);
        for axis in 0..2 {
            let (at, per_step) = (ray.at[axis], ray.per_step[axis]);
            // A little larger, for the rounding of the ray.
            let [from, to] = [self.min[axis] - 1.0, self.max[axis] + 1.0];
            if per_step == 0.0 {
                if !(from..=to).contains(&at) {
                    return false;
                }
                continue;
            }
            let [a, b] = [(from - at) / per_step, (to - at) / per_step];
            (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
        }
        low <= high + 1.0
    }
}

impl SurfaceIndex {
    /// Returns the index of triangles in the domain of which each corner has a height.
    pub fn new(arrays: SurfaceArrays) -> Self {
        let groups = arrays.triangles.par_chunks(GROUP).with_min_len(GROUP);
        let groups: Vec<Bounds> = groups
            .map(|group| {
                let corners = group.iter().filter_map(|triangle| arrays.corners(triangle)).flatten();
                corners.fold(Bounds::EMPTY, |all, corner| all.joined(&Bounds { min: corner, max: corner }))
            })
            .collect();
        let parents = groups.chunks(GROUP);
        let parents = parents.map(|boxes| boxes.iter().fold(Bounds::EMPTY, Bounds::joined)).collect();
        Self { groups, parents }
    }

    /// Returns the point nearest the viewer at which a ray meets a triangle that `is_drawn` accepts by its
    /// number: its place in lattice steps, and its height in steps. `arrays` are those of the index.
    pub fn nearest(
        &self,
        arrays: SurfaceArrays,
        ray: &ViewRay,
        is_drawn: impl Fn(usize) -> bool,
    ) -> Option<(DVec2, f64)> {
        let met = |boxes: &[Bounds], first: usize| {
            let met = boxes.iter().enumerate().filter(|(_, bounds)| bounds.meets(ray));
            met.map(|(place, _)| first + place).collect::<Vec<_>>()
        };
        let mut highest: Option<f64> = None;
        for parent in met(&self.parents, 0) {
            let first = parent * GROUP;
            for group in met(&self.groups[first..self.groups.len().min(first + GROUP)], first) {
                let first = group * GROUP;
                let end = arrays.triangles.len().min(first + GROUP);
                for index in (first..end).filter(|&index| is_drawn(index)) {
                    let height = arrays.corners(&arrays.triangles[index]);
                    let height = height.and_then(|corners| height_on(corners, ray));
                    // The viewer is above: the highest point of the ray is the nearest.
                    highest = [highest, height].into_iter().flatten().reduce(f64::max);
                }
            }
        }
        highest.map(|height| (ray.at + ray.per_step * height, height))
    }
}

impl SurfaceArrays<'_> {
    fn corners(&self, triangle: &Triangle) -> Option<[DVec3; 3]> {
        let heights =
            triangle.vertices.map(|node| self.heights.get(node.index()).copied().unwrap_or(NO_HEIGHT));
        if triangle.is_outside() || heights.contains(&NO_HEIGHT) {
            return None;
        }
        let corner =
            |i: usize| self.nodes[triangle.vertices[i].index()].as_dvec2().extend(f64::from(heights[i]));
        Some([corner(0), corner(1), corner(2)])
    }
}

/// Returns the height at which a ray meets a triangle.
fn height_on(corners: [DVec3; 3], ray: &ViewRay) -> Option<f64> {
    // Along the ray onto the plane of the height 0, from the place of the ray there.
    let [a, b, c] = corners.map(|corner| dvec2(corner.x, corner.y) - ray.per_step * corner.z - ray.at);
    let whole = (b - a).perp_dot(c - a);
    if whole == 0.0 {
        return None;
    }
    let parts = [b.perp_dot(c) / whole, c.perp_dot(a) / whole, a.perp_dot(b) / whole];
    let is_inside = parts.iter().all(|&part| part >= -CLOSED);
    is_inside.then(|| parts[0] * corners[0].z + parts[1] * corners[1].z + parts[2] * corners[2].z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{HeightScale, SpaceCamera, ViewDirection};
    use meshbrush_mesh::geometry::{Lattice, Rect};
    use meshbrush_mesh::mesh::{Limits, Mesh};

    fn surface() -> (Mesh, Vec<u32>, HeightScale) {
        let lattice = Lattice::covering(Rect::UNIT, 0.02, 1_000_000).unwrap();
        let mesh =
            Mesh::coarse_grid(&lattice, |p| p.distance(dvec2(0.3, 0.3)) > 0.1, &Limits::default()).unwrap();
        let scale = HeightScale::between(-1.0, 1.0);
        let height = |p: DVec2| libm::sin(9.0 * p.x) * libm::cos(7.0 * p.y);
        let nodes = mesh.raw_nodes().iter().map(|&node| height(lattice.world_from_lattice(node)));
        let heights = nodes.map(|height| scale.steps(Some(height))).collect();
        (mesh, heights, scale)
    }

    #[test]
    fn the_point_of_a_pixel_is_the_nearest_of_all_triangles() {
        let (mesh, heights, scale) = surface();
        let (nodes, triangles) = (mesh.raw_nodes(), mesh.raw_triangles());
        let arrays = SurfaceArrays { nodes, triangles, heights: &heights };
        let index = SurfaceIndex::new(arrays);
        let mut met = 0;
        for (azimuth, altitude) in [(0.0, 30.0), (123.0, 8.0), (250.0, 70.0), (10.0, 90.0)] {
            let direction = ViewDirection { azimuth, altitude };
            let surface = (scale, [0, 1 << 30]);
            let camera = SpaceCamera::fit(mesh.lattice(), surface, direction, 0.06, [300, 200], 5.0);
            for px in (0..60).map(|n| dvec2(5.0 * f64::from(n) + 0.3, f64::from(n * 37 % 200) + 0.1)) {
                let ray = camera.ray(px);
                let all = triangles.iter().filter_map(|triangle| arrays.corners(triangle));
                let brute = all.filter_map(|corners| height_on(corners, &ray)).reduce(f64::max);
                let found = index.nearest(arrays, &ray, |_| true);
                assert_eq!(found.map(|(_, height)| height), brute, "{px} {direction:?}");
                if let Some((place, height)) = found {
                    let back = camera.screen_map()(place, height);
                    assert!(back.truncate().distance(px) < 1e-6, "{px} {back}");
                    met += 1;
                }
            }
        }
        assert!(met > 80, "{met}");
    }

    #[test]
    fn a_box_is_met_by_the_rays_that_go_through_it() {
        let bounds = Bounds { min: DVec3::splat(1e6), max: DVec3::new(2e6, 3e6, 4e6) };
        let mut random = fastrand::Rng::with_seed(1);
        let mut counts = [0, 0];
        for _ in 0..2_000 {
            let mut number = |most: f64| most * (2.0 * random.f64() - 1.0);
            let per_step = dvec2(number(2.0), number(2.0));
            let ray = ViewRay { at: dvec2(number(4e6), number(4e6)), per_step };
            // Points of the ray at the heights of the box, 2,000 or less beside one another.
            let is_within = |reach: f64| {
                let heights = (0..=3_000).map(|n| bounds.min.z + f64::from(n) * 1e3);
                heights.map(|height| ray.at + per_step * height).any(|at| {
                    (0..2)
                        .all(|axis| (bounds.min[axis] - reach..=bounds.max[axis] + reach).contains(&at[axis]))
                })
            };
            assert!(!is_within(0.0) || bounds.meets(&ray), "{ray:?}");
            assert!(is_within(4e3) || !bounds.meets(&ray), "{ray:?}");
            counts[usize::from(bounds.meets(&ray))] += 1;
        }
        assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    }

    #[test]
    fn a_triangle_with_a_node_without_a_height_is_not_met() {
        let (mesh, mut heights, _) = surface();
        let (nodes, triangles) = (mesh.raw_nodes(), mesh.raw_triangles());
        let first = &triangles[0];
        let corners = |heights: &[u32]| SurfaceArrays { nodes, triangles, heights }.corners(first);
        assert!(!first.is_outside() && corners(&heights).is_some());
        heights[first.vertices[1].index()] = NO_HEIGHT;
        assert!(corners(&heights).is_none());
    }

    #[test]
    fn a_vertical_ray_finds_the_height_at_a_node() {
        let (mesh, heights, _) = surface();
        let arrays =
            SurfaceArrays { nodes: mesh.raw_nodes(), triangles: mesh.raw_triangles(), heights: &heights };
        let index = SurfaceIndex::new(arrays);
        let used =
            mesh.raw_triangles().iter().filter(|triangle| !triangle.is_outside()).map(|t| t.vertices[0]);
        for node in used.step_by(101) {
            let at = mesh.raw_nodes()[node.index()].as_dvec2();
            let (place, height) =
                index.nearest(arrays, &ViewRay { at, per_step: DVec2::ZERO }, |_| true).unwrap();
            assert!((height - f64::from(heights[node.index()])).abs() < 1e-3 && place == at);
        }
        assert_eq!(
            index.nearest(arrays, &ViewRay { at: dvec2(-9.0, 3.0), per_step: DVec2::ZERO }, |_| true),
            None
        );
    }
}
