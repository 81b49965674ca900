//! Another document takes the place of the one that is open.

use super::session::Session;
use super::size_change::SizeChange;
use meshbrush_core::document::{Document, Pace};

impl Session {
    /// Replaces the document by another one. This cannot be undone. Until its mesh is made, its bare
    /// rectangle takes the place of the former mesh.
    pub fn replace_document(&mut self, document: Document) {
        self.cuts.discard(&mut self.document);
        self.document.replace_with(document);
        self.document_id = self.document_id.next();
        self.follower.show_bare(&self.document);
        self.bare_revision = Some(self.follower.revision());
        // Its triangles can be a thousand times as dear.
        self.pace = Pace::default();
        self.brake.release();
        self.size_change = SizeChange::default();
        self.query(None);
        self.notices.dismiss();
    }

    /// Returns whether the document was just opened, and no mesh of it was made yet.
    pub fn awaits_mesh(&self) -> bool {
        self.bare_revision == Some(self.follower.revision())
    }
}
