//! The panel of a step: its data, the rows that it changes and the lines that it runs.

use std::collections::HashSet;

use eframe::egui::{Align, Layout, RichText, Ui};

use super::steps::MOST_TRIANGLES;
use super::{StepCommand, code, panel_export, rows};
use crate::app::features::stepping::Stepping;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, remark};
use meshbrush_mesh::mesh::bisection_edge_length;
use meshbrush_study::steps::{NeighbourCase, RecordedStep, StepAction, StepPlayer, StepStage};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{ActionButton, Section, ValueRow, format, tips, toggle_row};

/// Width of the panel, in points, and the most of the window that it takes.
const WIDTH: f32 = 488.0;
const MOST_OF_WINDOW: f32 = 0.45;

/// Returns the width of the panel in the room that is left of the window, in points.
pub fn width(ui: &Ui) -> f32 {
    WIDTH.min(MOST_OF_WINDOW * ui.available_width())
}

/// Draws what the step does, and the lines that it runs.
pub fn text_and_code(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(steps) = state.feature::<Stepping>().steps() else { return };
    let Some(player) = steps.player() else {
        ui.label("The steps are being recorded…");
        return;
    };
    ui.label(RichText::new(sentence(player)).size(15.0).color(tokens(ui).value));
    if let Some(text) = about_outline(player) {
        ui.add_space(4.0);
        remark(ui, &text);
    }
    let mut only = steps.only_bisections;
    if toggle_row(ui, "Only bisections", &mut only).changed() {
        commands.push(Command::from(StepCommand::OnlyBisections(only)));
    }
    if let Some(step) = player.step() {
        let (algorithm, lines) = step.lines();
        let title = algorithm.title();
        let section = Section::new(&title).note(algorithm.name()).id("algorithm of the step");
        section.show(ui, |ui| code::lines(ui, algorithm, lines));
    }
}

/// Draws the data of the step, the rows that it changes, and which steps to export.
pub fn details(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(steps) = state.feature::<Stepping>().steps() else { return };
    let Some(player) = steps.player() else { return };
    if let Some(stage) = player.stage() {
        Section::new("Mesh").id("mesh of the stage").show(ui, |ui| stage_rows(ui, player, stage));
    } else {
        Section::new("Triangle").id("triangle of the step").show(ui, |ui| triangle_rows(ui, player, state));
        Section::new("Changed rows").show(ui, |ui| rows::changed_rows(ui, player, state));
    }
    panel_export::section(ui, state, steps, player.len(), commands);
}

/// Draws the title with the button that leaves the mode.
pub fn title(ui: &mut Ui, commands: &mut Vec<Command>) {
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        let title = RichText::new("Step through the refinement").font(font::strong());
        ui.label(title.color(tokens(ui).value));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let leave = ui.add(ActionButton::new("Leave").named("Leave the steps"));
            if tips::explain(ui, leave, tips::sentence("Leave the steps")).clicked() {
                commands.push(Command::from(StepCommand::Leave));
            }
        });
    });
    ui.add_space(6.0);
}

/// Describes the step in a sentence.
pub(super) fn sentence(player: &StepPlayer) -> String {
    let at_end = player.position() == player.len();
    let (is_cut_short, limit) = (player.recording().is_cut_short, format::count(MOST_TRIANGLES as u64));
    match player.step() {
        None if is_cut_short => format!(
            "The coarse grid, before the first step. The mesh has more triangles than the {limit} that are recorded: the \
             steps end there. Raise h_min to see all of them."
        ),
        None => "The coarse grid, before the first step.".into(),
        Some(step) if at_end && is_cut_short => {
            format!("{} The mesh has more than {limit} triangles: the steps end here.", step.sentence())
        }
        Some(step) => step.sentence(),
    }
}

/// Returns what the steps show of the outline of the domain: at the first step, and where stages follow.
fn about_outline(player: &StepPlayer) -> Option<String> {
    let stages = player.recording().stages().len();
    let is_shown = player.position() == 0 || player.position() + stages == player.len();
    (stages > 0 && is_shown).then(|| {
        let steps = if stages == 1 { "step".into() } else { format!("{stages} steps") };
        format!(
            "The steps refine the grid; the outline of the domain is drawn over it. The last {steps} remove triangles outside \
             and fit the others to the outline."
        )
    })
}

