//! Draws a surface in space, with a buffer of depths.

use std::ops::Range;

use glam::{DVec3, Vec3, dvec2};
use rayon::prelude::*;

use super::damage::BAND_ROWS;
use super::painter::{TriangleArrays, ground};
use super::rasterizer::{self, EdgeFunction, pixels_between, snapped};
use super::threads::on_drawing_threads;
use crate::colormap::LEVELS;
use crate::render::Image;
use crate::render::SEAM_SLACK_PX;
use crate::render::draw_flags::DrawFlags;
use crate::scene::{Light, NO_HEIGHT, NodeHeights, ShownSurface, SpaceCamera, SpacePaint, SpaceView, Style};
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Extract, Triangle};

/// Triangles in a group: they are near each other in the picture, and bands of rows that a group does not
/// reach pass it over.
const GROUP: usize = 64;
/// Nodes that a thread maps at a time.
const NODES_PER_TASK: usize = 8192;

/// Draws the extract of a mesh in space, for files. `heights` are those of its nodes.
pub fn draw_extract_in_space(
    extract: &Extract,
    heights: &NodeHeights,
    view: &SpaceView,
    style: &Style,
) -> Image {
    let none = DrawFlags::default();
    let (nodes, triangles) = (extract.nodes(), extract.triangles());
    draw_parts(&[SurfacePart { nodes, triangles, heights: &heights.mesh, flags: &none }], view, style)
}

/// Draws a mesh in space with its pieces. All triangles of which each corner has a height are drawn.
///
/// The time is proportional to the mesh and to the pixels, and shared by all cores.
pub fn draw_surface(shown: ShownSurface, view: &SpaceView, style: &Style) -> Image {
    let ShownSurface { mesh, pieces, heights } = shown;
    let none = DrawFlags::default();
    let flags = pieces.map(|pieces| DrawFlags::from_pieces(pieces, mesh.raw_triangle_count()));
    let (nodes, triangles) = (mesh.raw_nodes(), mesh.raw_triangles());
    let mut parts = vec![SurfacePart {
        nodes,
        triangles,
        heights: &heights.mesh,
        flags: flags.as_ref().unwrap_or(&none),
    }];
    if let Some(pieces) = pieces {
        let (nodes, triangles) = (pieces.nodes(), pieces.triangles());
        parts.push(SurfacePart { nodes, triangles, heights: &heights.pieces, flags: &none });
    }
    draw_parts(&parts, view, style)
}

/// Triangles with the heights of their nodes.
struct SurfacePart<'a> {
    nodes: &'a [LatticePoint],
    triangles: &'a [Triangle],
    heights: &'a [u32],
    flags: &'a DrawFlags,
}

/// A part as one camera sees it.
struct Placed<'a> {
    part: &'a SurfacePart<'a>,
    /// For each node its place in pixels and towards the viewer; NaN without a height.
    corners: Vec<DVec3>,
    /// For each group its rows, from the first to behind the last.
    rows: Vec<Range<i32>>,
}

fn draw_parts(parts: &[SurfacePart], view: &SpaceView, style: &Style) -> Image {
    let size = view.camera.size_px();
    let mut image = Image::filled(size, ground(style));
    on_drawing_threads(|| {
        let placed: Vec<_> = parts.iter().map(|part| Placed::new(part, &view.camera)).collect();
        let shader = SpaceShader::new(view, style);
        let width = size[0] as usize;
        let bands = image.pixels_mut().par_chunks_mut(width * BAND_ROWS).with_max_len(1).enumerate();
        bands.for_each(|(band, pixels)| {
            let first = (band * BAND_ROWS) as i32;
            let rows = first..first + (pixels.len() / width) as i32;
            let depths = vec![f32::NEG_INFINITY; pixels.len()];
            let mut band = Band { width: width as i32, rows, pixels, depths };
            placed.iter().for_each(|placed| placed.draw(&mut band, &shader));
        });
    });
    image
}

impl<'a> Placed<'a> {
    fn new(part: &'a SurfacePart<'a>, camera: &SpaceCamera) -> Self {
        let screen = camera.screen_map();
        let heights = part.heights.par_iter().chain(rayon::iter::repeat_n(&NO_HEIGHT, part.nodes.len()));
        let heights = heights.take(part.nodes.len());
        let nodes = part.nodes.par_iter().with_min_len(NODES_PER_TASK);
        let corners: Vec<DVec3> = nodes
            .zip(heights)
            .map(|(node, &steps)| match steps {
                NO_HEIGHT => DVec3::NAN,
                steps => screen(node.as_dvec2(), f64::from(steps)),
            })
            .collect();
        let groups = part.triangles.par_chunks(GROUP).with_min_len(GROUP);
        let rows = groups.map(|group| rows_of(group, &corners)).collect();
        Self { part, corners, rows }
    }

