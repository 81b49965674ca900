//! `meshbrush path`: build, then find the path of least cost.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;
use serde::Serialize;

use super::args::PathArguments;
use super::build::{FinishedMesh, build_from};
use super::details::provenance;
use super::exported_mesh::NOT_ON_EARTH;
use super::failure::Failure;
use super::input::{Input, ToMesh};
use super::lengths;
use super::mesh::note_capped;
use super::output::{RequestedLook, check_place};
use super::output_coordinates::OutputCoordinates;
use super::path_proof::{About, Proof, task, write_certificate};
use super::points::TypedPoint;
use super::terminal::Terminal;
use meshbrush_core::document::{PathCost, PathPlan};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::earth::{Coordinates, EarthPlane, Projection, Speed, hours_and_minutes, metres_along};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::{
    CostDensity, PathArea, PathError, PathMesh, PathRequest, Planner, Solution, Weights,
};
use meshbrush_io::io::path::PathLengths;
use meshbrush_io::io::{self as files, DocumentPlane, Meter, Provenance};
use meshbrush_mesh::mesh::MeshView;
use meshbrush_mesh::text::{Grouped, LengthUnit, Number, percent_above, rounded};
use meshbrush_render::render::path_export::{MeshOfPath, NotOnEarth, PathExport, PathFormat};

/// Runs the command. `line` is how it was typed, and `out` is standard output.
///
/// # Errors
/// Fails with the reason, when the arguments make no sense, the work failed, or there is no path.
pub fn run(
    typed: &PathArguments,
    line: &str,
    out: &mut dyn Write,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let within = typed.within.as_deref().map(share).transpose()?;
    let formula = typed.cost.as_deref().map(cost_formula).transpose()?;
    let speed = typed.speed.as_deref().map(speed).transpose()?;
    let places = places(typed)?;
    let look = RequestedLook::new(&typed.picture)?;
    let outputs = typed.output.iter().map(|path| PathOutput::new(path)).collect::<Result<Vec<_>, _>>()?;
    let input = Input::new(&typed.input)?;
    let inputs = [input.files(), typed.keep_out.clone()].concat();
    let files = outputs.iter().map(|output| &output.path).chain(&typed.certificate);
    files.into_iter().try_for_each(|file| check_place(file, &inputs))?;
    input.options_without_effect(&typed.input).iter().for_each(|note| terminal.note(note));
    let ask =
        |saved: &PathPlan, plane: Option<&DocumentPlane>| RequestedPath::new(typed, formula, saved, plane);
    let (read, mut asked) = read_and_ask(&input, terminal, ask)?;
    let (projection, unit) = (read.spec.domain.projection, read.unit);
    if let Some(places) = &places {
        asked.places = in_domain(places, projection, unit)?;
    }
    let plane = EarthPlane::new(projection, unit);
    check_units(typed, plane, unit)?;
    outputs.iter().try_for_each(|output| output.format.check(&output.path, plane)).map_err(usage)?;
    let finished = build_from(read, terminal)?;
    note_capped(&finished, terminal);
    let extract = finished.extract();
    let density = asked.cost.density(finished.risk(), finished.domain())?;
    let start = Instant::now();
    let area = asked.area(finished.domain(), finished.spec().boundary)?;
    let search = || asked.path(&*density, extract.view(), &area);
    let (mut solution, mesh) = terminal
        .while_working("finding the path", search)
        .map_err(|error| error.in_domain(finished.domain(), &asked.places))?;
    let width = within.filter(|&width| solution.gap() > width || typed.certificate.is_some());
    let certificate = width.and_then(|width| {
        let task = task(&finished, density.clone(), area, &solution, width);
        Proof::search(&mut solution, &task, mesh, terminal).noted(&solution, width, terminal)
    });
    let seconds = start.elapsed().as_secs_f64();
    let simplify = typed.simplify.as_ref().map(|length| length.value);
    let export = PathExport::new(&solution, &*density, simplify)?.named(asked.name.clone(), plane);
    let mut export = export.at_speed(speed, unit);
    let provenance = provenance(&finished, line, &input, OutputCoordinates::Plane);
    let look = look.for_extract(&finished, &extract)?;
    let over = MeshOfPath { mesh: finished.mesh(), extract: &extract, look: &look };
    for output in &outputs {
        let coordinates = output.coordinates(typed, &finished);
        export = export.in_coordinates(finished.domain(), coordinates);
        output.write(&export, &over, &provenance, terminal)?;
    }
    let about = asked.about(finished.domain());
    let write = |file| write_certificate(file, certificate.as_ref(), &about, &provenance, terminal);
    typed.certificate.as_deref().map_or(Ok(()), write)?;
    let answer = PathAnswer::new(&export, extract.triangles().len(), seconds);
    answer.print(typed.json, export.solution().gap(), out)
}

