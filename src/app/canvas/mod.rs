//! The canvas: the mesh, what is drawn over it, and gestures of the pointer on it.

mod contours;
mod coordinates;
mod floats;
mod gpu;
mod graticule;
mod legend;
mod level_legend;
mod menu;
mod navigation;
mod overlay;
mod overlay_data;
mod overlay_legend;
mod overlay_picture;
mod press;
mod price;
mod quality_colors;
mod relief_colors;
mod space;
mod toast;
mod way_back;

use eframe::egui::{self, Context, CursorIcon, Event, Id, Key, Popup, Rect, Response, Sense, Ui};
use glam::DVec2;

pub use gpu::{CanvasGpu, canvas_image};
use meshbrush_render::colormap::overlay_palette::OverlayPalette;
use overlay::OverlayColors;
pub use overlay_picture::overlay_of_picture;
use press::{begin_gesture, pen_pressure, pointer_over};
pub use space::space_sight;
pub use toast::Toast;

use super::contours::ContourFinder;
use super::features::ROWS;
use super::features::painting::picks;
use super::features::picture::BackgroundTexture;
use super::parts::{WindowPart, mark};
use super::software_window::SoftwareWindow;
use meshbrush_core::paint::StrokePlan;
use meshbrush_kit::kit::busy::Busy;
use meshbrush_kit::kit::command::{BrushCommand, Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::jobs::Jobs;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::tools::{PAN, Tools};
use meshbrush_kit::kit::view::View;
use meshbrush_kit::kit::{FrameState, Gesture, OverMesh, Pointer, Press, marks};
use meshbrush_mesh::geometry::{Lattice, Rect as WorldRect};
use meshbrush_mesh::mesh::Progress;
use meshbrush_render::scene::Highlights;
use meshbrush_ui::theme::tokens;

/// Name by which tests and screen readers find the canvas.
pub const CANVAS_NAME: &str = "Mesh canvas";

/// The state that the canvas keeps from frame to frame.
pub struct Canvas {
    gpu: Option<CanvasGpu>,
    jobs: Jobs,
    overlay_colors: OverlayColors,
    background: BackgroundTexture,
    contours: ContourFinder,
    /// The widget of the last frame, and where it was.
    shown: Option<(Id, Rect)>,
    /// The rectangles of the floating widgets in the last frame that take clicks.
    floats: Vec<Rect>,
    gesture: Option<Box<dyn Gesture>>,
    pointer: Option<DVec2>,
    mesh_work: Busy,
    /// What the last key did, if it changed the tool.
    toast: Option<Toast>,
}

impl Canvas {
    /// Creates a canvas. Without `gpu` it stays empty.
    pub fn new(gpu: Option<CanvasGpu>, jobs: &Jobs) -> Self {
        Self {
            gpu,
            jobs: jobs.clone(),
            overlay_colors: OverlayColors::default(),
            background: BackgroundTexture::default(),
            contours: ContourFinder::default(),
            shown: None,
            floats: Vec::new(),
            gesture: None,
            pointer: None,
            mesh_work: Busy::default(),
            toast: None,
        }
    }

    /// Returns what is left when another document is opened: the place of the canvas, and what draws it.
    pub fn for_next_document(self) -> Self {
        let Self { gpu, jobs, shown, floats, .. } = self;
        Self { shown, floats, ..Self::new(gpu, &jobs) }
    }

    /// Draws in software from now on.
    pub fn draw_in_software(&mut self) {
        if let Some(gpu) = &mut self.gpu {
            gpu.draw_in_software();
        }
    }

    /// Returns whether no GPU draws the mesh, so that drawing and everything else share the cores.
    pub fn draws_in_software(&self) -> bool {
        self.gpu.as_ref().is_some_and(CanvasGpu::draws_in_software)
    }

    /// Readies a window that is drawn in software, where the mesh is.
    pub fn software_window(&mut self) -> Option<SoftwareWindow> {
        self.gpu.as_mut()?.leave_to_software_window().map(|state| SoftwareWindow::new(state, canvas_image))
    }

    /// Returns the position of the pointer, in world units, while it is on the canvas or in a gesture.
    pub fn pointer(&self) -> Option<DVec2> {
        self.pointer
    }

    /// Returns where the canvas was in the last frame, in points.
    pub fn rect(&self) -> Option<Rect> {
        self.shown.map(|(_, rect)| rect)
    }

    /// Returns the widget of the canvas, once it was shown.
    pub fn id(&self) -> Option<Id> {
        self.shown.map(|(id, _)| id)
    }

    /// Says what a key did, for a moment.
    pub fn tell(&mut self, toast: Toast) {
        self.toast = Some(toast);
    }

    /// Ends a gesture that Escape ends. Returns whether there was one.
    pub fn end_gesture_on_escape(&mut self) -> bool {
        self.gesture.take_if(|gesture| gesture.ends_on_escape()).is_some()
    }

    /// Notes what floats over the canvas and takes clicks there.
    pub fn note_floats(&mut self, places: Vec<Rect>) {
        self.floats = places;
    }

    /// Notes whether there is work on the mesh.
    pub fn note_work(&mut self, session: &Session) {
        self.mesh_work.note(floats::work_on_mesh(session).is_some());
    }
}

/// Input.
impl Canvas {
    /// Turns an event into commands. The canvas is where it was in the last frame.
    pub fn take_event(
        &mut self,
        event: &Event,
        ctx: &Context,
        view: &mut View,
        tools: &Tools,
        session: &Session,
        commands: &mut Vec<Command>,
    ) {
        let Some(pointer) = self.pointer_on(ctx, view, tools, session) else { return };
        match *event {
            Event::PointerButton { pos, button, pressed: true, modifiers }
                if self.gesture.is_none() && self.is_free_at(ctx, pos) && ctx.multi_touch().is_none() =>
            {
                self.gesture = begin_gesture(ctx, Press { at: pos, modifiers }, button, &pointer, commands);
            }
            Event::PointerMoved(pos) => {
                if let Some(gesture) = &mut self.gesture {
                    gesture.moved(pos, &pointer, commands);
                }
            }
            Event::PointerButton { pos, button, pressed: false, .. } => {
                if let Some(gesture) = self.gesture.take_if(|gesture| gesture.button() == button) {
                    gesture.released(pos, &pointer, commands);
                }
            }
            Event::Touch { phase, force, .. } => {
                if ctx.multi_touch().is_some() {
                    self.give_way_to_fingers(session, commands);
                }
                commands.extend(pen_pressure(phase, force).map(BrushCommand::Pen).map(Command::from));
            }
            Event::WindowFocused(false) => self.interrupt(commands),
            _ => {}
        }
    }

    /// Handles what is no single event, after the events of the frame: the wheel, where the pointer is, and
    /// a button that was released outside the window.
    pub fn take_state(
        &mut self,
        ctx: &Context,
        view: &mut View,
        tools: &Tools,
        session: &Session,
        commands: &mut Vec<Command>,
    ) {
        let Some(mut pointer) = self.pointer_on(ctx, view, tools, session) else { return };
        let Some(response) = self.shown.and_then(|(id, _)| ctx.read_response(id)) else { return };
        if !ctx.input(|input| input.pointer.any_down()) {
            self.interrupt(commands);
        }
        if let Some(fingers) = ctx.multi_touch() {
            navigation::by_fingers(&fingers, &mut pointer, commands);
        } else if response.contains_pointer() {
            navigation::zoom(ctx, &mut pointer, commands);
        }
        commands.extend(navigation::movement(ctx, response.id).map(ViewCommand::Pan).map(Command::from));
        let at = response.hover_pos().or(response.interact_pointer_pos());
        self.pointer = at.map(|at| pointer.world(at));
    }

    fn pointer_on<'a>(
        &self,
        ctx: &Context,
        view: &mut View,
        tools: &'a Tools,
        session: &'a Session,
    ) -> Option<Pointer<'a>> {
        let (_, rect) = self.shown?;
        navigation::fit_camera(view, session.mesh().lattice(), rect, ctx.pixels_per_point());
        pointer_over(ctx, rect, view, tools, session)
    }

    /// Returns whether a press at `pos`, in points, meets the canvas and nothing over it. egui knows this
    /// only for the place where the pointer is at the end of the frame.
    fn is_free_at(&self, ctx: &Context, pos: egui::Pos2) -> bool {
        let Some((id, rect)) = self.shown else { return false };
        let handle = ctx.global_style().interaction.resize_grab_radius_side;
        let on_top = ctx.read_response(id).map(|response| response.layer_id) == ctx.layer_id_at(pos);
        let covered = self.floats.iter().any(|float| float.contains(pos));
        // A press beside an open menu only closes it.
        on_top && rect.shrink(handle).contains(pos) && !covered && !Popup::is_any_open(ctx)
    }

    /// A second finger came: what the first one began is a movement of the view. Its stroke is taken back.
    fn give_way_to_fingers(&mut self, session: &Session, commands: &mut Vec<Command>) {
        let Some(gesture) = self.gesture.take() else { return };
        if session.document().stroke().is_some() {
            commands.push(Command::from(ShellCommand::Escape));
        } else {
            gesture.interrupted(commands);
        }
    }

    /// Ends the gesture where it is.
    fn interrupt(&mut self, commands: &mut Vec<Command>) {
        if let Some(gesture) = self.gesture.take() {
            gesture.interrupted(commands);
        }
    }

    /// Returns the stroke that a click would paint at the pointer: a dab, or with Shift a line from the last
    /// painted point. None where a click does something else.
    pub fn planned_stroke(&self, ctx: &Context, tools: &Tools, bounds: WorldRect) -> Option<StrokePlan> {
        let (brush, to) = tools.brush().zip(self.pointer)?;
        let (id, _) = self.shown?;
        let at = ctx.read_response(id)?.hover_pos()?;
        let is_free = self.gesture.is_none() && !self.floats.iter().any(|float| float.contains(at));
        let (shift, paints) = ctx.input(|input| {
            let paints = !picks(input.modifiers) && !input.key_down(Key::Space) && !input.pointer.any_down();
            (input.modifiers.shift, paints)
        });
        let from = tools.last_painted.filter(|_| shift).unwrap_or(to);
        (is_free && paints).then(|| StrokePlan { brush, mirror: tools.mirror(bounds), from, to })
    }
}

