//! The figures by which people judge a mesh.

use eframe::egui::Ui;
use glam::DVec2;

use super::Measured;
use crate::app::features::statistics::{Statistics, StatisticsCommand};
use meshbrush_core::layers::LargestTimeStep;
use meshbrush_kit::kit::command::{Command, ShellCommand, ViewCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab};
use meshbrush_mesh::mesh::MeshStatistics;
use meshbrush_ui::theme::metrics;
use meshbrush_ui::widgets::{Section, ValueRow, format, value_row};

/// Rows of the figures of a mesh in one part.
const DEFAULT_ROWS: f32 = 9.0;
/// Connected parts with a row of their own.
const MOST_PARTS: usize = 5;

/// Edges, areas, angles, gradation, parts, whether h̄ is honoured, and the fingerprint.
pub static STATISTICS: Panel = Panel { name: "statistics", tab: Tab::Mesh, place: 1, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Statistics").closed().show(ui, |ui| {
        let figures = state.feature::<Statistics>().figures(state.session);
        let is_current = figures.is_some_and(|(_, is_current)| is_current);
        if state.feature::<Statistics>().is_due(state.session) {
            // They are computed only while the section is open.
            commands.push(Command::from(StatisticsCommand::Measure));
        }
        let Some((measured, _)) = figures else {
            // The room that the figures will take: opening the section brings all of it into view.
            ui.set_min_height(DEFAULT_ROWS * (metrics::ROW + metrics::ROW_GAP));
            value_row(ui, "Mesh", "being measured");
            return;
        };
        // The figures of the former mesh stay until those of the new one are known: nothing jumps. Their
        // places are no places of the mesh that is shown.
        ui.scope(|ui| {
            if !is_current {
                ui.disable();
            }
            count_rows(ui, measured);
            if let Some(statistics) = &measured.statistics {
                edge_rows(ui, statistics, state, commands);
                shape_rows(ui, statistics, measured, state, commands);
            }
            target_row(ui, measured, state, commands);
            fingerprint_row(ui, measured, commands);
        });
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

fn edge_rows(ui: &mut Ui, statistics: &MeshStatistics, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let help = "A click goes to this edge.";
    for (label, length, place) in [
        ("Shortest edge", statistics.shortest_edge, statistics.shortest_edge_at),
        ("Longest edge", statistics.longest_edge, statistics.longest_edge_at),
    ] {
        let value = &format::length(length, state.unit());
        PlaceRow { label, value, help, place, size: length }.show(ui, commands);
    }
}

fn shape_rows(
    ui: &mut Ui,
    statistics: &MeshStatistics,
    measured: &Measured,
    state: &FrameState<'_>,
    commands: &mut Vec<Command>,
) {
    value_row(ui, "Area", &format::area(measured.area, state.unit(), 6));
    // No triangle is smaller: at this zoom, those of all figures can be seen.
    let size = statistics.shortest_edge;
    let help = "A click goes to this corner.";
    for (label, angle, place) in [
        ("Smallest angle", statistics.smallest_angle, statistics.smallest_angle_at),
        ("Largest angle", statistics.largest_angle, statistics.largest_angle_at),
    ] {
        let value = &format!("{}°", format::fixed(angle, 1));
        PlaceRow { label, value, help, place, size }.show(ui, commands);
    }
    let (value, place) =
        (&format!("× {}", format::fixed(statistics.size_ratio, 2)), statistics.size_ratio_at);
    let help = "The largest ratio of the diameters of two neighbouring triangles. A click goes there.";
    PlaceRow { label: "Gradation", value, help, place, size }.show(ui, commands);
    if let Some(LargestTimeStep { seconds, at, edge }) = measured.time_step {
        let value = &format::time(seconds);
        let help = "The largest time step of a solver for a wave of 1 m with the Courant number 1 along every edge. A click \
                    goes to the edge that decides it.";
        PlaceRow { label: "Time step", value, help, place: at, size: edge }.show(ui, commands);
    }
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
            PlaceRow { label, value: &value, help, place, size }.show(ui, commands);
        }
        None => {
            let help = "At some point the target diameter is not a positive number.";
            ValueRow::new(label, "h̄ is invalid at some point").help(help).show(ui);
        }
    }
}

fn fingerprint_row(ui: &mut Ui, measured: &Measured, commands: &mut Vec<Command>) {
    if ValueRow::new("Fingerprint", &measured.fingerprint).link().show(ui).clicked() {
        commands.push(Command::from(ShellCommand::Copy(measured.fingerprint.clone())));
    }
}

/// A row whose click goes to a place.
struct PlaceRow<'a> {
    label: &'a str,
    value: &'a str,
    help: &'a str,
    place: DVec2,
    /// The size of what is there, in world units.
    size: f64,
}

impl PlaceRow<'_> {
    fn show(self, ui: &mut Ui, commands: &mut Vec<Command>) {
        if ValueRow::new(self.label, self.value).help(self.help).link().show(ui).clicked() {
            commands.push(Command::from(ViewCommand::GoTo(self.place, self.size)));
        }
    }
}
