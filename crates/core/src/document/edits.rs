use std::collections::BTreeSet;

use crate::layers::LayerId;

/// What was edited in a document, to keep a copy of it up to date.
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
    /// Whether nothing changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    pub(super) fn everything() -> Self {
        Self { settings: true, all_paint: true, layers: BTreeSet::new() }
    }
}
