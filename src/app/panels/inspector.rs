use eframe::egui::Ui;

use super::super::App;
use super::super::command::Command;
use super::super::readout::{Quantity, Readout, TriangleReadout};
use super::super::theme::tokens;
use super::super::widgets::{Chip, Icon, Section, chips, empty_state, format, segmented, value_row};
use crate::mesh::{Location, Neighbour, Orientation};

impl App {
    pub(super) fn inspector_ui(&mut self, ui: &mut Ui) {
        let readout = self.session.readout(self.view.quantity);
        let title = match readout.as_ref().and_then(|readout| readout.location.triangle()) {
            Some(id) => format!("Triangle {}", number(self.session.triangle_number(id))),
            None => "Triangle".to_owned(),
        };
        Section::new(&title).id("inspector").show(ui, |ui| match readout {
            None => {
                let text =
                    "Click the mesh with the query tool (Q): triangle, neighbours and values appear here.";
                empty_state(ui, Icon::QUERY, "Nothing asked yet", text, None);
            }
            Some(Readout { triangle: Some(triangle), location, point }) => {
                self.triangle_ui(ui, &triangle, location, point);
            }
            Some(readout) => nowhere_ui(ui, &readout),
        });
    }

    fn triangle_ui(
        &mut self,
        ui: &mut Ui,
        triangle: &TriangleReadout,
        location: Location,
        point: glam::DVec2,
    ) {
        let orientation = match triangle.orientation {
            Orientation::Clockwise => "clockwise",
            Orientation::Anticlockwise => "anticlockwise",
        };
        let step = self.view.camera.map_or(1e-4, |camera| 1.0 / camera.px_per_world());
        let place =
            |p: glam::DVec2| format!("{} {}", format::coordinate(p.x, step), format::coordinate(p.y, step));
        let turn = value_row(ui, "Level · orientation", &format!("{} · {orientation}", triangle.level));
        turn.on_hover_text("Which way v₁ v₂ v₃ run, as bisection left them. In files all run anticlockwise.");
        value_row(ui, "Diameter", &format::length(triangle.diameter));
        value_row(ui, "Point", &place(point));
        if let Some(on) = where_on(location) {
            value_row(ui, "Lies", on);
        }
        let [a, b, c] = triangle.zeta.map(|zeta| format::fixed(zeta, 3));
        value_row(ui, "ζ₁ ζ₂ ζ₃", &format!("{a} {b} {c}"));
        self.neighbours_ui(ui, triangle);
        self.quantity_ui(ui, triangle);
        ui.add_space(4.0);
        for (i, (node, corner)) in triangle.vertices.iter().enumerate() {
            let label = format!("v{} · {}", ["₁", "₂", "₃"][i], number(self.session.node_number(*node)));
            value_row(ui, &label, &place(*corner));
        }
    }

    /// The three neighbours as chips in their colours on the canvas; a click goes there.
    fn neighbours_ui(&mut self, ui: &mut Ui, triangle: &TriangleReadout) {
        let colors = tokens(ui).neighbours;
        ui.add_space(4.0);
        chips(ui, |ui| {
            for (i, neighbour) in triangle.neighbours.iter().enumerate() {
                self.neighbour_chip(ui, i, *neighbour, colors[i]);
            }
        });
        ui.add_space(4.0);
    }

    fn neighbour_chip(&mut self, ui: &mut Ui, i: usize, neighbour: Neighbour, color: eframe::egui::Color32) {
        let name = ["Bisection neighbour", "Second neighbour", "Third neighbour"][i];
        let text = neighbour.triangle().map_or("edge".into(), |id| number(self.session.triangle_number(id)));
        let response = Chip::new(color, &text, name).enabled(neighbour.triangle().is_some()).show(ui);
        if let Some(id) = neighbour.triangle() {
            if response.clicked() {
                self.commands.push(Command::QueryTriangle(id));
            }
            if response.hovered() {
                self.hovered_neighbour = Some(id);
            }
        }
    }

    fn quantity_ui(&mut self, ui: &mut Ui, triangle: &TriangleReadout) {
        let choices = [(Quantity::TargetDiameter, "h̄"), (Quantity::Risk, "Risk")];
        segmented(ui, "Quantity", &mut self.view.quantity, &choices);
        let number = |value: f64| format::significant(value, 4);
        let [a, b, c] = triangle.at_vertices.map(number);
        value_row(ui, "At v₁ v₂ v₃", &format!("{a} {b} {c}"));
        value_row(ui, "Interpolated", &number(triangle.interpolated));
        let difference = triangle.interpolated - triangle.exact;
        let sign = match difference {
            d if d < 0.0 => "−",
            d if d > 0.0 => "+",
            _ => "",
        };
        let exact =
            format!("{} ({sign}{})", number(triangle.exact), format::significant(difference.abs(), 2));
        value_row(ui, "True (difference)", &exact);
    }
}

/// A number as files have it; a sign of more to come until it is counted.
fn number(number: Option<usize>) -> String {
    number.map_or("…".into(), |number| format::count(number as u64))
}

fn where_on(location: Location) -> Option<&'static str> {
    match location {
        Location::OnVertex { .. } => Some("on a vertex"),
        Location::OnEdge { edge: 0, .. } => Some("on the bisection edge"),
        Location::OnEdge { .. } => Some("on an edge"),
        _ => None,
    }
}

fn nowhere_ui(ui: &mut Ui, readout: &Readout) {
    let text = match readout.location {
        Location::OutsideDomain => "The point lies in a hole of the domain, or beyond its outline.",
        Location::Invalid => "The point is not a number.",
        _ => "The point lies outside the domain.",
    };
    empty_state(ui, Icon::QUERY, "No triangle here", text, None);
}
