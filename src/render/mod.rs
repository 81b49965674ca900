//! Draws a scene: [`software`] everywhere, and on the GPU with the feature `gui`.
//!
//! Both follow one rule for each pixel. The pixel takes the fill of the triangle that holds its centre, mixed with the
//! colour of the edge by `edge_alpha · clamp(reach − d, 0, 1)`, where d is the distance to the nearest edge of that
//! triangle in pixels. All numbers of the rule come from [`LevelPaint`](crate::scene::LevelPaint) and
//! [`Style`](crate::scene::Style). Fills have no antialiasing: abutting triangles would show bright seams.

pub mod export;
#[cfg(feature = "gui")]
pub mod gpu;
pub mod software;

/// Triangles with legs from this length on, in pixels, are not rasterised by their corners but pixel by pixel, from the
/// exact lines through their edges: further out, f32 and a rasteriser's fixed-point numbers would shift a diagonal.
/// At most a few of them meet a canvas at a time.
const HUGE_LEG_PX: f32 = 4096.0;

/// How far the pixels of a huge triangle reach beyond its edges, in pixels. A rasterised neighbour ends on its own grid
/// of 1/256 px; this closes the gap.
const SEAM_SLACK_PX: f32 = 1.0 / 64.0;

/// An opaque picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green, blue, alpha as sRGB bytes, row by row from the upper left.
    pub rgba: Vec<u8>,
}

impl Image {
    /// A picture of one colour.
    pub fn filled(size: [u32; 2], color: [u8; 4]) -> Self {
        Self { size, rgba: color.repeat(size[0] as usize * size[1] as usize) }
    }

    /// The colour at a column and row, from the upper left.
    ///
    /// # Panics
    /// When there is no such pixel.
    pub fn pixel(&self, column: u32, row: u32) -> [u8; 4] {
        self.pixels()[row as usize * self.size[0] as usize + column as usize]
    }

    /// All pixels, row by row from the upper left.
    pub fn pixels(&self) -> &[[u8; 4]] {
        bytemuck::cast_slice(&self.rgba)
    }

    fn pixels_mut(&mut self) -> &mut [[u8; 4]] {
        bytemuck::cast_slice_mut(&mut self.rgba)
    }
}
