use glam::DVec2;

/// Returns the area that a ring of points encloses; negative if they run clockwise. The last point need not
/// be the first one again.
pub fn signed_area(ring: &[DVec2]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    let ends = ring.iter().skip(1).chain(ring.first());
    // Relative to a corner of the ring: large coordinates would cost digits.
    0.5 * ring.iter().zip(ends).map(|(&a, &b)| (a - origin).perp_dot(b - origin)).sum::<f64>()
}
