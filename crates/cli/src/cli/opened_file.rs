//! The file that the window opens.

use std::path::Path;

use clap::CommandFactory as _;

use super::args::Arguments;
use super::failure::Failure;
use meshbrush_io::io::{exists, nearest_word};

/// Checks before the window opens that there is such a file: the word may be a command.
///
/// # Errors
/// Fails with a sentence where there is none.
pub fn check(file: &Path) -> Result<(), Failure> {
    let is_link = file.to_string_lossy().contains('#');
    if is_link || exists(file) {
        return Ok(());
    }
    let program = Arguments::command();
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set());
    let names: Vec<&str> = commands.map(|command| command.get_name()).collect();
    let advice = match nearest_word(&file.to_string_lossy(), &names) {
        Some(command) => format!("Is the command `{command}` meant?"),
        None => "`meshbrush --help` lists the commands.".to_owned(),
    };
    Err(Failure::Usage(format!("There is no file {}. {advice}", file.display())))
}
