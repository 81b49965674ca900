//! Angles of triangles whose corners are lattice points, measured in world units.

use glam::DVec2;

use crate::geometry::LatticePoint;

/// The cotangents of 5°, 20°, 25° and 30°.
pub(super) const COT_5: f64 = 11.430_052_302_761_343;
pub(super) const COT_20: f64 = 2.747_477_419_454_622;
pub(super) const COT_25: f64 = 2.144_506_920_509_558_6;
pub(super) const COT_30: f64 = 1.732_050_807_568_877_2;
/// The cotangent of 18.4°.
const COT_18_4: f64 = 3.006_110_903_495_366_6;

/// Compares angles by their cotangents: without trigonometry, so that every machine gets the same result. A
/// smaller angle has a larger cotangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angles {
    /// World length of a lattice step along x and y.
    step: DVec2,
}

impl Angles {
    pub(super) fn new(step: DVec2) -> Self {
        Self { step }
    }

    pub(super) fn step(&self) -> DVec2 {
        self.step
    }

    /// Returns the vector from one point to another, in world units.
    #[inline]
    pub(super) fn vector(&self, from: LatticePoint, to: LatticePoint) -> DVec2 {
        let steps = |from: u32, to: u32| (i64::from(to) - i64::from(from)) as f64;
        DVec2::new(steps(from.x, to.x), steps(from.y, to.y)) * self.step
    }

    /// Returns whether the angle at `at`, anticlockwise from the direction of `from` to that of `to`, is at
    /// least 5°. It may be more than 180°, up to 270°.
    #[inline]
    pub(super) fn is_open(&self, at: LatticePoint, from: LatticePoint, to: LatticePoint) -> bool {
        let (a, b) = (self.vector(at, from), self.vector(at, to));
        let (cross, dot) = (a.perp_dot(b), a.dot(b));
        dot < 0.0 || (cross > 0.0 && dot <= COT_5 * cross)
    }

    /// Returns the cotangent of the smallest angle of a triangle; infinite if its corners do not run
    /// anticlockwise.
    #[inline]
    pub(super) fn worst(&self, [a, b, c]: [LatticePoint; 3]) -> f64 {
        let (ab, ac, bc) = (self.vector(a, b), self.vector(a, c), self.vector(b, c));
        let cross = ab.perp_dot(ac);
        if cross > 0.0 { ab.dot(ac).max(ac.dot(bc)).max(-ab.dot(bc)) / cross } else { f64::INFINITY }
    }

    /// Returns the cotangent of the smallest angle that triangles inside may have: 18.4°, or the smallest
    /// angle that occurs where every node is at its home and every cut edge is cut in its middle, if that is
    /// smaller. In square cells that angle is arctan ⅓ = 18.43°.
    pub(super) fn limit(&self) -> f64 {
        let point = LatticePoint::new;
        // The shapes at even and at odd levels.
        let shapes = [
            [point(0, 0), point(4, 0), point(0, 4)],
            [point(0, 0), point(4, 0), point(2, 2)],
            [point(0, 0), point(2, 2), point(0, 4)],
        ];
        let turned = |[a, b, c]: [LatticePoint; 3]| [[a, b, c], [b, c, a], [c, a, b]];
        let worst = |corners| self.worst_of_halves(corners);
        let homes = shapes.into_iter().flat_map(turned).map(worst).fold(0.0, f64::max);
        COT_18_4.max(homes * (1.0 + 1e-9))
    }

    /// Returns the cotangent of the smallest angle of the pieces that a cut from the first corner through the
    /// middle of the opposite edge leaves of a triangle.
    ///
    /// Cuts through the middles of two edges leave no smaller angle: the corner that they cut off has the
    /// angles of the triangle, and the better diagonal of the rest makes pieces of such halves.
    fn worst_of_halves(&self, [a, b, c]: [LatticePoint; 3]) -> f64 {
        let middle = b.midpoint(c);
        self.worst([a, b, middle]).max(self.worst([a, middle, c]))
    }

    /// Returns the cotangents of the smallest angles of the two triangles on either side of a diagonal of a
    /// quadrilateral: first for the diagonal from the first corner, then for the one from the second.
    pub(super) fn diagonals(&self, [a, b, c, d]: [LatticePoint; 4]) -> [f64; 2] {
        [self.worst([a, b, c]).max(self.worst([a, c, d])), self.worst([a, b, d]).max(self.worst([b, c, d]))]
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn smallest_angle(corners: [DVec2; 3]) -> f64 {
        let angle = |at: DVec2, p: DVec2, q: DVec2| (p - at).angle_to(q - at).abs();
        let [a, b, c] = corners;
        angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
    }

    /// Cuts through the middles of edges leave, of each kind of triangle: halves, where the outline passes a
    /// corner, and a corner with a quadrilateral, which the better of its diagonals divides.
    #[test]
    fn the_limit_is_the_smallest_angle_that_cuts_in_the_middle_leave() {
        let mut narrower = 0;
        for height in [0.2, 0.5, 0.9, 1.0, 1.3, 2.5, 6.0] {
            let point = |x: f64, y: f64| dvec2(x, height * y);
            let kinds = [
                [point(0.0, 0.0), point(4.0, 0.0), point(0.0, 4.0)],
                [point(0.0, 0.0), point(4.0, 0.0), point(2.0, 2.0)],
                [point(0.0, 0.0), point(2.0, 2.0), point(0.0, 4.0)],
            ];
            let mut least = 18.4_f64.to_radians();
            for [p, q, r] in kinds {
                for [a, b, c] in [[p, q, r], [q, r, p], [r, p, q]] {
                    let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
                    let parts = |parts: &[[DVec2; 3]]| {
                        parts.iter().map(|&part| smallest_angle(part)).fold(f64::INFINITY, f64::min)
                    };
                    let halves = parts(&[[a, b, bc], [a, bc, c]]);
                    let beside = parts(&[[ab, b, c], [ab, c, ca]]).max(parts(&[[ab, b, ca], [b, c, ca]]));
                    least = least.min(halves).min(parts(&[[a, ab, ca]])).min(beside);
                }
            }
            let limit = (1.0 / Angles::new(dvec2(1.0, height)).limit()).atan();
            assert!((limit - least).abs() < 1e-6, "{height}: {limit} {least}");
            narrower += usize::from(least < 18.3_f64.to_radians());
        }
        assert!(narrower >= 4, "{narrower}");
    }
}
