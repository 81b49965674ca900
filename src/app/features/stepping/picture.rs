//! The mesh at a step, on the canvas.

use std::collections::HashMap;

use eframe::egui::{Color32, Mesh, Painter, Pos2, Rect, Response, Shape, Stroke, Ui};

use glam::DVec2;

use super::Steps;
use super::letters::{LabelKind, PlacedLabels, StepLabel};
use super::steps::names_of;
use crate::app::features::stepping::Stepping;
use meshbrush_kit::kit::marks::point_from_px;
use meshbrush_kit::kit::{FrameState, marks};
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_render::colormap::{Ground, LevelColors};
use meshbrush_render::scene::Camera;
use meshbrush_ui::theme::tokens;

use meshbrush_study::report::ReportFigure;
use meshbrush_study::steps::{MOST_AVOIDED, Marked, NamedPlace, StepPart, StepPlayer, StepTriangle};

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
/// Room for hints and the scale bar at the bottom of the canvas, in points: labels stay above it.
const ROOM_BELOW: f32 = 52.0;
/// The colour of numbers of triangles that the step is not about.
const QUIET: Color32 = Color32::from_gray(0xe6);
/// Width of the outline of a triangle of the step over its shortest edge.
const LINE_SHARE: f32 = 0.06;
/// Width of the outline of the domain, in points.
const OUTLINE: f32 = 1.0;
/// A line over the colours of levels: a bright one on a dark one.
const HALO: Color32 = Color32::from_black_alpha(0xf0);

/// Returns the colour of a triangle of the step, visible on any level.
fn color_of(part: StepPart) -> Color32 {
    let [across, waiting, relinked] = Ground::ON_LEVELS.map(|[r, g, b]| Color32::from_rgb(r, g, b));
    match part {
        StepPart::Waiting => waiting,
        StepPart::Relinked | StepPart::Removed => relinked,
        StepPart::Across => across,
        StepPart::Current => Color32::WHITE,
    }
}

/// Draws the mesh at the step that is shown, on the canvas, with the letters of the figure of the report that
/// is shown beside it.
pub fn paint(ui: &Ui, response: &Response, state: &FrameState<'_>, figure: Option<ReportFigure>) {
    let player = state.feature::<Stepping>().steps().and_then(Steps::player);
    let (Some(player), Some(camera)) = (player, state.view.camera) else { return };
    let colors = state.view.level_colors(state.session.follower().settings());
    let marked = player.marked();
    let places = Places::new(ui, response.rect, &camera, player, &marked);
    let painter = &ui.painter_at(response.rect);
    places.paint_triangles(painter, &colors);
    paint_outline(ui, painter, response.rect, &camera, state);
    marked.iter().for_each(|one| places.paint_marked(painter, one));
    places.paint_moves(painter, player);
    places.labels(painter, player, &marked, figure).paint(painter);
    if response.contains_pointer() {
        ui.ctx().set_cursor_icon(state.tools.tool.cursor);
    }
}

/// Draws the outline of the domain.
fn paint_outline(ui: &Ui, painter: &Painter, rect: Rect, camera: &Camera, state: &FrameState<'_>) {
    let Some(region) = state.session.follower().settings().outline() else { return };
    let px_per_point = ui.pixels_per_point();
    let place = |&corner: &DVec2| point_from_px(rect, camera.screen_from_world(corner), px_per_point);
    for ring in region.polygons().iter().flatten() {
        let closed = ring.iter().chain(ring.first()).map(place);
        marks::paint_rimmed_line(painter, closed, tokens(ui).accent, OUTLINE);
    }
}

/// The triangles, and the positions of lattice points on the screen, in points.
struct Places<'a> {
    rect: Rect,
    camera: &'a Camera,
    px_per_point: f32,
    nodes: Vec<Pos2>,
    triangles: Vec<StepTriangle>,
    /// The triangles that the step is about, by number.
    parts: HashMap<u32, StepPart>,
}

