//! `meshbrush check`: build, then say where the mesh as it would be written breaks the rules of a solver.

use std::fmt::Write as _;
use std::io::Write;

use serde::Serialize;

use super::args::CheckArguments;
use super::build::FinishedMesh;
use super::cut_strips::{Suited, build_suited};
use super::details::{DetailUses, MeshDetails};
use super::exported_mesh::ExportedMesh;
use super::failure::Failure;
use super::input::Input;
use super::mesh::note_capped;
use super::quantities::typed_quantities;
use super::terminal::Terminal;
use meshbrush_io::io::solver_rules::{
    BrokenPlace, BrokenRule, Severity, Solver, SolverRule, WrittenMesh, broken_rules, rules_of,
};
use meshbrush_io::io::{CellShape, JoinedCells, MeshData, NodeValues};
use meshbrush_mesh::text::{Grouped, Number};

/// How many places of a rule are printed one by one; JSON has all.
const SHOWN_PLACES: usize = 10;

/// Runs the command. `line` is how it was typed, and `out` is standard output.
///
/// # Errors
/// Fails with the reason, when the arguments make no sense, the work failed, or the mesh breaks a rule.
pub fn run(
    typed: &CheckArguments,
    line: &str,
    out: &mut dyn Write,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let mut input = Input::new(&typed.input)?.scaled(typed.scale.unwrap_or(1.0));
    let quantities = typed_quantities(&typed.quantities)?;
    input.check_depth_for(quantities.iter().find(|quantity| quantity.uses_depth()))?;
    input.options_without_effect(&typed.input).iter().for_each(|note| terminal.note(note));
    let named = [
        (typed.cut_strips.then_some(typed.solver), "--cut-strips"),
        (typed.repair.then_some(typed.solver), "--repair"),
    ];
    let (finished, suited) = build_suited(&mut input, named, terminal)?;
    note_capped(&finished, terminal);
    let extract = finished.extract();
    let coordinates = typed.out_crs.unwrap_or_else(|| finished.coordinates().into());
    let given_depth = quantities.iter().find(|quantity| quantity.is_depth());
    let uses = DetailUses { json: false, node_data: true, given_depth, depth_changes: typed.depths.into() };
    let details = MeshDetails::of(&finished, &extract, line, &input, coordinates, uses)?;
    let provenance = &details.provenance;
    let exported = ExportedMesh {
        finished: &finished,
        extract: &extract,
        details: &details,
        provenance,
        coordinates,
        target_diameter: &[],
    };
    let mut notes = details.quantity_notes.clone();
    let (values, _) = exported.values_at_nodes(&quantities, Vec::new(), uses.depth_changes, &mut notes)?;
    notes.iter().for_each(|note| terminal.note(note));
    let cells = typed.cells.unwrap_or_default();
    let file = FileToCheck { exported, values: &values, cells, solver: typed.solver };
    let (written, broken) = terminal.while_working("checking the rules", || file.broken())?;
    let answer = CheckAnswer { suited, ..file.answer(&written, &broken) };
    let text = match typed.json {
        true => serde_json::to_string(&answer).map_err(|error| Failure::Print(error.into()))? + "\n",
        false => answer.for_people(typed.solver, &broken),
    };
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(Failure::Print)?;
    match answer.violations.len() {
        0 => Ok(()),
        count => Err(Failure::Work(format!(
            "The mesh breaks rules of {} in {}.",
            typed.solver.name(),
            counted(count, "place")
        ))),
    }
}

/// A mesh that is checked as a file of a solver has it.
pub struct FileToCheck<'a> {
    /// The mesh.
    pub exported: ExportedMesh<'a>,
    /// Values at its nodes.
    pub values: &'a [NodeValues],
    /// The cells of the file.
    pub cells: CellShape,
    /// The solver.
    pub solver: Solver,
}

impl<'a> FileToCheck<'a> {
    /// Returns the text of `meshbrush check --json`.
    ///
    /// # Errors
    /// Fails where the domain is not in the plane of a projection, and other coordinates are asked for.
    pub fn as_json(&self) -> Result<String, Failure> {
        let (written, broken) = self.broken()?;
        serde_json::to_string(&self.answer(&written, &broken)).map_err(|error| Failure::Print(error.into()))
    }

    /// Returns the mesh as the file has it, and the rules that it breaks.
    fn broken(&self) -> Result<(WrittenMesh, Vec<BrokenRule>), Failure> {
        let placed = self.exported.in_coordinates()?;
        // Those of the details can be in other coordinates.
        let joined = &JoinedCells::default();
        let data = MeshData { cells: self.cells, joined, ..self.exported.data(self.values, false) };
        let written = WrittenMesh::of(placed.as_ref().unwrap_or(self.exported.extract), &data, self.solver);
        let broken = broken_rules(&written, self.solver);
        Ok((written, broken))
    }

    fn answer<'b>(&self, written: &WrittenMesh, broken: &'b [BrokenRule]) -> CheckAnswer<'b>
    where
        'a: 'b,
    {
        let ExportedMesh { finished, provenance, .. } = self.exported;
        let meaning = provenance.entries().find_map(|(key, text)| (key == "coordinates").then_some(text));
        CheckAnswer::new(finished, written, self.solver, meaning.unwrap_or_default(), broken)
    }
}

