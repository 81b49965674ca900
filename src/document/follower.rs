use std::sync::Arc;

use super::cut::Cut;
use super::job::{Finished, Job};
use super::stage::{FollowError, Stage};
use super::{Document, Repainted, Settings};
use crate::domain::DomainOnLattice;
use crate::field::{RefinementRule, TargetField};
use crate::mesh::{Changes, Element, Mesh, Progress, RefineError, Updater};
use crate::raster::PixelRect;

/// Keeps field and mesh in step with a document, in slices.
///
/// Paint changes the mesh where it is, and nowhere else ([`Updater`]): the mesh is conforming and can be drawn after every
/// slice, and at rest it is the one that would be made from scratch. Everything else (settings, and every edit under the
/// vertex rule, which cannot be undone locally) leads to a mesh made anew beside the one that is shown; the two change places
/// when the new one is whole.
#[derive(Clone, Debug)]
pub struct Follower {
    settings: Settings,
    domain: DomainOnLattice,
    field: TargetField,
    mesh: Arc<Mesh>,
    /// Work on the shown mesh; idle under the vertex rule.
    updater: Updater,
    /// What it changed since [`Self::take_change`] was last called.
    changes: Option<Changes>,
    revision: u64,
    /// Another mesh is shown since [`Self::take_change`] was last called.
    replaced: bool,
    /// The shown mesh no longer is the one of its settings and field: the next work makes it anew.
    lost_step: bool,
    /// All of the paint changed: the field is to be filled anew.
    refill: bool,
    /// What was painted and is not yet in the field.
    unread: Vec<PixelRect>,
    job: Option<Job>,
    /// Another outline, on its way to the shown mesh.
    cut: Option<Cut>,
    /// The revision of the document that could not be met: not tried again.
    given_up_on: Option<u64>,
    /// Why the shown mesh is not the document's, until it is.
    stopped: Option<FollowError>,
}

/// What became of the shown mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeshChange {
    /// It is another one.
    Replaced,
    /// These entries changed.
    Within(Changes),
}

impl Follower {
    /// Makes field and mesh of a document, in one go.
    ///
    /// # Errors
    /// When the document has no mesh.
    pub fn new(document: &mut Document) -> Result<Self, FollowError> {
        document.take_repainted();
        let mut job = Job::new(document.settings(), false, None)?;
        while job.advance(document, None, usize::MAX)? == Progress::More {}
        let Finished { settings, domain, field, mesh } = job.finished();
        let field = field.expect("the first job fills a field of its own");
        let updater = Updater::new(settings.limits());
        Ok(Self {
            settings,
            domain,
            field,
            mesh: Arc::new(mesh),
            updater,
            changes: None,
            revision: 0,
            replaced: true,
            lost_step: false,
            refill: false,
            unread: Vec::new(),
            job: None,
            cut: None,
            given_up_on: None,
            stopped: None,
        })
    }

    /// The shown mesh: conforming at all times.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The shown mesh as it is, to be kept by work that takes longer than a frame.
    pub fn shared_mesh(&self) -> Arc<Mesh> {
        self.mesh.clone()
    }

    /// The domain on the lattice of the shown mesh.
    pub fn domain(&self) -> &DomainOnLattice {
        &self.domain
    }

    /// h̄ as the document has it, once in step.
    pub fn field(&self) -> &TargetField {
        &self.field
    }

    /// The settings that mesh and field were made from.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Grows whenever the shown mesh changes.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// What became of the shown mesh since this was last asked.
    pub fn take_change(&mut self) -> Option<MeshChange> {
        let within = self.changes.take().map(MeshChange::Within);
        if std::mem::take(&mut self.replaced) { Some(MeshChange::Replaced) } else { within }
    }

