//! What each command does, and what finished work on files does. A match arm is one call into the module that
//! owns the data.

use eframe::egui::{Context, ViewportCommand};
use glam::DVec2;

use super::App;
use super::background::{Aim, Outcome, WorkId};
use super::command::{BoundaryCommand, Command, DomainCommand};
use super::dialogs::{Dialog, FileRequest};
use super::journal::JournalKeeper;
use super::readout::{Quantity, value_at};
use super::tools::{BOUNDARY, BRUSH, BoundaryToolMode, DOMAIN, PaintKind, QUERY};
use super::{files, journal, project};
use crate::document::{Document, Settings};
use crate::domain::{BoundaryPieces, CutShape};
use crate::mesh::TriangleId;

impl App {
    /// Runs one command.
    pub(super) fn execute(&mut self, command: Command, ctx: &Context) {
        let Some(command) = self.project.ask_before_leaving(command, &mut self.session, &self.background)
        else {
            return;
        };
        match self.execute_on_files(command, ctx) {
            None => {}
            Some(Command::Domain(command)) => self.execute_on_domain(command),
            Some(Command::Boundary(command)) => self.execute_on_boundary(command),
            Some(command) => self.execute_on_document(command, ctx),
        }
    }

    /// Runs commands about files, windows and dialogs, and returns others.
    fn execute_on_files(&mut self, command: Command, ctx: &Context) -> Option<Command> {
        match command {
            Command::New => self.open(new_document()),
            Command::OpenExample(example) => self.open(files::example(example)),
            Command::NewWith(settings) => self.new_with(*settings),
            Command::Open(path) => match project::open_command(path) {
                Ok(command) => self.send(command),
                Err(problem) => self.session.report(problem),
            },
            Command::OpenProject(path) => project::open_project(&self.session, &mut self.background, &path),
            Command::OpenImage(path) => files::load_image(&self.session, &mut self.background, &path),
            Command::OpenDomain(path) => files::load_domain(&mut self.background, &path),
            Command::Save => match self.project.path() {
                Some(path) => self.send(Command::SaveTo(path.to_owned())),
                None => self.dialogs.open(Dialog::Path(FileRequest::Save)),
            },
            Command::SaveAs(path) => self.commands.extend(self.project.save_as(path)),
            Command::SaveTo(path) => {
                self.project.save_to(path, &mut self.session, &mut self.background);
            }
            Command::ExportAs(path) => self.commands.extend(self.project.export_as(path)),
            Command::Export(path) => {
                files::export(&mut self.session, &self.view, &mut self.background, &path);
            }
            Command::CancelWork(id) => self.cancel_work(id),
            Command::AnswerLeaving(answer) => {
                self.commands.extend(self.project.answer_leaving(answer, &mut self.session));
            }
            Command::AnswerReplacing(answer) => self.commands.extend(self.project.answer_replacing(answer)),
            Command::AnswerRecovery(answer) => {
                self.commands.extend(self.journal.as_mut().and_then(|keeper| keeper.answer(answer)));
            }
            Command::Restore => self.restore(),
            Command::Ask(request) => self.dialogs.open(Dialog::Path(request)),
            Command::Browse(request) => self.dialogs.browse(request, ctx),
            Command::Palette => self.dialogs.open(Dialog::Palette),
            Command::About => self.dialogs.open(Dialog::About),
            Command::CloseDialog => self.dialogs.close(),
            Command::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            other => return Some(other),
        }
        None
    }

    /// Runs commands about the document, the tools and the view.
    fn execute_on_document(&mut self, command: Command, ctx: &Context) {
        match command {
            Command::Undo => self.keep_brush_share(|app| app.session.undo()),
            Command::Redo => self.keep_brush_share(|app| app.session.redo()),
            Command::ClearPaint => self.session.document_mut().clear_paint(),
            Command::Set(setting) => self.session.set(setting),
            Command::EndGesture => self.session.end_gesture(),
            Command::CancelUpdate => self.session.cancel_update(),
            Command::DismissNotice => self.session.dismiss_notice(),
            Command::Report(failure) => self.session.report(failure),
            Command::Query(point) => self.query(point),
            Command::QueryTriangle(id) => self.query_triangle(id),

            Command::BeginStroke(point) => self.begin_stroke(point),
            Command::DrawTo(point) => self.draw_to(point),
            Command::EndStroke => self.session.document_mut().finish_stroke(),
            Command::LineTo(point) => self.line_to(point),
            Command::Escape => self.escape(),

            Command::Use(tool) => self.tools.select(tool),
            Command::Paint(kind) => (self.tools.kind, self.tools.tool) = (kind, &BRUSH),
            Command::BrushRadius(radius) => self.set_brush_radius(radius),
            Command::ScaleBrush(factor) => self.set_brush_radius(self.tools.radius * factor),
            Command::BrushHardness(hardness) => self.tools.hardness = hardness.clamp(0.0, 1.0),
            Command::BrushStrength(strength) => self.tools.set_strength(strength),
            Command::BrushDiameter(diameter) => self.set_brush_diameter(diameter),
            Command::PickValue(point) => self.pick_value(point),
            other => self.view.execute(other, ctx),
        }
    }