/// Drawing.
impl Canvas {
    /// Takes the space that is left for the canvas, and fits the camera to it. Returns `None` where there is
    /// no room to draw.
    pub fn layout(&mut self, ui: &mut Ui, view: &mut View, lattice: &Lattice) -> Option<Response> {
        mark(ui, WindowPart::Canvas);
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, CANVAS_NAME));
        if rect.width() < 1.0 || rect.height() < 1.0 {
            return None;
        }
        if self.shown.is_none_or(|(_, former)| former != rect) {
            // The pointer acts on the canvas where it was in the last frame: only the next frame is right.
            ui.ctx().request_repaint();
        }
        self.shown = Some((response.id, rect));
        view.follow_theme(ui.ctx());
        navigation::fit_camera(view, lattice, rect, ui.pixels_per_point());
        Some(response)
    }

    /// Fills the canvas with its ground.
    pub fn draw_ground(&self, ui: &Ui) {
        let Some((_, rect)) = self.shown else { return };
        ui.painter().rect_filled(rect, 0.0, tokens(ui).canvas);
    }

    /// Sends the changes of the mesh to the GPU, and draws it.
    pub fn draw_mesh(&mut self, ui: &Ui, session: &mut Session, view: &View, commands: &mut Vec<Command>) {
        if view.space.is_on {
            return self.draw_in_space(ui, session, view, commands);
        }
        self.follow_contours(session, view);
        let change = session.take_shown_change();
        let (Some(gpu), Some(camera), Some((_, rect))) = (&mut self.gpu, view.camera, self.shown) else {
            return self.draw_ground(ui);
        };
        let settings = session.follower().settings();
        let colors = view.level_colors(settings);
        let palette = OverlayPalette::new(view.ground, colors);
        let neutral = palette.neutral();
        let overlay = self.overlay_colors.overlay(view.overlay, session, palette, &camera, &self.jobs);
        // In software, a triangle without a pixel takes less time than the question whom it represents.
        let triangles = if gpu.draws_in_software() { 0 } else { session.mesh().raw_triangle_count() };
        let style = view.style(settings, triangles, ui.pixels_per_point());
        let style = if overlay.is_some() { style.under(neutral) } else { style };
        match gpu.sync(session, change, overlay.as_ref(), &camera, &style) {
            Ok(Progress::Done) => {}
            Ok(Progress::More) => ui.ctx().request_repaint(),
            Err(error) => commands.push(Command::from(ShellCommand::Report(error.to_string()))),
        }
        if session.awaits_mesh() {
            return self.draw_ground(ui);
        }
        if !style.is_opaque() {
            ui.painter().rect_filled(rect, 0.0, tokens(ui).canvas);
        }
        let background = session.document().settings().background.as_ref();
        self.background.paint(&ui.painter_at(rect), rect, &camera, background);
        ui.painter().add(gpu.shape(rect, camera, style));
    }

    /// Draws what features show below numbers and what the tool shows.
    fn paint_marks_below(state: &FrameState<'_>, over: &OverMesh<'_>) {
        ROWS.iter().for_each(|row| (row.marks_below)(state, over));
    }

    /// Draws what the tool and features show over the mesh, and the gesture in progress.
    fn paint_marks(&self, state: &FrameState<'_>, over: &OverMesh<'_>) {
        (state.tools.tool.paint)(state, over);
        for row in ROWS {
            (row.marks)(state, over);
        }
        if let Some(gesture) = &self.gesture {
            gesture.paint(over.painter);
        }
    }

    /// Draws highlights, what the tool shows, the brush ring and the price beside it, and sets the cursor.
    pub fn draw_marks(&self, ui: &mut Ui, response: &Response, state: &FrameState<'_>) {
        let Some(camera) = state.view.camera else { return };
        if state.view.space.is_on {
            return self.draw_marks_in_space(ui, response, state);
        }
        let (rect, px_per_point) = (response.rect, ui.pixels_per_point());
        let painter = ui.painter_at(rect);
        self.paint_contours(&painter, rect, &camera);
        graticule::paint(ui, rect, &camera, state);
        coordinates::paint_frame(ui, rect, &camera, state);
        let highlights = self.highlights(state);
        let mesh = state.session.view();
        marks::paint_highlights(&painter, rect, mesh, &camera, &highlights);
        let screen = camera.screen_map();
        let screen_from_world = |world| marks::point_from_px(rect, screen(world), px_per_point);
        let (pointer, screen_from_world) = (response.hover_pos(), &screen_from_world);
        let over =
            OverMesh { ui, canvas: rect, painter: &painter, screen_from_world, straight: None, pointer };
        // Lines pass below the numbers of the triangles that they lead through.
        Self::paint_marks_below(state, &over);
        marks::paint_neighbour_numbers(&painter, rect, mesh, &camera, &highlights);
        if let Some(selected) = highlights.selected {
            marks::paint_corner_names(&painter, rect, mesh, &camera, selected);
        }
        if let Some(readout) = state.readout {
            marks::paint_point(&painter, screen_from_world(readout.point));
        }
        self.paint_marks(state, &over);
        if let Some(mirror) = state.stroke_mirror() {
            marks::paint_mirror_lines(&painter, screen_from_world, &mirror);
        }
        if let Some(pointer) = pointer {
            let radius = state.tools.radius as f32 * camera.px_per_world() as f32 / px_per_point;
            self.draw_brush(ui, state, &over, pointer, radius);
            price::show(ui, state, (rect, &self.floats), pointer, radius);
        }
        if response.contains_pointer() || self.gesture.is_some() {
            ui.ctx().set_cursor_icon(self.cursor(ui.ctx(), state.tools));
        }
    }

    fn highlights(&self, state: &FrameState<'_>) -> Highlights {
        let mesh = state.session.view();
        let selected = state.readout.and_then(|readout| readout.location.triangle());
        let mut highlights = selected.map_or(Highlights::default(), |id| Highlights::around(mesh, id));
        let hovering = state.tools.tool.queries && self.gesture.is_none();
        let hovered =
            state.pointer.filter(|_| hovering).and_then(|point| state.session.locate(point).triangle());
        highlights.hovered = hovered.or(state.view.hovered_neighbour);
        highlights
    }

    /// The brush ring and its mirror images, and with Shift held the line that a click would paint; the
    /// eyedropper where a click picks a value.
    fn draw_brush(
        &self,
        ui: &Ui,
        state: &FrameState<'_>,
        over: &OverMesh<'_>,
        pointer: egui::Pos2,
        radius: f32,
    ) {
        let tools = state.tools;
        if !tools.has_ring() {
            return;
        }
        if self.is_picking(ui.ctx(), tools) {
            return marks::paint_eyedropper(over.painter, pointer);
        }
        if let Some((mirror, point)) = state.stroke_mirror().zip(state.pointer) {
            marks::paint_mirror_images(over.painter, over.screen_from_world, &mirror, point, radius);
        }
        if let Some(center) = self.gesture.as_ref().and_then(|gesture| gesture.ring_center()) {
            return marks::paint_brush_ring(over.painter, center, tools, radius);
        }
        if let Some(last) = tools.last_painted.filter(|_| tools.paints())
            && ui.input(|input| input.modifiers.shift)
        {
            marks::paint_line_preview(over.painter, (over.screen_from_world)(last), pointer);
        }
        marks::paint_brush_ring(over.painter, pointer, tools, radius);
    }

    /// Returns whether a click would pick a value for the brush.
    fn is_picking(&self, ctx: &Context, tools: &Tools) -> bool {
        tools.paints() && self.gesture.is_none() && ctx.input(|input| picks(input.modifiers))
    }

    fn cursor(&self, ctx: &Context, tools: &Tools) -> CursorIcon {
        if let Some(cursor) = self.gesture.as_ref().and_then(|gesture| gesture.cursor()) {
            return cursor;
        }
        if ctx.input(|input| input.key_down(Key::Space)) {
            return PAN.cursor;
        }
        if tools.has_ring() { CursorIcon::None } else { tools.tool.cursor }
    }
}
