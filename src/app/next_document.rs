//! Another document takes the place of the one that is open. Of the former one nothing is left in the window:
//! tools, view, canvas and features say what they keep and reset everything else, so that a part added to
//! them later is reset too.

use super::App;
use super::canvas::Canvas;
use meshbrush_core::document::Document;

impl App {
    /// Opens another document in place of the current one. This cannot be undone:
    /// [`meshbrush_kit::kit::project::ProjectFile::ask_before_leaving`] asks before edits are lost.
    pub(super) fn show_document(&mut self, document: Document) {
        self.session.replace_document(document);
        self.jobs.work_for(self.session.document_id());
        let settings = self.session.document().settings();
        let (extent, h_min) = (settings.domain.bounds.size().max_element(), settings.transfer.h_min);
        self.tools = self.tools.clone().for_next_document(extent, h_min);
        self.view = self.view.clone().for_next_document();
        self.features = std::mem::take(&mut self.features).for_next_document();
        let no_canvas = Canvas::new(None, &self.jobs);
        self.canvas = std::mem::replace(&mut self.canvas, no_canvas).for_next_document();
    }
}
