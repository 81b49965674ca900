//! The mesh at a step, on the canvas.

use eframe::egui::{Color32, Mesh, Painter, Pos2, Rect, Response, Shape, Stroke, Ui, pos2, vec2};

use glam::DVec2;

use super::Steps;
use crate::app::kit::marks::{NUMBER_DISC, point_from_px};
use crate::app::kit::{FrameState, marks};
use crate::app::theme::{font, tokens};
use meshbrush_render::colormap::{Ground, LevelColors};
use meshbrush_render::scene::Camera;
use meshbrush_study::steps::{StepPart, StepPlayer};

/// Shortest leg of a triangle, in points, at which its number is drawn.
const NUMBERED_LEG: f32 = 44.0;
/// Length of a leg in points from which the triangles of the step are numbered.
const NUMBERED_LEG_OF_STEP: f32 = 22.0;
/// Shortest leg around a node at which its number is drawn.
const NUMBERED_NODE: f32 = 90.0;
/// Most numbers that are drawn.
const MOST_NUMBERS: usize = 600;
/// The edges of triangles: seen on the darkest and on the lightest level.
const EDGE: Color32 = Color32::from_rgba_premultiplied(0x58, 0x5d, 0x66, 0xa0);
/// Shortest leg of a triangle of the step at which its nodes are numbered.
const NUMBERED_NODE_OF_STEP: f32 = 40.0;
/// Width of the outline of the domain, in points.
const OUTLINE: f32 = 1.0;
/// A line over the colours of levels: a bright one on a dark one.
const HALO: Color32 = Color32::from_black_alpha(0xf0);

/// Returns the colour of a triangle of the step, visible on any level.
fn color_of(part: StepPart) -> Color32 {
    let [across, waiting, relinked] = Ground::ON_LEVELS.map(|[r, g, b]| Color32::from_rgb(r, g, b));
    match part {
        StepPart::Waiting => waiting,
        StepPart::Relinked => relinked,
        StepPart::Across => across,
        StepPart::Current => Color32::WHITE,
    }
}

/// Draws the mesh at the step that is shown, on the canvas.
pub fn paint(ui: &Ui, response: &Response, state: &FrameState<'_>) {
    let player = state.features.stepping.steps().and_then(Steps::player);
    let (Some(player), Some(camera)) = (player, state.view.camera) else { return };
    let colors = state.view.level_colors(state.session.follower().settings());
    let places = Places::new(ui, response.rect, &camera, player);
    let painter = &ui.painter_at(response.rect);
    places.paint_triangles(painter, player, &colors);
    paint_outline(ui, painter, response.rect, &camera, state);
    let parts = player.parts();
    for (number, part) in &parts {
        paint_part(painter, &places.corners(player, *number), *part);
    }
    places.paint_node_numbers(painter, player, &parts);
    places.paint_triangle_numbers(painter, player, &parts);
    if response.contains_pointer() {
        ui.ctx().set_cursor_icon(state.tools.tool.cursor);
    }
}

/// Draws the polygons of the domain.
fn paint_outline(ui: &Ui, painter: &Painter, rect: Rect, camera: &Camera, state: &FrameState<'_>) {
    let Some(region) = state.session.follower().settings().domain.region() else { return };
    let px_per_point = ui.pixels_per_point();
    let place = |&corner: &DVec2| point_from_px(rect, camera.screen_from_world(corner), px_per_point);
    for ring in region.polygons().iter().flatten() {
        let closed = ring.iter().chain(ring.first()).map(place);
        marks::paint_rimmed_line(painter, closed, tokens(ui).accent, OUTLINE);
    }
}

/// The positions of the nodes on the screen, in points.
struct Places {
    rect: Rect,
    nodes: Vec<Pos2>,
}

impl Places {
    fn new(ui: &Ui, rect: Rect, camera: &Camera, player: &StepPlayer) -> Self {
        let place = |&node: &_| point_from_px(rect, camera.screen_from_lattice(node), ui.pixels_per_point());
        Self { rect, nodes: player.nodes().iter().map(place).collect() }
    }

    fn corners(&self, player: &StepPlayer, number: u32) -> [Pos2; 3] {
        let [a, b, c, ..] = player.rows()[number as usize - 1];
        [a, b, c].map(|node| self.nodes[node as usize - 1])
    }

    fn is_visible(&self, corners: &[Pos2; 3]) -> bool {
        Rect::from_points(corners).intersects(self.rect)
    }

