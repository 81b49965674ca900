//! Keeps field and mesh in step with a document.
//!
//! ```text
//!                     paint                   other settings
//!        ┌──────────────────────────┐  ┌─────────────────────────────┐
//!        │                          ▼  │                             ▼
//!    ┌────────┐    done    ┌──────────────┐   another grid   ┌──────────────┐
//!    │ InStep │ ◀───────── │   Updating   │ ───────────────▶ │  Rebuilding  │ ──┐ newer settings:
//!    └────────┘            └──────────────┘ ◀─── shown ───── └──────────────┘ ◀─┘ shown, then the next
//!        │                      ▲    │
//!        │ outline,   compared, │    │ updated, and
//!        │ layers      checked  │    ▼ newer settings
//!        │                  ┌─────────────┐    error, cancel   ┌────────┐
//!        └────────────────▶ │  Following  │    (any state) ──▶ │ GaveUp │ ── next edit ──▶ (any state)
//!                           └─────────────┘                    └────────┘
//! ```
//!
//! `Settings::change_from` says which of them other settings need.
//!
//! Every edit may arrive in every state; [`Follower::advance`] first chooses the state for the document as it
//! is, then does one slice of work there.

use std::sync::Arc;

use super::change::Change;
use super::following::InPlaceUpdate;
use super::rebuild::Rebuild;
use super::shown::Shown;
use super::{Document, Repainted, Settings, Stage};
use crate::build::{BuildError, BuiltMesh, Parts};
use crate::domain::DomainOnLattice;
use crate::layers::{PaintLayers, SizeField};
use crate::mesh::{Changes, Limits, Mesh, MeshCopy, Progress};
use crate::outline::{EdgeTargets, SharedTargets};
use crate::surface::SurfaceRule;

/// Keeps field and mesh in step with a document, in slices.
///
/// Paint changes the mesh where it is, and nowhere else ([`Updater`](crate::mesh::Updater)): the mesh is
/// conforming and can be drawn after every slice, and once in step it is the one made from scratch. So do
/// edits of layers, limits and gradation, and of the outline of a fitted domain, together or one after the
/// other. For everything else (other settings, and every edit under the vertex rule, which cannot be undone
/// locally) another mesh is built beside the one that is shown; the two change places when the new one is
/// whole.
#[derive(Clone, Debug)]
pub struct Follower {
    shown: Shown,
    state: FollowState,
    /// The change of the shown mesh since the last call of [`Self::take_change`].
    change: Option<MeshChange>,
    revision: u64,
    /// Why the shown mesh is not the document's, until it is.
    stopped: Option<BuildError>,
}

/// The current work, with the data of that work only.
#[derive(Clone, Debug)]
enum FollowState {
    /// No work: field and mesh are up to date with the last seen state of the document.
    InStep,
    /// The shown mesh is updated where h̄ changed.
    Updating {
        /// The mesh that will be updated, while an export holds the shown one.
        copy: Option<Box<MeshCopy>>,
    },
    /// Settings that the shown mesh can follow where it is are compared with those that it has, and checked.
    Following(Box<InPlaceUpdate>),
    /// Another mesh is built beside the shown one.
    Rebuilding(Box<Rebuild>),
    /// No work, as long as the document has this revision.
    GaveUp {
        revision: u64,
        /// Whether the work was cancelled; otherwise it failed, see [`Follower::stopped`].
        cancelled: bool,
    },
}

/// A change of the shown mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeshChange {
    /// Another mesh is shown.
    Replaced,
    /// These entries changed.
    Within(Changes),
}

impl Follower {
    /// Makes field and mesh of a document, in one go.
    ///
    /// # Errors
    /// Fails when the document has no mesh.
    pub fn new(document: &mut Document) -> Result<Self, BuildError> {
        document.take_repainted();
        let spec = document.settings().mesh_spec()?;
        let mut first = Rebuild::new(document.settings(), spec, Parts::default());
        while first.advance(document.paint(), usize::MAX)? == Progress::More {}
        Ok(Self {
            shown: Shown::rebuilt(first, document.paint()),
            state: FollowState::InStep,
            change: Some(MeshChange::Replaced),
            revision: 0,
            stopped: None,
        })
    }

