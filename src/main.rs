//! The program: a thin door to [`meshbrush::cli`] and, with the feature `gui`, to the window.

use std::process::ExitCode;

use meshbrush::cli::Window;

/// The window, in a build that has one.
#[cfg(feature = "gui")]
const WINDOW: Option<Window> =
    Some(Window { open: meshbrush::app::run, write_screenshots: meshbrush::app::write_screenshots });
#[cfg(not(feature = "gui"))]
const WINDOW: Option<Window> = None;

fn main() -> ExitCode {
    meshbrush::cli::run(std::env::args_os(), WINDOW)
}
