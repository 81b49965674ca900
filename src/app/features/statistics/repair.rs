//! Smaller triangles where the mesh breaks a rule of a solver: layers that ask for them.

use meshbrush_io::io::solver_rules::{Repaired, Solver};
use meshbrush_kit::kit::jobs::{Jobs, Slot};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::solver_repair::SolverRepair;
use meshbrush_ui::widgets::format;

const BY_VERTICES: &str = "By the vertex rule sizes count in nodes only, so none can ask for one triangle to be bisected. Choose the \
                           area rule.";

/// Finds the layers, and adds them to the document as one edit.
#[derive(Default)]
pub struct Repair {
    found: Slot<(u64, Solver), Result<Repaired, String>>,
    /// What came of the last one, and the document after it.
    outcome: Option<(u64, String)>,
}

impl Repair {
    /// Returns whether layers are being looked for.
    pub fn is_running(&self) -> bool {
        self.found.is_running()
    }

    /// Returns what came of the last repair, as long as the document is as it left it.
    pub fn outcome(&self, session: &Session) -> Option<&str> {
        let (revision, outcome) = self.outcome.as_ref()?;
        (*revision == session.document().revision()).then_some(outcome)
    }

    /// Begins to look for the layers.
    pub fn begin(&mut self, session: &Session, solver: Solver, jobs: &Jobs) {
        let revision = session.document().revision();
        match SolverRepair::of(session, solver) {
            Some(repair) => {
                self.outcome = None;
                self.found.start_wanted((revision, solver), |wanted| repair.run(wanted), jobs);
            }
            None => self.outcome = Some((revision, BY_VERTICES.to_owned())),
        }
    }

    /// Gives up looking.
    pub fn stop(&mut self, jobs: &Jobs) {
        self.found.stop(jobs);
    }

    /// Adds the layers once they are found, unless the document has changed since. Returns whether they are
    /// being looked for.
    pub fn follow(&mut self, session: &mut Session, jobs: &Jobs) -> bool {
        let goes_on = self.found.take(jobs);
        if let Some(((revision, solver), found)) = self.found.take_last() {
            let outcome = match found {
                _ if revision != session.document().revision() => {
                    "The document has changed since the repair began: repair it again.".to_owned()
                }
                Ok(repaired) => {
                    let sentence = in_words(&repaired, solver);
                    add_layers(session, &repaired);
                    sentence
                }
                Err(problem) => problem,
            };
            self.outcome = Some((session.document().revision(), outcome));
        }
        goes_on
    }
}

fn add_layers(session: &mut Session, repaired: &Repaired) {
    session.end_gesture();
    repaired.settings_for(session.document()).into_iter().for_each(|setting| session.set(setting));
    session.end_gesture();
}

/// Returns a sentence: how many triangles are bisected, by which layers, and what is left.
fn in_words(repaired: &Repaired, solver: Solver) -> String {
    let count = |count: usize, noun: &str| {
        let plural = if count == 1 { "" } else { "s" };
        format!("{} {noun}{plural}", format::count(count as u64))
    };
    let left = match repaired.places_left() {
        0 => String::new(),
        left => format!(" Smaller triangles do not help at {}.", count(left, "place")),
    };
    match repaired.layers.len() {
        0 => format!("No triangle was bisected for {}.{left}", solver.name()),
        layers => format!(
            "{} bisected once more for {}, by {} at the top.{left}",
            count(repaired.bisected, "triangle"),
            solver.name(),
            count(layers, "layer"),
        ),
    }
}
