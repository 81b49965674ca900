use glam::{DVec2, dvec2};

use super::Camera;
use crate::geometry::Rect;

/// A raster of colours above the mesh, such as the field that is painted.
///
/// Shown with the nearest pixel, so that the raster's own resolution is seen.
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    /// Where it lies, in world units.
    pub bounds: Rect,
    /// Pixels in a row.
    pub columns: u32,
    /// Number of rows.
    pub rows: u32,
    /// Red, green, blue, alpha, not premultiplied, row by row from the lower left.
    pub rgba: &'a [[u8; 4]],
    /// How much of it shows, from 0 to 1.
    pub opacity: f32,
    /// Changes with the contents; renderers that keep a copy compare it.
    pub revision: u64,
}

/// The pixels of an overlay as seen from the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelMap {
    /// Column and row, as real numbers, in the middle of the canvas.
    pub at_center: DVec2,
    /// Columns for a pixel to the right, and rows for a pixel upwards.
    pub per_px: DVec2,
}

impl Overlay<'_> {
    /// Where on the screen its pixels are.
    pub fn texels(&self, camera: &Camera) -> TexelMap {
        let per_world = dvec2(f64::from(self.columns), f64::from(self.rows)) / self.bounds.size();
        let middle = camera.world_from_screen(camera.half_size_px());
        TexelMap {
            at_center: (middle - self.bounds.min) * per_world,
            per_px: per_world / camera.px_per_world(),
        }
    }
}
