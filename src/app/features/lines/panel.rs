//! The lines, with what of each is on edges of the mesh, and what can be done with the selected one.

use eframe::egui::{Color32, Frame, Margin, Ui};

use super::files::ADD_LINES;
use super::places::{fit_in, reason};
use super::{LineToolMode, LinesCommand};
use crate::app::features::lines::LineTool;
use meshbrush_core::domain::Line;
use meshbrush_core::outline::LineFit;
use meshbrush_kit::kit::command::{Command, FileCommand, ViewCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, name_field, remark};
use meshbrush_mesh::geometry::Rect;
use meshbrush_ui::theme::tokens;
use meshbrush_ui::widgets::{Section, ValueRow, format};

/// All lines of the document.
pub static LINES: Panel = Panel { name: "lines", tab: Tab::Domain, place: 1, show };

/// The most lines in the list.
const MOST_ROWS: usize = 50;
/// By how much the ground of the selected row is wider than its text, in points.
const GROUND_MARGIN: i8 = 6;
/// Space around a line that is shown as a whole, as a share of its size.
const SPACE_AROUND: f64 = 0.1;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let lines = &state.session.document().settings().lines;
    let note = if lines.is_empty() { String::new() } else { format::count(lines.len() as u64) };
    let section = Section::new("Lines").note(&note).closed().reveal(LINES.is_revealed(state));
    section.show(ui, |ui| {
        if lines.is_empty() {
            remark(
                ui,
                "The mesh that files get can have edges along lines, such as a breakwater or a thalweg. Draw them with \
                 the line tool[ ({line})], or add them from a file.",
            );
        }
        let selected = state.tools.settings::<LineTool>().selected_in(lines);
        for (number, line) in lines.iter().enumerate().take(MOST_ROWS) {
            // Lines of files can have the same name.
            ui.push_id(number, |ui| line_row(ui, state, (number, line), selected == Some(number), commands));
        }
        if lines.len() > MOST_ROWS {
            remark(ui, "Click the others on the canvas, with Move corners of the line tool.");
        }
        if let Some(number) = selected {
            ui.add_space(4.0);
            selected_rows(ui, state, (number, &lines[number]), commands);
        }
        buttons(ui, selected, lines, commands);
    });
}

/// Shows how much of a line is on edges. A click selects it.
fn line_row(
    ui: &mut Ui,
    state: &FrameState<'_>,
    (number, line): (usize, &Line),
    is_selected: bool,
    commands: &mut Vec<Command>,
) {
    let fit = fit_in(state.session, number);
    let label = if line.weir().is_some() { format!("{} (weir)", line.name) } else { line.name.clone() };
    let value = fit.map_or("…".to_owned(), share_on_edges);
    let is_whole = fit.is_none_or(|fit| fit.unresolved.is_empty());
    let help = "How much of the line is on edges of the mesh. A click selects it.";
    let ground = if is_selected { tokens(ui).field } else { Color32::TRANSPARENT };
    // The ground reaches beyond the text, which stays aligned with that of other rows.
    let [beyond, within] = [-GROUND_MARGIN, GROUND_MARGIN].map(|margin| Margin::symmetric(margin, 0));
    let frame = Frame::new().fill(ground).corner_radius(4).outer_margin(beyond).inner_margin(within);
    let row = ValueRow::new(&label, &value).help(help).stands_out(!is_whole).link();
    let row = frame.show(ui, |ui| row.show(ui));
    if row.inner.clicked() {
        commands.push(Command::from(LinesCommand::Select((!is_selected).then_some(number))));
    }
}

/// Returns the share of a line on edges: never 100 % where a part is not.
fn share_on_edges(fit: &LineFit) -> String {
    let share = 100.0 * fit.length_on_edges / fit.length.max(f64::MIN_POSITIVE);
    let most = if fit.unresolved.is_empty() { 100.0 } else { 99.9 };
    format!("{} %", format::fixed(share.min(most), 1))
}

/// Name and length of the selected line, and the places where it is not on edges.
fn selected_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    (number, line): (usize, &Line),
    commands: &mut Vec<Command>,
) {
    if let Some(name) = name_field(ui, "line", &line.name) {
        commands.push(Command::from(LinesCommand::Rename(number, name)));
    }
    let length = format::length(line.length(), state.unit());
    _ = ValueRow::new("Length", &length).help("Length of the line, in the unit of the document.").show(ui);
    if let Some(fit) = fit_in(state.session, number) {
        place_rows(ui, state, fit, commands);
    }
}

/// A click goes from place to place.
fn place_rows(ui: &mut Ui, state: &FrameState<'_>, fit: &LineFit, commands: &mut Vec<Command>) {
    let count = fit.unresolved.len();
    if count == 0 {
        _ = ValueRow::new("Not on edges", "nothing").help("All of the line is on edges.").show(ui);
        return;
    }
    let shown = state.tools.settings::<LineTool>().shown_place.filter(|&place| place < count);
    let places = if count == 1 { "place" } else { "places" };
    let value = match shown {
        Some(place) => format!("{} of {}", format::count(place as u64 + 1), format::count(count as u64)),
        None => format!("{} {places}", format::count(count as u64)),
    };
    let help = "Where the line is not on edges of the mesh. A click goes to the next place.";
    if ValueRow::new("Not on edges", &value).help(help).stands_out(true).link().show(ui).clicked() {
        let next = shown.map_or(0, |place| place + 1);
        commands.push(Command::from(LinesCommand::ShowPlace(next)));
    }
    remark(ui, &reason(&fit.unresolved[shown.unwrap_or(0)], state.unit()));
}

fn buttons(ui: &mut Ui, selected: Option<usize>, lines: &[Line], commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    if let Some(number) = selected {
        let area = area_of(&lines[number]);
        let show = Command::from(ViewCommand::ShowArea(area.unwrap_or(Rect::UNIT)));
        let row = [
            ("Zoom to line", area.is_some(), show),
            ("Delete line", true, Command::from(LinesCommand::Remove(number))),
        ];
        button_rows(ui, [row], commands);
    }
    let draw = Command::from(LinesCommand::Mode(LineToolMode::Corners));
    let rows = [
        vec![("Draw lines", true, draw), ("Add lines…", true, Command::from(FileCommand::Ask(&ADD_LINES)))],
        vec![("Delete all lines", !lines.is_empty(), Command::from(LinesCommand::RemoveAll))],
    ];
    button_rows(ui, rows, commands);
}

/// Returns an area around a line; `None` where it has no finite corner.
fn area_of(line: &Line) -> Option<Rect> {
    let area = Rect::holding(line.points.iter().copied().filter(|point| point.is_finite()))?;
    let size = area.size().max_element();
    (size > 0.0).then(|| area.expanded(SPACE_AROUND * size))
}
