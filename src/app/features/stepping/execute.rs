//! What the commands of the mode do.

use std::path::PathBuf;

use glam::DVec2;

use super::entries::entries;
use super::{StepCommand, Stepping, Steps};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::{Ctx, Feature, Row};
use meshbrush_mesh::geometry::Rect;

/// The distance of a corner of a triangle from its middle, in pixels, from which the numbers of its nodes
/// have room.
const SMALLEST_REACH_PX: f64 = 40.0;
/// How much of the surroundings is shown of a smaller triangle, in distances of its corners from its middle.
const REACHES_AROUND: f64 = 7.0;

impl Feature for Stepping {
    type Command = StepCommand;
    const ROW: Row = Row { entries, ..Row::EMPTY };

    fn execute(&mut self, command: StepCommand, ctx: &mut Ctx<'_>) {
        if let StepCommand::Begin(figure) = command {
            // Its middle: the point itself can lie on an edge, and in two triangles.
            let queried = ctx.session.queried_triangle().filter(|_| figure.is_none());
            let corners = queried.map(|id| ctx.session.view().world_corners(id));
            let queried = corners.map(|corners| corners.iter().sum::<DVec2>() / 3.0);
            if let (Some(corners), Some(middle)) = (corners, queried) {
                show_closely(corners, middle, ctx);
            }
            if figure.is_none() {
                ctx.session.query(None);
            }
            ctx.tools.only_move_view(true);
            self.steps = Some(Steps::new(ctx.session, figure, queried));
            return;
        }
        if let StepCommand::BeginAt(position) = command {
            ctx.tools.only_move_view(true);
            self.steps = Some(Steps::new(ctx.session, None, None).at(position));
            return;
        }
        let Some(steps) = &mut self.steps else { return };
        match command {
            StepCommand::Begin(_) | StepCommand::BeginAt(_) => {}
            StepCommand::ExportAs(path) => return export_as(steps, path, ctx),
            StepCommand::Export(path) => {
                let started = steps.export(&path, ctx.session, ctx.view, ctx.background);
                return started.unwrap_or_else(|problem| ctx.fail(problem));
            }
            StepCommand::Leave => _ = self.leave(ctx.tools),
            StepCommand::GoTo(position) => steps.go_to(position),
            StepCommand::Move(count) => steps.go_by(count),
            StepCommand::TogglePlay => steps.toggle_play(ctx.egui),
            StepCommand::OnlyBisections(only) => steps.only_bisections = only,
            StepCommand::Speed(speed) => steps.set_speed(speed),
            StepCommand::ExportGround(ground) => steps.export_ground = Some(ground),
            StepCommand::ExportRange(first, last) => steps.set_export_range(first, last),
        }
        if let Some(place) = self.steps().and_then(Steps::place) {
            ctx.view.reveal(place);
        }
    }

    /// Records or plays steps. The mode ends when the document is edited.
    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let Some(steps) = &mut self.steps else { return false };
        if !steps.belongs_to(ctx.session) {
            self.leave(ctx.tools);
            ctx.session.tell("The document was edited, so that its mesh is shown again.".into());
            return false;
        }
        steps.advance(ctx.session, ctx.jobs, ctx.egui).unwrap_or_else(|problem| {
            self.leave(ctx.tools);
            ctx.session.report(problem);
            false
        })
    }
}

/// Zooms in until the numbers of a triangle and its nodes have room, if they have none.
fn show_closely(corners: [DVec2; 3], middle: DVec2, ctx: &mut Ctx<'_>) {
    let reach = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
    if reach < SMALLEST_REACH_PX * ctx.view.world_per_px() {
        let area = Rect::around(middle, REACHES_AROUND * reach);
        ctx.send(Command::from(ViewCommand::ShowArea(area)));
    }
}

/// Writes the chosen steps, and asks before other files are replaced.
fn export_as(steps: &Steps, path: PathBuf, ctx: &mut Ctx<'_>) {
    match steps.files(&path) {
        Ok(files) => {
            let export = Command::from(StepCommand::Export(path));
            ctx.commands.extend(ctx.project.ask_to_replace(files, export));
        }
        Err(problem) => ctx.fail(problem),
    }
}
