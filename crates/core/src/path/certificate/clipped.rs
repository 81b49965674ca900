//! Triangles cut by rectangles, and the least values of polynomials there.

use glam::{DVec2, dvec2};

use super::triangle::FlatTriangle;
use crate::geometry::Rect;

pub(super) fn quarters(rectangle: &Rect) -> [Rect; 4] {
    let (min, middle, max) = (rectangle.min, rectangle.center(), rectangle.max);
    [
        Rect::new(min, middle),
        Rect::new(dvec2(middle.x, min.y), dvec2(max.x, middle.y)),
        Rect::new(dvec2(min.x, middle.y), dvec2(middle.x, max.y)),
        Rect::new(middle, max),
    ]
}

/// A convex polygon of at most seven corners: a triangle cut by a rectangle.
#[derive(Clone, Copy)]
pub(super) struct Clipped {
    corners: [DVec2; 8],
    count: usize,
}

pub(super) fn clipped(triangle: &FlatTriangle, rectangle: &Rect) -> Clipped {
    let [a, b, c] = triangle.corners;
    let mut polygon = Clipped { corners: [a, b, c, a, a, a, a, a], count: 3 };
    for axis in 0..2 {
        polygon = polygon.cut(|p| p[axis] - rectangle.min[axis]);
        polygon = polygon.cut(|p| rectangle.max[axis] - p[axis]);
    }
    polygon
}

impl Clipped {
    pub fn corners(&self) -> &[DVec2] {
        &self.corners[..self.count]
    }

    /// Returns the part where `inside` is not negative.
    fn cut(&self, inside: impl Fn(DVec2) -> f64) -> Self {
        let mut cut = Self { count: 0, ..*self };
        let old = self.corners();
        for (index, &to) in old.iter().enumerate() {
            let from = old[(index + old.len() - 1) % old.len()];
            let [before, after] = [inside(from), inside(to)];
            if (before < 0.0) != (after < 0.0) {
                cut.push(from.lerp(to, before / (before - after)));
            }
            if after >= 0.0 {
                cut.push(to);
            }
        }
        cut
    }

    fn push(&mut self, corner: DVec2) {
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Returns whether it has no area.
    pub fn is_flat(&self) -> bool {
        let corners = self.corners();
        let Some(&first) = corners.first() else { return true };
        let fan = corners.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first));
        fan.sum::<f64>() == 0.0
    }
}

/// A polynomial is nearly flat in one direction if its curvature there is below this share of that in the
/// other.
const NEARLY_FLAT: f64 = 1e-6;

/// A point so far beyond an edge still counts as in a polygon.
const BESIDE: f64 = 1e-8;

/// Returns the least value of c₀ + c₁u + c₂v + c₃u² + c₄uv + c₅v² over a convex polygon, but for rounding. It
/// is at a corner, on an edge where the polynomial along it is least between the ends, or where both
/// derivatives vanish. The coordinates of the corners are between −1 and 1.
pub(super) fn least_on_polygon(coefficients: &[f64; 6], corners: impl Iterator<Item = DVec2> + Clone) -> f64 {
    let [c, cu, cv, cuu, cuv, cvv] = *coefficients;
    let at = |p: DVec2| c + p.x * (cu + cuu * p.x + cuv * p.y) + p.y * (cv + cvv * p.y);
    let mut least = f64::INFINITY;
    let Some(mut from) = corners.clone().last() else { return f64::NEG_INFINITY };
    for to in corners.clone() {
        least = least.min(at(to));
        let along = to - from;
        // p(from + s along) = p(from) + slope s + bend s².
        let slope = along.x * (cu + 2.0 * cuu * from.x + cuv * from.y)
            + along.y * (cv + 2.0 * cvv * from.y + cuv * from.x);
        let bend = cuu * along.x * along.x + cuv * along.x * along.y + cvv * along.y * along.y;
        if slope < 0.0 && bend > 0.0 && slope + 2.0 * bend > 0.0 {
            least = least.min(at(from + (-0.5 * slope / bend) * along));
        }
        from = to;
    }
    let (determinant, bend) = (4.0 * cuu * cvv - cuv * cuv, cuu + cvv);
    if bend > 0.0 && determinant.abs() < NEARLY_FLAT * bend * bend {
        // Along one direction it is so flat that it falls by less than this between two places of the rim.
        least -= 2.0 * NEARLY_FLAT * bend;
    } else if determinant > 0.0 && bend > 0.0 {
        let still = dvec2(cuv * cv - 2.0 * cvv * cu, cuv * cu - 2.0 * cuu * cv) / determinant;
        if is_around(corners, still) {
            least = least.min(at(still));
        }
    }
    least
}

