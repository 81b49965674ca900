use std::sync::Arc;

use super::{Document, Repainted, Settings};
use crate::field::{Rule, TargetField, VertexRule};
use crate::mesh::{Changes, CoarseError, InvalidTarget, Mesh, Progress, RefineError, Refiner, Updater};
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
    field: TargetField,
    mesh: Arc<Mesh>,
    /// Work on the shown mesh; idle under the vertex rule.
    updater: Updater,
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
    /// The revision of the document that could not be met: not tried again.
    given_up_on: Option<u64>,
}

/// What became of the shown mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeshChange {
    /// It is another one.
    Replaced,
    /// These entries changed.
    Within(Changes),
}

/// A mesh in the making.
#[derive(Clone, Debug)]
struct Job {
    settings: Settings,
    /// A field in the making, where that of the shown mesh does not serve.
    field: Option<TargetField>,
    refining: Option<Refining>,
    /// What was painted since the work began: field and mesh are updated there once they are shown.
    repainted: Vec<PixelRect>,
}

#[derive(Clone, Debug)]
struct Refining {
    mesh: Mesh,
    refiner: Refiner,
    /// h̄ by node, as far as the vertex rule has asked.
    known: Vec<f64>,
}

/// How far a [`Follower`] is behind its document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// Not at all.
    InStep,
    /// The field is being sampled.
    Filling,
    /// The mesh is being refined; so far it has this many triangles.
    Refining {
        /// Triangles so far.
        triangles: usize,
    },
}

