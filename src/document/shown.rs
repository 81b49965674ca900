//! The shown field and mesh, updated where they are.

use std::sync::Arc;

use super::layers_update::LayersUpdate;
use super::outline_update::OutlineUpdate;
use super::rebuild::Rebuild;
use super::{RepaintedArea, Settings};
use crate::build::{BuildError, BuiltMesh, Parts, RefinementCriterion};
use crate::domain::DomainOnLattice;
use crate::field::RefinementRule;
use crate::geometry::{LatticeRect, Rect};
use crate::layers::{PaintLayers, SizeField};
use crate::mesh::{Changes, Mesh, MeshCopy, Progress, RefineError, TargetChange, Updater};

/// The field and the mesh that are shown, with the updates that they still need.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    /// What field and mesh were made from.
    pub(super) settings: Settings,
    pub(super) domain: DomainOnLattice,
    /// Shared with a rebuild that reuses it, and not changed meanwhile.
    pub(super) field: Arc<SizeField>,
    pub(super) mesh: Arc<Mesh>,
    /// Updates of the mesh; idle under the vertex rule.
    updater: Updater,
    upkeep: Upkeep,
}

/// What brings the shown mesh up to date.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Upkeep {
    /// Updates in place.
    InPlace,
    /// A rebuild: updates were cancelled, something was painted under the vertex rule, the document was
    /// replaced, or most of a large mesh would have to be updated.
    NewMesh,
}

/// From this many triangles on a mesh is made again on all cores rather than updated for the most part, which
/// one core does. Before, both take a few frames, and an update keeps the numbers of triangles.
const LARGE: usize = 250_000;

/// Triangles that are looked up to estimate a share of them.
const SAMPLE: usize = 4096;

/// Whether more than half of the triangles of a mesh lie in some areas, by a sample at equal steps.
fn hold_most(areas: &[LatticeRect], mesh: &Mesh) -> bool {
    let triangles = mesh.raw_triangles();
    let sampled = triangles.iter().step_by(triangles.len().div_ceil(SAMPLE).max(1));
    let count = sampled.len();
    let inside = sampled.filter(|triangle| {
        let corners = triangle.edge_nodes().map(|(from, _)| mesh.node(from));
        areas.iter().any(|area| area.touches(corners))
    });
    2 * inside.count() > count
}

impl Shown {
    /// A mesh that was just built. `repainted` was painted meanwhile, in world units.
    pub(super) fn new(settings: Settings, built: BuiltMesh, repainted: &[Rect], paint: &PaintLayers) -> Self {
        let BuiltMesh { domain, field, mesh, .. } = built;
        let updater = Updater::new(settings.limits());
        let upkeep = Upkeep::InPlace;
        let mut shown = Self { settings, domain, field, mesh: Arc::new(mesh), updater, upkeep };
        // Pixels may have been read before or after they changed.
        let areas: Vec<_> =
            repainted.iter().map(|&rect| RepaintedArea { rect, change: TargetChange::Any }).collect();
        shown.repaint(&areas, paint);
        shown
    }

    /// Notes where the paint changed. `paint` is the paint as it is now.
    pub(super) fn repaint(&mut self, areas: &[RepaintedArea], paint: &PaintLayers) {
        if areas.is_empty() {
            return;
        }
        match self.settings.rule {
            RefinementRule::Area => {
                for RepaintedArea { rect, change } in areas {
                    if let Some(area) = self.field.area_affected_by(rect, paint) {
                        self.updater.add_change(area, *change);
                    }
                }
            }
            RefinementRule::Vertex => self.upkeep = Upkeep::NewMesh,
        }
    }

    /// Notes that the document was replaced.
    pub(super) fn replace_paint(&mut self) {
        self.upkeep = Upkeep::NewMesh;
    }

    /// Gives up the updates that are left.
    pub(super) fn cancel(&mut self) {
        if !self.updater.is_done() {
            self.updater.cancel();
            self.upkeep = Upkeep::NewMesh;
        }
    }

    /// Whether the mesh waits for updates in place.
    pub(super) fn has_updates(&self) -> bool {
        self.upkeep == Upkeep::InPlace && !self.updater.is_done()
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

    /// The work that follows other layers in place, where that is possible.
    pub(super) fn follow_layers(&self, wanted: &Settings) -> Option<LayersUpdate> {
        self.can_follow_layers(wanted).then(|| LayersUpdate::new(&self.settings, wanted, self.mesh.lattice()))
    }

    /// Not so where the mesh is beyond the wanted budgets already: only a rebuild finds out whether they can
    /// be kept.
    pub(super) fn can_follow_layers(&self, wanted: &Settings) -> bool {
        self.upkeep == Upkeep::InPlace
            && self.mesh.raw_triangle_count() <= wanted.limits().most_triangles()
            && LayersUpdate::is_possible(&self.settings, wanted)
    }

    /// Takes over other layers: the mesh is updated where h̄ can differ, or made again where that is most of
    /// a large mesh.
    pub(super) fn take_layers(&mut self, update: LayersUpdate, paint: &PaintLayers) {
        let (settings, field) = update.finish();
        let areas = field.areas_that_differ(&self.field, paint);
        if self.mesh.raw_triangle_count() >= LARGE && hold_most(&areas, &self.mesh) {
            self.upkeep = Upkeep::NewMesh;
        } else {
            let change = settings.change_since(&self.settings);
            areas.into_iter().for_each(|area| self.updater.add_change(area, change));
        }
        self.updater.set_limits(settings.limits());
        self.domain = self.domain.with_boundary(settings.boundary);
        (self.settings, self.field) = (settings, field);
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
        let is_current = same_lattice && *self.field.spec() == spec.field && spec.rule == self.settings.rule;
        let field = is_current.then(|| self.field.clone());
        let domain = same_domain.then(|| self.domain.clone());
        Ok(Rebuild::new(wanted, spec, Parts { domain, field, spare }))
    }

    /// One slice of updates of the mesh; of copying it first, as long as it is shared.
    pub(super) fn update_mesh(
        &mut self,
        copy: &mut Option<Box<MeshCopy>>,
        paint: &PaintLayers,
        budget: usize,
    ) -> Result<(), RefineError> {
        if self.updater.is_done() || self.unshare_mesh(copy, budget) == Progress::More {
            return Ok(());
        }
        let Self { domain, field, mesh, updater, .. } = self;
        let mesh = Arc::get_mut(mesh).expect("it is not shared, see above");
        let mut criterion = RefinementCriterion::by_area(domain, field, paint);
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
