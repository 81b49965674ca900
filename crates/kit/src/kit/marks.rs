//! Marks over the mesh: the brush ring, highlighted triangles and their numbers.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2, pos2, vec2};
use glam::DVec2;

use crate::kit::tools::Tools;
use meshbrush_core::domain::CutShape;
use meshbrush_core::paint::Mirror;
use meshbrush_mesh::mesh::{MeshView, TriangleId};
use meshbrush_render::colormap::Ground;
use meshbrush_render::scene::{Camera, Highlights, Outline as HighlightOutline, highlight_outlines};
use meshbrush_ui::theme::NUMBER_DISC;
use meshbrush_ui::theme::font;
use meshbrush_ui::widgets::Icon;

/// Side of a triangle in points below which its number would not fit.
const SMALLEST_NUMBERED: f64 = 26.0;

/// Draws a number on a ground around it.
pub fn paint_number(
    painter: &Painter,
    at: Pos2,
    number: impl ToString,
    font: FontId,
    color: Color32,
    ground: Color32,
) {
    let galley = painter.layout_no_wrap(number.to_string(), font, color);
    let place = Rect::from_center_size(at, galley.size() + vec2(8.0, 2.0));
    painter.rect_filled(place, 6.0, ground);
    painter.galley(place.center() - galley.size() / 2.0, galley, color);
}

/// Draws the outlines of the selected triangle, its neighbours and the one under the pointer.
pub fn paint_highlights(
    painter: &Painter,
    rect: Rect,
    mesh: MeshView<'_>,
    camera: &Camera,
    highlights: &Highlights,
) {
    let px_per_point = painter.pixels_per_point();
    for outline in highlight_outlines(mesh, camera, highlights, px_per_point) {
        painter.add(outline_shape(&outline, rect, px_per_point));
    }
}

/// Numbers the neighbours of the selected triangle that are large enough.
pub fn paint_neighbour_numbers(
    painter: &Painter,
    rect: Rect,
    mesh: MeshView<'_>,
    camera: &Camera,
    highlights: &Highlights,
) {
    for (i, (neighbour, [r, g, b])) in highlights.neighbours.iter().zip(Ground::ON_LEVELS).enumerate() {
        if let Some(id) = *neighbour
            && let Some(at) = middle_if_large(painter, rect, mesh, camera, id)
        {
            // On a dark disc in either theme.
            painter.circle_filled(at, 9.0, NUMBER_DISC);
            let number = (i + 1).to_string();
            painter.text(at, Align2::CENTER_CENTER, number, font::strong(), Color32::from_rgb(r, g, b));
        }
    }
}

/// Shortest side of a triangle, in points, at which its corners have room for their names.
const SHORTEST_NAMED: f32 = 40.0;
/// Distance of the middle of a name from its corner, away from the triangle, in points.
const NAME_DISTANCE: f32 = 15.0;
/// Width and height of the ground of a name, in points.
const NAME_SIZE: Vec2 = vec2(24.0, 17.0);

/// Names the corners of a triangle v₁ v₂ v₃ as files list them, where it is large enough.
pub fn paint_corner_names(
    painter: &Painter,
    rect: Rect,
    mesh: MeshView<'_>,
    camera: &Camera,
    id: TriangleId,
) {
    let px_per_point = painter.pixels_per_point();
    let corners = mesh.file_vertices(id).map(|node| camera.screen_from_lattice(mesh.node(node)));
    let corners = corners.map(|px| point_from_px(rect, px, px_per_point));
    let Some(places) = corner_name_places(corners) else { return };
    for (at, name) in places.into_iter().zip(["v₁", "v₂", "v₃"]) {
        painter.rect_filled(Rect::from_center_size(at, NAME_SIZE), 5.0, NUMBER_DISC);
        painter.text(at, Align2::CENTER_CENTER, name, font::strong(), Color32::WHITE);
    }
}

/// Returns the middles of the names: outside the triangle, so that they cover none of it and no number of a
/// neighbour. None where the triangle is too small for them.
fn corner_name_places(corners: [Pos2; 3]) -> Option<[Pos2; 3]> {
    let middle = corners.iter().fold(Vec2::ZERO, |sum, corner| sum + corner.to_vec2()) / 3.0;
    let has_room = (0..3).all(|i| corners[i].distance(corners[(i + 1) % 3]) >= SHORTEST_NAMED);
    has_room.then(|| corners.map(|corner| corner + NAME_DISTANCE * (corner.to_vec2() - middle).normalized()))
}

