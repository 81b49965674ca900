//! The canvas: the mesh, what is drawn over it, and what the pointer does there.

mod gpu;
mod input;
mod marks;
mod overlay;
mod price;

use std::time::Instant;

use eframe::egui::{self, Align2, CursorIcon, Rect, Response, Sense, Ui, vec2};

pub use gpu::CanvasGpu;
pub use input::Gesture;
#[cfg(test)]
pub use marks::NUMBER_DISC;
pub use overlay::OverlayColors;

use glam::{DVec2, dvec2};

use super::background::Row;
use super::command::Command;
use super::cutting::PATIENCE;
use super::theme::tokens;
use super::tools::Tool;
use super::widgets::{Banner, BannerAnswer, bytes_row, format, hint_pill, paint_floating, progress_row};
use super::{ALL_THE_TIME, App, FRAME_BUDGET};
use crate::document::Stage;
use crate::geometry::Rect as WorldRect;
use crate::mesh::Progress;
use crate::scene::{Camera, Highlights};
use input::Pointer;

/// Free room round the domain when it is fitted, in points.
const FIT_MARGIN: f64 = 24.0;
/// More of it below, where hints are, in points.
const HINT_ROOM: f64 = 32.0;
/// Name by which tests and screen readers find the canvas.
pub const CANVAS_NAME: &str = "Mesh canvas";