impl<'a> Places<'a> {
    fn new(ui: &Ui, rect: Rect, camera: &'a Camera, player: &StepPlayer, marked: &[Marked]) -> Self {
        let triangles = player.triangles().collect();
        let px_per_point = ui.pixels_per_point();
        let parts = marked.iter().map(|one| (one.number, one.part)).collect();
        let mut places = Self { rect, camera, px_per_point, nodes: Vec::new(), triangles, parts };
        places.nodes = player.nodes().iter().map(|&node| places.on_screen(node)).collect();
        places
    }

    fn on_screen(&self, point: LatticePoint) -> Pos2 {
        point_from_px(self.rect, self.camera.screen_from_lattice(point), self.px_per_point)
    }

    fn corners(&self, triangle: &StepTriangle) -> [Pos2; 3] {
        triangle.nodes.map(|node| self.nodes[node as usize - 1])
    }

    fn is_visible(&self, corners: &[Pos2; 3]) -> bool {
        Rect::from_points(corners).intersects(self.rect)
    }

    fn paint_triangles(&self, painter: &Painter, colors: &LevelColors) {
        let (mut fills, mut edges) = (Mesh::default(), Vec::new());
        let line = Stroke::new(1.0, EDGE);
        for triangle in &self.triangles {
            let corners = self.corners(triangle);
            if !self.is_visible(&corners) {
                continue;
            }
            let [r, g, b, _] = colors.of(triangle.level);
            let first = fills.vertices.len() as u32;
            corners.iter().for_each(|&corner| fills.colored_vertex(corner, Color32::from_rgb(r, g, b)));
            fills.add_triangle(first, first + 1, first + 2);
            edges.push(Shape::closed_line(corners.to_vec(), line));
        }
        painter.add(Shape::mesh(fills));
        painter.extend(edges);
    }

    /// Draws the colour of a part of the step over its triangle.
    fn paint_marked(&self, painter: &Painter, marked: &Marked) {
        let corners = marked.corners.map(|corner| self.on_screen(corner));
        if !self.is_visible(&corners) {
            return;
        }
        let color = color_of(marked.part);
        let widest = if marked.part == StepPart::Current { 2.5 } else { 2.0 };
        // Lines that cover small triangles would hide what they show.
        let width = (LINE_SHARE * shortest_edge(&corners)).clamp(0.5, widest);
        let rim = Stroke::new(width * (1.0 + 3.0 / widest), HALO);
        painter.add(Shape::convex_polygon(corners.to_vec(), color.gamma_multiply(0.25), rim));
        painter.add(Shape::closed_line(corners.to_vec(), Stroke::new(width, color)));
    }

    /// Draws a line from the former place of each node that the step moved, with a dot where it is now.
    fn paint_moves(&self, painter: &Painter, player: &StepPlayer) {
        for ends in player.moves() {
            let [from, to] = ends.map(|end| self.on_screen(end));
            if self.rect.contains(to) {
                painter.line_segment([from, to], Stroke::new(3.5, HALO));
                painter.line_segment([from, to], Stroke::new(1.5, Color32::WHITE));
                painter.circle(to, 2.5, Color32::WHITE, Stroke::new(1.0, HALO));
            }
        }
    }

    /// Finds room for the names that text, data and code of the step use and those of the figure, and then
    /// for numbers.
    fn labels(
        &self,
        painter: &Painter,
        player: &StepPlayer,
        marked: &[Marked],
        figure: Option<ReportFigure>,
    ) -> PlacedLabels {
        let names = names_of(player, figure);
        let name = |(place, text): (NamedPlace, String)| {
            let corners: Vec<Pos2> =
                player.points_of(place).into_iter().map(|point| self.on_screen(point)).collect();
            let part = match place {
                NamedPlace::Triangle(number) => self.parts.get(&number),
                _ => None,
            };
            let color = part.map_or(Color32::WHITE, |part| color_of(*part));
            StepLabel { corners, text, color, kind: LabelKind::Name }
        };
        let mut labels: Vec<StepLabel> = names.labels().map(name).collect();
        let named: Vec<NamedPlace> = names.labels().map(|(place, _)| place).collect();
        let mut numbers = self.triangle_numbers(&named);
        numbers.extend(self.node_numbers(&named));
        numbers.sort_by_key(|(is_of_step, _)| !is_of_step);
        labels.extend(numbers.into_iter().map(|(_, label)| label));
        let is_about = |one: &&Marked| !matches!(one.part, StepPart::Waiting | StepPart::Removed);
        let corners = |one: &Marked| one.corners.map(|corner| self.on_screen(corner));
        let avoided: Vec<_> = marked.iter().rev().filter(is_about).take(MOST_AVOIDED).map(corners).collect();
        let area = self.rect.with_max_y((self.rect.bottom() - ROOM_BELOW).max(self.rect.top()));
        PlacedLabels::new(painter, area, labels, &avoided)
    }

