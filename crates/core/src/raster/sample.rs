//! A sample of the values of a raster.

use super::{RasterPyramid, ValueRange};

/// Most pixels whose values [`RasterPyramid::sorted_sample`] returns, besides the minimum and the maximum.
const SAMPLE: usize = 1 << 16;

impl RasterPyramid {
    /// Returns finite values in ascending order: the minimum, the maximum, and those of every pixel, or of
    /// every second, third … pixel where there are more than 65,536.
    pub fn sorted_sample(&self) -> Vec<f32> {
        let Some(ValueRange { least, greatest }) = self.finite_range() else { return Vec::new() };
        let all = self.raster().values();
        let every = all.len().div_ceil(SAMPLE).max(1);
        let mut values: Vec<f32> =
            all.iter().copied().step_by(every).filter(|value| value.is_finite()).collect();
        if every > 1 {
            values.extend([least, greatest]);
        }
        values.sort_unstable_by(f32::total_cmp);
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;
    use crate::raster::Raster;

    #[test]
    fn a_sample_is_ascending_and_has_both_ends() {
        let of = |size: [u32; 2], values: Vec<f32>| {
            RasterPyramid::new(Raster::from_values(Rect::UNIT, size, values)).sorted_sample()
        };
        assert_eq!(of([2, 2], vec![3.0, f32::NAN, -1.0, f32::INFINITY]), [-1.0, 3.0]);
        assert!(of([1, 1], vec![f32::NAN]).is_empty());
        let mut large = vec![0.5; 400 * 400];
        (large[1], large[3]) = (-7.0, 9.0);
        let sample = of([400, 400], large);
        assert_eq!((sample[0], *sample.last().unwrap()), (-7.0, 9.0));
        assert!(sample.len() <= SAMPLE + 2, "{}", sample.len());
    }
}
