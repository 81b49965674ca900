//! What was done to a document as few bytes, without the meshes: for links.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};

use super::super::project::{PartNames, Project};
use super::saved::{RecordedSettings, SavedEdit};
use meshbrush_core::document::{Document, Example};

/// Most bytes of the text that is written or read: links have a hundredth of it.
const MOST_BYTES: u64 = 1 << 20;

/// The examples that documents begin with by their names. They need no data, and must stay as they are.
const STARTS: [Example; 3] = [Example::Threats, Example::Diamond, Example::Path];

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedGestures {
    /// The name of the example that the document was at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    example: Option<String>,
    /// The document at the start, where it was none of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<RecordedSettings>,
    edits: Vec<SavedEdit>,
}

/// Returns the edits of a document since they are recorded, with the document before them, as packed bytes.
/// `None` where they are not recorded, do not lead to the document as it is, or are too long.
pub fn write(document: &Document) -> Option<Vec<u8>> {
    let recording = document.recording().filter(|recording| !recording.is_full())?;
    let before = Document::new(recording.settings().clone(), Some(recording.paint().clone())).ok()?;
    let start = Project::of(&before);
    let example = STARTS.into_iter().find(|example| Project::of(&as_recorded(*example)) == start);
    let (mut names, mut replayed) = (PartNames::default(), before);
    let start = RecordedSettings::whole(&start, &mut names).ok()?;
    let mut edits = Vec::new();
    for recorded in recording.edits() {
        edits.push(SavedEdit::of(&recorded.edit, replayed.settings(), &mut names).ok()?);
        replayed.apply(&recorded.edit).ok()?;
    }
    if Project::of(&replayed) != Project::of(document) {
        return None;
    }
    let example = example.map(|example| example.name().to_owned());
    let saved = SavedGestures { start: example.is_none().then_some(start), example, edits };
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
    let text = serde_json::to_vec(&saved).ok()?;
    if text.len() as u64 > MOST_BYTES {
        return None;
    }
    packed.write_all(&text).ok()?;
    packed.finish().ok()
}

/// Returns an example as a recording begins with it.
fn as_recorded(example: Example) -> Document {
    let mut document = example.without_data();
    document.record();
    document
}

/// Returns the document of packed bytes, with nothing to undo.
///
/// # Errors
/// Fails with a sentence when they are damaged, or an edit is impossible.
pub fn read(bytes: &[u8]) -> Result<Document, String> {
    let mut text = Vec::new();
    let unpacked = ZlibDecoder::new(bytes).take(MOST_BYTES + 1).read_to_end(&mut text);
    unpacked.map_err(|error| format!("it cannot be unpacked: {error}."))?;
    if text.len() as u64 > MOST_BYTES {
        return Err("it is too long.".into());
    }
    let saved: SavedGestures =
        serde_json::from_slice(&text).map_err(|error| format!("it is not valid: {error}."))?;
    let mut names = PartNames::default();
    let mut document = match (saved.example, saved.start) {
        (Some(name), None) => {
            let example = STARTS.into_iter().find(|example| example.name() == name);
            let example = example.ok_or("it begins with an example that is not known.")?;
            let document = as_recorded(example);
            RecordedSettings::whole(&Project::of(&document), &mut names)
                .map_err(|error| error.to_string())?;
            document
        }
        (None, Some(start)) => {
            start.into_project(&mut names).map_err(|flaw| flaw.flaw.to_string())?.into_document()?
        }
        _ => return Err("it has no beginning.".into()),
    };
    for edit in saved.edits {
        let edit = edit.checked(document.settings(), &mut names).map_err(|flaw| flaw.flaw.to_string())?;
        document.apply(&edit).map_err(|error| error.to_string())?;
    }
    // As a file: nothing of it is undone.
    Project::of(&document).into_document()
}
