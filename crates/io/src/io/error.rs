//! Errors of readers: the file, the place in it, and the flaw there.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::Cancelled;
use meshbrush_core::raster::{LONGEST_SIDE, MOST_PIXELS};
use meshbrush_mesh::text::{Grouped, abridged};

/// The reason why a file could not be used: the file, the place in it, and the mistake.
#[derive(Debug, thiserror::Error)]
#[error("{}{place}: {flaw}", file.display())]
pub struct ReadError {
    /// The file as it was named.
    pub file: PathBuf,
    /// The place in the file.
    pub place: PlaceInFile,
    /// The mistake at this place.
    #[source]
    pub flaw: Flaw,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceInFile {
    /// The file as a whole.
    Whole,
    /// A line, counted from one.
    Line(usize),
    /// A line and a column, counted from one; columns in characters.
    Column {
        /// The line.
        line: usize,
        /// The character in the line.
        column: usize,
    },
    /// A part of an archive, and the line in it if it is text.
    Part(&'static str, Option<usize>),
}

impl fmt::Display for PlaceInFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line(line) => write!(f, ", line {line}"),
            Self::Column { line, column } => write!(f, ", line {line}, column {column}"),
            Self::Part(part, None) => write!(f, ", {part} in it"),
            Self::Part(part, Some(line)) => write!(f, ", line {line} of {part} in it"),
        }
    }
}

/// A mistake in a file.
#[derive(Debug, thiserror::Error)]
pub enum Flaw {
    /// An error of the operating system.
    #[error("cannot be read ({0})")]
    Io(#[from] io::Error),
    /// The file ends before all announced data.
    #[error("the file ends too early; it seems to be cut off. Copy or export it again.")]
    CutOff,
    /// The content and its checksum differ.
    #[error("the file is damaged: its content does not match its checksum. Use another copy.")]
    Damaged,
    /// The PNG decoder refuses it.
    #[error("this is not a PNG image that can be read ({}). Export it again as PNG.", abridged(_0))]
    Png(String),
    /// The TIFF decoder refuses it.
    #[error("this is not a TIFF raster that can be read ({}). Export it again as GeoTIFF.", abridged(_0))]
    Tiff(String),
    /// A raster with too many pixels, or none.
    #[error(
        "{} × {} pixels cannot be read: a raster has 1 to {} pixels along each side, and at most {} in all. Scale it \
         first.",
        Grouped(*columns as usize), Grouped(*rows as usize), Grouped(LONGEST_SIDE as usize),
        Grouped(MOST_PIXELS as usize)
    )]
    Size {
        /// Columns, as announced.
        columns: u64,
        /// Rows, as announced.
        rows: u64,
    },
    /// The text breaks a rule of its format, which the sentence names.
    #[error("{}", abridged(_0))]
    Syntax(String),
}

impl Flaw {
    /// Returns the flaw with its line, counted from one.
    pub(super) fn at(self, line: usize) -> PlacedFlaw {
        PlacedFlaw { place: PlaceInFile::Line(line), flaw: self }
    }
}

impl From<Cancelled> for Flaw {
    fn from(cancelled: Cancelled) -> Self {
        Self::Io(cancelled.into())
    }
}

/// A flaw with its place, before the file is known.
#[derive(Debug)]
pub(super) struct PlacedFlaw {
    pub(super) place: PlaceInFile,
    pub(super) flaw: Flaw,
}

impl PlacedFlaw {
    /// Returns the flaw as one in a part of an archive.
    pub(super) fn within(self, part: &'static str) -> Self {
        let line = if let PlaceInFile::Line(line) = self.place { Some(line) } else { None };
        Self { place: PlaceInFile::Part(part, line), flaw: self.flaw }
    }

    pub(super) fn in_file(self, file: &Path) -> ReadError {
        ReadError { file: file.to_owned(), place: self.place, flaw: self.flaw }
    }
}

impl<F: Into<Flaw>> From<F> for PlacedFlaw {
    fn from(flaw: F) -> Self {
        Self { place: PlaceInFile::Whole, flaw: flaw.into() }
    }
}
