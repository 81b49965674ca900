//! The rules of solvers, and smaller triangles where a mesh breaks them.

use meshbrush_cli::cli::build::MeshOrigin;
use meshbrush_cli::cli::check::FileToCheck;
use meshbrush_cli::cli::details::provenance_from;
use meshbrush_cli::cli::exported_mesh::ExportedMesh;
use meshbrush_cli::cli::failure::Failure;
use meshbrush_cli::cli::output_coordinates::OutputCoordinates;
use meshbrush_cli::cli::output_keys::{depth_changes_of, quantities_of};
use meshbrush_core::document::Setting;
use meshbrush_core::domain::Domain;
use meshbrush_core::field::RefinementRule;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_io::io::settings::{SavedDomain, SavedOutput};
use meshbrush_io::io::solver_rules::{Solver, StripCutting, repaired};
use meshbrush_io::io::{CellShape, MeshSource};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::document::{Document, NO_PLANE, built, lock, origin_of};
use crate::errors::{fault_in, mesh_error};
use crate::mesh::{Mesh, values_at_nodes};
use crate::values::text_value;
use crate::work::{Watch, Watching, run};

#[pymethods]
impl Mesh {
    /// Says where the mesh as a file of a solver has it breaks its rules: the text of `meshbrush check
    /// --json`, and notes on quantities. `output` has the quantities and grids of a file.
    #[pyo3(signature = (output, solver, crs, cells, values))]
    fn check(
        slf: &Bound<'_, Self>,
        output: &Bound<'_, PyDict>,
        solver: &str,
        crs: Option<&str>,
        cells: Option<&str>,
        values: Vec<(String, PyReadonlyArray1<'_, f64>)>,
    ) -> PyResult<(String, Vec<String>)> {
        let shared = slf.get().0.clone();
        let solver: Solver = solver.parse().map_err(mesh_error)?;
        let cells = cells.map(str::parse::<CellShape>).transpose();
        let cells = cells.map_err(|error| mesh_error(format!("cells: {error}")))?.unwrap_or_default();
        let coordinates = match crs {
            Some(text) => text.parse().map_err(|error| mesh_error(format!("crs: {error}")))?,
            None => OutputCoordinates::from(shared.finished.coordinates()),
        };
        if crs.is_some_and(|text| text != "plane") && shared.finished.domain().projection.is_none() {
            return Err(mesh_error(NO_PLANE));
        }
        let table = text_value(output)?;
        let keys = SavedOutput::of_value(&table)
            .and_then(|saved| Ok((quantities_of(&saved)?, depth_changes_of(&saved)?)));
        let (quantities, depth_changes) = keys.map_err(|fault| fault_in(&table, &fault))?;
        let values = values_at_nodes(values, shared.counts()[0])?;
        let answer = run(slf.py(), &Watching::QUIET, move |_| {
            let details = shared.details().map_err(|problem| Failure::Work(problem.to_owned()))?;
            let source = MeshSource::Document(&shared.name);
            let provenance = &provenance_from(&shared.finished, source, None, coordinates);
            shared.with_extract(|extract| {
                let finished = &shared.finished;
                let exported = ExportedMesh {
                    finished,
                    extract,
                    details,
                    provenance,
                    coordinates,
                    target_diameter: &[],
                };
                let mut notes = Vec::new();
                let (values, _) = exported.values_at_nodes(&quantities, values, depth_changes, &mut notes)?;
                let values = &values;
                let answer = FileToCheck { exported, values, cells, solver }.as_json()?;
                Ok((answer, notes))
            })
        })?;
        answer.map_err(|failure: Failure| mesh_error(failure))
    }
}

#[pymethods]
impl Document {
    /// Adds layers with which the mesh keeps the rules of a solver, as far as smaller triangles help, as one
    /// edit. Returns the triangles that they bisect, and the places that are left.
    fn repair(&self, py: Python<'_>, solver: &str, watching: Watching) -> PyResult<(usize, usize)> {
        let solver: Solver = solver.parse().map_err(mesh_error)?;
        let state = self.state.clone();
        let (found, revision) = run(py, &watching, move |watch| {
            let (origin, revision) = {
                let state = lock(&state);
                let lattice = state.document.settings().lattice().map_err(|error| error.to_string())?;
                (origin_of(&state, lattice), state.document.revision())
            };
            if origin.spec.rule == RefinementRule::Vertex {
                return Err(BY_VERTICES.to_owned());
            }
            let make = |spec| built(spec, &origin.paint, watch).map(|(built, ..)| built);
            Ok((repaired(solver, &origin.spec, &origin.marks, (1.0, &origin.paint), make)?, revision))
        })?
        .map_err(mesh_error)?;
        self.with(py, |state| {
            let document = &mut state.document;
            if document.revision() != revision {
                return Err(mesh_error(CHANGED));
            }
            document.end_gesture();
            for setting in found.settings_for(document) {
                document.set(setting).map_err(mesh_error)?;
            }
            document.end_gesture();
            Ok(())
        })?;
        Ok((found.bisected, found.places_left()))
    }

