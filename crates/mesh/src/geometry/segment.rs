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
        let segment = [dvec2(1.0, 0.0), dvec2(3.0, 0.0)];
        for (p, nearest) in [
            (dvec2(0.0, 5.0), dvec2(1.0, 0.0)),
            (dvec2(2.5, -1.0), dvec2(2.5, 0.0)),
            (dvec2(9.0, 0.0), dvec2(3.0, 0.0)),
        ] {
            assert_eq!(nearest_on_segment(p, segment), nearest);
        }
        assert_eq!(nearest_on_segment(dvec2(7.0, 7.0), [segment[0]; 2]), segment[0]);
    }
}
