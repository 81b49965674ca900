use glam::DVec2;

use crate::geometry::LatticePoint;
use crate::mesh::extract::Extract;
use crate::mesh::kernel::{NodeId, TriangleId};

/// Barycentric coordinates ζ₁ ζ₂ ζ₃ of `point` in the triangle with the given corners (Section 7).
///
/// All points are in lattice coordinates. The result is in the order of the corners and sums to one; each
/// coordinate is in \[0, 1\] if the point is in the triangle.
///
/// ```
/// # use meshbrush_mesh::geometry::LatticePoint;
/// # use meshbrush_mesh::mesh::barycentric;
/// let corners = [LatticePoint::new(0, 4), LatticePoint::new(0, 0), LatticePoint::new(4, 0)];
/// assert_eq!(barycentric(corners, glam::dvec2(1.0, 1.0)), [0.25, 0.5, 0.25]);
/// ```
pub fn barycentric(corners: [LatticePoint; 3], point: DVec2) -> [f64; 3] {
    let [a, b, c] = corners.map(LatticePoint::as_dvec2);
    // Differences of lattice coordinates are exact, and so is their determinant: right angles make it one
    // product.
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let area = ab.perp_dot(ac);
    let zeta_b = ap.perp_dot(ac) / area;
    let zeta_c = ab.perp_dot(ap) / area;
    [1.0 - zeta_b - zeta_c, zeta_b, zeta_c]
}

/// Returns the value at a point with barycentric coordinates `zeta`, from the `values` at the three vertices
/// (Section 7). A vertex with ζ = 0 does not count, even if its value is infinite.
///
/// ```
/// assert_eq!(meshbrush_mesh::mesh::interpolate([0.5, 0.5, 0.0], [1.0, 2.0, 7.0]), 1.5);
/// assert_eq!(meshbrush_mesh::mesh::interpolate([0.0, 1.0, 0.0], [f64::INFINITY, 3.0, 5.0]), 3.0);
/// ```
pub fn interpolate(zeta: [f64; 3], values: [f64; 3]) -> f64 {
    let counts = |(zeta, _): &(f64, f64)| *zeta != 0.0;
    zeta.into_iter().zip(values).filter(counts).map(|(zeta, value)| zeta * value).sum()
}

impl Extract<'_> {
    /// Returns the barycentric coordinates of a point, in world units, in the order of the corners of a cell.
    ///
    /// # Panics
    /// Panics when there is no such triangle.
    pub fn weights_at(&self, id: TriangleId, point: DVec2) -> [f64; 3] {
        let corners = self.cell(id).corners.map(|node| self.node(NodeId::from_index(node)));
        barycentric(corners, self.lattice().lattice_from_world(point))
    }
}