/// Checks that lengths with a unit, and times, have a meaning in the document.
fn check_units(typed: &PathArguments, plane: Option<EarthPlane>, unit: LengthUnit) -> Result<(), Failure> {
    if !matches!(plane, Some(EarthPlane::Projected(_)))
        && matches!(typed.out_crs, Some(OutputCoordinates::Other(_)))
    {
        return Err(Failure::Usage(NOT_ON_EARTH.into()));
    }
    [("--clearance", &typed.clearance), ("--simplify", &typed.simplify)]
        .into_iter()
        .filter_map(|(option, length)| Some((option, length.as_ref()?)))
        .try_for_each(|(option, length)| lengths::check(option, length, unit))?;
    check_times(typed, plane, unit)
}

/// The requested path: from the options, and from the project or recipe where an option is missing.
struct RequestedPath {
    places: Vec<DVec2>,
    cost: PathCost,
    keep_out: Vec<Mask>,
    clearance: f64,
    name: String,
}

impl RequestedPath {
    /// Reads the keep-out regions, in the plane of the domain if it lies in one. `saved` is what the file
    /// says; its places are ignored if the options give some.
    fn new(
        typed: &PathArguments,
        formula: Option<CostFormula>,
        saved: &PathPlan,
        plane: Option<&DocumentPlane>,
    ) -> Result<Self, Failure> {
        let keep_out = match typed.keep_out.is_empty() {
            true => saved.keep_out_masks(),
            false => typed.keep_out.iter().map(|path| mask(path, plane)).collect::<Result<_, _>>()?,
        };
        let (name, places) = match typed.from {
            Some(_) => ("Path".to_owned(), Vec::new()),
            None => (saved.name(route_index(typed)), saved_places(typed, saved)?),
        };
        let clearance = typed.clearance.as_ref().map_or(saved.clearance, |clearance| clearance.value);
        Ok(Self { places, cost: cost(typed, formula, &saved.cost), keep_out, clearance, name })
    }

    /// Returns where the path may go.
    fn area(&self, domain: &Domain, boundary: BoundaryTreatment) -> Result<PathArea, PathError> {
        PathArea::new(domain, boundary, self.keep_out.clone(), self.clearance)
    }

    /// Returns what a certificate is about.
    fn about<'a>(&'a self, domain: &'a Domain) -> About<'a> {
        let clearance = domain.greatest_scale() * self.clearance;
        About { cost: &self.cost, domain, keep_out: &self.keep_out, clearance }
    }

    /// Returns the path, and the triangles that it was sought in.
    fn path(
        &self,
        density: &dyn CostDensity,
        view: MeshView,
        area: &PathArea,
    ) -> Result<(Solution, Arc<PathMesh>), PathError> {
        let mesh = Arc::new(PathMesh::in_area(view, area)).detailed(std::slice::from_ref(&self.places));
        let mut planner = Planner::new(mesh, density)?;
        let solution = planner.solve(density, &self.places, PathRequest::FULL)?;
        Ok((solution, Arc::clone(planner.mesh())))
    }
}

/// Reads the files of an input, and what path is asked for, which can depend on the paths of its project or
/// recipe and on its plane. Without any of them the path is read first: a mistake in it should not wait for
/// large files.
fn read_and_ask(
    input: &Input,
    terminal: &mut Terminal,
    ask: impl FnOnce(&PathPlan, Option<&DocumentPlane>) -> Result<RequestedPath, Failure>,
) -> Result<(ToMesh, RequestedPath), Failure> {
    if input.project.is_none() && input.recipe.is_none() && input.settings.domain.projection.is_none() {
        let asked = ask(&PathPlan::default(), None)?;
        return Ok((input.read(terminal)?, asked));
    }
    let read = input.read(terminal)?;
    // The text was read with the settings.
    let assumed = input.settings.domain.crs.as_deref().and_then(|text| text.parse().ok());
    let plane = read.spec.domain.projection.map(|projection| DocumentPlane { projection, assumed });
    let asked = ask(&read.paths, plane.as_ref())?;
    Ok((read, asked))
}

