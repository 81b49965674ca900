use glam::{DVec2, dvec2};

use super::Camera;
use crate::colormap::Ground;
use meshbrush_mesh::mesh::{MeshView, TriangleId};

const WHITE: [u8; 3] = [0xff; 3];
/// Colour of the dark outer part of every line. White and bright lines alone are hard to see on yellow, and
/// on the light canvas.
const HALO: [u8; 4] = [0, 0, 0, 0xf0];
/// How far the halo extends beyond each side of its line, in points.
const HALO_POINTS: f32 = 1.5;
/// Opacity of the fills: the colour of the level stays visible.
const NEIGHBOUR_FILL: u8 = 0x50;
const HOVERED_FILL: u8 = 0x18;
const SELECTED_FILL: u8 = 0x30;
/// Distance in pixels beyond the canvas at which outlines are clipped; larger than any line width.
const CLIP_MARGIN_PX: f64 = 32.0;

/// Triangles to emphasize.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Highlights {
    /// The queried triangle.
    pub selected: Option<TriangleId>,
    /// The neighbours of the selected triangle, the bisection neighbour first; `None` at the boundary.
    pub neighbours: [Option<TriangleId>; 3],
    /// The triangle under the pointer.
    pub hovered: Option<TriangleId>,
}

impl Highlights {
    /// Highlights a triangle and its three neighbours.
    pub fn around(mesh: MeshView<'_>, selected: TriangleId) -> Self {
        let neighbours = mesh.neighbours(selected).map(|n| n.triangle());
        Self { selected: Some(selected), neighbours, hovered: None }
    }
}

/// A closed shape on the screen, filled and outlined. Colours are sRGB bytes, alpha not premultiplied.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Corners in pixels, at least three: a triangle, clipped where it extends far beyond the canvas.
    pub polygon: Vec<[f32; 2]>,
    /// Colour inside.
    pub fill: [u8; 4],
    /// Colour of the line.
    pub line: [u8; 4],
    /// Width of the line in pixels; half of it is outside.
    pub line_width_px: f32,
}

/// Returns the outlines of the highlights, in drawing order: each line after its dark halo, so that it is
/// visible on the colour of any level. `px_per_point` scales line widths on dense screens.
///
/// Ids that the mesh no longer has and triangles outside the canvas have no outline.
pub fn highlight_outlines(
    mesh: MeshView<'_>,
    camera: &Camera,
    highlights: &Highlights,
    px_per_point: f32,
) -> Vec<Outline> {
    let mut outlines = Vec::new();
    let mut draw = |id: Option<TriangleId>, [r, g, b]: [u8; 3], fill_alpha: u8, width: f32| {
        let Some(polygon) = id.and_then(|id| polygon_on_screen(mesh, camera, id)) else { return };
        let (halo_width, none) = (width + 2.0 * HALO_POINTS, [0; 4]);
        let mut add = |polygon, fill, line, width: f32| {
            outlines.push(Outline { polygon, fill, line, line_width_px: width * px_per_point });
        };
        add(polygon.clone(), [r, g, b, fill_alpha], HALO, halo_width);
        add(polygon, none, [r, g, b, 0xff], width);
    };
    for (id, color) in highlights.neighbours.into_iter().zip(Ground::ON_LEVELS) {
        draw(id, color, NEIGHBOUR_FILL, 1.5);
    }
    if highlights.hovered != highlights.selected {
        draw(highlights.hovered, WHITE, HOVERED_FILL, 1.0);
    }
    draw(highlights.selected, WHITE, SELECTED_FILL, 2.0);
    outlines
}

fn polygon_on_screen(mesh: MeshView<'_>, camera: &Camera, id: TriangleId) -> Option<Vec<[f32; 2]>> {
    let triangle = mesh.get(id)?;
    let corners = triangle.vertices.map(|v| camera.screen_from_lattice(mesh.node(v)));
    let polygon = clip_to_canvas(corners.to_vec(), camera);
    (polygon.len() >= 3).then(|| polygon.into_iter().map(|p| p.as_vec2().to_array()).collect())
}

