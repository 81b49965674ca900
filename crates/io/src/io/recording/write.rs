use std::io::{self, Write};

use super::super::Meter;
use super::super::project::{PartNames, Project};
use super::saved::{RecordedSettings, SavedEdit, SavedHead, SavedStart, SavedStep};
use super::{MOST_BYTES, SLICE, too_long};
use meshbrush_core::document::{Recording, Replay, ReplayedMesh};

/// Does the edits of a recording again, and writes each with the mesh after it. The meter counts edits.
///
/// # Errors
/// Fails with the errors of `out`, when the work was cancelled, when the document had no mesh at the start,
/// or when the recording is too long to be read.
pub fn write(out: &mut dyn Write, recording: &Recording, meter: &Meter) -> io::Result<()> {
    meter.expect(recording.edits().len() as u64 + 1);
    let names = &mut PartNames::default();
    let project = Project { settings: recording.settings().clone(), paint: recording.paint().clone() };
    let mut left = MOST_BYTES;
    let mut line = |content: Vec<u8>| line(out, &content, &mut left);
    line(serde_json::to_vec(&SavedHead::of_this_program())?)?;
    let start = RecordedSettings::whole(&project, names)?;
    let mut replay = Replay::new(project.settings, project.paint).map_err(io::Error::other)?;
    let gives = (&mesh_of(&mut replay, meter)?).into();
    line(serde_json::to_vec(&SavedStart { start, gives })?)?;
    for (number, recorded) in recording.edits().iter().enumerate() {
        meter.add(1)?;
        let does = SavedEdit::of(&recorded.edit, replay.document().settings(), names)?;
        replay.apply(&recorded.edit).map_err(io::Error::other)?;
        let gives = (&mesh_of(&mut replay, meter)?).into();
        let step = SavedStep { edit: number + 1, title: recorded.title.into(), does, gives };
        line(serde_json::to_vec(&step)?)?;
    }
    meter.add(1)?;
    Ok(())
}

/// Makes the mesh after an edit.
///
/// # Errors
/// Fails when the work was cancelled.
pub(super) fn mesh_of(replay: &mut Replay, meter: &Meter) -> io::Result<ReplayedMesh> {
    loop {
        meter.check()?;
        if let Some(mesh) = replay.advance(SLICE) {
            return Ok(mesh);
        }
    }
}

/// Writes a line, if bytes enough are left for it.
fn line(out: &mut dyn Write, content: &[u8], left: &mut u64) -> io::Result<()> {
    let length = content.len() as u64 + 1;
    *left = left.checked_sub(length).ok_or_else(|| io::Error::other(too_long()))?;
    out.write_all(content)?;
    out.write_all(b"\n")
}
