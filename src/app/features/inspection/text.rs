//! The inspector's values for a queried triangle, as text, for the panel and for copying.

use meshbrush_core::layers::{Decision, DepthSurface, DiameterLimit, Layer, LayerId};
use meshbrush_kit::kit::coordinates::{CoordinateStyle, place_text};
use meshbrush_kit::kit::readout::{Quantity, Readout, TriangleReadout};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::View;
use meshbrush_mesh::mesh::{Location, NodeId, Orientation};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::format;

/// The names of the three neighbours, in their order.
pub const NEIGHBOURS: [&str; 3] = ["Bisection neighbour", "Second neighbour", "Third neighbour"];

/// A name and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct InspectorRow {
    /// The name.
    pub label: String,
    /// The value, rounded for the panel, with its unit.
    pub shown: String,
    /// The value in full, without a unit, for other programs.
    pub exact: String,
    /// The unit of `exact`.
    pub unit: LengthUnit,
}

impl InspectorRow {
    fn new(label: impl Into<String>, shown: impl Into<String>, exact: impl Into<String>) -> Self {
        Self { label: label.into(), shown: shown.into(), exact: exact.into(), unit: LengthUnit::None }
    }

    fn text(label: impl Into<String>, text: impl Into<String>) -> Self {
        let text = text.into();
        Self::new(label, text.clone(), text)
    }

    fn in_unit(self, unit: LengthUnit) -> Self {
        Self { unit, ..self }
    }
}

/// The target diameter of one layer at the queried point.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerAnswer {
    /// The name of the layer and its target diameter.
    pub row: InspectorRow,
    /// Whether the layer decides h̄ there.
    pub decides: bool,
}

/// A queried point and the triangle around it.
pub struct Inspection<'a> {
    session: &'a Session,
    view: &'a View,
    readout: &'a Readout,
    triangle: &'a TriangleReadout,
}

impl<'a> Inspection<'a> {
    /// None where the queried point is in no triangle.
    pub fn of(readout: &'a Readout, session: &'a Session, view: &'a View) -> Option<Self> {
        let triangle = readout.triangle.as_ref()?;
        Some(Self { session, view, readout, triangle })
    }

    fn unit(&self) -> LengthUnit {
        self.session.document().settings().unit
    }

    /// Returns the number that files give a triangle or node of the shown mesh; `…` until it is known.
    pub fn number(&self, index: usize) -> String {
        if self.session.has_file_numbers() { format::count(index as u64) } else { "…".into() }
    }

    /// [`number`](Self::number) without commas.
    fn plain_number(&self, index: usize) -> String {
        if self.session.has_file_numbers() { index.to_string() } else { "…".into() }
    }

    /// Returns the triangle's number in words.
    pub fn title(&self) -> String {
        format!("Triangle {}", self.number(self.triangle.id.index()))
    }

    /// Returns the level, size and position.
    pub fn place_rows(&self) -> Vec<InspectorRow> {
        let triangle = self.triangle;
        let orientation = match triangle.orientation {
            Orientation::Clockwise => "clockwise",
            Orientation::Anticlockwise => "anticlockwise",
        };
        let [a, b, c] = triangle.zeta.map(|zeta| format::fixed(zeta, 3));
        let diameter = format::length(triangle.diameter, self.unit());
        let mut rows = vec![
            InspectorRow::text("Level · orientation", format!("{} · {orientation}", triangle.level)),
            InspectorRow::new("Diameter", diameter, format::exact(triangle.diameter)).in_unit(self.unit()),
            self.point_row("Point", self.readout.point.to_array()),
        ];
        rows.extend(self.geographic_row());
        rows.extend(self.depth_row());
        rows.extend(where_on(self.readout.location).map(|on| InspectorRow::text("Lies", on)));
        rows.push(InspectorRow::new("ζ₁ ζ₂ ζ₃", format!("{a} {b} {c}"), exact_list(&triangle.zeta)));
        rows
    }

    /// Returns the chosen quantity at the vertices and at the point.
    pub fn quantity_rows(&self) -> Vec<InspectorRow> {
        let unit = match self.view.quantity {
            Quantity::TargetDiameter => self.unit(),
            Quantity::Risk => LengthUnit::None,
        };
        let triangle = self.triangle;
        let number = |value: f64| format::significant(value, 4);
        let [a, b, c] = triangle.at_vertices.map(number);
        let difference = triangle.interpolated - triangle.exact;
        let sign = match difference {
            d if d < 0.0 => "−",
            d if d > 0.0 => "+",
            _ => "",
        };
        let exact = unit.after(&number(triangle.exact));
        let exact = format!("{exact} ({sign}{})", format::significant(difference.abs(), 2));
        let interpolated = unit.after(&number(triangle.interpolated));
        let rows = [
            InspectorRow::new(
                "At v₁ v₂ v₃",
                unit.after(&format!("{a} {b} {c}")),
                exact_list(&triangle.at_vertices),
            ),
            InspectorRow::new("Interpolated", interpolated, format::exact(triangle.interpolated)),
            InspectorRow::new("True (difference)", exact, format::exact(triangle.exact)),
        ];
        rows.map(|row| row.in_unit(unit)).into()
    }

    /// Which layer decides h̄ at the point, and where gradation carries its diameter from.
    pub fn decision_rows(&self) -> Vec<InspectorRow> {
        let decision = &self.readout.decision;
        let layers = &self.session.follower().settings().layers;
        let mut rows = vec![InspectorRow::text("Decided by", decided_by(layers, decision))];
        if decision.from != self.readout.point {
            rows.push(self.point_row("Through gradation from", decision.from.to_array()));
        }
        rows
    }

