//! A document: settings, layers and paint, and its mesh.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use meshbrush_cli::cli::build::{FinishedMesh, MeshOrigin};
use meshbrush_core::build::{BuildError, BuildStage, BuiltMesh, MeshBuilder, MeshSpec};
use meshbrush_core::document::{self as core, Settings};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::PaintLayers;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_io::io::recipe::{self, LoadedDocument, Loading};
use meshbrush_io::io::settings::{SavedSettings, word_of};
use meshbrush_io::io::{TextValue, obstacle, project, write_file_metered};
use meshbrush_mesh::geometry::Lattice;
use meshbrush_mesh::mesh::{Limits, MemoryLimit, Progress, RefineError};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{array_of, points_of};
use crate::errors::{fault_in, file_error, load_error, mesh_error, read_error};
use crate::mesh::{Mesh, Shared};
use crate::values::{Frame, GivenData, given_of, text_value};
use crate::work::{Watch, Watching, run};

/// Triangles, edges or pixels of a slice of work, between two looks whether it is cancelled.
const SLICE: usize = 1 << 15;

/// Why there are no other coordinates.
pub const NO_PLANE: &str = "The domain is not in the plane of a projection, so its coordinates are those of its files. Choose a plane \
     with projection, as in projection=\"auto\".";

/// A document.
#[pyclass(frozen, module = "meshbrush._core")]
pub struct Document {
    pub state: Arc<Mutex<State>>,
    /// What keeps a mesh up to date with the document; locked during the work.
    pub follower: Arc<Mutex<Option<core::Follower>>>,
}

/// Everything about a document.
pub struct State {
    pub document: core::Document,
    /// What coordinates of files are that do not name a known system.
    pub assumed: Option<Coordinates>,
    /// The coordinates of files with the mesh, unless others are asked for.
    coordinates: Coordinates,
    /// Whether somebody said the smallest diameter, which risk needs.
    pub has_smallest: bool,
    /// What the options say about the parts that stay.
    parts: SavedSettings,
    /// Settings and mesh at the time when changes of the paint were last taken.
    pub base: Option<(Settings, Arc<Shared>)>,
    /// How often they were taken.
    taken: u64,
}

impl Document {
    fn of(loaded: LoadedDocument, saved: &SavedSettings) -> Self {
        let LoadedDocument { document, coordinates, notes: _, without_effect: _ } = loaded;
        Self::of_state(State {
            document,
            assumed: saved.domain.assumed().ok().flatten(),
            coordinates: coordinates.unwrap_or(Coordinates::Geographic),
            has_smallest: saved.limits.h_min.is_some(),
            parts: SavedSettings { domain: saved.domain.clone(), ..SavedSettings::default() },
            base: None,
            taken: 0,
        })
    }

    fn of_document(document: core::Document) -> Self {
        Self::of_state(State {
            document,
            assumed: None,
            coordinates: Coordinates::Geographic,
            has_smallest: true,
            parts: SavedSettings::default(),
            base: None,
            taken: 0,
        })
    }

    fn of_state(state: State) -> Self {
        Self { state: Arc::new(Mutex::new(state)), follower: Arc::default() }
    }

    /// Looks at the document, or changes it, while no lock of Python is held.
    pub fn with<T: Send>(&self, py: Python<'_>, act: impl FnOnce(&mut State) -> T + Send) -> T {
        py.detach(|| act(&mut lock(&self.state)))
    }
}

