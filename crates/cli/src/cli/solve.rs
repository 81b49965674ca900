//! `meshbrush solve`: build, then solve a problem on the mesh by finite elements.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use serde::Serialize;

use super::args::SolveArguments;
use super::build::build;
use super::details::{DetailUses, MeshDetails, provenance};
use super::exported_mesh::ExportedMesh;
use super::failure::Failure;
use super::input::Input;
use super::mesh::note_capped;
use super::output::check_place;
use super::problem::problem;
use super::requested_files::RequestedFiles;
use super::solved_mesh::{ErrorGoal, ErrorRound, MeshByError, SolvedMesh, short};
use super::terminal::Terminal;
use meshbrush_fem::fem::{BoundProof, FemProblem, WITHOUT_PROOF};
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_io::io::{Interruption, NodeValues, Provenance, certificate, write_file_metered};
use meshbrush_mesh::text::Grouped;

/// The name of the solution in files.
const SOLUTION: &str = "u";

/// Runs the command. `line` is how it was typed, and `out` is standard output.
///
/// # Errors
/// Fails with the reason, when the arguments make no sense, the work failed, or there is no solution.
pub fn run(
    typed: &SolveArguments,
    line: &str,
    out: &mut dyn Write,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let input = Input::new(&typed.input)?;
    let (problem, exact) = problem(&typed.problem, &input.settings.problem)?;
    let files = requested(typed, &input)?;
    input.options_without_effect(&typed.input).iter().for_each(|note| terminal.note(note));
    let document = build(&input, terminal)?;
    note_capped(&document, terminal);
    let start = Instant::now();
    let solve = || MeshByError::new(&document, &problem, exact.as_ref(), goal(typed), |_| true);
    let by_error = terminal.while_working("solving", solve)?;
    let answer = SolveAnswer::new(&by_error, start.elapsed().as_secs_f64());
    let (finished, solved) = (by_error.finished(&document), &by_error.solved);
    let extract = finished.extract();
    solved.notes(&problem, finished, &extract).iter().for_each(|note| terminal.note(note));
    let coordinates = typed.out_crs.unwrap_or_else(|| finished.coordinates().into());
    let origin = provenance(finished, line, &input, coordinates);
    if !files.is_empty() {
        let origin = origin.clone();
        let uses = DetailUses { node_data: true, ..DetailUses::default() };
        let details = MeshDetails::with_provenance(finished, &extract, origin, uses)?;
        let target_diameter = finished.target_at_nodes(&extract, &Default::default());
        let target_diameter = &target_diameter.expect("nobody cancels this meter");
        let provenance: &Provenance = &details.provenance;
        let (extract, details) = (&extract, &details);
        let exported = ExportedMesh { finished, extract, details, provenance, coordinates, target_diameter };
        files.iter().try_for_each(|files| write(files, &exported, solved, terminal))?;
    }
    let write = |file| write_certificate(file, solved, &problem, &origin, terminal);
    typed.certificate.as_deref().map_or(Ok(()), write)?;
    answer.print(typed.json, out)
}

/// Writes what proves the bound.
fn write_certificate(
    file: &Path,
    solved: &SolvedMesh,
    problem: &FemProblem,
    origin: &Provenance,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let proof = BoundProof::new(&solved.mesh, problem, &solved.solution, &solved.bound);
    let proof = proof.ok_or_else(|| Failure::Work(format!("{}: {WITHOUT_PROOF}", file.display())))?;
    terminal.while_writing(file, |meter| {
        write_file_metered(file, meter, |out| certificate::write_solution(out, &proof, origin))
    })?;
    terminal.say(&format!("wrote {}", file.display()));
    Ok(())
}

/// Returns when the mesh is fine enough.
fn goal(typed: &SolveArguments) -> ErrorGoal {
    match (typed.within, typed.at_most()) {
        (Some(within), _) => ErrorGoal::Within(within),
        (None, Some(most)) => ErrorGoal::AtMost(most),
        (None, None) => ErrorGoal::Document,
    }
}

