//! The nearest pixel with a value.

use glam::DVec2;

use super::Raster;

/// A pixel with a value, seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPixel {
    /// The value of the pixel.
    pub value: f64,
    /// The distance of its centre, in world units.
    pub distance: f64,
}

impl Raster {
    /// Returns the pixel with a value whose centre is nearest to a point in world units; `None` if no pixel
    /// within `farthest` columns and rows has one.
    pub fn nearest(&self, point: DVec2, farthest: u32) -> Option<NearestPixel> {
        let [x, y] = self.pixel_from_world(point).floor().to_array().map(|at| at as i64);
        let mut best: Option<NearestPixel> = None;
        let pixel = self.pixel_size();
        for ring in 0..=i64::from(farthest) {
            // Pixels of a farther ring have their centres farther than this.
            let closest = (ring as f64 - 0.5) * pixel.min_element();
            if best.is_some_and(|best| best.distance <= closest) {
                break;
            }
            let on_ring = (-ring..=ring).flat_map(|d| match d.abs() == ring {
                true => (-ring..=ring).map(|e| (d, e)).collect::<Vec<_>>(),
                false => vec![(d, -ring), (d, ring)],
            });
            for (dx, dy) in on_ring {
                let (x, y) = (x.saturating_add(dx), y.saturating_add(dy));
                let Some(value) = self.known(x, y) else { continue };
                let distance = self.pixel_center(x as u32, y as u32).distance(point);
                if best.is_none_or(|best| distance < best.distance) {
                    best = Some(NearestPixel { value: f64::from(value), distance });
                }
            }
        }
        best
    }
}
