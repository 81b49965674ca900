//! Places on a mesh: where a path begins and ends.

use glam::DVec2;

use super::march::Seed;
use super::path_mesh::PathMesh;
use super::{Passage, PathError, Waypoint};

/// A point in one of the open triangles that contain it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// In world units.
    pub point: DVec2,
    /// The triangle.
    pub triangle: u32,
}

impl Place {
    /// Finds a waypoint. A point that lies outside only by rounding is moved into its triangle, by as little
    /// as numbers allow.
    ///
    /// # Errors
    /// When it is no point of the domain, or lies where no path may go.
    pub fn find(mesh: &PathMesh, point: DVec2, which: Waypoint) -> Result<Self, PathError> {
        if !point.is_finite() {
            return Err(PathError::NotAPlace { which, at: point });
        }
        match mesh.open_triangle_at(point) {
            Some(triangle) => Ok(Self { point: mesh.moved_into(triangle, point), triangle }),
            None if mesh.locate(point, Passage::Partly).is_some() || mesh.is_kept_out(point) => {
                Err(PathError::KeptOut { which, at: point })
            }
            None => Err(PathError::Outside { which, at: point }),
        }
    }

    /// The corners of its triangle, with the exact costs of the segments to them: where a march begins.
    pub fn seeds(&self, mesh: &PathMesh, costs: &[f64]) -> [Seed; 3] {
        let cost = costs[self.triangle as usize];
        let corners = mesh.triangles[self.triangle as usize].corners;
        corners.map(|node| (node, cost * self.point.distance(mesh.nodes[node as usize])))
    }

    /// The corners of its triangle.
    pub(super) fn corner_nodes(&self, mesh: &PathMesh) -> [u32; 3] {
        mesh.triangles[self.triangle as usize].corners
    }

    /// The shares of the corners of its triangle in the point: they interpolate linearly.
    pub(super) fn shares(&self, mesh: &PathMesh) -> [f64; 3] {
        let [a, b, c] = mesh.corners(self.triangle);
        let area = (b - a).perp_dot(c - a);
        let of = |p: DVec2, q: DVec2| (p - self.point).perp_dot(q - self.point) / area;
        [of(b, c), of(c, a), of(a, b)]
    }

    /// A function that is linear on each triangle, at the place.
    pub(super) fn interpolate(&self, mesh: &PathMesh, values: &[f64]) -> f64 {
        let (shares, nodes) = (self.shares(mesh), self.corner_nodes(mesh));
        (0..3).map(|k| shares[k] * values[nodes[k] as usize]).sum()
    }
}
