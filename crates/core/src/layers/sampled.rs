//! h̄ on a grid of pixels, to be shown.

use glam::DVec2;

use super::engine::Ungraded;
use super::{LayerId, PaintLayers, SizeField};
use crate::geometry::Rect;
use crate::raster::Raster;

impl SizeField {
    /// h̄ at the centres of the pixels of a grid over `bounds`, in world units; `size` is [columns, rows].
    ///
    /// Gradation is computed on the grid, by sweeps over the eikonal equation |∇h̄| = g: exact enough to be
    /// shown, and much faster than a search for each pixel.
    pub fn sampled(&self, paint: &PaintLayers, bounds: Rect, size: [u32; 2]) -> Raster {
        self.sampled_while(paint, bounds, size, &|| true)
            .map_or_else(|| Raster::filled(bounds, size, 0.0), |(h, _)| h)
    }

    /// Samples the field as [`Self::sampled`] does, and returns also the layers that decide h̄ at the pixels,
    /// row by row from the lowest: `None` where no layer asks for anything. Gradation carries the layer along
    /// with its diameter. The work ends without a result once it no longer `goes_on`.
    pub fn sampled_while(
        &self,
        paint: &PaintLayers,
        bounds: Rect,
        size: [u32; 2],
        goes_on: &dyn Fn() -> bool,
    ) -> Option<(Raster, Vec<Option<LayerId>>)> {
        let mut raster = Raster::filled(bounds, size, 0.0);
        let mut layers = Vec::with_capacity(raster.values().len());
        let centers = raster.pixel_centers();
        for (x, y) in raster.all().pixels() {
            if x == 0 && !goes_on() {
                return None;
            }
            let Ungraded { target, layer, .. } = self.stack.ungraded_at(paint, centers(x, y));
            raster.set(x, y, target as f32);
            layers.push(layer);
        }
        if let Some(slope) = self.stack.slope() {
            limit_slope(&mut raster, &mut layers, slope);
        }
        Some((raster, layers))
    }
}

/// Lowers values until they change by no more than `slope` per unit of length. The layers of a pixel become
/// those of the neighbour that lowers it.
fn limit_slope(raster: &mut Raster, layers: &mut [Option<LayerId>], slope: f64) {
    let [columns, rows] = raster.size();
    let step = raster.pixel_size() * slope;
    let forward = |n: u32| (0..n).collect::<Vec<_>>();
    let backward = |n: u32| (0..n).rev().collect::<Vec<_>>();
    // Twice in each direction: the second round carries values around corners.
    for _ in 0..2 {
        for ys in [forward(rows), backward(rows)] {
            for xs in [forward(columns), backward(columns)] {
                for &y in &ys {
                    for &x in &xs {
                        let (limit, [from_x, from_y]) = from_neighbours(raster, x, y, step);
                        if limit < f64::from(raster.get(x, y)) {
                            raster.set(x, y, limit as f32);
                            let [from, to] =
                                [[from_x, from_y], [x, y]].map(|[x, y]| (y * columns + x) as usize);
                            layers[to] = layers[from];
                        }
                    }
                }
            }
        }
    }
}

/// Returns the value of the eikonal equation from the smaller neighbours along both axes, and the neighbour
/// that lowers it most; `step` is the largest change per pixel.
fn from_neighbours(raster: &Raster, x: u32, y: u32, step: DVec2) -> (f64, [u32; 2]) {
    let [columns, rows] = raster.size();
    let value = |inside: bool, x: u32, y: u32| match inside {
        true => (f64::from(raster.get(x, y)), [x, y]),
        false => (f64::INFINITY, [x, y]),
    };
    let smaller = |a: (f64, [u32; 2]), b: (f64, [u32; 2])| if b.0 < a.0 { b } else { a };
    let (along_x, at_x) = smaller(value(x > 0, x.wrapping_sub(1), y), value(x + 1 < columns, x + 1, y));
    let (along_y, at_y) = smaller(value(y > 0, x, y.wrapping_sub(1)), value(y + 1 < rows, x, y + 1));
    let (one_sided, from) = smaller((along_x + step.x, at_x), (along_y + step.y, at_y));
    // ((v − a) / sx)² + ((v − b) / sy)² = 1
    let (a, b) = (along_x, along_y);
    if !(a.is_finite() && b.is_finite()) {
        return (one_sided, from);
    }
    let (p, q) = (1.0 / (step.x * step.x), 1.0 / (step.y * step.y));
    let discriminant = (p + q) - p * q * (a - b) * (a - b);
    if discriminant < 0.0 {
        return (one_sided, from);
    }
    let both = (p * a + q * b + discriminant.sqrt()) / (p + q);
    (if both >= a.max(b) { both.min(one_sided) } else { one_sided }, from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;

    /// The update from both axes counts only where it is above both neighbours: a front that reaches a pixel
    /// from below cannot come from a higher neighbour.
    #[test]
    fn a_value_is_above_the_neighbours_that_it_comes_from() {
        let mut random = fastrand::Rng::with_seed(61);
        let (mut both, mut one) = (0, 0);
        for _ in 0..20_000 {
            let mut raster = Raster::filled(Rect::UNIT, [2, 2], f32::INFINITY);
            let [a, b] = [0, 1].map(|_| 3.0 * random.f32());
            raster.set(0, 1, a);
            raster.set(1, 0, b);
            let step = DVec2::new(0.1 + random.f64(), 0.1 + random.f64());
            let (value, from) = from_neighbours(&raster, 1, 1, step);
            let sided = (f64::from(a) + step.x).min(f64::from(b) + step.y);
            let [a, b] = [a, b].map(f64::from);
            let rises = [(value - a).max(0.0) / step.x, (value - b).max(0.0) / step.y];
            // The slope that is allowed, over both axes as far as the value rises along them.
            assert!((rises[0].hypot(rises[1]) - 1.0).abs() < 1e-6, "{a} {b} {step} {value}");
            assert!(value <= sided && (from == [0, 1] || from == [1, 0]));
            both += usize::from(value < sided);
            one += usize::from(value == sided);
        }
        assert!(both > 1000 && one > 1000, "{both} {one}");
    }
}