fn outline_shape(outline: &HighlightOutline, rect: Rect, px_per_point: f32) -> Shape {
    let points = outline.polygon.iter().map(|&[x, y]| rect.min + vec2(x, y) / px_per_point).collect();
    let stroke = Stroke::new(outline.line_width_px / px_per_point, color(outline.line));
    Shape::convex_polygon(points, color(outline.fill), stroke)
}

fn color([r, g, b, a]: [u8; 4]) -> Color32 {
    Color32::from_rgba_unmultiplied(r, g, b, a)
}

/// Returns the middle of a triangle, if it is large enough for a number.
fn middle_if_large(
    painter: &Painter,
    rect: Rect,
    mesh: MeshView<'_>,
    camera: &Camera,
    id: TriangleId,
) -> Option<Pos2> {
    let px_per_point = f64::from(painter.pixels_per_point());
    let leg = mesh.diameter(id) / std::f64::consts::SQRT_2;
    if leg * camera.px_per_world() / px_per_point < SMALLEST_NUMBERED {
        return None;
    }
    let [a, b, c] = mesh.corners(id).map(|corner| camera.screen_from_lattice(corner));
    Some(point_from_px(rect, (a + b + c) / 3.0, px_per_point as f32))
}

/// A small dot with a dark rim where the queried point is.
pub fn paint_point(painter: &Painter, at: Pos2) {
    painter.circle(at, 3.5, Color32::WHITE, Stroke::new(1.5, Color32::from_black_alpha(200)));
}

/// The ring of the brush: white on a dark halo, visible on any colour, and a thinner ring for the hardness.
///
/// `radius` is in points.
pub fn paint_brush_ring(painter: &Painter, at: Pos2, tools: &Tools, radius: f32) {
    let radius = radius.max(2.0);
    let halo = Color32::from_black_alpha(130);
    painter.circle_stroke(at, radius, Stroke::new(3.5, halo));
    painter.circle_stroke(at, radius, Stroke::new(1.5, Color32::WHITE));
    let core = radius * tools.hardness as f32;
    if tools.paints() && core > 3.0 && radius - core > 3.0 {
        painter.circle_stroke(at, core, Stroke::new(2.0, Color32::from_black_alpha(70)));
        painter.circle_stroke(at, core, Stroke::new(1.0, Color32::from_white_alpha(120)));
    }
    if radius < 6.0 {
        let arm = 7.0;
        for d in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
            let ends = [at + d * (radius + 2.0), at + d * (radius + arm)];
            painter.line_segment(ends, Stroke::new(3.0, halo));
            painter.line_segment(ends, Stroke::new(1.0, Color32::WHITE));
        }
    }
}

/// An eyedropper with its tip at the pointer.
pub fn paint_eyedropper(painter: &Painter, tip: Pos2) {
    let icon = |offset: [f32; 2], color| {
        let at = tip + vec2(-2.0, 2.0) + offset.into();
        painter.text(at, Align2::LEFT_BOTTOM, Icon::PICK.glyph(), font::icon(22.0), color);
    };
    for offset in [[-1.5, 0.0], [1.5, 0.0], [0.0, -1.5], [0.0, 1.5]] {
        icon(offset, Color32::from_black_alpha(170));
    }
    icon([0.0, 0.0], Color32::WHITE);
}

/// The lines in which strokes are repeated.
pub fn paint_mirror_lines(painter: &Painter, screen_from_world: &dyn Fn(DVec2) -> Pos2, mirror: &Mirror) {
    let view = painter.clip_rect();
    let middle = screen_from_world(DVec2::new(mirror.x.unwrap_or(0.0), mirror.y.unwrap_or(0.0)));
    let vertical = mirror.x.map(|_| [pos2(middle.x, view.top()), pos2(middle.x, view.bottom())]);
    let horizontal = mirror.y.map(|_| [pos2(view.left(), middle.y), pos2(view.right(), middle.y)]);
    for line in [vertical, horizontal].into_iter().flatten() {
        painter.line_segment(line, Stroke::new(2.5, Color32::from_black_alpha(70)));
        painter.extend(Shape::dashed_line(&line, Stroke::new(1.0, Color32::from_white_alpha(110)), 8.0, 6.0));
    }
}

