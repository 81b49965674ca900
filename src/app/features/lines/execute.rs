//! Runs commands about lines.

use std::sync::Arc;

use glam::DVec2;

use super::deepest::{NO_DEPTHS, find_way, has_depths};
use super::entries::entries;
use super::files::ROLES;
use super::gestures::GESTURES;
use super::load::load_lines;
use super::places::fit_in;
use super::{DocumentLines, LINE, LINE_SIZES, LINES, LineEnd, LineToolMode, LinesCommand, marks};
use crate::app::features::lines::LineTool;
use meshbrush_core::document::Setting;
use meshbrush_core::domain::{Line, LineKind};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::{Ctx, Feature, Row};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::Grouped;

/// Most letters of a name.
const LONGEST_NAME: usize = 80;
/// The area that is shown around a place, in lengths of the part that is not on edges.
const AREA_IN_LENGTHS: f64 = 4.0;

impl Feature for DocumentLines {
    type Command = LinesCommand;
    const ROW: Row = Row {
        tools: &[&LINE],
        panels: &[&LINES],
        layer_kinds: &[&LINE_SIZES],
        roles: &ROLES,
        gestures: &GESTURES,
        marks_below: marks::paint,
        entries,
        ..Row::EMPTY
    };

    fn execute(&mut self, command: LinesCommand, ctx: &mut Ctx<'_>) {
        let tool = ctx.tools.settings_mut::<LineTool>();
        match command {
            LinesCommand::Open(path) => load_lines(ctx.session, ctx.background, &path),
            LinesCommand::Add(lines, notes) => add_read(lines, notes, ctx),
            LinesCommand::Remove(number) => remove(number, ctx),
            LinesCommand::RemoveAll => set_lines(Vec::new(), ctx),
            LinesCommand::Mode(mode) => use_mode(mode, ctx),
            LinesCommand::Snaps(snaps) => tool.snaps = snaps,
            LinesCommand::AddCorner(corner) => tool.corners.push(corner),
            LinesCommand::MoveCorner(index, corner) => {
                if let Some(place) = tool.corners.get_mut(index) {
                    *place = corner;
                }
            }
            LinesCommand::RemoveCorner => _ = tool.corners.pop(),
            LinesCommand::End(end) => end_line(end, ctx),
            LinesCommand::Draw(points, end) => add_drawn("line", points, end, ctx),
            LinesCommand::WayAt(point) => set_end_of_way(point, ctx),
            LinesCommand::AddWay(points) => add_drawn("deepest way", points, LineEnd::Open, ctx),
            LinesCommand::Select(number) => select(number, ctx),
            LinesCommand::Rename(number, name) => rename(number, &name, ctx),
            LinesCommand::ShowPlace(place) => show_place(place, ctx),
            LinesCommand::TakeCorner(corner) => tool.corner = corner,
            LinesCommand::DragCorner(index, to) => edit_selected(ctx, |line| {
                if let Some(corner) = line.points.get_mut(index) {
                    *corner = to;
                }
            }),
            LinesCommand::InsertCorner(index, at) => {
                tool.corner = Some(index);
                edit_selected(ctx, |line| {
                    if index <= line.points.len() {
                        line.points.insert(index, at);
                    }
                });
            }
            LinesCommand::Delete => delete(ctx),
        }
    }

    /// Corners snap to the pieces of the boundary.
    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        ctx.tools.tool == &LINE && ctx.session.find_boundary(ctx.jobs)
    }

    fn put_down(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let tool = ctx.tools.settings_mut::<LineTool>();
        let had_corners = !std::mem::take(&mut tool.corners).is_empty();
        tool.way_from.take().is_some() || had_corners
    }
}

/// Selects the tool and what a press does.
fn use_mode(mode: LineToolMode, ctx: &mut Ctx<'_>) {
    ctx.tools.settings_mut::<LineTool>().mode = mode;
    ctx.tools.select(&LINE);
    if mode == LineToolMode::DeepestWay && !has_depths(ctx.session.document().settings()) {
        ctx.session.tell(NO_DEPTHS.into());
    }
}

/// Sets the first end of the deepest way, or begins to look for the way to the other one.
fn set_end_of_way(point: DVec2, ctx: &mut Ctx<'_>) {
    if !has_depths(ctx.session.document().settings()) {
        return ctx.session.tell(NO_DEPTHS.into());
    }
    match ctx.tools.settings_mut::<LineTool>().way_from.take() {
        Some(from) if from != point => find_way([from, point], ctx),
        _ => ctx.tools.settings_mut::<LineTool>().way_from = Some(point),
    }
}

fn lines<'a>(ctx: &'a Ctx<'_>) -> &'a Arc<Vec<Line>> {
    &ctx.session.document().settings().lines
}

/// Gives the document other lines, as a gesture of its own.
fn set_lines(lines: Vec<Line>, ctx: &mut Ctx<'_>) {
    ctx.session.end_gesture();
    ctx.session.set(Setting::Lines(Arc::new(lines)));
    ctx.session.end_gesture();
}

