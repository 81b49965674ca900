//! The mesh as it leaves the program: derived from the mesh of the follower on another thread.
//!
//! ```text
//!  follower's mesh ──▶ derived mesh      shown, queried, counted while the two belong together
//!        │                  │
//!        │ updated          │ pieces in place of changed triangles: those of the coast, which is kept in step
//!        ▼                  ▼ (coast.rs); without it they are retired, and the mesh itself is drawn there
//!  follower's mesh ──▶ derived mesh
//! ```
//!
//! While a stroke is drawn, only small meshes are derived: deriving holds the mesh, and the follower would
//! have to copy a large one before it continues.

mod coast;
mod key;

use std::ops::Range;
use std::sync::Arc;

use glam::DVec2;

use coast::{Coast, RemovedTriangles};
pub use key::DerivationKey;

use super::jobs::{Job, JobKind, Jobs, Output, Succession, Taken};
use meshbrush_core::document::{Document, Follower, MeshChange};
use meshbrush_core::domain::{Domain, FitComparison, FitQuality, Region};
use meshbrush_core::layers::PaintLayers;
use meshbrush_core::outline::{DerivedFollower, DerivedMesh, LineFit, MeshDerivation, OutlineFit};
use meshbrush_mesh::mesh::{
    Changes, Extract, Location, MeshView, PatchPieces, PatchedLocator, Progress, Removed, Topology,
    TriangleId,
};

/// Most triangles of a mesh that is derived while a gesture goes on.
const MOST_IN_GESTURE: usize = 50_000;

/// The changes on the screen.
#[derive(Clone, Debug, Default)]
pub struct ShownChange {
    /// The change of the follower's mesh.
    pub mesh: Option<MeshChange>,
    /// The change of the pieces that are drawn in place of some triangles.
    pub pieces: Option<PiecesChange>,
}

/// A mesh as files have it. Ids are the numbers in files.
pub struct Derived {
    key: DerivationKey,
    /// Shared with the thread that compares it with the outline.
    extract: Arc<Extract<'static>>,
    locator: PatchedLocator,
    /// Triangles of each level.
    pub level_counts: Vec<usize>,
    /// Nodes, parts and holes.
    pub topology: Topology,
    /// The parts and pinches that cleaning removed.
    pub removed: Removed,
    /// How well the boundary lies on the outline, where nodes are moved there.
    pub outline_fit: Option<OutlineFit>,
    /// How well the mesh fits each line.
    pub line_fits: Vec<LineFit>,
    /// The comparison with the outline, once it is made.
    pub quality: Option<FitQuality>,
}

impl Derived {
    /// Returns the data that the derived mesh depends on.
    pub fn key(&self) -> &DerivationKey {
        &self.key
    }

    /// Returns the nodes and triangles.
    pub fn view(&self) -> MeshView<'_> {
        self.extract.view()
    }

    /// Returns the nodes and triangles, for work on another thread.
    pub fn shared_extract(&self) -> Arc<Extract<'static>> {
        self.extract.clone()
    }

    /// Finds a point, given where the mesh of the follower finds it.
    pub fn locate(&self, point: DVec2, in_mesh: Location) -> Location {
        self.locator.locate(&self.extract, point, in_mesh)
    }
}

/// How the pieces changed since they were last sent to the GPU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PiecesChange {
    /// They are others.
    Replaced,
    /// Those in place of these triangles were retired or replaced; the ranges are of
    /// [`PatchPieces::triangles`].
    Within(Vec<(TriangleId, Range<usize>)>),
}

/// Derives meshes, and keeps the last one.
#[derive(Default)]
pub struct Derivation {
    latest: Option<Derived>,
    pieces: PatchPieces,
    pieces_revision: u64,
    pieces_change: Option<PiecesChange>,
    coast: Coast,
    running: Option<RunningDerivation>,
    succession: Succession<DerivationKey>,
    /// The data for which no mesh could be derived: it is not tried again.
    failed: Option<DerivationKey>,
}

