//! `meshbrush replay`: do the edits of a recorded session again, and compare the meshes.

use std::io::Write;

use serde::Serialize;

use super::args::ReplayArguments;
use super::failure::Failure;
use super::terminal::Terminal;
use meshbrush_io::io::Meter;
use meshbrush_io::io::recording::{self, Difference, Replayed};
use meshbrush_mesh::text::Grouped;

/// Runs the command. `out` is standard output.
///
/// # Errors
/// Fails when the file is no recording, an edit cannot be done, or a mesh is not the recorded one.
pub fn run(typed: &ReplayArguments, out: &mut dyn Write, terminal: &mut Terminal) -> Result<(), Failure> {
    let file = recording::read(&typed.file)?;
    let meter = Meter::default();
    let what = format!("replaying {}", typed.file.display());
    let replayed = terminal.while_metered(&what, &meter, || file.replay(&meter))?;
    if typed.json {
        let answer =
            serde_json::to_string(&ReplayAnswer::of(&replayed)).expect("numbers and texts are valid JSON");
        writeln!(out, "{answer}").map_err(Failure::Print)?;
    }
    match &replayed.difference {
        Some(difference) => Err(Failure::Work(difference.to_string())),
        None if typed.json => Ok(()),
        None => writeln!(out, "{}", summary(&replayed)).map_err(Failure::Print),
    }
}

fn summary(replayed: &Replayed) -> String {
    let Replayed { edits, triangles, .. } = *replayed;
    let edits = match edits {
        1 => "1 edit".into(),
        _ => format!("{} edits", Grouped(edits)),
    };
    format!(
        "{edits} replayed: every mesh is the recorded one, and the last has {} triangles.",
        Grouped(triangles)
    )
}

/// The answer of `--json`.
#[derive(Serialize)]
struct ReplayAnswer<'a> {
    /// Edits in the file.
    edits: usize,
    /// Whether every mesh is the recorded one.
    agrees: bool,
    /// Triangles of the last mesh that was made.
    triangles: usize,
    /// The first mesh that is not the recorded one.
    #[serde(skip_serializing_if = "Option::is_none")]
    difference: Option<SavedDifference<'a>>,
}

#[derive(Serialize)]
struct SavedDifference<'a> {
    /// The edit, counted from 1; 0 is the start.
    edit: usize,
    title: &'a str,
    expected: &'a str,
    found: &'a str,
}

impl<'a> ReplayAnswer<'a> {
    fn of(replayed: &'a Replayed) -> Self {
        let difference = |Difference { edit, title, expected, found }: &'a Difference| SavedDifference {
            edit: *edit,
            title,
            expected,
            found,
        };
        Self {
            edits: replayed.edits,
            agrees: replayed.difference.is_none(),
            triangles: replayed.triangles,
            difference: replayed.difference.as_ref().map(difference),
        }
    }
}