/// How much a stage changed, and the mesh after it.
fn stage_rows(ui: &mut Ui, player: &StepPlayer, stage: &StepStage) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let count = |count: usize| format::count(count as u64);
    let used: HashSet<u32> = stage.triangles.iter().flat_map(|triangle| triangle.nodes).collect();
    row(
        ui,
        "Removed",
        &count(stage.removed.len()),
        "Triangles of which nothing is left. Pink on the canvas.",
    );
    row(
        ui,
        "Changed",
        &count(stage.changed.len()),
        "Triangles, or pieces of them, with other nodes. White on the canvas.",
    );
    row(
        ui,
        "Moved",
        &count(stage.moved.len()),
        "Nodes that are elsewhere. A line on the canvas leads from the former place.",
    );
    row(ui, "Added", &count(stage.change.added as usize), "Nodes in edges that the outline cuts.");
    let (triangles, nodes) = (stage.triangles.len(), used.len());
    let counts = format!("{}, {}", count(triangles), count(nodes));
    row(
        ui,
        "Triangles, nodes",
        &counts,
        "How many the mesh has after the step. Pieces have the number of their triangle.",
    );
    let left = format!("{} of {}", count(player.position()), count(player.len()));
    row(ui, "Step", &left, "The mesh after the last step is that of the document.");
}

fn triangle_rows(ui: &mut Ui, player: &StepPlayer, state: &FrameState<'_>) {
    // Everything about a step is in sight in a window of the default height.
    ui.spacing_mut().item_spacing.y = 0.0;
    let stack = player.stack_in_words();
    if let Some(step) = player.step().filter(|step| step.triangle > 0) {
        let spacing = player.recording().lattice.spacing();
        let length = format::length(bisection_edge_length(spacing, step.level.into()), state.unit());
        let number = match step.visited == step.triangle {
            true => step.triangle.to_string(),
            false => format!("{}, for triangle {}", step.triangle, step.visited),
        };
        row(ui, "Triangle i", &number, TRIANGLE);
        let level = format!("{}  ·  ℓ_b = {length}", step.level);
        row(
            ui,
            "L(t_i)",
            &level,
            "The level of triangle i before it is bisected, and the length of its longest edge.",
        );
        row(ui, "k(t_i), O(t_i)", &format!("{}, {}", step.k, step.orientation), K_AND_O);
        let across = step.across.map_or("the boundary".into(), |across| across.to_string());
        row(ui, "i_b", &across, "What lies across the bisection edge of triangle i.");
        row(ui, "Case", &case(step), "How the neighbours of the halves are found; it follows from k and O.");
    }
    row(
        ui,
        "Stack S_b",
        &stack,
        "Triangles that wait until what lies across their bisection edge is bisected; the top is last.",
    );
    let counts = format!(
        "{}, {}",
        format::count(player.rows().len() as u64),
        format::count(player.nodes().len() as u64)
    );
    row(ui, "N_t, N_x", &counts, "How many triangles and nodes there are after the step.");
}

const TRIANGLE: &str =
    "The triangle that the step is about, and the one that RefineMesh, Algorithm 12, visits meanwhile.";
const K_AND_O: &str = "k says which vertices end the bisection edge, the first and the one with number k + 1; O is 1 \
                       where the vertices run anticlockwise. Both are those before the triangle is bisected.";

fn row(ui: &mut Ui, label: &str, value: &str, help: &str) {
    ValueRow::new(label, value).help(help).show(ui);
}

/// (k, O, O_b) with the routine that it chooses.
fn case(step: &RecordedStep) -> String {
    let is_known = matches!(
        step.action,
        StepAction::Divisible | StepAction::Bisect | StepAction::Pop | StepAction::UpdateNeighbours(_)
    );
    if !is_known {
        return "–".into();
    }
    let routine = NeighbourCase::of(step.k, step.orientation, step.orientation_across);
    let name = routine.algorithm().name();
    match step.orientation_across {
        Some(across) => format!("({}, {}, {across}): {name}", step.k, step.orientation),
        None => format!("({}, {}): {name}", step.k, step.orientation),
    }
}
