//! What the commands about the queried point and its triangle do.

use glam::DVec2;

use super::text::{Inspection, NEIGHBOURS};
use super::{DETAILS, ExploreCommand, INSPECTOR, InspectCommand, Inspector, QUERY, TreeStep, WALK, WHY};
use super::{cause_marks, entries, walk_marks};
use meshbrush_kit::kit::command::{Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::{Ctx, Feature, Row};
use meshbrush_mesh::mesh::TriangleId;

/// A triangle that was asked for is shown at least so large, in pixels.
const TRIANGLE_PX: f64 = 60.0;

impl Feature for Inspector {
    type Command = InspectCommand;
    const ROW: Row = Row {
        tools: &[&QUERY],
        panels: &[&INSPECTOR, &DETAILS, &WHY, &WALK],
        marks_below: walk_marks::paint_walk,
        marks: |state, over| {
            cause_marks::paint(state, over);
            walk_marks::paint_trail(over, state.session.trail());
        },
        entries: entries::entries,
        ..Row::EMPTY
    };

    fn execute(&mut self, command: InspectCommand, ctx: &mut Ctx<'_>) {
        match command {
            InspectCommand::Query(point) => {
                ctx.view.revealed_panel = Some(INSPECTOR.name);
                ctx.session.query(Some(point));
                ctx.tools.note_use(&QUERY);
            }
            InspectCommand::QueryTriangle(id) => query_triangle(id, ctx),
            InspectCommand::QueryNeighbour(place) => query_neighbour(place, false, ctx),
            InspectCommand::FollowNeighbour(place) => query_neighbour(place, true, ctx),
            InspectCommand::Explore(ExploreCommand::Step(step)) => self.walk_tree(step, ctx),
            InspectCommand::Explore(ExploreCommand::ShowCorner(corner)) => self.explore.show_corner(corner),
            InspectCommand::MeasureWalks => self.walks.measure(ctx.session, ctx.jobs),
            InspectCommand::CopyReadout => copy_readout(ctx),
            InspectCommand::GoTo(point) => {
                ctx.session.query(Some(point));
                self.arrived_at = Some(point);
                match ctx.session.queried_triangle() {
                    Some(id) => ctx.view.go_to(point, ctx.session.view().diameter(id), TRIANGLE_PX),
                    None => ctx.send(Command::from(ViewCommand::LookAt(point))),
                }
            }
            InspectCommand::GoToTriangle(id) => {
                let middle = middle_of(id, ctx);
                ctx.session.query(Some(middle));
                ctx.view.go_to(middle, ctx.session.view().diameter(id), TRIANGLE_PX);
            }
            InspectCommand::AskWhy(point, size) => {
                // Only the query tool explains.
                ctx.send(Command::from(ShellCommand::Use(&QUERY)));
                ctx.session.query(Some(point));
                ctx.view.revealed_panel = Some(WHY.name);
                ctx.view.go_to(point, size, TRIANGLE_PX);
            }
            InspectCommand::Interpolate(quantity) => ctx.view.quantity = quantity,
        }
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        if ctx.tools.chosen().queries {
            self.explore.advance(ctx.session);
        }
        self.walks.take(ctx.session, ctx.jobs)
    }
}

impl Inspector {
    /// Goes to a triangle of the bisection tree, and moves the view where it is out of sight.
    fn walk_tree(&mut self, step: TreeStep, ctx: &mut Ctx<'_>) {
        let mesh = ctx.session.mesh();
        self.explore.step(step, mesh);
        if let Some(shown) = self.explore.shown() {
            let corners = shown.corners().map(|corner| mesh.lattice().world_from_lattice(corner));
            ctx.view.reveal(corners.iter().sum::<DVec2>() / 3.0);
        }
    }
}

fn copy_readout(ctx: &mut Ctx<'_>) {
    let Some(readout) = ctx.session.readout(ctx.view.quantity) else { return };
    let Some(inspection) = Inspection::of(&readout, ctx.session, ctx.view) else { return };
    ctx.egui.copy_text(inspection.full_text());
    let news = format!("Copied: all values of {}", inspection.title().to_lowercase());
    ctx.session.tell(news);
}

fn query_neighbour(place: usize, keeps_trail: bool, ctx: &mut Ctx<'_>) {
    let Some(id) = ctx.session.queried_triangle() else { return };
    match ctx.session.view().neighbours(id)[place].triangle() {
        Some(neighbour) if keeps_trail => {
            let (from, to) = (middle_of(id, ctx), middle_of(neighbour, ctx));
            ctx.session.query_next(from, to);
            ctx.view.reveal(to);
        }
        Some(neighbour) => query_triangle(neighbour, ctx),
        None => {
            let name = NEIGHBOURS[place].to_lowercase();
            ctx.session.tell(format!("There is no {name}: that edge is on the boundary."));
        }
    }
}

fn middle_of(id: TriangleId, ctx: &Ctx<'_>) -> DVec2 {
    let [a, b, c] = ctx.session.view().world_corners(id);
    (a + b + c) / 3.0
}

/// Queries a triangle, and moves the view where it is out of sight.
fn query_triangle(id: TriangleId, ctx: &mut Ctx<'_>) {
    let middle = middle_of(id, ctx);
    ctx.session.query(Some(middle));
    ctx.view.reveal(middle);
}
