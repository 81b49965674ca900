//! What the arguments ask for: every value checked on its own, every formula compiled; of the files
//! only a recipe is read.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::args::{BoundaryArgument, InputArguments};
use super::failure::Failure;
use super::layer_options::layers;
use crate::document::LEAST_MEMORY;
use crate::domain::BoundaryMarks;
use crate::field::{Formula, RefinementRule, Transfer};
use crate::geometry::Rect;
use crate::io::layers::{KindSpec, LayerSpec};
use crate::io::recipe::{Recipe, checked_gradation};
use crate::mesh::{Cleaning, KeptParts, Limits, MOST_TRIANGLES, MemoryLimit};
use crate::text::{Bytes, Grouped, LengthUnit};

/// A mesh that is asked for.
#[derive(Debug)]
pub struct MeshRequest {
    /// A saved document, which decides everything but the limits.
    pub project: Option<PathBuf>,
    /// The recipe that the other values come from.
    pub recipe: Option<Recipe>,
    /// The triangle budget, where one is given; else it is the project's.
    pub asked_budget: Option<usize>,
    /// `None` for the rectangle that the rasters cover, or the unit square.
    pub domain: Option<Rect>,
    /// The domain is where this is not 0.
    pub inside: Option<Formula>,
    /// The domain is what the polygons of this file cover.
    pub region: Option<PathBuf>,
    /// How the mesh meets the outline of a region.
    pub boundary: BoundaryArgument,
    /// Largest diameter of a triangle on the outline, in world units; `None` for the usual one.
    pub boundary_diameter: Option<f64>,
    /// The parts that stay, where that is given.
    pub parts: Option<KeptParts>,
    /// Whether pinches stay in any case.
    pub keeps_pinches: bool,
    /// Longest side of a coarse cell, in world units.
    pub spacing: Option<f64>,
    /// The size field, from the bottom layer to the top one.
    pub layers: Vec<LayerSpec>,
    /// Bound of the change of h̄ by unit of length, dimensionless.
    pub gradation: Option<f64>,
    /// Lower bound of the target diameter, in world units.
    pub h_min: Option<f64>,
    /// Upper bound of the target diameter, in world units.
    pub h_max: Option<f64>,
    /// Exponent of the risk, dimensionless.
    pub transfer_shape: f64,
    /// Which points of a triangle count.
    pub rule: RefinementRule,
    /// What the mesh may cost.
    pub limits: Limits,
    /// The unit, in place of that of the region's file.
    pub unit: Option<LengthUnit>,
    /// Names of the boundary, in place of those of the region's file.
    pub marks: Option<Arc<BoundaryMarks>>,
}

/// Most triangles unless `--max-triangles` says otherwise.
pub const USUAL_BUDGET: usize = 50_000_000;

impl MeshRequest {
    /// Checks the arguments one by one and against each other.
    ///
    /// # Errors
    /// With a sentence that names the option, the value and the rule.
    pub fn new(typed: &InputArguments) -> Result<Self, Failure> {
        if let Some(path) = &typed.recipe {
            return Self::of_recipe(path, typed);
        }
        let layers = layers(typed)?;
        let request = Self {
            project: typed.project.clone(),
            recipe: None,
            asked_budget: typed.max_triangles,
            domain: typed.domain.as_deref().map(parse_domain).transpose()?,
            inside: typed.inside.as_deref().map(|text| parse_formula("--inside", text)).transpose()?,
            region: typed.region.clone(),
            boundary: typed.boundary.unwrap_or_default(),
            boundary_diameter: boundary_diameter(typed)?,
            parts: typed.parts.as_deref().map(parts).transpose()?,
            keeps_pinches: typed.keep_pinches,
            spacing: typed.spacing.map(|value| length("--spacing", value)).transpose()?,
            rule: rule(typed.rule.map(Into::into), &layers),
            layers,
            gradation: typed.gradation.map(gradation).transpose()?,
            h_min: typed.h_min.map(|value| length("--h-min", value)).transpose()?,
            h_max: typed.h_max.map(|value| length("--h-max", value)).transpose()?,
            transfer_shape: typed.transfer_shape,
            limits: limits(typed, USUAL_BUDGET)?,
            unit: None,
            marks: None,
        };
        request.check_bounds()?;
        Ok(request)
    }

    /// Whether some source needs both ends of the scale from --h-min to --h-max.
    pub fn uses_scale(&self) -> bool {
        self.layers.iter().any(LayerSpec::uses_scale)
    }

