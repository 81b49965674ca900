//! Places on a mesh: where a path begins and ends.

use glam::DVec2;

use super::march::Seed;
use super::path_mesh::{NONE, PathMesh};
use super::{Passage, PathError, Waypoint};
use crate::geometry::{Side, side_of_points};

/// A point in one of the open triangles that contain it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPlace {
    /// The point in world units.
    pub point: DVec2,
    /// The triangle.
    pub triangle: u32,
}

impl MeshPlace {
    /// Finds a waypoint. A point that lies outside only by rounding is moved into its triangle, by as little
    /// as numbers allow.
    ///
    /// # Errors
    /// Fails when it is no point of the domain, or lies where no path may go.
    pub fn find(mesh: &PathMesh, point: DVec2, which: Waypoint) -> Result<Self, PathError> {
        if !point.is_finite() {
            return Err(PathError::NotAPlace { which, at: point });
        }
        match mesh.open_triangle_at(point) {
            Some(triangle) => Ok(Self { point: mesh.moved_into(triangle, point), triangle }),
            None if mesh.locate(point, Passage::Partly).is_some() || mesh.is_kept_out(point) => {
                Err(mesh.area().refusal(which, point).unwrap_or(PathError::KeptOut { which, at: point }))
            }
            None => Err(PathError::Outside { which, at: point }),
        }
    }

    /// Returns the corners of its triangle, and those beyond its edges to which a segment leads through two
    /// open triangles, with the costs of the segments: where a march begins. From the corners alone, a march
    /// would measure the distance of a place on an edge by way of one of the ends.
    pub fn seeds(&self, mesh: &PathMesh, costs: &[f64]) -> Vec<Seed> {
        let triangle = &mesh.triangles[self.triangle as usize];
        let cost = costs[self.triangle as usize];
        let to = |node: u32| mesh.nodes[node as usize];
        let mut seeds: Vec<Seed> =
            triangle.corners.iter().map(|&node| (node, cost * self.point.distance(to(node)))).collect();
        for (edge, &across) in mesh.across[self.triangle as usize].iter().enumerate() {
            if across == NONE || mesh.passage(across) != Passage::Open {
                continue;
            }
            let [a, b] = [triangle.corners[edge], triangle.corners[(edge + 1) % 3]];
            let beyond =
                mesh.triangles[across as usize].corners.into_iter().find(|&node| node != a && node != b);
            let Some(beyond) = beyond else { continue };
            let sides = [a, b].map(|end| side_of_points(self.point, to(beyond), to(end)));
            if sides != [Side::Left, Side::Right] && sides != [Side::Right, Side::Left] {
                continue;
            }
            let heights = [self.point, to(beyond)].map(|end| (to(b) - to(a)).perp_dot(end - to(a)).abs());
            let own = heights[0] / (heights[0] + heights[1]);
            let mean = own * cost + (1.0 - own) * costs[across as usize];
            seeds.push((beyond, mean * self.point.distance(to(beyond))));
        }
        seeds
    }

    /// Returns the corners of its triangle.
    pub(super) fn corner_nodes(&self, mesh: &PathMesh) -> [u32; 3] {
        mesh.triangles[self.triangle as usize].corners
    }

    /// Returns the shares of the corners of its triangle in the point: they interpolate linearly.
    pub(super) fn shares(&self, mesh: &PathMesh) -> [f64; 3] {
        let [a, b, c] = mesh.corners(self.triangle);
        let area = (b - a).perp_dot(c - a);
        let of = |p: DVec2, q: DVec2| (p - self.point).perp_dot(q - self.point) / area;
        [of(b, c), of(c, a), of(a, b)]
    }

    /// Returns a function that is linear on each triangle, at the place.
    pub(super) fn interpolate(&self, mesh: &PathMesh, values: &[f64]) -> f64 {
        let (shares, nodes) = (self.shares(mesh), self.corner_nodes(mesh));
        (0..3).map(|k| shares[k] * values[nodes[k] as usize]).sum()
    }
}
