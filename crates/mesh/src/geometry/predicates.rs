use std::cmp::Ordering;

use glam::DVec2;

use super::LatticePoint;

/// The side of a directed edge on which a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Strictly to the left: inside, for an edge that runs anticlockwise around a triangle.
    Left,
    /// On the line through the edge.
    On,
    /// Strictly to the right: outside.
    Right,
}

/// Returns the orientation test of the report (Figure 6), without its rounding errors.
///
/// The edge runs from `from` to `to`; both are lattice nodes, `point` is in lattice coordinates.
/// Edges of a mesh run in one of eight directions only (along an axis or a diagonal), so that the
/// sign of the determinant is the sign of a sum of three numbers, which is found exactly.
///
/// ```
/// # use meshbrush_mesh::geometry::{LatticePoint, Side, side_of_edge};
/// let (a, b) = (LatticePoint::new(0, 0), LatticePoint::new(4, 4));
/// assert_eq!(side_of_edge(a, b, glam::dvec2(1.0, 1.0)), Side::On);
/// assert_eq!(side_of_edge(a, b, glam::dvec2(1.0, 1.0_f64.next_up())), Side::Left);
/// ```
#[inline]
pub fn side_of_edge(from: LatticePoint, to: LatticePoint, point: DVec2) -> Side {
    let step_x = direction(from.x, to.x);
    let step_y = direction(from.y, to.y);
    debug_assert!(
        step_x == 0.0 || step_y == 0.0 || from.x.abs_diff(to.x) == from.y.abs_diff(to.y),
        "an edge of a mesh runs along an axis or a diagonal"
    );
    let (from_x, from_y) = (f64::from(from.x), f64::from(from.y));
    let estimate = step_x * (point.y - from_y) - step_y * (point.x - from_x);
    // Lattice coordinates stay below 2^31, so the estimate is off by less than 2^-20.
    if estimate > 1e-6 {
        return Side::Left;
    }
    if estimate < -1e-6 {
        return Side::Right;
    }
    match exact_sum_sign(step_x * point.y, -step_y * point.x, step_x * from_y - step_y * from_x) {
        Ordering::Greater => Side::Left,
        Ordering::Equal => Side::On,
        Ordering::Less => Side::Right,
    }
}

#[inline]
fn direction(from: u32, to: u32) -> f64 {
    f64::from(i32::from(to > from) - i32::from(to < from))
}

