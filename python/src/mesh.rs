//! A mesh as arrays.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use meshbrush_cli::cli::build::FinishedMesh;
use meshbrush_cli::cli::details::{DetailUses, MeshDetails, provenance_from};
use meshbrush_cli::cli::exported_mesh::ExportedMesh;
use meshbrush_cli::cli::failure::Failure;
use meshbrush_cli::cli::output::Output;
use meshbrush_cli::cli::output_coordinates::OutputCoordinates;
use meshbrush_cli::cli::requested_files::RequestedFiles;
use meshbrush_cli::cli::summary::Summary;
use meshbrush_core::earth::Coordinates;
use meshbrush_core::surface::CurvePoint;
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_io::io::{Cancelled, MeshSource, Meter, NodeValues};
use meshbrush_mesh::mesh::{Extract, PatchedLocator};
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, ToPyArray};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};

use crate::arrays::{array_of, lent};
use crate::document::NO_PLANE;
use crate::errors::{fault_in, file_error, mesh_error};
use crate::values::text_value;
use crate::work::{Watching, run};

/// A mesh that does not change any more.
#[pyclass(frozen, module = "meshbrush._core")]
pub struct Mesh(pub Arc<Shared>);

/// A mesh, and what was computed from it.
pub struct Shared {
    pub finished: FinishedMesh,
    /// The name of the document.
    pub name: String,
    /// The mesh as files have it.
    extract: OnceLock<Extract<'static>>,
    nodes: OnceLock<Vec<f64>>,
    triangles: OnceLock<Vec<u32>>,
    levels: OnceLock<Vec<u8>>,
    neighbours: OnceLock<Vec<i64>>,
    targets: OnceLock<Vec<f64>>,
    details: OnceLock<Result<MeshDetails, String>>,
    locator: OnceLock<Option<PatchedLocator>>,
}

impl Shared {
    pub fn new(finished: FinishedMesh, name: String) -> Arc<Self> {
        Arc::new(Self {
            finished,
            name,
            extract: OnceLock::new(),
            nodes: OnceLock::new(),
            triangles: OnceLock::new(),
            levels: OnceLock::new(),
            neighbours: OnceLock::new(),
            targets: OnceLock::new(),
            details: OnceLock::new(),
            locator: OnceLock::new(),
        })
    }

    /// Calls `read` with the mesh as files have it.
    pub fn with_extract<T>(&self, read: impl FnOnce(&Extract<'_>) -> T) -> T {
        read(self.extract.get_or_init(|| self.finished.extract()))
    }

    pub fn counts(&self) -> [usize; 2] {
        self.with_extract(|extract| [extract.nodes().len(), extract.triangles().len()])
    }

    fn nodes(&self) -> &[f64] {
        let coordinates =
            |extract: &Extract<'_>| extract.world_nodes().flat_map(|node| [node.x, node.y]).collect();
        self.nodes.get_or_init(|| self.with_extract(coordinates))
    }

    fn triangles(&self) -> &[u32] {
        let corners = |extract: &Extract<'_>| {
            extract.cells().flat_map(|cell| cell.corners.map(|node| node as u32)).collect()
        };
        self.triangles.get_or_init(|| self.with_extract(corners))
    }

    fn levels(&self) -> &[u8] {
        let levels = |extract: &Extract<'_>| extract.cells().map(|cell| cell.level as u8).collect();
        self.levels.get_or_init(|| self.with_extract(levels))
    }

    fn neighbours(&self) -> &[i64] {
        let number = |opposite: Option<usize>| opposite.map_or(-1, |triangle| triangle as i64);
        let neighbours =
            |extract: &Extract<'_>| extract.cells().flat_map(|cell| cell.opposite.map(number)).collect();
        self.neighbours.get_or_init(|| self.with_extract(neighbours))
    }

    fn targets(&self, meter: &Meter) -> Result<&[f64], Cancelled> {
        if let Some(targets) = self.targets.get() {
            return Ok(targets);
        }
        let targets = self.with_extract(|extract| self.finished.target_at_nodes(extract, meter))?;
        Ok(self.targets.get_or_init(|| targets))
    }

    /// Returns what finds points in changed triangles, if some are changed.
    pub fn patched_locator(&self) -> Option<&PatchedLocator> {
        let patch = self.finished.derived.patch();
        let locator = self.locator.get_or_init(|| {
            let new = |extract: &Extract<'_>| PatchedLocator::new(self.finished.mesh(), patch, extract);
            (!patch.is_empty()).then(|| self.with_extract(new))
        });
        locator.as_ref()
    }