/// A mesh that is being derived.
struct RunningDerivation {
    key: DerivationKey,
    job: Job<DerivationResult>,
    /// The change of the follower's mesh since then.
    since: Option<MeshChange>,
    /// The triangles whose pieces the coast replaced since then.
    replaced: Vec<TriangleId>,
}

/// The values that the other thread sends, in this order.
enum DerivationResult {
    Derived(Box<Derived>, PatchPieces, RemovedTriangles),
    Coast(Box<DerivedFollower>),
    Quality(FitQuality),
}

impl Derivation {
    /// Returns the derived mesh, if it belongs to the follower's mesh as it is.
    pub fn current(&self, follower: &Follower) -> Option<&Derived> {
        self.latest.as_ref().filter(|derived| DerivationKey::of(follower).as_ref() == Some(&derived.key))
    }

    /// Returns the pieces that are drawn in place of triangles of the follower's mesh.
    pub fn pieces(&self) -> &PatchPieces {
        &self.pieces
    }

    /// Grows whenever [`Self::pieces`] change.
    pub fn pieces_revision(&self) -> u64 {
        self.pieces_revision
    }

    /// How the pieces changed since the last call.
    pub fn take_pieces_change(&mut self) -> Option<PiecesChange> {
        self.pieces_change.take()
    }

    /// Notes what became of the follower's mesh.
    pub fn note_change(&mut self, change: &MeshChange, follower: &Follower, paint: &PaintLayers) {
        let mesh = follower.mesh();
        match change {
            // Whoever draws begins another mesh without pieces.
            MeshChange::Replaced => {
                self.coast.forget();
                self.replace_pieces(PatchPieces::default());
            }
            MeshChange::Within(changes) => {
                let replaced = self.coast.follow(follower, paint, changes);
                let touched = match &replaced {
                    Some(ids) => self.pieces.replace(mesh, changes, self.coast.replacements(mesh, ids)),
                    None => self.pieces.retire(mesh, changes),
                };
                self.note_touched(touched);
                if let Some(running) = &mut self.running {
                    running.replaced.extend(replaced.into_iter().flatten());
                }
            }
        }
        if let Some(running) = &mut self.running {
            MeshChange::join(&mut running.since, change.clone(), mesh);
        }
    }

    fn note_touched(&mut self, touched: Vec<(TriangleId, Range<usize>)>) {
        if touched.is_empty() {
            return;
        }
        self.pieces_revision += 1;
        match &mut self.pieces_change {
            Some(PiecesChange::Replaced) => {}
            Some(PiecesChange::Within(earlier)) => earlier.extend(touched),
            None => self.pieces_change = Some(PiecesChange::Within(touched)),
        }
    }

    fn replace_pieces(&mut self, pieces: PatchPieces) {
        self.pieces = pieces;
        self.pieces_revision += 1;
        self.pieces_change = Some(PiecesChange::Replaced);
    }

    /// Returns whether the pieces are kept in step with the mesh.
    #[cfg(any(test, feature = "hooks"))]
    pub fn shows_coast(&self, follower: &Follower) -> bool {
        self.coast.is_of(follower)
    }

    /// [`Self::shows_coast`], and nothing was removed.
    #[cfg(any(test, feature = "hooks"))]
    pub fn shows_whole_coast(&self, follower: &Follower) -> bool {
        self.shows_coast(follower) && self.coast.is_whole()
    }

    /// Takes finished meshes, waiting for them as long as the frame may, and starts to derive the next one
    /// where that is due. Returns whether one is being derived. `paint` is that of the follower's mesh.
    pub fn advance(
        &mut self,
        follower: &Follower,
        paint: &PaintLayers,
        in_gesture: bool,
        jobs: &Jobs,
    ) -> bool {
        let is_small = follower.mesh().raw_triangle_count() <= MOST_IN_GESTURE;
        let may_start = follower.stage().is_settled() && (is_small || !in_gesture);
        loop {
            if let Some(running) = &self.running {
                if let Some(key) = DerivationKey::of(follower).filter(|_| may_start)
                    && self.succession.gives_way(&running.key, &key, jobs)
                {
                    running.job.cancel();
                }
                match running.job.take(jobs) {
                    Taken::Working => return true,
                    Taken::Ended => self.end(),
                    Taken::Value(outcome) => self.take(outcome, follower, paint),
                }
                continue;
            }
            match DerivationKey::of(follower) {
                Some(key) if self.is_new(&key) && may_start => self.start(key, follower, paint, jobs),
                Some(_) => return false,
                None => {
                    self.forget();
                    return false;
                }
            }
        }
    }