    fn paint_triangles(&self, painter: &Painter, player: &StepPlayer, colors: &LevelColors) {
        let (mut fills, mut edges) = (Mesh::default(), Vec::new());
        let line = Stroke::new(1.0, EDGE);
        for (index, row) in player.rows().iter().enumerate() {
            let corners = self.corners(player, index as u32 + 1);
            if !self.is_visible(&corners) {
                continue;
            }
            let [r, g, b, _] = colors.of(row[7] as u8);
            let first = fills.vertices.len() as u32;
            corners.iter().for_each(|&corner| fills.colored_vertex(corner, Color32::from_rgb(r, g, b)));
            fills.add_triangle(first, first + 1, first + 2);
            edges.push(Shape::closed_line(corners.to_vec(), line));
        }
        painter.add(Shape::mesh(fills));
        painter.extend(edges);
    }

    /// Numbers the nodes between large triangles, and those of the triangles of the step, which the panel
    /// names: a dot with the number above it.
    fn paint_node_numbers(&self, painter: &Painter, player: &StepPlayer, parts: &[(u32, StepPart)]) {
        let mut has_room = vec![true; self.nodes.len()];
        for (index, row) in player.rows().iter().enumerate() {
            if shortest_edge(&self.corners(player, index as u32 + 1)) < NUMBERED_NODE {
                row[..3].iter().for_each(|&node| has_room[node as usize - 1] = false);
            }
        }
        for (number, _) in parts {
            if shortest_edge(&self.corners(player, *number)) >= NUMBERED_NODE_OF_STEP {
                let [a, b, c, ..] = player.rows()[*number as usize - 1];
                [a, b, c].into_iter().for_each(|node| has_room[node as usize - 1] = true);
            }
        }
        let nodes = self.nodes.iter().enumerate();
        let shown = nodes.filter(|(node, at)| has_room[*node] && self.rect.contains(**at));
        for (node, &at) in shown.take(MOST_NUMBERS) {
            painter.circle(at, 3.0, Color32::WHITE, Stroke::new(1.5, HALO));
            let galley = painter.layout_no_wrap((node + 1).to_string(), font::caption(), Color32::WHITE);
            let corner = pos2(at.x + 6.0, at.y - galley.size().y - 4.0);
            let ground = Rect::from_min_size(corner, galley.size()).expand2(vec2(3.0, 1.0));
            painter.rect_filled(ground, 3.0, Color32::from_black_alpha(190));
            painter.galley(corner, galley, Color32::WHITE);
        }
    }

    fn paint_triangle_numbers(&self, painter: &Painter, player: &StepPlayer, parts: &[(u32, StepPart)]) {
        let mut left = MOST_NUMBERS;
        for number in 1..=player.rows().len() as u32 {
            let corners = self.corners(player, number);
            let part = parts.iter().find(|(of_step, _)| *of_step == number).map(|(_, part)| *part);
            let needed = if part.is_some() { NUMBERED_LEG_OF_STEP } else { NUMBERED_LEG };
            let is_shown = shortest_edge(&corners) >= needed && self.is_visible(&corners);
            if is_shown && (left > 0 || part.is_some()) {
                left = left.saturating_sub(1);
                paint_number(painter, middle(&corners), number, part);
            }
        }
    }
}

fn paint_part(painter: &Painter, corners: &[Pos2; 3], part: StepPart) {
    let color = color_of(part);
    let width = if part == StepPart::Current { 2.5 } else { 2.0 };
    painter.add(Shape::convex_polygon(
        corners.to_vec(),
        color.gamma_multiply(0.25),
        Stroke::new(width + 3.0, HALO),
    ));
    painter.add(Shape::closed_line(corners.to_vec(), Stroke::new(width, color)));
}

/// The number of a triangle: on a dark ground, in the colour of its part of the step.
fn paint_number(painter: &Painter, at: Pos2, number: u32, part: Option<StepPart>) {
    let (font, color) = match part {
        Some(part) => (font::strong(), color_of(part)),
        None => (font::caption(), Color32::from_gray(0xe6)),
    };
    let ground = if part.is_some() { NUMBER_DISC } else { Color32::from_black_alpha(150) };
    marks::paint_number(painter, at, number, font, color, ground);
}

fn shortest_edge([a, b, c]: &[Pos2; 3]) -> f32 {
    a.distance(*b).min(b.distance(*c)).min(c.distance(*a))
}

fn middle([a, b, c]: &[Pos2; 3]) -> Pos2 {
    pos2((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0)
}
