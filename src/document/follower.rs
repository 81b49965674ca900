use std::sync::Arc;

use super::{Document, Repainted, Settings};
use crate::field::{Rule, TargetField, VertexRule};
use crate::mesh::{CoarseError, InvalidTarget, Mesh, Progress, RefineError, Refiner};

/// Keeps field and mesh in step with a document, in slices.
///
/// Every edit leads to a mesh made anew beside the one that is shown; the two change places when the new one is whole. So
/// nothing flickers, and whatever goes wrong, the former mesh is still there. (Updating the mesh in place is to come in
/// here: [`Self::advance`] is the one place that decides what an edit costs.)
#[derive(Clone, Debug)]
pub struct Follower {
    settings: Settings,
    field: TargetField,
    mesh: Arc<Mesh>,
    generation: u64,
    repainted: bool,
    /// All of the paint changed: the field is to be filled anew.
    refill: bool,
    job: Option<Job>,
    /// The revision of the document that could not be met: not tried again.
    given_up_on: Option<u64>,
}

/// A mesh in the making.
#[derive(Clone, Debug)]
struct Job {
    settings: Settings,
    /// A field in the making, where that of the shown mesh does not serve.
    field: Option<TargetField>,
    refining: Option<Refining>,
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
        Ok(Self {
            settings,
            field,
            mesh: Arc::new(mesh),
            generation: 0,
            repainted: false,
            refill: false,
            job: None,
            given_up_on: None,
        })
    }

    /// The last whole mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The last whole mesh, to be kept by work that takes longer than a frame.
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

    /// Grows whenever another mesh is shown.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// What is left to do.
    pub fn stage(&self) -> Stage {
        match &self.job {
            None => Stage::InStep,
            Some(Job { refining: None, .. }) => Stage::Filling,
            Some(Job { refining: Some(refining), .. }) => {
                Stage::Refining { triangles: refining.mesh.triangles().len() }
            }
        }
    }

    /// Gives up the work under way. The document may then differ from the mesh, until its next change.
    pub fn cancel(&mut self, document: &Document) {
        self.job = None;
        self.given_up_on = Some(document.revision());
    }

    /// Takes over what changed in the document, and does one slice of work: about `visits` pixels or triangles.
    ///
    /// A change of settings begins anew. Paint that changes under the work is taken over as it is, and once that mesh is
    /// shown another is made: during a long stroke the mesh follows at the pace at which meshes can be made.
    ///
    /// # Errors
    /// When the document has no mesh. The former one stays, and the document is not tried again until it changes.
    pub fn advance(&mut self, document: &mut Document, visits: usize) -> Result<Stage, FollowError> {
        self.take_over_paint(document);
        if self.given_up_on == Some(document.revision()) {
            return Ok(Stage::InStep);
        }
        let result = self.advance_job(document, visits);
        if result.is_err() {
            self.cancel(document);
        }
        result
    }

    fn advance_job(&mut self, document: &Document, visits: usize) -> Result<Stage, FollowError> {
        let wanted = document.settings();
        let outdated = self.job.as_ref().is_some_and(|job| job.settings != *wanted);
        let begin = self.job.is_none() && (self.repainted || self.settings != *wanted);
        if outdated || begin {
            self.repainted = false;
            let reuse_field = self.reuses_field(wanted);
            self.refill = false;
            self.job = Some(Job::new(wanted, reuse_field)?);
        }
        let Some(job) = &mut self.job else { return Ok(Stage::InStep) };
        if job.advance(document, Some(&self.field), visits)? == Progress::Done {
            self.show();
        }
        Ok(if self.repainted { Stage::Filling } else { self.stage() })
    }

    fn show(&mut self) {
        if let Some(job) = self.job.take() {
            self.settings = job.settings.clone();
            let (field, mesh) = job.finished();
            if let Some(field) = field {
                self.field = field;
            }
            self.mesh = Arc::new(mesh);
            self.generation += 1;
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
            Repainted::Within(area) if area.is_empty() => {}
            Repainted::Within(area) => {
                let paint = document.layers().as_paint();
                if paint.risk.size() == self.field.target().size() {
                    self.field.update(paint, area);
                }
                if let Some(field) = self.job.as_mut().and_then(|job| job.field.as_mut())
                    && paint.risk.size() == field.target().size()
                {
                    field.update(paint, area);
                }
                self.repainted = true;
            }
            Repainted::Everything => {
                self.job = None;
                self.repainted = true;
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
        Ok(Self { settings: settings.clone(), field, refining })
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
