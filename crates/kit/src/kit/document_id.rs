//! Which document of a window something belongs to.

/// Tells the documents apart that are opened in a window one after the other. Whatever is computed, read or
/// written beside the window carries the identity of the document that it is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct DocumentId(u64);

impl DocumentId {
    /// Returns the identity of the document that is opened next.
    pub fn next(self) -> Self {
        Self(self.0 + 1)
    }
}