    fn is_new(&self, key: &DerivationKey) -> bool {
        self.latest.as_ref().is_none_or(|derived| derived.key != *key) && self.failed.as_ref() != Some(key)
    }

    /// The thread has ended: with a mesh, because it gave way to the next one, or because it failed.
    fn end(&mut self) {
        let Some(RunningDerivation { key, job, .. }) = self.running.take() else { return };
        let has_derived = !self.is_new(&key);
        self.succession.ended(has_derived);
        self.failed = Some(key).filter(|_| !has_derived && !job.is_cancelled());
    }

    fn forget(&mut self) {
        self.coast.forget();
        if self.latest.take().is_some() {
            self.replace_pieces(PatchPieces::default());
        }
    }

    fn take(&mut self, outcome: DerivationResult, follower: &Follower, paint: &PaintLayers) {
        match outcome {
            DerivationResult::Derived(derived, pieces, removed) => {
                self.coast.remove(removed, follower);
                let pieces = self.followed(pieces, follower);
                self.latest = Some(*derived);
                self.replace_pieces(pieces);
            }
            DerivationResult::Coast(coast) => self.begin_coast(*coast, follower, paint),
            DerivationResult::Quality(quality) => {
                if let Some(derived) = &mut self.latest {
                    derived.quality = Some(quality);
                }
            }
        }
    }

    /// Returns derived pieces for the mesh as it is now.
    fn followed(&mut self, mut pieces: PatchPieces, follower: &Follower) -> PatchPieces {
        let Some(running) = &mut self.running else { return pieces };
        let mesh = follower.mesh();
        match &running.since {
            None => {}
            Some(MeshChange::Replaced) => pieces = PatchPieces::default(),
            Some(MeshChange::Within(changes)) if self.coast.is_of(follower) => {
                // It was in step all the time, so this is all that differs.
                let mut ids = std::mem::take(&mut running.replaced);
                ids.sort_unstable();
                ids.dedup();
                ids.retain(|id| id.index() < mesh.raw_triangle_count());
                pieces.replace(mesh, changes, self.coast.replacements(mesh, &ids));
            }
            Some(MeshChange::Within(changes)) => drop(pieces.retire(mesh, changes)),
        }
        pieces
    }

    /// Lets the coast of the mesh that was derived catch up with the mesh, and shows it.
    fn begin_coast(&mut self, coast: DerivedFollower, follower: &Follower, paint: &PaintLayers) {
        let since = self.running.as_ref().and_then(|running| running.since.as_ref());
        if let Some(ids) = self.coast.begin(coast, follower, paint, since) {
            let mesh = follower.mesh();
            let replacements = self.coast.replacements(mesh, &ids);
            let touched = self.pieces.replace(mesh, &Changes::default(), replacements);
            self.note_touched(touched);
        }
    }

    fn start(&mut self, key: DerivationKey, follower: &Follower, paint: &PaintLayers, jobs: &Jobs) {
        let follows = !self.coast.is_of(follower);
        // Dropping a large one takes longer than a frame.
        let useless = self.coast.take_useless();
        let settings = follower.settings();
        let (domain, cleaning) = (follower.domain().clone(), key.cleaning);
        let targets = follower.shared_targets(paint);
        let derivation = MeshDerivation::new(follower.shared_mesh(), domain, targets, cleaning, follows);
        let work = DerivationWork {
            key: key.clone(),
            in_world: settings.domain.clone(),
            step: DerivationStep::Derive(derivation),
        };
        let begin = move || {
            drop(useless);
            Some(work)
        };
        let job = jobs.start_in_slices(JobKind::Compute, begin, DerivationWork::advance);
        self.running = Some(RunningDerivation { key, job, since: None, replaced: Vec::new() });
    }
}