    /// Returns the boundary in named pieces and the rest that statistics and files have.
    pub fn details(&self) -> Result<&MeshDetails, &str> {
        let details = self.details.get_or_init(|| {
            let source = MeshSource::Document(&self.name);
            let coordinates = self.finished.coordinates().into();
            let provenance = provenance_from(&self.finished, source, None, coordinates);
            let uses = DetailUses { json: true, node_data: true, ..DetailUses::default() };
            let details = self.with_extract(|extract| {
                MeshDetails::with_provenance(&self.finished, extract, provenance, uses)
            });
            details.map_err(|error| error.to_string())
        });
        details.as_ref().map_err(String::as_str)
    }
}

/// Computes something of a mesh once.
fn computed<T: Send + 'static>(
    mesh: &Bound<'_, Mesh>,
    compute: impl FnOnce(&Shared) -> T + Send + 'static,
) -> PyResult<T> {
    let shared = mesh.get().0.clone();
    run(mesh.py(), &Watching::QUIET, move |_| compute(&shared))
}

#[pymethods]
impl Mesh {
    /// The numbers of nodes and triangles.
    #[getter]
    pub fn counts(&self) -> [usize; 2] {
        self.0.counts()
    }

    #[getter]
    fn nodes<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        computed(slf, |mesh| mesh.nodes().len())?;
        lent(slf.clone().into_any(), &rows(slf.get().0.nodes(), 2))
    }

    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        computed(slf, |mesh| mesh.triangles().len())?;
        lent(slf.clone().into_any(), &rows(slf.get().0.triangles(), 3))
    }

    #[getter]
    fn levels<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<u8>>> {
        computed(slf, |mesh| mesh.levels().len())?;
        lent(slf.clone().into_any(), &ArrayView1::from(slf.get().0.levels()))
    }

    #[getter]
    fn neighbours<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        computed(slf, |mesh| mesh.neighbours().len())?;
        lent(slf.clone().into_any(), &rows(slf.get().0.neighbours(), 3))
    }

    /// h̄ at each node.
    #[getter]
    fn h<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let py = slf.py();
        let shared = slf.get().0.clone();
        let computed = run(py, &Watching::QUIET, move |watch| shared.targets(&watch.meter).map(|_| ()))?;
        computed.map_err(|_| PyKeyboardInterrupt::new_err(()))?;
        let targets = slf.get().0.targets.get().expect("they were computed");
        lent(slf.clone().into_any(), &ArrayView1::from(&**targets))
    }

    /// The edges of each piece of the boundary, with the domain on their left, in the order of markers.
    #[getter]
    fn boundary<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let pieces = computed(slf, |mesh| {
            let details = mesh.details().map_err(str::to_owned)?;
            let boundary = &details.boundary;
            let mut edges = vec![Vec::new(); boundary.pieces().list().len()];
            mesh.with_extract(|extract| {
                for (edge, &piece) in extract.boundary_edges().zip(boundary.piece_of_edge()) {
                    edges[piece as usize].extend(edge.ends.map(|node| node as u32));
                }
            });
            let name = |piece: usize| boundary.pieces().list()[piece].name.clone();
            Ok::<_, String>(
                boundary
                    .present()
                    .map(|piece| (name(piece), std::mem::take(&mut edges[piece])))
                    .collect::<Vec<_>>(),
            )
        })?;
        let all = PyDict::new(slf.py());
        for (name, edges) in pieces.map_err(mesh_error)? {
            let edges = rows(&edges, 2).to_pyarray(slf.py());
            edges.call_method1("setflags", (false,))?;
            all.set_item(name, edges)?;
        }
        Ok(all)
    }

    /// For each line with edges in the mesh, the nodes of each part of it that is on edges without a gap,
    /// along the line. Lines with one name have their parts in one list.
    #[getter]
    fn lines<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let found = computed(slf, |mesh| {
            let lines = &mesh.details().map_err(str::to_owned)?.lines;
            Ok::<_, String>(lines.iter().map(|line| (line.name.clone(), line.runs())).collect::<Vec<_>>())
        })?;
        let all = PyDict::new(slf.py());
        for (name, runs) in found.map_err(mesh_error)? {
            let parts = match all.get_item(&name)? {
                Some(parts) => parts.cast_into::<PyList>()?,
                None => PyList::empty(slf.py()),
            };
            for run in runs {
                let nodes: Vec<u32> = run.into_iter().map(|node| node as u32).collect();
                let nodes = nodes.into_pyarray(slf.py());
                nodes.call_method1("setflags", (false,))?;
                parts.append(nodes)?;
            }
            all.set_item(name, parts)?;
        }
        Ok(all)
    }

    /// The marker of each piece of the boundary in files.
    #[getter]
    fn markers<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let found = computed(slf, |mesh| {
            let boundary = &mesh.details().map_err(str::to_owned)?.boundary;
            let marker = |piece: usize| (boundary.pieces().list()[piece].name.clone(), piece + 1);
            Ok::<_, String>(boundary.present().map(marker).collect::<Vec<_>>())
        })?;
        let all = PyDict::new(slf.py());
        for (name, marker) in found.map_err(mesh_error)? {
            all.set_item(name, marker)?;
        }
        Ok(all)
    }

    /// Sentences about what the mesh does not keep.
    fn notes(&self) -> Vec<String> {
        self.0.finished.notes().collect()
    }

    #[getter]
    fn fingerprint(&self) -> String {
        self.0.finished.mesh().fingerprint().to_string()
    }

    /// The nodes in other coordinates than those of the plane of the mesh.
    fn nodes_in<'py>(slf: &Bound<'py, Self>, crs: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let coordinates = crs.parse::<Coordinates>().map_err(|error| mesh_error(format!("crs: {error}")))?;
        let nodes = computed(slf, move |mesh| {
            mesh.with_extract(|extract| mesh.finished.domain().nodes_in(&coordinates, extract))
        })?;
        Ok(array_of(slf.py(), nodes.ok_or_else(|| mesh_error(NO_PLANE))?.into_iter()))
    }

    /// The text of `meshbrush mesh --json`.
    fn summary(slf: &Bound<'_, Self>) -> PyResult<String> {
        let text = computed(slf, |mesh| {
            let details = mesh.details().map_err(str::to_owned)?;
            let summary =
                mesh.with_extract(|extract| Summary::of(&mesh.finished, extract, Some(details), None));
            serde_json::to_string(&summary).map_err(|error| error.to_string())
        })?;
        text.map_err(mesh_error)
    }

    /// Triangles and errors of the smallest meshes, and of uniform ones.
    #[pyo3(signature = (most, watching))]
    fn error_curve<'py>(
        slf: &Bound<'py, Self>,
        most: usize,
        watching: Watching,
    ) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        let shared = slf.get().0.clone();
        let Some(norm) = shared.finished.spec().surface_norm() else {
            return Err(mesh_error("An error curve needs a surface: add a layer with `layers.surface`."));
        };
        let traced = run(slf.py(), &watching, move |watch| {
            shared.finished.error_curves(norm, most, |triangles| {
                watch.tell("tracing the error", triangles as u64);
                !watch.is_cancelled()
            })
        })?;
        let curves = traced.map_err(mesh_error)?.ok_or_else(|| mesh_error("The work was cancelled."))?;
        let array = |points: &[CurvePoint]| {
            let rows = points.iter().flat_map(|point| [point.triangles as f64, point.error]);
            let rows: Vec<f64> = rows.collect();
            let array = rows.into_pyarray(slf.py()).call_method1("reshape", (points.len(), 2))?;
            Ok::<_, PyErr>(array.cast_into::<PyArray2<f64>>()?)
        };
        Ok([array(&curves.least)?, array(&curves.uniform)?])
    }

    /// The number of rules that the mesh breaks.
    fn violations(slf: &Bound<'_, Self>) -> PyResult<usize> {
        computed(slf, |mesh| {
            let derived = mesh.with_extract(|extract| mesh.finished.derived.violations(extract).len());
            mesh.finished.mesh().violations().len() + derived
        })
    }

    /// Writes files, and returns their names, and notes: on quantities, and where a coastal solver finds no
    /// open boundary.
    #[pyo3(signature = (output, format, crs, values, watching))]
    fn write(
        slf: &Bound<'_, Self>,
        output: &Bound<'_, PyDict>,
        format: Option<String>,
        crs: Option<&str>,
        values: Vec<(String, PyReadonlyArray1<'_, f64>)>,
        watching: Watching,
    ) -> PyResult<(Vec<PathBuf>, Vec<String>)> {
        let shared = slf.get().0.clone();
        let table = text_value(output)?;
        let requested = SavedOutput::of_value(&table)
            .and_then(|saved| RequestedFiles::of_keys(&saved, format.as_deref()))
            .map_err(|fault| fault_in(&table, &fault))?;
        let coordinates = match crs {
            Some(text) => text.parse().map_err(|error| mesh_error(format!("crs: {error}")))?,
            None => OutputCoordinates::from(shared.finished.coordinates()),
        };
        if crs.is_some_and(|text| text != "plane") && shared.finished.domain().projection.is_none() {
            return Err(mesh_error(NO_PLANE));
        }
        let values = values_at_nodes(values, shared.counts()[0])?;
        let written = run(slf.py(), &watching, move |watch| {
            watch.tell("writing", 0);
            let details = shared.details().map_err(|problem| Failure::Work(problem.to_owned()))?;
            let source = MeshSource::Document(&shared.name);
            let provenance = provenance_from(&shared.finished, source, None, coordinates);
            let target_diameter = match requested.outputs.iter().any(Output::has_targets) {
                true => shared.targets(&watch.meter).map_err(|error| Failure::Work(error.to_string()))?,
                false => &[],
            };
            shared.with_extract(|extract| {
                let (finished, provenance) = (&shared.finished, &provenance);
                let exported =
                    ExportedMesh { finished, extract, details, provenance, coordinates, target_diameter };
                let mut notes = Vec::new();
                let files = requested.write(&exported, values, &mut notes, &watch.meter)?;
                notes.extend(requested.closed_note(details));
                Ok((files, notes))
            })
        })?;
        written.map_err(|failure| match failure {
            Failure::Write { .. } => file_error(failure),
            failure => mesh_error(failure),
        })
    }

    /// A picture of the mesh: rows, columns, and red, green, blue and alpha.
    fn picture<'py>(
        slf: &Bound<'py, Self>,
        output: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let shared = slf.get().0.clone();
        let look = look_of(output)?;
        let picture = run(slf.py(), &Watching::QUIET, move |_| {
            shared.with_extract(|extract| look.picture_of(&shared.finished, extract))
        })?
        .map_err(mesh_error)?;
        let [width, height] = picture.size.map(|side| side as usize);
        let pixels = picture.rgba.into_pyarray(slf.py());
        Ok(pixels.call_method1("reshape", (height, width, 4))?.cast_into()?)
    }

    /// The bytes of a PNG file with a picture of the mesh.
    fn png<'py>(slf: &Bound<'py, Self>, output: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyBytes>> {
        let shared = slf.get().0.clone();
        let look = look_of(output)?;
        let bytes = run(slf.py(), &Watching::QUIET, move |_| {
            let picture = shared.with_extract(|extract| look.picture_of(&shared.finished, extract));
            picture.map(|picture| {
                let mut bytes = Vec::new();
                meshbrush_io::io::png::write(&mut bytes, picture.size, &picture.rgba).map(|()| bytes)
            })
        })?;
        let bytes = bytes.map_err(mesh_error)?;
        Ok(PyBytes::new(slf.py(), &bytes.map_err(file_error)?))
    }
}