    /// Cuts strips off the domain in which its frame runs along a coast, as one edit. Returns how many were
    /// cut off, and how many are left.
    fn cut_strips(&self, py: Python<'_>, solver: &str, watching: Watching) -> PyResult<(usize, usize)> {
        let solver: Solver = solver.parse().map_err(mesh_error)?;
        let state = self.state.clone();
        let (domain, counts, revision) = run(py, &watching, move |watch| {
            let (origin, revision) = {
                let state = lock(&state);
                let lattice = state.document.settings().lattice().map_err(|error| error.to_string())?;
                (origin_of(&state, lattice), state.document.revision())
            };
            let (domain, counts) = without_strips(solver, &origin, watch)?;
            Ok::<_, String>((domain, counts, revision))
        })?
        .map_err(mesh_error)?;
        self.with(py, |state| {
            let document = &mut state.document;
            if document.revision() != revision {
                return Err(mesh_error(CHANGED_BEFORE_CUT));
            }
            document.end_gesture();
            document.set(Setting::Domain(domain)).map_err(mesh_error)?;
            document.end_gesture();
            Ok(())
        })?;
        Ok(counts)
    }
}

/// Returns a domain without the strips in which its frame runs along a coast, how many were cut off, and how
/// many are left.
fn without_strips(
    solver: Solver,
    origin: &MeshOrigin,
    watch: &Watch,
) -> Result<(Domain, (usize, usize)), String> {
    let cutting = StripCutting::new(solver);
    let mut cutting =
        cutting.ok_or_else(|| format!("{} has no rule on strips along the frame.", solver.name()))?;
    let mut spec = origin.spec.clone();
    loop {
        let (made, ..) = built(spec.clone(), &origin.paint, watch)?;
        let targets = made.edge_targets(&origin.paint);
        let derived = DerivedMesh::new(&made.mesh, &made.domain, targets, &spec.cleaning);
        if !cutting.look(&derived.extract(&made.mesh), &spec.domain, &origin.marks) {
            return Ok((spec.domain, (cutting.cut(), cutting.left().len())));
        }
        let rings = SavedDomain { cut_off: cutting.rings().to_vec(), ..SavedDomain::default() };
        let cut = rings.cut(origin.spec.domain.clone());
        spec.domain = cut.map_err(|fault| fault.full_sentence())?;
    }
}

const CHANGED: &str =
    "The document was changed while its mesh was being repaired, and nothing was added. Repair it again.";
const CHANGED_BEFORE_CUT: &str = "The document was changed while strips were being looked for, and nothing was cut off. Cut them off again.";
const BY_VERTICES: &str = "The mesh cannot be repaired: by the vertex rule sizes count in nodes only, so none can ask for one triangle \
                           to be bisected. Choose rule=\"area\".";