/// Compares the exact sum `a + b` with `c`.
///
/// Rounding is monotone: where the rounded sum differs from `c`, it differs in the true direction;
/// where it does not, the rounding error (found by Knuth's two-sum) decides. NaN compares equal.
///
/// ```
/// # use meshbrush_mesh::geometry::exact_sum_sign;
/// assert_eq!(1.0 + 1e-300, 1.0);
/// assert!(exact_sum_sign(1.0, 1e-300, 1.0).is_gt());
/// ```
pub fn exact_sum_sign(a: f64, b: f64, c: f64) -> Ordering {
    let sum = a + b;
    if sum > c {
        return Ordering::Greater;
    }
    if sum < c {
        return Ordering::Less;
    }
    let b_rounded = sum - a;
    let a_rounded = sum - b_rounded;
    let error = (a - a_rounded) + (b - b_rounded);
    error.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

/// Returns the side of the line from `from` to `to` on which a point is, for any two different lattice points
/// ([`side_of_edge`] is faster for edges of a mesh).
pub fn side_of_line(from: LatticePoint, to: LatticePoint, point: DVec2) -> Side {
    let run = f64::from(to.x) - f64::from(from.x);
    let rise = f64::from(to.y) - f64::from(from.y);
    let estimate = run * (point.y - f64::from(from.y)) - rise * (point.x - f64::from(from.x));
    // Differences stay below 2^32 and products below 2^64, so the estimate is off by less than 2^13.
    if estimate.abs() > 8192.0 {
        return if estimate > 0.0 { Side::Left } else { Side::Right };
    }
    let offset = i128::from(to.y) * i128::from(from.x) - i128::from(to.x) * i128::from(from.y);
    let rounded = offset as f64;
    let rest = (offset - rounded as i128) as f64;
    let (a, b) = (run * point.y, -rise * point.x);
    let terms = [a, run.mul_add(point.y, -a), b, (-rise).mul_add(point.x, -b), rounded, rest];
    match sign_of_sum(terms) {
        Ordering::Greater => Side::Left,
        Ordering::Equal => Side::On,
        Ordering::Less => Side::Right,
    }
}

/// Returns the side of the line from `from` to `to` on which a point lies, for any three finite points: the
/// sign of (to − from) × (point − from) without rounding errors, as long as no product overflows or is below
/// 10⁻²⁹⁰.
///
/// ```
/// # use meshbrush_mesh::geometry::{Side, side_of_points};
/// let [from, to] = [glam::dvec2(0.0, 0.0), glam::dvec2(3.0, 1.0)];
/// assert_eq!(side_of_points(from, to, glam::dvec2(1.5, 0.5)), Side::On);
/// assert_eq!(side_of_points(from, to, glam::dvec2(1.5, 0.5_f64.next_up())), Side::Left);
/// ```
pub fn side_of_points(from: DVec2, to: DVec2, point: DVec2) -> Side {
    let (a, b) = (from - point, to - point);
    let (first, second) = (a.x * b.y, a.y * b.x);
    let estimate = first - second;
    // The signs of the differences are exact, and so are those of the products. Where the products have
    // different signs, so is that of their difference; elsewhere it is off by less than 4 ulps of their sum.
    let is_certain = (first <= 0.0 && second >= 0.0)
        || (first >= 0.0 && second <= 0.0)
        || estimate.abs() > 4.0 * f64::EPSILON * (first.abs() + second.abs());
    let sign = if is_certain {
        estimate.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
    } else {
        let product = |p: f64, q: f64| [p * q, p.mul_add(q, -(p * q))];
        let parts = [
            product(from.x, to.y),
            product(-from.x, point.y),
            product(-point.x, to.y),
            product(-from.y, to.x),
            product(from.y, point.x),
            product(point.y, to.x),
        ];
        let [[a, b], [c, d], [e, f], [g, h], [i, j], [k, l]] = parts;
        sign_of_sum([a, b, c, d, e, f, g, h, i, j, k, l])
    };
    match sign {
        Ordering::Greater => Side::Left,
        Ordering::Equal => Side::On,
        Ordering::Less => Side::Right,
    }
}

/// Returns the sign of the exact sum of some numbers: each is added to an expansion, a list of numbers that
/// do not overlap and have the same sum, the smallest first. The largest of them decides.
fn sign_of_sum<const N: usize>(terms: [f64; N]) -> Ordering {
    let mut expansion = [0.0f64; N];
    for (count, term) in terms.into_iter().enumerate() {
        let mut carried = term;
        for part in &mut expansion[..count] {
            let sum = carried + *part;
            let rounded = sum - carried;
            *part = (carried - (sum - rounded)) + (*part - rounded);
            carried = sum;
        }
        expansion[count] = carried;
    }
    let largest = expansion.into_iter().rfind(|part| *part != 0.0).unwrap_or(0.0);
    largest.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_beside_a_line_are_told_from_points_on_it() {
        let mut random = fastrand::Rng::with_seed(2601);
        let mut on_line = 0;
        for _ in 0..20_000 {
            // Multiples of 1/8 with 40 bits: integers decide without rounding.
            let mut coordinate = || random.i64(-(1 << 40)..1 << 40);
            let [a, b, mut c] = [(); 3].map(|()| [coordinate(), coordinate()]);
            if random.bool() {
                let steps = random.i64(1..4);
                c = [0, 1].map(|axis| a[axis] + steps * (b[axis] - a[axis]));
                c[random.usize(..2)] += random.i64(-1..2);
            }
            let product = |axis: usize| i128::from(b[axis] - a[axis]) * i128::from(c[1 - axis] - a[1 - axis]);
            let expected = product(0).cmp(&product(1));
            let [from, to, point] = [a, b, c].map(|[x, y]| DVec2::new(x as f64, y as f64) / 8.0);
            let side = match expected {
                Ordering::Greater => Side::Left,
                Ordering::Equal => Side::On,
                Ordering::Less => Side::Right,
            };
            on_line += usize::from(side == Side::On);
            assert_eq!(side_of_points(from, to, point), side, "{from} {to} {point}");
        }
        assert!(on_line > 1000, "{on_line}");
    }

    #[test]
    fn one_ulp_off_each_of_the_eight_directions_is_seen() {
        let centre = LatticePoint::new(1 << 29, 1 << 29);
        let middle = f64::from(1u32 << 29);
        for (dx, dy) in [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)] {
            let to = LatticePoint::new(
                (i64::from(centre.x) + 64 * dx) as u32,
                (i64::from(centre.y) + 64 * dy) as u32,
            );
            assert_eq!(side_of_edge(centre, to, DVec2::splat(middle)), Side::On);
            // Left of (dx, dy) is (-dy, dx): move one ulp that way along one axis.
            let mut left = DVec2::splat(middle);
            if dx != 0 {
                left.y = if dx > 0 { left.y.next_up() } else { left.y.next_down() };
            } else {
                left.x = if dy > 0 { left.x.next_down() } else { left.x.next_up() };
            }
            assert_eq!(side_of_edge(centre, to, left), Side::Left, "direction {dx}, {dy}");
            assert_eq!(side_of_edge(to, centre, left), Side::Right, "direction {dx}, {dy}");
        }
    }
}
