//! `meshbrush path`: build, then find the path of least cost.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;
use serde::Serialize;

use super::build::{FinishedMesh, build};
use super::details::MeshDetails;
use super::failure::Failure;
use super::mesh::note_capped;
use super::output::{RequestedLook, check_place};
use super::path_args::PathArguments;
use super::request::MeshRequest;
use super::terminal::Terminal;
use super::why::point;
use crate::field::CostFormula;
use crate::io::{self as files, Interruption, Meter, write_file_metered};
use crate::layers::Mask;
use crate::mesh::Extract;
use crate::path::{
    Certificate, CertificateTask, CostDensity, FormulaCost, PathMesh, PathRequest, PathSample, Planner,
    Solution, WeightedCost, Weights,
};
use crate::render::export::ExportFormat;
use crate::text::{Grouped, Number};

/// Runs the command. `line` is how it was typed, and `out` is standard output.
///
/// # Errors
/// With the reason, when the arguments make no sense, the work failed, or there is no path.
pub fn run(
    typed: &PathArguments,
    line: &str,
    out: &mut dyn Write,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let places = places(typed)?;
    let within = typed.within.as_deref().map(share).transpose()?;
    let formula = typed.cost.as_deref().map(cost_formula).transpose()?;
    let look = RequestedLook::new(&typed.picture)?;
    let outputs = typed.output.iter().map(|path| PathOutput::new(path)).collect::<Result<Vec<_>, _>>()?;
    let request = MeshRequest::new(&typed.input)?;
    let inputs = [request.input_files(), typed.keep_out.clone()].concat();
    outputs.iter().try_for_each(|output| check_place(&output.path, &inputs))?;
    request.options_without_effect(&typed.input).iter().for_each(|note| terminal.note(note));
    let keep_out = typed.keep_out.iter().map(|path| mask(path)).collect::<Result<Vec<_>, _>>()?;
    let finished = build(&request, terminal)?;
    note_capped(&finished, terminal);
    let extract = finished.extract();
    let density = density(typed, formula, &finished)?;
    let start = Instant::now();
    let mut planner = Planner::new(PathMesh::with_keep_out(extract.view(), &keep_out), &*density)?;
    let mut legs = planner.legs(&*density, &places, PathRequest::FULL)?;
    if let Some(width) = within {
        let prover = Prover { finished: &finished, density: &density, keep_out: &keep_out, width };
        legs.iter_mut().try_for_each(|leg| prover.tighten(leg, terminal))?;
    }
    let solution = Solution::joined(legs);
    let seconds = start.elapsed().as_secs_f64();
    if let Some(width) = within.filter(|&width| solution.gap() > width) {
        let reached = percent(solution.gap());
        terminal
            .note(&format!("The path is proved to be within {reached} of the best, not {}.", percent(width)));
    }
    let kept = match typed.simplify {
        Some(tolerance) => solution.waypoints(tolerance)?,
        None => (0..solution.points.len()).collect(),
    };
    let details = MeshDetails::of(&finished, &extract, line, &request);
    let written =
        Written { solution: &solution, samples: solution.samples_at(&*density, &kept), details: &details };
    written.write_files(&outputs, (&finished, &extract), &look, terminal)?;
    let answer = Answer::new(&solution, &written.samples, extract.triangles().len(), seconds);
    match typed.json {
        true => {
            let json = serde_json::to_string(&answer).map_err(|error| Failure::Print(error.into()))?;
            writeln!(out, "{json}").and_then(|()| out.flush()).map_err(Failure::Print)
        }
        false => writeln!(out, "{}", answer.for_people()).map_err(Failure::Print),
    }
}

/// The start, the via points and the goal.
fn places(typed: &PathArguments) -> Result<Vec<DVec2>, Failure> {
    let texts = std::iter::once(&typed.from).chain(&typed.via).chain([&typed.to]);
    texts.map(|text| point(text)).collect()
}

/// Reads "1%" or "0.01".
fn share(text: &str) -> Result<f64, Failure> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let share = number.trim().parse::<f64>().ok().map(|number| number * unit);
    share.filter(|share| (1e-7..1.0).contains(share)).ok_or_else(|| {
        Failure::Usage(format!("--within {text}: write a share from 0.00001% up to 100%, as in 1% or 0.01."))
    })
}

fn cost_formula(text: &str) -> Result<CostFormula, Failure> {
    CostFormula::parse(text).map_err(|mistake| {
        let pointer = mistake.pointer().replace('\n', "\n    ");
        Failure::Usage(format!("--cost: {mistake}\n    {pointer}"))
    })
}

fn density(
    typed: &PathArguments,
    formula: Option<CostFormula>,
    finished: &FinishedMesh,
) -> Result<Arc<dyn CostDensity>, Failure> {
    let risk = finished.risk();
    if let Some(formula) = formula {
        return Ok(Arc::new(FormulaCost { formula, risk }));
    }
    let usual = Weights::default();
    let weights = Weights {
        length: typed.length_weight.unwrap_or(usual.length),
        risk: typed.risk_weight.unwrap_or(usual.risk),
    };
    Ok(Arc::new(WeightedCost::new(weights, risk)?))
}

fn mask(path: &Path) -> Result<Mask, Failure> {
    let polygons = files::geojson::read(path)?;
    Mask::new(&polygons).map_err(|error| Failure::Work(format!("{}: {error}", path.display())))
}

