//! Runs the commands about the boundary.

use glam::DVec2;

use super::opening::{open_boundary, set_opened};
use super::{BOUNDARY, Boundary, BoundaryCommand, BoundaryToolMode, PIECES, entries};
use crate::app::features::boundary::BoundaryTool;
use meshbrush_core::domain::BoundaryPieces;
use meshbrush_core::layers::Layer;
use meshbrush_kit::kit::{Ctx, Feature, Row, Tab};

impl Feature for Boundary {
    type Command = BoundaryCommand;
    const ROW: Row = Row { tools: &[&BOUNDARY], panels: &[&PIECES], entries, ..Row::EMPTY };

    fn execute(&mut self, command: BoundaryCommand, ctx: &mut Ctx<'_>) {
        match command {
            BoundaryCommand::Click(point, reach) => click(point, reach, ctx),
            BoundaryCommand::Select(point) => {
                ctx.tools.select(&BOUNDARY);
                ctx.tools.settings_mut::<BoundaryTool>().selected = Some(point);
                ctx.view.reveal(point);
            }
            BoundaryCommand::Mode(mode) => {
                ctx.tools.select(&BOUNDARY);
                ctx.tools.settings_mut::<BoundaryTool>().mode = mode;
            }
            BoundaryCommand::Join => {
                let selected =
                    |pieces: &BoundaryPieces| ctx.tools.settings::<BoundaryTool>().selected_of(pieces);
                let marks =
                    ctx.session.changed_marks(|pieces, marks| pieces.joined(marks, selected(pieces)?));
                ctx.session.set_marks(marks);
            }
            BoundaryCommand::Open(entry) => open_boundary(ctx.session, ctx.background, entry),
            BoundaryCommand::SetOpened(opened) => set_opened(*opened, ctx),
            BoundaryCommand::Level(level) => ctx.tools.settings_mut::<BoundaryTool>().level = level,
        }
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let measures_to_pieces = |layer: &Layer| layer.kind.follows_pieces();
        let is_shown = ctx.tools.tool == &BOUNDARY
            || ctx.view.dock.tab() == Tab::Domain
            || ctx.session.document().active_layer().is_some_and(measures_to_pieces);
        is_shown && ctx.session.find_boundary(ctx.jobs)
    }
}

/// Selects or splits what is at a point, at most `reach` away.
fn click(point: DVec2, reach: f64, ctx: &mut Ctx<'_>) {
    ctx.tools.note_use(&BOUNDARY);
    if ctx.tools.settings::<BoundaryTool>().mode == BoundaryToolMode::Split {
        let marks = ctx.session.changed_marks(|pieces, marks| pieces.split(marks, point, reach));
        return ctx.session.set_marks(marks);
    }
    let piece = ctx.session.boundary_pieces().and_then(|pieces| {
        let (piece, _) = pieces.nearest(point, reach)?;
        Some(pieces.list()[piece].middle())
    });
    ctx.tools.settings_mut::<BoundaryTool>().selected = piece;
}