    fn draw(&self, band: &mut Band, shader: &SpaceShader) {
        let SurfacePart { triangles, flags, .. } = *self.part;
        for (group, rows) in self.rows.iter().enumerate() {
            if rows.start >= band.rows.end || rows.end <= band.rows.start {
                continue;
            }
            let first = group * GROUP;
            let group = &triangles[first..triangles.len().min(first + GROUP)];
            for (index, triangle) in (first..).zip(group) {
                if triangle.is_outside() || !flags.is_drawn(index) {
                    continue;
                }
                let corners = triangle.vertices.map(|vertex| self.corners[vertex.index()]);
                if corners.iter().any(|corner| corner.is_nan()) {
                    continue;
                }
                let drawn = DrawnTriangle { triangle, corners, part: self.part };
                band.draw(&drawn, shader);
            }
        }
    }
}

/// Returns the rows that a group of triangles can colour.
fn rows_of(group: &[Triangle], corners: &[DVec3]) -> Range<i32> {
    let inside = group.iter().filter(|triangle| !triangle.is_outside());
    let ys = inside.flat_map(|triangle| triangle.vertices).map(|vertex| corners[vertex.index()].y);
    let [low, high] = ys.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
    // One more, since a huge triangle is drawn a little beyond its edges. Far numbers become the farthest.
    if low > high { 0..0 } else { (low - 1.0).floor() as i32..(high + 2.0).ceil() as i32 }
}

struct DrawnTriangle<'a> {
    triangle: &'a Triangle,
    corners: [DVec3; 3],
    part: &'a SurfacePart<'a>,
}

impl DrawnTriangle<'_> {
    /// Returns the steps along each axis from one corner to another, which are exact.
    fn steps(&self, from: usize, to: usize) -> DVec3 {
        let [from, to] = [from, to].map(|corner| self.triangle.vertices[corner].index());
        let height = |node: usize| f64::from(self.part.heights[node]);
        let plane = self.part.nodes[to].as_dvec2() - self.part.nodes[from].as_dvec2();
        plane.extend(height(to) - height(from))
    }
}

impl DrawnTriangle<'_> {
    /// Returns its colours.
    fn shade(&self, shader: &SpaceShader) -> Shade {
        let edges = [self.steps(0, 1), self.steps(0, 2), self.steps(1, 2)];
        let [right, up, _] = shader.rows;
        let in_px = edges.map(|edge| dvec2(right.dot(edge), up.dot(edge)));
        let longest = in_px.iter().map(|edge| edge.length_squared()).fold(0.0, f64::max).sqrt();
        let least_px = in_px[0].perp_dot(in_px[1]).abs() / longest;
        let paint = &shader.paints[self.triangle.level() as usize];
        let brightness = shader.brightness([edges[0], edges[1]]);
        let lit = |color: [f32; 3]| color.map(|channel| (channel * brightness).min(1.0));
        let alpha = paint.alpha_at(least_px as f32, shader.style);
        let rims = if alpha > 0.0 {
            let boundary = TriangleArrays::boundary_in(self.part.triangles, self.part.flags, self.triangle);
            boundary.map(|boundary| if boundary { shader.style.rim_px() } else { 0.0 })
        } else {
            [0.0; 3]
        };
        let reach_px = shader.style.edge_reach_px();
        Shade { fill: lit(paint.fill), edge: lit(paint.edge), alpha, reach_px, rims }
    }
}

/// What colours the triangles of a picture.
struct SpaceShader<'a> {
    style: &'a Style,
    paints: [SpacePaint; LEVELS],
    shape: DVec3,
    light: Vec3,
    strength: f32,
    to_viewer: Vec3,
    rows: [DVec3; 3],
}

impl<'a> SpaceShader<'a> {
    fn new(view: &SpaceView, style: &'a Style) -> Self {
        let camera = &view.camera;
        Self {
            style,
            paints: SpacePaint::all(style),
            shape: camera.shape(),
            light: view.light.direction().as_vec3(),
            strength: view.light.strength(),
            to_viewer: camera.to_viewer().as_vec3(),
            rows: camera.rows(),
        }
    }