    fn execute_on_domain(&mut self, command: DomainCommand) {
        let tool = &mut self.tools.domain;
        match command {
            DomainCommand::Reshape(cut_shape, adds) => self.reshape(cut_shape, adds),
            DomainCommand::AddCorner(corner) => tool.corners.push(corner),
            DomainCommand::ClosePolygon => self.close_polygon(),
            DomainCommand::Mode(mode) => {
                self.tools.select(&DOMAIN);
                self.tools.domain.mode = mode;
            }
            DomainCommand::Adds(adds) => tool.adds = adds,
            DomainCommand::Bounds(bounds) => {
                self.session.set_bounds(bounds);
                self.tools.note_use(&DOMAIN);
            }
        }
    }

    fn execute_on_boundary(&mut self, command: BoundaryCommand) {
        match command {
            BoundaryCommand::Click(point, reach) => self.click_boundary(point, reach),
            BoundaryCommand::Select(point) => {
                self.tools.boundary.selected = Some(point);
                self.view.reveal(point);
            }
            BoundaryCommand::Mode(mode) => {
                self.tools.select(&BOUNDARY);
                self.tools.boundary.mode = mode;
            }
            BoundaryCommand::Join => {
                let selected = |pieces: &BoundaryPieces| self.tools.boundary.selected_of(pieces);
                let marks =
                    self.session.changed_marks(|pieces, marks| pieces.joined(marks, selected(pieces)?));
                self.session.set_marks(marks);
            }
        }
    }

    /// Selects or splits what is at a point, at most `reach` away.
    fn click_boundary(&mut self, point: DVec2, reach: f64) {
        self.tools.note_use(&BOUNDARY);
        if self.tools.boundary.mode == BoundaryToolMode::Split {
            let marks = self.session.changed_marks(|pieces, marks| pieces.split(marks, point, reach));
            return self.session.set_marks(marks);
        }
        let piece = self.session.boundary_pieces().and_then(|pieces| {
            let (piece, _) = pieces.nearest(point, reach)?;
            Some(pieces.list()[piece].middle())
        });
        self.tools.boundary.selected = piece;
    }

    fn reshape(&mut self, cut_shape: CutShape, adds: bool) {
        self.session.reshape(cut_shape, adds);
        self.tools.note_use(&DOMAIN);
    }

    fn close_polygon(&mut self) {
        let ring = std::mem::take(&mut self.tools.domain.corners);
        if ring.len() >= 3 {
            self.reshape(CutShape::Ring(ring), self.tools.domain.adds);
            self.session.end_gesture();
        }
    }

    fn open(&mut self, document: Document) {
        self.show_document(document);
        self.project.belongs_to(None, self.session.document().version(), true);
    }

    fn new_with(&mut self, settings: Settings) {
        match Document::new(settings, None) {
            Ok(document) => self.open(document),
            Err(error) => self.session.report(error),
        }
    }

    /// Opens another document in place of the current one, and fits brush and view to it. This cannot be
    /// undone: [`super::project::ProjectFile::ask_before_leaving`] asks before edits are lost.
    fn show_document(&mut self, document: Document) {
        self.session.replace_document(document);
        let settings = self.session.document().settings();
        let extent = settings.domain.bounds.size().max_element();
        self.tools.fit_to(extent, settings.transfer.h_min);
        self.view.camera = None;
    }

    /// Runs an undo or a redo. Where that changes the domain, the brush keeps its share of it.
    fn keep_brush_share(&mut self, step: fn(&mut Self)) {
        let extent = |app: &Self| app.session.document().settings().domain.bounds.size().max_element();
        let before = extent(self);
        step(self);
        let ratio = extent(self) / before;
        if ratio != 1.0 {
            self.tools.radius *= ratio;
            self.tools.diameter *= ratio;
        }
    }

    fn begin_stroke(&mut self, point: DVec2) {
        let Some(brush) = self.tools.brush() else { return };
        self.session.dismiss_news();
        // Record the last stroke before the next begins: both may come in one frame.
        self.session.document_mut().end_stroke();
        self.record_edits();
        let document = self.session.document_mut();
        document.begin_stroke(brush);
        document.extend_stroke(point);
        self.tools.last_painted = Some(point);
        self.tools.note_use(self.tools.tool);
    }

