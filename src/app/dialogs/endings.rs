//! The ending that files of each kind of the open document had last.

use std::collections::BTreeMap;
use std::path::Path;

use meshbrush_kit::kit::FileRequest;
use meshbrush_kit::kit::document_id::DocumentId;

/// Endings by the titles of kinds of files, of one document.
#[derive(Clone, Debug, Default)]
pub struct LastEndings {
    document: Option<DocumentId>,
    by_kind: BTreeMap<&'static str, &'static str>,
}

impl LastEndings {
    /// Returns the ending to propose, without the dot: the last one, or else the default one of the kind.
    pub fn of(&self, request: FileRequest, document: DocumentId) -> &'static str {
        let last = self.by_kind.get(request.title).filter(|_| self.document == Some(document));
        last.copied().unwrap_or_else(|| (request.endings)().first().copied().unwrap_or_default())
    }

    /// Notes the ending of an answer.
    pub fn note(&mut self, request: FileRequest, document: DocumentId, path: &Path) {
        if self.document != Some(document) {
            *self = Self { document: Some(document), ..Self::default() };
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let endings = (request.endings)().into_iter().filter(|ending| name.ends_with(&format!(".{ending}")));
        if let Some(ending) = endings.max_by_key(|ending| ending.len()) {
            self.by_kind.insert(request.title, ending);
        }
    }
}
