//! The document, the mesh that follows it, edits on their way to the document, and the queried point.

mod edits;
mod following;
mod prices;
mod shown;

use std::cell::RefCell;

use glam::DVec2;

use super::ages::AgeKeeper;
use super::boundary::BoundaryFinder;
use super::brake::GrowthGuard;
use super::clock::{Duration, Instant};
use super::cuts::PolygonEditQueue;
use super::derivation::Derivation;
use super::document_id::DocumentId;
use super::heights::HeightFinder;
use super::notices::Notices;
use super::size_change::SizeChange;
use meshbrush_core::build::BuildError;
use meshbrush_core::document::{Document, Follower, MeshChange, Pace, Pricer, Readings};
use meshbrush_mesh::mesh::Mesh;

/// A document and its mesh in the window.
pub struct Session {
    live: LiveDocument,
    guards: Guards,
    derived: DerivedData,
    query: Query,
    clock: UpdateClock,
    notices: Notices,
}

/// A document, and the field and the mesh that follow it.
struct LiveDocument {
    document: Document,
    document_id: DocumentId,
    follower: Follower,
    /// The size of the slices in which the follower works.
    pace: Pace,
    /// A cache of values at points. It changes no result.
    readings: RefCell<Readings>,
    /// What was drawn and has not reached the document yet.
    cuts: PolygonEditQueue,
    /// The revision of the follower's mesh that stands for that of the document until that is made.
    bare_revision: Option<u64>,
}

/// The prices of what is about to be done, and what holds updates that are too large.
#[derive(Default)]
struct Guards {
    /// The price of the stroke that a click would paint.
    stroke: Pricer,
    /// The effect of the last edit of the size, and the price of the next.
    size: SizeChange,
    /// Holds updates that need very many triangles.
    brake: GrowthGuard,
}

/// What is computed from the follower's mesh.
#[derive(Default)]
struct DerivedData {
    /// The mesh along the outline of the domain.
    mesh: Derivation,
    boundary: BoundaryFinder,
    ages: AgeKeeper,
    heights: HeightFinder,
    /// The change of the follower's mesh since the canvas last took it.
    mesh_change: Option<MeshChange>,
}

/// The queried point.
#[derive(Default)]
struct Query {
    /// In world units.
    point: Option<DVec2>,
    /// The middles of the triangles on the way to the queried one, in world units.
    trail: Vec<DVec2>,
}

/// How long updates of the mesh take.
struct UpdateClock {
    /// When the update in progress began.
    began: Option<Instant>,
    last: Option<Duration>,
}

impl Session {
    /// Opens a document and builds its mesh in one step.
    ///
    /// # Errors
    /// Fails when no mesh can be built for it.
    pub fn new(mut document: Document) -> Result<Self, BuildError> {
        let began = Instant::now();
        document.record();
        let follower = Follower::new(&mut document)?;
        let live = LiveDocument {
            document,
            document_id: DocumentId::default(),
            follower,
            pace: Pace::default(),
            readings: RefCell::default(),
            cuts: PolygonEditQueue::default(),
            bare_revision: None,
        };
        Ok(Self {
            live,
            guards: Guards::default(),
            derived: DerivedData::default(),
            query: Query::default(),
            clock: UpdateClock { began: None, last: Some(began.elapsed()) },
            notices: Notices::default(),
        })
    }

    /// Returns the document.
    pub fn document(&self) -> &Document {
        &self.live.document
    }

    /// Which document is open.
    pub fn document_id(&self) -> DocumentId {
        self.live.document_id
    }

    /// Returns the document, to be edited.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.live.document
    }

    /// Returns field and mesh as far as they are up to date.
    pub fn follower(&self) -> &Follower {
        &self.live.follower
    }

    /// Returns the mesh of the follower, which the derived mesh differs from along an outline.
    pub fn mesh(&self) -> &Mesh {
        self.live.follower.mesh()
    }

    /// Replaces the document by another one. This cannot be undone. Until its mesh is made, its bare
    /// rectangle takes the place of the former mesh.
    pub fn replace_document(&mut self, document: Document) {
        self.live.cuts.discard(&mut self.live.document);
        self.live.document.replace_with(document);
        self.live.document_id = self.live.document_id.next();
        self.live.follower.show_bare(&self.live.document);
        self.live.bare_revision = Some(self.live.follower.revision());
        // Its triangles can be a thousand times as dear.
        self.live.pace = Pace::default();
        self.guards.brake.release();
        self.guards.size = SizeChange::default();
        self.query(None);
        self.notices.dismiss();
    }

    /// Returns whether the document was just opened, and no mesh of it was made yet.
    pub fn awaits_mesh(&self) -> bool {
        self.live.bare_revision == Some(self.live.follower.revision())
    }

    /// Returns the messages on the canvas.
    pub fn notices(&self) -> &Notices {
        &self.notices
    }

    /// Returns the messages on the canvas, to dismiss them.
    pub fn notices_mut(&mut self) -> &mut Notices {
        &mut self.notices
    }

    /// Shows news.
    pub fn tell(&mut self, text: String) {
        self.notices.tell(text);
    }

    /// Shows a failure.
    pub fn report(&mut self, failure: impl std::fmt::Display) {
        self.notices.report(failure);
    }

    /// Shows that an edit failed. The next edit dismisses the message.
    pub(super) fn report_edit(&mut self, failure: impl std::fmt::Display) {
        self.notices.report_edit(self.live.document.version(), failure);
    }
}
