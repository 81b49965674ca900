//! The program: a thin door to [`meshbrush::cli`] and, with the feature `gui`, to the window.

use std::process::ExitCode;

/// What opens the window, in a build that has one.
#[cfg(feature = "gui")]
const WINDOW: Option<meshbrush::cli::OpenWindow> = Some(meshbrush::app::run);
#[cfg(not(feature = "gui"))]
const WINDOW: Option<meshbrush::cli::OpenWindow> = None;

fn main() -> ExitCode {
    meshbrush::cli::run(std::env::args_os(), WINDOW)
}
