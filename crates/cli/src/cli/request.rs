//! What the arguments ask for: every value checked on its own, every formula compiled; of the files
//! only a recipe is read.

use std::path::{Path, PathBuf};

use glam::DVec2;

use super::args::{BoundaryArgument, InputArguments};
use super::failure::Failure;
use super::layer_options::layers;
use meshbrush_core::document::LEAST_MEMORY;
use meshbrush_core::field::Formula;
use meshbrush_io::io::layers::LayerSpec;
use meshbrush_io::io::recipe::{self, MeshDescription, PathsSpec, Recipe, SavedTreatment, checked_gradation};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{KeptParts, MOST_TRIANGLES};
use meshbrush_mesh::text::{Bytes, Grouped};

/// A mesh that is asked for.
#[derive(Debug)]
pub struct MeshRequest {
    /// A saved document. What [`Self::mesh`] says overrides its settings.
    pub project: Option<PathBuf>,
    /// The recipe that domain and layers come from.
    pub recipe: Option<Recipe>,
    /// What to mesh: the options, in place of the values of the recipe where there is one.
    pub mesh: MeshDescription,
}

/// Most triangles unless `--max-triangles` says otherwise.
pub const USUAL_BUDGET: usize = 50_000_000;

impl MeshRequest {
    /// Checks the arguments one by one and against each other.
    ///
    /// # Errors
    /// With a sentence that names the option, the value and the rule; and when a recipe cannot be read.
    pub fn new(typed: &InputArguments) -> Result<Self, Failure> {
        refuse_options_beside_a_file(typed)?;
        let options = description(typed)?;
        let recipe = typed.recipe.as_deref().map(read_recipe).transpose()?;
        let given_diameter = options.boundary_diameter;
        let mesh = match &recipe {
            Some(recipe) => recipe.mesh.clone().overridden_by(&options),
            None => options,
        };
        let request = Self { project: typed.project.clone(), recipe, mesh };
        request.check_bounds()?;
        match given_diameter {
            // Of a project the domain is not known yet.
            Some(diameter) if request.project.is_none() => {
                check_boundary_diameter(diameter, request.mesh.region.is_some(), request.mesh.boundary)?;
            }
            _ => {}
        }
        Ok(request)
    }

    /// Options that were given and change nothing, a sentence each.
    pub fn options_without_effect(&self, typed: &InputArguments) -> Vec<String> {
        // The layers and the domain of a project are not known yet.
        let is_known = self.project.is_none();
        let unused = [
            (is_known && typed.transfer_shape.is_some() && !self.mesh.layers.iter().any(LayerSpec::is_risk))
                .then_some("--transfer-shape changes nothing without --risk or --risk-raster."),
            typed
                .resolution
                .is_some()
                .then_some("--resolution changes nothing: every layer is asked at its own resolution."),
            (is_known && typed.boundary.is_some() && self.mesh.region.is_none())
                .then_some("--boundary changes nothing without --region."),
        ];
        unused.into_iter().flatten().map(str::to_owned).collect()
    }

    /// The files to read.
    pub fn input_files(&self) -> Vec<PathBuf> {
        let recipe = self.recipe.as_ref().map(|recipe| recipe.file().to_owned());
        self.mesh.files().map(Path::to_owned).chain(self.project.clone()).chain(recipe).collect()
    }

    fn check_bounds(&self) -> Result<(), Failure> {
        if self.mesh.uses_scale() && self.mesh.h_min.is_none() {
            let problem =
                "Risk and images need --h-min, the target diameter where the risk is 1 or the image black";
            return Err(Failure::Usage(format!("{problem}. The size of the finest detail is a good start.")));
        }
        Ok(self.mesh.check_transfer()?)
    }
}

/// Checks that a diameter at the outline makes sense.
///
/// # Errors
/// When the domain has no outline, or nothing is refined along it.
pub fn check_boundary_diameter(
    diameter: f64,
    has_outline: bool,
    boundary: Option<SavedTreatment>,
) -> Result<(), Failure> {
    let problem = if !has_outline {
        "it is for the outline of a domain from a file. Name that with --region, or leave it out"
    } else if boundary == Some(SavedTreatment::Report) {
        "with --boundary report nothing is refined along the outline. Take --boundary fitted, or leave it out"
    } else {
        return Ok(());
    };
    Err(Failure::Usage(format!("--boundary-diameter {diameter}: {problem}.")))
}

/// Refuses the options on domain and layers beside a project or a recipe, which decide both.
fn refuse_options_beside_a_file(typed: &InputArguments) -> Result<(), Failure> {
    let (file, advice) = match (&typed.project, &typed.recipe) {
        (Some(file), _) => (
            format!("--project {}", file.display()),
            "Edit them in the window; or write the project as a recipe with `meshbrush recipe`, and edit that",
        ),
        (None, Some(file)) => (file.display().to_string(), "Edit the recipe"),
        (None, None) => return Ok(()),
    };
    let given = [
        ("--domain", typed.domain.is_some()),
        ("--inside", typed.inside.is_some()),
        ("--region", typed.region.is_some()),
        ("--target", !typed.target.is_empty()),
        ("--risk", !typed.risk.is_empty()),
        ("--target-raster", !typed.target_raster.is_empty()),
        ("--risk-raster", !typed.risk_raster.is_empty()),
        ("--threats", !typed.threats.is_empty()),
        ("--distance", !typed.distance.is_empty()),
    ];
    let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) else { return Ok(()) };
    let rule = "domain and layers are those of the file, and other options override its settings";
    Err(Failure::Usage(format!("{option} cannot be used with {file}: {rule}. {advice}.")))
}

