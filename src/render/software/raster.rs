use glam::{DVec2, dvec2};

use super::Line;
use crate::render::{Image, SEAM_SLACK_PX};
use crate::scene::{LevelPaint, Style};

/// Corners lie on a grid of 1 / 2⁸ px, as on most GPUs: shared corners are shared exactly, and integers decide.
const SUBPIXEL_BITS: u32 = 8;
const PIXEL: i32 = 1 << SUBPIXEL_BITS;
const HALF_PIXEL: i32 = PIXEL / 2;

/// A pixel position on the grid of corners. Positions beyond 4 million px, of which no rasterised triangle reaches the
/// canvas, stay there.
pub(super) fn snapped(px: DVec2) -> [i32; 2] {
    const FAR: f64 = (1 << 30) as f64;
    // Clamped, so that the cast is exact.
    [px.x, px.y].map(|c| (c * f64::from(PIXEL)).round_ties_even().clamp(-FAR, FAR) as i32)
}

/// The colours of one level, ready for pixels.
pub(super) struct Brush {
    fill: [u8; 4],
    fill_and_step: [[f32; 2]; 3],
    edge_alpha: f32,
    edge_reach_px: f32,
    rim_px: f32,
}

impl Brush {
    pub(super) fn new(paint: &LevelPaint, style: &Style) -> Self {
        let fill_and_step = std::array::from_fn(|i| {
            let fill = 255.0 * paint.fill[i];
            [fill, 255.0 * paint.edge[i] - fill]
        });
        let [r, g, b] = paint.fill.map(|c| (255.0 * c).round() as u8);
        Self {
            fill: [r, g, b, 0xff],
            fill_and_step,
            edge_alpha: paint.edge_alpha,
            edge_reach_px: style.edge_reach_px(),
            rim_px: style.rim_px(),
        }
    }

    /// What to take from the distances to the three edges, so that those at the boundary are drawn whole.
    #[inline]
    fn rims(&self, at_boundary: [bool; 3]) -> [f32; 3] {
        at_boundary.map(|boundary| if boundary { self.rim_px } else { 0.0 })
    }

    /// The colour of a pixel whose centre is `distance_px` inside the nearest edge.
    #[inline]
    fn color(&self, distance_px: f32) -> [u8; 4] {
        let share = (self.edge_reach_px - distance_px).clamp(0.0, 1.0) * self.edge_alpha;
        if share == 0.0 {
            return self.fill;
        }
        let [r, g, b] = self.fill_and_step.map(|[fill, step]| (fill + share * step + 0.5) as u8);
        [r, g, b, 0xff]
    }
}

/// The pixels of a picture, to fill triangles in.
pub(super) struct Canvas<'a> {
    width: i32,
    height: i32,
    pixels: &'a mut [[u8; 4]],
}

/// One edge of a snapped triangle: `value` at a pixel centre is positive inside, in units of 1 / 2¹⁶ px².
#[derive(Clone, Copy)]
struct EdgeFunction {
    value: i64,
    per_column: i64,
    per_row: i64,
    /// 0 for edges that own the pixels on them, else −1.
    bias: i64,
    px_per_unit: f32,
}

impl EdgeFunction {
    /// The edge from `p` to `q` of a triangle that runs clockwise on the screen, at the pixel `column`, `row`.
    #[inline]
    fn new(p: [i32; 2], q: [i32; 2], column: i32, row: i32) -> Self {
        let [dx, dy] = [i64::from(q[0]) - i64::from(p[0]), i64::from(q[1]) - i64::from(p[1])];
        let x = i64::from(column * PIXEL + HALF_PIXEL) - i64::from(p[0]);
        let y = i64::from(row * PIXEL + HALF_PIXEL) - i64::from(p[1]);
        // A centre on a common edge belongs to the triangle to the right of it or below.
        let owns_its_pixels = dy < 0 || (dy == 0 && dx > 0);
        Self {
            value: dx * y - dy * x,
            per_column: -dy * i64::from(PIXEL),
            per_row: dx * i64::from(PIXEL),
            bias: if owns_its_pixels { 0 } else { -1 },
            px_per_unit: 1.0 / (((dx * dx + dy * dy) as f32).sqrt() * PIXEL as f32),
        }
    }
}

