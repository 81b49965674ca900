//! How the mesh is made: coarse spacing, refinement rule and threads.

use std::num::NonZeroUsize;

use eframe::egui::Ui;

use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::field::RefinementRule;
use meshbrush_kit::kit::command::{Command, EditCommand, ShellCommand};
use meshbrush_kit::kit::threads::Threads;
use meshbrush_kit::kit::{FrameState, Panel, Tab, end_gesture_when_released, remark, set_once};
use meshbrush_ui::widgets::{NumberRow, Section, SliderRow, segmented, value_row};

/// Coarse spacing, refinement rule and threads.
pub static MESH: Panel = Panel { name: "mesh", tab: Tab::Mesh, place: 4, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Mesh").closed().show(ui, |ui| {
        spacing_rows(ui, state, commands);
        rule_row(ui, state, commands);
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
        commands.push(Command::from(EditCommand::Set(Setting::Spacing(spacing))));
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

fn threads_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut count = state.threads.count().get() as f64;
    let most = Threads::most().get() as f64;
    let help = "Most threads that compute the mesh, and each file. Fewer leave cores to other programs; the mesh is the \
                same. The picture is drawn on threads of its own.";
    let row = NumberRow::new("Threads", &mut count);
    if row.integer().range(1.0..=most).default(most).help(help).show(ui).changed() {
        commands.extend(
            NonZeroUsize::new(count as usize).map(|count| Command::from(ShellCommand::LimitThreads(count))),
        );
    }
}