    /// Returns the brightness of a triangle between two edges, in steps: 1 where it is level.
    fn brightness(&self, [a, b]: [DVec3; 2]) -> f32 {
        let normal = (a * self.shape).cross(b * self.shape).normalize_or(DVec3::Z).as_vec3();
        let up = if normal.z < 0.0 { -normal } else { normal };
        // From below, only the light from everywhere reaches the viewer.
        let lit = if up.dot(self.to_viewer) < 0.0 { 0.0 } else { up.dot(self.light).max(0.0) };
        Light::AMBIENT + self.strength * lit
    }
}

/// The colours of one triangle.
#[derive(Clone, Copy)]
struct Shade {
    fill: [f32; 3],
    edge: [f32; 3],
    alpha: f32,
    reach_px: f32,
    /// Subtracted from the distances to the edges opposite each corner, so that boundary edges get their full
    /// width.
    rims: [f32; 3],
}

impl Shade {
    /// Returns the colour of a pixel at these distances from the edges opposite each corner, in pixels.
    #[inline]
    fn color(&self, distances_px: [f32; 3]) -> [u8; 4] {
        let nearest = |i: usize| distances_px[i] - self.rims[i];
        let distance_px = nearest(0).min(nearest(1)).min(nearest(2));
        let share = (self.reach_px - distance_px).clamp(0.0, 1.0) * self.alpha;
        let channel = |i: usize| (255.0 * (self.fill[i] + share * (self.edge[i] - self.fill[i])) + 0.5) as u8;
        [channel(0), channel(1), channel(2), 0xff]
    }
}

/// A plane through a triangle: how near the viewer a pixel position is.
#[derive(Clone, Copy)]
struct DepthPlane {
    at: DVec3,
    per_column: f64,
    per_row: f64,
}

impl DepthPlane {
    /// Returns `None` for a triangle that is seen from its edge.
    fn through([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let (to_b, to_c) = (b - a, c - a);
        let area = to_b.truncate().perp_dot(to_c.truncate());
        let per_column = (to_b.z * to_c.y - to_c.z * to_b.y) / area;
        let per_row = (to_b.x * to_c.z - to_c.x * to_b.z) / area;
        (per_column.is_finite() && per_row.is_finite()).then_some(Self { at: a, per_column, per_row })
    }

    #[inline]
    fn depth(&self, x: f64, y: f64) -> f64 {
        self.at.z + self.per_column * (x - self.at.x) + self.per_row * (y - self.at.y)
    }
}

/// Some rows of a picture, with the depth of each pixel.
struct Band<'a> {
    width: i32,
    rows: Range<i32>,
    pixels: &'a mut [[u8; 4]],
    depths: Vec<f32>,
}

