//! The figures of the mesh, which are computed on another thread: a large mesh takes longer than a frame.

use std::sync::Arc;

use super::derivation::Derivation;
use super::jobs::{Jobs, Slot};
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::document::{Document, Follower};
use meshbrush_mesh::mesh::{MeshStatistics, TriangleId};

/// The figures of a mesh as files get it.
pub struct Measured {
    /// Edges, areas, angles and gradation; `None` without triangles.
    pub statistics: Option<MeshStatistics>,
    /// Area in square world units.
    pub area: f64,
    /// Nodes.
    pub nodes: usize,
    /// Triangles of each connected part, the part with the largest area first.
    pub part_sizes: Vec<usize>,
    /// The fingerprint of the mesh that was refined, as the command line prints it.
    pub fingerprint: String,
    /// The triangles of that mesh which exceed their target, or `None` where h̄ cannot be evaluated.
    pub too_coarse: Option<Vec<TriangleId>>,
}

/// Which mesh was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredMesh {
    follower: u64,
    derived: u64,
}

/// Measures meshes, and keeps the figures of the last one.
#[derive(Default)]
pub struct Statistician(Slot<MeasuredMesh, Measured>);

impl Statistician {
    /// The last figures, and whether they are those of the mesh as it is.
    pub fn figures(&self, follower: &Follower, derivation: &Derivation) -> Option<(&Measured, bool)> {
        let now = MeasuredMesh::now(follower, derivation);
        self.0.last().map(|(key, measured)| (measured, *key == now))
    }

    /// Takes figures that are ready, waiting for them as long as the frame may. Returns whether a mesh is
    /// being measured.
    pub fn take(&mut self, jobs: &Jobs) -> bool {
        self.0.take(jobs)
    }

    /// Whether the mesh is settled and was not measured yet.
    pub fn is_due(&self, document: &Document, follower: &Follower, derivation: &Derivation) -> bool {
        let is_known = self.0.is_running() || self.0.has(&MeasuredMesh::now(follower, derivation));
        !is_known && MeasuredMesh::is_settled(document, follower, derivation)
    }

    /// Measures the mesh, where that is due.
    pub fn measure(
        &mut self,
        document: &Document,
        follower: &Follower,
        derivation: &Derivation,
        jobs: &Jobs,
    ) {
        if !self.is_due(document, follower, derivation) {
            return;
        }
        let extract = derivation.current(follower).map(|derived| derived.shared_extract());
        let (mesh, domain, field) =
            (follower.shared_mesh(), follower.domain().clone(), follower.field().clone());
        let (rule, paint) = (follower.settings().rule, document.paint().clone());
        let measure = move || {
            let mut criterion = RefinementCriterion::new(&domain, &field, rule, Some(&paint));
            let extract = extract.unwrap_or_else(|| Arc::new(mesh.extract().into_owned()));
            Measured {
                statistics: extract.statistics(),
                area: extract.area(),
                nodes: extract.nodes().len(),
                part_sizes: extract.part_sizes(),
                fingerprint: mesh.fingerprint().to_string(),
                too_coarse: mesh.unsatisfied(|element| criterion.exceeds(element)).ok(),
            }
        };
        self.0.start(MeasuredMesh::now(follower, derivation), measure, jobs);
    }
}

impl MeasuredMesh {
    /// Whether the mesh is as the document asks for, and derived where it has to be.
    pub fn is_settled(document: &Document, follower: &Follower, derivation: &Derivation) -> bool {
        let is_fitted = follower.settings().domain.region().is_some();
        let is_derived = !is_fitted || derivation.current(follower).is_some();
        follower.stage().is_settled() && !document.is_in_gesture() && is_derived
    }

    /// The mesh as it is.
    pub fn now(follower: &Follower, derivation: &Derivation) -> Self {
        Self { follower: follower.revision(), derived: derivation.pieces_revision() }
    }
}