/// Clips a convex polygon a little outside the canvas (Sutherland and Hodgman).
///
/// At a deep zoom a coarse triangle can be 10¹¹ px wide; in f32 its edges would be displaced.
fn clip_to_canvas(mut polygon: Vec<DVec2>, camera: &Camera) -> Vec<DVec2> {
    let far = 2.0 * camera.half_size_px() + DVec2::splat(CLIP_MARGIN_PX);
    let sides = [
        (dvec2(1.0, 0.0), CLIP_MARGIN_PX),
        (dvec2(-1.0, 0.0), far.x),
        (dvec2(0.0, 1.0), CLIP_MARGIN_PX),
        (dvec2(0.0, -1.0), far.y),
    ];
    for (inwards, offset) in sides {
        let inside = |p: DVec2| inwards.dot(p) + offset;
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, &b) in polygon.iter().enumerate() {
            let a = polygon[(i + polygon.len() - 1) % polygon.len()];
            let (da, db) = (inside(a), inside(b));
            if (da < 0.0) != (db < 0.0) {
                kept.push(a + (b - a) * (da / (da - db)));
            }
            if db >= 0.0 {
                kept.push(b);
            }
        }
        polygon = kept;
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colormap::{Colormap, LevelColors, contrast_ratio};
    use meshbrush_mesh::geometry::{Lattice, Rect};
    use meshbrush_mesh::mesh::{Limits, Mesh};

    fn mesh() -> Mesh {
        Mesh::coarse_grid(
            &Lattice::covering(Rect::UNIT, 0.5, 1_000_000).unwrap(),
            |_| true,
            &Limits::default(),
        )
        .unwrap()
    }

    #[test]
    fn a_triangle_and_its_neighbours_are_outlined_by_their_corners() {
        let mesh = mesh();
        let camera = Camera::fit(mesh.lattice(), Rect::UNIT, [100, 100], 0.0);
        let highlights = Highlights::around(mesh.view(), TriangleId::from_index(0));
        let outlines = highlight_outlines(mesh.view(), &camera, &highlights, 1.0);
        // Two sides of the first triangle are on the boundary; each line has a halo.
        assert_eq!(outlines.len(), 4);
        assert_eq!(outlines[1].line[..3], Ground::ON_LEVELS[0]);
        let white = outlines.last().unwrap();
        assert_eq!((white.line, white.line_width_px), ([0xff; 4], 2.0));
        for corner in [[0.0, 50.0], [0.0, 100.0], [50.0, 100.0]] {
            assert!(white.polygon.contains(&corner), "{:?}", white.polygon);
        }
    }

    #[test]
    fn a_triangle_much_larger_than_the_canvas_is_clipped_outside_it() {
        let mesh = mesh();
        let camera =
            Camera::fit(mesh.lattice(), Rect::UNIT, [100, 100], 0.0).zoomed(1e300, dvec2(10.0, 80.0));
        let all = (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
        let shown: Vec<_> = all.filter_map(|id| polygon_on_screen(mesh.view(), &camera, id)).collect();
        assert_eq!(shown.len(), 1);
        assert!(shown[0].iter().flatten().all(|&c| (-33.0..=133.0).contains(&c)), "{shown:?}");
    }

    #[test]
    fn ids_of_a_previous_mesh_are_not_drawn() {
        let mesh = mesh();
        let camera = Camera::fit(mesh.lattice(), Rect::UNIT, [100, 100], 0.0);
        let highlights =
            Highlights { hovered: Some(TriangleId::from_index(1_000_000)), ..Highlights::default() };
        assert_eq!(highlight_outlines(mesh.view(), &camera, &highlights, 1.0), []);
    }

    /// `color` over `below`, as the screen blends them.
    fn over(below: [u8; 3], [r, g, b, alpha]: [u8; 4]) -> [u8; 3] {
        let share = f64::from(alpha) / 255.0;
        let mix = |from: u8, to: u8| f64::from(from) + share * (f64::from(to) - f64::from(from));
        [mix(below[0], r), mix(below[1], g), mix(below[2], b)].map(|c| c.round() as u8)
    }

    /// Calls `check` with the colour of each level, for every map on both grounds.
    fn on_every_level(mut check: impl FnMut(&str, [u8; 3])) {
        for map in Colormap::ALL {
            for ground in [Ground::Dark, Ground::Light] {
                let colors = LevelColors::new(map, ground, 20);
                for level in 0..=20 {
                    let [r, g, b, _] = colors.of(level);
                    check(&format!("level {level}, {map:?} on {ground:?}"), [r, g, b]);
                }
            }
        }
    }

    #[test]
    fn each_outline_stands_out_from_the_colour_of_every_level() {
        let mesh = mesh();
        let camera = Camera::fit(mesh.lattice(), Rect::UNIT, [100, 100], 0.0);
        let ids: Vec<_> = [0, 1, 2, 3, 4].map(TriangleId::from_index).map(Some).to_vec();
        let neighbours = [ids[1], ids[2], ids[3]];
        let highlights = Highlights { selected: ids[0], neighbours, hovered: ids[4] };
        let outlines = highlight_outlines(mesh.view(), &camera, &highlights, 1.0);
        assert_eq!(outlines.len(), 10, "halo and line of five triangles");
        for pair in outlines.chunks(2) {
            let (halo, line) = (&pair[0], &pair[1]);
            on_every_level(|place, level| {
                for beside in [level, over(level, halo.fill)] {
                    let dark = over(beside, halo.line);
                    let bright = over(dark, line.line);
                    let seen = contrast_ratio(dark, beside).max(contrast_ratio(bright, beside));
                    assert!(seen >= 3.0, "{:?} at {place}: only {seen:.2}", line.line);
                    let core = contrast_ratio(bright, dark);
                    assert!(core >= 3.0, "{:?} in its halo at {place}: only {core:.2}", line.line);
                }
            });
        }
    }
}
