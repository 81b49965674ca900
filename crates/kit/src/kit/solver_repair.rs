//! Layers with which the mesh of a document keeps the rules of a solver.

use super::jobs::Wanted;
use super::session::Session;
use meshbrush_core::build::{BuildError, BuiltMesh, MeshBuilder, MeshSpec};
use meshbrush_core::document::Settings;
use meshbrush_core::field::RefinementRule;
use meshbrush_core::layers::PaintLayers;
use meshbrush_io::io::solver_rules::{Repaired, Solver, repaired};
use meshbrush_mesh::mesh::Progress;

/// Triangles visited between two questions whether the layers are still wanted.
const SLICE: usize = 1 << 16;

/// A document whose mesh is to keep the rules of a solver.
pub struct SolverRepair {
    settings: Settings,
    paint: PaintLayers,
    solver: Solver,
}

/// Why there are no layers.
enum NoLayers {
    Impossible(BuildError),
    Unwanted,
}

impl From<BuildError> for NoLayers {
    fn from(error: BuildError) -> Self {
        Self::Impossible(error)
    }
}

impl SolverRepair {
    /// Takes the document as it is; `None` where no layer can ask for one triangle to be bisected, by the
    /// vertex rule.
    pub fn of(session: &Session, solver: Solver) -> Option<Self> {
        let document = session.document();
        let settings = document.settings().clone();
        let is_by_area = settings.rule == RefinementRule::Area;
        is_by_area.then(|| Self { settings, paint: document.paint().clone(), solver })
    }

    /// Makes meshes until one keeps the rules as far as smaller triangles help; `None` once its layers are no
    /// longer wanted.
    ///
    /// # Errors
    /// Fails with a sentence when a mesh with the layers cannot be made.
    pub fn run(self, wanted: &Wanted) -> Option<Result<Repaired, String>> {
        let spec = match self.settings.mesh_spec() {
            Ok(spec) => spec,
            Err(error) => return Some(Err(error.to_string())),
        };
        let make = |spec| self.make(spec, wanted);
        match repaired(self.solver, &spec, &self.settings.boundary_marks, (1.0, &self.paint), make) {
            Ok(repaired) => Some(Ok(repaired)),
            Err(NoLayers::Impossible(error)) => Some(Err(error.to_string())),
            Err(NoLayers::Unwanted) => None,
        }
    }

    fn make(&self, spec: MeshSpec, wanted: &Wanted) -> Result<BuiltMesh, NoLayers> {
        let mut builder = MeshBuilder::new(spec);
        while builder.advance(Some(&self.paint), SLICE)? == Progress::More {
            if !wanted.goes_on() {
                return Err(NoLayers::Unwanted);
            }
        }
        Ok(builder.finish())
    }
}
