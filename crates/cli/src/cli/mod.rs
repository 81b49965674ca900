//! The command line: arguments as typed (`args`), what they say about the mesh (`options`, `input`), running
//! it.
//!
//! Results go to standard output, everything else to standard error. Exit status 0: done; 1: the work failed,
//! with a sentence; 2: wrong usage.

mod args;
pub mod build;
pub mod check;
mod color_by;
mod command_line;
mod cut_strips;
mod depths;
pub mod details;
mod error_curve;
pub mod exported_mesh;
pub mod failure;
mod grid_source;
pub mod input;
mod lengths;
mod line_notes;
mod lines;
mod locate;
#[cfg(feature = "man")]
mod man;
mod mesh;
pub mod mesh_by_error_failure;
mod opened_file;
mod options;
pub mod output;
pub mod output_coordinates;
pub mod output_keys;
mod partition;
mod path;
mod path_proof;
mod points;
mod problem;
pub mod quality;
mod quantities;
mod recipe;
mod repair;
mod replay;
mod report;
pub mod requested_files;
mod run_clock;
pub mod schism_files;
mod sequence;
mod solve;
pub mod solved_mesh;
mod space_look;
mod standard_output;
pub mod summary;
mod terminal;
pub mod threads;
mod thumbnail;
pub mod why;

use std::ffi::OsString;
use std::io::{self, IsTerminal as _, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::CommandFactory;

pub use run_clock::RunClock;

use args::{Arguments, Command};
use command_line::command_line;
use failure::Failure;
use meshbrush_mesh::text::printable;
use standard_output::StandardOutput;
use terminal::Terminal;

/// The functions of the window that the command line calls. Errors are sentences.
pub struct Window {
    /// Opens it, on a file or the first example, and returns when it is closed.
    pub open: fn(Option<PathBuf>) -> Result<(), String>,
    /// Writes pictures of it into a folder, without a display, and returns the files.
    pub write_screenshots: fn(&Path) -> Result<Vec<PathBuf>, String>,
    /// Writes the pictures of the manual likewise.
    pub write_manual_pictures: fn(&Path) -> Result<Vec<PathBuf>, String>,
    /// Writes pictures of the steps of a first session likewise.
    pub write_tour: fn(&Path) -> Result<Vec<PathBuf>, String>,
}

/// Runs the program. `arguments` begin with its name; `window` is `None` in a build without one.
pub fn run(arguments: impl IntoIterator<Item = OsString>, window: Option<Window>) -> ExitCode {
    ExitCode::from(status_of(arguments, window))
}

/// Runs the program as [`run`] does, and returns its exit status.
pub fn status_of(arguments: impl IntoIterator<Item = OsString>, window: Option<Window>) -> u8 {
    let typed: Vec<OsString> = arguments.into_iter().collect();
    let arguments = match Arguments::read(&typed) {
        Ok(arguments) => arguments,
        Err(answer) => {
            print_answer(&answer);
            return answer.exit_code() as u8;
        }
    };
    let mut terminal = Terminal::new();
    if let Some(note) = threads::start(arguments.threads) {
        terminal.note(&note);
    }
    match run_command(arguments, &command_line(&typed), window, &mut terminal) {
        Ok(()) => 0,
        Err(failure) if failure.is_closed_pipe() => 0,
        Err(failure) => {
            terminal.say(&format!("meshbrush: {failure}"));
            failure.exit_status()
        }
    }
}

/// Prints help, the version, or what is wrong with the arguments, which are repeated in it.
fn print_answer(answer: &clap::Error) {
    // A closed pipe is no error.
    let _ = match answer.use_stderr() {
        true if io::stderr().is_terminal() && printable(&answer.to_string()) == answer.to_string() => {
            answer.print()
        }
        true => write!(io::stderr(), "{}", printable(&answer.to_string())),
        false => answer.print(),
    };
}

/// Runs a command; `line` is how it was typed.
fn run_command(
    arguments: Arguments,
    line: &str,
    window: Option<Window>,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let mut out = StandardOutput::lock();
    match (arguments.command, window) {
        (Some(Command::Mesh(typed)), _) => mesh::run(&typed, line, &mut out, terminal),
        (Some(Command::Locate(typed)), _) => locate::run(&typed, &mut out, terminal),
        (Some(Command::Check(typed)), _) => check::run(&typed, line, &mut out, terminal),
        (Some(Command::Why(typed)), _) => why::run(&typed, &mut out, terminal),
        (Some(Command::Path(typed)), _) => path::run(&typed, line, &mut out, terminal),
        (Some(Command::Solve(typed)), _) => solve::run(&typed, line, &mut out, terminal),
        (Some(Command::Replay(typed)), _) => replay::run(&typed, &mut out, terminal),
        (Some(Command::Report(typed)), _) => report::run(&typed, &mut out, terminal),
        (Some(Command::Thumbnail(typed)), _) => thumbnail::write(&typed, terminal),
        (Some(Command::Recipe(typed)), _) => recipe::write(&typed, terminal),
        (Some(Command::Completions(typed)), _) => {
            let mut script = Vec::new();
            clap_complete::generate(typed.shell, &mut Arguments::command(), "meshbrush", &mut script);
            out.write_all(&script).and_then(|()| out.flush()).map_err(Failure::Print)
        }
        #[cfg(feature = "man")]
        (Some(Command::Man(typed)), _) => man::write(&typed.folder),
        (Some(Command::Screenshots(typed)), window) => {
            let Some(window) = window else { return Err(without_window()) };
            let write = match (typed.manual, typed.tour) {
                (true, _) => window.write_manual_pictures,
                (_, true) => window.write_tour,
                _ => window.write_screenshots,
            };
            for file in write(&typed.folder).map_err(Failure::Work)? {
                terminal.say(&file.display().to_string());
            }
            Ok(())
        }
        (None, window) => {
            drop(out);
            arguments.file.as_deref().map_or(Ok(()), opened_file::check)?;
            let window = window.ok_or_else(without_window)?;
            (window.open)(arguments.file).map_err(Failure::Work)
        }
    }
}

fn without_window() -> Failure {
    let problem = "This meshbrush was built without its window (feature `gui`). Its commands are `mesh`,";
    Failure::Usage(format!(
        "{problem} `check`, `locate`, `why`, `path`, `solve`, `recipe`, `replay` and `report`; `meshbrush --help` lists them."
    ))
}
