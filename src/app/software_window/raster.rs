//! Fills the triangles of the window's panels and marks, as egui's shader does.

use std::ops::Range;

use eframe::egui::Mesh;
use eframe::egui::epaint::Vertex;

use super::textures::Texture;

/// Corners are rounded to a grid of 1/256 px, as on most GPUs.
const PIXEL: i64 = 256;

/// Some columns of consecutive rows of the window, to be drawn on.
pub struct Strip<'a> {
    /// The pixels of the rows, in full width.
    pub pixels: &'a mut [[u8; 4]],
    /// Pixels in a row.
    pub width: usize,
    /// The columns that are drawn.
    pub columns: Range<i32>,
    /// The rows, from the top of the window.
    pub rows: Range<i32>,
}

impl Strip<'_> {
    /// Returns the pixels of one row.
    pub fn row(&mut self, row: i32, columns: Range<i32>) -> &mut [[u8; 4]] {
        let start = (row - self.rows.start) as usize * self.width;
        &mut self.pixels[start + columns.start as usize..start + columns.end as usize]
    }

    /// Draws the part of a mesh within a rectangle of pixels.
    pub fn draw(&mut self, mesh: &Mesh, texture: &Texture, px_per_point: f32, clip: &[Range<i32>; 2]) {
        let columns = self.columns.start.max(clip[0].start)..self.columns.end.min(clip[0].end);
        let rows = self.rows.start.max(clip[1].start)..self.rows.end.min(clip[1].end);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        for corners in mesh.indices.as_chunks::<3>().0 {
            let corners = corners.map(|index| &mesh.vertices[index as usize]);
            self.fill(corners, texture, px_per_point, &columns, &rows);
        }
    }

    fn fill(
        &mut self,
        corners: [&Vertex; 3],
        texture: &Texture,
        px_per_point: f32,
        columns: &Range<i32>,
        rows: &Range<i32>,
    ) {
        let [top, bottom] = extent(corners.map(|corner| corner.pos.y * px_per_point));
        let rows = rows.start.max(top)..rows.end.min(bottom);
        let [left, right] = extent(corners.map(|corner| corner.pos.x * px_per_point));
        let columns = columns.start.max(left)..columns.end.min(right);
        if rows.is_empty() || columns.is_empty() {
            return;
        }
        let Some(triangle) = Triangle::new(corners, px_per_point) else { return };
        let paint = Paint::new(corners, texture, &triangle);
        for row in rows {
            let span = triangle.span(row, &columns);
            if !span.is_empty() {
                paint.fill(self.row(row, span.clone()), span.start, row, texture);
            }
        }
    }
}

/// Returns the first pixel that can lie between these positions, and the one behind the last.
fn extent(px: [f32; 3]) -> [i32; 2] {
    let least = px[0].min(px[1]).min(px[2]);
    let largest = px[0].max(px[1]).max(px[2]);
    [least.floor() as i32, (largest.ceil() as i32).saturating_add(1)]
}

/// A triangle on the grid of corners, clockwise on the screen.
struct Triangle {
    corners: [[i64; 2]; 3],
    /// Twice the area in px².
    doubled_area_px: f32,
}

impl Triangle {
    /// `None` without an area.
    fn new(corners: [&Vertex; 3], px_per_point: f32) -> Option<Self> {
        const FAR: f32 = (1 << 20) as f32;
        let snapped = |c: f32| ((c * px_per_point).clamp(-FAR, FAR) * PIXEL as f32).round_ties_even() as i64;
        let [a, b, c] = corners.map(|corner| [snapped(corner.pos.x), snapped(corner.pos.y)]);
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let doubled_area_px = turn as f32 / (PIXEL * PIXEL) as f32;
        let corners = if turn < 0 { [a, c, b] } else { [a, b, c] };
        (turn != 0).then_some(Self { corners, doubled_area_px })
    }

