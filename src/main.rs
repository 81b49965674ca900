//! The program. Everything is in the library.

use std::process::ExitCode;

use meshbrush::ProgramAllocator;

#[global_allocator]
static ALLOCATOR: ProgramAllocator = ProgramAllocator;

fn main() -> ExitCode {
    meshbrush::run_program(std::env::args_os())
}
