use glam::DVec2;

/// Returns the area that a ring of points encloses; negative if they run clockwise. The last point need not
/// be the first one again.
pub fn signed_area(ring: &[DVec2]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    let ends = ring.iter().skip(1).chain(ring.first());
    // Relative to a corner of the ring: large coordinates would cost digits.
    0.5 * ring.iter().zip(ends).map(|(&a, &b)| (a - origin).perp_dot(b - origin)).sum::<f64>()
}

/// Returns whether a ring runs around a point an odd number of times, counting the edges to the right of it.
/// The last point need not be the first one again.
pub fn is_around(ring: &[DVec2], point: DVec2) -> bool {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| {
        (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}