impl App {
    /// The canvas with everything on it. Edits made here reach the mesh before it is drawn: it follows within the frame.
    pub(super) fn canvas_ui(&mut self, ui: &mut Ui) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, CANVAS_NAME));
        ui.painter().rect_filled(rect, 0.0, tokens(ui).canvas);
        if rect.width() < 1.0 || rect.height() < 1.0 {
            return;
        }
        self.canvas_rect = rect;
        let mut camera = self.camera_for(rect, ui.pixels_per_point());
        let mut commands = std::mem::take(&mut self.commands);
        self.follow_pointer(ui, &response, &mut camera, &mut commands);
        self.view.camera = Some(camera);
        if !commands.is_empty() {
            // The panels of this frame were drawn before.
            ui.ctx().request_repaint();
        }
        for command in commands {
            self.execute(command, ui.ctx());
        }
        // What is shown on the way would depend on the machine's speed.
        let [budget, patience] = if self.reproducible { [ALL_THE_TIME; 2] } else { [FRAME_BUDGET, PATIENCE] };
        let deadline = Instant::now() + budget;
        let cuts = self.follow_cuts(ui.ctx(), patience);
        let follows = self.session.follow(deadline);
        if self.session.price_dab(self.hovered_dab(ui, &response), deadline) || follows || cuts {
            ui.ctx().request_repaint();
        }
        // Commands may have moved the view or changed the grid.
        let camera = self.camera_for(rect, ui.pixels_per_point());
        self.view.camera = Some(camera);
        self.paint_mesh(ui, rect, camera);
        self.paint_marks(ui, &response, &camera);
        self.float_over(ui, rect);
        if let Some(pointer) = response.hover_pos() {
            let points_per_world = camera.px_per_world() as f32 / ui.pixels_per_point();
            self.show_price(ui, rect, pointer, self.tools.radius as f32 * points_per_world);
        }
    }

    /// The camera, fitted where there is none yet or the domain is another one.
    fn camera_for(&self, rect: Rect, px_per_point: f32) -> Camera {
        let size = (rect.size() * px_per_point).round();
        let size_px = [size.x as u32, size.y as u32];
        let lattice = self.session.mesh().lattice();
        let bounds = lattice.bounds();
        match self.view.camera {
            Some(camera) if camera.lattice().bounds() == bounds => {
                camera.resized(size_px).on_lattice(lattice)
            }
            _ => {
                let [margin, below] =
                    [FIT_MARGIN, HINT_ROOM].map(|points| (points * f64::from(px_per_point)).round());
                let above_hint = [size_px[0], size_px[1].saturating_sub(below as u32)];
                let fitted = Camera::fit(lattice, bounds, above_hint, margin);
                fitted.resized(size_px).panned(dvec2(0.0, -0.5 * below))
            }
        }
    }

    fn follow_pointer(
        &mut self,
        ui: &Ui,
        response: &Response,
        camera: &mut Camera,
        commands: &mut Vec<Command>,
    ) {
        let px_per_point = f64::from(ui.pixels_per_point());
        let (rect, covered, tools) = (response.rect, &self.floats[..], &self.tools);
        let first_corner = self.outline.first().copied();
        let mut pointer = Pointer { rect, camera, covered, tools, px_per_point, first_corner };
        pointer.follow_events(ui, response, &mut self.gesture, commands);
        let over = response.hover_pos().or(response.interact_pointer_pos());
        let before = self.pointer_world;
        self.pointer_world = over.map(|at| pointer.world(at));
        if self.pointer_world != before {
            // The status bar of this frame was drawn before.
            ui.ctx().request_repaint();
        }
        if response.contains_pointer() || self.gesture != Gesture::None {
            ui.ctx().set_cursor_icon(self.cursor(ui));
        }
    }

    fn cursor(&self, ui: &Ui) -> CursorIcon {
        let pans = self.tools.tool == Tool::Pan || ui.input(|input| input.key_down(egui::Key::Space));
        match self.gesture {
            Gesture::Panning { .. } => CursorIcon::Grabbing,
            _ if pans => CursorIcon::Grab,
            _ if self.tools.has_ring() => CursorIcon::None,
            _ => CursorIcon::Crosshair,
        }
    }

    fn paint_mesh(&mut self, ui: &Ui, rect: Rect, camera: Camera) {
        let change = self.session.take_mesh_change();
        let Some(gpu) = &mut self.gpu else { return };
        let settings = self.session.follower().settings();
        let colors = self.view.level_colors(settings);
        let (document, follower) = (self.session.document(), self.session.follower());
        let overlay = self.overlay_colors.overlay(self.view.overlay, document, follower, colors);
        let style = self.view.style(settings, ui.pixels_per_point());
        match gpu.sync(follower, change, overlay.as_ref(), &camera, &style) {
            Ok(Progress::Done) => {}
            Ok(Progress::More) => ui.ctx().request_repaint(),
            Err(error) => self.session.report(error),
        }
        ui.painter().add(gpu.shape(rect, camera, style));
    }

    fn paint_marks(&self, ui: &Ui, response: &Response, camera: &Camera) {
        let (rect, px_per_point) = (response.rect, ui.pixels_per_point());
        let painter = ui.painter_at(rect);
        let mesh = self.session.mesh();
        let readout = self.session.readout(self.view.quantity);
        let selected = readout.as_ref().and_then(|readout| readout.location.triangle());
        let hovering = self.tools.tool == Tool::Query && self.gesture == Gesture::None;
        let hovered = self.pointer_world.filter(|_| hovering).and_then(|p| mesh.locate(p).triangle());
        let mut highlights = selected.map_or(Highlights::default(), |id| Highlights::around(mesh, id));
        highlights.hovered = hovered.or(self.hovered_neighbour);
        marks::paint_highlights(&painter, rect, mesh, camera, &highlights, self.view.ground);
        let at = |world| marks::point_from_px(rect, camera.screen_from_world(world), px_per_point);
        if let Some(readout) = readout {
            marks::paint_point(&painter, at(readout.point));
        }
        if self.tools.tool == Tool::Domain {
            let screen = camera.screen_map();
            let at = |world| marks::point_from_px(rect, screen(world), px_per_point);
            self.paint_outlines(&painter, &at, response.hover_pos());
        }
        if let Gesture::Framing { from, to, .. } = self.gesture {
            marks::paint_frame(&painter, Rect::from_two_pos(from, to));
        }
        if let Some(pointer) = response.hover_pos().filter(|_| self.tools.has_ring()) {
            let points_per_world = camera.px_per_world() as f32 / px_per_point;
            self.paint_brush(ui, &painter, pointer, self.last_painted.map(at), points_per_world);
        }
    }

    /// The outline of the domain, and the polygon that is being set.
    fn paint_outlines(
        &self,
        painter: &egui::Painter,
        at: &impl Fn(DVec2) -> egui::Pos2,
        pointer: Option<egui::Pos2>,
    ) {
        if let Some(region) = self.session.document().settings().domain.region() {
            for ring in region.rings() {
                marks::paint_outline(painter, ring.iter().map(|&corner| at(corner)));
            }
        }
        for cut_shape in self.cutter.cut_shapes() {
            marks::paint_stencil(painter, cut_shape, at);
        }
        let corners: Vec<egui::Pos2> = self.outline.iter().map(|&corner| at(corner)).collect();
        marks::paint_open_polygon(painter, &corners, pointer);
    }

    /// The ring of the brush, and with Shift held the line that a click would paint from `last`.
    fn paint_brush(
        &self,
        ui: &Ui,
        painter: &egui::Painter,
        pointer: egui::Pos2,
        last: Option<egui::Pos2>,
        points_per_world: f32,
    ) {
        if let Gesture::Sizing { from, dragged: true, .. } = self.gesture {
            return marks::paint_brush_ring(painter, from, &self.tools, points_per_world);
        }
        if let Some(last) = last
            && self.tools.paints()
            && ui.input(|input| input.modifiers.shift)
        {
            marks::paint_line_preview(painter, last, pointer);
        }
        marks::paint_brush_ring(painter, pointer, &self.tools, points_per_world);
    }

    /// Message, progress and hint, over the canvas.
    fn float_over(&mut self, ui: &mut Ui, rect: Rect) {
        let inner = rect.shrink(12.0);
        self.floats.clear();
        self.show_notice(ui, inner);
        let works = self.show_progress(ui, inner);
        let hints = self.hints.for_tool(self.tools.tool, self.tools.kind);
        // In a small window there is no room for both below.
        if !hints.is_empty() && !works && self.session.notice().is_none() {
            hint_pill(ui, inner.left_bottom(), Align2::LEFT_BOTTOM, inner, hints);
        }
    }

    fn show_notice(&mut self, ui: &mut Ui, inner: Rect) {
        let Some(notice) = self.session.notice().cloned() else { return };
        let width = inner.width().min(640.0);
        let place =
            Rect::from_center_size(egui::pos2(inner.center().x, inner.top() + 40.0), vec2(width, 80.0));
        let mut child = ui.new_child(egui::UiBuilder::new().max_rect(place));
        let banner = if notice.failed { Banner::error(&notice.text) } else { Banner::info(&notice.text) };
        let stands = self.session.notice_stands();
        let banner = if stands { banner.standing().action("Undo") } else { banner };
        let answer = banner.show(&mut child);
        self.floats.push(child.min_rect());
        match answer {
            BannerAnswer::Open => {}
            BannerAnswer::Acted => {
                self.commands.push(Command::Undo);
                ui.ctx().request_repaint();
            }
            BannerAnswer::Dismissed => self.session.set_notice(None),
        }
    }

    /// How far each work is, once it has taken longer than a moment: that on the mesh lowest, then that on files. Tells whether any is
    /// shown.
    fn show_progress(&mut self, ui: &mut Ui, inner: Rect) -> bool {
        let size = vec2(inner.width().min(360.0), 36.0);
        let first = Rect::from_min_size(inner.right_bottom() - size, size);
        let mut place = first;
        let above = |place: Rect| place.translate(vec2(0.0, -size.y - 8.0));
        let on_mesh = self.work_on_mesh();
        let long = self.busy.is_long(on_mesh.is_some());
        if let Some((what, done)) = on_mesh.filter(|_| long) {
            if progress_row(&mut self.card(ui, place), what, &done) {
                self.cancel_update();
            }
            place = above(place);
        }
        for Row { id, what, meter } in self.background.rows(self.project.is_leaving()) {
            if bytes_row(&mut self.card(ui, place), &what, meter.done(), meter.total()) {
                self.cancel_work(id);
            }
            place = above(place);
        }
        place != first
    }

    /// What is being done to bring the mesh up to date, and how far it is.
    fn work_on_mesh(&self) -> Option<(&'static str, String)> {
        match self.session.stage() {
            _ if !self.cutter.is_idle() => Some(("Cutting the outline", String::new())),
            Stage::Refining { triangles } => {
                Some(("Refining", format!("{} triangles", format::count(triangles as u64))))
            }
            Stage::Copying { triangles } => {
                Some(("Copying the mesh", format!("{} triangles", format::count(triangles as u64))))
            }
            Stage::Indexing => Some(("Indexing the outline", String::new())),
            Stage::Sampling => Some(("Sampling the field", String::new())),
            Stage::InStep | Stage::GaveUp(_) => None,
        }
    }

    /// A ground over the canvas for a row of widgets, which takes the clicks there.
    fn card(&mut self, ui: &mut Ui, place: Rect) -> Ui {
        self.floats.push(place);
        paint_floating(ui, place);
        let row =
            place.with_min_x(place.left() + 12.0).with_max_x(place.right() - 4.0).shrink2(vec2(0.0, 4.0));
        ui.new_child(egui::UiBuilder::new().max_rect(row))
    }

    /// Where a point of the world is on the screen, once there was a frame.
    pub fn on_screen(&self, world: DVec2) -> Option<egui::Pos2> {
        let (camera, rect) = (self.view.camera?, self.canvas_rect);
        let px_per_point = camera.size_px()[0] as f32 / rect.width();
        Some(marks::point_from_px(rect, camera.screen_from_world(world), px_per_point))
    }

    /// The part of the world on the canvas.
    pub fn visible_world(&self) -> Option<WorldRect> {
        self.view.camera.map(|camera| camera.visible_world())
    }
}
