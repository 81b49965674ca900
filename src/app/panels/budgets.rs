//! The budgets: how many triangles the mesh may have, how much memory, and which deepest level.

use std::ops::RangeInclusive;

use eframe::egui::Ui;

use meshbrush_core::document::{LEAST_MEMORY, Setting, Settings};
use meshbrush_kit::kit::brake::Need;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, Panel, Tab, set_once};
use meshbrush_mesh::mesh::MemoryLimit;
use meshbrush_ui::widgets::{NumberRow, Section, ValueRow, format, value_row};

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

/// Triangles and memory.
pub static BUDGETS: Panel = Panel { name: "budgets", tab: Tab::Size, place: 2, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Budgets").show(ui, |ui| budget_rows(ui, state, commands));
}

fn budget_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let default = Settings::default();
    let mut triangles = settings.max_triangles as f64;
    let help =
        "Most triangles of the mesh. A stroke that would need more stops there; a setting is taken back.";
    let row = NumberRow::new(TRIANGLE_BUDGET, &mut triangles).integer().range(TRIANGLE_BUDGETS);
    if row.default(default.max_triangles as f64).help(help).show(ui).changed() {
        set_once(Setting::MaxTriangles(triangles as usize), commands);
    }
    let mut gigabytes = settings.max_memory as f64 / GIGABYTE;
    let help = format!(
        "Most memory, in gigabytes, for the mesh and for the next one while that is built: {} bytes a triangle. The \
         smaller of the two budgets counts.",
        MemoryLimit::TWO_MESHES
    );
    let range = LEAST_MEMORY as f64 / GIGABYTE..=MOST_MEMORY;
    let row = NumberRow::new("Memory budget", &mut gigabytes)
        .aligned_with(TRIANGLE_BUDGET)
        .range(range)
        .unit("GB")
        .help(&help);
    if row.default(default.max_memory as f64 / GIGABYTE).show(ui).changed() {
        let max_memory = (gigabytes * GIGABYTE).round() as usize;
        set_once(Setting::MaxMemory(max_memory), commands);
    }
    level_row(ui, state, commands);
    needs(ui, state);
}

/// The deepest level. The last one of the lattice is as good as none.
fn level_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let session = state.session;
    let last = f64::from(session.mesh().lattice().deepest_level());
    let given = session.document().settings().max_level;
    let mut level = given.map_or(last, |level| f64::from(level).min(last));
    let help = "The deepest level of a triangle: those that have it stay as they are, also where they are larger than \
                their target. The default is the last one of the lattice, so that only h̄ decides.";
    let row = NumberRow::new("Deepest level", &mut level).aligned_with(TRIANGLE_BUDGET).integer();
    if row.range(0.0..=last).default(last).help(help).show(ui).changed() {
        set_once(Setting::MaxLevel((level < last).then_some(level as u32)), commands);
    }
}

/// Shows what is used of the budgets, and what the present settings would need.
fn needs(ui: &mut Ui, state: &FrameState<'_>) {
    let session = state.session;
    let (mesh, limits) = (session.mesh(), session.document().settings().limits());
    let most = limits.most_triangles();
    let share = 100.0 * mesh.raw_triangle_count() as f64 / most as f64;
    let count = format::count(mesh.raw_triangle_count() as u64);
    let used = format!("{count} ({} %)", format::digits(share, 2));
    let help = format!(
        "All triangles that are in memory, {} in the domain and the others around it, and their share of those that the \
         smaller of the two budgets allows.",
        format::count(session.triangle_count() as u64)
    );
    ValueRow::new("Triangles in memory", &used).help(&help).show(ui);
    value_row(ui, "Memory in use", &format!("{} MB", format::fixed(mesh.bytes() as f64 / MEGABYTE, 1)));
    let (text, over) = match session.need() {
        Some(need) => (need_in_words(need), need.triangles() > most as u64),
        None => ("as many as there are".to_owned(), false),
    };
    let help = "The triangles that the document asks for, and their memory with the next mesh beside. An estimate, \
                where a budget or a question stops the mesh before.";
    ValueRow::new("Needed", &text).help(help).stands_out(over).show(ui);
}

/// Returns a need of triangles, and the memory for it.
fn need_in_words(need: Need) -> String {
    let bytes = need.triangles() as f64 * MemoryLimit::TWO_MESHES as f64;
    let memory = format!("{} GB", format::digits(bytes / GIGABYTE, 2));
    match need {
        Need::About(triangles) => format!("about {}, {memory}", format::about(triangles)),
        Need::MoreThan(triangles) => format!("over {}, {memory}", format::about(triangles)),
    }
}
