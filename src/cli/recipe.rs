//! The request that a recipe makes, and `meshbrush recipe`: a project as a recipe.

use std::path::Path;

use super::args::{BoundaryArgument, InputArguments};
use super::failure::Failure;
use super::more_args::RecipeArguments;
use super::request::{MeshRequest, USUAL_BUDGET, limits, parts, rule};
use super::terminal::Terminal;
use crate::io::Meter;
use crate::io::project::{self, Project};
use crate::io::recipe::{self, Recipe, RecipeFiles, SavedTreatment};
use crate::mesh::{Limits, MemoryLimit};

/// Writes a project as a recipe.
///
/// # Errors
/// When the project cannot be read, or the recipe not written.
pub fn write(typed: &RecipeArguments, terminal: &mut Terminal) -> Result<(), Failure> {
    check_ending(&typed.output)?;
    let document = project::read(&typed.project)?;
    let files = RecipeFiles::new(&Project::of(&document), &typed.output);
    let failed =
        |error: std::io::Error| Failure::Write { file: typed.output.clone(), problem: error.to_string() };
    files.write(&Meter::default()).map_err(failed)?;
    files.paths().for_each(|file| terminal.say(&format!("wrote {}", file.display())));
    Ok(())
}

fn check_ending(path: &Path) -> Result<(), Failure> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(recipe::ENDING)) {
        return Ok(());
    }
    Err(Failure::Usage(format!("{}: the name of a recipe ends with .toml.", path.display())))
}

impl MeshRequest {
    /// The request of a recipe. The options on parts and limits precede it.
    ///
    /// # Errors
    /// When the file is no recipe, or cannot be read.
    pub(super) fn of_recipe(path: &Path, typed: &InputArguments) -> Result<Self, Failure> {
        if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(recipe::ENDING)) {
            let file = path.display();
            return Err(Failure::Usage(format!(
                "{file}: a file without an option is a recipe, and its name ends with .toml. Name a project with \
                 --project, and a domain with --region."
            )));
        }
        let recipe = recipe::read(path)?;
        Ok(Self {
            project: None,
            asked_budget: typed.max_triangles,
            domain: recipe.bounds,
            inside: recipe.inside.clone(),
            region: recipe.region.clone(),
            boundary: recipe.boundary.map(Into::into).unwrap_or_default(),
            boundary_diameter: recipe.boundary_diameter,
            parts: typed.parts.as_deref().map(parts).transpose()?.or(recipe.parts),
            keeps_pinches: typed.keep_pinches || recipe.keeps_pinches,
            spacing: recipe.spacing,
            rule: rule(recipe.rule, &recipe.layers),
            layers: recipe.layers.clone(),
            gradation: recipe.gradation,
            h_min: recipe.h_min,
            h_max: recipe.h_max,
            transfer_shape: recipe.shape,
            limits: limits_of(&recipe, typed)?,
            unit: recipe.unit,
            marks: recipe.marks.clone(),
            recipe: Some(recipe),
        })
    }
}

fn limits_of(recipe: &Recipe, typed: &InputArguments) -> Result<Limits, Failure> {
    let asked = limits(typed, recipe.max_triangles.unwrap_or(USUAL_BUDGET))?;
    Ok(Limits {
        max_level: asked.max_level.or(recipe.max_level),
        max_memory: asked.max_memory.or(recipe.max_memory.map(MemoryLimit::for_one_mesh)),
        ..asked
    })
}

impl From<SavedTreatment> for BoundaryArgument {
    fn from(saved: SavedTreatment) -> Self {
        match saved {
            SavedTreatment::Report => Self::Report,
            SavedTreatment::Fitted => Self::Fitted,
            SavedTreatment::Outline => Self::Outline,
        }
    }
}
