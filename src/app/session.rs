//! The document, the mesh that follows it, and the point that was asked about.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec2;

use super::readout::{Quantity, Readout};
use super::widgets::format;
use crate::build::BuildError;
use crate::document::{Document, Follower, MeshChange, Pricer, Setting, Stage};
use crate::mesh::{Mesh, NodeId, Numbering, Progress, RefineError, Survey, Topology, TriangleId};
use crate::paint::Brush;
use crate::text::Bytes;

/// Pixels or triangles in one slice of work: well below a millisecond.
const SLICE: usize = 2048;

/// A message that stays on the canvas until it is dismissed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Whether something failed, or is just to be known.
    pub failed: bool,
    /// A sentence.
    pub text: String,
}

/// What the window works on.
pub struct Session {
    document: Document,
    follower: Follower,
    pricer: Pricer,
    queried: Option<DVec2>,
    notice: Option<Notice>,
    /// That the mesh stopped short of the document: shown as long as this is so.
    standing: Option<Notice>,
    work: Duration,
    last_update: Option<Duration>,
    survey: Surveyed,
}

/// The shape of the mesh, and the numbers in its files, as far as they are known.
#[derive(Default)]
struct Surveyed {
    /// The revision of the mesh that the rest is about.
    revision: Option<u64>,
    under_way: Option<Survey>,
    found: Option<(Topology, Numbering)>,
}

impl Session {
    /// Opens a document, and makes its mesh in one go.
    ///
    /// # Errors
    /// When it has none.
    pub fn new(mut document: Document) -> Result<Self, BuildError> {
        let began = Instant::now();
        let follower = Follower::new(&mut document)?;
        Ok(Self {
            document,
            follower,
            pricer: Pricer::default(),
            queried: None,
            notice: None,
            standing: None,
            work: Duration::ZERO,
            last_update: Some(began.elapsed()),
            survey: Surveyed::default(),
        })
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The document, to be edited.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.document
    }

    /// Field and mesh as far as they are in step.
    pub fn follower(&self) -> &Follower {
        &self.follower
    }

    /// The mesh on the screen.
    pub fn mesh(&self) -> &Mesh {
        self.follower.mesh()
    }

    /// The mesh on the screen, for work that outlasts a frame.
    pub fn shared_mesh(&self) -> Arc<Mesh> {
        self.follower.shared_mesh()
    }

    /// Triangles per level of the mesh on the screen.
    pub fn level_counts(&self) -> Vec<usize> {
        self.mesh().level_counts()
    }

    /// Time that the last whole update took, all slices together.
    pub fn last_update(&self) -> Option<Duration> {
        self.last_update
    }

    /// What is left to do.
    pub fn stage(&self) -> Stage {
        self.follower.stage()
    }

    /// The message to be shown.
    pub fn notice(&self) -> Option<&Notice> {
        self.notice.as_ref().or(self.standing.as_ref())
    }

    /// Whether the message to be shown cannot be dismissed: it goes once mesh and document agree.
    pub fn notice_stands(&self) -> bool {
        self.notice.is_none() && self.standing.is_some()
    }

    /// Shows a message, or none.
    pub fn set_notice(&mut self, notice: Option<Notice>) {
        self.notice = notice;
    }

    /// Takes away what was only to be known; what failed stays until it is dismissed.
    pub fn put_news_away(&mut self) {
        self.notice.take_if(|notice| !notice.failed);
    }

    /// Shows a failure.
    pub fn report(&mut self, failure: impl std::fmt::Display) {
        self.notice = Some(Notice { failed: true, text: failure.to_string() });
    }

    /// Changes a setting; what cannot be met is reported, and the document stays as it was.
    pub fn set(&mut self, setting: Setting) {
        match self.document.set(setting) {
            Ok(()) => self.notice = None,
            Err(error) => self.report(error),
        }
    }

    /// Gives up the update under way. The document keeps what was edited; the notice says that the mesh lags behind.
    pub fn cancel_update(&mut self) {
        self.follower.cancel(&self.document);
        let text =
            "The mesh was not updated: it still shows an earlier state. The next edit brings it up to date.";
        self.notice = Some(Notice { failed: false, text: text.into() });
    }

    /// Asks about a point in world units, or about none.
    pub fn query(&mut self, point: Option<DVec2>) {
        self.queried = point;
    }

    /// What is to be said of the queried point, in the present mesh.
    pub fn readout(&self, quantity: Quantity) -> Option<Readout> {
        self.queried.map(|point| Readout::at(point, &self.document, &self.follower, quantity))
    }

    /// Draws the stroke under way, and brings field and mesh nearer to the document until `deadline`; tells whether work is left.
    ///
    /// What turns out to be impossible is reported. A setting that caused it is taken back; paint stays, to be undone or
    /// thinned out by whoever painted it.
    pub fn follow(&mut self, deadline: Instant) -> bool {
        let began = Instant::now();
        let revision = self.follower.revision();
        let left = loop {
            if self.document.advance_stroke(SLICE) == Progress::More && Instant::now() < deadline {
                continue;
            }
            match self.follower.advance(&mut self.document, SLICE) {
                Ok(stage) if stage.is_settled() => break false,
                Ok(_) if Instant::now() >= deadline => break true,
                Ok(_) => {}
                Err(error) => {
                    self.take_back(&error);
                    break true;
                }
            }
        };
        if self.follower.stopped().is_none() {
            self.standing = None;
        }
        let left = left || !self.document.is_stroke_drawn();
        let changed = self.follower.revision() != revision;
        if left || changed {
            self.work += began.elapsed();
        }
        if !left && self.work > Duration::ZERO {
            self.last_update = Some(std::mem::take(&mut self.work));
        }
        left || self.survey(deadline)
    }

