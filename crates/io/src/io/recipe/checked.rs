//! A recipe whose values are checked.

use std::path::PathBuf;
use std::sync::Arc;

use super::super::ReadError;
use super::super::layers::{
    FindFile, KeyFault, KindSpec, LayerSpec, SavedLayer, Step, compiled, positive_length, rect_of,
};
use super::super::words::marks_of;
use super::MeshDescription;
use super::saved::{
    SavedDomain, SavedLimits, SavedMesh, SavedOutput, SavedParts, SavedRecipe, SavedTreatment,
};
use super::text::{RecipeText, quoted};
use meshbrush_core::document::LEAST_MEMORY;
use meshbrush_core::domain::BoundaryMarks;
use meshbrush_core::field::Transfer;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::MOST_TRIANGLES;
use meshbrush_mesh::text::{Bytes, Grouped, Number};

/// What a recipe says. No file that it names was read yet.
#[derive(Clone, Debug)]
pub struct Recipe {
    text: RecipeText,
    /// What to mesh.
    pub mesh: MeshDescription,
    /// Files to write.
    pub outputs: Vec<OutputSpec>,
}

/// A file to write. The look of pictures and the quantities are checked by those who know them.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSpec {
    /// The file.
    pub path: PathBuf,
    /// Everything else, as the text has it.
    pub saved: SavedOutput,
}

impl Recipe {
    /// Checks the values of a recipe.
    ///
    /// # Errors
    /// With line and column, for the first one that cannot be used.
    pub(super) fn checked(text: RecipeText, saved: &SavedRecipe, find: &FindFile) -> Result<Self, ReadError> {
        let (mesh, outputs) = Self::unplaced(&text, saved, find).map_err(|fault| text.error(&fault))?;
        Ok(Self { text, mesh, outputs })
    }

    /// The file as it was named.
    pub fn file(&self) -> &std::path::Path {
        self.text.file()
    }

    /// The error for a value of an output that cannot be used.
    pub fn output_error(&self, output: usize, fault: KeyFault) -> ReadError {
        self.text.error(&fault.within(Step::Index(output)).within(Step::Key("output")))
    }

    fn unplaced(
        text: &RecipeText,
        saved: &SavedRecipe,
        find: &FindFile,
    ) -> Result<(MeshDescription, Vec<OutputSpec>), KeyFault> {
        let SavedRecipe { domain, mesh, limits, layer, paths: _, keep_out: _, pins, output: outputs } = saved;
        let in_table = |table: &'static str| move |fault: KeyFault| fault.within(Step::Key(table));
        let region = domain.region_file(find).map_err(in_table("domain"))?;
        check_domain(domain).map_err(in_table("domain"))?;
        check_mesh(mesh).map_err(in_table("mesh"))?;
        check_limits(limits).map_err(in_table("limits"))?;
        let bytes = mesh.max_memory.as_deref().map(memory).transpose().map_err(in_table("mesh"))?;
        let inside = domain.inside.as_deref().map(|text| compiled("inside", text)).transpose();
        let spec = |(index, layer): (usize, &SavedLayer)| {
            let checked = layer.checked(find).and_then(with_paint);
            let checked = checked.and_then(|layer| with_scale(layer, limits));
            checked.map_err(|fault| fault.within(Step::Index(index)).within(Step::Key("layer")))
        };
        let folder = text.file().parent();
        let beside = |name: &String| folder.map_or_else(|| name.into(), |folder| folder.join(name));
        let output = |saved: &SavedOutput| OutputSpec { path: beside(&saved.file), saved: saved.clone() };
        let mesh = MeshDescription {
            bounds: domain.checked_bounds().map_err(in_table("domain"))?,
            inside: inside.map_err(in_table("domain"))?,
            region,
            unit: domain.unit.map(Into::into),
            boundary: domain.boundary,
            boundary_diameter: domain.boundary_diameter,
            parts: domain.parts.map(Into::into),
            keeps_pinches: domain.keep_pinches,
            marks: domain.marks(),
            spacing: mesh.spacing,
            rule: mesh.rule.map(Into::into),
            max_triangles: mesh.max_triangles,
            max_level: mesh.max_level,
            max_memory: bytes,
            h_min: limits.h_min,
            h_max: limits.h_max,
            shape: limits.shape,
            gradation: limits.gradation,
            layers: layer.iter().enumerate().map(spec).collect::<Result<_, _>>()?,
            paths: saved.paths_spec(find)?,
            pins: pins.checked().map_err(in_table("pins"))?,
        };
        Ok((mesh, outputs.iter().map(output).collect()))
    }
}

/// Refuses paint that is nowhere: a recipe is text, and holds no pixels.
fn with_paint(layer: LayerSpec) -> Result<LayerSpec, KeyFault> {
    match layer.kind {
        KindSpec::Paint { from: None, .. } => Err(KeyFault::entry(
            "kind",
            "paint has no form as text; name the project that holds it, as in file = \"harbour.meshbrush\".",
        )),
        _ => Ok(layer),
    }
}

/// Refuses a layer that needs the scale from `h_min` to `h_max` where that has no lower end.
fn with_scale(layer: LayerSpec, limits: &SavedLimits) -> Result<LayerSpec, KeyFault> {
    if limits.h_min.is_some() || !layer.uses_scale() {
        return Ok(layer);
    }
    let sentence = "risk and images need `h_min` in the table [limits]: the target diameter where the risk is 1 \
                    or the image black.";
    Err(KeyFault::entry("kind", sentence))
}

