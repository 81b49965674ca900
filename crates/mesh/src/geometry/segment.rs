use glam::DVec2;

/// Returns the place on the segment from `a` to `b` that is nearest to `p`: 0 at `a`, 1 at `b`; 0 where both
/// are one point.
#[inline]
pub fn nearest_share(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    if length_squared > 0.0 { ((p - a).dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the point of a segment that is nearest to `p`.
pub fn nearest_on_segment(p: DVec2, [a, b]: [DVec2; 2]) -> DVec2 {
    a + nearest_share(p, [a, b]) * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn the_nearest_point_is_an_end_or_between_them() {
        let mut random = fastrand::Rng::with_seed(35);
        for _ in 0..500 {
            let mut point = || dvec2(random.f64(), random.f64()) * 10.0 - 5.0;
            let (p, [a, b]) = (point(), [point(), point()]);
            let nearest = nearest_on_segment(p, [a, b]);
            assert!(
                (nearest.distance(a) + nearest.distance(b) - a.distance(b)).abs() < 1e-12,
                "it is on {a} {b}"
            );
            for n in 0..=20 {
                let other = a.lerp(b, f64::from(n) / 20.0);
                assert!(p.distance(nearest) <= p.distance(other) + 1e-12, "{other} is nearer to {p}");
            }
            assert_eq!(nearest_on_segment(p, [a, a]), a, "a segment without length");
        }
    }
}