fn add_read(added: Vec<Line>, notes: Vec<String>, ctx: &mut Ctx<'_>) {
    let count = Grouped(added.len()).to_string();
    let noun = if added.len() == 1 { "line" } else { "lines" };
    set_lines([lines(ctx).to_vec(), added].concat(), ctx);
    let note = format!("Added: {count} {noun}. The mesh that files get has edges along them.");
    ctx.session.tell([vec![note], notes].concat().join(" "));
}

fn remove(number: usize, ctx: &mut Ctx<'_>) {
    let mut lines = lines(ctx).to_vec();
    if number < lines.len() {
        lines.remove(number);
        set_lines(lines, ctx);
        ctx.tools.settings_mut::<LineTool>().select(None);
    }
}

/// Adds the line that is being drawn to the document, or says what it lacks.
fn end_line(end: LineEnd, ctx: &mut Ctx<'_>) {
    let count = ctx.tools.settings::<LineTool>().corners.len();
    let (least, problem) = match end {
        LineEnd::Open => (2, "A line needs two corners: click to set another one."),
        LineEnd::Closed => (3, "A closed line needs three corners: click to set another one."),
    };
    if count < least {
        return ctx.session.tell(problem.into());
    }
    let points = std::mem::take(&mut ctx.tools.settings_mut::<LineTool>().corners);
    add_drawn("line", points, end, ctx);
}

/// Adds a line, and selects it. Its name is a word with the least number that no line has.
fn add_drawn(word: &str, mut points: Vec<DVec2>, end: LineEnd, ctx: &mut Ctx<'_>) {
    points.dedup();
    let mut all = lines(ctx).to_vec();
    let names = (1..).map(|number| format!("{word} {number}"));
    let name = names.into_iter().find(|name| all.iter().all(|line| line.name != *name));
    let name = name.unwrap_or_else(|| word.to_owned());
    all.push(Line { name, points, closed: end == LineEnd::Closed, kind: LineKind::default() });
    let number = all.len() - 1;
    set_lines(all, ctx);
    ctx.tools.note_use(&LINE);
    select(Some(number), ctx);
}

/// Selects a line, and shows its row in the list.
fn select(number: Option<usize>, ctx: &mut Ctx<'_>) {
    let number = number.filter(|&number| number < lines(ctx).len());
    ctx.tools.settings_mut::<LineTool>().select(number);
    if number.is_some() {
        ctx.view.revealed_panel = Some(LINES.name);
    }
}

fn rename(number: usize, name: &str, ctx: &mut Ctx<'_>) {
    let valid: String = name.trim().chars().filter(|c| !c.is_control()).take(LONGEST_NAME).collect();
    let mut all = lines(ctx).to_vec();
    match all.get_mut(number) {
        Some(_) if valid.is_empty() => {
            ctx.session
                .tell("The line keeps its name, as an empty name would not tell it from others.".into());
        }
        Some(line) if line.name != valid => {
            line.name = valid;
            set_lines(all, ctx);
        }
        _ => {}
    }
}

/// Shows a place where the selected line is not on edges. After the last one comes the first.
fn show_place(place: usize, ctx: &mut Ctx<'_>) {
    let tool = ctx.tools.settings::<LineTool>();
    let Some(number) = tool.selected_in(lines(ctx)) else { return };
    let Some(fit) = fit_in(ctx.session, number).filter(|fit| !fit.unresolved.is_empty()) else { return };
    let place = place % fit.unresolved.len();
    let part = fit.unresolved[place];
    ctx.tools.settings_mut::<LineTool>().shown_place = Some(place);
    let area = Rect::around(part.place, AREA_IN_LENGTHS * part.length.max(f64::MIN_POSITIVE));
    ctx.send(Command::from(ViewCommand::ShowArea(area)));
}

/// Changes the selected line. Further changes join the gesture.
fn edit_selected(ctx: &mut Ctx<'_>, edit: impl FnOnce(&mut Line)) {
    let mut all = lines(ctx).to_vec();
    if let Some(number) = ctx.tools.settings::<LineTool>().selected_in(&all) {
        edit(&mut all[number]);
        ctx.session.set(Setting::Lines(Arc::new(all)));
    }
}

/// Deletes the corner that was taken hold of last, or else the selected line.
fn delete(ctx: &mut Ctx<'_>) {
    let tool = ctx.tools.settings::<LineTool>();
    let all = lines(ctx);
    let Some((number, corner)) = tool.corner_in(all) else {
        if let Some(number) = tool.selected_in(all) {
            remove(number, ctx);
        }
        return;
    };
    let least = if all[number].closed { 3 } else { 2 };
    if all[number].points.len() <= least {
        let problem =
            "The corner was not deleted: a line needs two corners, and a closed one three. Delete the line.";
        return ctx.session.tell(problem.into());
    }
    ctx.session.end_gesture();
    edit_selected(ctx, |line| _ = line.points.remove(corner));
    ctx.session.end_gesture();
    ctx.tools.settings_mut::<LineTool>().corner = None;
}