/// What the options say.
fn description(typed: &InputArguments) -> Result<MeshDescription, Failure> {
    let positive = |option: &str, value: Option<f64>| value.map(|value| length(option, value)).transpose();
    Ok(MeshDescription {
        bounds: typed.domain.as_deref().map(parse_domain).transpose()?,
        inside: typed.inside.as_deref().map(|text| parse_formula("--inside", text)).transpose()?,
        region: typed.region.clone(),
        unit: None,
        boundary: typed.boundary.map(Into::into),
        boundary_diameter: positive("--boundary-diameter", typed.boundary_diameter)?,
        parts: typed.parts.as_deref().map(parts).transpose()?,
        keeps_pinches: typed.keep_pinches,
        marks: None,
        spacing: positive("--spacing", typed.spacing)?,
        rule: typed.rule.map(Into::into),
        max_triangles: typed.max_triangles.map(triangles).transpose()?,
        max_level: typed.max_level,
        max_memory: typed.max_memory.as_deref().map(memory).transpose()?,
        h_min: positive("--h-min", typed.h_min)?,
        h_max: positive("--h-max", typed.h_max)?,
        shape: typed.transfer_shape,
        gradation: typed.gradation.map(gradation).transpose()?,
        layers: layers(typed)?,
        paths: PathsSpec::default(),
        pins: Vec::new(),
    })
}

/// Reads a recipe.
fn read_recipe(path: &Path) -> Result<Recipe, Failure> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(recipe::ENDING)) {
        let file = path.display();
        return Err(Failure::Usage(format!(
            "{file}: a file without an option is a recipe, and its name ends with .toml. Name a project with \
             --project, and a domain with --region."
        )));
    }
    Ok(recipe::read(path)?)
}

/// The parts of the mesh that stay.
fn parts(text: &str) -> Result<KeptParts, Failure> {
    match text {
        "all" => Ok(KeptParts::All),
        "largest" => Ok(KeptParts::Largest),
        share => match share.parse() {
            Ok(share) if (0.0..=1.0).contains(&share) => Ok(KeptParts::Share(share)),
            _ => Err(Failure::Usage(format!(
                "--parts {share}: write largest, all, or a share of the area from 0 to 1, as in 0.01."
            ))),
        },
    }
}

fn gradation(bound: f64) -> Result<f64, Failure> {
    checked_gradation(bound).map_err(|problem| Failure::Usage(format!("--gradation: {problem}")))
}

/// Compiles a formula.
///
/// # Errors
/// With the mistake and, on separate lines, the formula and carets under the mistake.
pub fn parse_formula(option: &str, text: &str) -> Result<Formula, Failure> {
    Formula::parse(text).map_err(|mistake| {
        let pointer = mistake.pointer().replace('\n', "\n    ");
        Failure::Usage(format!("{option}: {mistake}\n    {pointer}"))
    })
}

fn parse_domain(text: &str) -> Result<Rect, Failure> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let Ok([x0, y0, x1, y1]) = numbers.as_deref() else {
        let problem = format!("--domain {text}: write four numbers with commas between, X0,Y0,X1,Y1");
        return Err(Failure::Usage(format!("{problem}, as in 0,0,1,1.")));
    };
    let domain = Rect::new(DVec2::new(*x0, *y0), DVec2::new(*x1, *y1));
    if !domain.is_proper() {
        let problem =
            format!("--domain {text}: all four numbers must be finite, X0 less than X1 and Y0 less than Y1");
        return Err(Failure::Usage(format!("{problem}.")));
    }
    Ok(domain)
}

/// A length, as given by an option.
///
/// # Errors
/// When it is not positive or not finite.
pub fn length(option: &str, value: f64) -> Result<f64, Failure> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(Failure::Usage(format!("{option} {value}: a length must be positive and finite.")))
    }
}

/// A triangle budget as typed.
fn triangles(count: usize) -> Result<usize, Failure> {
    if (2..=MOST_TRIANGLES).contains(&count) {
        return Ok(count);
    }
    let problem = format!("--max-triangles {count}: choose from 2 to {}", Grouped(MOST_TRIANGLES));
    Err(Failure::Usage(format!("{problem}. A triangle takes 38 bytes of memory.")))
}

/// A memory limit as typed, in bytes.
fn memory(typed: &str) -> Result<usize, Failure> {
    let wrong = |rule: &str| Failure::Usage(format!("--max-memory {typed}: {rule}, such as 500MB or 2GB."));
    let bytes = Bytes::parse(typed).ok_or_else(|| wrong("give a size with its unit"))?;
    if bytes >= LEAST_MEMORY { Ok(bytes) } else { Err(wrong("choose 1MB at least")) }
}

impl From<BoundaryArgument> for SavedTreatment {
    fn from(typed: BoundaryArgument) -> Self {
        match typed {
            BoundaryArgument::Report => Self::Report,
            BoundaryArgument::Fitted => Self::Fitted,
            BoundaryArgument::Outline => Self::Outline,
        }
    }
}
