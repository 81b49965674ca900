use std::path::Path;

use super::super::Meter;
use super::{DescriptionError, Loading, Recipe, read};
use meshbrush_core::document::{Document, MAX_COARSE_TRIANGLES};
use meshbrush_core::domain::BoundaryTreatment;
use meshbrush_mesh::mesh::KeptParts;

/// A recipe as a document.
#[derive(Debug)]
pub struct OpenedRecipe {
    /// The document, which is called after the recipe and has its mesh.
    pub document: Document,
    /// What a person should know, a sentence each: layers that ask for nothing, and what the recipe says and
    /// a document does not hold.
    pub notes: Vec<String>,
}

/// Reads a recipe and the files that it names into a document.
///
/// # Errors
/// As [`read`]; and when a file cannot be read or used, or no document can have these settings.
pub fn open(path: &Path, meter: &Meter) -> Result<OpenedRecipe, DescriptionError> {
    let recipe = read(path)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let described = recipe.mesh.load(&name, &Loading::all(MAX_COARSE_TRIANGLES, meter))?;
    let mut described = described.with_limits_of_the_grid();
    described.notes.extend(not_held(&recipe, described.settings.boundary));
    let document = Document::new(described.settings, Some(described.paint));
    let unsuited = |error| DescriptionError::Unsuited(format!("{}: {error}", path.display()));
    Ok(OpenedRecipe { document: document.map_err(unsuited)?, notes: described.notes })
}

/// What a recipe says that a document does not hold.
fn not_held(recipe: &Recipe, boundary: BoundaryTreatment) -> impl Iterator<Item = String> {
    let is_fitted = recipe.mesh.region.is_some() && boundary != BoundaryTreatment::Report;
    let removes_parts = recipe.mesh.parts.is_some_and(|parts| parts != KeptParts::All);
    let level = recipe.mesh.max_level.map(|level| {
        format!(
            "The window has no deepest level: max_level = {level} is left out, and the mesh can be finer."
        )
    });
    let parts = (removes_parts && !is_fitted).then(|| {
        "The window keeps all parts of a mesh that is not fitted to polygons: `parts` is left out.".to_owned()
    });
    let outputs = (!recipe.outputs.is_empty()).then(|| {
        let file = recipe.file().display();
        format!("The window writes no files of [[output]]; `meshbrush mesh {file}` does.")
    });
    [level, parts, outputs].into_iter().flatten()
}
