//! The shown field and mesh, updated where they are.

use std::sync::Arc;

use super::Settings;
use super::outline_update::OutlineUpdate;
use super::rebuild::Rebuild;
use crate::build::{BuildError, BuiltMesh, Parts, RefinementCriterion};
use crate::domain::DomainOnLattice;
use crate::field::{PaintRef, RefinementRule, TargetField};
use crate::mesh::{Changes, Mesh, MeshCopy, Progress, RefineError, Updater};
use crate::raster::PixelRect;

/// The field and the mesh that are shown, with the updates that they still need.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    /// What field and mesh were made from.
    pub(super) settings: Settings,
    pub(super) domain: DomainOnLattice,
    /// Shared with a rebuild that reuses it, and not changed meanwhile.
    pub(super) field: Arc<TargetField>,
    pub(super) mesh: Arc<Mesh>,
    /// Updates of the mesh; idle under the vertex rule.
    updater: Updater,
    /// What was painted and is not in the field yet.
    unread: Vec<PixelRect>,
    upkeep: Upkeep,
}

/// What brings the shown mesh up to date; a later variant includes the earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Upkeep {
    /// Updates in place.
    InPlace,
    /// A rebuild: updates were cancelled, or paint was read under the vertex rule.
    NewMesh,
    /// A rebuild with another field: all of the paint was replaced.
    NewField,
}

impl Shown {
    /// A mesh that was just built. `unread` was painted meanwhile.
    pub(super) fn new(settings: Settings, built: BuiltMesh, unread: Vec<PixelRect>) -> Self {
        let BuiltMesh { domain, field, mesh, .. } = built;
        let updater = Updater::new(settings.limits());
        let upkeep = Upkeep::InPlace;
        Self { settings, domain, field, mesh: Arc::new(mesh), updater, unread, upkeep }
    }

    /// Notes what was painted.
    pub(super) fn repaint(&mut self, areas: Vec<PixelRect>) {
        self.unread.extend(areas);
    }

    /// Notes that all of the paint was replaced.
    pub(super) fn replace_paint(&mut self) {
        self.unread.clear();
        self.upkeep = Upkeep::NewField;
    }

    /// Gives up the updates that are left.
    pub(super) fn cancel(&mut self) {
        if !self.updater.is_done() {
            self.updater.cancel();
            self.upkeep = self.upkeep.max(Upkeep::NewMesh);
        }
    }

    /// Whether field or mesh wait for updates in place.
    pub(super) fn has_updates(&self) -> bool {
        match self.upkeep {
            Upkeep::InPlace => !self.unread.is_empty() || !self.updater.is_done(),
            // The field is brought up to date first: then the rebuild can use it.
            Upkeep::NewMesh => !self.unread.is_empty(),
            Upkeep::NewField => false,
        }
    }

    /// Whether paint waits to be read into the field.
    pub(super) fn has_unread_paint(&self) -> bool {
        !self.unread.is_empty()
    }

    /// Whether the shown mesh, once it is updated, is that of `wanted`: the settings that it was made from,
    /// or others with the same mesh and budgets that it keeps.
    pub(super) fn obeys(&self, wanted: &Settings) -> bool {
        if self.upkeep != Upkeep::InPlace {
            return false;
        }
        self.settings == *wanted
            || (self.mesh.raw_triangle_count() <= wanted.limits().most_triangles()
                && self.settings.share_mesh_with(wanted))
    }

    /// Takes over settings that the mesh obeys. Updates that a former budget stopped go on.
    pub(super) fn adopt(&mut self, wanted: &Settings) {
        if self.settings != *wanted {
            self.settings = wanted.clone();
            self.domain = self.domain.with_boundary(wanted.boundary);
            self.updater.set_limits(wanted.limits());
        }
    }

    /// Whether only paint must be read before a rebuild for the same settings can begin.
    pub(super) fn reads_paint_first(&self, wanted: &Settings) -> bool {
        self.upkeep == Upkeep::NewMesh && self.has_unread_paint() && self.settings == *wanted
    }

    /// The work that follows an edit of the outline in place, where that is possible.
    pub(super) fn follow_outline(&self, wanted: &Settings) -> Option<OutlineUpdate> {
        if self.can_follow_outline(wanted) {
            OutlineUpdate::new(&self.settings, wanted, self.mesh.lattice())
        } else {
            None
        }
    }

