//! Why a command did not do its work.

use std::io;
use std::path::PathBuf;

use super::mesh_by_error_failure::MeshByErrorFailure;
use meshbrush_core::build::BuildError;
use meshbrush_core::field::TransferError;
use meshbrush_core::layers::NoDepth;
use meshbrush_core::path::PathError;
use meshbrush_io::io::ReadError;
use meshbrush_io::io::recipe::LoadError;
use meshbrush_mesh::mesh::{CoarseError, InvalidTarget, RefineError};
use meshbrush_mesh::text::abridged;

/// Why a command did not do its work. Each prints as one sentence; a formula's mistake adds the lines that
/// point at it.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The arguments make no sense.
    #[error("{0}")]
    Usage(String),
    /// The curve from risk to diameter is impossible.
    #[error(transparent)]
    Transfer(#[from] TransferError),
    /// A file given as input cannot be used.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// There is no mesh.
    #[error("{0}{advice}", advice = advice(.0))]
    Build(#[from] BuildError),
    /// There is no path.
    #[error(transparent)]
    Path(#[from] PathError),
    /// There is no solution.
    #[error(transparent)]
    Solve(#[from] MeshByErrorFailure),
    /// A file could not be written.
    #[error("{} cannot be written: {problem}.", abridged(&file.display().to_string()))]
    Write {
        /// The file as it was named.
        file: PathBuf,
        /// The operating system's message.
        problem: String,
    },
    /// Standard output is closed or full.
    #[error("The result cannot be printed: {0}.")]
    Print(io::Error),
    /// The mesh or the field is not as it must be; the sentence says what.
    #[error("{0}")]
    Work(String),
}

impl Failure {
    /// 2 for wrong usage, 1 for work that failed.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Usage(_) | Self::Transfer(_) => 2,
            _ => 1,
        }
    }

    /// Returns whether the reader of standard output has simply seen enough, as `head` does.
    pub fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::Print(e) if e.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Returns advice against an error, as a further sentence.
fn advice(error: &BuildError) -> &'static str {
    match error {
        BuildError::Refine(RefineError::TooManyTriangles { .. }) => {
            " Raise the smallest diameter, or the limit with --max-triangles."
        }
        BuildError::Refine(RefineError::TooMuchMemory { .. }) => {
            " Raise the smallest diameter, or the limit with --max-memory."
        }
        BuildError::Refine(RefineError::TooFine { .. }) => {
            " Raise the smallest diameter, or mesh a smaller domain."
        }
        BuildError::Refine(RefineError::OutOfMemory { .. } | RefineError::Rule(_))
        | BuildError::Coarse(_)
        | BuildError::InvalidLayer(_)
        | BuildError::InvalidTarget(_) => "",
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::Read(error) => error.into(),
            LoadError::Coarse(error) => error.into(),
            LoadError::Data(_) | LoadError::Value(_) | LoadError::Unsuited(_) => {
                Self::Work(error.to_string())
            }
        }
    }
}

impl From<NoDepth> for Failure {
    fn from(error: NoDepth) -> Self {
        Self::Work(error.to_string())
    }
}

impl From<CoarseError> for Failure {
    fn from(error: CoarseError) -> Self {
        Self::Build(error.into())
    }
}

impl From<InvalidTarget> for Failure {
    fn from(error: InvalidTarget) -> Self {
        Self::Build(error.into())
    }
}