/// Locks a value, also where a panic has left it: documents and meshes are whole after every step.
pub fn lock<T>(value: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

#[pymethods]
impl Document {
    /// Makes a document from tables with the keys of a recipe, and returns it with notes for a person, and
    /// those of them on what has no effect.
    #[staticmethod]
    fn new(
        py: Python<'_>,
        tables: &Bound<'_, PyDict>,
        given: Vec<(String, GivenData<'_>)>,
        name: String,
    ) -> PyResult<(Self, Vec<String>, Vec<String>)> {
        let tables = text_value(tables)?;
        let given = given_of(given, None)?;
        let saved = SavedSettings::of_value(&tables, &given).map_err(|fault| fault_in(&tables, &fault))?;
        let loaded = run(py, &Watching::QUIET, move |watch| {
            let loading = Loading { given, ..Loading::for_document(&watch.meter) };
            saved.into_document(&name, &loading).map(|loaded| (loaded, saved))
        })?;
        let (loaded, saved) = loaded.map_err(|error| load_error(&tables, &error))?;
        let (notes, without_effect) = (loaded.notes.clone(), loaded.without_effect.clone());
        Ok((Self::of(loaded, &saved), notes, without_effect))
    }

    /// Reads a recipe, and returns its document with notes for a person, and those of them on what has no
    /// effect.
    #[staticmethod]
    fn read_recipe(py: Python<'_>, path: PathBuf) -> PyResult<(Self, Vec<String>, Vec<String>)> {
        let loaded = run(py, &Watching::QUIET, move |watch| {
            let recipe = recipe::read(&path)?;
            let loaded = recipe.into_document(&Loading::for_document(&watch.meter))?;
            Ok((loaded, recipe.settings))
        })?;
        let (loaded, saved) =
            loaded.map_err(|error: recipe::LoadError| load_error(&TextValue::Nothing, &error))?;
        let (notes, without_effect) = (loaded.notes.clone(), loaded.without_effect.clone());
        Ok((Self::of(loaded, &saved), notes, without_effect))
    }

    /// Reads a project.
    #[staticmethod]
    fn read_project(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = run(py, &Watching::QUIET, move |watch| project::read_metered(&path, &watch.meter))?;
        read.map(Self::of_document).map_err(|error| read_error(&error))
    }

    /// Reads a project from the bytes of its file.
    #[staticmethod]
    fn of_bytes(py: Python<'_>, bytes: Vec<u8>) -> PyResult<Self> {
        let read = run(py, &Watching::QUIET, move |_| {
            let project =
                project::from_bytes(&bytes, "document".as_ref()).map_err(|error| read_error(&error))?;
            project.into_document().map_err(mesh_error)
        })?;
        read.map(Self::of_document)
    }

    /// The bytes of a project.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let project = self.with(py, |state| project::Project::of(&state.document));
        let written = run(py, &Watching::QUIET, move |watch| {
            let mut bytes = Vec::new();
            project::write_metered(&mut bytes, &project, &watch.meter).map(|()| bytes)
        })?;
        Ok(PyBytes::new(py, &written.map_err(file_error)?))
    }

    /// Writes a project, or a recipe with files beside it.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let project = self.with(py, |state| project::Project::of(&state.document));
        let shown = path.display().to_string();
        let written = run(py, &Watching::QUIET, move |watch| {
            let ending = path.extension().unwrap_or_default();
            if ending.eq_ignore_ascii_case(recipe::ENDING) {
                return recipe::RecipeFiles::new(&project, &path).write(&watch.meter).map(|_| ());
            }
            if let Some(problem) = obstacle(&path) {
                return Err(std::io::Error::other(problem));
            }
            write_file_metered(&path, &watch.meter, |out| project::write_metered(out, &project, &watch.meter))
        })?;
        written.map_err(|error| file_error(format!("{shown} cannot be written: {error}.")))
    }

    /// The settings that options change, by their names.
    fn options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let settings = self.with(py, |state| state.document.settings().clone());
        let saved: SavedSettings = SavedSettings::of(&settings, "", Vec::new(), Vec::new());
        let all = PyDict::new(py);
        all.set_item("name", settings.name)?;
        all.set_item("unit", settings.unit.name())?;
        all.set_item("spacing", settings.spacing)?;
        all.set_item("h_min", settings.transfer.h_min)?;
        all.set_item("h_risk", settings.transfer.h_risk)?;
        all.set_item("h_max", settings.transfer.h_max)?;
        all.set_item("shape", settings.transfer.shape)?;
        all.set_item("gradation", settings.gradation)?;
        all.set_item("rule", saved.mesh.rule.as_ref().map(word_of))?;
        all.set_item("max_triangles", settings.max_triangles)?;
        all.set_item("max_memory", settings.max_memory)?;
        all.set_item("max_level", settings.max_level)?;
        let boundary = saved.domain.boundary;
        all.set_item("boundary", boundary.as_ref().map(word_of))?;
        all.set_item("boundary_diameter", boundary.and(settings.boundary.diameter()))?;
        all.set_item("projection", settings.domain.projection.map(|projection| projection.to_string()))?;
        let bounds = settings.domain.bounds;
        all.set_item("bounds", (bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y))?;
        Ok(all)
    }

    /// Changes the settings that tables with the keys of a recipe state.
    fn set(&self, py: Python<'_>, tables: &Bound<'_, PyDict>) -> PyResult<()> {
        let tables = text_value(tables)?;
        let unit = self.with(py, |state| state.document.settings().unit);
        let saved = SavedSettings::of_value_for(&tables, unit).map_err(|fault| fault_in(&tables, &fault))?;
        self.with(py, |state| {
            let wanted = saved.override_settings(state.document.settings().clone());
            let wanted = wanted.map_err(|fault| fault_in(&tables, &fault))?;
            state.document.change_numbers(wanted).map_err(mesh_error)?;
            state.has_smallest |= saved.limits.h_min.is_some();
            // What is said about parts counts for every domain.
            let parts = &mut state.parts.domain;
            parts.parts = saved.domain.parts.or(parts.parts);
            parts.keep_pinches = saved.domain.keep_pinches.or(parts.keep_pinches);
            parts.improve_boundary = saved.domain.improve_boundary.or(parts.improve_boundary);
            Ok(())
        })
    }

    /// A number that grows with every change.
    fn revision(&self, py: Python<'_>) -> u64 {
        self.with(py, |state| state.document.revision())
    }

    /// Returns longitudes and latitudes in the plane of the document.
    fn to_world<'py>(
        &self,
        py: Python<'py>,
        lonlat: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let projection = self.with(py, |state| state.document.settings().domain.projection);
        let projection = projection.ok_or_else(|| mesh_error(NO_PLANE))?;
        let points = points_of(&lonlat)?;
        Ok(array_of(py, points.into_iter().map(|point| projection.plane_from_geographic(point))))
    }

    /// Undoes the last edit, and returns whether there was one.
    fn undo(&self, py: Python<'_>) -> bool {
        self.with(py, |state| state.document.undo())
    }

    /// Redoes the edit that was undone last, and returns whether there was one.
    fn redo(&self, py: Python<'_>) -> bool {
        self.with(py, |state| state.document.redo())
    }

    /// Returns the mesh.
    fn mesh(&self, py: Python<'_>, watching: Watching, fresh: bool) -> PyResult<Mesh> {
        let (state, follower) = (self.state.clone(), self.follower.clone());
        let made = run(py, &watching, move |watch| {
            let held = lock(&follower);
            if let (Some(follower), false) = (&*held, fresh)
                && let Some((built, origin)) = built_in_place(&state, follower)
            {
                drop(held);
                let name = lock(&state).document.settings().name.clone();
                return derived(built, origin, name, Duration::ZERO, 0, watch);
            }
            let to_make = ToMake::of(&state, held.is_some())?;
            drop(held);
            to_make.made(&state, watch)
        })?;
        Ok(Mesh(made.map_err(mesh_error)?))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        self.with(py, |state| {
            let settings = state.document.settings();
            let count = settings.layers.len();
            let plural = if count == 1 { "" } else { "s" };
            format!("<meshbrush.Document “{}”: {count} layer{plural}>", settings.name)
        })
    }
}

