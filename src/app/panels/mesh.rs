//! The mesh: coarse spacing, refinement rule and budgets.

use eframe::egui::Ui;

use super::{Panel, end_gesture_when_released, remark, set_once};
use crate::app::command::Command;
use crate::app::frame::FrameState;
use crate::app::widgets::{NumberRow, Section, SliderRow, format, segmented, value_row};
use crate::document::{LEAST_MEMORY, Setting};
use crate::field::RefinementRule;

/// Triangles in a million.
const MILLION: f64 = 1e6;
/// Bytes in a gigabyte.
const BILLION: f64 = 1e9;

/// Coarse spacing, refinement rule and budgets.
pub static MESH: Panel = Panel { name: "mesh", only_with_tool: false, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Mesh").closed().show(ui, |ui| {
        spacing_rows(ui, state, commands);
        rule_row(ui, state, commands);
        budget_rows(ui, state, commands);
    });
}

fn spacing_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let extent = settings.domain.bounds.size().max_element();
    let mut spacing = settings.spacing;
    let help = "Side of a coarse cell. Cells are a little smaller where that fits the domain better.";
    let range = extent / 250.0..=extent;
    let slider = SliderRow::new("Spacing δ", &mut spacing, range).logarithmic();
    let response = slider.unit(state.unit().symbol()).help(help).show(ui);
    if response.changed() {
        commands.push(Command::Set(Setting::Spacing(spacing)));
    }
    end_gesture_when_released(&response, commands);
    let [columns, rows] = state.session.mesh().lattice().cells();
    value_row(ui, "Coarse grid", &format!("{columns} × {rows}"));
}

fn rule_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut rule = state.session.document().settings().rule;
    let choices = [(RefinementRule::Area, "Area rule"), (RefinementRule::Vertex, "Vertex rule")];
    if segmented(ui, "Refinement rule", &mut rule, &choices).changed() {
        set_once(Setting::RefinementRule(rule), commands);
    }
    let text = match rule {
        RefinementRule::Area => "A triangle obeys h̄ everywhere inside it: no stroke is missed.",
        RefinementRule::Vertex => {
            "The report's rule: h̄ counts at the three corners only. A stroke that passes between the nodes leaves \
             no trace, and every edit builds the mesh from scratch."
        }
    };
    remark(ui, text);
}

fn budget_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let mut millions = settings.max_triangles as f64 / MILLION;
    let mut gigabytes = settings.max_memory as f64 / BILLION;
    let help =
        "Most triangles, in millions. A stroke that would need more stops there; a setting is taken back.";
    let row = NumberRow::new("Triangle budget", &mut millions).range(0.001..=100.0).unit("M").help(help);
    if row.show(ui).changed() {
        let max_triangles = (millions * MILLION).round() as usize;
        set_once(Setting::MaxTriangles(max_triangles), commands);
    }
    let help = "Most memory, in gigabytes, for the mesh and for the next one while that is built: 86 bytes a triangle. \
                The smaller of the two budgets counts.";
    let least = LEAST_MEMORY as f64 / BILLION;
    let row = NumberRow::new("Memory budget", &mut gigabytes).range(least..=1000.0).unit("GB").help(help);
    if row.show(ui).changed() {
        let max_memory = (gigabytes * BILLION).round() as usize;
        set_once(Setting::MaxMemory(max_memory), commands);
    }
    let bytes = state.session.mesh().bytes() as f64;
    value_row(ui, "Memory in use", &format!("{} MB", format::fixed(bytes / MILLION, 1)));
}
