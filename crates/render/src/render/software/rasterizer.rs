//! Fills triangles pixel by pixel.

use std::ops::Range;

use glam::{DVec2, dvec2};

use super::painter::HalfPlane;
use crate::render::{HUGE_PX, SEAM_SLACK_PX};
use crate::scene::{LevelPaint, Style};

/// Corners are rounded to a grid of 1/256 px, as on most GPUs. Triangles that share a corner share it
/// exactly, and integer arithmetic decides which pixels a triangle covers.
const SUBPIXEL_BITS: u32 = 8;
const PIXEL: i32 = 1 << SUBPIXEL_BITS;
const HALF_PIXEL: i32 = PIXEL / 2;

/// Returns a pixel position rounded to the grid of corners. Positions beyond 4 million px are clamped; no
/// rasterized triangle with such a corner reaches the picture.
pub(super) fn snapped(px: DVec2) -> [i32; 2] {
    const FAR: f64 = (1 << 30) as f64;
    // The sum has no bits for a fraction and is rounded to an even number where that is half; its lowest bits
    // are the integer. This is several times as fast as rounding on processors without an instruction for it.
    const NO_FRACTION: f64 = 1.5 * (1_u64 << 52) as f64;
    [px.x, px.y].map(|c| ((c * f64::from(PIXEL)).clamp(-FAR, FAR) + NO_FRACTION).to_bits() as i32)
}

/// Returns columns and rows of the pixels that a triangle with these [`snapped`] corners can colour, and
/// `margin_px` more on every side.
pub(super) fn pixels_around(corners: &[[i32; 2]], margin_px: i32) -> [Range<i32>; 2] {
    [0, 1].map(|axis| {
        let along = corners.iter().map(|corner| corner[axis]);
        let low = along.clone().min().unwrap_or(0) >> SUBPIXEL_BITS;
        let high = along.max().unwrap_or(0) >> SUBPIXEL_BITS;
        // One more, since a huge triangle is drawn a little beyond its edges.
        low - 1 - margin_px..high + 2 + margin_px
    })
}

/// Returns whether a triangle with [`snapped`] corners extends over at least [`HUGE_PX`] along an axis.
#[inline]
pub(super) fn is_huge([a, b, c]: [[i32; 2]; 3]) -> bool {
    const HUGE: i64 = HUGE_PX as i64 * PIXEL as i64;
    let extent = |axis: usize| {
        let [a, b, c] = [a, b, c].map(|corner| i64::from(corner[axis]));
        a.max(b).max(c) - a.min(b).min(c)
    };
    extent(0) >= HUGE || extent(1) >= HUGE
}

/// Colours the pixels of the triangles of one level.
pub(super) struct LevelShader {
    fill: [u8; 4],
    fill_and_step: [[f32; 2]; 4],
    edge_alpha: f32,
    edge_reach_px: f32,
    rim_px: f32,
}

impl LevelShader {
    pub(super) fn new(paint: &LevelPaint, style: &Style) -> Self {
        let ([r, g, b], [edge_r, edge_g, edge_b]) = (paint.fill, paint.edge);
        let fill = [r, g, b, 1.0].map(|c| 255.0 * style.fill_opacity * c);
        let edge = [edge_r, edge_g, edge_b, 1.0].map(|c| 255.0 * c);
        Self {
            fill: fill.map(|c| c.round() as u8),
            fill_and_step: std::array::from_fn(|i| [fill[i], edge[i] - fill[i]]),
            edge_alpha: paint.edge_alpha,
            edge_reach_px: style.edge_reach_px(),
            rim_px: style.rim_px(),
        }
    }

    /// Returns the amounts to subtract from the distances to the three edges, so that boundary edges get
    /// their full width.
    #[inline]
    fn rims(&self, at_boundary: impl FnOnce() -> [bool; 3]) -> [f32; 3] {
        if self.edge_alpha == 0.0 {
            return [0.0; 3];
        }
        at_boundary().map(|boundary| if boundary { self.rim_px } else { 0.0 })
    }

    /// Returns the colour of a pixel whose centre is `distance_px` inside the nearest edge.
    #[inline]
    fn color(&self, distance_px: f32) -> [u8; 4] {
        let share = (self.edge_reach_px - distance_px).clamp(0.0, 1.0) * self.edge_alpha;
        if share == 0.0 {
            return self.fill;
        }
        self.fill_and_step.map(|[fill, step]| (fill + share * step + 0.5) as u8)
    }
}

/// Fills triangles in some columns of consecutive rows of a picture.
pub(super) struct Rasterizer<'a> {
    width: i32,
    columns: Range<i32>,
    rows: Range<i32>,
    /// The pixels of the rows, in full width.
    pixels: &'a mut [[u8; 4]],
}

/// The edge function of one edge of a snapped triangle. `value` at a pixel centre is positive inside; its
/// unit is 2⁻¹⁶ px².
#[derive(Clone, Copy)]
pub(super) struct EdgeFunction {
    pub(super) value: i64,
    pub(super) per_column: i64,
    pub(super) per_row: i64,
    /// 0 for edges that own the pixel centres on them, otherwise −1.
    pub(super) bias: i64,
    pub(super) px_per_unit: f32,
}

