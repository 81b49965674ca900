use std::io::Read;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::super::error::{Flaw, PlaceInFile, PlacedFlaw, ReadError};
use super::super::json::{self, JsonFlaw};
use super::super::project::{PartNames, Project};
use super::saved::{RecordedMesh, SavedHead, SavedStart, SavedStep};
use super::{FORMAT, MOST_BYTES, VERSION, too_long};
use crate::io::disk::File;
use meshbrush_mesh::text::excerpt;

/// A recording that was read: the document at the start, and the edits.
#[derive(Debug)]
pub struct RecordingFile {
    pub(super) path: PathBuf,
    pub(super) start: Project,
    /// The rasters of the start.
    pub(super) names: PartNames,
    pub(super) start_mesh: RecordedMesh,
    pub(super) steps: Vec<SavedStep>,
}

/// The lines before the first edit.
pub(super) const HEAD_LINES: usize = 2;

/// Reads a recording.
///
/// # Errors
/// Fails with the line, when the file is not a recording, was written by a newer program, or has a mistake
/// that shows without doing the edits.
pub fn read(path: &Path) -> Result<RecordingFile, ReadError> {
    let bytes = || -> Result<Vec<u8>, PlacedFlaw> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(Flaw::Syntax(format!("{}.", too_long())).into());
        }
        Ok(bytes)
    };
    from_bytes(&bytes().map_err(|flaw| flaw.in_file(path))?, path)
}

/// Reads a recording from bytes. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<RecordingFile, ReadError> {
    parse(bytes, name).map_err(|flaw| flaw.in_file(name))
}

fn parse(bytes: &[u8], name: &Path) -> Result<RecordingFile, PlacedFlaw> {
    // The last line ends as well: a file that was cut off there is noticed.
    let Some(text) = bytes.strip_suffix(b"\n") else {
        return Err(if bytes.is_empty() { not_a_recording() } else { Flaw::CutOff }.into());
    };
    let mut lines = text.split(|&byte| byte == b'\n').enumerate().map(|(n, line)| (n + 1, line));
    let mut next = || lines.next().ok_or(Flaw::CutOff);
    let (_, head) = next()?;
    check_head(head)?;
    let (number, start) = next()?;
    let start: SavedStart = parsed(number, start)?;
    let mut names = PartNames::default();
    let SavedStart { start, gives } = start;
    let start = start.into_project(&mut names).map_err(|flaw| at(flaw, number))?;
    let mut steps = Vec::new();
    for (number, line) in lines {
        let step: SavedStep = parsed(number, line)?;
        let expected = number - HEAD_LINES;
        if step.edit != expected {
            let problem = format!("this is edit {}, and {expected} would be next.", step.edit);
            return Err(Flaw::Syntax(problem).at(number));
        }
        steps.push(step);
    }
    Ok(RecordingFile { path: name.to_owned(), start, names, start_mesh: gives, steps })
}

fn not_a_recording() -> Flaw {
    Flaw::Syntax("this is not a Meshbrush recording.".into())
}

fn check_head(line: &[u8]) -> Result<(), PlacedFlaw> {
    let head: SavedHead = serde_json::from_slice(line).map_err(|_| not_a_recording().at(1))?;
    if head.format != FORMAT {
        return Err(not_a_recording().at(1));
    }
    if head.version > VERSION {
        let by = excerpt(40, &head.written_by);
        return Err(Flaw::Syntax(format!(
            "the recording was written by {by} in version {} of its format, and this program ({}) reads up to version \
             {VERSION}. Use a newer Meshbrush.",
            head.version,
            env!("CARGO_PKG_VERSION"),
        ))
        .at(1));
    }
    Ok(())
}

fn parsed<T: DeserializeOwned>(line: usize, text: &[u8]) -> Result<T, PlacedFlaw> {
    json::parse(text).map_err(|JsonFlaw { sentence, column, .. }| {
        let flaw = Flaw::Syntax(format!("the line is not valid: {sentence}"));
        PlacedFlaw { place: PlaceInFile::Column { line, column }, flaw }
    })
}

/// Returns the flaw of a line.
pub(super) fn at(flaw: PlacedFlaw, line: usize) -> PlacedFlaw {
    PlacedFlaw { place: PlaceInFile::Line(line), ..flaw }
}