/// The images of a brush ring at `pointer`, in world units, beyond the lines of a mirror. `radius` is in
/// points.
pub fn paint_mirror_images(
    painter: &Painter,
    screen_from_world: &dyn Fn(DVec2) -> Pos2,
    mirror: &Mirror,
    pointer: DVec2,
    radius: f32,
) {
    for image in mirror.images(pointer).skip(1) {
        let at = screen_from_world(image);
        painter.circle_stroke(at, radius.max(2.0), Stroke::new(2.5, Color32::from_black_alpha(70)));
        painter.circle_stroke(at, radius.max(2.0), Stroke::new(1.0, Color32::from_white_alpha(130)));
    }
}

/// The string on which the pointer pulls the brush.
pub fn paint_string(painter: &Painter, brush: Pos2, pointer: Pos2) {
    painter.line_segment([brush, pointer], Stroke::new(3.0, Color32::from_black_alpha(90)));
    painter.line_segment([brush, pointer], Stroke::new(1.0, Color32::from_white_alpha(160)));
    painter.circle_filled(pointer, 2.5, Color32::WHITE);
}

/// The straight line that Shift and a click would paint.
pub fn paint_line_preview(painter: &Painter, from: Pos2, to: Pos2) {
    let ends = [from, to];
    painter.line_segment(ends, Stroke::new(3.0, Color32::from_black_alpha(110)));
    painter.extend(Shape::dashed_line(&ends, Stroke::new(1.5, Color32::WHITE), 6.0, 4.0));
}

/// Shortest edge of an outline that is drawn, in points: a shorter one cannot be seen.
const SHORTEST_PIECE: f32 = 0.7;

/// A ring of the domain's outline, thin and light on a dark halo.
pub fn paint_outline(painter: &Painter, corners: impl Iterator<Item = Pos2>) {
    let mut ring: Vec<Pos2> = Vec::new();
    for corner in corners {
        if ring.last().is_none_or(|last| last.distance_sq(corner) >= SHORTEST_PIECE * SHORTEST_PIECE) {
            ring.push(corner);
        }
    }
    let pieces = visible_pieces(&ring, painter.clip_rect().expand(3.0));
    for stroke in [Stroke::new(2.5, Color32::from_black_alpha(110)), Stroke::new(1.0, Color32::WHITE)] {
        painter.extend(pieces.iter().map(|piece| Shape::line(piece.clone(), stroke)));
    }
}

/// A contour line: thin, and light on a dark halo, so that it is visible on the colour of any level.
pub fn paint_contour(painter: &Painter, points: impl Iterator<Item = Pos2>) {
    paint_quiet_line(painter, points, [Color32::from_black_alpha(120), Color32::from_white_alpha(225)]);
}

/// A thin line on a halo, in these two colours.
pub fn paint_quiet_line(painter: &Painter, points: impl Iterator<Item = Pos2>, [halo, line]: [Color32; 2]) {
    let (lines, _) = lines_in_view(painter, points, 2.0);
    for stroke in [Stroke::new(2.2, halo), Stroke::new(0.9, line)] {
        painter.extend(lines.iter().map(|line| Shape::line(line.clone(), stroke)));
    }
}

/// Returns a line in a colour on a dark halo. Returns the length of what is in view, in points.
pub fn paint_line(painter: &Painter, points: impl Iterator<Item = Pos2>, color: Color32, width: f32) -> f32 {
    let (lines, length) = lines_in_view(painter, points, width);
    for stroke in [Stroke::new(width + 2.0, Color32::from_black_alpha(150)), Stroke::new(width, color)] {
        painter.extend(lines.iter().map(|line| Shape::line(line.clone(), stroke)));
    }
    length
}

/// A line in a colour between light rims on a dark halo, so that it differs from the colours of all levels.
pub fn paint_rimmed_line(painter: &Painter, points: impl Iterator<Item = Pos2>, color: Color32, width: f32) {
    let (lines, _) = lines_in_view(painter, points, width);
    let halo = Stroke::new(width + 3.5, Color32::from_black_alpha(110));
    for stroke in [halo, Stroke::new(width + 1.8, Color32::WHITE), Stroke::new(width, color)] {
        painter.extend(lines.iter().map(|line| Shape::line(line.clone(), stroke)));
    }
}