    /// Which triangles stay: the usual ones, unless an option says otherwise.
    pub fn cleaning(&self, usual: Cleaning) -> Cleaning {
        Cleaning {
            parts: self.parts.unwrap_or(usual.parts),
            keeps_pinches: self.keeps_pinches || usual.keeps_pinches,
        }
    }

    /// Options that were given and change nothing, a sentence each.
    pub fn options_without_effect(&self, typed: &InputArguments) -> Vec<String> {
        let unused = [
            (typed.transfer_shape != 1.0 && !self.layers.iter().any(LayerSpec::is_risk))
                .then_some("--transfer-shape changes nothing without --risk or --risk-raster."),
            typed
                .resolution
                .is_some()
                .then_some("--resolution changes nothing: every layer is asked at its own resolution."),
            (typed.boundary.is_some() && self.region.is_none())
                .then_some("--boundary changes nothing without --region."),
        ];
        unused.into_iter().flatten().map(str::to_owned).collect()
    }

    /// The files to read.
    pub fn input_files(&self) -> Vec<PathBuf> {
        let data = self.layers.iter().flat_map(LayerSpec::files).map(Path::to_owned);
        let recipe = self.recipe.as_ref().map(|recipe| recipe.file().to_owned());
        data.chain(self.region.clone()).chain(self.project.clone()).chain(recipe).collect()
    }

    fn check_bounds(&self) -> Result<(), Failure> {
        if self.uses_scale() && self.h_min.is_none() {
            let problem =
                "Risk and images need --h-min, the target diameter where the risk is 1 or the image black";
            return Err(Failure::Usage(format!("{problem}. The size of the finest detail is a good start.")));
        }
        // Where one end is not given, the other takes its place: only the rest is checked then.
        let h_min = self.h_min.or(self.h_max).unwrap_or(1.0);
        let h_max = self.h_max.unwrap_or(h_min);
        Transfer { h_min, h_max, shape: self.transfer_shape }.checked()?;
        Ok(())
    }
}

/// The diameter at the outline. It makes sense only where there is an outline, and where the mesh is refined
/// along it.
fn boundary_diameter(typed: &InputArguments) -> Result<Option<f64>, Failure> {
    let given = typed.boundary_diameter.map(|value| length("--boundary-diameter", value)).transpose()?;
    let Some(diameter) = given else { return Ok(None) };
    let problem = if typed.region.is_none() {
        "it is for the outline of a domain from a file. Name that with --region, or leave it out"
    } else if typed.boundary == Some(BoundaryArgument::Report) {
        "with --boundary report nothing is refined along the outline. Take --boundary fitted, or leave it out"
    } else {
        return Ok(Some(diameter));
    };
    Err(Failure::Usage(format!("--boundary-diameter {diameter}: {problem}.")))
}

/// The parts of the mesh that stay.
///
/// # Errors
/// When the text says none.
pub fn parts(text: &str) -> Result<KeptParts, Failure> {
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

/// The rule that is asked for; where none is, the one that suits the layers: the area rule misses no pixel.
pub fn rule(asked: Option<RefinementRule>, layers: &[LayerSpec]) -> RefinementRule {
    let is_formula = |layer: &LayerSpec| matches!(layer.kind, KindSpec::Formula { .. });
    asked.unwrap_or(match layers.iter().all(is_formula) {
        true => RefinementRule::Vertex,
        false => RefinementRule::Area,
    })
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

/// What the mesh may cost; `usual` is the triangle budget where no option gives one.
///
/// # Errors
/// When an option is out of range.
pub fn limits(typed: &InputArguments, usual: usize) -> Result<Limits, Failure> {
    let max_triangles = typed.max_triangles.unwrap_or(usual);
    if !(2..=MOST_TRIANGLES).contains(&max_triangles) {
        let problem =
            format!("--max-triangles {max_triangles}: choose from 2 to {}", Grouped(MOST_TRIANGLES));
        return Err(Failure::Usage(format!("{problem}. A triangle takes 38 bytes of memory.")));
    }
    let bytes = typed.max_memory.as_deref().map(memory).transpose()?;
    Ok(Limits { max_triangles, max_level: typed.max_level, max_memory: bytes.map(MemoryLimit::for_one_mesh) })
}

/// A memory limit as typed, in bytes.
fn memory(typed: &str) -> Result<usize, Failure> {
    let wrong = |rule: &str| Failure::Usage(format!("--max-memory {typed}: {rule}, such as 500MB or 2GB."));
    let bytes = Bytes::parse(typed).ok_or_else(|| wrong("give a size with its unit"))?;
    if bytes >= LEAST_MEMORY { Ok(bytes) } else { Err(wrong("choose 1MB at least")) }
}
