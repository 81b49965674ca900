//! How many edits ago triangles came: follows the session's edits and its mesh.

use crate::kit::clock::Instant;

use meshbrush_core::document::{Document, MeshChange};
use meshbrush_core::explain::{Ages, AgesNow};
use meshbrush_mesh::mesh::{Mesh, Progress};

/// Triangles that are looked at between two looks at the clock.
const SLICE: usize = 1 << 16;

/// Keeps the ages of triangles.
#[derive(Default)]
pub struct AgeKeeper {
    ages: Ages,
    /// The version of the document at the last look.
    version: u64,
    was_in_gesture: bool,
    /// Whether the next change of the mesh belongs to another edit than the last one.
    is_new_edit: bool,
}

impl AgeKeeper {
    /// Finds out whether another edit has begun since the last look.
    pub fn look_at(&mut self, document: &Document) {
        let (version, is_in_gesture) = (document.version(), document.is_in_gesture());
        // A gesture gets its version when it ends: that is no other edit.
        if !self.was_in_gesture && (is_in_gesture || version != self.version) {
            self.is_new_edit = true;
        }
        (self.version, self.was_in_gesture) = (version, is_in_gesture);
    }

    /// Takes in a change of the mesh.
    pub fn note(&mut self, change: &MeshChange, mesh: &Mesh) {
        match change {
            MeshChange::Replaced => self.ages.clear(),
            MeshChange::Within(changes) => {
                if std::mem::take(&mut self.is_new_edit) {
                    self.ages.begin_edit();
                }
                self.ages.note(changes, mesh);
            }
        }
    }

    /// Looks at triangles of a mesh that is new to it until `deadline`. Returns whether work is left.
    pub fn advance(&mut self, mesh: &Mesh, deadline: Instant) -> bool {
        while self.ages.advance(mesh, SLICE) == Progress::More {
            if Instant::now() >= deadline {
                return true;
            }
        }
        false
    }

    /// Returns the ages as they are, for another thread.
    pub fn snapshot(&self) -> AgesNow {
        self.ages.snapshot()
    }
}
