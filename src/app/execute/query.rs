//! Commands about the queried point and its triangle.

use eframe::egui::Context;
use glam::DVec2;

use crate::app::App;
use crate::app::command::{ExploreCommand, InspectCommand, ViewCommand};
use crate::app::dialogs::{Dialog, fill_in_place};
use crate::app::explore::TreeStep;
use crate::app::inspection::{Inspection, NEIGHBOURS};
use crate::app::tools::QUERY;
use meshbrush_mesh::mesh::TriangleId;

/// A triangle that was asked for is shown at least so large, in pixels.
const TRIANGLE_PX: f64 = 60.0;

impl App {
    pub(super) fn execute_on_query(&mut self, command: InspectCommand, ctx: &Context) {
        match command {
            InspectCommand::Query(point) => self.query(point),
            InspectCommand::QueryTriangle(id) => self.query_triangle(id),
            InspectCommand::QueryNeighbour(place) => self.query_neighbour(place, false),
            InspectCommand::FollowNeighbour(place) => self.query_neighbour(place, true),
            InspectCommand::Explore(ExploreCommand::Step(step)) => self.walk_tree(step),
            InspectCommand::Explore(ExploreCommand::ShowCorner(corner)) => self.explore.show_corner(corner),
            InspectCommand::MeasureWalks => self.walks.measure(&self.session, &self.jobs),
            InspectCommand::CopyReadout => self.copy_readout(ctx),
            InspectCommand::AskPlace => self.dialogs.open(Dialog::GoTo),
            InspectCommand::AskPlaceNear(point) => {
                fill_in_place(ctx, self.view.typed_point(point));
                self.dialogs.open(Dialog::GoTo);
            }
            InspectCommand::GoTo(point) => {
                self.ask(Some(point));
                self.view.execute(ViewCommand::LookAt(point), ctx);
            }
            InspectCommand::GoToTriangle(id) => self.go_to_triangle(id),
            InspectCommand::Interpolate(quantity) => self.view.quantity = quantity,
        }
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

    pub(super) fn query(&mut self, point: DVec2) {
        self.view.reveals_inspector = true;
        self.ask(Some(point));
        self.tools.note_use(&QUERY);
    }

    /// Queries a point or none. The trail to the former one ends.
    pub(super) fn ask(&mut self, point: Option<DVec2>) {
        self.tools.query(point, &mut self.session);
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
