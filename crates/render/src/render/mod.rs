//! Draws a scene, in software ([`software`]) or, with the feature `gui`, on the GPU.
//!
//! Both renderers colour a pixel by the same rule: the fill of the triangle that contains its centre, mixed
//! with the colour of the edge by `edge_alpha · clamp(reach − d, 0, 1)`, where d is the distance to the
//! nearest edge of that triangle in pixels. All numbers of the rule come from
//! [`LevelPaint`](crate::scene::LevelPaint) and [`Style`](crate::scene::Style). Fills are not antialiased,
//! since adjacent triangles would show bright seams.

mod draw_flags;
mod drawn;
pub mod export;
pub mod furniture;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod look;
pub mod north_arrow;
pub mod overlay;
pub mod path_export;
pub mod picture_size;
mod skia;
pub mod software;
pub mod space_look;
#[cfg(test)]
mod picture_tests;
mod vector_picture;

pub use drawn::picture_of;

/// Triangles of at least this size in pixels are drawn pixel by pixel from the exact lines through their
/// edges. Rasterizing such triangles from their corners in f32 or fixed-point numbers would shift an edge. At
/// most a few of them intersect the canvas.
const HUGE_PX: f32 = 4096.0;

/// How far huge triangles are drawn beyond their edges, in pixels. A rasterized neighbour ends on a grid of
/// 1/256 px; the overlap closes the gap.
const SEAM_SLACK_PX: f32 = 1.0 / 64.0;

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green, blue and alpha as sRGB bytes, row by row from the upper left.
    pub rgba: Vec<u8>,
}

impl Image {
    /// Returns a picture of one colour.
    pub fn filled(size: [u32; 2], color: [u8; 4]) -> Self {
        Self { size, rgba: color.repeat(size[0] as usize * size[1] as usize) }
    }

    /// Returns the colour at a column and row, counted from the upper left.
    ///
    /// # Panics
    /// Panics when there is no such pixel.
    pub fn pixel(&self, column: u32, row: u32) -> [u8; 4] {
        self.pixels()[row as usize * self.size[0] as usize + column as usize]
    }

    /// Returns all pixels, row by row from the upper left.
    pub fn pixels(&self) -> &[[u8; 4]] {
        bytemuck::cast_slice(&self.rgba)
    }

    /// Returns all pixels for drawing, row by row from the upper left.
    pub fn pixels_mut(&mut self) -> &mut [[u8; 4]] {
        bytemuck::cast_slice_mut(&mut self.rgba)
    }
}
