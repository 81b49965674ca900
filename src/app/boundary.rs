//! The pieces of the document's boundary, for the tool that shows and names them. They are found on another
//! thread: an outline of many corners takes longer than a frame.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::Context;

use super::latest::Latest;
use crate::document::{Document, Follower};
use crate::domain::{BoundaryMarks, BoundaryPieces, Domain};

/// What pieces were found for.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    domain: Domain,
    marks: Arc<BoundaryMarks>,
    /// That of the mesh, for a domain whose boundary is that of its mesh.
    revision: Option<u64>,
}

/// Finds the pieces of the boundary.
#[derive(Default)]
pub struct BoundaryFinder(Latest<Key, BoundaryPieces>);

impl BoundaryFinder {
    /// The pieces of the document; `None` until they are found.
    pub fn pieces(&self, document: &Document) -> Option<&BoundaryPieces> {
        let settings = document.settings();
        let is_current = |key: &Key| key.domain == settings.domain && key.marks == settings.boundary_marks;
        self.0.last().filter(|(key, _)| is_current(key)).map(|(_, pieces)| pieces)
    }

    /// Finds the pieces of the document, and waits for them up to `patience`. Returns whether some are being
    /// found.
    pub fn advance(
        &mut self,
        document: &Document,
        follower: &Follower,
        patience: Duration,
        ctx: &Context,
    ) -> bool {
        self.0.take(Duration::ZERO);
        let is_of_mesh = document.settings().domain.formula().is_some();
        if is_of_mesh && !follower.is_in_step(document) {
            return false;
        }
        let settings = document.settings();
        let (domain, marks) = (settings.domain.clone(), settings.boundary_marks.clone());
        let key = Key { domain, marks, revision: is_of_mesh.then(|| follower.revision()) };
        if !self.0.has(&key) {
            let Key { domain, marks, revision } = key.clone();
            let mesh = revision.map(|_| follower.shared_mesh());
            let find = move || match mesh {
                Some(mesh) => BoundaryPieces::of_mesh(&mesh.extract(), &marks),
                None => BoundaryPieces::of_domain(&domain, &marks).expect("it is given by no formula"),
            };
            self.0.start(key, find, ctx);
        }
        self.0.take(patience)
    }
}
