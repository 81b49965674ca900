//! The heights of a surface at the nodes of a mesh, each found once.

use glam::DVec2;

use super::SurfaceSamples;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::Element;

/// The heights of the surface at the nodes of a mesh that is being refined, by the numbers of the nodes.
#[derive(Clone, Debug, Default)]
pub struct SurfaceNodes {
    known: Vec<KnownHeight>,
}

#[derive(Clone, Copy, Debug)]
enum KnownHeight {
    NotYet,
    /// The height, if the surface has one there.
    Height(Option<f64>),
}

/// A triangle with the surface at its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceTriangle {
    /// In world units.
    pub(super) corners: [DVec2; 3],
    /// `None` where the surface has no height at a corner.
    pub(super) heights: Option<[f64; 3]>,
}

impl SurfaceNodes {
    pub(super) fn triangle(&mut self, element: &Element, samples: &SurfaceSamples) -> SurfaceTriangle {
        let corners = element.world_corners();
        let found = [0, 1, 2].map(|n| {
            let node = element.triangle.vertices[n].index();
            if node >= self.known.len() {
                self.known.resize(node + 1, KnownHeight::NotYet);
            }
            match self.known[node] {
                KnownHeight::Height(height) => height,
                KnownHeight::NotYet => {
                    let height = samples.height_at(corners[n]);
                    self.known[node] = KnownHeight::Height(height);
                    height
                }
            }
        });
        SurfaceTriangle::new(corners, found)
    }
}

impl SurfaceTriangle {
    pub(super) fn new(corners: [DVec2; 3], heights: [Option<f64>; 3]) -> Self {
        let heights = match heights {
            [Some(a), Some(b), Some(c)] => Some([a, b, c]),
            _ => None,
        };
        Self { corners, heights }
    }

    /// Returns a triangle given by its corners on a lattice.
    pub(super) fn from_samples(
        corners: [LatticePoint; 3],
        lattice: &Lattice,
        samples: &SurfaceSamples,
    ) -> Self {
        let corners = corners.map(|corner| lattice.world_from_lattice(corner));
        Self::new(corners, corners.map(|corner| samples.height_at(corner)))
    }

    /// Returns the area, in square world units.
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).perp_dot(c - a).abs()
    }

    /// Returns the longest edge, in world units.
    pub(super) fn diameter(&self) -> f64 {
        let [a, b, c] = self.corners;
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn a_triangle_has_its_area_and_diameter_in_any_order_of_corners() {
        let corners = [dvec2(1.0, 1.0), dvec2(4.0, 1.0), dvec2(1.0, 5.0)];
        for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1]] {
            let triangle =
                SurfaceTriangle::new(order.map(|n: usize| corners[n]), [Some(1.0), Some(2.0), Some(3.0)]);
            assert_eq!((triangle.area(), triangle.diameter()), (6.0, 5.0), "{order:?}");
            assert_eq!(triangle.heights, Some([1.0, 2.0, 3.0]));
        }
        assert_eq!(SurfaceTriangle::new(corners, [Some(1.0), None, Some(3.0)]).heights, None);
    }
}
