//! The lines, with what of each is on edges of the mesh.

use eframe::egui::Ui;

use super::LinesCommand;
use super::files::ADD_LINES;
use meshbrush_core::outline::LineFit;
use meshbrush_kit::kit::command::{Command, FileCommand, ViewCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, remark};
use meshbrush_mesh::geometry::Rect;
use meshbrush_ui::widgets::{Section, ValueRow, format};

/// All lines of the document.
pub static LINES: Panel = Panel { name: "lines", tab: Tab::Domain, place: 1, show };

/// The most lines in the list.
const MOST_ROWS: usize = 50;
/// The area that is shown around a place, in lengths of the part that is not on edges.
const AREA_IN_LENGTHS: f64 = 4.0;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let lines = &state.session.document().settings().lines;
    let note = if lines.is_empty() { String::new() } else { format::count(lines.len() as u64) };
    Section::new("Lines").note(&note).closed().show(ui, |ui| {
        if lines.is_empty() {
            remark(
                ui,
                "The mesh that files get can have edges along lines, such as a breakwater or a thalweg.",
            );
        }
        let fits = state.session.derived().map(|derived| &*derived.line_fits);
        for (number, line) in lines.iter().enumerate().take(MOST_ROWS) {
            let fit = fits.and_then(|fits| fits.get(number)).filter(|fit| fit.name == line.name);
            let label = if line.weir().is_some() { &format!("{} (weir)", line.name) } else { &line.name };
            line_row(ui, label, fit, commands);
        }
        buttons(ui, lines.len(), commands);
    });
}

/// Shows how much of a line is on edges. A click goes to the first place where it is not.
fn line_row(ui: &mut Ui, name: &str, fit: Option<&LineFit>, commands: &mut Vec<Command>) {
    let Some(fit) = fit else {
        ValueRow::new(name, "…").show(ui);
        return;
    };
    let share = 100.0 * fit.length_on_edges / fit.length.max(f64::MIN_POSITIVE);
    let value = format!("{} %", format::fixed(share, 1));
    let Some(first) = fit.unresolved.first() else {
        ValueRow::new(name, &value).help("How much of the line is on edges of the mesh.").show(ui);
        return;
    };
    let help = format!(
        "How much of the line is on edges of the mesh. {} of it are not: a click goes to the first.",
        match fit.unresolved.len() {
            1 => "1 part".to_owned(),
            count => format!("{} parts", format::count(count as u64)),
        }
    );
    let row = ValueRow::new(name, &value).help(&help).stands_out(true).link().show(ui);
    if row.clicked() {
        let area = Rect::around(first.place, AREA_IN_LENGTHS * first.length.max(f64::MIN_POSITIVE));
        commands.push(Command::from(ViewCommand::ShowArea(area)));
    }
}

fn buttons(ui: &mut Ui, count: usize, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    let last = Command::from(LinesCommand::Remove(count.saturating_sub(1)));
    let rows = [
        vec![("Add lines…", true, Command::from(FileCommand::Ask(&ADD_LINES)))],
        vec![
            ("Delete last line", count > 0, last),
            ("Delete all lines", count > 0, Command::from(LinesCommand::RemoveAll)),
        ],
    ];
    button_rows(ui, rows, commands);
}