/// Returns the start, the via points and the goal, where they are given.
fn places(typed: &PathArguments) -> Result<Option<Vec<TypedPoint>>, Failure> {
    let Some((from, to)) = typed.from.as_ref().zip(typed.to.as_ref()) else { return Ok(None) };
    let texts = std::iter::once(from).chain(&typed.via).chain([to]);
    texts.map(|text| TypedPoint::parse(text)).collect::<Result<_, _>>().map(Some)
}

/// Returns places in the coordinates of the domain.
fn in_domain(
    places: &[TypedPoint],
    projection: Option<Projection>,
    unit: LengthUnit,
) -> Result<Vec<DVec2>, Failure> {
    places.iter().map(|place| place.in_domain(projection, unit)).collect()
}

/// Returns the number, from 0, of the path of the project or the recipe that is asked for.
fn route_index(typed: &PathArguments) -> usize {
    typed.route.unwrap_or(1).saturating_sub(1)
}

fn speed(text: &str) -> Result<Speed, Failure> {
    text.parse().map_err(|error| Failure::Usage(format!("--speed: {error}")))
}

/// Checks that lengths in metres are known where a time is asked for.
fn check_times(typed: &PathArguments, plane: Option<EarthPlane>, unit: LengthUnit) -> Result<(), Failure> {
    match &typed.speed {
        Some(speed) if metres_along(plane, unit, &[]).is_none() => Err(Failure::Usage(format!(
            "--speed {speed}: the time of a path needs lengths in metres, and the unit of the coordinates is not \
             known. They need a projection, or the unit m, km or degrees in the recipe or project."
        ))),
        _ => Ok(()),
    }
}

fn usage(error: NotOnEarth) -> Failure {
    Failure::Usage(format!("-o {error}"))
}

/// Returns the places of a path of the project or the recipe.
fn saved_places(typed: &PathArguments, saved: &PathPlan) -> Result<Vec<DVec2>, Failure> {
    let number = typed.route.unwrap_or(1);
    if let Some(places) = number.checked_sub(1).and_then(|n| saved.routes.get(n)) {
        return Ok(places.clone());
    }
    let file = typed.input.project.as_ref().map(|project| (project, "set one in the window"));
    let file = file.or(typed.input.recipe.as_ref().map(|recipe| (recipe, "add `routes` to [paths]")));
    Err(Failure::Usage(match (file, saved.routes.len()) {
        (None, _) => "A path needs a start and a goal: give --from X,Y and --to X,Y.".to_owned(),
        (Some((file, how)), 0) => {
            format!("{} has no path: give --from X,Y and --to X,Y, or {how}.", file.display())
        }
        (Some((file, _)), count) => {
            format!("--route {number}: the paths of {} are numbered from 1 to {count}.", file.display())
        }
    }))
}

