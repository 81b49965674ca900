//! Whether a solver takes the mesh: its rules, and the places that break them.

use eframe::egui::Ui;
use glam::DVec2;

use super::panel::PlaceRow;
use super::{Statistics, StatisticsCommand};
use meshbrush_io::io::Meter;
use meshbrush_io::io::solver_rules::{BrokenRule, Severity, Solver, rules_of};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::jobs::{Jobs, Slot};
use meshbrush_kit::kit::mesh_export::MeshExport;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::View;
use meshbrush_kit::kit::{FrameState, Panel, Tab, remark};
use meshbrush_render::render::export::ExportFormat;
use meshbrush_ui::widgets::{ActionButton, Section, ValueRow, dropdown_row, format};

/// Places of a rule that are listed; the others are as many as the number beside the rule says.
const SHOWN_PLACES: usize = 8;

/// The rules of a solver.
pub static PREFLIGHT: Panel = Panel { name: "preflight", tab: Tab::Mesh, place: 3, show };

/// What the rules depend on: the mesh, the document with its depths and pieces, and the solver.
type CheckedMesh = (MeasuredMesh, u64, &'static str);

/// Checks meshes by the rules of a solver.
pub struct Preflight {
    /// The solver that a person chose.
    pub solver: Solver,
    found: Slot<CheckedMesh, Result<Vec<BrokenRule>, String>>,
}

impl Default for Preflight {
    fn default() -> Self {
        Self { solver: Solver::Adcirc, found: Slot::default() }
    }
}

impl Preflight {
    /// Returns the state for another document, with the solver that the person chose.
    pub fn for_next_document(self) -> Self {
        Self { solver: self.solver, ..Self::default() }
    }

    /// Returns the rules that the mesh as it is breaks, or why it cannot be checked, once that is known.
    fn found(&self, session: &Session) -> Option<&Result<Vec<BrokenRule>, String>> {
        let (key, found) = self.found.last()?;
        (*key == self.now(session)).then_some(found)
    }

    fn now(&self, session: &Session) -> CheckedMesh {
        let mesh = MeasuredMesh::now(session.follower(), session.derivation());
        (mesh, session.document().revision(), self.solver.word())
    }

    /// Returns whether the mesh is settled and was not checked yet.
    fn is_due(&self, session: &Session) -> bool {
        let is_known = self.found.is_running() || self.found.has(&self.now(session));
        !is_known && MeasuredMesh::is_settled(session.document(), session.follower(), session.derivation())
    }

    /// Takes what was found, and lets a check of an earlier mesh give way. Returns whether one runs.
    pub fn follow(&mut self, session: &Session, jobs: &Jobs) -> bool {
        if MeasuredMesh::is_settled(session.document(), session.follower(), session.derivation()) {
            self.found.want(&self.now(session), jobs);
        }
        self.found.take(jobs)
    }

    /// Checks the mesh, where that is due.
    pub fn check(&mut self, session: &Session, view: &View, jobs: &Jobs) {
        // The rules need the values at the nodes that every format of a solver has.
        let Some(format) = ExportFormat::named("fort14").filter(|_| self.is_due(session)) else { return };
        let (export, solver) = (MeshExport::of(session, view, format), self.solver);
        let check = move || export.broken_rules(solver, &Meter::default()).map_err(|error| error.to_string());
        self.found.start(self.now(session), check, jobs);
    }
}

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Solver rules").closed().show(ui, |ui| {
        let preflight = &state.feature::<Statistics>().preflight;
        if preflight.is_due(state.session) {
            commands.push(Command::from(StatisticsCommand::CheckRules));
        }
        let mut solver = preflight.solver;
        let choices = Solver::ALL.map(|solver| (solver, solver.name()));
        if dropdown_row(ui, "Solver", &mut solver, &choices).changed() {
            commands.push(Command::from(StatisticsCommand::ChooseSolver(solver)));
        }
        match preflight.found(state.session) {
            None => {
                ValueRow::new("Rules", "being checked …").help(HELP).show(ui);
            }
            Some(Err(problem)) => {
                ValueRow::new("Rules", "not checked").help(HELP).stands_out(true).show(ui);
                remark(ui, problem);
            }
            Some(Ok(broken)) => {
                rules_row(ui, preflight.solver, broken);
                repair_row(ui, broken, commands, state);
                for broken in broken {
                    // Several rules have a first place.
                    ui.push_id(broken.rule.name, |ui| broken_rows(ui, broken, state, commands));
                }
            }
        }
    });
}

const HELP: &str = "The rules by which the solver refuses, drops or doubles what a mesh file holds, on the mesh as its \
                    file has it. On the command line: meshbrush check RECIPE --for NAME.";

/// How many rules are kept.
fn rules_row(ui: &mut Ui, solver: Solver, broken: &[BrokenRule]) {
    let all = rules_of(solver).filter(|rule| rule.severity == Severity::Violation).count();
    let violated = broken.iter().filter(|broken| broken.rule.severity == Severity::Violation).count();
    let text = match violated {
        0 => format!("all {all} kept: ready for {}", solver.name()),
        _ => format!("{violated} of {all} broken"),
    };
    ValueRow::new("Rules", &text).help(HELP).stands_out(violated > 0).show(ui);
}

/// The button that has the mesh mended, where smaller triangles help, and what came of that.
fn repair_row(ui: &mut Ui, broken: &[BrokenRule], commands: &mut Vec<Command>, state: &FrameState<'_>) {
    let repair = &state.feature::<Statistics>().repair;
    if repair.is_running() {
        remark(ui, "Looking for the triangles that are to be bisected …");
        if ui.add(ActionButton::new("Cancel repair").vanishing()).clicked() {
            commands.push(Command::from(StatisticsCommand::StopRepair));
        }
        return;
    }
    if let Some(outcome) = repair.outcome(state.session) {
        remark(ui, outcome);
        return;
    }
    let helps = broken.iter().any(|broken| broken.rule.is_mended_by_size);
    if helps && ui.add(ActionButton::new("Repair").vanishing()).on_hover_text(REPAIR).clicked() {
        commands.push(Command::from(StatisticsCommand::Repair));
    }
}

const REPAIR: &str = "Adds layers that have the triangles bisected once more which break a rule, where that helps. The mesh is then \
                      another one, in all files; Undo takes the layers away.";

/// A rule that is broken, what helps, and links to places.
fn broken_rows(ui: &mut Ui, broken: &BrokenRule, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let places = format::count(broken.found.len() as u64);
    let label = &broken.rule.title();
    let text = if broken.found.len() == 1 { "1 place".to_owned() } else { format!("{places} places") };
    let is_violation = broken.rule.severity == Severity::Violation;
    ValueRow::new(label, &text).help(broken.rule.source).stands_out(is_violation).show(ui);
    remark(ui, broken.rule.remedy);
    for (number, found) in (1..).zip(broken.found.iter().take(SHOWN_PLACES)) {
        let label = &format!("Place {number}");
        let value = &state.place_text(found.place).values.join(", ");
        let (place, size) = (found.place, size_at(found.place, state));
        PlaceRow { label, value, help: &found.sentence, place, inside: place, size }.show(ui, commands);
    }
}

/// Returns the size of the triangle at a place, in world units; that of a part of the domain beside the mesh.
fn size_at(place: DVec2, state: &FrameState<'_>) -> f64 {
    let triangle = state.session.locate(place).triangle();
    let domain = || 0.01 * state.session.document().settings().domain.bounds.size().max_element();
    triangle.map_or_else(domain, |id| state.session.view().diameter(id))
}
