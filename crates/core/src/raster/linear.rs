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
        is_within.then(|| self.linear_in(at.min(last.map(f64::next_down)))).flatten()
    }

    /// Returns what [`Self::linear_at`] does, but extrapolates linearly in the half pixel beyond the
    /// outermost centres: with a constant, a surface would have a kink there.
    pub(crate) fn continued_at(&self, point: DVec2) -> Option<f64> {
        let at = self.pixel_from_world(point);
        let last = DVec2::from(self.size().map(f64::from));
        if !(at.cmpge(DVec2::ZERO).all() && at.cmple(last).all()) {
            return None;
        }
        let at = at.min(last.map(f64::next_down));
        let inner = at.clamp(DVec2::splat(0.5), last - 0.5);
        let mirrored = 2.0 * inner - at;
        let beyond =
            |at: f64, inner: f64, mirrored: f64, value: &dyn Fn(f64) -> Option<f64>| match at == inner {
                true => value(at),
                false => Some(2.0 * value(inner)? - value(mirrored)?),
            };
        let along = |y| beyond(at.x, inner.x, mirrored.x, &|x| self.linear_in(DVec2::new(x, y)));
        let continued = beyond(at.y, inner.y, mirrored.y, &along);
        // Only the pixel at the point must have a value.
        self.linear_in(at).map(|flat| continued.unwrap_or(flat))
    }

    /// Returns the value at a place in pixels within the raster.
    fn linear_in(&self, at: DVec2) -> Option<f64> {
        linear(at, |x, y| self.known(x, y))
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

    #[test]
    fn a_plane_goes_on_to_the_sides_of_a_raster() {
        let mut random = fastrand::Rng::with_seed(36);
        let plane = |at: DVec2| 3.0 + 2.0 * at.x - 5.0 * at.y;
        for size in [[2, 2], [5, 3], [9, 7]] {
            let last = DVec2::from(size.map(f64::from));
            let mut raster = Raster::filled(Rect::new(DVec2::ZERO, last), size, 0.0);
            for (x, y) in raster.all().pixels() {
                raster.set(x, y, plane(raster.pixel_center(x, y)) as f32);
            }
            for _ in 0..500 {
                let at = dvec2(random.f64(), random.f64()) * last;
                let found = raster.continued_at(at).unwrap();
                assert!((found - plane(at)).abs() < 1e-12, "{found} at {at}");
                let inner = at.clamp(DVec2::splat(0.5), last - 0.5);
                assert_eq!(raster.continued_at(inner), raster.linear_at(inner), "the same between centres");
            }
            assert_eq!(raster.continued_at(last + 0.1), None);
            // Beside a pixel without a value it is flat, and on that pixel there is nothing.
            raster.set(1, 0, f32::NAN);
            assert_eq!(raster.continued_at(dvec2(0.1, 0.5)), raster.linear_at(dvec2(0.1, 0.5)));
            assert_eq!(raster.continued_at(dvec2(1.5, 0.1)), None);
        }
        let one = Raster::filled(Rect::UNIT, [1, 1], 4.0);
        assert_eq!(one.continued_at(dvec2(0.1, 0.9)), Some(4.0));
    }

    /// The sum over all pixels with a value, each with the weight of a tent around its centre.
    fn by_tents(raster: &Raster, at: DVec2) -> Option<f64> {
        let pixels = || raster.all().pixels().filter(|&(x, y)| !raster.get(x, y).is_nan());
        let [x, y] = at.to_array().map(|v| v as u32);
        pixels().find(|&pixel| pixel == (x, y))?;
        let tent = |v: f64, n: u32| (1.0 - (v - 0.5 - f64::from(n)).abs()).max(0.0);
        let terms = pixels().map(|(x, y)| {
            let weight = tent(at.x, x) * tent(at.y, y);
            [weight, weight * f64::from(raster.get(x, y))]
        });
        let [weights, sum] = terms.fold([0.0; 2], |sums, term| [sums[0] + term[0], sums[1] + term[1]]);
        Some(sum / weights)
    }

    #[test]
    fn random_rasters_have_the_values_of_tents_around_their_pixels() {
        let mut random = fastrand::Rng::with_seed(35);
        let mut gaps = 0;
        for _ in 0..3_000 {
            let size = [random.u32(1..6), random.u32(1..6)];
            let value = |_| if random.u8(..4) == 0 { f32::NAN } else { random.f32() };
            let values: Vec<f32> = (0..size[0] * size[1]).map(value).collect();
            let last = DVec2::from(size.map(f64::from));
            let raster = Raster::from_values(Rect::new(DVec2::ZERO, last), size, values);
            let at = dvec2(random.f64(), random.f64()) * last;
            let (found, expected) = (raster.linear_at(at), by_tents(&raster, at));
            gaps += usize::from(found.is_none());
            assert_eq!(found.is_some(), expected.is_some(), "{raster:?} at {at}");
            assert!(found.zip(expected).is_none_or(|(a, b)| (a - b).abs() < 1e-6), "{raster:?} at {at}");
            assert_eq!(raster.linear_at(at + last), None);
            assert_eq!(raster.linear_at(at - last), None);
        }
        assert!((300..1_500).contains(&gaps), "{gaps}");
    }
}
