use crate::build::BuildError;

/// What a [`Follower`](super::Follower) is doing to bring the mesh in step with its document.
#[derive(Clone, Debug, PartialEq)]
pub enum Stage {
    /// Nothing: field and mesh are those of the document.
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
    /// Nothing, until the document changes: the mesh is not that of the document. The reason, or `None` where
    /// the work was cancelled.
    GaveUp(Option<BuildError>),
}

impl Stage {
    /// Whether nothing is left to do before the document changes: in step, or given up.
    pub fn is_settled(&self) -> bool {
        matches!(self, Self::InStep | Self::GaveUp(_))
    }
}
