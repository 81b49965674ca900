use super::super::Meter;
use super::super::error::{Flaw, PlacedFlaw, ReadError};
use super::RecordingFile;
use super::read::{HEAD_LINES, at};
use super::saved::{RecordedMesh, SavedStep};
use super::write::mesh_of;
use meshbrush_core::document::Replay;
use meshbrush_mesh::text::{Grouped, excerpt};

/// The result of repeating a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// Edits in the file.
    pub edits: usize,
    /// Triangles of the last mesh.
    pub triangles: usize,
    /// The first edit after which the mesh is not the recorded one; nothing was done after it.
    pub difference: Option<Difference>,
}

/// A mesh that is not the recorded one.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The edit, counted from 1; 0 is the start.
    pub edit: usize,
    /// The name of the edit.
    pub title: String,
    /// The description of the mesh in the file.
    pub expected: String,
    /// The mesh that was made.
    pub found: String,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { edit, title, expected, found } = self;
        match edit {
            0 => f.write_str("The mesh at the start differs: ")?,
            _ => write!(f, "The mesh after edit {edit} ({title}) differs: ")?,
        }
        write!(f, "expected is {expected}, and found was {found}.")
    }
}

impl RecordingFile {
    /// Returns how many edits there are.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Does all edits again, and compares the mesh after each with the recorded one, up to the first
    /// difference. The meter counts edits.
    ///
    /// # Errors
    /// Fails with the line, when an edit cannot be done; and when the work was cancelled.
    pub fn replay(mut self, meter: &Meter) -> Result<Replayed, ReadError> {
        let result = self.replay_lines(meter);
        result.map_err(|flaw| flaw.in_file(&self.path))
    }

    fn replay_lines(&mut self, meter: &Meter) -> Result<Replayed, PlacedFlaw> {
        meter.expect(self.len() as u64 + 1);
        let (settings, paint) = (self.start.settings.clone(), self.start.paint.clone());
        let mut replay = Replay::new(settings, paint).map_err(|e| Flaw::Syntax(e).at(HEAD_LINES))?;
        let mesh = (&mesh_of(&mut replay, meter)?).into();
        let mut replayed = Replayed { edits: self.len(), triangles: triangles(&mesh), difference: None };
        replayed.difference = difference(0, "start", &self.start_mesh, &mesh);
        for step in &self.steps {
            meter.add(1)?;
            if replayed.difference.is_some() {
                break;
            }
            let SavedStep { edit: number, title, does, gives } = step;
            let line = number + HEAD_LINES;
            let edit = does.checked(replay.document().settings(), &mut self.names);
            let edit = edit.map_err(|flaw| at(flaw, line))?;
            replay.apply(&edit).map_err(|error| Flaw::Syntax(error.to_string()).at(line))?;
            let mesh = (&mesh_of(&mut replay, meter)?).into();
            replayed.triangles = triangles(&mesh);
            replayed.difference = difference(*number, title, gives, &mesh);
        }
        meter.add(1)?;
        Ok(replayed)
    }
}

fn triangles(mesh: &RecordedMesh) -> usize {
    match mesh {
        RecordedMesh::Mesh { triangles, .. } => *triangles,
        RecordedMesh::NoMesh(_) => 0,
    }
}

fn difference(edit: usize, title: &str, expected: &RecordedMesh, found: &RecordedMesh) -> Option<Difference> {
    // The reason is for people: a later program may word it otherwise.
    let both_fail = matches!((expected, found), (RecordedMesh::NoMesh(_), RecordedMesh::NoMesh(_)));
    (!both_fail && expected != found).then(|| Difference {
        edit,
        title: excerpt(40, title),
        expected: expected.to_string(),
        found: found.to_string(),
    })
}

impl std::fmt::Display for RecordedMesh {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Mesh { fingerprint, triangles } => {
                let triangles = Grouped(*triangles);
                write!(f, "{} ({triangles} triangles)", excerpt(32, fingerprint))
            }
            Self::NoMesh(reason) => write!(f, "no mesh ({})", excerpt(200, reason.trim_end_matches('.'))),
        }
    }
}
