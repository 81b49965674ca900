//! `meshbrush man`: the man pages of a package, from the same texts as the help.

use std::io::{self, Write};
use std::path::Path;

use clap::CommandFactory;
use clap_mangen::Man;

use super::args::Arguments;
use super::failure::Failure;
use meshbrush_io::io::{make_folder, write_file};

/// Writes the page of the program, and one for each of its commands, into a folder.
///
/// # Errors
/// Fails when the folder or a page cannot be written.
pub fn write(folder: &Path) -> Result<(), Failure> {
    make_folder(folder).map_err(|error| not_written(folder, &error))?;
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set()).cloned();
    for command in commands.collect::<Vec<_>>().into_iter().chain([program]) {
        write_page(command, folder)?;
    }
    Ok(())
}

fn write_page(command: clap::Command, folder: &Path) -> Result<(), Failure> {
    let examples = command.get_after_help().map(ToString::to_string);
    let source = format!("meshbrush {}", env!("CARGO_PKG_VERSION"));
    // The examples are lines of a shell: a paragraph of clap_mangen would fill them up.
    let page = Man::new(command.after_help(None::<&str>)).source(source).manual("Meshbrush");
    let file = folder.join(page.get_filename());
    write_file(&file, |out| render(&page, examples.as_deref(), out))
        .map_err(|error| not_written(&file, &error))
}

fn render(page: &Man, examples: Option<&str>, out: &mut dyn Write) -> io::Result<()> {
    let mut text = Vec::new();
    page.render(&mut text)?;
    // Where the language is not set, man has no ellipsis.
    out.write_all(String::from_utf8_lossy(&text).replace('…', "...").as_bytes())?;
    let Some(examples) = examples else { return Ok(()) };
    writeln!(out, ".SH EXAMPLES\n.nf")?;
    let lines = examples.lines().filter(|line| !line.starts_with("Example"));
    for line in lines {
        writeln!(
            out,
            "\\&{}",
            line.trim_start().replace('\\', "\\e").replace('-', "\\-").replace('\'', "\\(aq")
        )?;
    }
    writeln!(out, ".fi")
}

fn not_written(file: &Path, error: &io::Error) -> Failure {
    Failure::Write { file: file.to_owned(), problem: error.to_string() }
}
