//! The program. Everything is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    meshbrush::run_program(std::env::args_os())
}