/// Returns the mesh that follows the document, where it is that of the document as it is.
fn built_in_place(state: &Mutex<State>, follower: &core::Follower) -> Option<(BuiltMesh, MeshOrigin)> {
    let state = lock(state);
    follower
        .is_in_step(&state.document)
        .then(|| (follower.built(), origin_of(&state, *follower.mesh().lattice())))
}

/// Returns what the mesh of a document on a lattice is made from.
pub fn origin_of(state: &State, lattice: Lattice) -> MeshOrigin {
    let settings = state.document.settings();
    let default = settings.derived_cleaning();
    // Of a fitted mesh, the settings have what was said, and an undo takes it back.
    let cleaning = if settings.is_fitted() { default } else { state.parts.cleaning(default) };
    MeshOrigin {
        spec: MeshSpec { cleaning, ..settings.mesh_spec_on(lattice, limits_of(state)) },
        paint: state.document.paint().clone(),
        marks: settings.boundary_marks.clone(),
        unit: settings.unit,
        coordinates: state.coordinates,
        // A document does not keep what was said about its files.
        assumed: None,
    }
}

fn limits_of(state: &State) -> Limits {
    let settings = state.document.settings();
    Limits {
        max_triangles: settings.max_triangles,
        max_level: settings.max_level,
        max_memory: Some(MemoryLimit::for_one_mesh(settings.max_memory)),
    }
}

