//! The mesh follows a document in place.

use std::sync::Mutex;
use std::time::Instant;

use meshbrush_core::document::{Follower, MeshChange, Stage};
use pyo3::prelude::*;

use crate::document::{Document, State, ToMake, lock, sentence};
use crate::errors::mesh_error;
use crate::work::{Watch, Watching, run};

/// Triangles or pixels of a slice of work: few, because the document waits for each.
const SLICE: usize = 1 << 12;

/// What became of the mesh of a document.
#[pyclass(frozen, get_all, module = "meshbrush._core")]
pub struct Change {
    /// Triangles before.
    before: usize,
    /// Triangles now.
    triangles: usize,
    /// Whether another mesh was made in place of the former one.
    replaced: bool,
    /// The time that it took, in seconds.
    seconds: f64,
}

#[pymethods]
impl Document {
    /// Brings the mesh up to date with the document where it is.
    fn update(&self, py: Python<'_>, watching: Watching) -> PyResult<Change> {
        let (state, follower) = (self.state.clone(), self.follower.clone());
        let updated = run(py, &watching, move |watch| {
            let begun = Instant::now();
            let mut held = lock(&follower);
            let (first, mut follower) = match held.take() {
                Some(follower) => (false, follower),
                None => new_follower(&state, watch)?,
            };
            let before = follower.mesh().triangle_count();
            follower.take_change();
            // After an error, another mesh is made: this one has given up until the document changes.
            follow(&state, &mut follower, watch)?;
            let replaced = first || follower.take_change() == Some(MeshChange::Replaced);
            let triangles = follower.mesh().triangle_count();
            *held = Some(follower);
            Ok::<_, String>(Change { before, triangles, replaced, seconds: begun.elapsed().as_secs_f64() })
        })?;
        updated.map_err(mesh_error)
    }
}

#[pymethods]
impl Change {
    fn __repr__(&self) -> String {
        let how = if self.replaced { "made again" } else { "updated in place" };
        let Self { before, triangles, seconds, .. } = self;
        format!("<meshbrush.Change: {before} to {triangles} triangles, {how} in {seconds:.3} s>")
    }
}

/// Returns what follows the last mesh of the document, or one that is made now, and whether it is.
fn new_follower(state: &Mutex<State>, watch: &Watch) -> Result<(bool, Follower), String> {
    let base = lock(state).base.take();
    let is_new = base.is_none();
    let (settings, mesh) = match base {
        Some(base) => base,
        None => {
            ToMake::of(state, false)?.made(state, watch)?;
            lock(state).base.take().ok_or("The document was changed by another thread; try again.")?
        }
    };
    Ok((is_new, Follower::from_built(settings, mesh.finished.built().clone())))
}

fn follow(state: &Mutex<State>, follower: &mut Follower, watch: &Watch) -> Result<(), String> {
    loop {
        let mut state = lock(state);
        let stage = follower.advance(&mut state.document, SLICE).map_err(|error| sentence(&error))?;
        match stage {
            Stage::InStep => return Ok(()),
            Stage::GaveUp(error) => {
                let error = error.map(|error| sentence(&error));
                return Err(error.unwrap_or_else(|| "The update was cancelled.".to_owned()));
            }
            Stage::Indexing => watch.tell("indexing the outline", 0),
            Stage::Checking => watch.tell("checking the layers", 0),
            Stage::Copying { triangles } => watch.tell("copying", triangles as u64),
            Stage::Refining { triangles } => watch.tell("refining", triangles as u64),
        }
        if watch.is_cancelled() {
            return Err("it was cancelled".to_owned());
        }
    }
}
