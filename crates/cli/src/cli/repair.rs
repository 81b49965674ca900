//! Meshes with smaller triangles where they would break a rule of a solver: `mesh --repair-for` and
//! `check --repair`.

use glam::DVec2;
use serde::Serialize;

use super::build::{FinishedMesh, build_from, refine};
use super::failure::Failure;
use super::input::{Input, ToMesh};
use super::terminal::Terminal;
use meshbrush_core::build::{MeshBuilder, MeshSpec};
use meshbrush_core::field::RefinementRule;
use meshbrush_core::layers::{DistanceLayer, Layer};
use meshbrush_io::io::layers::{ListsInPlace, SavedLayer};
use meshbrush_io::io::recipe;
use meshbrush_io::io::settings::{SavedLimits, SavedSettings};
use meshbrush_io::io::solver_rules::{Repaired, Solver, repaired};
use meshbrush_mesh::text::Grouped;

/// What was done so that a mesh keeps the rules of a solver.
#[derive(Clone, Debug, Serialize)]
pub struct RepairSummary {
    /// The word of the solver.
    #[serde(rename = "for")]
    solver: &'static str,
    /// The triangles that were bisected once more.
    bisected: usize,
    /// The places that smaller triangles did not mend.
    left: usize,
    /// The smallest target diameter, where it had to be less than it was.
    #[serde(skip_serializing_if = "Option::is_none")]
    h_min: Option<f64>,
    /// The layers that ask for it, above all others.
    layers: Vec<RepairLayer>,
    /// The deepest level that a triangle may have, if there is one.
    #[serde(skip)]
    max_level: Option<u32>,
    #[serde(skip)]
    name: &'static str,
    #[serde(skip)]
    as_recipe: String,
}

/// A layer that asks for a diameter in discs.
#[derive(Clone, Debug, Serialize)]
struct RepairLayer {
    diameter: f64,
    radius: f64,
    places: Vec<[f64; 2]>,
}

impl RepairLayer {
    fn of(layer: &Layer) -> Option<Self> {
        let DistanceLayer { to, at_zero, range, .. } = layer.kind.get()?;
        let places = to.shapes()?.list().points.iter().map(DVec2::to_array).collect();
        Some(Self { diameter: *at_zero, radius: *range, places })
    }
}

/// Builds the mesh of an input, which keeps the rules of a solver, if one is named, as far as smaller
/// triangles help.
///
/// # Errors
/// Fails when a file cannot be used, the target is impossible somewhere, a limit is reached, or nothing can
/// be mended by the rule of refinement.
pub fn build_for(
    input: &Input,
    solver: Option<(Solver, &str)>,
    terminal: &mut Terminal,
) -> Result<(FinishedMesh, Option<RepairSummary>), Failure> {
    let mut read = input.read(terminal)?;
    let Some((solver, option)) = solver else { return Ok((build_from(read, terminal)?, None)) };
    if read.spec.rule == RefinementRule::Vertex {
        return Err(Failure::Usage(format!(
            "{option}: by the vertex rule sizes count in nodes only, so no size can ask for one triangle to be bisected. \
             Leave it out, or mesh by the area rule (--rule area)."
        )));
    }
    let repaired = repair(&read, solver, terminal)?;
    let summary = RepairSummary::new(solver, &repaired, &read.spec);
    read.spec.field.layers.extend(repaired.layers);
    read.spec.field.transfer.h_min = repaired.h_min.unwrap_or(read.spec.field.transfer.h_min);
    Ok((build_from(read, terminal)?, Some(summary)))
}

fn repair(read: &ToMesh, solver: Solver, terminal: &mut Terminal) -> Result<Repaired, Failure> {
    let make = |spec: MeshSpec| {
        let mut builder = MeshBuilder::new(spec).scaled(read.scale);
        let refined = refine(&mut builder, &read.paint, terminal);
        terminal.clear();
        refined.map(|_| builder.finish())
    };
    repaired(solver, &read.spec, &read.marks, (read.scale, &read.paint), make)
}

impl RepairSummary {
    fn new(solver: Solver, repaired: &Repaired, before: &MeshSpec) -> Self {
        let Repaired { layers, h_min, bisected, left: _ } = repaired;
        let saved = layers.iter().map(|layer| SavedLayer::of(layer, None, ListsInPlace::ALL)).collect();
        // Without a value of its own, the diameter at risk 1 would become less, too.
        let has_risk = before.field.layers.iter().any(Layer::is_of_risk);
        let h_risk = h_min.filter(|_| has_risk).map(|_| before.field.transfer.h_risk.into());
        let limits = SavedLimits { h_min: h_min.map(Into::into), h_risk, ..SavedLimits::default() };
        let recipe = recipe::to_text(&SavedSettings { layer: saved, limits, ..SavedSettings::default() });
        let start = recipe.find('[').unwrap_or(recipe.len());
        Self {
            solver: solver.word(),
            bisected: *bisected,
            left: repaired.places_left(),
            max_level: before.limits.max_level,
            layers: layers.iter().filter_map(RepairLayer::of).collect(),
            name: solver.name(),
            h_min: *h_min,
            as_recipe: recipe[start..].to_owned(),
        }
    }

    /// Returns a sentence: how many triangles were bisected, and how many places are left.
    pub fn for_people(&self) -> String {
        let triangles = match self.bisected {
            0 => "no triangle was".to_owned(),
            1 => "1 triangle was".to_owned(),
            count => format!("{} triangles were", Grouped(count)),
        };
        let why = match self.max_level {
            None => "where smaller triangles do not help".to_owned(),
            Some(level) => format!("where smaller triangles do not help or level {level} is the deepest"),
        };
        let left = match self.left {
            0 => String::new(),
            1 => format!("; 1 place is left, {why}"),
            count => format!("; {} places are left, {why}", Grouped(count)),
        };
        format!("For {} {triangles} bisected once more{left}.", self.name)
    }

    /// Returns the limits and layers as a recipe has them, to be added to it.
    pub fn as_recipe(&self) -> &str {
        &self.as_recipe
    }
}
