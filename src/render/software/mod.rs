//! The renderer that needs no graphics driver. It draws pictures for the command line and is the reference
//! for the GPU.

mod rasterizer;

use glam::{DVec2, I64Vec2, Vec2, Vec2Swizzles};

use self::rasterizer::{LevelShader, Rasterizer};
use super::Image;
use super::draw_flags::DrawFlags;
use crate::colormap::LEVELS;
use crate::geometry::LatticePoint;
use crate::mesh::{Extract, Orientation, Triangle};
use crate::scene::{Camera, LevelPaint, Outline, Overlay, ShownMesh, Style};

/// Draws a mesh as `camera` sees it, the overlay above it, and outlines on top.
///
/// Outlines come from [`highlight_outlines`](crate::scene::highlight_outlines). The time is proportional to
/// the mesh and to the pixels: about 50 ns per triangle.
pub fn draw<'a>(
    shown: impl Into<ShownMesh<'a>>,
    camera: &Camera,
    style: &Style,
    overlay: Option<&Overlay>,
    outlines: &[Outline],
) -> Image {
    let ShownMesh { mesh, pieces } = shown.into();
    let flags = pieces.map(|pieces| DrawFlags::of_pieces(pieces, mesh.raw_triangle_count()));
    let mut image = ground(camera, style);
    let mut painter = Painter::new(&mut image, camera.on_lattice(mesh.lattice()), style);
    painter.draw(&TriangleArrays {
        nodes: mesh.raw_nodes(),
        triangles: mesh.raw_triangles(),
        flags: flags.unwrap_or_default(),
    });
    if let Some(pieces) = pieces {
        painter.draw(&TriangleArrays::new(pieces.nodes(), pieces.triangles()));
    }
    if let Some(overlay) = overlay {
        blend_overlay(&mut image, camera, overlay);
    }
    draw_outlines(&mut image, outlines);
    image
}

/// Draws what files get of a mesh.
pub fn draw_extract(extract: &Extract, camera: &Camera, style: &Style) -> Image {
    let mut image = ground(camera, style);
    Painter::new(&mut image, camera.on_lattice(extract.lattice()), style)
        .draw(&TriangleArrays::new(extract.nodes(), extract.triangles()));
    image
}

fn ground(camera: &Camera, style: &Style) -> Image {
    Image::filled(camera.size_px(), style.clear_color().map(|c| (255.0 * c).round() as u8))
}

/// Triangles and their nodes. A neighbour that is one of `triangles` shares an edge.
struct TriangleArrays<'a> {
    nodes: &'a [LatticePoint],
    triangles: &'a [Triangle],
    /// The triangles that are replaced by others.
    flags: DrawFlags,
}

impl<'a> TriangleArrays<'a> {
    fn new(nodes: &'a [LatticePoint], triangles: &'a [Triangle]) -> Self {
        Self { nodes, triangles, flags: DrawFlags::default() }
    }

    /// For each vertex whether the opposite edge is on the boundary: nothing is drawn across it.
    fn boundary_opposite(&self, triangle: &Triangle) -> [bool; 3] {
        let mut boundary = [false; 3];
        for ((from, to), across) in triangle.edges().into_iter().zip(triangle.raw_neighbours) {
            boundary[3 - from - to] = across.triangle().is_none_or(|id| self.is_vacant(id.index()));
        }
        boundary
    }

    fn is_vacant(&self, index: usize) -> bool {
        self.flags.is_vacant(index) || self.flags.is_drawn(index) && self.triangles[index].is_outside()
    }
}

/// Draws triangles as one camera sees them, in one style.
struct Painter<'a> {
    rasterizer: Rasterizer<'a>,
    camera: Camera,
    shaders: [LevelShader; LEVELS],
}

impl<'a> Painter<'a> {
    fn new(image: &'a mut Image, camera: Camera, style: &Style) -> Self {
        let shaders = LevelPaint::all(&camera, style).map(|paint| LevelShader::new(&paint, style));
        Self { rasterizer: Rasterizer::new(image), camera, shaders }
    }

    fn draw(&mut self, arrays: &TriangleArrays) {
        let snap = |&p: &LatticePoint| rasterizer::snapped(self.camera.screen_from_lattice(p));
        let snapped: Vec<[i32; 2]> = arrays.nodes.iter().map(snap).collect();
        for (index, triangle) in arrays.triangles.iter().enumerate() {
            if triangle.is_outside() || !arrays.flags.is_drawn(index) {
                continue;
            }
            let shader = &self.shaders[triangle.level() as usize];
            let at_boundary = || arrays.boundary_opposite(triangle);
            let corners = triangle.vertices.map(|v| snapped[v.index()]);
            if rasterizer::is_huge(corners) {
                let half_planes = half_planes(triangle, arrays.nodes, &self.camera);
                self.rasterizer.fill_half_planes(&half_planes, at_boundary, shader);
            } else {
                self.rasterizer.fill_snapped(corners, at_boundary, shader);
            }
        }
    }
}

