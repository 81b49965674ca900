use glam::{DVec2, dvec2};

use super::Camera;
use meshbrush_mesh::geometry::Rect;

/// A raster of colours that takes the place of the colours of the mesh, such as the painted field.
///
/// The picture of the mesh is multiplied by it: drawn with [`Style::under`](super::Style::under), triangles
/// have exactly the colours of the raster, and edges are a dark tint of them. It is sampled at the nearest
/// pixel, so that its own resolution is visible.
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    /// The rectangle it covers, in world units.
    pub bounds: Rect,
    /// Pixels in a row.
    pub columns: u32,
    /// Number of rows.
    pub rows: u32,
    /// Red, green, blue and an unused byte, row by row from the lower left.
    pub rgba: &'a [[u8; 4]],
    /// The colour beyond the rectangle.
    pub beyond: [u8; 4],
    /// Changes with the contents. Renderers that keep a copy compare it.
    pub revision: u64,
}

/// Maps screen positions to pixels (texels) of an overlay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelMap {
    /// Column and row at the middle of the canvas, as real numbers.
    pub at_center: DVec2,
    /// Columns per pixel to the right, and rows per pixel upwards.
    pub per_px: DVec2,
}

impl Overlay<'_> {
    /// Returns the map from screen positions to pixels of this overlay.
    pub fn texels(&self, camera: &Camera) -> TexelMap {
        let per_world = dvec2(f64::from(self.columns), f64::from(self.rows)) / self.bounds.size();
        let middle = camera.world_from_screen(camera.half_size_px());
        TexelMap {
            at_center: (middle - self.bounds.min) * per_world,
            per_px: per_world / camera.px_per_world(),
        }
    }
}
