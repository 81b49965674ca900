use crate::build::BuildError;

/// The work of a [`Follower`](super::Follower) that brings the mesh up to date with its document.
#[derive(Clone, Debug, PartialEq)]
pub enum Stage {
    /// No work: field and mesh are those of the document.
    InStep,
    /// The outline of the domain is indexed on the lattice.
    Indexing,
    /// The formulas of the layers are checked.
    Checking,
    /// The mesh is copied, because an export holds it; so far this many triangles.
    Copying {
        /// Triangles so far.
        triangles: usize,
    },
    /// The mesh is refined; so far it has this many triangles.
    Refining {
        /// Triangles so far.
        triangles: usize,
    },
    /// No work until the document changes, although the mesh is not up to date. The error, or `None` if the
    /// work was cancelled.
    GaveUp(Option<BuildError>),
}

impl Stage {
    /// Returns whether nothing is left to do before the document changes: in step, or given up.
    pub fn is_settled(&self) -> bool {
        matches!(self, Self::InStep | Self::GaveUp(_))
    }
}