    /// Returns the pixels of a row whose centres lie in the triangle. A centre on an edge belongs to the
    /// triangle to its right or below.
    fn span(&self, row: i32, columns: &Range<i32>) -> Range<i32> {
        let y = i64::from(row) * PIXEL + PIXEL / 2;
        let (mut start, mut end) = (i64::from(columns.start), i64::from(columns.end));
        for i in 0..3 {
            let ([px, py], [qx, qy]) = (self.corners[i], self.corners[(i + 1) % 3]);
            let (dx, dy) = (qx - px, qy - py);
            let owns_its_pixels = dy < 0 || (dy == 0 && dx > 0);
            // Inside where this is 0 or more, at the centre of column 0 and for each column.
            let at_zero = dx * (y - py) - dy * (PIXEL / 2 - px) - i64::from(!owns_its_pixels);
            let per_column = -dy * PIXEL;
            match per_column {
                0 if at_zero < 0 => return 0..0,
                0 => {}
                1.. => {
                    start = start.max(
                        (-at_zero).div_euclid(per_column) + i64::from((-at_zero).rem_euclid(per_column) != 0),
                    )
                }
                _ => end = end.min(at_zero.div_euclid(-per_column) + 1),
            }
        }
        start as i32..end.max(start) as i32
    }
}

/// A value that changes evenly over a triangle.
#[derive(Clone, Copy)]
struct Slope {
    at_origin: f32,
    per_column: f32,
    per_row: f32,
}

impl Slope {
    fn at(self, column: i32, row: i32) -> f32 {
        self.at_origin + self.per_column * column as f32 + self.per_row * row as f32
    }
}

/// The colours that fill the pixels of a triangle.
enum Paint {
    /// One colour, premultiplied, from 0 to 255.
    Plain([f32; 4]),
    /// A colour, and where in the texture it is taken from, at each pixel.
    Varying { color: [Slope; 4], place: [Slope; 2] },
}

impl Paint {
    fn new(corners: [&Vertex; 3], texture: &Texture, triangle: &Triangle) -> Self {
        let [a, b, c] = corners;
        if a.color == b.color && b.color == c.color && a.uv == b.uv && b.uv == c.uv {
            return Self::Plain(product(a.color.to_array().map(f32::from), texture.sample(a.uv.x, a.uv.y)));
        }
        let slope = |value: &dyn Fn(&Vertex) -> f32| triangle.slope(corners, value);
        Self::Varying {
            color: std::array::from_fn(|i| slope(&|corner| f32::from(corner.color.to_array()[i]))),
            place: [slope(&|corner| corner.uv.x), slope(&|corner| corner.uv.y)],
        }
    }

    /// Fills pixels of a row from a column on.
    fn fill(&self, pixels: &mut [[u8; 4]], first_column: i32, row: i32, texture: &Texture) {
        match self {
            Self::Plain([0.0, 0.0, 0.0, 0.0]) => {}
            Self::Plain(color) if color[3] >= 255.0 => pixels.fill(color.map(|c| (c + 0.5) as u8)),
            Self::Plain(color) => pixels.iter_mut().for_each(|pixel| blend(pixel, *color)),
            Self::Varying { color, place: [u, v] } => {
                for (column, pixel) in (first_column..).zip(pixels) {
                    let color = color.map(|slope| slope.at(column, row).clamp(0.0, 255.0));
                    let texel = texture.sample(u.at(column, row), v.at(column, row));
                    blend(pixel, product(color, texel));
                }
            }
        }
    }
}

impl Triangle {
    /// Returns a value at the centres of pixels from its values at the corners.
    fn slope(&self, corners: [&Vertex; 3], value: &dyn Fn(&Vertex) -> f32) -> Slope {
        let [f, g, h] = corners.map(value);
        // The corners of the triangle may have changed places.
        let is_swapped = self.doubled_area_px < 0.0;
        let [a, b, c] = self.corners;
        let (b, c) = if is_swapped { (c, b) } else { (b, c) };
        let px = |n: i64| n as f32 / PIXEL as f32;
        let [bx, by] = [px(b[0] - a[0]), px(b[1] - a[1])];
        let [cx, cy] = [px(c[0] - a[0]), px(c[1] - a[1])];
        let per_column = ((g - f) * cy - (h - f) * by) / self.doubled_area_px;
        let per_row = ((h - f) * bx - (g - f) * cx) / self.doubled_area_px;
        let at_origin = f + per_column * (0.5 - px(a[0])) + per_row * (0.5 - px(a[1]));
        Slope { at_origin, per_column, per_row }
    }
}

/// Returns the product of two colours from 0 to 255.
#[inline]
fn product(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|i| a[i] * b[i] * (1.0 / 255.0))
}

/// Draws a premultiplied colour from 0 to 255 over a pixel.
#[inline]
pub fn blend(pixel: &mut [u8; 4], color: [f32; 4]) {
    let left = 1.0 - color[3] * (1.0 / 255.0);
    *pixel = std::array::from_fn(|i| (color[i] + left * f32::from(pixel[i]) + 0.5) as u8);
}
