//! The uses of files of data.

use super::{DataContents, DataFile, FileRequest, FrameState};

/// A use of a file of data: a row beside the [`FileKind`](super::FileKind) that reads the file.
pub struct DataRole {
    /// The order of roles in the dialog: those with a lower number come first.
    pub place: u8,
    /// The name of the role.
    pub title: &'static str,
    /// A sentence about what becomes of the file.
    pub sentence: &'static str,
    /// The kind of file whose command does it.
    pub kind: FileRequest,
    /// Whether a file of the right ending is of the right contents at all; otherwise the role is not listed.
    pub is_for: fn(&DataContents) -> bool,
    /// A sentence that says why the role is impossible for this file and document.
    pub refusal: fn(&DataFile, &FrameState<'_>) -> Option<String>,
}