/// Why no mesh could be made of a document. The former mesh is still shown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FollowError {
    /// The coarse grid is impossible, or empty.
    #[error(transparent)]
    Coarse(#[from] CoarseError),
    /// h̄ is no length somewhere.
    #[error(transparent)]
    InvalidTarget(#[from] InvalidTarget),
    /// A limit was reached.
    #[error(transparent)]
    Refine(#[from] RefineError),
}

impl Follower {
    /// Makes field and mesh of a document, in one go.
    ///
    /// # Errors
    /// When the document has no mesh.
    pub fn new(document: &mut Document) -> Result<Self, FollowError> {
        document.take_repainted();
        let mut job = Job::new(document.settings(), false)?;
        while job.advance(document, None, usize::MAX)? == Progress::More {}
        let (field, mesh) = job.finished();
        let field = field.expect("the first job fills a field of its own");
        let settings = document.settings().clone();
        let updater = Updater::new(settings.limits());
        Ok(Self {
            settings,
            field,
            mesh: Arc::new(mesh),
            updater,
            revision: 0,
            replaced: true,
            lost_step: false,
            refill: false,
            unread: Vec::new(),
            job: None,
            given_up_on: None,
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
        let within = self.updater.take_changes().map(MeshChange::Within);
        if std::mem::take(&mut self.replaced) { Some(MeshChange::Replaced) } else { within }
    }

    /// What is left to do.
    pub fn stage(&self) -> Stage {
        match &self.job {
            None if !self.unread.is_empty() || (self.lost_step && self.given_up_on.is_none()) => {
                Stage::Filling
            }
            None if self.updater.is_done() => Stage::InStep,
            None => Stage::Refining { triangles: self.mesh.triangles().len() },
            Some(Job { refining: None, .. }) => Stage::Filling,
            Some(Job { refining: Some(refining), .. }) => {
                Stage::Refining { triangles: refining.mesh.triangles().len() }
            }
        }
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
        self.job = None;
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
        if result.is_err() {
            self.give_up(document);
        }
        result
    }

    fn work(&mut self, document: &Document, visits: usize) -> Result<Stage, FollowError> {
        let wanted = document.settings();
        let outdated = match &self.job {
            Some(job) => job.settings != *wanted,
            None => (self.lost_step && self.unread.is_empty()) || self.settings != *wanted,
        };
        if outdated {
            let reuse_field = self.reuses_field(wanted) && self.unread.is_empty();
            self.job = Some(Job::new(wanted, reuse_field)?);
        }
        match &mut self.job {
            Some(job) => {
                if job.advance(document, Some(&self.field), visits)? == Progress::Done {
                    self.show();
                }
            }
            None => self.update(document, visits)?,
        }
        Ok(self.stage())
    }

    /// One slice of work on the shown field and mesh.
    fn update(&mut self, document: &Document, visits: usize) -> Result<(), RefineError> {
        if let Some(area) = self.unread.pop() {
            let (now, later) = area.split_after(visits);
            self.unread.extend(later);
            self.field.update(document.layers().as_paint(), now);
            self.note_repainted(now);
            return Ok(());
        }
        if self.updater.is_done() {
            return Ok(());
        }
        let field = &self.field;
        let mesh = Arc::make_mut(&mut self.mesh);
        let steps = self.updater.steps();
        let result = self.updater.run(mesh, |element| Ok(field.exceeds(element)), visits);
        self.revision += u64::from(self.updater.steps() != steps);
        result.map(|_| ())
    }

    fn show(&mut self) {
        let Some(mut job) = self.job.take() else { return };
        self.settings = job.settings.clone();
        self.updater = Updater::new(self.settings.limits());
        self.unread = std::mem::take(&mut job.repainted);
        let (field, mesh) = job.finished();
        if let Some(field) = field {
            self.field = field;
        }
        self.mesh = Arc::new(mesh);
        self.revision += 1;
        self.replaced = true;
        (self.lost_step, self.refill) = (false, false);
    }

    /// The field has changed within `area`; the mesh is to follow.
    fn note_repainted(&mut self, area: PixelRect) {
        match self.settings.rule {
            Rule::Area => self.updater.add(self.field.lattice_rect(area)),
            Rule::Vertex => self.lost_step = true,
        }
    }

    /// Whether the shown field is made from the same things as `wanted` asks for.
    fn reuses_field(&self, wanted: &Settings) -> bool {
        !self.refill
            && self.field.spec() == &wanted.field_spec()
            && wanted.lattice().as_ref() == Ok(self.mesh.lattice())
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
                self.job = None;
                self.unread.clear();
                self.lost_step = true;
                self.refill = true;
            }
        }
    }
}

impl Job {
    fn new(settings: &Settings, reuse_field: bool) -> Result<Self, FollowError> {
        let lattice = settings.lattice().map_err(CoarseError::from)?;
        let field = (!reuse_field).then(|| TargetField::new(settings.field_spec(), &lattice));
        let refining = if field.is_none() { Some(Refining::new(settings)?) } else { None };
        Ok(Self { settings: settings.clone(), field, refining, repainted: Vec::new() })
    }

    /// One slice of filling or refining.
    fn advance(
        &mut self,
        document: &Document,
        shown: Option<&TargetField>,
        visits: usize,
    ) -> Result<Progress, FollowError> {
        let Some(refining) = &mut self.refining else {
            let field = self.field.as_mut().expect("a job without a field of its own starts refining");
            if field.fill(document.layers().as_paint(), visits)? == Progress::Done {
                self.refining = Some(Refining::new(&self.settings)?);
            }
            return Ok(Progress::More);
        };
        let field =
            self.field.as_ref().or(shown).expect("a job without a field of its own reuses the shown one");
        Ok(refining.advance(field, document, self.settings.rule, visits)?)
    }

    fn finished(self) -> (Option<TargetField>, Mesh) {
        let refining = self.refining.expect("a job is done when refining is");
        (self.field, refining.mesh)
    }
}

impl Refining {
    fn new(settings: &Settings) -> Result<Self, FollowError> {
        let domain = &settings.domain;
        let contains = |point| domain.contains(point);
        let limits = settings.limits();
        let mesh = Mesh::coarse_grid(domain.bounds, settings.spacing, contains, &limits)?;
        let refiner = Refiner::new(&mesh, limits);
        Ok(Self { mesh, refiner, known: Vec::new() })
    }

    fn advance(
        &mut self,
        field: &TargetField,
        document: &Document,
        rule: Rule,
        visits: usize,
    ) -> Result<Progress, RefineError> {
        match rule {
            Rule::Area => self.refiner.run(&mut self.mesh, |element| Ok(field.exceeds(element)), visits),
            Rule::Vertex => {
                let paint = document.layers().as_paint();
                let target = |point| field.target_at_node(paint, point);
                let mut rule = VertexRule::resumed(target, std::mem::take(&mut self.known));
                let progress = self.refiner.run(&mut self.mesh, |element| rule.exceeds(element), visits);
                self.known = rule.into_known();
                progress
            }
        }
    }
}
