//! Why a triangle is in a mesh.

use glam::DVec2;
use meshbrush_cli::cli::why::{answer_as_json, nowhere, sentences};
use pyo3::prelude::*;

use crate::errors::mesh_error;
use crate::mesh::Mesh;
use crate::work::{Watching, run};

#[pymethods]
impl Mesh {
    /// Says why the triangle at a point is in the mesh: in sentences, and as the text of
    /// `meshbrush why --json`.
    fn why(slf: &Bound<'_, Self>, point: [f64; 2]) -> PyResult<(String, String)> {
        let shared = slf.get().0.clone();
        let answer = run(slf.py(), &Watching::QUIET, move |_| {
            let (finished, mesh) = (&shared.finished, shared.finished.mesh());
            let location = mesh.locate(DVec2::from(point));
            let typed = format!("{}, {}", point[0], point[1]);
            let id = location.triangle().ok_or_else(|| nowhere(&typed, &location, mesh).to_string())?;
            let explanation = finished.explanation(id);
            Ok::<_, String>((
                sentences(finished, id, &explanation),
                answer_as_json(finished, id, &explanation),
            ))
        })?;
        answer.map_err(mesh_error)
    }
}