fn rows<T>(values: &[T], columns: usize) -> ArrayView2<'_, T> {
    ArrayView2::from_shape((values.len() / columns, columns), values).expect("rows are complete")
}

fn look_of(output: &Bound<'_, PyDict>) -> PyResult<RequestedFiles> {
    let table = text_value(output)?;
    let look = SavedOutput::of_value(&table).and_then(|saved| RequestedFiles::of_keys(&saved, None));
    look.map_err(|fault| fault_in(&table, &fault))
}

/// Checks values at the nodes: their number and their names.
pub fn values_at_nodes(
    values: Vec<(String, PyReadonlyArray1<'_, f64>)>,
    nodes: usize,
) -> PyResult<Vec<NodeValues>> {
    let checked = |(name, values): (String, PyReadonlyArray1<'_, f64>)| {
        let values = values.as_array().to_vec();
        if values.len() != nodes {
            let count = values.len();
            return Err(mesh_error(format!(
                "The values “{name}” are {count}, and the mesh has {nodes} nodes."
            )));
        }
        if let Some(node) = values.iter().position(|value| !value.is_finite()) {
            let value = values[node];
            return Err(mesh_error(format!(
                "The value “{name}” is {value} at node {node}: files need a finite number at every node."
            )));
        }
        Ok(NodeValues { name, values })
    };
    values.into_iter().map(checked).collect()
}
