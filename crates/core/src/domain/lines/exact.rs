//! Segments between lattice points, in integers.

use crate::geometry::LatticePoint;

/// Returns the coordinates of a lattice point, which stay below 2^31.
pub(crate) fn place(p: LatticePoint) -> [i64; 2] {
    [i64::from(p.x), i64::from(p.y)]
}

/// Returns twice the area of a triangle: positive if its corners run anticlockwise. It is below 2^62.
pub(crate) fn cross(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> i64 {
    let ([ax, ay], [bx, by], [cx, cy]) = (place(a), place(b), place(c));
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

fn dot(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> i64 {
    let ([ax, ay], [bx, by], [cx, cy]) = (place(a), place(b), place(c));
    (bx - ax) * (cx - ax) + (by - ay) * (cy - ay)
}

/// Returns whether a point is at most one lattice step beside the straight line through a segment.
pub(crate) fn is_near([a, b]: [LatticePoint; 2], p: LatticePoint) -> bool {
    let off = i128::from(cross(a, b, p));
    off * off <= i128::from(dot(a, b, b))
}

/// Returns whether the foot of a point on the straight line through a segment is strictly between its ends.
pub(crate) fn lies_between([a, b]: [LatticePoint; 2], p: LatticePoint) -> bool {
    dot(a, b, p) > 0 && dot(b, a, p) > 0
}

/// Returns the lattice point nearest to the crossing of two segments; `None` unless the ends of each are
/// strictly on different sides of the other. It does not depend on directions and order.
pub(crate) fn crossing(one: [LatticePoint; 2], other: [LatticePoint; 2]) -> Option<LatticePoint> {
    let sorted = |[a, b]: [LatticePoint; 2]| if a <= b { [a, b] } else { [b, a] };
    let (one, other) = (sorted(one), sorted(other));
    let ([a, b], [p, q]) = if one <= other { (one, other) } else { (other, one) };
    let (at_a, at_b) = (cross(p, q, a), cross(p, q, b));
    let (at_p, at_q) = (cross(a, b, p), cross(a, b, q));
    let apart = |s: i64, t: i64| s.signum() * t.signum() < 0;
    if !apart(at_a, at_b) || !apart(at_p, at_q) {
        return None;
    }
    let (whole, share) = (i128::from(at_a) - i128::from(at_b), i128::from(at_a));
    let (whole, share) = if whole < 0 { (-whole, -share) } else { (whole, share) };
    let ([ax, ay], [bx, by]) = (place(a), place(b));
    let at = |a: i64, b: i64| {
        let moved = i128::from(b - a) * share;
        (i128::from(a) + (2 * moved + whole).div_euclid(2 * whole)) as u32
    };
    Some(LatticePoint::new(at(ax, bx), at(ay, by)))
}
