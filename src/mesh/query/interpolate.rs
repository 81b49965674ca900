use glam::DVec2;

use crate::geometry::LatticePoint;

/// Barycentric coordinates ζ₁ ζ₂ ζ₃ of `point` in the triangle with the given corners (Section 7).
///
/// All in lattice coordinates; ζ is in the order of the corners and sums to one. Each lies in \[0, 1\] when
/// the point lies in the triangle.
///
/// ```
/// # use meshbrush::{LatticePoint, barycentric};
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

/// The value at a point with barycentric coordinates `zeta`, from the `values` at the three vertices (Section
/// 7).
pub fn interpolate(zeta: [f64; 3], values: [f64; 3]) -> f64 {
    zeta[0] * values[0] + zeta[1] * values[1] + zeta[2] * values[2]
}
