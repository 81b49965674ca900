//! The shown field and mesh, updated where they are.

use std::sync::Arc;

use super::change::Change;
use super::following::{InPlaceUpdate, PreparedUpdate};
use super::pace::questions_per_thread;
use super::pending::Pending;
use super::rebuild::Rebuild;
use super::{Document, Settings};
use crate::build::{BuildError, BuiltMesh, MeshBuilder, MeshSpec, Parts, RefinementCriterion};
use crate::domain::{Domain, DomainOnLattice, DomainShape};
use crate::field::{RefinementRule, Transfer};
use crate::geometry::{LatticePoint, LatticeRect};
use crate::layers::{PaintChange, PaintLayers, SizeField};
use crate::mesh::{
    ChangedArea, Changes, Limits, Mesh, MeshCopy, Progress, RefineError, RuleAnswers, SharedRule,
    TreeTriangle, TriangleId, Updater,
};
use crate::surface::{SurfaceRule, SurfaceSamples};

/// The field and the mesh that are shown, with the updates that they still need.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    /// The settings from which field and mesh were made.
    pub(super) settings: Settings,
    pub(super) domain: DomainOnLattice,
    /// Shared with a rebuild that reuses it, and not changed meanwhile.
    pub(super) field: Arc<SizeField>,
    /// How close the mesh is to surfaces, if a layer is one. Such a mesh is not updated in place.
    pub(super) surface: Option<Arc<SurfaceRule>>,
    pub(super) mesh: Arc<Mesh>,
    /// Updates of the mesh; idle under the vertex rule.
    updater: Updater,
    /// The changes that the updates apply.
    pending: Pending,
    upkeep: Upkeep,
    /// Where targets changed since this was last asked, if nodes are moved to an outline.
    retargeted: Vec<LatticeRect>,
}

/// The work that brings the shown mesh up to date.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Upkeep {
    /// Updates in place.
    InPlace,
    /// A rebuild: updates were cancelled, something was painted under the vertex rule, the document was
    /// replaced, or most of a large mesh would have to be updated.
    NewMesh,
}

/// Number of triangles from which a mesh is rebuilt rather than updated where most of it changes. Smaller
/// meshes take a few frames either way, and an update keeps the numbers of triangles.
const LARGE: usize = 250_000;

/// Triangles that are looked at to estimate a share of them.
const SAMPLE: usize = 256;

/// How many times as long it takes to bisect a triangle, or to put a parent back, as to write a triangle of a
/// block: the mesh is made again where more than one triangle in so many changes.
const REBUILD_COST_RATIO: usize = 8;

/// Returns whether making a new mesh would take less time than updating this one in some areas, judged by a
/// sample of its triangles: an update loses where it asks about as many questions as the mesh has triangles,
/// or bisects or removes many of them. A new mesh asks fewer, as most answers hold for many triangles.
fn rebuild_is_cheaper(areas: &[ChangedArea], mesh: &Mesh, criterion: &RefinementCriterion<'_>) -> bool {
    let rule = criterion.shared();
    let mut answers = rule.answers();
    let mut exceeds = |corners, level| answers.exceeds(corners, level).unwrap_or(false);
    let count = mesh.raw_triangle_count();
    let (mut asked, mut loose, mut changed) = (0, 0, 0);
    for index in (0..count).step_by(count.div_ceil(SAMPLE).max(1)) {
        let triangle = TreeTriangle::from_mesh(mesh, TriangleId::from_index(index));
        let (corners, level) = (triangle.corners(), triangle.level());
        let [asks, loosens] = concerns(areas, mesh, corners, level);
        let parent = triangle.parent(mesh.lattice()).filter(|_| loosens);
        asked += usize::from(asks);
        loose += usize::from(loosens);
        changed += usize::from(
            (asks && exceeds(corners, level))
                || parent.is_some_and(|parent| !exceeds(parent.corners(), parent.level())),
        );
    }
    2 * asked + loose > SAMPLE || REBUILD_COST_RATIO * changed > SAMPLE
}

/// Returns what [`ChangedArea::concerns`] does, for the changes of all areas together.
fn concerns(areas: &[ChangedArea], mesh: &Mesh, corners: [LatticePoint; 3], level: u32) -> [bool; 2] {
    let touched = areas.iter().filter(|area| area.rect.touches(corners));
    touched.fold([false; 2], |found, area| {
        let [asks, loosens] = area.concerns(mesh, corners, level);
        [found[0] || asks, found[1] || loosens]
    })
}

