//! Runs commands about lines.

use std::sync::Arc;

use super::entries::entries;
use super::files::ROLES;
use super::load::load_lines;
use super::{DocumentLines, LINE_SIZES, LINES, LinesCommand, marks};
use meshbrush_core::document::Setting;
use meshbrush_core::domain::Line;
use meshbrush_kit::kit::{Ctx, Feature, Row};
use meshbrush_mesh::text::Grouped;

impl Feature for DocumentLines {
    type Command = LinesCommand;
    const ROW: Row = Row {
        panels: &[&LINES],
        layer_kinds: &[&LINE_SIZES],
        roles: &ROLES,
        marks: marks::paint,
        entries,
        ..Row::EMPTY
    };

    fn execute(&mut self, command: LinesCommand, ctx: &mut Ctx<'_>) {
        let before = || ctx.session.document().settings().lines.to_vec();
        match command {
            LinesCommand::Open(path) => load_lines(ctx.session, ctx.background, &path),
            LinesCommand::Add(lines, notes) => {
                let added = Grouped(lines.len()).to_string();
                let noun = if lines.len() == 1 { "line" } else { "lines" };
                set_lines([before(), lines].concat(), ctx);
                let note = format!("Added: {added} {noun}. The mesh that files get has edges along them.");
                ctx.session.tell([vec![note], notes].concat().join(" "));
            }
            LinesCommand::Remove(number) => {
                let mut lines = before();
                if number < lines.len() {
                    lines.remove(number);
                    set_lines(lines, ctx);
                }
            }
            LinesCommand::RemoveAll => set_lines(Vec::new(), ctx),
        }
    }
}

/// Gives the document other lines, as a gesture of its own.
fn set_lines(lines: Vec<Line>, ctx: &mut Ctx<'_>) {
    ctx.session.end_gesture();
    ctx.session.set(Setting::Lines(Arc::new(lines)));
    ctx.session.end_gesture();
}
