//! The pieces of the document's boundary, for the tool that shows and names them. They are found on another
//! thread: an outline of many corners takes longer than a frame.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use eframe::egui::Context;

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

/// The pieces that were found last, and those that are being found.
#[derive(Default)]
pub struct BoundaryFinder {
    found: Option<(Key, BoundaryPieces)>,
    running: Option<(Key, Receiver<BoundaryPieces>)>,
}

impl BoundaryFinder {
    /// The pieces of the document; `None` until they are found.
    pub fn pieces(&self, document: &Document) -> Option<&BoundaryPieces> {
        let settings = document.settings();
        let is_current = |key: &Key| key.domain == settings.domain && key.marks == settings.boundary_marks;
        self.found.as_ref().filter(|(key, _)| is_current(key)).map(|(_, pieces)| pieces)
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
        self.take(Duration::ZERO);
        let is_of_mesh = document.settings().domain.formula().is_some();
        if is_of_mesh && !follower.is_in_step(document) {
            return false;
        }
        let settings = document.settings();
        let (domain, marks) = (settings.domain.clone(), settings.boundary_marks.clone());
        let key = Key { domain, marks, revision: is_of_mesh.then(|| follower.revision()) };
        if self.found.as_ref().is_some_and(|(found, _)| *found == key) {
            return false;
        }
        if self.running.is_none() {
            self.start(key, follower, ctx);
        }
        self.take(patience);
        self.running.is_some()
    }

    fn start(&mut self, key: Key, follower: &Follower, ctx: &Context) {
        let (sender, result) = channel();
        let (Key { domain, marks, revision }, ctx) = (key.clone(), ctx.clone());
        let mesh = revision.map(|_| follower.shared_mesh());
        thread::spawn(move || {
            let pieces = match mesh {
                Some(mesh) => BoundaryPieces::of_mesh(&mesh.extract(), &marks),
                None => BoundaryPieces::of_domain(&domain, &marks).expect("it is given by no formula"),
            };
            // The receiver is gone when the window is closed.
            let _ = sender.send(pieces);
            ctx.request_repaint();
        });
        self.running = Some((key, result));
    }

    /// Takes what was found.
    fn take(&mut self, patience: Duration) {
        let Some((_, result)) = &self.running else { return };
        let found = result.recv_timeout(patience);
        if !matches!(found, Err(RecvTimeoutError::Timeout)) {
            let key = self.running.take().map(|(key, _)| key);
            self.found = key.zip(found.ok());
        }
    }
}
