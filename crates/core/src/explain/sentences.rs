//! An explanation as sentences for a person.

use glam::DVec2;

use super::{Demand, Explanation};
use crate::earth::EdgeLengths;
use crate::geometry::LatticePoint;
use crate::layers::{DiameterLimit, Layer, LeastTarget, SurfaceNorm};
use crate::mesh::{Cause, Mesh, TreeTriangle};
use crate::surface::SurfaceDemand;
use crate::text::{LengthUnit, short_name, significant};

/// The names and units that sentences use.
pub struct Words<'a> {
    /// The mesh of the explanation.
    pub mesh: &'a Mesh,
    /// The diameters of triangles, which targets are compared with.
    pub edge_lengths: &'a EdgeLengths,
    /// The layers of the size field.
    pub layers: &'a [Layer],
    /// The unit of lengths.
    pub unit: LengthUnit,
}

/// Returns what is wrong with the triangle that must be bisected.
fn fault(explanation: &Explanation) -> &'static str {
    match explanation.demand {
        Some(Demand::Surface(_)) => "is too far from a surface",
        Some(Demand::Outline | Demand::Target(_)) | None => "exceeds its target",
    }
}

impl Words<'_> {
    /// Returns the explanation, a sentence for each step of the argument.
    pub fn sentences(&self, explanation: &Explanation) -> Vec<String> {
        let level = explanation.triangle.level();
        match &explanation.cause {
            Cause::Coarse => vec!["It is a triangle of the coarse grid: no bisection made it.".into()],
            Cause::OwnRule { parent } => vec![
                format!(
                    "It is half of a triangle of level {}, which has the diameter {} and {}.",
                    parent.level(),
                    self.length(parent),
                    fault(explanation)
                ),
                self.demand(explanation),
            ],
            Cause::Compatibility { chain } => {
                let (first, steps) = (&chain[0], explanation.steps());
                let plural = if steps == 1 { "bisection" } else { "bisections" };
                vec![
                    format!(
                        "Its parent, of level {}, satisfies the rule. It was bisected to keep the mesh compatible.",
                        level.saturating_sub(1)
                    ),
                    format!(
                        "A triangle of level {} near {} required it, {steps} {plural} away; it has the diameter {} and \
                         {}.",
                        first.level(),
                        self.place(self.centroid(first)),
                        self.length(first),
                        fault(explanation)
                    ),
                    self.demand(explanation),
                ]
            }
            _ => vec!["Nothing needs it: the mesh is not up to date with the size field.".into()],
        }
    }

    fn demand(&self, explanation: &Explanation) -> String {
        match explanation.demand {
            None => String::new(),
            Some(Demand::Outline) => {
                "The outline of the domain passes through it, and its diameter exceeds that of the boundary."
                    .into()
            }
            Some(Demand::Target(least)) => self.least(&least),
            Some(Demand::Surface(demand)) => self.surface(&demand),
        }
    }

    fn surface(&self, demand: &SurfaceDemand) -> String {
        let SurfaceDemand { layer, norm, error, at, most } = *demand;
        let layer = self.layers.iter().find(|one| one.id == layer);
        let name = layer.map_or_else(String::new, |layer| short_name(&layer.name).to_string());
        let (error, most) = (significant(error, 4), significant(most, 4));
        let squares = |of: &str| {
            format!(
                "It has one of the largest shares in the error of the surface “{name}”: the root mean square of the \
                 {of} is {error} in it, and {most} over the mesh."
            )
        };
        match norm {
            SurfaceNorm::Largest => format!(
                "The surface “{name}” is {error} from it at {}, and {most} is allowed.",
                self.place(at)
            ),
            SurfaceNorm::RootMeanSquare => squares("differences"),
            SurfaceNorm::Gradient => squares("differences of the gradient"),
        }
    }

    fn least(&self, least: &LeastTarget) -> String {
        let LeastTarget { target, at, from, layer, limit } = *least;
        let layer = layer.and_then(|id| self.layers.iter().find(|layer| layer.id == id));
        let from = (at.distance(from) > self.mesh.lattice().step().max_element()).then_some(from);
        let (target, at) = (self.with_unit(target), self.place(at));
        let name = layer.map(|layer| format!("the layer “{}”", short_name(&layer.name)));
        let limit = match limit {
            Some(DiameterLimit::Smallest) => Some(("smallest", "less")),
            Some(DiameterLimit::Largest) => Some(("largest", "more")),
            None => None,
        };
        match (name, limit, from.map(|from| self.place(from))) {
            (Some(name), None, None) => {
                format!("The least target diameter in it is at {at}, where {name} asks for {target}.")
            }
            (Some(name), Some((limit, amount)), None) => format!(
                "The least target diameter in it is {target} at {at}, by the {limit} diameter of the document: \
                 {name} asks for {amount} there."
            ),
            (Some(name), None, Some(from)) => format!(
                "The least target diameter in it is {target} at {at}: {name} asks for a finer one at {from}, and \
                 the gradation carries it there."
            ),
            (Some(name), Some((limit, amount)), Some(from)) => format!(
                "The least target diameter in it is {target} at {at}: the gradation carries the {limit} diameter \
                 of the document there from {from}, where {name} asks for {amount}."
            ),
            (None, ..) => format!(
                "The least target diameter in it is {target} at {at}: no layer asks for anything, so that the \
                 largest diameter counts."
            ),
        }
    }

    fn centroid(&self, triangle: &TreeTriangle) -> DVec2 {
        let corners = triangle.corners().map(|c: LatticePoint| self.mesh.lattice().world_from_lattice(c));
        corners.iter().sum::<DVec2>() / 3.0
    }

    fn length(&self, triangle: &TreeTriangle) -> String {
        self.with_unit(self.edge_lengths.of(triangle.corners(), triangle.level()))
    }

    fn with_unit(&self, length: f64) -> String {
        self.unit.after(&significant(length, 4))
    }

    /// Returns a point, as exactly as the domain can be told apart.
    fn place(&self, point: DVec2) -> String {
        let size = self.mesh.lattice().bounds().size().max_element();
        let decimals = (6.0 - libm::log10(size).floor()).clamp(0.0, 12.0) as usize;
        format!("({:.decimals$}, {:.decimals$})", point.x, point.y)
    }
}
