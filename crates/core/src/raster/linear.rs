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
        let bounds = Rect::new(dvec2(10.0, 20.0), dvec2(14.0, 22.0));
        let values = vec![0.0, 2.0, 4.0, 6.0, 1.0, 3.0, f32::NAN, 7.0];
        let raster = Raster::from_values(bounds, [4, 2], values);
        for ([x, y], value) in [
            ([11.0, 20.5], Some(1.0)),
            ([11.0, 21.0], Some(1.5)),
            ([10.0, 20.0], Some(0.0)),
            ([14.0, 22.0], Some(7.0)),
            ([12.5, 21.5], None),
            // The pixel without a value does not count beside others.
            ([13.0, 21.5], Some(7.0)),
            ([9.9, 20.5], None),
        ] {
            assert_eq!(raster.linear_at(dvec2(x, y)), value, "{x}, {y}");
        }
    }
}
