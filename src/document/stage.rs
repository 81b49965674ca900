use crate::mesh::{CoarseError, InvalidTarget, RefineError};

/// How far a [`Follower`](super::Follower) is behind its document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// Not at all.
    InStep,
    /// The outline of the domain is being laid on the lattice.
    Outlining,
    /// The field is being sampled.
    Filling,
    /// The mesh is being refined; so far it has this many triangles.
    Refining {
        /// Triangles so far.
        triangles: usize,
    },
}

/// Why no mesh could be made of a document. The former mesh is still shown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FollowError {
    /// The coarse grid is impossible, or empty.
    #[error(transparent)]
    Coarse(#[from] CoarseError),
    /// h̄ is no length somewhere.
    #[error(transparent)]
    InvalidTarget(#[from] InvalidTarget),
    /// A limit was reached.
    #[error(transparent)]
    Refine(#[from] RefineError),
}
