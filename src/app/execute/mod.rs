//! What each command does. A match arm is one call into the module that owns the data.

mod corridor;
mod domain;
mod files;
mod keep_out;
mod layers;
mod painting;
mod steps;
mod paths;
mod pins;
mod plots;
mod report;
mod threats;

use eframe::egui::Context;
use glam::DVec2;

use super::App;
use super::command::{Command, ExploreCommand};
use super::dialogs::{Dialog, fill_in_place};
use super::explore::TreeStep;
use super::inspection::{Inspection, NEIGHBOURS};
use super::tools::{QUERY, Tool};
use meshbrush_mesh::mesh::TriangleId;

/// A triangle that was asked for is shown at least so large, in pixels.
const TRIANGLE_PX: f64 = 60.0;

impl App {
    /// Runs one command.
    pub(super) fn execute(&mut self, command: Command, ctx: &Context) {
        let Some(command) = self.project.ask_before_leaving(command, &mut self.session, &self.background)
        else {
            return;
        };
        match self.execute_on_files(command, ctx) {
            None => {}
            Some(Command::Layer(command)) => self.execute_on_layers(command, ctx),
            Some(Command::Threats(command)) => self.execute_on_threats(command),
            Some(Command::Steps(command)) => self.execute_on_steps(command, ctx),
            Some(Command::Path(command)) => self.execute_on_paths(command),
            Some(Command::Pins(command)) => self.execute_on_pins(command, ctx),
            Some(Command::Figure(command)) => self.execute_on_report(command, ctx),
            Some(Command::Plots(command)) => self.execute_on_plots(command, ctx),
            Some(Command::Domain(command)) => self.execute_on_domain(command),
            Some(Command::Boundary(command)) => self.execute_on_boundary(command),
            Some(command) => self.execute_on_document(command, ctx),
        }
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
            Command::DismissNotice => self.session.notices_mut().dismiss(),
            Command::Report(failure) => self.session.report(failure),
            Command::Tell(news) => self.session.notices_mut().tell(news),
            Command::ShowHelp(topic) => self.help = Some(topic),
            Command::CloseHelp => self.help = None,
            Command::LimitThreads(count) => self.limit_threads(count),
            Command::Measure => self.session.measure(&self.jobs),
            Command::Copy(text) => self.copy(text, ctx),
            Command::Query(point) => self.query(point),
            Command::QueryTriangle(id) => self.query_triangle(id),
            Command::QueryNeighbour(place) => self.query_neighbour(place, false),
            Command::FollowNeighbour(place) => self.query_neighbour(place, true),
            Command::MeasureWalks => self.walks.measure(&self.session, &self.jobs),
            Command::Explore(ExploreCommand::Step(step)) => self.walk_tree(step),
            Command::Explore(ExploreCommand::ShowCorner(corner)) => self.explore.show_corner(corner),
            Command::CopyReadout => self.copy_readout(ctx),
            Command::AskPlace => self.dialogs.open(Dialog::GoTo),
            Command::AskPlaceNear(point) => {
                fill_in_place(ctx, self.view.typed_point(point));
                self.dialogs.open(Dialog::GoTo);
            }
            Command::GoTo(point) => {
                self.ask(Some(point));
                self.view.execute(Command::LookAt(point), ctx);
            }
            Command::GoToTriangle(id) => self.go_to_triangle(id),

            Command::BeginStroke(point) => self.begin_stroke(point),
            Command::DrawTo(point) => self.draw_to(point),
            Command::EndStroke => self.session.document_mut().finish_stroke(),
            Command::LineTo(point) => self.line_to(point),
            Command::Escape => self.escape(),

            Command::Use(tool) => self.use_tool(tool),
            Command::Brush(command) => self.execute_on_brush(command),
            other => self.view.execute(other, ctx),
        }
    }

    /// Ends the steps. Else cancels what is in progress: the stroke, the cut, or the rectangle or polygon.
    /// Else closes the help, or clears query and message.
    fn escape(&mut self) {
        if self.help.is_none() && self.stepping.take().is_some() {
            return;
        }
        if self.session.document().stroke().is_some() {
            return self.session.document_mut().cancel_stroke();
        }
        let gesture_ended = self.canvas.end_gesture_on_escape();
        let in_gesture = self.session.document().is_in_gesture();
        if self.session.is_cutting() || (gesture_ended && in_gesture) {
            self.session.drop_cut();
        } else if gesture_ended || !self.tools.domain.corners.is_empty() || self.tools.path.pending.is_some()
        {
            self.tools.domain.corners.clear();
            self.tools.path.pending = None;
        } else if self.help.take().is_none() {
            self.ask(None);
            self.session.notices_mut().dismiss();
        }
    }

    /// Selects a tool, for the mesh of the document.
    fn use_tool(&mut self, tool: Tool) {
        self.stepping = None;
        self.tools.select(tool);
    }

    fn copy(&mut self, text: String, ctx: &Context) {
        self.session.tell(format!("Copied: {text}"));
        ctx.copy_text(text);
    }

    fn copy_readout(&mut self, ctx: &Context) {
        let Some(readout) = self.session.readout(self.view.quantity) else { return };
        let Some(inspection) = Inspection::of(&readout, &self.session, &self.view) else { return };
        ctx.copy_text(inspection.full_text());
        let news = format!("Copied: all values of {}", inspection.title().to_lowercase());
        self.session.tell(news);
    }

    /// Goes to a triangle of the bisection tree, and moves the view where it is out of sight.
    fn walk_tree(&mut self, step: TreeStep) {
        let mesh = self.session.mesh();
        self.explore.step(step, mesh);
        if let Some(shown) = self.explore.shown() {
            let corners = shown.corners().map(|corner| mesh.lattice().world_from_lattice(corner));
            self.view.reveal(corners.iter().sum::<DVec2>() / 3.0);
        }
    }

    fn query_neighbour(&mut self, place: usize, keeps_trail: bool) {
        let Some(id) = self.session.queried_triangle() else { return };
        match self.session.view().neighbours(id)[place].triangle() {
            Some(neighbour) => {
                let (from, to) = (self.middle_of(id), self.middle_of(neighbour));
                let mut trail = std::mem::take(&mut self.tools.trail);
                self.query_triangle(neighbour);
                if keeps_trail {
                    if trail.is_empty() {
                        trail.push(from);
                    }
                    trail.push(to);
                    self.tools.trail = trail;
                }
            }
            None => {
                let name = NEIGHBOURS[place].to_lowercase();
                self.session.tell(format!("There is no {name}: that edge is on the boundary."));
            }
        }
    }

    fn query(&mut self, point: DVec2) {
        self.view.reveals_inspector = true;
        self.ask(Some(point));
        self.tools.note_use(&QUERY);
    }

    /// Queries a point or none. The trail to the former one ends.
    fn ask(&mut self, point: Option<DVec2>) {
        self.tools.trail.clear();
        self.session.query(point);
    }

    fn middle_of(&self, id: TriangleId) -> DVec2 {
        let [a, b, c] = self.session.view().world_corners(id);
        (a + b + c) / 3.0
    }

    /// Queries a triangle, and moves the view where it is out of sight.
    fn query_triangle(&mut self, id: TriangleId) {
        let middle = self.middle_of(id);
        self.ask(Some(middle));
        self.view.reveal(middle);
    }

    fn go_to_triangle(&mut self, id: TriangleId) {
        let middle = self.middle_of(id);
        self.ask(Some(middle));
        self.view.go_to(middle, self.session.view().diameter(id), TRIANGLE_PX);
    }
}