/// One side of a line. The signed distance of the pixel position p from the line is `normal · p + offset` in
/// pixels, with |normal| = 1; it is positive inside.
pub(super) struct HalfPlane {
    normal: DVec2,
    offset: f64,
}

impl HalfPlane {
    #[inline]
    fn distance_px(&self, px: DVec2) -> f64 {
        self.normal.dot(px) + self.offset
    }

    /// The half-plane to the left of the line from one node to another.
    ///
    /// The part of the cross product that consists of lattice coordinates is calculated in integers. They
    /// have 30 bits, so the sum of two products has 61. The remainder, of the camera's place within a lattice
    /// step, is as large as the length of the edge at most, so its rounding errors are below 2⁻⁵⁰ steps.
    fn left_of(from: LatticePoint, to: LatticePoint, camera: &Camera) -> Self {
        let steps = |p: LatticePoint| I64Vec2::new(i64::from(p.x), i64::from(p.y));
        let (anchor, fraction) = camera.anchor();
        let along = steps(to) - steps(from);
        let to_anchor = anchor.as_i64vec2() - steps(from);
        let whole = along.perp_dot(to_anchor);
        let cross = whole as f64 + along.as_dvec2().perp_dot(fraction);
        let scale = camera.px_per_step();
        let along_px = along.as_dvec2() * scale;
        let length_px = along_px.length();
        // The y axis points up on the lattice and down on the screen.
        let normal = -along_px.yx() / length_px;
        let at_middle = cross * scale.element_product() / length_px;
        Self { normal, offset: at_middle - normal.dot(camera.half_size_px()) }
    }
}

/// The half-planes that intersect in a triangle. Each is that of the edge opposite the vertex.
fn half_planes(triangle: &Triangle, nodes: &[LatticePoint], camera: &Camera) -> [HalfPlane; 3] {
    let corners = triangle.vertices.map(|v| nodes[v.index()]);
    std::array::from_fn(|i| {
        let [from, to] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
        match triangle.orientation() {
            Orientation::Anticlockwise => HalfPlane::left_of(from, to, camera),
            Orientation::Clockwise => HalfPlane::left_of(to, from, camera),
        }
    })
}

fn blend_overlay(image: &mut Image, camera: &Camera, overlay: &Overlay) {
    let map = overlay.texels(camera);
    let half = camera.half_size_px();
    let [width, height] = camera.size_px();
    let columns: Vec<Option<usize>> = (0..width)
        .map(|x| map.at_center.x + (f64::from(x) + 0.5 - half.x) * map.per_px.x)
        .map(|texel| index_below(texel, overlay.columns))
        .collect();
    let pixels = image.pixels_mut();
    for y in 0..height {
        let texel = map.at_center.y + (half.y - f64::from(y) - 0.5) * map.per_px.y;
        let Some(row) = index_below(texel, overlay.rows) else { continue };
        let colors = &overlay.rgba[row * overlay.columns as usize..];
        let pixel_row = &mut pixels[(y * width) as usize..][..width as usize];
        for (pixel, column) in pixel_row.iter_mut().zip(&columns) {
            if let &Some(column) = column {
                *pixel = blended(*pixel, colors[column], overlay.opacity);
            }
        }
    }
}

fn index_below(texel: f64, count: u32) -> Option<usize> {
    (texel >= 0.0 && texel < f64::from(count)).then_some(texel as usize)
}

fn blended(below: [u8; 4], [r, g, b, a]: [u8; 4], opacity: f32) -> [u8; 4] {
    let share = f32::from(a) / 255.0 * opacity;
    let mix = |from: u8, to: u8| (f32::from(from) + share * (f32::from(to) - f32::from(from))).round() as u8;
    [mix(below[0], r), mix(below[1], g), mix(below[2], b), 0xff]
}

/// Draws a line through points in pixels over an opaque picture.
pub fn draw_line(image: &mut Image, points: &[Vec2], [r, g, b]: [u8; 3], width_px: f32) {
    let [width, height] = image.size;
    let Some(mut pixmap) = tiny_skia::PixmapMut::from_bytes(&mut image.rgba, width, height) else { return };
    let mut line = tiny_skia::PathBuilder::new();
    let Some((first, rest)) = points.split_first() else { return };
    line.move_to(first.x, first.y);
    rest.iter().for_each(|p| line.line_to(p.x, p.y));
    let Some(path) = line.finish() else { return };
    let stroke = tiny_skia::Stroke {
        width: width_px,
        line_join: tiny_skia::LineJoin::Round,
        line_cap: tiny_skia::LineCap::Round,
        ..tiny_skia::Stroke::default()
    };
    pixmap.stroke_path(&path, &paint([r, g, b, 0xff]), &stroke, tiny_skia::Transform::identity(), None);
}