/// The mesh of a document as it was at one time, to be made from scratch.
pub struct ToMake {
    origin: MeshOrigin,
    settings: Settings,
    /// The number of the time when changes of the paint were taken, if they were.
    taken: Option<u64>,
}

impl ToMake {
    /// Returns what to make of a document as it is. Without a follower, changes of the paint count from here
    /// on.
    ///
    /// # Errors
    /// Fails when there is no coarse grid.
    pub fn of(state: &Mutex<State>, is_followed: bool) -> Result<Self, String> {
        let mut state = lock(state);
        let settings = state.document.settings().clone();
        let lattice = settings.lattice().map_err(|error| error.to_string())?;
        let taken = (!is_followed).then(|| {
            state.base = None;
            state.document.take_repainted();
            state.taken += 1;
            state.taken
        });
        Ok(Self { origin: origin_of(&state, lattice), settings, taken })
    }

    /// Makes the mesh. The document can change meanwhile.
    ///
    /// # Errors
    /// Fails when there is no such mesh, and when the work was cancelled.
    pub fn made(self, state: &Mutex<State>, watch: &Watch) -> Result<Arc<Shared>, String> {
        let Self { origin, settings, taken } = self;
        let (built, refinement, capped) = built(origin.spec.clone(), &origin.paint, watch)?;
        let mesh = derived(built, origin, settings.name.clone(), refinement, capped, watch)?;
        let mut state = lock(state);
        if taken == Some(state.taken) {
            state.base = Some((settings, mesh.clone()));
        }
        Ok(mesh)
    }
}

/// Makes a mesh from scratch. Returns the time of refinement and the triangles that a cap left too coarse,
/// too.
///
/// # Errors
/// Fails when there is no such mesh, and when the work was cancelled.
pub fn built(
    spec: MeshSpec,
    paint: &PaintLayers,
    watch: &Watch,
) -> Result<(BuiltMesh, Duration, usize), String> {
    let mut builder = MeshBuilder::new(spec);
    let mut refinement = Duration::ZERO;
    loop {
        let (stage, begun) = (builder.stage(), Instant::now());
        let (name, done) = match stage {
            BuildStage::Indexing => ("indexing the outline", 0),
            BuildStage::Checking => ("checking the layers", 0),
            BuildStage::Refining { triangles } => ("refining", triangles),
            BuildStage::Classifying { triangles } => ("classifying", triangles),
        };
        watch.tell(name, done as u64);
        let progress = builder.advance(Some(paint), SLICE).map_err(|error| sentence(&error))?;
        if matches!(stage, BuildStage::Refining { .. }) {
            refinement += begun.elapsed();
        }
        if watch.is_cancelled() {
            return Err("it was cancelled".to_owned());
        }
        if progress == Progress::Done {
            let capped = builder.capped();
            return Ok((builder.finish(), refinement, capped));
        }
    }
}

/// Returns what went wrong, with advice.
pub fn sentence(error: &BuildError) -> String {
    let advice = match error {
        BuildError::Refine(RefineError::TooManyTriangles { .. }) => " Raise h_min, or raise max_triangles.",
        BuildError::Refine(RefineError::TooMuchMemory { .. }) => " Raise h_min, or raise max_memory.",
        BuildError::Refine(RefineError::TooFine { .. }) => " Raise h_min, or mesh a smaller domain.",
        _ => "",
    };
    format!("{error}{advice}")
}

fn derived(
    built: BuiltMesh,
    origin: MeshOrigin,
    name: String,
    refinement: Duration,
    capped: usize,
    watch: &Watch,
) -> Result<Arc<Shared>, String> {
    watch.tell("fitting the mesh to its domain", built.mesh.raw_triangle_count() as u64);
    let targets = built.edge_targets(&origin.paint);
    let derived = DerivedMesh::new(&built.mesh, &built.domain, targets, &origin.spec.cleaning);
    let finished = FinishedMesh::new(built, derived, origin, refinement, capped);
    Ok(Shared::new(finished.map_err(|error| error.to_string())?, name))
}

/// Returns where grids without a place lie in a document.
pub fn frame_of(state: &State) -> Frame {
    let domain = &state.document.settings().domain;
    let bounds = domain.bounds;
    Frame {
        bounds: [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y],
        plane: domain.projection.map(Coordinates::Plane),
    }
}
