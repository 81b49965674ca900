//! The mesh in space on the canvas, and what is drawn over it.

use eframe::egui::{
    Align2, Color32, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, Ui, WidgetInfo,
};
use glam::DVec2;

use super::{Canvas, price};
use meshbrush_core::paint::Mirror;
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_kit::kit::heights::{Heights, SpaceSight};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::View;
use meshbrush_kit::kit::{FrameState, OverMesh, Tool, marks};
use meshbrush_mesh::geometry::Rect as WorldRect;
use meshbrush_mesh::mesh::{Progress, TriangleId};
use meshbrush_render::colormap::Ground;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::Hint::{Key, KeyOf, Text};
use meshbrush_ui::widgets::{format, hint_pill};

/// Greatest length of a straight piece of a line on a surface, in points.
const STRAIGHT: f32 = 6.0;
/// Corners of the brush ring on a surface.
const RING_CORNERS: u32 = 72;
/// Straight pieces of the line of a mirror on a surface.
const MIRROR_PIECES: u32 = 200;

/// Returns the view in space with the surface that it shows; `None` in the plan, and until heights are known.
pub fn space_sight<'a>(view: &View, session: &'a Session) -> Option<SpaceSight<'a>> {
    let camera = view.space_view()?.camera;
    match session.heights() {
        Heights::Known(surface) => Some(SpaceSight { camera, surface }),
        Heights::Sought | Heights::Missing => None,
    }
}

/// Says that a tool is of no use in space.
pub fn only_in_plan(tool: Tool) -> String {
    format!("{} works in the plan: Esc, or View → In space, goes back to it.", tool.name)
}

impl Canvas {
    /// Sends the changes of the mesh to the GPU, and draws it in space.
    pub fn draw_in_space(
        &mut self,
        ui: &Ui,
        session: &mut Session,
        view: &View,
        commands: &mut Vec<Command>,
    ) {
        let change = session.take_shown_change();
        let (Some(gpu), Some((_, rect))) = (&mut self.gpu, self.shown) else { return self.draw_ground(ui) };
        let seen = view.space_view();
        let style = view.style(session.follower().settings(), 0, ui.pixels_per_point());
        let style = meshbrush_render::scene::Style { fill_opacity: 1.0, ..style };
        let surface = match session.heights() {
            Heights::Known(surface) => Some(surface),
            Heights::Sought | Heights::Missing => None,
        };
        let sent = gpu.sync_in_space(session, change, surface, seen.as_ref().map(|view| (view, &style)));
        match sent {
            Ok(Progress::Done) => {}
            Ok(Progress::More) => ui.ctx().request_repaint(),
            Err(error) => commands.push(Command::from(ShellCommand::Report(error.to_string()))),
        }
        if let (Some(surface), Some(seen)) = (surface, seen) {
            let can_redraw = surface.is_current() && gpu.has_mesh(session);
            ui.painter().add(gpu.shape_in_space(rect, seen, style, can_redraw));
            return;
        }
        self.draw_ground(ui);
    }

    /// Draws what [`Self::draw_marks`] draws, on the surface.
    pub fn draw_marks_in_space(&self, ui: &mut Ui, response: &Response, state: &FrameState<'_>) {
        let Some(sight) = space_sight(state.view, state.session) else {
            return show_lack(ui, response.rect, state.session);
        };
        let (rect, px_per_point) = (response.rect, ui.pixels_per_point());
        let painter = ui.painter_at(rect);
        let on_screen = |world| marks::point_from_px(rect, sight.screen(world), px_per_point);
        self.paint_triangles(&painter, state, &on_screen);
        if let Some(readout) = state.readout {
            marks::paint_point(&painter, on_screen(readout.point));
        }
        let pointer = response.hover_pos();
        let px_per_world = sight.camera.plan().px_per_world();
        let straight = Some(f64::from(STRAIGHT * px_per_point) / px_per_world);
        let over = OverMesh {
            ui,
            canvas: rect,
            painter: &painter,
            screen_from_world: &on_screen,
            straight,
            pointer,
        };
        Self::paint_marks_below(state, &over);
        self.paint_marks(state, &over);
        if let Some(mirror) = state.stroke_mirror() {
            let bounds = state.session.document().settings().domain.bounds;
            paint_mirror_lines(&over, &sight, &mirror, bounds);
        }
        if let (Some(pointer), Some(world)) = (pointer, state.pointer)
            && state.tools.tool.in_space
        {
            self.paint_ring(ui, state, &over, &sight, (pointer, world));
            let radius = state.tools.radius * px_per_world;
            price::show(ui, state, (rect, &self.floats), pointer, radius as f32 / px_per_point);
        }
        if response.contains_pointer() || self.gesture.is_some() {
            ui.ctx().set_cursor_icon(self.cursor(ui.ctx(), state.tools));
        }
        // A message is more important.
        if state.session.notices().shown().is_none() {
            ui.push_id("view in space", |ui| show_keys(ui, rect.shrink(12.0), state));
        }
    }

