//! Rasters of layers.

use std::sync::Arc;

use crate::raster::{Raster, RasterPyramid};

/// A raster, and where it comes from. Clones share the pixels.
#[derive(Clone, Debug)]
pub struct RasterSource {
    /// The name of the file, for a person.
    pub name: String,
    /// The values, at their place.
    pub raster: Arc<RasterPyramid>,
}

impl PartialEq for RasterSource {
    /// Rasters that share their memory are not compared pixel by pixel. Pixels without a value are equal.
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && (Arc::ptr_eq(&self.raster, &other.raster)
                || have_equal_pixels(self.raster.raster(), other.raster.raster()))
    }
}

fn have_equal_pixels(a: &Raster, b: &Raster) -> bool {
    let is_equal = |(a, b): (&f32, &f32)| a == b || (a.is_nan() && b.is_nan());
    a.bounds() == b.bounds() && a.size() == b.size() && a.values().iter().zip(b.values()).all(is_equal)
}

impl RasterSource {
    /// Returns the address of the pixels, and their memory in bytes.
    pub(super) fn shared_data(&self) -> (usize, usize) {
        (Arc::as_ptr(&self.raster).addr(), self.raster.bytes())
    }
}
