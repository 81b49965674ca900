//! The status bar.

use std::time::Duration;

use eframe::egui::{Align, Layout, Ui};

use crate::app::features::inspection::decided_by;
use meshbrush_core::document::Stage;
use meshbrush_core::field::RefinementRule;
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::coordinates::PlaceText;
use meshbrush_kit::kit::readout::{Quantity, value_at};
use meshbrush_ui::widgets::{StatusCell, format};

/// Space between cells.
const GAP: f32 = 16.0;
/// Most letters of the name of a layer.
const MOST_OF_NAME: usize = 17;
/// Most letters of a longitude or latitude where a pixel is not smaller than a metre.
const MOST_OF_ANGLE: usize = 13;
/// Shown where there is nothing to show.
const NONE: &str = "–";

/// Pointer, mesh and work.
pub fn status_bar(ui: &mut Ui, state: &FrameState<'_>) {
    let [left, right] = fitting_cells(ui, state);
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for cell in left {
            cell.show(ui);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for cell in right {
                cell.show(ui);
            }
        });
    });
}

/// Returns the cells at the left, from the left, and those at the right, from the right. In a narrow window
/// the least important are left out.
fn fitting_cells(ui: &Ui, state: &FrameState<'_>) -> [Vec<StatusCell>; 2] {
    let [x, y, target, level, layer] = pointer_cells(state);
    let [triangles, nodes, deepest] = mesh_cells(state);
    let [rule, update] = work_cells(state);
    let mut left = vec![x, y, target, level, layer, triangles, nodes, deepest];
    let mut right = vec![rule, update];
    let room = ui.available_width();
    let width = |cells: &[StatusCell]| cells.iter().map(|cell| cell.width(ui) + GAP).sum::<f32>();
    // Nodes, the deepest level, the deciding layer, the level of the triangle.
    for least_important in [6, 6, 4, 3] {
        if width(&left) + width(&right) - GAP > room {
            left.remove(least_important);
        }
    }
    if width(&left) + width(&right) - GAP > room {
        right.truncate(1);
    }
    [left, right]
}

/// Returns the position of the pointer, h̄ and the level of the triangle there, and what decides h̄: a layer
/// or a limit.
fn pointer_cells(state: &FrameState<'_>) -> [StatusCell; 5] {
    let unit = state.unit();
    let chars = 8 + unit.after("").chars().count();
    let of_place = if state.geographic_plane().is_some() { MOST_OF_ANGLE } else { chars };
    let cells = |PlaceText { names, values: [x, y] }, [target, level, layer]: [String; 3]| {
        let layer = StatusCell::new("by", shortened(layer), MOST_OF_NAME);
        let [x, y] = [StatusCell::new(names[0], x, of_place), StatusCell::new(names[1], y, of_place)];
        [x, y, StatusCell::new("h̄", target, chars), StatusCell::new("level", level, 2), layer]
    };
    let pointer = state.pointer.filter(|_| !state.session.awaits_mesh());
    let Some(point) = pointer else {
        let names = state.place_names();
        return cells(PlaceText { names, values: [NONE; 2].map(String::from) }, [NONE; 3].map(String::from));
    };
    let (document, follower) = (state.session.document(), state.session.follower());
    let decision = state.session.decision_at(point);
    let target = match follower.settings().rule {
        RefinementRule::Area => decision.target,
        RefinementRule::Vertex => value_at(point, document, follower, Quantity::TargetDiameter),
    };
    // The mesh decides: it may lack a part of the bounds.
    let values = match state.session.locate(point).triangle() {
        Some(id) => {
            let level = state.session.view().triangle(id).level().to_string();
            let by = decided_by(&follower.settings().layers, &decision).to_owned();
            [format::length(target, unit), level, by]
        }
        None => ["outside", NONE, NONE].map(String::from),
    };
    cells(state.place_text(point), values)
}

/// Returns a name with no more letters than its cell has room for.
fn shortened(name: String) -> String {
    if name.chars().count() <= MOST_OF_NAME {
        return name;
    }
    name.chars().take(MOST_OF_NAME - 1).chain(['…']).collect()
}

fn mesh_cells(state: &FrameState<'_>) -> [StatusCell; 3] {
    let session = state.session;
    let nodes = match session.derived() {
        Some(derived) => format::count(derived.topology.nodes as u64),
        None if session.has_file_numbers() => format::count(session.mesh().raw_nodes().len() as u64),
        None => NONE.into(),
    };
    let deepest = session.level_counts().len().saturating_sub(1);
    let values = [format::count(session.triangle_count() as u64), nodes, deepest.to_string()];
    let [triangles, nodes, deepest] =
        if session.awaits_mesh() { [NONE; 3].map(String::from) } else { values };
    [
        StatusCell::new("triangles", triangles, 10),
        StatusCell::new("nodes", nodes, 10),
        StatusCell::new("deepest level", deepest, 2),
    ]
}

/// Returns the rule, and the time of the last update or of the present one so far.
fn work_cells(state: &FrameState<'_>) -> [StatusCell; 2] {
    let rule = match state.session.follower().settings().rule {
        RefinementRule::Area => "area",
        RefinementRule::Vertex => "vertex",
    };
    [StatusCell::new("rule", rule, 0), StatusCell::new("update", update_text(state), 11)]
}

fn update_text(state: &FrameState<'_>) -> String {
    let session = state.session;
    let time = |time: Option<Duration>| time.map_or(NONE.into(), |time| format::time(time.as_secs_f64()));
    match session.stage() {
        // Also during work: which glyphs it needed would depend on the machine's speed.
        _ if state.reproducible => NONE.into(),
        _ if session.question().is_some() => "waits".into(),
        Stage::InStep => time(session.last_update()),
        // How far it is, the canvas says.
        Stage::Indexing | Stage::Checking | Stage::Copying { .. } | Stage::Refining { .. } => {
            format!("{}…", time(session.update_so_far()))
        }
        Stage::GaveUp(None) => "cancelled".into(),
        Stage::GaveUp(Some(_)) => "stopped".into(),
    }
}
