use std::io;
use std::path::PathBuf;

use crate::field::TransferError;
use crate::io::ReadError;
use crate::mesh::{CoarseError, InvalidTarget, RefineError};

/// Why a command did not do its work. Each prints as one sentence; a formula's mistake adds the lines that point at it.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The arguments make no sense.
    #[error("{0}")]
    Usage(String),
    /// The curve from risk to diameter is impossible.
    #[error(transparent)]
    Transfer(#[from] TransferError),
    /// A file given as input is of no use.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// No coarse mesh.
    #[error(transparent)]
    Coarse(#[from] CoarseError),
    /// The refinement could not end.
    #[error("{0}{advice}", advice = advice(.0))]
    Refine(#[from] RefineError),
    /// A file could not be written.
    #[error("{} cannot be written: {problem}.", file.display())]
    Write {
        /// The file as it was named.
        file: PathBuf,
        /// What the operating system says.
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

    /// Whether the reader of standard output has simply seen enough, as `head` does.
    pub fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::Print(e) if e.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// What would help, as a further sentence.
fn advice(error: &RefineError) -> &'static str {
    match error {
        RefineError::InvalidTarget(_) => "",
        RefineError::TooManyTriangles { .. } => {
            " Raise the smallest diameter, or the limit with --max-triangles."
        }
        RefineError::TooMuchMemory { .. } => " Raise the smallest diameter, or the limit with --max-memory.",
        RefineError::TooFine { .. } => " Raise the smallest diameter, or mesh a smaller domain.",
    }
}

impl From<InvalidTarget> for Failure {
    fn from(error: InvalidTarget) -> Self {
        Self::Refine(error.into())
    }
}
