//! The figures by which people judge a mesh.

use eframe::egui::Ui;
use glam::DVec2;

use super::Measured;
use super::measuring::edges_at;
use crate::app::features::inspection::InspectCommand;
use crate::app::features::statistics::{Statistics, StatisticsCommand};
use meshbrush_kit::kit::command::{Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab};
use meshbrush_mesh::mesh::MeshStatistics;
use meshbrush_ui::theme::metrics;
use meshbrush_ui::widgets::{AnswerRow, Section, ValueRow, format, value_row};

/// Rows of the figures of a mesh in one part.
const DEFAULT_ROWS: f32 = 8.0;
/// Connected parts with a row of their own.
const MOST_PARTS: usize = 5;

/// Edges, area, gradation, parts, whether h̄ is honoured, and the fingerprint.
pub static STATISTICS: Panel = Panel { name: "statistics", tab: Tab::Mesh, place: 1, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Statistics").closed().show(ui, |ui| {
        figures_of(ui, DEFAULT_ROWS, state, commands, |ui, measured, commands| {
            count_rows(ui, measured);
            if let Some(statistics) = &measured.statistics {
                edge_rows(ui, statistics, measured, state, commands);
            }
            target_row(ui, measured, state, commands);
            fingerprint_row(ui, measured, commands);
        });
    });
}

/// Shows the figures of the mesh, with room for so many rows before they are known. They are computed only
/// while somebody asks.
pub fn figures_of(
    ui: &mut Ui,
    rows: f32,
    state: &FrameState<'_>,
    commands: &mut Vec<Command>,
    show: impl FnOnce(&mut Ui, &Measured, &mut Vec<Command>),
) {
    let figures = state.feature::<Statistics>().figures(state.session);
    let is_current = figures.is_some_and(|(_, is_current)| is_current);
    if state.feature::<Statistics>().is_due(state.session) {
        commands.push(Command::from(StatisticsCommand::Measure));
    }
    let Some((measured, _)) = figures else {
        // The room that the figures will take: opening the section brings all of it into view.
        ui.set_min_height(rows * (metrics::ROW + metrics::ROW_GAP));
        value_row(ui, "Mesh", "being measured");
        return;
    };
    // The figures of the former mesh stay until those of the new one are known: nothing jumps. Their places
    // are no places of the mesh that is shown.
    ui.scope(|ui| {
        if !is_current {
            ui.disable();
        }
        show(ui, measured, commands);
    });
}

fn count(number: usize) -> String {
    format::count(number as u64)
}

fn count_rows(ui: &mut Ui, measured: &Measured) {
    let triangles = measured.part_sizes.iter().sum();
    value_row(ui, "Triangles", &count(triangles));
    value_row(ui, "Nodes", &count(measured.nodes));
    let parts = &measured.part_sizes;
    if parts.len() < 2 {
        return;
    }
    for (number, &size) in parts.iter().enumerate().take(MOST_PARTS) {
        let help = "Triangles of a connected part. The first has the largest area.";
        ValueRow::new(&format!("Part {}", number + 1), &count(size)).help(help).show(ui);
    }
    if let Some(rest) = parts.get(MOST_PARTS..).filter(|rest| !rest.is_empty()) {
        let label = format!("{} smaller parts", rest.len());
        ValueRow::new(&label, &count(rest.iter().sum())).help("Triangles of all other parts.").show(ui);
    }
}

fn edge_rows(
    ui: &mut Ui,
    statistics: &MeshStatistics,
    measured: &Measured,
    state: &FrameState<'_>,
    commands: &mut Vec<Command>,
) {
    let [shortest, longest, gradation] = edges_at(statistics);
    let [of_shortest, of_longest, of_gradation] = measured.beside_edges;
    let help = "A click goes to this edge.";
    for (label, length, place, inside) in [
        ("Shortest edge", statistics.shortest_edge, shortest, of_shortest),
        ("Longest edge", statistics.longest_edge, longest, of_longest),
    ] {
        let value = &format::length(length, state.unit());
        let inside = inside.unwrap_or(place);
        PlaceRow { label, value, help, place, inside, size: length }.show(ui, commands);
    }
    value_row(ui, "Area", &format::area(measured.area, state.unit(), 6));
    let value = &format!("× {}", format::fixed(statistics.size_ratio, 2));
    let help = "The largest ratio of the diameters of two neighbouring triangles. A click goes there.";
    let (place, inside) = (gradation, of_gradation.unwrap_or(gradation));
    // No triangle is smaller: at this zoom, those of all figures can be seen.
    let size = statistics.shortest_edge;
    PlaceRow { label: "Gradation", value, help, place, inside, size }.show(ui, commands);
}

/// Whether the mesh honours h̄: Eq. (14) of the report.
fn target_row(ui: &mut Ui, measured: &Measured, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let label = "h̄ honoured";
    match measured.too_coarse.as_deref() {
        Some([]) => {
            let help = "No triangle is longer than h̄ asks for by the refinement rule. Nodes that move onto an outline \
                        afterwards can lengthen their triangles a little.";
            ValueRow::new(label, "everywhere").help(help).show(ui);
        }
        Some(too_coarse @ [first, ..]) => {
            let value = format!("not in {} triangles", count(too_coarse.len()));
            let mesh = state.session.mesh().view();
            let Some(place) =
                mesh.get(*first).map(|_| mesh.world_corners(*first).iter().sum::<DVec2>() / 3.0)
            else {
                return;
            };
            let help = "Triangles that are longer than h̄ asks for. A click goes to the first of them.";
            let size = mesh.diameter(*first);
            PlaceRow { label, value: &value, help, place, inside: place, size }.show(ui, commands);
        }
        None => {
            let help = "At some point the target diameter is not a positive number.";
            ValueRow::new(label, "h̄ is invalid at some point").help(help).show(ui);
        }
    }
}

fn fingerprint_row(ui: &mut Ui, measured: &Measured, commands: &mut Vec<Command>) {
    // Both ends are enough to compare by eye; a click copies all of it.
    let (begin, end) = (measured.fingerprint.get(..8), measured.fingerprint.get(24..));
    let ends = begin.zip(end).map(|(begin, end)| format!("{begin}…{end}"));
    let shown = ends.as_ref().unwrap_or(&measured.fingerprint);
    if ValueRow::new("Fingerprint", shown).link().show(ui).clicked() {
        commands.push(Command::from(ShellCommand::Copy(measured.fingerprint.clone())));
    }
}

/// A row whose click goes to a place. The word *why* explains the triangle there.
pub struct PlaceRow<'a> {
    /// Its name.
    pub label: &'a str,
    /// What is found there.
    pub value: &'a str,
    /// What it means.
    pub help: &'a str,
    /// The place, in world units.
    pub place: DVec2,
    /// A point in the triangle that is explained.
    pub inside: DVec2,
    /// The size of what is there, in world units.
    pub size: f64,
}

impl PlaceRow<'_> {
    /// Shows the row.
    pub fn show(self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let clicks = AnswerRow::new(self.label, self.value, self.help).show(ui);
        if clicks.goes {
            commands.push(Command::from(ViewCommand::GoTo(self.place, self.size)));
        }
        if clicks.asks_why {
            commands.push(Command::from(InspectCommand::AskWhy(self.inside, self.size)));
        }
    }
}