    /// Nodes, parts and holes of the mesh on the screen, where some triangles lie outside; `None` until they are counted.
    pub fn topology(&self) -> Option<Topology> {
        self.found().map(|(topology, _)| *topology)
    }

    /// The number that a triangle has in files; `None` until it is counted, and for one outside.
    pub fn triangle_number(&self, id: TriangleId) -> Option<usize> {
        self.in_files(id, Numbering::triangle).map(TriangleId::index)
    }

    /// The number that a node has in files; `None` until it is counted, and for one outside.
    pub fn node_number(&self, id: NodeId) -> Option<usize> {
        self.in_files(id, Numbering::node).map(NodeId::index)
    }

    /// Where everything is in the domain, files have the ids of the mesh.
    fn in_files<I>(&self, id: I, number: fn(&Numbering, I) -> Option<I>) -> Option<I> {
        if self.mesh().outside_count() == 0 {
            return Some(id);
        }
        let (_, numbering) = self.found()?;
        number(numbering, id)
    }

    fn found(&self) -> Option<&(Topology, Numbering)> {
        self.survey.found.as_ref().filter(|_| self.survey.revision == Some(self.follower.revision()))
    }

    /// Counts parts, holes and numbers until `deadline`, where the mesh is at rest and has them; tells whether work is left.
    fn survey(&mut self, deadline: Instant) -> bool {
        let mesh = self.follower.mesh();
        let revision = Some(self.follower.revision());
        if self.survey.revision != revision {
            let under_way = (mesh.outside_count() > 0).then(|| Survey::new(mesh));
            self.survey = Surveyed { revision, under_way, found: None };
        }
        let Some(survey) = &mut self.survey.under_way else { return false };
        while survey.advance(mesh, SLICE) == Progress::More {
            if Instant::now() >= deadline {
                return true;
            }
        }
        self.survey.found = Some((survey.topology(mesh), survey.numbering()));
        self.survey.under_way = None;
        false
    }

    /// Works out what a dab would cost, until `deadline`, and tells whether work is left. `None` gives up.
    pub fn price_dab(&mut self, dab: Option<(Brush, DVec2)>, deadline: Instant) -> bool {
        self.pricer.ask(dab, &self.document, &self.follower);
        while self.pricer.progress() == Progress::More && Instant::now() < deadline {
            self.pricer.advance(&self.document, &self.follower, SLICE);
        }
        self.pricer.progress() == Progress::More
    }

    /// What the dab asked about would cost.
    pub fn pricer(&self) -> &Pricer {
        &self.pricer
    }

    /// What became of the mesh since this was last asked.
    pub fn take_mesh_change(&mut self) -> Option<MeshChange> {
        self.follower.take_change()
    }

    /// Takes back the setting that made a mesh impossible; where it is paint that did, the mesh stands still, and that is said.
    fn take_back(&mut self, error: &BuildError) {
        let revision = self.document.revision();
        if self.document.settings() != self.follower.settings() {
            self.document.reject_last();
        }
        if self.document.revision() != revision {
            self.report(format!("{error}{}", advice(error)));
        } else {
            let former = self.document.settings() != self.follower.settings();
            let text = if former {
                format!("{error}{} Until then the former mesh is shown.", advice(error))
            } else {
                standstill(error)
            };
            self.standing = Some(Notice { failed: true, text });
        }
    }
}

/// What would help against an error, as a further sentence.
fn advice(error: &BuildError) -> &'static str {
    match error {
        BuildError::Refine(RefineError::TooFine { .. }) => {
            " Raise the smallest diameter, or mesh a smaller domain."
        }
        BuildError::Refine(error) if error.is_over_budget() => {
            " Raise the smallest diameter, paint less, or raise the limit."
        }
        _ => "",
    }
}

/// What to say while the mesh does not show all that was painted.
fn standstill(error: &BuildError) -> String {
    let kept = "what you painted is kept, but the mesh does not show all of it.";
    let helps = "in the Mesh panel or the smallest diameter, erase, or undo.";
    match error {
        BuildError::Refine(RefineError::TooManyTriangles { limit }) => {
            let limit = format::count(*limit as u64);
            format!(
                "The mesh stops at its limit of {limit} triangles: {kept} Raise the triangle budget {helps}"
            )
        }
        BuildError::Refine(RefineError::TooMuchMemory { memory, .. }) => {
            let limit = Bytes(memory.bytes);
            format!(
                "The mesh stops at its limit of {limit} of memory: {kept} Raise the memory budget {helps}"
            )
        }
        other => format!("{other}{} Until then {kept}", advice(other)),
    }
}
