//! The renderer that needs no graphics driver. It draws pictures for the command line and is the reference
//! for the GPU.

mod corners;
mod damage;
mod groups;
mod kept;
mod painter;
mod rasterizer;
mod space;
mod threads;

use glam::Vec2;

pub use self::damage::{BAND_ROWS, Damage, PxRect};
pub use self::kept::KeptPicture;
pub use self::space::{draw_extract_in_space, draw_surface};
pub use self::threads::on_drawing_threads;

use self::corners::Corners;
use self::groups::TriangleGroups;
use self::painter::{Painter, TriangleArrays, ground};
use super::Image;
use super::draw_flags::DrawFlags;
use super::skia::paint;
use crate::scene::{Camera, Outline, Overlay, ShownMesh, ShownRevision, Style};
use meshbrush_mesh::mesh::Extract;

/// Draws a mesh as `camera` sees it, multiplied by the overlay, and outlines on top.
///
/// Outlines come from [`highlight_outlines`](crate::scene::highlight_outlines). The time is proportional to
/// the mesh and to the pixels: about 50 ns per triangle, shared by all cores.
pub fn draw<'a>(
    shown: impl Into<ShownMesh<'a>>,
    camera: &Camera,
    style: &Style,
    overlay: Option<&Overlay>,
    outlines: &[Outline],
) -> Image {
    let mut kept = KeptPicture::default();
    kept.update(shown.into(), ShownRevision { mesh: 0, pieces: 0 }, camera, style);
    let mut image = kept.into_image();
    if let Some(overlay) = overlay {
        multiply_by(&mut image, camera, overlay);
    }
    draw_outlines(&mut image, outlines);
    image
}

/// Draws the extract of a mesh, for files.
pub fn draw_extract(extract: &Extract, camera: &Camera, style: &Style) -> Image {
    let mut image = Image::filled(camera.size_px(), ground(style));
    let camera = camera.on_lattice(extract.lattice());
    let (nodes, triangles) = (extract.nodes(), extract.triangles());
    let (groups, flags) = (TriangleGroups::new(nodes, triangles), DrawFlags::default());
    let corners = Corners::new(nodes, &camera);
    let arrays = TriangleArrays {
        nodes,
        corners: &corners,
        triangles,
        groups: &groups,
        flags: &flags,
        are_of_mesh: false,
    };
    let everything = Damage::everything(camera.size_px());
    on_drawing_threads(|| Painter::new(camera, style).draw(&mut image, &everything, &[arrays]));
    image
}

/// Multiplies the colours of a picture by those of an overlay.
pub(in crate::render) fn multiply_by(image: &mut Image, camera: &Camera, overlay: &Overlay) {
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
        let row = index_below(texel, overlay.rows).map(|row| row * overlay.columns as usize);
        let pixel_row = &mut pixels[(y * width) as usize..][..width as usize];
        for (pixel, column) in pixel_row.iter_mut().zip(&columns) {
            let place = row.zip(*column).map(|(row, column)| row + column);
            *pixel = product(*pixel, place.map_or(overlay.beyond, |place| overlay.rgba[place]));
        }
    }
}

fn index_below(texel: f64, count: u32) -> Option<usize> {
    (texel >= 0.0 && texel < f64::from(count)).then_some(texel as usize)
}

fn product(below: [u8; 4], color: [u8; 4]) -> [u8; 4] {
    let channel = |i: usize| (f32::from(below[i]) * f32::from(color[i]) / 255.0).round() as u8;
    [channel(0), channel(1), channel(2), below[3]]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colormap::{LEVELS, LevelColors};
    use glam::dvec2;
    use meshbrush_mesh::geometry::{Lattice, Rect};
    use meshbrush_mesh::mesh::{Limits, Mesh};

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
        let beyond = [70, 60, 50, 255];
        let overlay = Overlay { bounds: Rect::UNIT, columns: 2, rows: 2, rgba: &rgba, beyond, revision: 1 };
        let style = Style { edges: false, ..Style::dark([[50; 4]; LEVELS]).under(beyond) };
        let image = draw(&mesh, &camera, &style, Some(&overlay), &[]);
        assert_eq!(image.pixel(10, 90), [255, 0, 0, 255], "the first row is the lowest");
        assert_eq!(image.pixel(90, 90), [0, 255, 0, 255]);
        assert_eq!(image.pixel(10, 10), [0, 0, 255, 255]);
        let with_edges = draw(&mesh, &camera, &Style { edges: true, ..style.clone() }, Some(&overlay), &[]);
        let [red, others @ ..] = with_edges.pixel(25, 90);
        assert!((100..250).contains(&red) && others == [0, 0, 255], "an edge is a dark tint: {red}");
        let camera = Camera::fit(mesh.lattice(), Rect::UNIT, [100, 100], 10.0);
        let image = draw(&mesh, &camera, &style, Some(&overlay), &[]);
        assert_eq!(image.pixel(3, 3), Style::dark([[50; 4]; LEVELS]).ground, "the ground keeps its colour");
    }
}