impl<'a> Canvas<'a> {
    pub(super) fn of(image: &'a mut Image) -> Self {
        let [width, height] = image.size.map(|n| n as i32);
        Self { width, height, pixels: image.pixels_mut() }
    }

    /// Fills the pixels whose centres lie in a triangle of less than 2¹⁴ px, given by [`snapped`] corners. The edges opposite to
    /// some of them may be `at_boundary`.
    #[inline]
    pub(super) fn fill_snapped(&mut self, [a, b, c]: [[i32; 2]; 3], at_boundary: [bool; 3], brush: &Brush) {
        let columns = pixels_between(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]), self.width);
        let rows = pixels_between(a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]), self.height);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let turn =
            i64::from(b[0] - a[0]) * i64::from(c[1] - a[1]) - i64::from(b[1] - a[1]) * i64::from(c[0] - a[0]);
        let [opposite_a, opposite_b, opposite_c] = brush.rims(at_boundary);
        let (b, c, rims) = if turn < 0 {
            (c, b, [opposite_b, opposite_a, opposite_c])
        } else {
            (b, c, [opposite_c, opposite_a, opposite_b])
        };
        let mut edges =
            [(a, b), (b, c), (c, a)].map(|(p, q)| EdgeFunction::new(p, q, columns.start, rows.start));
        for row in rows {
            let start = (row * self.width) as usize;
            let line = &mut self.pixels[start..start + self.width as usize];
            fill_row(&mut line[columns.start as usize..columns.end as usize], edges, rims, brush);
            edges.iter_mut().for_each(|edge| edge.value += edge.per_row);
        }
    }

    /// Fills the pixels whose centres lie on the positive side of three lines.
    pub(super) fn fill_by_lines(&mut self, lines: &[Line; 3], at_boundary: [bool; 3], brush: &Brush) {
        let rims = brush.rims(at_boundary);
        let least = -f64::from(SEAM_SLACK_PX);
        let corner = dvec2(f64::from(self.width), f64::from(self.height));
        for line in lines {
            let nearest_corner = line.normal.max(DVec2::ZERO).dot(corner) + line.offset;
            if nearest_corner < least {
                return;
            }
        }
        for row in 0..self.height {
            for column in 0..self.width {
                let px = dvec2(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let distances = lines.each_ref().map(|l| l.normal.dot(px) + l.offset);
                if distances.iter().all(|&distance| distance >= least) {
                    let color = brush.color(nearest(distances.map(|d| d as f32), rims));
                    self.pixels[(row * self.width + column) as usize] = color;
                }
            }
        }
    }
}

/// The distance to the nearest edge, after `rims` are taken away.
#[inline]
fn nearest(distances: [f32; 3], rims: [f32; 3]) -> f32 {
    (distances[0] - rims[0]).min(distances[1] - rims[1]).min(distances[2] - rims[2])
}

/// The pixels below `limit` whose centres lie from `low` to `high`, both on the grid of corners.
#[inline]
fn pixels_between(low: i32, high: i32, limit: i32) -> std::ops::Range<i32> {
    let first = (low - HALF_PIXEL + PIXEL - 1) >> SUBPIXEL_BITS;
    let last = (high - HALF_PIXEL) >> SUBPIXEL_BITS;
    first.max(0)..(last + 1).min(limit)
}

#[inline]
fn fill_row(pixels: &mut [[u8; 4]], mut edges: [EdgeFunction; 3], rims: [f32; 3], brush: &Brush) {
    for pixel in pixels {
        let inside = edges.iter().all(|edge| edge.value + edge.bias >= 0);
        if inside {
            *pixel = if brush.edge_alpha == 0.0 {
                brush.fill
            } else {
                let distances = edges.map(|edge| edge.value as f32 * edge.px_per_unit);
                brush.color(nearest(distances, rims))
            };
        }
        edges.iter_mut().for_each(|edge| edge.value += edge.per_column);
    }
}
