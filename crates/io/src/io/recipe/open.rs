use std::path::Path;

use super::super::Meter;
use super::super::settings::{SavedOutput, SavedParts};
use super::{LoadError, Loaded, Loading, Recipe, read};
use meshbrush_core::document::Document;
use meshbrush_core::domain::BoundaryTreatment;

/// A recipe as a document.
#[derive(Debug)]
pub struct OpenedRecipe {
    /// The document, which is called after the recipe and has its mesh.
    pub document: Document,
    /// Notes for a person, a sentence each: layers without any target, and settings of the recipe that a
    /// document does not have.
    pub notes: Vec<String>,
    /// The files that the recipe asks for, with their paths.
    pub outputs: Vec<SavedOutput>,
}

/// Reads a recipe and the files that it names into a document.
///
/// # Errors
/// Fails as [`read`] does; and when a file cannot be read or used, or no document can have these settings.
pub fn open(path: &Path, meter: &Meter) -> Result<OpenedRecipe, LoadError> {
    let recipe = read(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let Loaded { settings, paint, mut notes, without_effect: _, coordinates: _ } =
        recipe.settings.load_files(&name, &Loading::for_document(meter))?;
    notes.extend(not_held(&recipe, settings.boundary));
    let document = Document::new(settings.with_limits_of_the_grid()?, Some(paint));
    let unsuited = |error| LoadError::Unsuited(format!("{}: {error}", path.display()));
    let outputs = recipe.settings.output.clone();
    Ok(OpenedRecipe { document: document.map_err(unsuited)?, notes, outputs })
}

/// Returns sentences about the settings of a recipe that a document does not have.
fn not_held(recipe: &Recipe, boundary: BoundaryTreatment) -> impl Iterator<Item = String> {
    let is_fitted = recipe.settings.domain.has_outline() && boundary != BoundaryTreatment::Report;
    let removes_parts = recipe.settings.domain.parts.is_some_and(|parts| parts != SavedParts::All);
    let parts = (removes_parts && !is_fitted).then(|| {
        "The window keeps all parts of a mesh that is not fitted to an outline: `parts` is left out."
            .to_owned()
    });
    let problem = (!recipe.settings.problem.is_empty()).then(|| {
        "The window solves no problem, and a project holds none: `[problem]` is left out. `meshbrush solve` reads it."
            .to_owned()
    });
    parts.into_iter().chain(problem)
}