/// A dashed line in a colour on a dark halo. The dashes stay where they are when the view is moved.
pub fn paint_dashed_line(painter: &Painter, points: impl Iterator<Item = Pos2>, color: Color32, width: f32) {
    let view = painter.clip_rect().expand(width);
    let (mut last, mut length) = (None, 0.0);
    for point in points {
        if let Some(from) = last.replace(point) {
            if let Some([start, end]) = clipped([from, point], view) {
                painter.line_segment([start, end], Stroke::new(width + 2.0, Color32::from_black_alpha(120)));
                let dashes = dashes([start, end], length + from.distance(start));
                painter.extend(dashes.map(|ends| Shape::line_segment(ends, Stroke::new(width, color))));
            }
            length += from.distance(point);
        }
    }
}

/// Length of a dash, and of the space after it, in points.
const DASH: f32 = 6.0;
const DASH_GAP: f32 = 4.0;

/// Returns the dashes of a segment that begins at a distance along a line.
fn dashes([from, to]: [Pos2; 2], begins_at: f32) -> impl Iterator<Item = [Pos2; 2]> {
    let (length, period) = (from.distance(to), DASH + DASH_GAP);
    let first = -(begins_at % period);
    let count = ((length - first) / period).ceil().max(0.0) as usize;
    let at = move |distance: f32| from + distance.clamp(0.0, length) / length * (to - from);
    let starts = (0..count).map(move |number| first + number as f32 * period);
    starts.filter(|start| start + DASH > 0.0).map(move |start| [at(start), at(start + DASH)])
}

/// Returns the part of a segment in a rectangle (Liang and Barsky).
fn clipped([from, to]: [Pos2; 2], view: Rect) -> Option<[Pos2; 2]> {
    let along = to - from;
    let (mut enters, mut leaves) = (0.0_f32, 1.0_f32);
    for axis in 0..2 {
        let sides = [view.min[axis] - from[axis], view.max[axis] - from[axis]];
        if along[axis] == 0.0 {
            if sides[0] > 0.0 || sides[1] < 0.0 {
                return None;
            }
            continue;
        }
        let [first, second] = sides.map(|side| side / along[axis]);
        enters = enters.max(first.min(second));
        leaves = leaves.min(first.max(second));
    }
    (enters < leaves).then(|| [from + enters * along, from + leaves * along])
}

/// Returns the parts of a line in view, without edges that are too short to be seen, and their length in
/// points.
fn lines_in_view(painter: &Painter, points: impl Iterator<Item = Pos2>, width: f32) -> (Vec<Vec<Pos2>>, f32) {
    let view = painter.clip_rect().expand(width);
    let (mut lines, mut last): (Vec<Vec<Pos2>>, Option<Pos2>) = (Vec::new(), None);
    let mut length = 0.0;
    let mut points = points.peekable();
    while let Some(point) = points.next() {
        let Some(from) = last else {
            last = Some(point);
            continue;
        };
        if points.peek().is_some() && from.distance_sq(point) < SHORTEST_PIECE * SHORTEST_PIECE {
            continue;
        }
        last = Some(point);
        if !Rect::from_two_pos(from, point).intersects(view) {
            continue;
        }
        length += from.distance(point);
        match lines.last_mut().filter(|line| line.last() == Some(&from)) {
            Some(line) => line.push(point),
            None => lines.push(vec![from, point]),
        }
    }
    (lines, length)
}