impl Shown {
    /// Shows the mesh of a finished rebuild.
    pub(super) fn rebuilt(rebuild: Rebuild, paint: &PaintLayers) -> Self {
        let (settings, built, repainted) = rebuild.finish();
        Self::new(settings, built, &repainted, paint)
    }

    /// Creates a mesh that was just built. `repainted` was painted meanwhile.
    pub(super) fn new(
        settings: Settings,
        built: BuiltMesh,
        repainted: &[PaintChange],
        paint: &PaintLayers,
    ) -> Self {
        let BuiltMesh { domain, field, surface, mesh, .. } = built;
        let updater = Updater::new(settings.limits());
        let (pending, upkeep) = (Pending::default(), Upkeep::InPlace);
        let mesh = Arc::new(mesh);
        let retargeted = Vec::new();
        let mut shown = Self { settings, domain, field, surface, mesh, updater, pending, upkeep, retargeted };
        shown.repaint(repainted, paint);
        shown
    }

    /// Creates the mesh of the bare rectangle of some settings, with as few cells as possible and no layer:
    /// it stands for a mesh that is yet to be made. `None` where there is no lattice.
    pub(super) fn bare(wanted: &Settings) -> Option<Self> {
        let settings = Settings {
            name: wanted.name.clone(),
            unit: wanted.unit,
            domain: Domain { shape: DomainShape::Whole, ..wanted.domain.clone() },
            spacing: wanted.domain.bounds.size().max_element(),
            transfer: Transfer { h_max: f64::MAX, ..wanted.transfer },
            layers: Vec::new(),
            rule: wanted.rule,
            ..Settings::default()
        };
        let mut builder = MeshBuilder::new(settings.mesh_spec().ok()?);
        while builder.advance(None, usize::MAX).ok()? == Progress::More {}
        let mut shown = Self::new(settings, builder.finish(), &[], &PaintLayers::default());
        shown.upkeep = Upkeep::NewMesh;
        Some(shown)
    }

    /// Notes where the paint changed. `paint` is the paint as it is now.
    pub(super) fn repaint(&mut self, changes: &[PaintChange], paint: &PaintLayers) {
        if changes.is_empty() {
            return;
        }
        match self.settings.rule {
            _ if self.settings.has_surface() => self.upkeep = Upkeep::NewMesh,
            RefinementRule::Area => {
                self.pending.paint(self.updater.is_done(), changes, &self.field);
                let areas = self.pending.changed_areas(changes, &self.field, paint);
                areas.into_iter().for_each(|area| self.add_area(area));
            }
            RefinementRule::Vertex => self.upkeep = Upkeep::NewMesh,
        }
    }

