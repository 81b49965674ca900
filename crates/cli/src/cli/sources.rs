//! From a [`MeshRequest`] to a [`MeshSpec`]: projects, polygons and the data of layers are read here.

use std::io::stdin;
use std::path::Path;
use std::sync::Arc;

use super::failure::Failure;
use super::output::is_standard_stream;
use super::request::{MeshRequest, USUAL_BUDGET, check_boundary_diameter};
use super::terminal::Terminal;
use meshbrush_core::build::MeshSpec;
use meshbrush_core::document::{PathPlan, Settings};
use meshbrush_core::domain::BoundaryMarks;
use meshbrush_core::layers::PaintLayers;
use meshbrush_io::io::geojson::{self, Outline};
use meshbrush_io::io::recipe::{Described, Loading, SavedTreatment};
use meshbrush_io::io::{Meter, ReadError, project};
use meshbrush_mesh::geometry::Lattice;
use meshbrush_mesh::mesh::{CoarseError, Limits, MemoryLimit, bisection_edge_length};
use meshbrush_mesh::text::LengthUnit;

/// What to mesh, and what is said about the mesh: of a document with the options in place of its settings.
pub struct ToMesh {
    /// What to mesh.
    pub spec: MeshSpec,
    /// What is painted on its layers.
    pub paint: PaintLayers,
    /// Names of the boundary.
    pub marks: Arc<BoundaryMarks>,
    /// The unit of coordinates and lengths, where a file says it.
    pub unit: LengthUnit,
    /// The paths of a project.
    pub paths: Arc<PathPlan>,
}

/// Reads the files of a request.
///
/// # Errors
/// When a file cannot be read or used, there is no coarse grid, or an option does not suit the file.
pub fn read(request: &MeshRequest, terminal: &mut Terminal) -> Result<ToMesh, Failure> {
    let meter = Meter::default();
    match &request.project {
        Some(path) => read_project(path, request, &meter, terminal),
        None => read_description(request, &meter, terminal),
    }
}

fn read_project(
    path: &Path,
    request: &MeshRequest,
    meter: &Meter,
    terminal: &mut Terminal,
) -> Result<ToMesh, Failure> {
    let reading = format!("reading {}", path.display());
    let document = terminal.while_metered(&reading, meter, || project::read_metered(path, meter))?;
    let options = &request.mesh;
    let has_outline = document.settings().domain.region().is_some();
    if let Some(diameter) = options.boundary_diameter {
        let stored = SavedTreatment::of(document.settings().boundary);
        check_boundary_diameter(diameter, has_outline, Some(options.boundary.unwrap_or(stored)))?;
    } else if options.boundary.is_some() && !has_outline {
        terminal.note("--boundary changes nothing: the domain of the project has no polygons.");
    }
    let settings = options.override_settings(document.settings().clone());
    settings.transfer.checked()?;
    let limits = Limits {
        max_triangles: settings.max_triangles,
        max_level: options.max_level,
        // The window keeps room for a second mesh; here there is one.
        max_memory: Some(MemoryLimit::for_one_mesh(settings.max_memory)),
    };
    let bounds = settings.domain.bounds;
    let lattice = Lattice::covering(bounds, settings.spacing, limits.most_triangles());
    let lattice = lattice.map_err(CoarseError::from)?;
    let spec = settings.mesh_spec_on(lattice, limits);
    to_mesh(request, spec, document.paint().clone(), settings)
}

fn read_description(
    request: &MeshRequest,
    meter: &Meter,
    terminal: &mut Terminal,
) -> Result<ToMesh, Failure> {
    let limits = request.mesh.limits(USUAL_BUDGET);
    let most_coarse = limits.most_triangles();
    let loading = Loading { most_coarse, with_hidden: false, read_outline, meter };
    let read = terminal.while_metered("reading", meter, || request.mesh.load("", &loading));
    let described = read?;
    let spec = described.mesh_spec(limits);
    let Described { settings, paint, notes, .. } = described;
    notes.iter().for_each(|note| terminal.note(note));
    to_mesh(request, spec, paint, settings)
}

fn to_mesh(
    request: &MeshRequest,
    spec: MeshSpec,
    paint: PaintLayers,
    settings: Settings,
) -> Result<ToMesh, Failure> {
    request.mesh.boundary_diameter.map_or(Ok(()), |diameter| check_resolvable(diameter, &spec.lattice))?;
    // What is said about parts counts for every domain; else only fitted meshes are cleaned.
    let spec = MeshSpec { cleaning: request.mesh.cleaning(spec.cleaning), ..spec };
    let Settings { boundary_marks: marks, unit, paths, .. } = settings;
    Ok(ToMesh { spec, paint, marks, unit, paths })
}

/// Reads the polygons of a domain, from standard input where the file is `-`.
fn read_outline(path: &Path, meter: &Meter) -> Result<Outline, ReadError> {
    match is_standard_stream(path) {
        true => geojson::read_outline_from(stdin().lock(), Path::new("standard input")),
        false => geojson::read_outline(path, meter),
    }
}

/// Refuses a diameter at the outline that the lattice cannot resolve: the refinement would fail wherever the
/// outline passes.
fn check_resolvable(diameter: f64, lattice: &Lattice) -> Result<(), Failure> {
    let level = lattice.deepest_level();
    let smallest = bisection_edge_length(lattice.spacing(), level);
    if diameter >= smallest {
        return Ok(());
    }
    Err(Failure::Work(format!(
        "--boundary-diameter {diameter:e}: below {smallest:.3e} (level {level}) nodes would leave the lattice. Raise it, or mesh a \
         smaller domain."
    )))
}