    fn draw_to(&mut self, point: DVec2) {
        self.session.document_mut().extend_stroke(point);
        self.tools.last_painted = Some(point);
    }

    fn line_to(&mut self, point: DVec2) {
        self.begin_stroke(self.tools.last_painted.unwrap_or(point));
        self.draw_to(point);
        self.session.document_mut().finish_stroke();
    }

    /// Cancels what is in progress: the stroke, the cut, or the rectangle or polygon. Else clears query and
    /// message.
    fn escape(&mut self) {
        if self.session.document().stroke().is_some() {
            return self.session.document_mut().cancel_stroke();
        }
        let gesture_ended = self.canvas.end_gesture_on_escape();
        let in_gesture = self.session.document().is_in_gesture();
        if self.session.is_cutting() || (gesture_ended && in_gesture) {
            self.session.drop_cut();
        } else if gesture_ended || !self.tools.domain.corners.is_empty() {
            self.tools.domain.corners.clear();
        } else {
            self.session.query(None);
            self.session.dismiss_notice();
        }
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

    fn query(&mut self, point: DVec2) {
        self.session.query(Some(point));
        self.tools.note_use(&QUERY);
    }

    /// Queries a triangle, and moves the view where it is out of sight.
    fn query_triangle(&mut self, id: TriangleId) {
        let [a, b, c] = self.session.view().world_corners(id);
        let middle = (a + b + c) / 3.0;
        self.session.query(Some(middle));
        self.view.reveal(middle);
    }

    fn cancel_work(&mut self, id: WorkId) {
        match self.background.cancel(id) {
            Some((Aim::Read, name)) => {
                self.session.tell(format!("Reading {name} was cancelled. The document is unchanged."));
                self.project.keep_edits();
            }
            Some((Aim::Save(_), _)) => self.project.cancel_saving(),
            Some((Aim::Export, _)) | None => {}
        }
    }

    /// Opens the work of an earlier run that is offered, and records it in this run's journal from now on.
    fn restore(&mut self) {
        let Some(left) = self.journal.as_mut().and_then(JournalKeeper::take_offered) else { return };
        let document = match left.project.clone().into_document() {
            Ok(document) => document,
            Err(problem) => return self.session.report(problem),
        };
        self.show_document(document);
        let version = self.session.document().version();
        self.project.belongs_to(left.home.clone(), version, false);
        self.record_edits();
        if let Some(keeper) = &self.journal {
            keeper.forget(left);
        }
    }

    /// Hands finished gestures to the journal.
    pub(super) fn record_edits(&mut self) {
        if let Some(keeper) = &mut self.journal {
            journal::record(keeper, &mut self.session, &self.project);
        }
    }

    /// Applies the outcomes of work on other threads.
    pub(super) fn finish_work(&mut self) {
        while let Some(outcome) = self.background.take_finished() {
            self.finish(outcome);
        }
    }

    fn finish(&mut self, outcome: Outcome) {
        match outcome {
            Outcome::Commands(commands) => self.commands.extend(commands),
            Outcome::News(text) => self.session.tell(text),
            Outcome::NotRead(problem) => {
                self.project.keep_edits();
                self.session.report(problem);
            }
            Outcome::NotWritten(problem) => {
                self.project.stay();
                self.session.report(problem);
            }
            Outcome::Opened { path, document, replaces } if replaces == self.session.document().version() => {
                self.show_document(*document);
                self.project.belongs_to(Some(path), self.session.document().version(), true);
            }
            Outcome::Opened { path, .. } => {
                let problem = "was not opened, as the document was edited in the meantime. Open it again.";
                self.session.report(format!("{} {problem}", path.display()));
            }
            Outcome::Saved { path, version } => {
                self.session.tell(format!("Saved to {}.", path.display()));
                self.project.belongs_to(Some(path), version, true);
                self.finish_saving();
            }
            Outcome::SavingCancelled(text) => {
                self.session.tell(text);
                self.project.save_again(&mut self.session, &mut self.background);
            }
            Outcome::NotSaved(problem) => {
                self.project.cancel_saving();
                self.session.report(problem);
            }
        }
    }

    fn finish_saving(&mut self) {
        if let Some(keeper) = self.journal.as_ref().filter(|_| !self.project.is_edited(&self.session)) {
            keeper.note_saved(&self.project);
        }
        self.project.save_again(&mut self.session, &mut self.background);
        if !self.background.saves() {
            // It asks again about edits made since.
            self.commands.extend(self.project.take_after_saving());
        }
    }
}

fn new_document() -> Document {
    Document::new(Settings::default(), None).expect("the default settings are valid: a test opens them")
}