/// The answer of `--json`.
#[derive(Serialize)]
struct CheckAnswer<'a> {
    /// The word of the solver.
    solver: &'static str,
    /// What coordinates are in the file.
    coordinates: &'a str,
    triangles: usize,
    nodes: usize,
    /// The mesh's fingerprint.
    hash: String,
    /// All rules of the solver, with the number of places that break them.
    rules: Vec<RuleCount>,
    /// The places that break a rule.
    violations: Vec<PlaceAnswer<'a>>,
    /// The places that a person should know of.
    notes: Vec<PlaceAnswer<'a>>,
    /// What was done so that fewer rules are broken, if that was asked for.
    #[serde(flatten)]
    suited: Suited,
    /// Rules that could not be checked, as the boundary touches itself.
    unchecked: Vec<&'static str>,
}

/// A rule, and how often it is broken.
#[derive(Serialize)]
struct RuleCount {
    rule: &'static str,
    source: &'static str,
    count: usize,
}

/// A place that breaks a rule.
#[derive(Serialize)]
struct PlaceAnswer<'a> {
    rule: &'static str,
    /// In the coordinates of the file.
    place: [f64; 2],
    source: &'static str,
    sentence: &'a str,
}

impl<'a> PlaceAnswer<'a> {
    /// Returns the places that break rules that matter so much.
    fn all(broken: &'a [BrokenRule], severity: Severity) -> Vec<Self> {
        let of_severity = broken.iter().filter(|broken| broken.rule.severity == severity);
        let places =
            of_severity.flat_map(|broken| broken.found.iter().map(move |found| (broken.rule, found)));
        let place = |(rule, found): (&SolverRule, &'a BrokenPlace)| Self {
            rule: rule.name,
            place: found.place.into(),
            source: rule.source,
            sentence: &found.sentence,
        };
        places.map(place).collect()
    }
}

impl<'a> CheckAnswer<'a> {
    fn new(
        finished: &FinishedMesh,
        written: &WrittenMesh,
        solver: Solver,
        coordinates: &'a str,
        broken: &'a [BrokenRule],
    ) -> Self {
        let count = |name: &str| {
            broken.iter().find(|broken| broken.rule.name == name).map_or(0, |broken| broken.found.len())
        };
        let of_rule =
            |rule: &'static str, source: &'static str| RuleCount { rule, source, count: count(rule) };
        let needs = rules_of(solver).filter(|rule| rule.needs_strings && !written.has_strings());
        Self {
            solver: solver.word(),
            coordinates,
            triangles: written.triangles.len(),
            nodes: written.nodes.len(),
            hash: finished.mesh().fingerprint().to_string(),
            rules: rules_of(solver).map(|rule| of_rule(rule.name, rule.source)).collect(),
            violations: PlaceAnswer::all(broken, Severity::Violation),
            notes: PlaceAnswer::all(broken, Severity::Note),
            suited: Suited::default(),
            unchecked: needs.map(|rule| rule.name).collect(),
        }
    }

    /// Returns a line about the mesh, and for each broken rule its first places and what helps.
    fn for_people(&self, solver: Solver, broken: &[BrokenRule]) -> String {
        let name = solver.name();
        let (violations, rules) = (self.violations.len(), self.rules.len());
        let (triangles, coordinates) = (counted(self.triangles, "triangle"), self.coordinates);
        let found = if violations == 0 { "no violation".into() } else { counted(violations, "violation") };
        let of = counted(rules, "rule");
        let mut text = format!("{name}: {found} of {of} in {triangles}, with {coordinates}\n");
        for BrokenRule { rule, found } in broken {
            let kind = if rule.severity == Severity::Note { "note: " } else { "" };
            let _ = write!(text, "\n{kind}{} ({}): {}\n", rule.name, rule.source, Grouped(found.len()));
            for BrokenPlace { place, sentence, .. } in found.iter().take(SHOWN_PLACES) {
                let _ = writeln!(text, "  x = {}, y = {}: {sentence}", Number(place.x), Number(place.y));
            }
            if let Some(more @ 1..) = found.len().checked_sub(SHOWN_PLACES) {
                let _ = writeln!(text, "  {} more; --json has all", Grouped(more));
            }
            let _ = writeln!(text, "  {}", rule.remedy);
        }
        if let Some(cut) = &self.suited.cut_strips {
            text += &cut.with_recipe();
        }
        if let Some(repaired) = &self.suited.repaired {
            let _ = writeln!(text, "\n{}", repaired.for_people());
            if !repaired.as_recipe().is_empty() {
                let _ = writeln!(
                    text,
                    "In a recipe, these values in [limits] and these layers after the others ask for it:\n\n{}",
                    repaired.as_recipe()
                );
            }
        }
        if !self.unchecked.is_empty() {
            let names = self.unchecked.join(", ");
            let _ = writeln!(text, "\nnot checked, as the boundary touches itself: {names}");
        }
        text
    }
}

/// Returns a number with its noun.
fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{} {noun}{plural}", Grouped(count))
}