impl EdgeFunction {
    /// Returns the edge from `p` to `q` of a triangle that runs clockwise on the screen, at the pixel
    /// `column`, `row`.
    #[inline]
    pub(super) fn new(p: [i32; 2], q: [i32; 2], column: i32, row: i32) -> Self {
        let [dx, dy] = [i64::from(q[0]) - i64::from(p[0]), i64::from(q[1]) - i64::from(p[1])];
        let x = i64::from(column * PIXEL + HALF_PIXEL) - i64::from(p[0]);
        let y = i64::from(row * PIXEL + HALF_PIXEL) - i64::from(p[1]);
        // Top-left rule: a centre on a shared edge belongs to the triangle to its right or below.
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

impl<'a> Rasterizer<'a> {
    /// Creates a rasterizer for these columns of the rows from `first_row` on, whose `pixels` are given.
    pub(super) fn new(pixels: &'a mut [[u8; 4]], width: u32, columns: Range<u32>, first_row: usize) -> Self {
        let rows = first_row as i32..(first_row + pixels.len() / width as usize) as i32;
        let columns = columns.start as i32..columns.end as i32;
        Self { width: width as i32, columns, rows, pixels }
    }

    /// Gives all pixels of the columns one colour.
    pub(super) fn fill(&mut self, color: [u8; 4]) {
        for row in self.rows.clone() {
            self.pixels_of(row, self.columns.clone()).fill(color);
        }
    }

    fn pixels_of(&mut self, row: i32, columns: Range<i32>) -> &mut [[u8; 4]] {
        let start = (row - self.rows.start) * self.width;
        &mut self.pixels[(start + columns.start) as usize..(start + columns.end) as usize]
    }

    /// Fills the pixels whose centres lie in a triangle with [`snapped`] corners that is not [huge](is_huge).
    /// `at_boundary()[i]`: the edge opposite corner i is on the boundary.
    #[inline]
    pub(super) fn fill_snapped(
        &mut self,
        [a, b, c]: [[i32; 2]; 3],
        at_boundary: impl FnOnce() -> [bool; 3],
        shader: &LevelShader,
    ) {
        let columns = pixels_between(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]), &self.columns);
        let rows = pixels_between(a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]), &self.rows);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        // Run through the corners clockwise on the screen.
        let turn =
            i64::from(b[0] - a[0]) * i64::from(c[1] - a[1]) - i64::from(b[1] - a[1]) * i64::from(c[0] - a[0]);
        let [opposite_a, opposite_b, opposite_c] = shader.rims(at_boundary);
        let (b, c, rims) = if turn < 0 {
            (c, b, [opposite_b, opposite_a, opposite_c])
        } else {
            (b, c, [opposite_c, opposite_a, opposite_b])
        };
        let mut edges =
            [(a, b), (b, c), (c, a)].map(|(p, q)| EdgeFunction::new(p, q, columns.start, rows.start));
        for row in rows {
            fill_row(self.pixels_of(row, columns.clone()), edges, rims, shader);
            edges.iter_mut().for_each(|edge| edge.value += edge.per_row);
        }
    }

    /// Fills the pixels whose centres lie in all three half-planes.
    pub(super) fn fill_half_planes(
        &mut self,
        half_planes: &[HalfPlane; 3],
        at_boundary: impl FnOnce() -> [bool; 3],
        shader: &LevelShader,
    ) {
        let least = -f64::from(SEAM_SLACK_PX);
        let corner = |column, row| dvec2(f64::from(column), f64::from(row));
        let first = corner(self.columns.start, self.rows.start);
        let last = corner(self.columns.end, self.rows.end);
        for HalfPlane { normal, offset } in half_planes {
            // The distance of the corner of these pixels that lies deepest inside.
            let largest = normal.max(DVec2::ZERO).dot(last) + normal.min(DVec2::ZERO).dot(first) + offset;
            if largest < least {
                return;
            }
        }
        let rims = shader.rims(at_boundary);
        for row in self.rows.clone() {
            for column in self.columns.clone() {
                let px = dvec2(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let distances = half_planes.each_ref().map(|half_plane| half_plane.distance_px(px));
                if distances.iter().all(|&distance| distance >= least) {
                    let color = shader.color(nearest(distances.map(|d| d as f32), rims));
                    self.pixels_of(row, column..column + 1)[0] = color;
                }
            }
        }
    }
}

/// Returns the distance to the nearest edge after subtracting `rims`.
#[inline]
fn nearest(distances: [f32; 3], rims: [f32; 3]) -> f32 {
    (distances[0] - rims[0]).min(distances[1] - rims[1]).min(distances[2] - rims[2])
}

/// Returns the pixels within `limits` whose centres lie between `low` and `high`, which are in units of the
/// grid of corners.
#[inline]
pub(super) fn pixels_between(low: i32, high: i32, limits: &Range<i32>) -> Range<i32> {
    let first = (low - HALF_PIXEL + PIXEL - 1) >> SUBPIXEL_BITS;
    let last = (high - HALF_PIXEL) >> SUBPIXEL_BITS;
    first.max(limits.start)..(last + 1).min(limits.end)
}

#[inline]
fn fill_row(pixels: &mut [[u8; 4]], mut edges: [EdgeFunction; 3], rims: [f32; 3], shader: &LevelShader) {
    for pixel in pixels {
        let inside = edges.iter().all(|edge| edge.value + edge.bias >= 0);
        if inside {
            *pixel = if shader.edge_alpha == 0.0 {
                shader.fill
            } else {
                let distances = edges.map(|edge| edge.value as f32 * edge.px_per_unit);
                shader.color(nearest(distances, rims))
            };
        }
        edges.iter_mut().for_each(|edge| edge.value += edge.per_column);
    }
}
