use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::Cancelled;
use crate::raster::MAX_SIDE;
use crate::text::Grouped;

/// Why a file could not be used: which file, where in it, and what is wrong there.
#[derive(Debug, thiserror::Error)]
#[error("{}{place}: {flaw}", file.display())]
pub struct ReadError {
    /// The file as it was named.
    pub file: PathBuf,
    /// Where in the file.
    pub place: Place,
    /// What is wrong there.
    #[source]
    pub flaw: Flaw,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    Whole,
    /// A line, counted from one.
    Line(usize),
    /// A file within the file, and the line there if it is one of text.
    Part(&'static str, Option<usize>),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line(line) => write!(f, ", line {line}"),
            Self::Part(part, None) => write!(f, ", {part} in it"),
            Self::Part(part, Some(line)) => write!(f, ", line {line} of {part} in it"),
        }
    }
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum Flaw {
    /// The operating system says no.
    #[error("cannot be read ({0})")]
    Io(#[from] io::Error),
    /// The file ends before everything it promises has come.
    #[error("the file ends too early; it seems to be cut off. Copy or export it again.")]
    CutOff,
    /// What was stored and what is found differ.
    #[error("the file is damaged: what it holds and its checksum do not agree. Use another copy.")]
    Damaged,
    /// The decoder of images refuses it.
    #[error("this is not a PNG image that can be read ({0}). Export it again as PNG.")]
    Png(String),
    /// A raster that would take too much memory.
    #[error(
        "{} × {} pixels cannot be taken: a raster has 1 to {} pixels along each side. Scale it \
         first.",
        Grouped(*columns as usize), Grouped(*rows as usize), Grouped(MAX_SIDE as usize)
    )]
    Size {
        /// Columns that the file announces.
        columns: u64,
        /// Rows that the file announces.
        rows: u64,
    },
    /// The text breaks a rule of its format; the sentence says which.
    #[error("{0}")]
    Syntax(String),
}

impl Flaw {
    /// The flaw, at a line counted from one.
    pub(super) fn at(self, line: usize) -> PlacedFlaw {
        PlacedFlaw { place: Place::Line(line), flaw: self }
    }
}

impl From<Cancelled> for Flaw {
    fn from(cancelled: Cancelled) -> Self {
        Self::Io(cancelled.into())
    }
}

/// A flaw before it is known which file has it.
#[derive(Debug)]
pub(super) struct PlacedFlaw {
    pub(super) place: Place,
    pub(super) flaw: Flaw,
}

impl PlacedFlaw {
    /// The flaw as one of a file within the file.
    pub(super) fn within(self, part: &'static str) -> Self {
        let line = if let Place::Line(line) = self.place { Some(line) } else { None };
        Self { place: Place::Part(part, line), flaw: self.flaw }
    }

    pub(super) fn in_file(self, file: &Path) -> ReadError {
        ReadError { file: file.to_owned(), place: self.place, flaw: self.flaw }
    }
}

impl<F: Into<Flaw>> From<F> for PlacedFlaw {
    fn from(flaw: F) -> Self {
        Self { place: Place::Whole, flaw: flaw.into() }
    }
}

/// At most so many characters of what stands in a file, which may be a whole file long.
pub(super) fn shown(most: usize, text: &str) -> String {
    let start: String = text.chars().take(most).collect();
    let more = if text.chars().nth(most).is_some() { "…" } else { "" };
    format!("{}{more}", start.escape_debug())
}