    /// Returns the target diameter of each visible layer at the point, from the top layer on.
    pub fn layer_answers(&self) -> Vec<LayerAnswer> {
        let decision = &self.readout.decision;
        let layers = &self.session.follower().settings().layers;
        let is_direct = decision.from == self.readout.point;
        let answer = |&(id, asked): &(LayerId, Option<f64>)| {
            let label = deciding_layer(layers, Some(id));
            let row = match asked {
                Some(h) => InspectorRow::new(label, format::length(h, self.unit()), format::exact(h))
                    .in_unit(self.unit()),
                None => InspectorRow::text(label, "nothing"),
            };
            LayerAnswer { row, decides: is_direct && decision.layer == Some(id) }
        };
        decision.asked.iter().rev().map(answer).collect()
    }

    /// Returns the corners, with their numbers in files.
    pub fn corner_rows(&self) -> Vec<InspectorRow> {
        let corners = self.triangle.vertices.iter().zip(["v₁", "v₂", "v₃"]);
        let label = |name: &str, node: NodeId| format!("{name} · {}", self.number(node.index()));
        corners.map(|((node, place), name)| self.point_row(&label(name, *node), place.to_array())).collect()
    }

    /// Returns all of it: a line for each value, in full and with its unit.
    pub fn full_text(&self) -> String {
        let triangle = self.triangle;
        let mut rows = vec![InspectorRow::text("Triangle", self.plain_number(triangle.id.index()))];
        rows.extend(self.place_rows());
        rows.extend(triangle.neighbours.iter().zip(NEIGHBOURS).map(|(neighbour, name)| {
            let number = neighbour.triangle().map(|id| self.plain_number(id.index()));
            InspectorRow::text(name, number.unwrap_or_else(|| "none, at the boundary".into()))
        }));
        let quantity = match self.view.quantity {
            Quantity::TargetDiameter => "h̄",
            Quantity::Risk => "risk",
        };
        rows.push(InspectorRow::text("Quantity", quantity));
        for row in self.quantity_rows() {
            let label = if row.label.starts_with("True") { "True".into() } else { row.label };
            rows.push(InspectorRow { label, ..row });
        }
        rows.extend(self.decision_rows());
        rows.extend(self.layer_answers().into_iter().map(|LayerAnswer { row, .. }| {
            let label = format!("Layer {}", row.label);
            InspectorRow { label, ..row }
        }));
        rows.extend(self.corner_rows());
        let lines = rows.iter().map(|row| format!("{}: {}\n", row.label, row.unit.after(&row.exact)));
        lines.collect()
    }

    /// Returns longitude and latitude of the point, where the domain lies on the Earth.
    fn geographic_row(&self) -> Option<InspectorRow> {
        let settings = self.session.document().settings();
        let at = settings.domain.projection?.geographic_from_plane(self.readout.point).to_array();
        let style = match self.view.coordinates {
            CoordinateStyle::Plane => CoordinateStyle::default(),
            style => style,
        };
        let shown = place_text(settings, style, self.readout.point, 1.0).values.join(" ");
        Some(InspectorRow::new("Longitude, latitude", shown, exact_list(&at)).in_unit(LengthUnit::Degree))
    }

    /// Returns the depth of the water at the point, in documents with depths.
    fn depth_row(&self) -> Option<InspectorRow> {
        let depths = DepthSurface::of(&self.session.document().settings().layers)?;
        let Some(depth) = depths.depth_at(self.readout.point) else {
            return Some(InspectorRow::text("Depth", "no value here"));
        };
        let shown = LengthUnit::Metre.after(&format::significant(depth, 4));
        Some(InspectorRow::new("Depth", shown, format::exact(depth)).in_unit(LengthUnit::Metre))
    }

    fn point_row(&self, label: &str, point: [f64; 2]) -> InspectorRow {
        let step = self.view.world_per_px();
        let shown = point.map(|value| format::coordinate(value, step, self.unit())).join(" ");
        InspectorRow::new(label, shown, exact_list(&point)).in_unit(self.unit())
    }
}

/// Returns what decides h̄: the limit that a layer asks to pass, or the name of the layer; in words where
/// there is none.
pub fn decided_by<'a>(layers: &'a [Layer], decision: &Decision) -> &'a str {
    match decision.limit {
        Some(DiameterLimit::Smallest) => "smallest diameter",
        Some(DiameterLimit::Largest) => "largest diameter",
        None => deciding_layer(layers, decision.layer),
    }
}

/// Returns the name of the layer that decides, in words where none does.
fn deciding_layer(layers: &[Layer], decides: Option<LayerId>) -> &str {
    let Some(id) = decides else { return "no layer" };
    layers.iter().find(|layer| layer.id == id).map_or("a deleted layer", |layer| &layer.name)
}

fn exact_list(values: &[f64]) -> String {
    values.iter().map(|&value| format::exact(value)).collect::<Vec<_>>().join(", ")
}

fn where_on(location: Location) -> Option<&'static str> {
    match location {
        Location::OnVertex { .. } => Some("on a vertex"),
        Location::OnEdge { edge: 0, .. } => Some("on the bisection edge"),
        Location::OnEdge { .. } => Some("on an edge"),
        _ => None,
    }
}
