//! `meshbrush thumbnail`: a small picture of a project for a file manager.
//!
//! File managers run it on every file that they show, whoever made it: it takes little time and memory, or
//! there is no picture.

use std::ffi::OsString;
use std::process::exit;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use super::args::{Arguments, Command, MeshArguments, ThumbnailArguments};
use super::build::build;
use super::failure::Failure;
use super::input::Input;
use super::output::{check_place, failed};
use super::requested_files::RequestedFiles;
use super::terminal::Terminal;
use meshbrush_io::io::{png, write_file};
use meshbrush_mesh::mesh::ProgramAllocator;

/// The longest time that it takes.
const LONGEST: Duration = Duration::from_millis(1900);
/// Most memory for the work, in bytes. The program itself takes the rest of 256 MB.
const MOST_MEMORY: usize = 180_000_000;
/// Most triangles: they take half of the memory.
const MOST_TRIANGLES: &str = "1000000";

/// Runs the command.
///
/// # Errors
/// Fails when there is no picture.
pub fn write(typed: &ThumbnailArguments, terminal: &mut Terminal) -> Result<(), Failure> {
    ProgramAllocator::limit(MOST_MEMORY);
    let end = End::after(LONGEST)?;
    let mesh = mesh_arguments(typed)?;
    let input = Input::new(&mesh.input)?;
    check_place(&typed.output, &input.files())?;
    let files = RequestedFiles::of_options(&mesh)?;
    let finished = build(&input, terminal)?;
    let extract = finished.extract_as_made();
    let picture = files.picture_of(&finished, &extract)?;
    let mut bytes = Vec::new();
    let written = png::write(&mut bytes, picture.size, &picture.rgba).and_then(|()| {
        end.is_near();
        write_file(&typed.output, |out| out.write_all(&bytes))
    });
    written.map_err(|error| failed(&typed.output, error.to_string()))
}

/// Returns the arguments of the command that makes the mesh.
fn mesh_arguments(typed: &ThumbnailArguments) -> Result<MeshArguments, Failure> {
    let size = format!("{0}x{0}", typed.size);
    let words = [
        "meshbrush",
        "mesh",
        "--max-triangles",
        MOST_TRIANGLES,
        "--size",
        &size,
        "-o",
        "picture.png",
        "--project",
    ];
    let words: Vec<OsString> =
        words.map(OsString::from).into_iter().chain([typed.project.clone().into()]).collect();
    let read = Arguments::read(&words).map_err(|error| Failure::Usage(error.to_string()))?;
    match read.command {
        Some(Command::Mesh(mesh)) => Ok(mesh),
        _ => unreachable!("the words begin with this command"),
    }
}

/// The end of the program after a time.
struct End(Arc<Mutex<bool>>);

impl End {
    /// Ends the program after a time, unless the work is done before.
    ///
    /// # Errors
    /// Fails where no thread can be made: nobody would watch the time.
    fn after(time: Duration) -> Result<Self, Failure> {
        let is_near = Arc::new(Mutex::new(false));
        let watched = is_near.clone();
        let watch = move || {
            thread::sleep(time);
            let is_near = watched.lock().unwrap_or_else(PoisonError::into_inner);
            if !*is_near {
                Terminal::new().say("meshbrush: This takes longer than 2 s, which is the limit here.");
                exit(1)
            }
        };
        let started = thread::Builder::new().spawn(watch);
        started.map_err(|error| Failure::Work(format!("The system allows no thread now: {error}.")))?;
        Ok(Self(is_near))
    }

    /// Lets the program write its file completely.
    fn is_near(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = true;
    }
}
