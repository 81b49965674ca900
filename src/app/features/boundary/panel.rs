//! The pieces of the boundary: their kinds, types and lengths.

use eframe::egui::{ScrollArea, Ui};

use super::BoundaryCommand;
use crate::app::command::Command;
use crate::app::kit::{FrameState, Panel, Tab, remark, set_once};
use crate::app::widgets::{Section, ValueRow, dropdown_row, format, value_row};
use meshbrush_core::document::Setting;
use meshbrush_core::domain::{BoundaryPieces, BoundaryType};
use meshbrush_mesh::text::LengthUnit;

/// The pieces, and what is known of the selected one.
pub static PIECES: Panel = Panel { name: "boundary", tab: Tab::Domain, place: 2, show };

/// Height of the list, in points; more pieces scroll.
const LIST_HEIGHT: f32 = 200.0;
/// Most pieces in the list; the others are on the canvas.
const MOST_ROWS: usize = 200;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(pieces) = state.session.boundary_pieces() else {
        let text = "The pieces are being found.";
        Section::new("Boundary").id("boundary").show(ui, |ui| remark(ui, text));
        return;
    };
    let selected = state.tools.boundary.selected_of(pieces);
    let lost = state.session.lost_boundary_pieces().unwrap_or_default();
    let present = pieces.list().len() - lost.len();
    let note = format::count(present as u64);
    Section::new("Boundary").id("boundary").note(&note).show(ui, |ui| {
        if selected.is_none() {
            remark(ui, "Click a piece in the list, or on the canvas with the boundary tool[ ({boundary})], to name it and to set its type.");
        }
        if let Some(selected) = selected {
            selected_rows(ui, state, pieces, selected, commands);
        }
        let area = ScrollArea::vertical().id_salt("pieces").max_height(LIST_HEIGHT);
        area.min_scrolled_height(LIST_HEIGHT).show(ui, |ui| {
            list(ui, pieces, lost, selected, state.unit(), commands);
        });
    });
}

fn selected_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    pieces: &BoundaryPieces,
    selected: usize,
    commands: &mut Vec<Command>,
) {
    let piece = &pieces.list()[selected];
    value_row(ui, "Kind", piece.kind.name());
    let usual = format!("usual ({})", piece.usual_type().word());
    let types = BoundaryType::ALL.map(|boundary_type| (Some(boundary_type), boundary_type.word()));
    let choices = [&[(None, usual.as_str())], &types[..]].concat();
    let mut chosen = piece.set_type;
    if dropdown_row(ui, "Type", &mut chosen, &choices).changed() {
        let marks = &state.session.document().settings().boundary_marks;
        set_once(Setting::BoundaryMarks(pieces.retyped(marks, selected, chosen)), commands);
    }
    value_row(ui, "Length", &format::length(piece.length(), state.unit()));
    value_row(ui, "Marker in files", &(selected + 1).to_string());
    ui.add_space(8.0);
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
        let (kind, boundary_type) = (piece.kind.name(), piece.boundary_type().word());
        let help = format!("{what}; its kind is {kind}, its type {boundary_type}. A click selects it.");
        let row = ValueRow::new(&piece.name, &value).help(&help).stands_out(selected == Some(number));
        if row.link().show(ui).clicked() {
            commands.push(Command::Boundary(BoundaryCommand::Select(piece.middle())));
        }
    }
    if pieces.list().len() > MOST_ROWS {
        remark(ui, "Click the others on the canvas.");
    }
}