    /// What is left to do.
    pub fn stage(&self) -> Stage {
        match &self.job {
            // What is left is not tried before the document changes.
            None if self.given_up_on.is_some() => Stage::InStep,
            None if self.cut.is_some() => Stage::Outlining,
            None if !self.unread.is_empty() || self.lost_step => Stage::Filling,
            None if self.updater.is_done() => Stage::InStep,
            None => Stage::Refining { triangles: self.mesh.raw_triangle_count() },
            Some(job) => job.stage(),
        }
    }

    /// Why the shown mesh is not that of the document: a budget was met, or a target that cannot be. It stays until mesh and
    /// document agree, also while another edit is being tried.
    pub fn stopped(&self) -> Option<&FollowError> {
        self.stopped.as_ref()
    }

    /// Whether field and mesh are those of the document as it is: nothing to do, and nothing given up.
    pub fn is_in_step(&self, document: &Document) -> bool {
        self.stage() == Stage::InStep
            && self.given_up_on.is_none()
            && self.settings == *document.settings()
            && document.repainted == Repainted::Within(Vec::new())
    }

    /// Gives up the work under way. The document may then differ from the mesh, until its next change.
    pub fn cancel(&mut self, document: &Document) {
        if !self.updater.is_done() {
            self.updater.cancel();
            self.lost_step = true;
        }
        self.give_up(document);
    }

    fn give_up(&mut self, document: &Document) {
        (self.job, self.cut) = (None, None);
        self.given_up_on = Some(document.revision());
    }

    /// Takes over what changed in the document, and does one slice of work: about `visits` pixels or triangles.
    ///
    /// A change of settings begins anew. Paint joins the work under way.
    ///
    /// # Errors
    /// When the document has no mesh. The shown one stays, conforming, and the document is not tried again until it changes.
    pub fn advance(&mut self, document: &mut Document, visits: usize) -> Result<Stage, FollowError> {
        self.take_over_paint(document);
        if self.given_up_on == Some(document.revision()) {
            return Ok(Stage::InStep);
        }
        self.given_up_on = None;
        let result = self.work(document, visits);
        match &result {
            Ok(Stage::InStep) => self.stopped = None,
            Ok(_) => {}
            Err(error) => {
                self.stopped = Some(error.clone());
                self.give_up(document);
            }
        }
        result
    }

    /// Takes over settings that the shown mesh obeys as it is, if these are such: those that it was made from, after a change
    /// there and back, and other budgets that it keeps. What a former budget stopped goes on.
    fn takes_over(&mut self, wanted: &Settings) -> bool {
        let (max_triangles, max_memory) = (wanted.max_triangles, wanted.max_memory);
        let with_budgets = Settings { max_triangles, max_memory, ..self.settings.clone() };
        let limits = wanted.limits();
        let fits = self.mesh.raw_triangle_count() <= limits.most_triangles();
        let obeyed = !self.lost_step && fits && with_budgets == *wanted;
        if obeyed {
            self.settings = with_budgets;
            self.updater.set_limits(limits);
            self.job = None;
        }
        obeyed
    }

    fn work(&mut self, document: &Document, visits: usize) -> Result<Stage, FollowError> {
        let wanted = document.settings();
        let differs = *wanted != *self.job.as_ref().map_or(&self.settings, |job| &job.settings);
        let cuts = differs && self.follows_domain(wanted);
        if !cuts {
            self.cut = None;
        }
        let outdated = if differs {
            !cuts && !self.takes_over(wanted)
        } else {
            self.job.is_none() && self.lost_step && self.unread.is_empty()
        };
        if outdated {
            let reuse_field = self.reuses_field(wanted) && self.unread.is_empty();
            self.job = Some(Job::new(wanted, reuse_field, self.laid_domain(wanted))?);
        }
        match (&mut self.job, self.cut.take()) {
            (Some(job), _) => {
                if job.advance(document, Some(&self.field), visits)? == Progress::Done {
                    self.show();
                }
            }
            (None, Some(cut)) => self.cut(cut, wanted, visits),
            (None, None) => self.update(document, visits)?,
        }
        Ok(self.stage())
    }

