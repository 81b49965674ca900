//! Paths of least cost through a mesh.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;
use meshbrush_core::document::PathCost;
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::{
    CertificateTask, CostDensity, PathArea, PathCertificate, PathMesh, PathRequest, Planner, Solution,
    Weights,
};
use meshbrush_io::io::geojson::{read_outline_from, without_names};
use meshbrush_io::io::settings::SavedSettings;
use meshbrush_io::io::shape_format::{placed_polygons, read_polygons};
use meshbrush_io::io::{DocumentPlane, Meter};
use meshbrush_mesh::text::LengthUnit;
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{array_of, points_of};
use crate::errors::{fault_in, mesh_error, mistake_in};
use crate::mesh::{Mesh, Shared};
use crate::values::text_value;
use crate::work::{Watch, Watching, run};

/// What path is asked for.
struct Asked {
    places: Vec<DVec2>,
    cost: PathCost,
    keep_out: Vec<KeepOut>,
    clearance: f64,
    /// The width of the interval around the least cost, as a share.
    within: Option<f64>,
}

/// Polygons that a path does not enter.
#[derive(FromPyObject)]
enum KeepOut {
    /// A file.
    File(PathBuf),
    /// GeoJSON.
    Shapes(Vec<u8>),
}

/// The points of a path, its figures, and the places of its stops among the points.
type PathArrays<'py> = (Bound<'py, PyArray2<f64>>, [f64; 6], Vec<usize>, Option<String>);

#[pymethods]
impl Mesh {
    /// Finds the path of least cost between places. `table` has keys of the table `paths` of a recipe.
    /// Returns points, cost, lower and upper bound of the least cost, length, risk and highest risk, the
    /// numbers of the stops, and why no narrower interval was proved.
    fn path<'py>(
        slf: &Bound<'py, Self>,
        places: PyReadonlyArray2<'py, f64>,
        table: &Bound<'py, PyDict>,
        keep_out: Vec<KeepOut>,
        within: Option<f64>,
        watching: Watching,
    ) -> PyResult<PathArrays<'py>> {
        let places = points_of(&places)?;
        let (cost, clearance) = cost_of(table, slf.get().0.finished.unit())?;
        if let Some(width) = within.filter(|width| !(1e-7..1.0).contains(width)) {
            return Err(mesh_error(format!(
                "within = {width}: give a share from 0.0000001 up to 1, as 0.01."
            )));
        }
        let asked = Asked { places, cost, keep_out, clearance, within };
        let shared = slf.get().0.clone();
        let found = run(slf.py(), &watching, move |watch| asked.found(&shared, watch))?;
        let (solution, end) = found.map_err(mesh_error)?;
        let Solution { cost, lower, upper, length, risk, highest_risk, .. } = solution;
        let figures = [cost, lower, upper, length, risk, highest_risk];
        Ok((array_of(slf.py(), solution.points.iter().copied()), figures, solution.stops, end))
    }
}

/// Checks the keys of the table `paths`, and returns what paths cost and their clearance.
fn cost_of(table: &Bound<'_, PyDict>, unit: LengthUnit) -> PyResult<(PathCost, f64)> {
    let tables = PyDict::new(table.py());
    tables.set_item("paths", table)?;
    let tables = text_value(&tables)?;
    let saved = SavedSettings::of_value_for(&tables, unit).map_err(|fault| fault_in(&tables, &fault))?;
    let paths = saved.paths;
    let default = Weights::default();
    let cost = match &paths.cost {
        Some(text) => {
            let formula = CostFormula::parse(text);
            PathCost::Formula(formula.map_err(|mistake| mistake_in("cost", text, &mistake))?)
        }
        None => PathCost::Weighted(Weights {
            length: paths.length_weight.unwrap_or(default.length),
            risk: paths.risk_weight.unwrap_or(default.risk),
        }),
    };
    Ok((cost, paths.clearance.map_or(0.0, Into::into)))
}

impl Asked {
    fn found(self, shared: &Shared, watch: &Watch) -> Result<(Solution, Option<String>), String> {
        let finished = &shared.finished;
        let domain = finished.domain();
        let sentence =
            |error: meshbrush_core::path::PathError| error.in_domain(domain, &self.places).to_string();
        let density = self.cost.density(finished.risk(), domain).map_err(sentence)?;
        let plane = domain.projection.map(DocumentPlane::from);
        let keep_out = self
            .keep_out
            .iter()
            .map(|shapes| mask(shapes, plane.as_ref(), &watch.meter))
            .collect::<Result<_, _>>()?;
        let area =
            PathArea::new(domain, finished.spec().boundary, keep_out, self.clearance).map_err(sentence)?;
        watch.tell("finding the path", 0);
        let (mut solution, mesh) = shared.with_extract(|extract| {
            let mesh = Arc::new(PathMesh::in_area(extract.view(), &area));
            let mesh = mesh.detailed(std::slice::from_ref(&self.places));
            let mut planner = Planner::new(mesh, &*density).map_err(sentence)?;
            let solution = planner.solve(&*density, &self.places, PathRequest::FULL).map_err(sentence)?;
            Ok::<_, String>((solution, Arc::clone(planner.mesh())))
        })?;
        let Some(width) = self.within.filter(|&width| solution.gap() > width) else {
            return Ok((solution, None));
        };
        let task = CertificateTask::in_rectangle(
            domain.bounds,
            Arc::clone(&density) as Arc<dyn CostDensity>,
            solution.points.clone(),
            solution.upper,
            width,
        );
        let task = task.map_err(|error| error.to_string())?.in_domain(domain).in_area(area);
        let end = proved(&mut solution, &task, mesh, watch);
        let end = if solution.gap() > width { end } else { None };
        Ok((solution, end))
    }
}

/// Raises the lower bound, and takes better paths. Returns why that ended.
fn proved(
    solution: &mut Solution,
    task: &CertificateTask,
    mesh: Arc<PathMesh>,
    watch: &Watch,
) -> Option<String> {
    let mut certificate = match PathCertificate::new(solution, task) {
        Ok(certificate) => certificate.with_search(mesh),
        Err(error) => return Some(error.to_string()),
    };
    let mut end = certificate.end();
    while end.is_none() && !watch.is_cancelled() {
        match certificate.advance() {
            Ok(reached) => end = reached,
            Err(error) => return Some(error.to_string()),
        }
        solution.take(certificate.solution());
        watch.tell("proving", (1e6 * solution.gap()) as u64);
    }
    end.map(|end| end.to_string())
}

fn mask(shapes: &KeepOut, plane: Option<&DocumentPlane>, meter: &Meter) -> Result<Mask, String> {
    let polygons = match shapes {
        KeepOut::File(file) => read_polygons(file, plane, meter),
        KeepOut::Shapes(text) => {
            let name = Path::new("keep_out");
            read_outline_from(&text[..], name)
                .and_then(|outline| placed_polygons(outline.in_degrees(), plane, name))
        }
    };
    let polygons = polygons.map_err(|error| error.to_string())?;
    Mask::new(&without_names(polygons)).map_err(|error| format!("keep_out: {error}"))
}