    /// Shows the bare rectangle of a document that has taken the place of another one, and nothing of the
    /// former mesh any more. The next slice begins to make the mesh of the document.
    pub fn show_bare(&mut self, document: &Document) {
        let shown = Shown::bare(document.settings()).or_else(|| Shown::bare(&Settings::default()));
        self.shown = shown.expect("the unit square has a lattice");
        self.state = FollowState::InStep;
        self.stopped = None;
        self.revision += 1;
        self.change = Some(MeshChange::Replaced);
    }

    /// Follows a mesh that was made before, with these settings and the paint of the document as it was at
    /// the last call of [`Document::take_repainted`].
    pub fn from_built(settings: Settings, built: BuiltMesh) -> Self {
        Self {
            shown: Shown::new(settings, built, &[], &PaintLayers::default()),
            state: FollowState::InStep,
            change: Some(MeshChange::Replaced),
            revision: 0,
            stopped: None,
        }
    }

    /// Returns a copy of the shown mesh, with what it was made from.
    pub fn built(&self) -> BuiltMesh {
        let Shown { settings, domain, field, surface, mesh, .. } = &self.shown;
        BuiltMesh {
            domain: domain.clone(),
            field: field.clone(),
            rule: settings.rule,
            surface: surface.clone(),
            mesh: (**mesh).clone(),
        }
    }

    /// Returns the shown mesh: conforming at all times.
    pub fn mesh(&self) -> &Mesh {
        &self.shown.mesh
    }

    /// Returns the shown mesh as it is, for work that takes longer than a frame. It does not change while it
    /// is held; the follower continues with a copy.
    pub fn shared_mesh(&self) -> Arc<Mesh> {
        self.shown.mesh.clone()
    }

    /// Returns the domain on the lattice of the shown mesh.
    pub fn domain(&self) -> &DomainOnLattice {
        &self.shown.domain
    }

    /// h̄ of the shown mesh; that of the document, once in step.
    pub fn field(&self) -> &SizeField {
        &self.shown.field
    }

    /// Returns the field as it is, for work that takes longer than a frame.
    pub fn shared_field(&self) -> Arc<SizeField> {
        self.shown.field.clone()
    }

    /// Returns what the edges of the derived mesh are compared with, with the pixels of the document; `None`
    /// by the vertex rule, which knows h̄ at the nodes of the mesh only.
    pub fn edge_targets<'a>(&'a self, paint: &'a PaintLayers) -> Option<EdgeTargets<'a>> {
        EdgeTargets::by_rule(self.shown.settings.rule, &self.shown.field, paint)
    }

    /// [`Self::edge_targets`] for work that takes longer than a frame.
    pub fn shared_targets(&self, paint: &PaintLayers) -> Option<SharedTargets> {
        let shared = |_| SharedTargets { field: self.shown.field.clone(), paint: paint.clone() };
        self.edge_targets(paint).map(shared)
    }

    /// Returns how close the shown mesh is to surfaces, if a layer is one.
    pub fn surface(&self) -> Option<&Arc<SurfaceRule>> {
        self.shown.surface.as_ref()
    }

    /// Returns the settings that mesh and field were made from.
    pub fn settings(&self) -> &Settings {
        &self.shown.settings
    }

    /// Grows whenever the shown mesh changes.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Returns the change of the shown mesh since the last call.
    pub fn take_change(&mut self) -> Option<MeshChange> {
        self.change.take()
    }

    /// Returns the current stage of the work.
    pub fn stage(&self) -> Stage {
        match &self.state {
            FollowState::InStep => Stage::InStep,
            FollowState::Updating { copy: Some(copy) } => Stage::Copying { triangles: copy.triangles() },
            FollowState::Updating { copy: None } => {
                Stage::Refining { triangles: self.mesh().raw_triangle_count() }
            }
            FollowState::Following(following) => following.stage(),
            FollowState::Rebuilding(rebuild) => rebuild.stage(),
            FollowState::GaveUp { cancelled: true, .. } => Stage::GaveUp(None),
            FollowState::GaveUp { cancelled: false, .. } => Stage::GaveUp(self.stopped.clone()),
        }
    }

    /// Returns why the shown mesh is not that of the document: a limit was reached, or a target is
    /// impossible. The reason stays until mesh and document agree, also while another edit is tried.
    pub fn stopped(&self) -> Option<&BuildError> {
        self.stopped.as_ref()
    }