    /// The triangle under the pointer, the queried one and its neighbours.
    fn paint_triangles(&self, painter: &Painter, state: &FrameState<'_>, on_screen: &dyn Fn(DVec2) -> Pos2) {
        let highlights = self.highlights(state);
        let mesh = state.session.view();
        let outline = |id: TriangleId, fill: Color32, line: Stroke| {
            let corners = mesh.world_corners(id).map(on_screen).to_vec();
            painter.add(Shape::convex_polygon(corners, fill, line));
        };
        for (neighbour, [r, g, b]) in highlights.neighbours.iter().zip(Ground::ON_LEVELS) {
            if let Some(id) = *neighbour {
                outline(id, Color32::TRANSPARENT, Stroke::new(1.5, Color32::from_rgb(r, g, b)));
            }
        }
        if let Some(id) = highlights.hovered {
            outline(id, Color32::from_white_alpha(28), Stroke::new(1.0, Color32::from_white_alpha(170)));
        }
        if let Some(id) = highlights.selected {
            outline(id, Color32::from_white_alpha(40), Stroke::new(2.0, Color32::WHITE));
        }
    }

    /// The brush ring and its mirror images, draped on the surface.
    fn paint_ring(
        &self,
        ui: &Ui,
        state: &FrameState<'_>,
        over: &OverMesh<'_>,
        sight: &SpaceSight<'_>,
        (pointer, world): (Pos2, DVec2),
    ) {
        let tools = state.tools;
        if !tools.has_ring() {
            return;
        }
        if self.is_picking(ui.ctx(), tools) {
            return marks::paint_eyedropper(over.painter, pointer);
        }
        if let Some(mirror) = state.stroke_mirror() {
            for image in mirror.images(world).skip(1) {
                paint_loop(over, sight, (image, tools.radius), [2.5, 1.0], 0.5);
            }
        }
        paint_loop(over, sight, (world, tools.radius), [3.5, 1.5], 1.0);
        if tools.hardness > 0.0 {
            paint_loop(over, sight, (world, tools.radius * tools.hardness), [2.0, 1.0], 1.0);
        }
    }
}

/// Draws a ring on the surface: a bright line on a dark one, with these widths in points. The middle and the
/// radius are in world units.
fn paint_loop(
    over: &OverMesh<'_>,
    sight: &SpaceSight<'_>,
    (middle, radius): (DVec2, f64),
    widths: [f32; 2],
    opacity: f32,
) {
    let corners = (0..=RING_CORNERS).map(|n| {
        let angle = std::f64::consts::TAU * f64::from(n) / f64::from(RING_CORNERS);
        middle + radius * DVec2::from_angle(angle)
    });
    paint_draped(over, sight, corners, widths, opacity);
}

/// Draws a line through points in world units on the surface; faint where the surface hides it.
fn paint_draped(
    over: &OverMesh<'_>,
    sight: &SpaceSight<'_>,
    points: impl Iterator<Item = DVec2>,
    widths: [f32; 2],
    opacity: f32,
) {
    let places: Vec<_> =
        points.map(|point| ((over.screen_from_world)(point), sight.is_hidden(point))).collect();
    for pair in places.windows(2) {
        let [(from, hidden), (to, also_hidden)] = [pair[0], pair[1]];
        let [dark, bright] = if hidden || also_hidden { [30.0, 60.0] } else { [130.0, 255.0] };
        let line = |width, color| over.painter.line_segment([from, to], Stroke::new(width, color));
        line(widths[0], Color32::from_black_alpha((dark * opacity) as u8));
        line(widths[1], Color32::from_white_alpha((bright * opacity) as u8));
    }
}

/// Draws the lines in which strokes are repeated, across the domain.
fn paint_mirror_lines(over: &OverMesh<'_>, sight: &SpaceSight<'_>, mirror: &Mirror, bounds: WorldRect) {
    let (min, max) = (bounds.min, bounds.max);
    let vertical = mirror.x.map(|x| [DVec2::new(x, min.y), DVec2::new(x, max.y)]);
    let horizontal = mirror.y.map(|y| [DVec2::new(min.x, y), DVec2::new(max.x, y)]);
    for [from, to] in [vertical, horizontal].into_iter().flatten() {
        let points = (0..=MIRROR_PIECES).map(|n| from.lerp(to, f64::from(n) / f64::from(MIRROR_PIECES)));
        paint_draped(over, sight, points, [2.5, 1.0], 0.4);
    }
}

/// Says by how much heights are exaggerated, and how the view is moved.
fn show_keys(ui: &Ui, inner: Rect, state: &FrameState<'_>) {
    let factor = state.view.space.factor(state.session.mesh().lattice());
    let factor = format!("Heights × {}", format::digits(factor, 3));
    let hints = [
        Text(&factor),
        Key("Space"),
        Text("drag or middle-drag turns"),
        Key("Shift"),
        Text("pans"),
        KeyOf("fit-domain"),
        Text("fits"),
        KeyOf("in-space"),
        Text("plan"),
    ];
    hint_pill(ui, inner.left_top(), Align2::LEFT_TOP, inner, &hints);
}

/// Says why there is nothing to see.
fn show_lack(ui: &Ui, rect: Rect, session: &Session) {
    let sentence = match session.heights() {
        Heights::Missing => {
            "There are no heights to show in space. Add a layer of a surface, or depths of water (Layers → Add)."
        }
        Heights::Known(_) | Heights::Sought => "Finding the heights of the mesh…",
    };
    let place = Rect::from_center_size(rect.center(), rect.size() / 2.0);
    let label = ui.interact(place, ui.scope_id().with("no heights"), Sense::hover());
    label.widget_info(|| WidgetInfo::labeled(Role::Label, true, sentence));
    let text = ui.painter().layout(sentence.into(), font::body(), tokens(ui).value, place.width());
    let corner = rect.center() - text.size() / 2.0;
    ui.painter_at(rect).galley(corner, text, tokens(ui).value);
}