fn check_domain(domain: &SavedDomain) -> Result<(), KeyFault> {
    if domain.region.is_some() && domain.inside.is_some() {
        return Err(KeyFault::key("inside", "the domain is given by `region` or by `inside`, not by both."));
    }
    if let Some(diameter) = domain.boundary_diameter {
        length("boundary_diameter", diameter)?;
        if domain.region.is_none() {
            let sentence =
                "this is for the outline of a region; name its file with `region`, or leave it out.";
            return Err(KeyFault::key("boundary_diameter", sentence));
        }
        if domain.boundary == Some(SavedTreatment::Report) {
            let sentence = "with boundary = \"report\" nothing is refined along the outline; leave it out.";
            return Err(KeyFault::key("boundary_diameter", sentence));
        }
    }
    if domain.boundary.is_some() && domain.region.is_none() {
        let sentence = "this is for the outline of a region; name its file with `region`, or leave it out.";
        return Err(KeyFault::key("boundary", sentence));
    }
    if let Some(SavedParts::Share(share)) = domain.parts
        && !(0.0..=1.0).contains(&share)
    {
        let sentence = format!("{} is not a share of the area, which lies from 0 to 1.", Number(share));
        return Err(KeyFault::value("parts", sentence));
    }
    let is_finite = |[x, y]: &[f64; 2]| x.is_finite() && y.is_finite();
    let sentence = "both coordinates of a point must be finite.";
    if let Some(index) = domain.splits.iter().position(|at| !is_finite(at)) {
        return Err(KeyFault::value("splits", sentence).at(Step::Index(index)));
    }
    if let Some(index) = domain.names.iter().position(|name| !is_finite(&name.at)) {
        return Err(KeyFault::value("names", sentence).at(Step::Index(index)).at(Step::Key("at")));
    }
    Ok(())
}

fn check_mesh(mesh: &SavedMesh) -> Result<(), KeyFault> {
    mesh.spacing.map_or(Ok(()), |spacing| length("spacing", spacing))?;
    if let Some(count) = mesh.max_triangles
        && !(2..=MOST_TRIANGLES).contains(&count)
    {
        let sentence = format!("choose from 2 to {} triangles.", Grouped(MOST_TRIANGLES));
        return Err(KeyFault::value("max_triangles", sentence));
    }
    Ok(())
}

fn check_limits(limits: &SavedLimits) -> Result<(), KeyFault> {
    limits.h_min.map_or(Ok(()), |h_min| length("h_min", h_min))?;
    limits.h_max.map_or(Ok(()), |h_max| length("h_max", h_max))?;
    // Where one end is not given, the other takes its place: only the rest is checked then.
    let h_min = limits.h_min.or(limits.h_max).unwrap_or(1.0);
    let h_max = limits.h_max.unwrap_or(h_min);
    let transfer = Transfer { h_min, h_max, shape: limits.shape.unwrap_or(1.0) };
    let wrong_key = if h_min > h_max { "h_max" } else { "shape" };
    transfer.checked().map_err(|error| KeyFault::value(wrong_key, error.to_string()))?;
    let Some(gradation) = limits.gradation else { return Ok(()) };
    checked_gradation(gradation).map(|_| ()).map_err(|sentence| KeyFault::value("gradation", sentence))
}

/// A bound of the change of h̄ by unit of length.
///
/// # Errors
/// A sentence, when it is not positive or not finite.
pub fn checked_gradation(gradation: f64) -> Result<f64, String> {
    if gradation > 0.0 && gradation.is_finite() {
        return Ok(gradation);
    }
    Err(format!(
        "a gradation of {} cannot be kept: it must be positive and finite, and 0.1 to 0.5 are usual.",
        Number(gradation)
    ))
}

fn length(key: &'static str, value: f64) -> Result<(), KeyFault> {
    positive_length(value).map(|_| ()).map_err(|sentence| KeyFault::value(key, sentence))
}

fn memory(typed: &str) -> Result<usize, KeyFault> {
    let wrong = |rule: &str| {
        KeyFault::value("max_memory", format!("{} is no such size: {rule}, as in \"2GB\".", quoted(typed)))
    };
    let bytes = Bytes::parse(typed).ok_or_else(|| wrong("write a number with a unit"))?;
    if bytes < LEAST_MEMORY { Err(wrong("choose 1MB at least")) } else { Ok(bytes) }
}

impl SavedDomain {
    fn region_file(&self, find: &FindFile) -> Result<Option<PathBuf>, KeyFault> {
        let found = self.region.as_deref().map(find).transpose();
        found.map_err(|sentence| KeyFault::entry("region", sentence))
    }

    fn checked_bounds(&self) -> Result<Option<Rect>, KeyFault> {
        self.bounds.map(rect_of).transpose().map_err(|sentence| KeyFault::value("bounds", sentence))
    }

    fn marks(&self) -> Option<Arc<BoundaryMarks>> {
        if self.splits.is_empty() && self.names.is_empty() {
            return None;
        }
        Some(Arc::new(marks_of(&self.splits, &self.names)))
    }
}
