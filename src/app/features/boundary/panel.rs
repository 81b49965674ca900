//! The pieces of the boundary: their kinds, types and lengths.

use eframe::egui::{Key, ScrollArea, Ui};

use super::{BoundaryCommand, OPEN_IN_POLYGONS};
use crate::app::features::boundary::BoundaryTool;
use meshbrush_core::document::Setting;
use meshbrush_core::domain::{BoundaryPieces, BoundaryType};
use meshbrush_core::layers::DepthSurface;
use meshbrush_io::io::settings::SavedOpen;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, remark, set_once};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::{
    ActionButton, NumberRow, Section, TextRow, ValueRow, dropdown_row, format, value_row,
};

/// The pieces, and what is known of the selected one.
pub static PIECES: Panel = Panel { name: "boundary", tab: Tab::Domain, place: 2, show };

/// What a box is.
const BOX_RULE: &str = "write west, south, east and north, as in -6, 48, -5, 50.";
/// Height of the list, in points; more pieces scroll.
const LIST_HEIGHT: f32 = 200.0;
/// Most pieces in the list; the others are on the canvas.
const MOST_ROWS: usize = 200;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(pieces) = state.session.boundary_pieces() else {
        // As high as with the pieces, so that the panel does not scroll meanwhile.
        Section::new("Boundary").id("boundary").show(ui, |ui| {
            remark(ui, "The pieces are being found.");
            ui.add_space(LIST_HEIGHT);
            opening_rows(ui, state, commands);
        });
        return;
    };
    let selected = state.tools.settings::<BoundaryTool>().selected_of(pieces);
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
        opening_rows(ui, state, commands);
    });
}

/// Where to open the boundary in one step.
fn opening_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    ui.add_space(8.0);
    remark(ui, "Open in one step where the sea goes on. Islands stay land.");
    let row = [
        ("Along the frame", true, Command::from(BoundaryCommand::Open(SavedOpen::Frame))),
        ("In polygons…", true, Command::from(FileCommand::Ask(&OPEN_IN_POLYGONS))),
    ];
    button_rows(ui, [row], commands);
    ui.add_space(4.0);
    let mut level = state.tools.settings::<BoundaryTool>().level;
    let row = NumberRow::new("Deeper than", &mut level).range(f64::MIN..=f64::MAX).unit("m");
    if row.help("The depth of water beyond which the boundary is opened.").show(ui).changed() {
        commands.push(Command::from(BoundaryCommand::Level(level)));
    }
    let has_depths = DepthSurface::of(&state.session.document().settings().layers).is_some();
    let deeper = ActionButton::new("Open where deeper");
    if ui.add_enabled_ui(has_depths, |ui| ui.add(deeper)).inner.clicked() {
        commands.push(Command::from(BoundaryCommand::Open(SavedOpen::Deeper(level))));
    }
    ui.add_space(4.0);
    box_row(ui, state, commands);
}

/// The box in which to open the boundary. What is typed is in egui's memory.
fn box_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let id = ui.make_persistent_id(("box to open", state.session.document_id()));
    let mut text: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let row = TextRow::new("In a box", &mut text).hint("W, S, E, N");
    let help =
        "Enter opens the boundary in the box: in degrees on the Earth, or else in the unit of the document.";
    let response = row.help(help).show(ui);
    let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if is_entered && !text.trim().is_empty() {
        commands.push(match SavedOpen::parse(&text) {
            Ok(entry @ SavedOpen::Box(_)) => Command::from(BoundaryCommand::Open(entry)),
            Ok(_) => Command::from(ShellCommand::Report(format!("“{text}” is no box: {BOX_RULE}"))),
            Err(problem) => Command::from(ShellCommand::Report(problem)),
        });
    }
    ui.data_mut(|data| data.insert_temp(id, text));
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
    let default = format!("default ({})", piece.default_type().word());
    let types = BoundaryType::ALL.map(|boundary_type| (Some(boundary_type), boundary_type.word()));
    let choices = [&[(None, default.as_str())], &types[..]].concat();
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
            commands.push(Command::from(BoundaryCommand::Select(piece.middle())));
        }
    }
    if pieces.list().len() > MOST_ROWS {
        remark(ui, "Click the others on the canvas.");
    }
}
