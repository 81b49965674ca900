use std::collections::BTreeSet;

use crate::layers::LayerId;

/// The edits of a document, with which a copy of it is kept up to date.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edits {
    /// Whether settings changed.
    pub settings: bool,
    /// Whether the document was replaced, so that the paint of every layer may differ.
    pub all_paint: bool,
    /// The layers on which pixels changed.
    pub layers: BTreeSet<LayerId>,
}

impl Edits {
    /// Returns whether nothing changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    pub(super) fn everything() -> Self {
        Self { settings: true, all_paint: true, layers: BTreeSet::new() }
    }
}