    /// Returns whether field and mesh are those of the document as it is.
    pub fn is_in_step(&self, document: &Document) -> bool {
        matches!(self.state, FollowState::InStep)
            && self.shown.settings == *document.settings()
            && document.repainted == Repainted::Within(Vec::new())
    }

    /// Gives up the work that is left. The mesh may then differ from the document's, until the document's
    /// next change.
    pub fn cancel(&mut self, document: &Document) {
        if !self.is_in_step(document) {
            self.shown.cancel();
            self.state = FollowState::GaveUp { revision: document.revision(), cancelled: true };
        }
    }

    /// Drops the update of the mesh that is left: it is for former settings, and nobody wants its mesh. The
    /// next slice begins to make that of the document.
    pub fn drop_update(&mut self) {
        if matches!(self.state, FollowState::Updating { .. }) {
            self.shown.cancel();
            self.state = FollowState::InStep;
        }
    }

    /// Takes over what changed in the document, and does one slice of work: about `budget` edges, pixels or
    /// triangles.
    ///
    /// Paint joins the current work. A rebuild is finished and shown before the next one begins with newer
    /// settings, so that the mesh keeps moving while a setting is dragged.
    ///
    /// # Errors
    /// Fails when the document has no mesh. The shown one stays, conforming, and the document is not tried
    /// again until it changes.
    pub fn advance(&mut self, document: &mut Document, budget: usize) -> Result<Stage, BuildError> {
        self.take_over_paint(document);
        if !self.gave_up_on(document)
            && let Err(error) = self.work(document, budget)
        {
            self.stopped = Some(error.clone());
            self.state = FollowState::GaveUp { revision: document.revision(), cancelled: false };
            return Err(error);
        }
        if matches!(self.state, FollowState::InStep) {
            self.stopped = None;
        }
        Ok(self.stage())
    }

    /// Returns whether the document as it is was tried already, and failed or was cancelled.
    fn gave_up_on(&self, document: &Document) -> bool {
        matches!(self.state, FollowState::GaveUp { revision, .. } if revision == document.revision())
    }

    /// Returns the work that makes the shown mesh again, with other paint, within these limits.
    pub(super) fn rebuild_within(&self, limits: Limits, spare: Option<Mesh>) -> Result<Rebuild, BuildError> {
        self.shown.rebuild_within(&self.shown.settings, limits, spare)
    }

    fn take_over_paint(&mut self, document: &mut Document) {
        match document.take_repainted() {
            Repainted::Within(areas) => {
                if let FollowState::Rebuilding(rebuild) = &mut self.state {
                    rebuild.repaint(&areas);
                }
                self.shown.repaint(&areas, document.paint());
            }
            Repainted::Everything => {
                self.state = FollowState::InStep;
                self.shown.replace_paint();
            }
        }
    }

    /// Chooses the state for the document as it is, and does one slice of work there.
    fn work(&mut self, document: &Document, budget: usize) -> Result<(), BuildError> {
        self.state = match self.chosen_state(document)? {
            FollowState::Updating { copy } => self.update(copy, document, budget)?,
            FollowState::Following(following) => self.follow(following, document, budget)?,
            FollowState::Rebuilding(rebuild) => self.rebuild(rebuild, document, budget)?,
            idle @ (FollowState::InStep | FollowState::GaveUp { .. }) => idle,
        };
        Ok(())
    }

    /// Returns the present state, if its work is still of use for the document as it is; otherwise the next.
    fn chosen_state(&mut self, document: &Document) -> Result<FollowState, BuildError> {
        let state = std::mem::replace(&mut self.state, FollowState::InStep);
        let shown = &self.shown;
        let goes_on = match &state {
            FollowState::InStep | FollowState::GaveUp { .. } => false,
            // The mesh keeps moving while a layer, a limit or the outline is dragged: newer ones wait for the
            // update.
            FollowState::Updating { .. } => {
                shown.has_updates()
                    && match shown.change_to(document) {
                        Change::Nothing => shown.settings == *document.settings(),
                        Change::Update { .. } => true,
                        Change::NewMesh { .. } => false,
                    }
            }
            // So does work on an edit: what came since is the next one.
            FollowState::Following(_) => matches!(shown.change_to(document), Change::Update { .. }),
            FollowState::Rebuilding(rebuild) => {
                let triangles = shown.mesh.raw_triangle_count();
                rebuild.is_for(document.settings())
                    || (shown.change_to(document) != Change::Nothing
                        && rebuild.is_worth_finishing(document, triangles))
            }
        };
        if goes_on { Ok(state) } else { self.next_state(document) }
    }

