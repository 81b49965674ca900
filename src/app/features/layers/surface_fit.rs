//! How far the mesh is from the surfaces of its layers, measured on another thread.

use std::sync::Arc;

use meshbrush_core::surface::SurfaceFit;
use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::jobs::{Jobs, Slot, Wanted};
use meshbrush_kit::kit::session::Session;

/// Measures how far meshes are from surfaces, and keeps the figures of the last one.
#[derive(Default)]
pub struct MeasuredFit(Slot<MeasuredMesh, SurfaceFit>);

impl MeasuredFit {
    /// Returns the last figures, and whether they are those of the mesh as it is.
    pub fn figures(&self, session: &Session) -> Option<(&SurfaceFit, bool)> {
        let now = MeasuredMesh::now(session.follower(), session.derivation());
        self.0.last().map(|(key, fit)| (fit, *key == now))
    }

    /// Returns whether the mesh is settled and was not measured yet.
    pub fn is_due(&self, session: &Session) -> bool {
        let (follower, derivation) = (session.follower(), session.derivation());
        let is_known = self.0.is_running() || self.0.has(&MeasuredMesh::now(follower, derivation));
        let is_settled = || MeasuredMesh::is_settled(session.document(), follower, derivation);
        follower.surface().is_some() && !is_known && is_settled()
    }

    /// Measures the mesh, where that is due.
    pub fn measure(&mut self, session: &Session, jobs: &Jobs) {
        let follower = session.follower();
        let Some(rule) = follower.surface().filter(|_| self.is_due(session)).cloned() else { return };
        let extract = session.derived().map(|derived| derived.shared_extract());
        let mesh = follower.shared_mesh();
        let measure = move |wanted: &Wanted| {
            let extract = extract.unwrap_or_else(|| Arc::new(mesh.extract().into_owned()));
            wanted.goes_on().then(|| rule.samples().fit(extract.view()))
        };
        self.0.start_wanted(MeasuredMesh::now(follower, session.derivation()), measure, jobs);
    }

    /// Takes what was measured. Returns whether a mesh is being measured.
    pub fn follow(&mut self, session: &Session, jobs: &Jobs) -> bool {
        let (follower, derivation) = (session.follower(), session.derivation());
        if MeasuredMesh::is_settled(session.document(), follower, derivation) {
            self.0.want(&MeasuredMesh::now(follower, derivation), jobs);
        }
        self.0.take(jobs)
    }
}