/// Returns the files that are asked for.
fn requested(typed: &SolveArguments, input: &Input) -> Result<Vec<RequestedFiles>, Failure> {
    let file = |file: &std::path::PathBuf| {
        check_place(file, &input.files())?;
        let keys = SavedOutput { file: file.clone(), ..SavedOutput::default() };
        RequestedFiles::of_keys(&keys, None).map_err(|fault| Failure::Usage(fault.to_string()))
    };
    typed.certificate.iter().try_for_each(|file| check_place(file, &input.files()))?;
    typed.output.iter().map(file).collect()
}

fn write(
    files: &RequestedFiles,
    exported: &ExportedMesh,
    solved: &SolvedMesh,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let values = solved.values_in_files(exported.finished);
    let values = vec![NodeValues { name: SOLUTION.into(), values }];
    let interruption = Interruption::listen().map_err(|error| Failure::Work(format!("{error}.")))?;
    let (meter, mut notes) = (interruption.meter(), Vec::new());
    let written =
        terminal.while_metered("writing", &meter, || files.write(exported, values, &mut notes, &meter));
    interruption.end_program();
    written?.iter().for_each(|path| terminal.say(&format!("wrote {}", path.display())));
    notes.iter().for_each(|note| terminal.note(note));
    Ok(())
}

/// The answer of `--json`.
#[derive(Serialize)]
struct SolveAnswer {
    /// Nodes of the mesh.
    nodes: usize,
    /// Triangles of the mesh.
    triangles: usize,
    /// Steps of the solver.
    steps: usize,
    /// The least and the greatest value at a node.
    range: [f64; 2],
    /// The energy norm of u.
    energy_norm: f64,
    /// The energy error is at most this.
    energy_error_bound: f64,
    /// Whether that is proved, up to rounding of the last digits.
    guaranteed: bool,
    /// Why it is an estimate.
    estimate_because: Vec<String>,
    /// The energy error by the formula of the solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    energy_error: Option<f64>,
    /// Whether the mean of u is set to 0, because nothing else determines it.
    mean_is_zero: bool,
    /// The greatest Péclet number of a triangle.
    #[serde(skip_serializing_if = "Option::is_none")]
    peclet: Option<f64>,
    /// Time for solution and bound, and for all meshes by the error.
    seconds: f64,
    /// The meshes by the error, from that of the document.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    rounds: Vec<ErrorRound>,
}

impl SolveAnswer {
    fn new(by_error: &MeshByError, seconds: f64) -> Self {
        let SolvedMesh { mesh, solution, bound, error } = &by_error.solved;
        let least = solution.values.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = solution.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self {
            nodes: mesh.node_count(),
            triangles: mesh.triangle_count(),
            steps: solution.steps,
            range: [least, greatest],
            energy_norm: solution.energy_norm(mesh),
            energy_error_bound: bound.total,
            guaranteed: bound.is_guaranteed(),
            estimate_because: bound.doubts.iter().map(ToString::to_string).collect(),
            energy_error: *error,
            mean_is_zero: solution.has_mean_zero,
            peclet: solution.peclet.map(|(number, _)| number),
            seconds,
            rounds: if by_error.rounds.len() > 1 { by_error.rounds.clone() } else { Vec::new() },
        }
    }

    fn print(&self, as_json: bool, out: &mut dyn Write) -> Result<(), Failure> {
        let text = match as_json {
            true => serde_json::to_string(self).map_err(|error| Failure::Print(error.into()))?,
            false => self.for_people(),
        };
        writeln!(out, "{text}").and_then(|()| out.flush()).map_err(Failure::Print)
    }

    fn for_people(&self) -> String {
        let bound = match self.guaranteed {
            true => format!("energy error at most {}", short(self.energy_error_bound)),
            false => format!(
                "energy error about {}, an estimate: {}",
                short(self.energy_error_bound),
                self.estimate_because.join("; ")
            ),
        };
        let known = self.energy_error.map(|error| format!(", and {} by the formula", short(error)));
        format!(
            "u from {} to {}, energy norm {}\n\
             {bound}{}\n\
             {} nodes, {} triangles, {} steps, {:.2} s",
            short(self.range[0]),
            short(self.range[1]),
            short(self.energy_norm),
            known.unwrap_or_default(),
            Grouped(self.nodes),
            Grouped(self.triangles),
            self.steps,
            self.seconds
        )
    }
}
