//! The inspector: the queried point and the triangle around it.

use eframe::egui::{Color32, Ui};
use glam::DVec2;

use super::Panel;
use crate::app::command::Command;
use crate::app::frame::FrameState;
use crate::app::readout::{Quantity, Readout, TriangleReadout};
use crate::app::session::Session;
use crate::app::theme::tokens;
use crate::app::widgets::{Chip, Icon, Section, ValueRow, chips, empty_state, format, segmented, value_row};
use crate::mesh::{Location, Neighbour, Orientation, TriangleId};
use crate::text::LengthUnit;

/// The queried triangle, its neighbours, and a quantity in it.
pub static INSPECTOR: Panel = Panel { name: "inspector", only_with_tool: false, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let title = match state.readout.and_then(|readout| readout.location.triangle()) {
        Some(id) => format!("Triangle {}", number(state.session, id.index())),
        None => "Triangle".to_owned(),
    };
    let section = Section::new(&title).id("inspector").show(ui, |ui| match state.readout {
        None => {
            let text = "Click the mesh with the query tool (Q): triangle, neighbours and values appear here.";
            empty_state(ui, Icon::QUERY, "No query yet", text);
            None
        }
        Some(Readout { triangle: Some(triangle), location, point }) => {
            triangle_rows(ui, state, triangle, *location, *point, commands)
        }
        Some(readout) => {
            no_triangle(ui, readout);
            None
        }
    });
    let hovered = section.flatten();
    if hovered != state.view.hovered_neighbour {
        commands.push(Command::HighlightNeighbour(hovered));
    }
}

/// Everything about a triangle. Returns the neighbour under the pointer.
fn triangle_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    triangle: &TriangleReadout,
    location: Location,
    point: DVec2,
    commands: &mut Vec<Command>,
) -> Option<TriangleId> {
    let orientation = match triangle.orientation {
        Orientation::Clockwise => "clockwise",
        Orientation::Anticlockwise => "anticlockwise",
    };
    let step = state.view.world_per_px();
    let unit = state.unit();
    let place = |p: DVec2| [p.x, p.y].map(|value| format::coordinate(value, step, unit)).join(" ");
    value_row(ui, "Level · orientation", &format!("{} · {orientation}", triangle.level));
    value_row(ui, "Diameter", &format::length(triangle.diameter, unit));
    value_row(ui, "Point", &place(point));
    if let Some(on) = where_on(location) {
        value_row(ui, "Lies", on);
    }
    let [a, b, c] = triangle.zeta.map(|zeta| format::fixed(zeta, 3));
    value_row(ui, "ζ₁ ζ₂ ζ₃", &format!("{a} {b} {c}"));
    let hovered = neighbour_chips(ui, state.session, triangle, commands);
    quantity_rows(ui, state, triangle, commands);
    ui.add_space(4.0);
    for (i, (node, corner)) in triangle.vertices.iter().enumerate() {
        let label = format!("v{} · {}", ["₁", "₂", "₃"][i], number(state.session, node.index()));
        let help = "A vertex with its number in files, and its x and y in the unit of the document.";
        ValueRow::new(&label, &place(*corner)).help(help).show(ui);
    }
    hovered
}

/// The three neighbours as chips in their colours on the canvas; a click queries one. Returns the one under
/// the pointer.
fn neighbour_chips(
    ui: &mut Ui,
    session: &Session,
    triangle: &TriangleReadout,
    commands: &mut Vec<Command>,
) -> Option<TriangleId> {
    let colors = tokens(ui).neighbours;
    ui.add_space(4.0);
    let mut hovered = None;
    chips(ui, |ui| {
        for (i, neighbour) in triangle.neighbours.iter().enumerate() {
            hovered = neighbour_chip(ui, session, i, *neighbour, colors[i], commands).or(hovered);
        }
    });
    ui.add_space(4.0);
    hovered
}

fn neighbour_chip(
    ui: &mut Ui,
    session: &Session,
    i: usize,
    neighbour: Neighbour,
    color: Color32,
    commands: &mut Vec<Command>,
) -> Option<TriangleId> {
    let name = ["Bisection neighbour", "Second neighbour", "Third neighbour"][i];
    let text = neighbour.triangle().map_or("edge".into(), |id| number(session, id.index()));
    let response = Chip::new(color, &text, name).enabled(neighbour.triangle().is_some()).show(ui);
    let id = neighbour.triangle()?;
    if response.clicked() {
        commands.push(Command::QueryTriangle(id));
    }
    response.hovered().then_some(id)
}

fn quantity_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    triangle: &TriangleReadout,
    commands: &mut Vec<Command>,
) {
    let shown = state.view.quantity;
    let mut quantity = shown;
    let choices = [(Quantity::TargetDiameter, "h̄"), (Quantity::Risk, "Risk")];
    if segmented(ui, "Quantity", &mut quantity, &choices).changed() {
        commands.push(Command::Inspect(quantity));
    }
    let unit = match shown {
        Quantity::TargetDiameter => state.unit(),
        Quantity::Risk => LengthUnit::None,
    };
    let number = |value: f64| format::significant(value, 4);
    let [a, b, c] = triangle.at_vertices.map(number);
    value_row(ui, "At v₁ v₂ v₃", &unit.after(&format!("{a} {b} {c}")));
    value_row(ui, "Interpolated", &unit.after(&number(triangle.interpolated)));
    let difference = triangle.interpolated - triangle.exact;
    let sign = match difference {
        d if d < 0.0 => "−",
        d if d > 0.0 => "+",
        _ => "",
    };
    let exact = unit.after(&number(triangle.exact));
    let exact = format!("{exact} ({sign}{})", format::significant(difference.abs(), 2));
    value_row(ui, "True (difference)", &exact);
}

/// The number that files give a triangle or node of the shown mesh; `…` until it is known.
fn number(session: &Session, index: usize) -> String {
    if session.has_file_numbers() { format::count(index as u64) } else { "…".into() }
}

fn where_on(location: Location) -> Option<&'static str> {
    match location {
        Location::OnVertex { .. } => Some("on a vertex"),
        Location::OnEdge { edge: 0, .. } => Some("on the bisection edge"),
        Location::OnEdge { .. } => Some("on an edge"),
        _ => None,
    }
}

fn no_triangle(ui: &mut Ui, readout: &Readout) {
    let text = match readout.location {
        Location::OutsideDomain => "The point lies in a hole of the domain, or beyond its outline.",
        Location::Invalid => "The point is not a number.",
        _ => "The point lies outside the domain.",
    };
    empty_state(ui, Icon::QUERY, "No triangle here", text);
}
