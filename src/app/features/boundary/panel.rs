//! The pieces of the boundary: their names, kinds and lengths.

use eframe::egui::{Id, Ui};

use super::{BoundaryCommand, BoundaryToolMode};
use crate::app::command::Command;
use crate::app::kit::{FrameState, Panel, PanelGroup, remark, set_once};
use crate::app::widgets::{ActionButton, Section, TextRow, ValueRow, format, segmented, value_row};
use meshbrush_core::document::Setting;
use meshbrush_core::domain::BoundaryPieces;
use meshbrush_mesh::text::LengthUnit;

/// The pieces, while the boundary tool is selected.
pub static PIECES: Panel = Panel { name: "boundary", group: PanelGroup::Domain, only_with_tool: true, show };

/// Most pieces in the list; the others are on the canvas.
const MOST_ROWS: usize = 200;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(pieces) = state.session.boundary_pieces() else {
        Section::new("Boundary").show(ui, |ui| remark(ui, "The pieces are being found."));
        return;
    };
    let selected = state.tools.boundary.selected_of(pieces);
    let lost = state.session.lost_boundary_pieces().unwrap_or_default();
    let present = pieces.list().len() - lost.len();
    let note = format::count(present as u64);
    Section::new("Boundary").id("boundary").note(&note).show(ui, |ui| {
        let mut mode = state.tools.boundary.mode;
        let choices = [(BoundaryToolMode::Select, "Select"), (BoundaryToolMode::Split, "Split")];
        if segmented(ui, "What a click does", &mut mode, &choices).changed() {
            commands.push(Command::Boundary(BoundaryCommand::Mode(mode)));
        }
        ui.add_space(4.0);
        match (mode, selected) {
            (BoundaryToolMode::Split, _) => {
                remark(ui, "Click the boundary to split it there. A whole ring takes two clicks.");
            }
            (BoundaryToolMode::Select, None) => remark(ui, "Click a piece on the canvas or in the list."),
            (BoundaryToolMode::Select, Some(_)) => {}
        }
        if let Some(selected) = selected {
            selected_rows(ui, state, pieces, selected, commands);
        }
        list(ui, pieces, lost, selected, state.unit(), commands);
    });
}

fn selected_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    pieces: &BoundaryPieces,
    selected: usize,
    commands: &mut Vec<Command>,
) {
    let marks = &state.session.document().settings().boundary_marks;
    let piece = &pieces.list()[selected];
    if let Some(name) = name_row(ui, &piece.name) {
        set_once(Setting::BoundaryMarks(pieces.renamed(marks, selected, &name)), commands);
    }
    value_row(ui, "Kind", piece.kind.name());
    value_row(ui, "Length", &format::length(piece.length(), state.unit()));
    value_row(ui, "Marker in files", &(selected + 1).to_string());
    if let Some(joined) = pieces.joined(marks, selected)
        && ui.add(ActionButton::new("Join with next")).clicked()
    {
        set_once(Setting::BoundaryMarks(joined), commands);
    }
    ui.add_space(8.0);
}

/// The text typed so far, in egui's memory.
#[derive(Clone, Debug, Default)]
struct TypedName {
    text: String,
    /// The name when the text was last equal to it.
    of: String,
}

/// Shows a field for a name. Returns the new name once it is complete.
fn name_row(ui: &mut Ui, current: &str) -> Option<String> {
    let id = Id::unique("name of a piece typed so far");
    let mut typed: TypedName = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    if typed.of != current {
        // Another piece is selected, or the name was changed elsewhere.
        typed = TypedName { text: current.to_owned(), of: current.to_owned() };
    }
    let response = TextRow::new("Name", &mut typed.text).show(ui);
    let changed = typed.text != current;
    let new = (response.lost_focus() && changed).then(|| typed.text.clone());
    ui.data_mut(|data| data.insert_temp(id, typed));
    new
}

/// The pieces that the mesh has, then those that it lacks.
fn list(
    ui: &mut Ui,
    pieces: &BoundaryPieces,
    lost: &[usize],
    selected: Option<usize>,
    unit: LengthUnit,
    commands: &mut Vec<Command>,
) {
    let is_lost = |number: &usize| lost.binary_search(number).is_ok();
    let present = (0..pieces.list().len()).filter(|number| !is_lost(number));
    for number in present.chain(lost.iter().copied()).take(MOST_ROWS) {
        let piece = &pieces.list()[number];
        let value = if is_lost(&number) { "lost".to_owned() } else { format::length(piece.length(), unit) };
        let what =
            if is_lost(&number) { "A piece of which the mesh has no edge" } else { "Length of a piece" };
        let help = format!("{what}; its kind is {}. A click selects it.", piece.kind.name());
        let row = ValueRow::new(&piece.name, &value).help(&help).stands_out(selected == Some(number));
        if row.link().show(ui).clicked() {
            commands.push(Command::Boundary(BoundaryCommand::Select(piece.middle())));
        }
    }
    if pieces.list().len() > MOST_ROWS {
        remark(ui, "Click the others on the canvas.");
    }
}