    /// Numbers the nodes between large triangles, and those of the triangles of the step, which the panel
    /// names. Returns with each number whether the step is about it.
    fn node_numbers(&self, named: &[NamedPlace]) -> Vec<(bool, StepLabel)> {
        let mut has_room = vec![false; self.nodes.len()];
        let mut is_of_step = has_room.clone();
        let set = |marks: &mut Vec<bool>, triangle: &StepTriangle, to: bool| {
            triangle.nodes.into_iter().for_each(|node| marks[node as usize - 1] = to);
        };
        self.triangles.iter().for_each(|triangle| set(&mut has_room, triangle, true));
        for triangle in &self.triangles {
            if shortest_edge(&self.corners(triangle)) < NUMBERED_NODE {
                set(&mut has_room, triangle, false);
            }
        }
        for triangle in self.triangles.iter().filter(|one| self.parts.contains_key(&one.number)) {
            if shortest_edge(&self.corners(triangle)) >= NUMBERED_NODE_OF_STEP {
                set(&mut is_of_step, triangle, true);
            }
        }
        let label = |(node, &at): (usize, &Pos2)| {
            let is_shown = (has_room[node] || is_of_step[node])
                && self.rect.contains(at)
                && !named.contains(&NamedPlace::Node(node as u32 + 1));
            let (text, color) = ((node + 1).to_string(), Color32::WHITE);
            let label = StepLabel { corners: vec![at], text, color, kind: LabelKind::Node };
            is_shown.then_some((is_of_step[node], label))
        };
        self.nodes.iter().enumerate().filter_map(label).take(MOST_NUMBERS).collect()
    }

    /// Numbers the triangles that are large enough. Returns with each number whether the step is about it.
    fn triangle_numbers(&self, named: &[NamedPlace]) -> Vec<(bool, StepLabel)> {
        let label = |triangle: &StepTriangle| {
            let corners = self.corners(triangle);
            let part = self.parts.get(&triangle.number).copied();
            let needed = if part.is_some() { NUMBERED_LEG_OF_STEP } else { NUMBERED_LEG };
            let is_shown = shortest_edge(&corners) >= needed
                && self.is_visible(&corners)
                && !named.contains(&NamedPlace::Triangle(triangle.number));
            let (text, color) = (triangle.number.to_string(), part.map_or(QUIET, color_of));
            let kind = if part.is_some() { LabelKind::OfStep } else { LabelKind::Triangle };
            let label = StepLabel { corners: corners.to_vec(), text, color, kind };
            is_shown.then_some((part.is_some(), label))
        };
        self.triangles.iter().filter_map(label).take(MOST_NUMBERS).collect()
    }
}

fn shortest_edge([a, b, c]: &[Pos2; 3]) -> f32 {
    a.distance(*b).min(b.distance(*c)).min(c.distance(*a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    #[test]
    fn the_shortest_edge_does_not_depend_on_the_order_of_corners() {
        let [a, b, c] = [pos2(0.0, 0.0), pos2(3.0, 0.0), pos2(0.0, 6.0)];
        for corners in [[a, b, c], [b, c, a], [c, a, b], [c, b, a]] {
            assert_eq!(shortest_edge(&corners), 3.0, "{corners:?}");
        }
    }
}
