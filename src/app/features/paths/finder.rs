//! The paths of the document: found on another thread while the document changes, and then certified.
//!
//! ```text
//!   edit ─→ PathFinder ─→ thread: Planner      live paths while a gesture goes on
//!                            │
//!                            ▼ mesh complete
//!                         thread: Planner      the mesh as it is; paths with both bounds
//!                            │
//!                            ▼
//!           Prover      ─→ thread: Certificate the lower bound rises until the width is reached
//!           ShownCorridor, AlternativesFinder, FrontFinder: other paths, while they are shown
//! ```

use std::sync::Arc;

use super::alternatives::AlternativesFinder;
use super::corridor::ShownCorridor;
use super::front::FrontFinder;
use super::prover::{FoundPaths, Prover};
use super::work::{
    FinishedWork, FoundPath, KnownPlanner, PathWork, PlannedMesh, PlannerSource, ShownPath, WorkResult,
    find_corridor,
};
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::PathError;
use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::document_id::DocumentId;
use meshbrush_kit::kit::jobs::{Jobs, Slice, Slot};
use meshbrush_kit::kit::session::Session;

/// A mesh of one of the documents that were opened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshKey {
    document_id: DocumentId,
    mesh: MeasuredMesh,
}

/// The data from which paths were computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathsKey {
    document: u64,
    pub mesh: MeshKey,
    /// Whether the document is being changed.
    is_live: bool,
}

/// Finds the paths of the document, and keeps the last ones.
#[derive(Default)]
pub struct PathFinder {
    work: Slot<PathsKey, Option<FinishedWork>>,
    /// A planner, and the mesh that it knows.
    planner: Option<(KnownPlanner, MeshKey)>,
    key: Option<PathsKey>,
    shown: Vec<ShownPath>,
    /// Whether it was said that a proof exchanged the path.
    told: Vec<bool>,
    /// The data with which the shown paths were found.
    basis: Option<FoundPaths>,
    prover: Prover,
    /// The corridor of nearly best paths.
    pub corridor: ShownCorridor,
    /// The next best paths that differ from the one that is shown.
    pub alternatives: AlternativesFinder,
    /// The front of length against risk.
    pub front: FrontFinder,
}

impl PathFinder {
    /// Returns the results for each route of the document, in order.
    pub fn shown(&self) -> &[ShownPath] {
        &self.shown
    }

    /// Returns the requested width of the interval, as a share of the cost.
    pub fn width(&self) -> f64 {
        self.prover.width
    }

    /// Sets the requested width.
    pub fn set_width(&mut self, width: f64) {
        self.prover.width = width;
        // The bounds that are known stay; certificates begin again.
        self.prover.restart();
    }

    /// Returns whether the lower bounds are still rising.
    pub fn is_proving(&self) -> bool {
        self.prover.is_running()
    }

    /// Returns whether the paths are those of the document as it is.
    pub fn is_current(&self, session: &Session) -> bool {
        self.key.as_ref().is_some_and(|key| key.document == session.document().revision() && !key.is_live)
    }

    /// Returns the number of a path that a proof has exchanged for a better one since the last call, with the
    /// share by which the former costs more.
    pub fn take_exchanged(&mut self) -> Option<(usize, f64)> {
        let excess = |shown: &ShownPath| shown.found.as_ref().and_then(FoundPath::former_excess);
        self.told.resize(self.shown.len(), false);
        let number = (0..self.shown.len()).find(|&n| !self.told[n] && excess(&self.shown[n]).is_some())?;
        self.told[number] = true;
        Some((number, excess(&self.shown[number])?))
    }

    /// Makes a path the one that was shown before a proof.
    #[cfg(test)]
    pub fn set_former(&mut self, number: usize, former: meshbrush_core::path::Solution) {
        let found = self.shown[number].found.as_mut().expect("a complete path");
        found.former = Some(Box::new(former));
    }

    /// Returns how often the planner went over to another mesh since it was made.
    #[cfg(test)]
    pub fn moves(&self) -> Option<usize> {
        self.planner.as_ref().map(|(known, _)| known.moves)
    }

    /// Takes what was found, waiting as long as the frame may, and begins what is to be found next. The
    /// jobs wake the window: no frame needs to wait for them. Alternatives and the front are those of
    /// `route`.
    pub fn advance(&mut self, session: &Session, route: Option<usize>, jobs: &Jobs) {
        if self.work.is_running() {
            if self.work.take(jobs) {
                return;
            }
            self.take_work();
        }
        let Some(route) = route else { return self.forget() };
        let Some(key) = self.wanted(session) else { return };
        if self.key.as_ref() != Some(&key) {
            self.prover.cancel();
            self.alternatives.pause();
            self.front.pause();
            self.start(key, session, jobs);
            return;
        }
        if key.is_live {
            return;
        }
        if self.corridor.is_due(key) {
            self.start_corridor(key, session, jobs);
        }
        self.find_others(session, (key, route), jobs);
        self.prove(session, jobs);
    }

