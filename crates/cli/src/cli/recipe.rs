//! `meshbrush recipe`: a project as a recipe.

use std::path::Path;

use super::args::RecipeArguments;
use super::failure::Failure;
use super::terminal::Terminal;
use meshbrush_io::io::Meter;
use meshbrush_io::io::project::{self, Project};
use meshbrush_io::io::recipe::{self, RecipeFiles};

/// Writes a project as a recipe.
///
/// # Errors
/// Fails when the project cannot be read, or the recipe not written.
pub fn write(typed: &RecipeArguments, terminal: &mut Terminal) -> Result<(), Failure> {
    check_ending(&typed.output)?;
    let meter = Meter::default();
    let reading = format!("reading {}", typed.project.display());
    let document =
        terminal.while_metered(&reading, &meter, || project::read_metered(&typed.project, &meter))?;
    let files = RecipeFiles::new(&Project::of(&document), &typed.output);
    terminal.while_writing(&typed.output, |meter| files.write(meter))?;
    files.paths().for_each(|file| terminal.say(&format!("wrote {}", file.display())));
    files.left_out().iter().for_each(|sentence| terminal.note(sentence));
    Ok(())
}

fn check_ending(path: &Path) -> Result<(), Failure> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(recipe::ENDING)) {
        return Ok(());
    }
    Err(Failure::Usage(format!("{}: the name of a recipe ends with .toml.", path.display())))
}