    /// Returns the next state on the way to the document as it is, when there is no current work.
    fn next_state(&mut self, document: &Document) -> Result<FollowState, BuildError> {
        self.next_state_reusing(document, None)
    }

    /// Returns the result of [`Self::next_state`]; a rebuild reuses the memory of `spare`.
    fn next_state_reusing(
        &mut self,
        document: &Document,
        spare: Option<Mesh>,
    ) -> Result<FollowState, BuildError> {
        let wanted = document.settings();
        match self.shown.change_to(document) {
            Change::Nothing => {
                self.shown.adopt(wanted);
                let updates = self.shown.has_updates();
                Ok(if updates { FollowState::Updating { copy: None } } else { FollowState::InStep })
            }
            Change::Update { outline, field } => {
                Ok(FollowState::Following(Box::new(self.shown.follow(wanted, outline, field))))
            }
            Change::NewMesh { .. } => {
                Ok(FollowState::Rebuilding(Box::new(self.shown.rebuild(wanted, spare)?)))
            }
        }
    }

    /// Returns one slice of updates of the shown mesh.
    fn update(
        &mut self,
        mut copy: Option<Box<MeshCopy>>,
        document: &Document,
        budget: usize,
    ) -> Result<FollowState, BuildError> {
        let result = self.shown.update_mesh(&mut copy, document.paint(), budget);
        // What changed before an error is shown too.
        self.note_changes();
        match result {
            Ok(()) if self.shown.has_updates() => return Ok(FollowState::Updating { copy }),
            Err(error) if self.shown.settings == *document.settings() => return Err(error.into()),
            // What is impossible with outdated layers may be possible with the present ones.
            Ok(()) | Err(_) => {}
        }
        self.next_state(document)
    }

    /// Returns one slice of work on other settings; at its end the mesh begins to follow.
    fn follow(
        &mut self,
        mut following: Box<InPlaceUpdate>,
        document: &Document,
        budget: usize,
    ) -> Result<FollowState, BuildError> {
        match following.advance(budget) {
            Ok(Progress::More) => return Ok(FollowState::Following(following)),
            Ok(Progress::Done) => self.shown.take(following.finish(), document.paint()),
            Err(error) if following.is_for(document.settings()) => return Err(error),
            // It may be possible with the present settings.
            Err(_) => {}
        }
        self.next_state(document)
    }

    /// Returns one slice of work on another mesh; at its end that is shown.
    fn rebuild(
        &mut self,
        mut rebuild: Box<Rebuild>,
        document: &Document,
        budget: usize,
    ) -> Result<FollowState, BuildError> {
        let wanted = document.settings();
        match rebuild.advance(document.paint(), budget) {
            Ok(Progress::More) => return Ok(FollowState::Rebuilding(rebuild)),
            Ok(Progress::Done) => {
                let former = std::mem::replace(&mut self.shown, Shown::rebuilt(*rebuild, document.paint()));
                self.revision += 1;
                self.change = Some(MeshChange::Replaced);
                // Unless an export holds it, the next mesh of a drag is built in its memory.
                return self.next_state_reusing(document, Arc::into_inner(former.mesh));
            }
            Err(error) if rebuild.is_up_to_date(wanted) => return Err(error),
            // It may be possible with the present settings and paint.
            Err(_) => {}
        }
        self.next_state(document)
    }

    fn note_changes(&mut self) {
        let Some(changes) = self.shown.take_changes() else { return };
        self.revision += 1;
        MeshChange::join(&mut self.change, MeshChange::Within(changes), &self.shown.mesh);
    }
}

impl MeshChange {
    /// Joins what became of `mesh` after an earlier change to that change.
    pub fn join(earlier: &mut Option<Self>, later: Self, mesh: &Mesh) {
        match (&mut *earlier, later) {
            (Some(Self::Replaced), _) => {}
            (Some(Self::Within(earlier)), Self::Within(later)) => earlier.extend(&later, mesh),
            (_, later) => *earlier = Some(later),
        }
    }
}
