//! Values between the centres of pixels.

use glam::DVec2;

use super::Raster;

/// Returns the value at a place in pixels, whose floor is (column, row): linear between the centres of the
/// pixels around it, as far as these have a value. `None` where the pixel at the place has none. `pixel`
/// returns the value of a pixel, and `None` without one.
pub(super) fn linear(at: DVec2, pixel: impl Fn(i64, i64) -> Option<f32>) -> Option<f64> {
    let [x, y] = at.floor().to_array().map(|at| at as i64);
    pixel(x, y)?;
    let from = at - 0.5;
    let share = from - from.floor();
    let [x, y] = from.floor().to_array().map(|at| at as i64);
    let (mut sum, mut weights) = (0.0, 0.0);
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let along_x = if dx == 1 { share.x } else { 1.0 - share.x };
        let along_y = if dy == 1 { share.y } else { 1.0 - share.y };
        if let Some(value) = pixel(x + dx, y + dy) {
            sum += along_x * along_y * f64::from(value);
            weights += along_x * along_y;
        }
    }
    Some(sum / weights)
}

impl Raster {
    /// Returns the value of the pixel in column `x` and row `y`; `None` outside the raster and where there is
    /// none.
    pub fn known(&self, x: i64, y: i64) -> Option<f32> {
        let [columns, rows] = self.size().map(i64::from);
        let is_within = (0..columns).contains(&x) && (0..rows).contains(&y);
        is_within.then(|| self.get(x as u32, y as u32)).filter(|value| !value.is_nan())
    }

    /// Returns the value at a point in world units, linear between the centres of pixels that have a value;
    /// `None` outside the bounds and where the pixel at the point has none.
    pub fn linear_at(&self, point: DVec2) -> Option<f64> {
        // The upper and right sides belong to the last pixels.
        let at = self.pixel_from_world(point);
        let last = DVec2::from(self.size().map(f64::from));
        let is_within = at.cmpge(DVec2::ZERO).all() && at.cmple(last).all();
        is_within.then(|| linear(at.min(last.map(f64::next_down)), |x, y| self.known(x, y))).flatten()
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::Rect;

    #[test]
    fn values_are_linear_between_the_centres_of_pixels() {
        let mut random = fastrand::Rng::with_seed(32);
        for _ in 0..100 {
            // A plane through the centres of pixels: beyond the outer ones the values stay as they are there.
            let [columns, rows] = [(); 2].map(|()| random.u32(1..6));
            let bounds =
                Rect::new(dvec2(10.0, 20.0), dvec2(10.0 + f64::from(columns), 20.0 + f64::from(rows)));
            let slope = dvec2(f64::from(random.i32(-8..9)), f64::from(random.i32(-8..9)));
            let plane = |at: DVec2| 3.0 + slope.dot(at);
            let mut raster = Raster::filled(bounds, [columns, rows], 0.0_f32);
            for (x, y) in raster.all().pixels() {
                raster.set(x, y, plane(raster.pixel_center(x, y)) as f32);
            }
            for _ in 0..20 {
                let at = bounds.min + bounds.size() * dvec2(random.f64(), random.f64());
                let expected = plane(at.clamp(bounds.min + 0.5, bounds.max - 0.5));
                let found = raster.linear_at(at).unwrap();
                assert!((found - expected).abs() < 1e-9, "{at} in {bounds:?}: {found}, not {expected}");
            }
            // Without the values of some pixels: those of others there only, and within their range.
            for (x, y) in raster.all().pixels().filter(|_| random.bool()).collect::<Vec<_>>() {
                raster.set(x, y, f32::NAN);
            }
            let known: Vec<f64> =
                raster.values().iter().map(|&value| value.into()).filter(|v: &f64| !v.is_nan()).collect();
            for (x, y) in raster.all().pixels() {
                let (centre, own) = (raster.pixel_center(x, y), raster.get(x, y));
                assert_eq!(raster.linear_at(centre), (!own.is_nan()).then(|| own.into()));
                let beside = centre + dvec2(random.f64(), random.f64()) - 0.5;
                let found = raster.linear_at(beside);
                assert_eq!(found.is_some(), !own.is_nan(), "{beside}");
                let is_in_range = |value: f64| {
                    known.iter().any(|&v| v <= value + 1e-9) && known.iter().any(|&v| v >= value - 1e-9)
                };
                assert!(found.is_none_or(is_in_range), "{beside}: {found:?} of {known:?}");
            }
        }
    }

    #[test]
    fn the_rim_belongs_to_the_raster_and_pixels_without_values_do_not_count_beside_others() {
        let bounds = Rect::new(dvec2(10.0, 20.0), dvec2(14.0, 22.0));
        let values = vec![0.0, 2.0, 4.0, 6.0, 1.0, 3.0, f32::NAN, 7.0];
        let raster = Raster::from_values(bounds, [4, 2], values);
        for ([x, y], value) in [
            ([10.0, 20.0], Some(0.0)),
            ([14.0, 22.0], Some(7.0)),
            ([13.0, 21.5], Some(7.0)),
            ([9.9, 20.5], None),
        ] {
            assert_eq!(raster.linear_at(dvec2(x, y)), value, "{x}, {y}");
        }
    }
}
