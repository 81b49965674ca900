//! What each command does. A match arm is one call into the room that owns the data.

use eframe::egui::{Context, ThemePreference, ViewportCommand};
use glam::DVec2;

use super::App;
use super::canvas::Gesture;
use super::command::Command;
use super::files::FileRequest;
use super::readout::{Quantity, value_at};
use super::tools::{PaintKind, Tool, Tools};
use super::view::FieldOverlay;
use crate::document::{Document, Example, Settings};
use crate::mesh::TriangleId;

impl App {
    /// Carries out one command.
    pub fn execute(&mut self, command: Command, ctx: &Context) {
        let Some(command) = self.asked_before_leaving(command) else { return };
        match command {
            Command::New => self.open(new_document()),
            Command::OpenExample(example) => self.open_example(example),
            Command::AskToOpen => self.files.ask(FileRequest::Open),
            Command::Open(path) => self.open_file(path),
            Command::OpenProject(path) => self.open_project(path),
            Command::Save => self.save(),
            Command::AskWhereToSave => self.files.ask(FileRequest::Save),
            Command::SaveAs(path) => self.save_as(path),
            Command::SaveTo(path) => self.save_to(path),
            Command::AskForImage => self.files.ask(FileRequest::OpenImage),
            Command::OpenImage(path) => self.load_image(path),
            Command::NewWith(settings) => self.new_with(*settings),
            Command::AskForDomain => self.files.ask(FileRequest::OpenDomain),
            Command::OpenDomain(path) => self.load_domain(path),
            Command::AskForExport => self.files.ask(FileRequest::Export),
            Command::ExportAs(path) => self.export_as(path, ctx),
            Command::Export(path) => self.export(path),
            Command::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),

            Command::Restore => self.restore(),

            Command::Undo => self.undo(),
            Command::Redo => self.redo(),
            Command::ClearPaint => self.session.document_mut().clear_paint(),
            Command::Set(setting) => self.session.set(setting),
            Command::EndGesture => self.end_gesture(),
            Command::CancelUpdate => self.cancel_update(),

            Command::BeginStroke(point) => self.begin_stroke(point),
            Command::DrawTo(point) => self.draw_to(point),
            Command::EndStroke => self.session.document_mut().finish_stroke(),
            Command::LineTo(point) => self.line_to(point),
            Command::Escape => self.escape(),

            Command::Use(tool) => self.take_tool(tool),
            Command::Paint(kind) => self.paint(kind),
            Command::BrushRadius(radius) => self.set_brush_radius(radius),
            Command::ScaleBrush(factor) => self.set_brush_radius(self.tools.radius * factor),
            Command::BrushHardness(hardness) => self.tools.hardness = hardness.clamp(0.0, 1.0),
            Command::BrushStrength(strength) => *self.tools.strength_mut() = strength.clamp(0.01, 1.0),
            Command::BrushDiameter(diameter) => self.set_brush_diameter(diameter),
            Command::PickValue(point) => self.pick_value(point),

            Command::Query(point) => self.query(point),
            Command::QueryTriangle(id) => self.query_triangle(id),
            Command::Domain(command) => self.execute_on_domain(command),

            Command::Fit => self.view.camera = None,
            Command::LookAt(point) => self.view.look_at(point),
            Command::Zoom(factor) => self.view.zoom(factor),
            Command::ToggleEdges => self.view.edges = !self.view.edges,
            Command::Overlay(overlay) => self.toggle_overlay(overlay),
            Command::Colormap(map) => self.view.colormap = map,
            Command::Theme(theme) => self.set_theme(theme, ctx),
            Command::TogglePanels => self.view.panels = !self.view.panels,
            Command::Palette => self.palette.open(),
            Command::About => self.about = true,
        }
    }

    fn open(&mut self, document: Document) {
        self.show_document(document);
        self.project.belongs_to(None, self.session.document().version(), true);
    }

    /// Opens another document in place of the current one, and fits brush and view to it. It cannot be
    /// undone: [`Self::asked_before_leaving`] asks before edits are lost.
    pub(super) fn show_document(&mut self, document: Document) {
        self.give_up_cuts();
        self.session.document_mut().replace_with(document);
        self.session.query(None);
        self.session.set_notice(None);
        let settings = self.session.document().settings();
        let extent = settings.domain.bounds.size().max_element();
        let fitting = Tools::for_domain(extent, settings.transfer.h_min);
        self.tools.radius = fitting.radius;
        self.tools.diameter = fitting.diameter;
        self.view.camera = None;
    }

    /// Gives up cuts that are being made, or else the update of the mesh.
    pub(super) fn cancel_update(&mut self) {
        if self.cutter.is_idle() {
            self.session.cancel_update();
        } else {
            self.give_up_cuts();
        }
    }

    /// Takes the last gesture back; one that has not come to the document is given up.
    fn undo(&mut self) {
        if !self.give_up_cuts() {
            self.travel(Document::undo);
        }
    }

    fn redo(&mut self) {
        self.give_up_cuts();
        self.travel(Document::redo);
    }

    /// Undoes or redoes. Where that brings another domain, the brush keeps its share of it.
    fn travel(&mut self, step: fn(&mut Document) -> bool) {
        let extent = |app: &Self| app.session.document().settings().domain.bounds.size().max_element();
        let before = extent(self);
        step(self.session.document_mut());
        let ratio = extent(self) / before;
        if ratio != 1.0 {
            self.tools.radius *= ratio;
            self.tools.diameter *= ratio;
        }
    }

    fn new_with(&mut self, settings: Settings) {
        match Document::new(settings, None) {
            Ok(document) => self.open(document),
            Err(error) => self.session.report(error),
        }
    }

    fn open_example(&mut self, example: Example) {
        self.open(super::files::example(example));
    }

    fn begin_stroke(&mut self, point: DVec2) {
        self.session.put_news_away();
        // What the last one did is kept before the next begins: they may come in one frame.
        self.session.document_mut().end_stroke();
        self.follow_journal();
        let brush = self.tools.brush();
        let document = self.session.document_mut();
        document.begin_stroke(brush);
        document.extend_stroke(point);
        self.last_painted = Some(point);
        self.hints.did(self.tools.tool);
    }

    fn draw_to(&mut self, point: DVec2) {
        self.session.document_mut().extend_stroke(point);
        self.last_painted = Some(point);
    }

    fn line_to(&mut self, point: DVec2) {
        self.begin_stroke(self.last_painted.unwrap_or(point));
        self.draw_to(point);
        self.session.document_mut().finish_stroke();
    }

    fn escape(&mut self) {
        if self.session.document().stroke().is_some() {
            self.session.document_mut().cancel_stroke();
        } else if matches!(self.gesture, Gesture::Cutting { .. }) || !self.cutter.is_idle() {
            self.gesture = Gesture::None;
            let begun = self.session.document().is_in_gesture();
            self.give_up_cuts();
            if begun {
                self.session.document_mut().undo();
            }
        } else if matches!(self.gesture, Gesture::Framing { .. }) || !self.outline.is_empty() {
            self.gesture = Gesture::None;
            self.outline.clear();
        } else {
            self.session.query(None);
            self.session.set_notice(None);
        }
    }

    fn paint(&mut self, kind: PaintKind) {
        self.tools.kind = kind;
        self.tools.tool = Tool::Brush;
    }

    fn set_brush_radius(&mut self, radius: f64) {
        let extent = self.session.document().settings().domain.bounds.size().max_element();
        if radius.is_finite() {
            self.tools.radius = radius.clamp(1e-4 * extent, extent);
        }
    }

    fn set_brush_diameter(&mut self, diameter: f64) {
        let transfer = self.session.document().settings().transfer;
        if diameter.is_finite() {
            self.tools.diameter = diameter.clamp(transfer.h_min, transfer.h_max);
        }
    }

    /// Risk becomes the brush's strength, a diameter the brush's diameter.
    fn pick_value(&mut self, point: DVec2) {
        let value = |quantity| value_at(point, self.session.document(), self.session.follower(), quantity);
        match self.tools.kind {
            PaintKind::Risk => {
                let risk = value(Quantity::Risk);
                if risk > 0.0 {
                    self.tools.paint_strength = risk.clamp(0.01, 1.0);
                }
            }
            PaintKind::Diameter => self.set_brush_diameter(value(Quantity::TargetDiameter)),
        }
    }

    /// Goes to a triangle, and moves the view where it is out of sight.
    fn query_triangle(&mut self, id: TriangleId) {
        let [a, b, c] = self.session.mesh().world_corners(id);
        let middle = (a + b + c) / 3.0;
        self.session.query(Some(middle));
        self.view.reveal(middle);
    }

    fn query(&mut self, point: DVec2) {
        self.session.query(Some(point));
        self.hints.did(Tool::Query);
    }

    pub(super) fn take_tool(&mut self, tool: Tool) {
        self.tools.tool = tool;
        self.outline.clear();
    }

    /// The key of an overlay that is shown takes it away.
    fn toggle_overlay(&mut self, overlay: FieldOverlay) {
        self.view.overlay = if self.view.overlay == overlay { FieldOverlay::None } else { overlay };
    }

    fn set_theme(&mut self, theme: ThemePreference, ctx: &Context) {
        self.theme = theme;
        ctx.set_theme(theme);
    }
}

fn new_document() -> Document {
    Document::new(Settings::default(), None).expect("the default settings are sound: a test opens them")
}
