//! The inspector: the queried point and the triangle around it.

use eframe::egui::Ui;

use super::text::{Inspection, InspectorRow, LayerAnswer, NEIGHBOURS};
use crate::app::features::inspection::InspectCommand;
use meshbrush_kit::kit::command::{Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::readout::{Quantity, Readout, TriangleReadout};
use meshbrush_kit::kit::{FrameState, Panel, Tab};
use meshbrush_mesh::mesh::{Location, TriangleId};
use meshbrush_ui::theme::tokens;
use meshbrush_ui::widgets::{Chip, Icon, Section, ValueRow, chips, empty_state, segmented};

/// The queried triangle, its neighbours, and a quantity in it.
pub static INSPECTOR: Panel = Panel { name: "inspector", tab: Tab::Inspect, place: 0, show };

/// What each layer asks for at the queried point, and the vertices of its triangle.
pub static DETAILS: Panel =
    Panel { name: "layers and vertices", tab: Tab::Inspect, place: 2, show: show_details };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let inspection = state.readout.and_then(|readout| Inspection::of(readout, state.session, state.view));
    let title = inspection.as_ref().map_or("Triangle".into(), Inspection::title);
    let section = Section::new(&title).id("inspector").reveal(INSPECTOR.is_revealed(state));
    let section = section.show(ui, |ui| match (state.readout, inspection) {
        (Some(Readout { triangle: Some(triangle), .. }), Some(inspection)) => {
            triangle_rows(ui, state, triangle, &inspection, commands)
        }
        (Some(readout), _) => {
            no_triangle(ui, readout);
            None
        }
        (None, _) => {
            let text = "Click the mesh with the query tool[ ({query})]: triangle, neighbours and values appear here.";
            empty_state(ui, Icon::QUERY, "No query yet", text);
            None
        }
    });
    let hovered = section.flatten();
    if hovered != state.view.hovered_neighbour {
        commands.push(Command::from(ViewCommand::HighlightNeighbour(hovered)));
    }
}

/// Shows the target diameters of the layers at the queried point, and the vertices of the triangle.
fn show_details(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(inspection) =
        state.readout.and_then(|readout| Inspection::of(readout, state.session, state.view))
    else {
        return;
    };
    Section::new("Layers and vertices").show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        layer_rows(ui, &inspection, commands);
        ui.add_space(4.0);
        copied_rows(ui, &inspection.corner_rows(), commands);
    });
}

/// Everything about a triangle. Returns the neighbour under the pointer.
fn triangle_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    triangle: &TriangleReadout,
    inspection: &Inspection<'_>,
    commands: &mut Vec<Command>,
) -> Option<TriangleId> {
    // Pins are in sight below it.
    ui.spacing_mut().item_spacing.y = 0.0;
    copied_rows(ui, &inspection.place_rows(), commands);
    let hovered = neighbour_chips(ui, triangle, inspection, commands);
    let mut quantity = state.view.quantity;
    let choices = [(Quantity::TargetDiameter, "h̄"), (Quantity::Risk, "Risk")];
    if segmented(ui, "Quantity", &mut quantity, &choices).changed() {
        commands.push(Command::from(InspectCommand::Interpolate(quantity)));
    }
    copied_rows(ui, &inspection.quantity_rows(), commands);
    hovered
}

/// Shows the target diameter of each visible layer at the point, and marks the layer that decides.
fn layer_rows(ui: &mut Ui, inspection: &Inspection<'_>, commands: &mut Vec<Command>) {
    copied_rows(ui, &inspection.decision_rows(), commands);
    for (number, LayerAnswer { row, decides }) in inspection.layer_answers().iter().enumerate() {
        ui.push_id(number, |ui| {
            let value = ValueRow::new(&row.label, &row.shown).stands_out(*decides).copies(&row.exact);
            if value.help(LAYER_HELP).show(ui).clicked() {
                commands.push(Command::from(ShellCommand::Copy(row.exact.clone())));
            }
        });
    }
}

const LAYER_HELP: &str = "What this layer alone asks for at the point, before the layers are combined.";

/// Rows that a click copies, in full.
fn copied_rows(ui: &mut Ui, rows: &[InspectorRow], commands: &mut Vec<Command>) {
    for row in rows {
        let help = if row.label.starts_with('v') { VERTEX_HELP } else { "" };
        if ValueRow::new(&row.label, &row.shown).help(help).copies(&row.exact).show(ui).clicked() {
            commands.push(Command::from(ShellCommand::Copy(row.exact.clone())));
        }
    }
}

/// Shows the three neighbours as chips in their colours on the canvas; a click queries one. Returns the one
/// under the pointer.
fn neighbour_chips(
    ui: &mut Ui,
    triangle: &TriangleReadout,
    inspection: &Inspection<'_>,
    commands: &mut Vec<Command>,
) -> Option<TriangleId> {
    let colors = tokens(ui).neighbours;
    ui.add_space(4.0);
    let mut hovered = None;
    chips(ui, |ui| {
        for (i, neighbour) in triangle.neighbours.iter().enumerate() {
            let id = neighbour.triangle();
            let text = id.map_or("edge".into(), |id| inspection.number(id.index()));
            let chip = Chip::new(colors[i], &text, NEIGHBOURS[i]).number(i + 1).help(NEIGHBOUR_HELP[i]);
            let response = chip.enabled(id.is_some()).show(ui);
            if response.clicked() {
                let follows = ui.input(|input| input.modifiers.shift);
                let follow = Some(Command::from(InspectCommand::FollowNeighbour(i))).filter(|_| follows);
                commands.extend(follow.or(id.map(|id| Command::from(InspectCommand::QueryTriangle(id)))));
            }
            hovered = id.filter(|_| response.hovered()).or(hovered);
        }
    });
    ui.add_space(4.0);
    hovered
}

const VERTEX_HELP: &str = "A vertex with its number in files, and its x and y in the unit of the document.";

const NEIGHBOUR_HELP: [&str; 3] = [
    "The neighbour across the bisection edge. With the query tool, key 1 goes there; Shift keeps the trail.",
    "The second neighbour, anticlockwise. With the query tool, key 2 goes there; Shift keeps the trail.",
    "The third neighbour, anticlockwise. With the query tool, key 3 goes there; Shift keeps the trail.",
];

fn no_triangle(ui: &mut Ui, readout: &Readout) {
    let text = match readout.location {
        Location::OutsideDomain => "The point lies in a hole of the domain, or beyond its outline.",
        Location::Invalid => "The point is not a number.",
        _ => "The point lies outside the domain.",
    };
    empty_state(ui, Icon::QUERY, "No triangle here", text);
}