    pub(super) fn can_follow_outline(&self, wanted: &Settings) -> bool {
        self.upkeep == Upkeep::InPlace
            && self.settings.domain != wanted.domain
            && OutlineUpdate::is_possible(&self.settings, wanted)
    }

    /// Takes over another outline: the mesh is updated where it differs.
    pub(super) fn take_outline(&mut self, update: OutlineUpdate) {
        self.settings = update.settings.clone();
        let (domain, areas) = update.finish();
        self.domain = domain;
        areas.into_iter().for_each(|area| self.updater.add_and_report(area));
    }

    /// The work on another mesh, which reuses what the shown one has already, and the memory of `spare`.
    pub(super) fn rebuild(&self, wanted: &Settings, spare: Option<Mesh>) -> Result<Rebuild, BuildError> {
        let spec = wanted.mesh_spec()?;
        let same_lattice = spec.lattice == *self.mesh.lattice();
        let same_domain = same_lattice && wanted.domain == self.settings.domain;
        let is_current = self.upkeep != Upkeep::NewField && self.unread.is_empty();
        let field = if same_lattice && is_current && *self.field.spec() == spec.field {
            self.field.clone()
        } else {
            Arc::new(TargetField::reusing(spec.field.clone(), &spec.lattice, &self.field))
        };
        let domain = same_domain.then(|| self.domain.clone());
        Ok(Rebuild::new(wanted, spec, Parts { domain, field: Some(field), spare }))
    }

    /// Reads about `budget` pixels of what was painted into the field.
    pub(super) fn read_paint(&mut self, paint: PaintRef, budget: usize) {
        let Some(area) = self.unread.pop() else { return };
        let (now, later) = area.split_after(budget);
        self.unread.extend(later);
        // Only a rebuild shares the field, and there is none now: nothing is copied.
        let changed = Arc::make_mut(&mut self.field).update(paint, now);
        match self.settings.rule {
            RefinementRule::Area => {
                changed.iter().for_each(|&area| self.updater.add(self.field.lattice_rect(area)))
            }
            RefinementRule::Vertex => self.upkeep = self.upkeep.max(Upkeep::NewMesh),
        }
    }

    /// One slice of updates of the mesh; of copying it first, as long as it is shared.
    pub(super) fn update_mesh(
        &mut self,
        copy: &mut Option<Box<MeshCopy>>,
        budget: usize,
    ) -> Result<(), RefineError> {
        if self.updater.is_done() || self.unshare_mesh(copy, budget) == Progress::More {
            return Ok(());
        }
        let Self { domain, field, mesh, updater, .. } = self;
        let mesh = Arc::get_mut(mesh).expect("it is not shared, see above");
        let mut criterion = RefinementCriterion::by_area(domain, field);
        updater.advance(mesh, |element| criterion.exceeds(element), budget).map(|_| ())
    }

    /// What the updates changed since this was last asked, `None` if nothing.
    pub(super) fn take_changes(&mut self) -> Option<Changes> {
        let changes = self.updater.take_changes()?;
        let mesh = Arc::get_mut(&mut self.mesh).expect("it was not shared when it was changed");
        if self.domain.is_fitted() || mesh.outside_count() > 0 {
            for ids in &changes.triangles {
                mesh.classify(ids.clone(), |element| self.domain.excludes(element));
            }
        }
        Some(changes)
    }

    /// Copies a shared mesh in slices, and puts the copy in its place once it is whole. `Done` when the mesh
    /// is not shared.
    fn unshare_mesh(&mut self, copy: &mut Option<Box<MeshCopy>>, budget: usize) -> Progress {
        if Arc::get_mut(&mut self.mesh).is_some() {
            // The other holder let go: no copy is needed.
            *copy = None;
            return Progress::Done;
        }
        let mut copying = copy.take().unwrap_or_else(|| Box::new(MeshCopy::new(&self.mesh)));
        match copying.advance(&self.mesh, budget) {
            Progress::More => {
                *copy = Some(copying);
                Progress::More
            }
            Progress::Done => {
                self.mesh = Arc::new(copying.finish());
                Progress::Done
            }
        }
    }
}