    /// One slice of work on the shown field and mesh.
    fn update(&mut self, document: &Document, visits: usize) -> Result<(), RefineError> {
        if let Some(area) = self.unread.pop() {
            let (now, later) = area.split_after(visits);
            self.unread.extend(later);
            let changed = self.field.update(document.paint().as_paint(), now);
            match self.settings.rule {
                RefinementRule::Area => {
                    changed.iter().for_each(|&area| self.updater.add(self.field.lattice_rect(area)))
                }
                RefinementRule::Vertex => self.lost_step = true,
            }
            return Ok(());
        }
        if self.updater.is_done() {
            return Ok(());
        }
        let (field, domain) = (&self.field, &self.domain);
        let mesh = Arc::make_mut(&mut self.mesh);
        let exceeds = |element: &Element| domain.exceeds(element, |element| Ok(field.exceeds(element)));
        let result = self.updater.advance(mesh, exceeds, visits);
        if let Some(changes) = self.updater.take_changes() {
            self.revision += 1;
            if domain.is_fitted() || mesh.outside_count() > 0 {
                for ids in &changes.triangles {
                    mesh.classify(ids.clone(), |element| domain.excludes(element));
                }
            }
            match &mut self.changes {
                Some(earlier) => earlier.extend(&changes, mesh),
                None => self.changes = Some(changes),
            }
        }
        result.map(|_| ())
    }

    /// Begins to take over a domain of another outline, if the shown mesh can follow it in place. A cut that has begun goes on to its
    /// end: what came since is the next one.
    fn follows_domain(&mut self, wanted: &Settings) -> bool {
        if self.job.is_some() || self.lost_step || !Cut::is_possible(&self.settings, wanted) {
            return false;
        }
        if self.cut.is_none() {
            self.cut = Cut::begin(&self.settings, wanted, self.mesh.lattice());
        }
        true
    }

    /// One slice of a cut; at its end the mesh begins to follow, and the cut that came since begins.
    fn cut(&mut self, mut cut: Cut, wanted: &Settings, visits: usize) {
        if cut.advance(visits) == Progress::More {
            self.cut = Some(cut);
            return;
        }
        self.settings = cut.settings.clone();
        let (domain, areas) = cut.finished();
        self.domain = domain;
        areas.into_iter().for_each(|area| self.updater.add_and_tell(area));
        if self.settings != *wanted {
            self.follows_domain(wanted);
        }
    }

    fn show(&mut self) {
        let Some(mut job) = self.job.take() else { return };
        self.unread = std::mem::take(&mut job.repainted);
        let Finished { settings, domain, field, mesh } = job.finished();
        self.updater = Updater::new(settings.limits());
        (self.settings, self.domain) = (settings, domain);
        if let Some(field) = field {
            self.field = field;
        }
        self.mesh = Arc::new(mesh);
        self.revision += 1;
        self.replaced = true;
        self.changes = None;
        (self.lost_step, self.refill) = (false, false);
    }

    /// Whether the shown field is made from the same things as `wanted` asks for.
    fn reuses_field(&self, wanted: &Settings) -> bool {
        !self.refill
            && self.field.spec() == &wanted.field_spec()
            && wanted.lattice().as_ref() == Ok(self.mesh.lattice())
    }

    /// The wanted domain on the lattice, where the shown mesh has it.
    fn laid_domain(&self, wanted: &Settings) -> Option<DomainOnLattice> {
        let same =
            wanted.domain == self.settings.domain && wanted.lattice().as_ref() == Ok(self.mesh.lattice());
        same.then(|| self.domain.with_boundary(wanted.boundary))
    }

    fn take_over_paint(&mut self, document: &mut Document) {
        match document.take_repainted() {
            Repainted::Within(areas) => {
                if let Some(job) = &mut self.job {
                    job.repainted.extend(&areas);
                }
                self.unread.extend(areas);
            }
            Repainted::Everything => {
                (self.job, self.cut) = (None, None);
                self.unread.clear();
                self.lost_step = true;
                self.refill = true;
            }
        }
    }
}