/// Raises lower bounds.
struct Prover<'a> {
    finished: &'a FinishedMesh,
    density: &'a Arc<dyn CostDensity>,
    keep_out: &'a [Mask],
    width: f64,
}

impl Prover<'_> {
    fn tighten(&self, leg: &mut Solution, terminal: &mut Terminal) -> Result<(), Failure> {
        if leg.gap() <= self.width {
            return Ok(());
        }
        let start = Instant::now();
        let mut certificate = Certificate::new(self.task(leg))?;
        loop {
            let end = certificate.advance()?;
            leg.tighten(certificate.lower());
            match end {
                Some(_) => break,
                None => terminal.progress(start, || format!("within {} of the best", percent(leg.gap()))),
            }
        }
        terminal.clear();
        Ok(())
    }

    fn task(&self, leg: &Solution) -> CertificateTask {
        let domain = self.finished.domain();
        let (cost, path) = (self.density.clone(), leg.points.clone());
        CertificateTask::in_rectangle(domain.bounds, cost, path, leg.upper, self.width)
            .expect("the bounds of a domain are a rectangle")
            .in_domain(domain)
            .outside_of(self.keep_out.to_vec())
    }
}

/// A file of the path.
struct PathOutput {
    path: PathBuf,
    format: PathFormat,
}

enum PathFormat {
    GeoJson,
    Csv,
    Picture(ExportFormat),
}

impl PathOutput {
    fn new(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let format = match ending.to_ascii_lowercase().as_str() {
            "geojson" | "json" => PathFormat::GeoJson,
            "csv" => PathFormat::Csv,
            "svg" => PathFormat::Picture(ExportFormat::Svg),
            "png" => PathFormat::Picture(ExportFormat::Png),
            _ => {
                let problem = format!("-o {}: the ending decides the format", path.display());
                return Err(Failure::Usage(format!("{problem}; use .geojson, .csv, .svg or .png.")));
            }
        };
        Ok(Self { path: path.to_owned(), format })
    }
}

/// What files get of a path.
struct Written<'a> {
    solution: &'a Solution,
    samples: Vec<PathSample>,
    details: &'a MeshDetails,
}

impl Written<'_> {
    fn write_files(
        &self,
        outputs: &[PathOutput],
        (finished, extract): (&FinishedMesh, &Extract),
        look: &RequestedLook,
        terminal: &mut Terminal,
    ) -> Result<(), Failure> {
        let interruption = Interruption::listen().map_err(|error| Failure::Work(format!("{error}.")))?;
        let look = look.for_mesh(finished.mesh());
        let points: Vec<DVec2> = self.samples.iter().map(|sample| sample.point).collect();
        for PathOutput { path, format } in outputs {
            let meter = interruption.meter();
            let write = |out: &mut dyn Write, meter: &Meter| -> io::Result<()> {
                let provenance = &self.details.provenance;
                match format {
                    PathFormat::GeoJson => {
                        files::path::write_geojson(out, self.solution, &self.samples, provenance)
                    }
                    PathFormat::Csv => files::path::write_csv(out, &self.samples),
                    PathFormat::Picture(format) => {
                        let of = (finished.mesh(), extract);
                        format.write_path_to(out, of, &points, &look, provenance, meter)
                    }
                }
            };
            let written = terminal.while_metered(&format!("writing {}", path.display()), &meter, || {
                write_file_metered(path, &meter, |out| write(out, &meter))
            });
            interruption.end_program();
            let failed = |error: io::Error| Failure::Write { file: path.clone(), problem: error.to_string() };
            written.map_err(failed)?;
            terminal.say(&format!("wrote {}", path.display()));
        }
        Ok(())
    }
}

/// The answer of `--json`.
#[derive(Serialize)]
struct Answer {
    /// What the path costs.
    cost: f64,
    /// No path costs less.
    lower: f64,
    /// The best path costs no more.
    upper: f64,
    /// In world units.
    length: f64,
    /// The integral of the risk.
    risk: f64,
    highest_risk: f64,
    points: Vec<[f64; 2]>,
    /// Triangles of the mesh.
    triangles: usize,
    /// Time for path and bounds.
    seconds: f64,
}

impl Answer {
    fn new(solution: &Solution, samples: &[PathSample], triangles: usize, seconds: f64) -> Self {
        let Solution { cost, lower, upper, length, risk, highest_risk, .. } = *solution;
        let points = samples.iter().map(|sample| sample.point.to_array()).collect();
        Self { cost, lower, upper, length, risk, highest_risk, points, triangles, seconds }
    }

    fn for_people(&self) -> String {
        let gap = if self.upper > 0.0 { (self.upper - self.lower) / self.upper } else { 0.0 };
        format!(
            "cost {}, within {} of the best: no path costs less than {}\n\
             length {}, accumulated risk {}, highest risk {}\n\
             {} triangles, {:.2} s",
            short(self.cost),
            percent(gap),
            short(self.lower),
            short(self.length),
            short(self.risk),
            short(self.highest_risk),
            Grouped(self.triangles),
            self.seconds
        )
    }
}

/// Six significant digits.
fn short(value: f64) -> Number {
    Number(format!("{value:.5e}").parse().unwrap_or(value))
}

/// A share, rounded up.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = if percent < 0.1 { 1000.0 } else { 100.0 };
    format!("{} %", (percent * digits).ceil() / digits)
}