/// Returns whether a convex polygon of corners between −1 and 1, in either order, contains a point, but for
/// much more than rounding.
fn is_around(corners: impl Iterator<Item = DVec2> + Clone, point: DVec2) -> bool {
    let Some(mut from) = corners.clone().last() else { return false };
    let [mut least, mut greatest] = [f64::INFINITY, f64::NEG_INFINITY];
    for to in corners {
        let side = (to - from).perp_dot(point - from);
        (least, greatest, from) = (least.min(side), greatest.max(side), to);
    }
    least >= -BESIDE || greatest <= BESIDE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_of_a_polygon_has_a_lower_value_than_the_least_and_one_has_about_that() {
        let mut random = fastrand::Rng::with_seed(1470);
        let mut number = |half: f64| half * (2.0 * random.f64() - 1.0);
        let (mut at_edges, mut inside) = (0, 0);
        for round in 0..3000 {
            let triangle = FlatTriangle::new([(); 3].map(|()| dvec2(number(1.0), number(1.0))));
            let polygon = clipped(&triangle, &Rect::new(dvec2(-0.7, -0.7), dvec2(0.7, 0.7)));
            if polygon.is_flat() {
                continue;
            }
            let mut coefficients = [(); 6].map(|()| number(1.0));
            match round % 4 {
                // Flat in one direction, or nearly.
                0 => {
                    let (a, b, flat) = (number(1.0), number(1.0), [0.0, 1e-9][round / 4 % 2]);
                    let bends = [a * a + flat, 2.0 * a * b, b * b + flat];
                    coefficients[3..].copy_from_slice(&bends);
                }
                1 => coefficients[3..].iter_mut().for_each(|c| *c *= 1e-3),
                2 => coefficients[3..].copy_from_slice(&[2.0, number(1.0), 1.5]),
                _ => {}
            }
            let [c, cu, cv, cuu, cuv, cvv] = coefficients;
            let at = |p: DVec2| c + cu * p.x + cv * p.y + cuu * p.x * p.x + cuv * p.x * p.y + cvv * p.y * p.y;
            let least = least_on_polygon(&coefficients, polygon.corners().iter().copied());
            let corners = polygon.corners();
            let of_corners = corners.iter().map(|&p| at(p)).fold(f64::INFINITY, f64::min);
            let (mut seen, mut on_edges) = (of_corners, of_corners);
            for (k, &a) in corners.iter().enumerate() {
                for n in 0..corners.len() {
                    let b = corners[(k + n) % corners.len()];
                    for i in 0..=40 {
                        let on_chord = a.lerp(b, f64::from(i) / 40.0);
                        if n == 1 {
                            on_edges = on_edges.min(at(on_chord));
                        }
                        for j in 0..=10 {
                            let value = at(on_chord.lerp(corners[0], f64::from(j) / 10.0));
                            assert!(value >= least - 1e-14, "{value} {least} {coefficients:?} {corners:?}");
                            seen = seen.min(value);
                        }
                    }
                }
            }
            assert!(seen - least < 0.03, "{seen} {least} {coefficients:?} {corners:?}");
            at_edges += usize::from(on_edges < of_corners - 0.01 && least > on_edges - 0.01);
            inside += usize::from(least < on_edges - 0.03);
        }
        assert!(at_edges > 300 && inside > 20, "{at_edges} {inside}");
    }
}
