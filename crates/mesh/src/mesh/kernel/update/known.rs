//! What is known of marked triangles, until they are bisected.

use crate::mesh::kernel::{LevelsWithin, TriangleId};

/// A small cache of the known answers for the triangles within an entry of the mesh.
///
/// A triangle may be bisected together with the one across its bisection edge before the work list reaches
/// it: its children inherit through this cache what is known about it. An entry that was replaced is asked
/// about again.
#[derive(Clone, Debug)]
pub(super) struct KnownLevels {
    /// The entry and the answers, at the place from the last bits of the entry's number; empty without any.
    answers: Vec<(TriangleId, LevelsWithin)>,
}

/// The number of entries: more than twice those of a batch.
const SIZE: usize = 1 << 13;

impl KnownLevels {
    pub(super) const EMPTY: Self = Self { answers: Vec::new() };

    /// Forgets everything: the rule is another one, or entries have moved.
    pub(super) fn clear(&mut self) {
        self.answers.clear();
    }

    #[inline]
    pub(super) fn of(&self, id: TriangleId) -> LevelsWithin {
        match self.answers.get(id.index() % SIZE) {
            Some(&(entry, known)) if entry == id => known,
            _ => LevelsWithin::UNKNOWN,
        }
    }

    #[inline]
    pub(super) fn set(&mut self, id: TriangleId, known: LevelsWithin) {
        if self.answers.is_empty() {
            self.answers.resize(SIZE, (TriangleId::from_index(0), LevelsWithin::UNKNOWN));
        }
        self.answers[id.index() % SIZE] = (id, known);
    }
}