    /// Forgets all paths: the document has none.
    fn forget(&mut self) {
        let former = std::mem::take(self);
        self.prover.width = former.prover.width;
        (self.corridor.is_on, self.corridor.share) = (former.corridor.is_on, former.corridor.share);
        self.alternatives.is_on = former.alternatives.is_on;
        self.front.is_on = former.front.is_on;
    }

    /// Returns the data to compute paths from; `None` while the first mesh is not complete.
    fn wanted(&self, session: &Session) -> Option<PathsKey> {
        let (document, follower) = (session.document(), session.follower());
        let derivation = session.derivation();
        let is_settled =
            follower.is_in_step(document) && MeasuredMesh::is_settled(document, follower, derivation);
        let document_id = session.document_id();
        let mesh = match is_settled {
            true => MeshKey { document_id, mesh: MeasuredMesh::now(follower, derivation) },
            // Other regions need another planner.
            false => {
                let plan = &document.settings().paths;
                self.planner.as_ref().filter(|(known, _)| known.has_area_of(plan))?.1
            }
        };
        let is_of_document = mesh.document_id == document_id;
        is_of_document.then_some(PathsKey { document: document.revision(), mesh, is_live: !is_settled })
    }

    fn start(&mut self, key: PathsKey, session: &Session, jobs: &Jobs) {
        let document = session.document();
        let (settings, paint) = (document.settings(), document.paint());
        let risk = RiskField::new(&settings.layers, paint).within(&settings.domain.bounds);
        let (plan, is_live) = (document.settings().paths.clone(), key.is_live);
        let planner = self.planner.take();
        let is_of_document = |mesh: &MeshKey| mesh.document_id == key.mesh.document_id;
        let planner = planner.filter(|(known, mesh)| is_of_document(mesh) && known.has_area_of(&plan));
        let knows_mesh = planner.as_ref().is_some_and(|(_, mesh)| *mesh == key.mesh);
        let mesh = (!knows_mesh).then(|| match session.derived() {
            Some(derived) => PlannedMesh::Extract(derived.shared_extract()),
            None => PlannedMesh::Mesh(session.follower().shared_mesh()),
        });
        let source = PlannerSource { known: planner.map(|(known, _)| Box::new(known)), mesh };
        let place = (settings.domain.clone(), settings.boundary, settings.unit);
        let begin = move || Some(PathWork::new(source, (plan, risk), place, is_live));
        let find = |work: &mut Option<PathWork>| work.as_mut().map_or(Slice::Found(None), PathWork::advance);
        self.work.start_in_slices(key, begin, find, jobs);
    }

    /// Finds the corridor with the planner of the paths.
    fn start_corridor(&mut self, key: PathsKey, session: &Session, jobs: &Jobs) {
        let share = self.corridor.share;
        self.corridor.of = Some((key, share));
        let Some((planner, _)) = self.planner.take() else { return self.corridor.lines = Arc::default() };
        let plan = session.document().settings().paths.clone();
        self.work.start(key, move || Some(find_corridor(planner, &plan.routes, share)), jobs);
    }

    /// Takes the work that has ended.
    fn take_work(&mut self) {
        let Some((key, work)) = self.work.take_last() else { return };
        let Some(work) = work else {
            // The settings are checked: weights that make no cost are refused there.
            self.key = Some(key);
            return;
        };
        let mesh = work.planner.as_ref().map(|known| Arc::clone(known.planner.mesh()));
        self.planner = work.planner.map(|planner| (planner, key.mesh));
        match work.result {
            WorkResult::Corridor(lines) => self.corridor.lines = lines.into(),
            WorkResult::Paths { density, routes } => {
                self.take_paths(routes);
                self.basis = mesh.zip(density).map(|(mesh, density)| FoundPaths { density, mesh });
                self.prover.begin(self.basis.clone());
                self.key = Some(key);
            }
        }
    }

    fn take_paths(&mut self, routes: Vec<Result<FoundPath, PathError>>) {
        self.shown.resize_with(routes.len(), ShownPath::default);
        self.told.clear();
        for (shown, found) in self.shown.iter_mut().zip(routes) {
            match found {
                Ok(found) => *shown = ShownPath { found: Some(found), problem: None },
                Err(problem) => shown.problem = Some(problem),
            }
        }
    }

    /// Looks for the front and the alternatives of a complete path.
    fn find_others(&mut self, session: &Session, of: (PathsKey, usize), jobs: &Jobs) {
        let Some(basis) = &self.basis else { return self.alternatives.clear() };
        self.front.advance(session, of, &basis.mesh, jobs);
        let shown = self.shown.get(of.1).filter(|shown| shown.problem.is_none());
        match shown.and_then(|shown| shown.found.as_ref()) {
            Some(found) => {
                let places = &session.document().settings().paths.routes[of.1];
                self.alternatives.advance(of, (&found.solution, places), basis, jobs);
            }
            None => self.alternatives.clear(),
        }
    }

    /// Raises the lower bounds of complete paths.
    fn prove(&mut self, session: &Session, jobs: &Jobs) {
        let found = self.shown.iter_mut().filter(|shown| shown.problem.is_none());
        let found = found.filter_map(|shown| shown.found.as_mut()).collect();
        self.prover.advance(found, &session.document().settings().domain, jobs);
    }
}
