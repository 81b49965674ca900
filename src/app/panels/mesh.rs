//! The mesh: coarse spacing, refinement rule, budgets and threads.

use std::num::NonZeroUsize;
use std::ops::RangeInclusive;

use eframe::egui::Ui;

use crate::app::command::{Command, EditCommand, ShellCommand};
use crate::app::kit::{FrameState, Panel, PanelGroup, end_gesture_when_released, remark, set_once};
use crate::app::threads::Threads;
use crate::app::widgets::{NumberRow, Section, SliderRow, format, segmented, value_row};
use meshbrush_core::document::{LEAST_MEMORY, Setting, Settings};
use meshbrush_core::field::RefinementRule;

/// The longest label of a number; the fields of the others are aligned with it.
const TRIANGLE_BUDGET: &str = "Triangle budget";
/// Bytes in a megabyte.
const MEGABYTE: f64 = 1e6;
/// Bytes in a gigabyte.
const GIGABYTE: f64 = 1e9;
/// The triangles that a budget can allow.
const TRIANGLE_BUDGETS: RangeInclusive<f64> = 1000.0..=1e8;
/// The most memory that a budget can allow, in gigabytes.
const MOST_MEMORY: f64 = 1000.0;

/// Coarse spacing, refinement rule, budgets and threads.
pub static MESH: Panel = Panel { name: "mesh", group: PanelGroup::Mesh, only_with_tool: false, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Mesh").closed().show(ui, |ui| {
        spacing_rows(ui, state, commands);
        rule_row(ui, state, commands);
        budget_rows(ui, state, commands);
        if !state.reproducible {
            threads_row(ui, state, commands);
        }
    });
}

fn spacing_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let extent = settings.domain.bounds.size().max_element();
    let mut spacing = settings.spacing;
    let help = "Side of a coarse cell. Cells are a little smaller where that fits the domain better.";
    let range = extent / 250.0..=extent;
    let row = SliderRow::new("Spacing δ", &mut spacing, range).logarithmic().help(help);
    let row = row.typed_range(f64::MIN_POSITIVE..=extent).default(Settings::default().spacing * extent);
    let response = row.unit(state.unit().symbol()).show(ui);
    if response.changed() {
        commands.push(Command::Edit(EditCommand::Set(Setting::Spacing(spacing))));
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
    let usual = Settings::default();
    let mut triangles = settings.max_triangles as f64;
    let help =
        "Most triangles of the mesh. A stroke that would need more stops there; a setting is taken back.";
    let row = NumberRow::new(TRIANGLE_BUDGET, &mut triangles).integer().range(TRIANGLE_BUDGETS);
    if row.default(usual.max_triangles as f64).help(help).show(ui).changed() {
        set_once(Setting::MaxTriangles(triangles as usize), commands);
    }
    let mut gigabytes = settings.max_memory as f64 / GIGABYTE;
    let help = "Most memory, in gigabytes, for the mesh and for the next one while that is built: 98 bytes a triangle. \
                The smaller of the two budgets counts.";
    let range = LEAST_MEMORY as f64 / GIGABYTE..=MOST_MEMORY;
    let row = NumberRow::new("Memory budget", &mut gigabytes)
        .aligned_with(TRIANGLE_BUDGET)
        .range(range)
        .unit("GB")
        .help(help);
    if row.default(usual.max_memory as f64 / GIGABYTE).show(ui).changed() {
        let max_memory = (gigabytes * GIGABYTE).round() as usize;
        set_once(Setting::MaxMemory(max_memory), commands);
    }
    let bytes = state.session.mesh().bytes() as f64;
    value_row(ui, "Memory in use", &format!("{} MB", format::fixed(bytes / MEGABYTE, 1)));
}

fn threads_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut count = state.threads.count().get() as f64;
    let most = Threads::most().get() as f64;
    let help = "Most threads that compute the mesh, and each file. Fewer leave cores to other programs; the mesh is the \
                same. The picture is drawn on threads of its own.";
    let row = NumberRow::new("Threads", &mut count).aligned_with(TRIANGLE_BUDGET);
    if row.integer().range(1.0..=most).default(most).help(help).show(ui).changed() {
        commands.extend(
            NonZeroUsize::new(count as usize).map(|count| Command::Shell(ShellCommand::LimitThreads(count))),
        );
    }
}