impl Band<'_> {
    fn draw(&mut self, drawn: &DrawnTriangle, shader: &SpaceShader) {
        let corners = drawn.corners.map(|corner| snapped(corner.truncate()));
        let across = |axis: usize| {
            let along = corners.map(|corner| corner[axis]);
            [along[0].min(along[1]).min(along[2]), along[0].max(along[1]).max(along[2])]
        };
        let ([left, right], [top, bottom]) = (across(0), across(1));
        let columns = pixels_between(left, right, &(0..self.width));
        let rows = pixels_between(top, bottom, &self.rows);
        let is_huge = rasterizer::is_huge(corners);
        if !is_huge && (columns.is_empty() || rows.is_empty()) {
            return;
        }
        let Some(plane) = DepthPlane::through(drawn.corners) else { return };
        // Most small triangles have no pixel, or are hidden: those need no colour.
        let mut known = None;
        let mut shade = move || *known.get_or_insert_with(|| drawn.shade(shader));
        if is_huge {
            self.fill_huge(drawn.corners, &plane, &mut shade);
        } else {
            self.fill(corners, [columns, rows], &plane, &mut shade);
        }
    }

    /// Fills the pixels whose centres lie in a triangle with snapped corners, where nothing is before them.
    fn fill(
        &mut self,
        [a, b, c]: [[i32; 2]; 3],
        [columns, rows]: [Range<i32>; 2],
        plane: &DepthPlane,
        shade: &mut dyn FnMut() -> Shade,
    ) {
        let turn =
            i64::from(b[0] - a[0]) * i64::from(c[1] - a[1]) - i64::from(b[1] - a[1]) * i64::from(c[0] - a[0]);
        // Clockwise on the screen; `own` says which edge is opposite each corner.
        let (b, c, own) = if turn < 0 { (c, b, [1, 0, 2]) } else { (b, c, [1, 2, 0]) };
        let mut starts =
            [(a, b), (b, c), (c, a)].map(|(p, q)| EdgeFunction::new(p, q, columns.start, rows.start));
        for row in rows {
            let mut edges = starts;
            let mut depth = plane.depth(f64::from(columns.start) + 0.5, f64::from(row) + 0.5);
            for column in columns.clone() {
                if edges.iter().all(|edge| edge.value + edge.bias >= 0)
                    && let Some(pixel) = self.pixel_before(column, row, depth as f32)
                {
                    *pixel = shade().color(own.map(|i| edges[i].value as f32 * edges[i].px_per_unit));
                }
                edges.iter_mut().for_each(|edge| edge.value += edge.per_column);
                depth += plane.per_column;
            }
            starts.iter_mut().for_each(|edge| edge.value += edge.per_row);
        }
    }

    /// Fills the pixels of a triangle whose corners are far away, from the lines through its edges.
    fn fill_huge(&mut self, corners: [DVec3; 3], plane: &DepthPlane, shade: &mut dyn FnMut() -> Shade) {
        let lines: [_; 3] = std::array::from_fn(|i| {
            let [own, from, to] = [i, (i + 1) % 3, (i + 2) % 3].map(|corner| corners[corner].truncate());
            let along = (to - from).normalize_or_zero();
            let normal = if along.perp_dot(own - from) < 0.0 { -along.perp() } else { along.perp() };
            (normal, -normal.dot(from))
        });
        let least = -f64::from(SEAM_SLACK_PX);
        for row in self.rows.clone() {
            for column in 0..self.width {
                let at = dvec2(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let inside = lines.map(|(normal, offset)| normal.dot(at) + offset);
                if inside.iter().all(|&distance| distance >= least)
                    && let Some(pixel) = self.pixel_before(column, row, plane.depth(at.x, at.y) as f32)
                {
                    *pixel = shade().color(inside.map(|distance| distance as f32));
                }
            }
        }
    }

    /// Returns a pixel, if what it shows is behind a depth, which becomes its own.
    #[inline]
    fn pixel_before(&mut self, column: i32, row: i32, depth: f32) -> Option<&mut [u8; 4]> {
        let place = ((row - self.rows.start) * self.width + column) as usize;
        let is_before = depth > self.depths[place];
        is_before.then(|| {
            self.depths[place] = depth;
            &mut self.pixels[place]
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    #[test]
    fn a_huge_triangle_fills_the_pixels_whose_centres_it_has() {
        const SIDE: i32 = 8;
        let shade = Shade { fill: [1.0; 3], edge: [1.0; 3], alpha: 0.0, reach_px: 0.0, rims: [0.0; 3] };
        let far = 1e6;
        let filled = |corners: [DVec3; 3]| {
            let mut pixels = vec![[0; 4]; (SIDE * SIDE) as usize];
            let depths = vec![f32::NEG_INFINITY; pixels.len()];
            let mut band = Band { width: SIDE, rows: 0..SIDE, pixels: &mut pixels, depths };
            let plane = DepthPlane::through(corners).expect("it is seen from its face");
            band.fill_huge(corners, &plane, &mut || shade);
            let is_filled = |&place: &i32| pixels[place as usize] != [0; 4];
            let places: Vec<i32> = (0..SIDE * SIDE).filter(is_filled).collect();
            [places.iter().map(|place| place % SIDE).max(), places.iter().map(|place| place / SIDE).max()]
        };
        // The edge on the right, then that below, lies before, in or behind the centres of a column or row.
        for (edge, last) in [(3.4, 2), (3.5, 3), (3.6, 3), (4.4, 3), (4.6, 4)] {
            let left = [dvec3(edge, -far, 0.0), dvec3(edge, far, 0.0), dvec3(-far, 0.0, 0.0)];
            assert_eq!(filled(left), [Some(last), Some(SIDE - 1)], "left of x = {edge}");
            let above = left.map(|corner| dvec3(corner.y, corner.x, 0.0));
            assert_eq!(filled(above), [Some(SIDE - 1), Some(last)], "above y = {edge}");
        }
    }
}
