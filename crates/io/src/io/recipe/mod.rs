//! `.toml`: a recipe, which says in text what to mesh: domain, layers in order, limits, files to write.
//!
//! `docs/recipe.md` lists the keys. Files are named relative to the folder of the recipe.

mod export;
mod file_frame;
mod files;
mod grid_region;
mod line_files;
mod notes;
mod open;
mod opening;
#[cfg(test)]
mod tests;
mod text;
mod values;
mod write;

use std::io::Read;
use std::path::{Path, PathBuf};

use super::error::PlacedFlaw;
use super::layers::FindFile;
use super::raster_file::file_and_part;
use super::settings::SavedSettings;
use super::{Flaw, KeyFault, ReadError};
use crate::io::disk::{self, File};
pub use export::RecipeFiles;
pub use file_frame::{OutlineSource, SeaSource, sea_of_land};
pub use files::{LoadError, Loaded, Loading};
pub use open::{OpenedRecipe, open};
use text::RecipeText;
pub use values::{BesideLayer, LoadedDocument, LoadedLayer};
pub use write::to_text;

/// The extension of recipes.
pub const ENDING: &str = "toml";

/// Largest recipe that is written or read: room for a hundred thousand threats.
const MOST_BYTES: u64 = 16 << 20;

/// Returns a sentence without its full stop about a recipe that is longer than [`MOST_BYTES`].
fn too_long() -> String {
    let limit = MOST_BYTES >> 20;
    format!("the recipe is larger than {limit} MiB; put long lists into files that the recipe names")
}

/// Reads a recipe, and checks every value that can be checked without reading the files that it names.
///
/// # Errors
/// Fails when the file cannot be read; with line and column, when it is not valid TOML, has a key or a value
/// that no recipe has, or names a file that is not there.
pub fn read(path: &Path) -> Result<Recipe, ReadError> {
    let text = || -> Result<String, PlacedFlaw> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(Flaw::Syntax(format!("{}.", too_long())).into());
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
/// Fails as [`read`] does.
pub fn parse(file: &Path, text: String, find: &FindFile) -> Result<Recipe, ReadError> {
    let text = RecipeText::new(file, text);
    let mut settings = text.parse()?;
    let checked = settings.place_files(find).and_then(|()| settings.check());
    let checked = checked.and_then(|()| settings.check_recipe());
    checked.map_err(|fault| text.error(&settings.lengths.as_written(fault)))?;
    settings.place_outputs(file.parent().unwrap_or(Path::new("")));
    Ok(Recipe { text, settings })
}

/// A recipe whose values are checked. No file that it names was read yet.
#[derive(Clone, Debug)]
pub struct Recipe {
    text: RecipeText,
    /// Its settings. Files are named as from the working folder.
    pub settings: SavedSettings,
}

impl Recipe {
    /// Returns the file as it was named.
    pub fn file(&self) -> &Path {
        self.text.file()
    }

    /// Returns the error for a value of an output that cannot be used.
    pub fn output_error(&self, output: usize, fault: KeyFault) -> ReadError {
        self.text.error(&fault.within(output).within("output"))
    }
}

/// Returns the path of an input file, which must be there.
fn found_in(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let path = folder.join(name);
    let (file, _) = file_and_part(&path);
    match disk::find(&file) {
        Ok(true) => Ok(path),
        Ok(false) => Err(format!("{} is not a file.", path.display())),
        Err(error) => Err(format!(
            "the file {} cannot be found ({error}). Files are named from the folder of the recipe.",
            path.display()
        )),
    }
}
