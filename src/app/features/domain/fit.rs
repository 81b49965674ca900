//! How well the mesh renders the outline of its domain.

use eframe::egui::Ui;
use glam::DVec2;

use meshbrush_core::domain::{FitQuality, Region};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::derivation::Derived;
use meshbrush_kit::kit::{FrameState, Panel, Tab};
use meshbrush_mesh::geometry::Rect;
use meshbrush_ui::widgets::{Section, ValueRow, format, value_row};

/// Side of the area that is shown around a place, in diameters at the outline.
const AREA_IN_DIAMETERS: f64 = 24.0;

/// The mesh compared with the outline of its domain. Not shown without an outline.
pub static FIT: Panel = Panel { name: "fit", tab: Tab::Mesh, place: 2, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(region) = state.session.follower().settings().outline() else { return };
    let derived = state.session.derived();
    let quality = derived.and_then(|derived| derived.quality.as_ref());
    let note = quality.map_or("…".into(), |quality| {
        let share = 100.0 * quality.misclassified_area / quality.region_area;
        format!("{} % wrong", format::digits(share, 2))
    });
    Section::new("Fit to outline").note(&note).closed().show(ui, |ui| {
        let Some(derived) = derived else {
            value_row(ui, "Mesh", "being derived");
            return;
        };
        count_rows(ui, derived, &region);
        if let Some(quality) = quality {
            quality_rows(ui, state, quality, commands);
        }
        if let Some(fit) = derived.outline_fit {
            let nodes = format!("{} of {}", count(fit.on_outline), count(fit.nodes));
            value_row(ui, "Nodes on outline", &nodes);
        }
        removed_rows(ui, derived, &region, commands, state);
    });
}

/// Parts and holes of mesh and outline, coloured where they differ.
fn count_rows(ui: &mut Ui, derived: &Derived, region: &Region) {
    let topology = derived.topology;
    let rows = [
        ("Parts", topology.parts, region.polygons().len(), "Edge-connected parts of the mesh, and polygons."),
        ("Holes", topology.holes, region.hole_count(), "Holes of the mesh, and of the outline."),
    ];
    for (label, mesh, outline, help) in rows {
        let value = format!("{} (outline {})", count(mesh), count(outline));
        ValueRow::new(label, &value).help(help).stands_out(mesh != outline).show(ui);
    }
}

fn quality_rows(ui: &mut Ui, state: &FrameState<'_>, quality: &FitQuality, commands: &mut Vec<Command>) {
    let kept = quality.islands - quality.lost_islands.len();
    let islands = format!("{} of {}", count(kept), count(quality.islands));
    if let Some(lost) = quality.lost_islands.first() {
        let help = "Islands of the outline that do not lie wholly under triangles. A click goes to the largest lost one.";
        let row = ValueRow::new("Islands kept", &islands).help(help).stands_out(true).link().show(ui);
        go_to(&row, lost.place, state, commands);
    } else if quality.islands > 0 {
        value_row(ui, "Islands kept", &islands);
    }
    let percent = |area: f64| 100.0 * area / quality.region_area;
    if let Some(largest) = quality.new_holes.first() {
        let value = format!(
            "{}, up to {} %",
            count(quality.new_holes.len()),
            format::digits(percent(largest.area), 3)
        );
        let help = "Holes of the mesh that the outline does not have, such as inlets whose mouth it closes, and the area of \
                    the largest. A click goes there.";
        let row = ValueRow::new("New holes", &value).help(help).stands_out(true).link().show(ui);
        go_to(&row, largest.place, state, commands);
    }
    let sign = if quality.net_area < 0.0 { "−" } else { "+" };
    let net = format!("{sign}{} %", format::digits(percent(quality.net_area.abs()), 3));
    value_row(ui, "Net area", &net);
    let misclassified = format!("{} %", format::digits(percent(quality.misclassified_area), 2));
    value_row(ui, "Misclassified", &misclassified);
    let longer = format!("× {}", format::digits(quality.boundary_length / quality.outline_length, 2));
    ValueRow::new("Length", &longer).help("Length of the boundary, compared with the outline.").show(ui);
    let farthest = [
        (
            "Mesh off outline",
            quality.farthest_from_outline,
            "Largest distance of the boundary from the outline. A click goes there.",
        ),
        (
            "Outline off mesh",
            quality.farthest_from_mesh,
            "Largest distance of the outline from the boundary. A click goes there.",
        ),
    ];
    for (label, farthest, help) in farthest {
        let Some((distance, place)) = farthest else { continue };
        let row = ValueRow::new(label, &format::length(distance, state.unit())).help(help).link().show(ui);
        go_to(&row, place, state, commands);
    }
    let angles = [quality.smallest_angle, quality.largest_angle].map(|angle| format::fixed(angle, 1));
    value_row(ui, "Angles", &format!("{}° to {}°", angles[0], angles[1]));
}

/// Shows the parts that cleaning removed, with a button that goes to the largest one.
fn removed_rows(
    ui: &mut Ui,
    derived: &Derived,
    region: &Region,
    commands: &mut Vec<Command>,
    state: &FrameState<'_>,
) {
    let removed = &derived.removed;
    if removed.triangles == 0 {
        return;
    }
    let area = format::digits(100.0 * removed.area / region.area(), 3);
    let value = format!("{} triangles, {area} %", count(removed.triangles));
    let help = format!(
        "{} parts and the smaller sides of {} nodes in which the domain touched itself.",
        count(removed.parts.len()),
        count(removed.pinches)
    );
    ValueRow::new("Removed", &value).help(&help).show(ui);
    if let Some(part) = removed.parts.first() {
        let value = format!("{} triangles", count(part.triangles));
        let row = ValueRow::new("Largest part removed", &value).link().show(ui);
        go_to(&row, part.place, state, commands);
    }
}

/// Shows a place closely when its row is clicked.
fn go_to(row: &eframe::egui::Response, place: DVec2, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.follower().settings();
    let diameter = settings.boundary.diameter().unwrap_or(settings.spacing);
    if row.clicked() {
        commands.push(Command::from(ViewCommand::ShowArea(Rect::around(
            place,
            0.5 * AREA_IN_DIAMETERS * diameter,
        ))));
    }
}

fn count(count: usize) -> String {
    format::count(count as u64)
}
