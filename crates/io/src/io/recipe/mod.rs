//! `.toml`: a recipe, which says in text what to mesh: domain, layers in order, limits, files to write.
//!
//! `docs/recipe.md` lists the keys. Files are named relative to the folder of the recipe.

mod checked;
mod description;
mod export;
mod load;
mod of_settings;
mod open;
mod paths;
mod saved;
mod text;
#[cfg(test)]
mod tests;
mod wording;
mod write;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::error::PlacedFlaw;
pub use super::words::{SavedName, SavedRule, SavedUnit};
use super::{Flaw, ReadError};
pub use checked::{OutputSpec, Recipe, checked_gradation};
pub use description::MeshDescription;
pub use export::RecipeFiles;
pub use load::{Described, DescriptionError, Loading};
pub use open::{OpenedRecipe, open};
pub use paths::{KeepOutSpec, PathsSpec};
pub use saved::{
    SavedDomain, SavedKeepOut, SavedLimits, SavedMesh, SavedOutput, SavedParts, SavedPaths, SavedPins,
    SavedRecipe, SavedTreatment,
};
use text::RecipeText;
pub use write::to_text;

/// The extension of recipes.
pub const ENDING: &str = "toml";

/// Largest file read: room for a hundred thousand threats.
const MOST_BYTES: u64 = 16 << 20;

/// Reads a recipe, and checks every value that can be checked without reading the files that it names.
///
/// # Errors
/// When the file cannot be read; with line and column, when it is not valid TOML, has a key or a value that
/// no recipe has, or names a file that is not there.
pub fn read(path: &Path) -> Result<Recipe, ReadError> {
    let text = || -> Result<String, PlacedFlaw> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MOST_BYTES {
            let limit = MOST_BYTES >> 20;
            let advice = "Put long lists into files that the recipe names";
            return Err(Flaw::Syntax(format!("the recipe is larger than {limit} MiB. {advice}.")).into());
        }
        String::from_utf8(bytes).map_err(|error| {
            let line = error.as_bytes()[..error.utf8_error().valid_up_to()].split(|&b| b == b'\n').count();
            Flaw::Syntax("this is not UTF-8 text; save the recipe as UTF-8.".into()).at(line)
        })
    };
    let text = text().map_err(|flaw| flaw.in_file(path))?;
    let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
    parse(path, text, &|name| found_in(&folder, name))
}

/// Reads a recipe from its text. Errors call it `file`; `find` says where the files are that it names.
///
/// # Errors
/// As [`read`].
pub fn parse(file: &Path, text: String, find: &super::layers::FindFile) -> Result<Recipe, ReadError> {
    let text = RecipeText::new(file, text);
    let saved = text.parse()?;
    Recipe::checked(text, &saved, find)
}

/// The path of an input file, which must be there.
fn found_in(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let path = folder.join(name);
    match path.metadata() {
        Ok(found) if found.is_file() => Ok(path),
        Ok(_) => Err(format!("{} is not a file.", path.display())),
        Err(error) => Err(format!(
            "the file {} cannot be found ({error}). Files are named from the folder of the recipe.",
            path.display()
        )),
    }
}
