//! Whether segments enter open rectangles, in exact arithmetic of whole numbers. It shares no code with what
//! it checks.

use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::Rect;

/// Coordinates are counted in these parts.
const BITS: i32 = 110;

/// Returns whether a segment enters an open rectangle. `None` where a coordinate is no multiple of 2⁻¹¹⁰, or
/// above 8.
///
/// Two convex sets do not meet if an axis or the normal of the segment separates them.
pub fn enters(p: DVec2, q: DVec2, open: &Rect) -> Option<bool> {
    let corners = [open.min, dvec2(open.max.x, open.min.y), open.max, dvec2(open.min.x, open.max.y)];
    let [px, py, qx, qy] = [p.x, p.y, q.x, q.y].map(whole);
    let [px, py, qx, qy] = [px?, py?, qx?, qy?];
    let is_beside =
        |a: i128, b: i128, low: f64, high: f64| Some(a.max(b) <= whole(low)? || a.min(b) >= whole(high)?);
    if is_beside(px, qx, open.min.x, open.max.x)? || is_beside(py, qy, open.min.y, open.max.y)? {
        return Some(false);
    }
    let mut sides = [0; 4];
    for (side, corner) in sides.iter_mut().zip(corners) {
        let [x, y] = [whole(corner.x)?, whole(corner.y)?];
        let (first, second) = (product(qx - px, y - py), product(qy - py, x - px));
        *side = first.cmp(&second) as i32;
    }
    Some(sides.iter().any(|&side| side > 0) && sides.iter().any(|&side| side < 0))
}

/// Returns a number in parts of 2⁻¹¹⁰, if it is a multiple of them.
fn whole(x: f64) -> Option<i128> {
    if x == 0.0 {
        return Some(0);
    }
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32 - 1075;
    let mantissa = i128::from((bits & ((1 << 52) - 1)) | (1 << 52));
    let shift = exponent + BITS;
    let size = match shift {
        0..=63 if x.abs() < 8.0 => mantissa << shift,
        -52..0 if mantissa % (1 << -shift) == 0 => mantissa >> -shift,
        _ => return None,
    };
    Some(if x < 0.0 { -size } else { size })
}

/// Returns the product of two whole numbers: its upper and its lower 128 bits.
fn product(a: i128, b: i128) -> (i128, u128) {
    let (x, y) = (a.unsigned_abs(), b.unsigned_abs());
    let low = |n: u128| n & u128::from(u64::MAX);
    let (x0, x1, y0, y1) = (low(x), x >> 64, low(y), y >> 64);
    let middle = low(x1 * y0) + low(x0 * y1) + ((x0 * y0) >> 64);
    let upper = x1 * y1 + ((x1 * y0) >> 64) + ((x0 * y1) >> 64) + (middle >> 64);
    let lower = (middle << 64) | low(x0 * y0);
    if (a < 0) == (b < 0) {
        (upper as i128, lower)
    } else {
        (!(upper as i128) + i128::from(lower == 0), lower.wrapping_neg())
    }
}

#[test]
fn segments_beside_rectangles_do_not_enter_them() {
    let open = Rect::new(dvec2(0.25, 0.25), dvec2(0.5, 0.5));
    let up = 0.25_f64.next_up();
    for (p, q, expected) in [
        (dvec2(0.25, 0.0), dvec2(0.25, 1.0), false),
        (dvec2(up, 0.0), dvec2(up, 1.0), true),
        (dvec2(0.0, 0.5), dvec2(0.5, 0.0), false),
        (dvec2(0.0, 0.5), dvec2(0.5, 1e-17), true),
        (dvec2(0.0, 0.0), dvec2(0.25, 0.25), false),
        (dvec2(-0.5, -0.5), dvec2(1.0, 1.0), true),
    ] {
        assert_eq!(enters(p, q, &open), Some(expected), "{p} {q}");
    }
    assert_eq!(product(-3, 5), (-1, (-15_i128) as u128));
    assert_eq!(product(1 << 100, -(1 << 100)), (-(1 << 72), 0));
}