    /// Lets the mesh be updated where targets may have changed.
    fn add_area(&mut self, area: ChangedArea) {
        if self.domain.region_on_outline().is_some() || self.domain.lines().is_some() {
            self.retargeted.push(area.rect);
        }
        self.updater.add_area(area);
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

    /// Returns whether the mesh waits for updates in place.
    pub(super) fn has_updates(&self) -> bool {
        self.upkeep == Upkeep::InPlace && !self.updater.is_done()
    }

    /// Returns the work that brings the shown mesh up to date with a document, besides the updates that it
    /// still needs.
    ///
    /// A mesh beyond the wanted budgets is rebuilt: only that shows whether they can be kept.
    pub(super) fn change_to(&self, document: &Document) -> Change {
        let wanted = document.settings();
        let is_same = self.settings == *wanted;
        let change =
            if is_same { Change::Nothing } else { wanted.change_from(&self.settings, document.paint()) };
        let is_too_large = !is_same && self.mesh.raw_triangle_count() > wanted.limits().most_triangles();
        match change {
            Change::Nothing | Change::Update { .. } if self.upkeep == Upkeep::NewMesh || is_too_large => {
                Change::NewMesh { is_similar: true }
            }
            change => change,
        }
    }

    /// Takes over settings that the mesh obeys. Updates that a former budget stopped go on.
    pub(super) fn adopt(&mut self, wanted: &Settings) {
        if self.settings != *wanted {
            self.take_lines(wanted);
            self.settings = wanted.clone();
            self.domain = self.domain.with_boundary(wanted.boundary);
            self.updater.set_limits(wanted.limits());
        }
    }

    /// Takes over lines, which only the derived mesh depends on.
    fn take_lines(&mut self, wanted: &Settings) {
        if wanted.lines != self.settings.lines {
            self.domain = self.domain.clone().with_lines(&wanted.lines);
        }
    }

    /// Returns the work that follows an edit in place.
    pub(super) fn follow(&self, wanted: &Settings, outline: bool, field: bool) -> InPlaceUpdate {
        InPlaceUpdate::new(&self.settings, wanted, &self.field, outline, field)
    }

    /// Takes over an edit: the mesh is updated where outline or h̄ can differ, or rebuilt where that is
    /// faster for a large mesh.
    pub(super) fn take(&mut self, followed: PreparedUpdate, paint: &PaintLayers) {
        let PreparedUpdate { settings, outline, field } = followed;
        let outline_areas = outline.as_ref().map(|(_, areas)| areas.as_slice());
        let changes = field
            .as_ref()
            .map_or_else(Vec::new, |field| field.changes_since(&self.field, paint, outline_areas));
        let criterion = RefinementCriterion::by_area(
            outline.as_ref().map_or(&self.domain, |(domain, _)| domain),
            field.as_deref().unwrap_or(&self.field),
            paint,
        );
        if self.mesh.raw_triangle_count() >= LARGE && rebuild_is_cheaper(&changes, &self.mesh, &criterion) {
            self.upkeep = Upkeep::NewMesh;
            if outline.is_some() {
                // Until the other mesh is shown, this one has the former outline.
                return;
            }
        }
        let was_in_step = self.updater.is_done();
        match &field {
            _ if outline.is_some() => self.pending.anything(),
            Some(field) => {
                let layers = field.finer_layers_since(&self.field, paint, outline_areas);
                self.pending.field_changed(was_in_step, layers, field);
            }
            None => {}
        }
        changes.into_iter().for_each(|area| self.add_area(area));
        match outline {
            None => {
                self.take_lines(&settings);
                self.domain = self.domain.with_boundary(settings.boundary);
            }
            Some((domain, areas)) => {
                self.domain = domain.with_lines(&settings.lines);
                let lattice = self.mesh.lattice();
                for area in areas.iter().filter_map(|area| lattice.rect_around(area)) {
                    // Corners are moved to the nearest lattice point: by a step at most.
                    self.updater.add_and_report(area.expanded(1, lattice.extent()));
                }
            }
        }
        self.updater.set_limits(settings.limits());
        self.field = field.unwrap_or_else(|| self.field.clone());
        self.settings = settings;
    }

    /// Returns the work on another mesh, which reuses what the shown one has already, and the memory of
    /// `spare`.
    pub(super) fn rebuild(&self, wanted: &Settings, spare: Option<Mesh>) -> Result<Rebuild, BuildError> {
        self.rebuild_within(wanted, wanted.limits(), spare)
    }

    /// [`Self::rebuild`] within other limits than those of the settings.
    pub(super) fn rebuild_within(
        &self,
        wanted: &Settings,
        limits: Limits,
        spare: Option<Mesh>,
    ) -> Result<Rebuild, BuildError> {
        let spec = MeshSpec { limits, ..wanted.mesh_spec()? };
        let same_lattice = spec.lattice == *self.mesh.lattice();
        let same_domain = same_lattice && wanted.domain == self.settings.domain;
        let is_current =
            same_lattice && self.field.spec().asks_as(&spec.field) && spec.rule == self.settings.rule;
        let field = is_current.then(|| self.field.clone());
        let domain =
            Some(&self.domain).filter(|domain| same_domain && domain.serves(wanted.boundary)).cloned();
        let has_same_samples = same_domain && SurfaceSamples::are_same(&wanted.layers, &self.settings.layers);
        let samples = self.surface.as_ref().filter(|_| has_same_samples).map(|rule| rule.samples().clone());
        Ok(Rebuild::new(wanted, spec, Parts { domain, field, samples, spare }))
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
        let Self { domain, field, mesh, updater, pending, .. } = self;
        let mesh = Arc::get_mut(mesh).expect("it is not shared, see above");
        let (field, known) = pending.field(field);
        let criterion = RefinementCriterion::by_area(domain, field, paint);
        let rule = criterion.shared_with(known, questions_per_thread(budget, field));
        let result = updater.advance(mesh, &rule, budget);
        result.map(|_| ()).map_err(|error| error.map_rule(|never| match never {}))
    }

    /// Returns the changes by updates and of targets since the last call, or `None` if there are none.
    pub(super) fn take_changes(&mut self) -> Option<Changes> {
        let retargeted = std::mem::take(&mut self.retargeted);
        let Some(changes) = self.updater.take_changes() else {
            return (!retargeted.is_empty()).then(|| Changes { retargeted, ..Changes::default() });
        };
        let changes = Changes { retargeted, ..changes };
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