/// A mesh to be derived, to be kept in step along the coast, and to be compared with the outline.
struct DerivationWork {
    key: DerivationKey,
    in_world: Domain,
    step: DerivationStep,
}

/// What is done next.
enum DerivationStep {
    Derive(MeshDerivation),
    Extract(MeshDerivation, DerivedMesh),
    Send(MeshDerivation, DerivedMesh, Arc<Extract<'static>>),
    Follow(MeshDerivation, Arc<Extract<'static>>),
    Compare(FitComparison, Arc<Region>),
    Done,
}

impl DerivationWork {
    /// Takes the next step, and sends what it has found.
    fn advance(&mut self, output: &Output<DerivationResult>) -> Progress {
        self.step = match std::mem::replace(&mut self.step, DerivationStep::Done) {
            DerivationStep::Derive(mut derivation) => {
                derivation.advance();
                match derivation.take_derived() {
                    Some(derived) => DerivationStep::Extract(derivation, derived),
                    None => DerivationStep::Derive(derivation),
                }
            }
            DerivationStep::Extract(derivation, derived) => {
                let extract = Arc::new(derived.extract(derivation.mesh()).into_owned());
                DerivationStep::Send(derivation, derived, extract)
            }
            DerivationStep::Send(derivation, derived, extract) => {
                self.send(&derivation, &derived, &extract, output);
                DerivationStep::Follow(derivation, extract)
            }
            DerivationStep::Follow(mut derivation, extract) => {
                let progress = derivation.advance();
                if let Some(coast) = derivation.take_follower() {
                    output.send(DerivationResult::Coast(Box::new(coast)));
                }
                match progress {
                    Progress::More => DerivationStep::Follow(derivation, extract),
                    Progress::Done => self.key.region.clone().map_or(DerivationStep::Done, |region| {
                        let comparison = FitComparison::new(&extract, &region, &self.in_world.ground());
                        DerivationStep::Compare(comparison, region)
                    }),
                }
            }
            DerivationStep::Compare(mut comparison, region) => {
                match comparison.advance(&region, &self.in_world.ground()) {
                    None => DerivationStep::Compare(comparison, region),
                    Some(quality) => {
                        output.send(DerivationResult::Quality(quality));
                        DerivationStep::Done
                    }
                }
            }
            DerivationStep::Done => DerivationStep::Done,
        };
        if matches!(self.step, DerivationStep::Done) { Progress::Done } else { Progress::More }
    }

    /// Sends a derived mesh with its pieces.
    fn send(
        &self,
        derivation: &MeshDerivation,
        derived_mesh: &DerivedMesh,
        extract: &Arc<Extract<'static>>,
        output: &Output<DerivationResult>,
    ) {
        let mesh = derivation.mesh();
        let pieces = PatchPieces::new(mesh, derived_mesh.patch(), extract);
        let derived = Derived {
            key: self.key.clone(),
            locator: PatchedLocator::new(mesh, derived_mesh.patch(), extract),
            level_counts: extract.level_counts(),
            topology: extract.topology(),
            removed: derived_mesh.removed().clone(),
            outline_fit: derived_mesh.fit(),
            line_fits: derived_mesh.line_fits().to_vec(),
            quality: None,
            extract: extract.clone(),
        };
        let removed = RemovedTriangles::of(derived_mesh);
        output.send(DerivationResult::Derived(Box::new(derived), pieces, removed));
    }
}

/// Which mesh was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredMesh {
    follower: u64,
    derived: u64,
}

impl MeasuredMesh {
    /// Returns whether the mesh is as the document asks for, and derived where it has to be.
    pub fn is_settled(document: &Document, follower: &Follower, derivation: &Derivation) -> bool {
        let is_derived = !follower.settings().is_derived() || derivation.current(follower).is_some();
        follower.stage().is_settled() && !document.is_in_gesture() && is_derived
    }

    /// Returns the mesh as it is.
    pub fn now(follower: &Follower, derivation: &Derivation) -> Self {
        Self { follower: follower.revision(), derived: derivation.pieces_revision() }
    }
}
