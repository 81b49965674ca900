use std::io::{self, Write};

use serde::Serialize;

use super::super::Meter;
use super::super::project::{PartNames, Project};
use super::SLICE;
use super::saved::{SavedEdit, SavedHead, SavedSettings, SavedStart, SavedStep};
use meshbrush_core::document::{Recording, Replay, ReplayedMesh};

/// Does the edits of a recording again, and writes each with the mesh after it. The meter counts edits.
///
/// # Errors
/// Fails with the errors of `out`, when the work was cancelled, or when the document had no mesh at the
/// start.
pub fn write(out: &mut dyn Write, recording: &Recording, meter: &Meter) -> io::Result<()> {
    meter.expect(recording.edits().len() as u64 + 1);
    let names = &mut PartNames::default();
    let project = Project { settings: recording.settings().clone(), paint: recording.paint().clone() };
    line(out, &SavedHead::of_this_program())?;
    let start = SavedSettings::whole(&project, names);
    let mut replay = Replay::new(project.settings, project.paint).map_err(io::Error::other)?;
    line(out, &SavedStart { start, gives: (&mesh_of(&mut replay, meter)?).into() })?;
    for (number, recorded) in recording.edits().iter().enumerate() {
        meter.add(1)?;
        let does = SavedEdit::of(&recorded.edit, replay.document().settings(), names);
        replay.apply(&recorded.edit).map_err(io::Error::other)?;
        let gives = (&mesh_of(&mut replay, meter)?).into();
        line(out, &SavedStep { edit: number + 1, title: recorded.title.into(), does, gives })?;
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

fn line(out: &mut dyn Write, content: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *out, content)?;
    writeln!(out)
}