/// Returns the pieces of a ring near a view. The ring is split where it turns back: a line drawn around such
/// a corner would end in a spike far beyond it.
fn visible_pieces(ring: &[Pos2], view: Rect) -> Vec<Vec<Pos2>> {
    let mut pieces: Vec<Vec<Pos2>> = Vec::new();
    let mut continues = false;
    for (i, &from) in ring.iter().enumerate() {
        let [to, next] = [i + 1, i + 2].map(|i| ring[i % ring.len()]);
        if !Rect::from_two_pos(from, to).intersects(view) {
            continues = false;
            continue;
        }
        match pieces.last_mut() {
            Some(piece) if continues => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
        continues = (to - from).normalized().dot((next - to).normalized()) > -0.5;
    }
    pieces
}

/// Returns a shape that is not cut yet: a ring, or the path of the brush.
pub fn paint_cut_shape(painter: &Painter, cut_shape: &CutShape, at: &dyn Fn(DVec2) -> Pos2) {
    let (path, radius) = match cut_shape {
        CutShape::Ring(ring) => return paint_outline(painter, ring.iter().map(|&corner| at(corner))),
        CutShape::Stroke { path, radius } => (path, *radius),
    };
    let points: Vec<Pos2> = path.iter().map(|&point| at(point)).collect();
    let radius = points[0].distance(at(path[0] + DVec2::new(radius, 0.0)));
    let color = Color32::from_white_alpha(70);
    match points[..] {
        [point] => painter.circle_filled(point, radius, color),
        _ => painter.add(Shape::line(points, Stroke::new(2.0 * radius, color))),
    };
}

/// An open polygon: its next edge follows the pointer, and its corners can be dragged.
pub fn paint_open_polygon(painter: &Painter, corners: &[Pos2], pointer: Option<Pos2>) {
    if let ([first, _, _, ..], Some(pointer)) = (corners, pointer) {
        let closing = Stroke::new(1.0, Color32::from_white_alpha(110));
        painter.extend(Shape::dashed_line(&[pointer, *first], closing, 3.0, 5.0));
    }
    paint_open_line(painter, corners, pointer);
}

/// A line that is being drawn, as [`paint_open_polygon`], without an edge back to its first corner.
pub fn paint_open_line(painter: &Painter, corners: &[Pos2], pointer: Option<Pos2>) {
    for edge in corners.windows(2) {
        painter.line_segment([edge[0], edge[1]], Stroke::new(3.0, Color32::from_black_alpha(110)));
        painter.line_segment([edge[0], edge[1]], Stroke::new(1.5, Color32::WHITE));
    }
    if let (Some(pointer), Some(&last)) = (pointer, corners.last()) {
        paint_line_preview(painter, last, pointer);
    }
    paint_handles(painter, corners);
}

/// Corners that can be dragged; the first one is larger.
pub fn paint_handles(painter: &Painter, corners: &[Pos2]) {
    let rim = Stroke::new(1.5, Color32::from_black_alpha(200));
    for (number, &corner) in corners.iter().enumerate().rev() {
        painter.circle(corner, if number == 0 { 5.0 } else { 3.5 }, Color32::WHITE, rim);
    }
}

/// A rectangle that is being drawn.
pub fn paint_frame(painter: &Painter, frame: Rect) {
    painter.rect_stroke(frame, 0.0, Stroke::new(3.5, Color32::from_black_alpha(130)), StrokeKind::Middle);
    painter.rect_stroke(frame, 0.0, Stroke::new(1.5, Color32::WHITE), StrokeKind::Middle);
}

/// Returns the position of a canvas pixel, in points.
pub fn point_from_px(rect: Rect, px: DVec2, px_per_point: f32) -> Pos2 {
    pos2(rect.min.x + px.x as f32 / px_per_point, rect.min.y + px.y as f32 / px_per_point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshbrush_mesh::geometry::{Lattice, Rect as WorldRect};
    use meshbrush_mesh::mesh::{Element, Limits, Mesh};

    #[test]
    fn names_of_corners_cover_no_number_of_a_neighbour_and_not_the_triangle() {
        let lattice = Lattice::covering(WorldRect::UNIT, 0.2, 1_000_000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let half = 5 * lattice.cell_steps() / 2;
        let deeper = |element: &Element<'_>| {
            element.triangle.level() < 3 && element.corners.iter().all(|corner| corner.x < half)
        };
        mesh.refine(&Limits::default(), deeper).unwrap();
        let view = mesh.view();
        for scale in [200.0, 400.0, 1000.0, 3000.0] {
            let at = |world: DVec2| pos2((scale * world.x) as f32, (scale * world.y) as f32);
            let named = (0..mesh.raw_triangle_count()).map(TriangleId::from_index).filter_map(|id| {
                let corners = view.world_corners(id).map(at);
                corner_name_places(corners).map(|places| (id, corners, places))
            });
            for (id, corners, places) in named {
                let grounds = places.map(|place| Rect::from_center_size(place, NAME_SIZE));
                let numbers = view.neighbours(id).into_iter().filter_map(|across| {
                    let [a, b, c] = view.world_corners(across.triangle()?);
                    Some(at((a + b + c) / 3.0))
                });
                for number in numbers {
                    let free = grounds.iter().all(|ground| ground.distance_to_pos(number) >= 9.0);
                    assert!(free, "{id:?} at {scale}: {number:?} in {grounds:?}");
                }
                let middle = corners.iter().fold(Vec2::ZERO, |sum, corner| sum + corner.to_vec2()) / 3.0;
                assert!(grounds.iter().all(|ground| !ground.contains(middle.to_pos2())));
            }
        }
        let small = [pos2(0.0, 0.0), pos2(30.0, 0.0), pos2(0.0, 30.0)];
        assert_eq!(corner_name_places(small), None);
    }
}