/// Returns the cost of paths. A weight that is not given comes from the file, or has its default.
fn cost(typed: &PathArguments, formula: Option<CostFormula>, saved: &PathCost) -> PathCost {
    if let Some(formula) = formula {
        return PathCost::Formula(formula);
    }
    if typed.length_weight.is_none() && typed.risk_weight.is_none() {
        return saved.clone();
    }
    let default = match saved {
        PathCost::Weighted(weights) => *weights,
        PathCost::Formula(_) => Weights::default(),
    };
    PathCost::Weighted(Weights {
        length: typed.length_weight.unwrap_or(default.length),
        risk: typed.risk_weight.unwrap_or(default.risk),
    })
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

fn mask(path: &Path, plane: Option<&DocumentPlane>) -> Result<Mask, Failure> {
    let named = files::shape_format::read_polygons(path, plane, &Meter::default())?;
    Mask::new(&files::geojson::without_names(named))
        .map_err(|error| Failure::Work(format!("{}: {error}", path.display())))
}

/// A file of the path.
struct PathOutput {
    path: PathBuf,
    format: PathFormat,
}

impl PathOutput {
    fn new(path: &Path) -> Result<Self, Failure> {
        let format = PathFormat::from_path(path).map_err(|error| Failure::Usage(format!("-o {error}.")))?;
        Ok(Self { path: path.to_owned(), format })
    }

    /// Returns the coordinates of the file; without them they are longitudes and latitudes, where a path has
    /// any.
    fn coordinates(&self, typed: &PathArguments, finished: &FinishedMesh) -> Option<Coordinates> {
        match typed.out_crs {
            Some(OutputCoordinates::Lonlat) => Some(Coordinates::Geographic),
            Some(OutputCoordinates::Other(other)) => Some(other),
            Some(OutputCoordinates::Plane) => finished.domain().projection.map(Coordinates::Plane),
            None => (self.format == PathFormat::Csv).then(|| finished.coordinates()),
        }
    }

    fn write(
        &self,
        export: &PathExport<'_>,
        over: &MeshOfPath<'_>,
        provenance: &Provenance,
        terminal: &mut Terminal,
    ) -> Result<(), Failure> {
        let Self { path, format } = self;
        terminal.while_writing(path, |meter| export.write(path, *format, over, provenance, meter))?;
        terminal.say(&format!("wrote {}", path.display()));
        Ok(())
    }
}

/// The answer of `--json`.
#[derive(Serialize)]
struct PathAnswer {
    /// The cost of the path.
    cost: f64,
    /// No path costs less; 0 where no bound is known.
    lower: f64,
    /// The best path costs no more.
    upper: f64,
    /// The length of the path: in metres on the ellipsoid in the plane of a projection, otherwise in world
    /// units.
    length: f64,
    /// The length in the plane of a projection, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    length_in_plane: Option<f64>,
    /// The time of the path at the speed that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    travel_seconds: Option<f64>,
    /// The integral of the risk.
    risk: f64,
    highest_risk: f64,
    points: Vec<[f64; 2]>,
    /// Triangles of the mesh.
    triangles: usize,
    /// Time for path and bounds.
    seconds: f64,
}

impl PathAnswer {
    fn new(export: &PathExport<'_>, triangles: usize, seconds: f64) -> Self {
        let Solution { cost, lower, upper, risk, highest_risk, .. } = *export.solution();
        let PathLengths { length, in_plane: length_in_plane, seconds: travel_seconds } = *export.lengths();
        Self {
            cost,
            lower,
            upper,
            length,
            length_in_plane,
            travel_seconds,
            risk,
            highest_risk,
            points: export.samples().iter().map(|sample| sample.point.to_array()).collect(),
            triangles,
            seconds,
        }
    }

    fn print(&self, as_json: bool, gap: f64, out: &mut dyn Write) -> Result<(), Failure> {
        let text = match as_json {
            true => serde_json::to_string(self).map_err(|error| Failure::Print(error.into()))?,
            false => self.for_people(gap),
        };
        writeln!(out, "{text}").and_then(|()| out.flush()).map_err(Failure::Print)
    }

    fn for_people(&self, gap: f64) -> String {
        let bound = match self.lower > 0.0 || self.upper == 0.0 {
            true => {
                format!(
                    "within {} of the best: no path costs less than {}",
                    percent_above(gap),
                    short(self.lower)
                )
            }
            false => {
                "no lower bound is known: the mesh does not cover the whole domain. --within 1% looks for one"
                    .to_owned()
            }
        };
        let on_the_ellipsoid = if self.length_in_plane.is_some() { " m on the ellipsoid" } else { "" };
        let time = self.travel_seconds.map(|seconds| format!(", {} on the way", hours_and_minutes(seconds)));
        format!(
            "cost {}, {bound}\n\
             length {}{on_the_ellipsoid}{}, accumulated risk {}, highest risk {}\n\
             {} triangles, {:.2} s",
            short(self.cost),
            short(self.length),
            time.unwrap_or_default(),
            short(self.risk),
            short(self.highest_risk),
            Grouped(self.triangles),
            self.seconds
        )
    }
}

/// Six significant digits.
fn short(value: f64) -> Number {
    Number(rounded(value, 6))
}