fn draw_outlines(image: &mut Image, outlines: &[Outline]) {
    let [width, height] = image.size;
    // In an opaque picture, premultiplied and plain colours are the same.
    let Some(mut pixmap) = tiny_skia::PixmapMut::from_bytes(&mut image.rgba, width, height) else { return };
    for outline in outlines {
        let Some(path) = closed_path(&outline.polygon) else { continue };
        let identity = tiny_skia::Transform::identity();
        pixmap.fill_path(&path, &paint(outline.fill), tiny_skia::FillRule::Winding, identity, None);
        let line = tiny_skia::Stroke {
            width: outline.line_width_px,
            line_join: tiny_skia::LineJoin::Round,
            ..tiny_skia::Stroke::default()
        };
        pixmap.stroke_path(&path, &paint(outline.line), &line, identity, None);
    }
}

fn closed_path(polygon: &[[f32; 2]]) -> Option<tiny_skia::Path> {
    let (&[x, y], rest) = polygon.split_first()?;
    let mut builder = tiny_skia::PathBuilder::new();
    builder.move_to(x, y);
    for &[x, y] in rest {
        builder.line_to(x, y);
    }
    builder.close();
    builder.finish()
}

fn paint([r, g, b, a]: [u8; 4]) -> tiny_skia::Paint<'static> {
    let mut paint = tiny_skia::Paint::default();
    paint.set_color_rgba8(r, g, b, a);
    paint
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colormap::{LEVELS, LevelColors};
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Mesh};
    use glam::dvec2;

    fn colors() -> LevelColors {
        std::array::from_fn(|level| [40 + 3 * level as u8, 90, 120, 255]).into()
    }

    fn mesh() -> Mesh {
        Mesh::coarse_grid(
            &Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap(),
            |_| true,
            &Limits::default(),
        )
        .unwrap()
    }

    #[test]
    fn exactly_the_pixels_of_the_domain_are_filled() {
        let mesh = mesh();
        let style = Style { edges: false, ..Style::dark(colors()) };
        for zoom in [1.0, 0.77, 3.1] {
            let camera =
                Camera::fit(mesh.lattice(), Rect::UNIT, [103, 77], 5.0).zoomed(zoom, dvec2(50.0, 33.0));
            let image = draw(&mesh, &camera, &style, None, &[]);
            for (i, &pixel) in image.pixels().iter().enumerate() {
                let px = dvec2((i % 103) as f64 + 0.5, (i / 103) as f64 + 0.5);
                let inside = Rect::UNIT.contains(camera.world_from_screen(px));
                assert_eq!(pixel, if inside { [40, 90, 120, 255] } else { style.ground }, "{px}");
            }
        }
    }

    #[test]
    fn the_boundary_of_the_domain_is_drawn_on_every_side() {
        let mesh = mesh();
        let style = Style::dark(colors());
        for margin in [0.0, 0.25, 0.5, 0.75] {
            let camera = Camera::fit(mesh.lattice(), Rect::UNIT, [101, 101], margin);
            let image = draw(&mesh, &camera, &style, None, &[]);
            // Away from corners and interior edges, only the boundary edge darkens the fill of 40.
            let inward = |n: u32| [[n, 10], [100 - n, 90], [10, n], [90, 100 - n]];
            for (outermost, next) in inward(0).into_iter().zip(inward(1)) {
                let red = |[x, y]: [u32; 2]| image.pixel(x, y)[0];
                let rim = [red(outermost), red(next)].into_iter().filter(|&red| red >= 20).min();
                assert!(rim.is_some_and(|red| red <= 30), "margin {margin}, at {outermost:?}: {rim:?}");
            }
        }
    }

    #[test]
    fn a_huge_triangle_is_drawn_from_its_half_planes() {
        let mesh = mesh();
        let style = Style::dark(colors());
        let camera = Camera::fit(mesh.lattice(), Rect::UNIT, [64, 64], 0.0).zoomed(1e300, dvec2(10.0, 45.0));
        // A corner of a cell is in the middle of the picture, with the diagonal that starts there.
        let camera = camera.centered_on(dvec2(0.5, 0.25));
        let image = draw(&mesh, &camera, &style, None, &[]);
        assert!(image.pixel(32, 5)[0] < 40, "the vertical edge");
        assert!(image.pixel(5, 32)[0] < 40, "the horizontal edge");
        assert!(image.pixel(52, 52)[0] < 40, "the diagonal");
        assert_eq!(image.pixel(20, 44), [40, 90, 120, 255]);
    }

    #[test]
    fn an_overlay_covers_its_rectangle() {
        let mesh = mesh();
        let camera = Camera::fit(mesh.lattice(), Rect::UNIT, [100, 100], 0.0);
        let rgba = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [9, 9, 9, 0]];
        let overlay =
            Overlay { bounds: Rect::UNIT, columns: 2, rows: 2, rgba: &rgba, opacity: 1.0, revision: 1 };
        let image = draw(&mesh, &camera, &Style::dark([[50; 4]; LEVELS]), Some(&overlay), &[]);
        assert_eq!(image.pixel(10, 90), [255, 0, 0, 255], "the first row is the lowest");
        assert_eq!(image.pixel(90, 90), [0, 255, 0, 255]);
        assert_eq!(image.pixel(10, 10), [0, 0, 255, 255]);
        assert_eq!(image.pixel(97, 8)[0], 50, "nothing where it is transparent");
    }
}
