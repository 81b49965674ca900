//! `meshbrush why`: build, then say why the triangle at a point is there.

use std::io::Write;

use serde::Serialize;

use super::args::WhyArguments;
use super::build::{FinishedMesh, build};
use super::failure::Failure;
use super::input::Input;
use super::mesh::note_capped;
use super::points::TypedPoint;
use super::terminal::Terminal;
use meshbrush_core::explain::{Demand, Explanation, Words};
use meshbrush_core::layers::DiameterLimit;
use meshbrush_core::surface::SurfaceDemand;
use meshbrush_io::io::layers::SavedNorm;
use meshbrush_mesh::mesh::{Cause, Location, Mesh, TreeTriangle, TriangleId};

/// Runs the command. `out` is standard output.
///
/// # Errors
/// Fails with the reason, when the arguments make no sense, the work failed, or no triangle is at the point.
pub fn run(typed: &WhyArguments, out: &mut dyn Write, terminal: &mut Terminal) -> Result<(), Failure> {
    let point = TypedPoint::parse(&typed.point)?;
    let input = Input::new(&typed.input)?;
    input.options_without_effect(&typed.input).iter().for_each(|note| terminal.note(note));
    let finished = build(&input, terminal)?;
    note_capped(&finished, terminal);
    let mesh = finished.mesh();
    let location = mesh.locate(point.in_domain(finished.domain().projection, finished.unit())?);
    let id = location.triangle().ok_or_else(|| nowhere(&typed.point, &location, mesh))?;
    let explanation = terminal.while_working("looking for the cause", || finished.explanation(id));
    let text = if typed.json {
        answer_as_json(&finished, id, &explanation)
    } else {
        sentences(&finished, id, &explanation)
    };
    writeln!(out, "{text}").map_err(Failure::Print)
}

/// Returns why no triangle is at a point.
pub fn nowhere(point: &str, location: &Location, mesh: &Mesh) -> Failure {
    let bounds = mesh.lattice().bounds();
    Failure::Work(match location {
        Location::OutsideBounds => format!(
            "No triangle is at {point}: the domain goes from {},{} to {},{}.",
            bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y
        ),
        _ => format!(
            "No triangle is at {point}: the point lies in a hole of the domain, or beyond its outline."
        ),
    })
}

/// Returns the answer as JSON.
pub fn answer_as_json(finished: &FinishedMesh, id: TriangleId, explanation: &Explanation) -> String {
    let answer = WhyAnswer::new(finished, id, explanation);
    serde_json::to_string(&answer).expect("numbers and texts are valid JSON")
}

/// Returns the answer as sentences, one in each line.
pub fn sentences(finished: &FinishedMesh, id: TriangleId, explanation: &Explanation) -> String {
    let words = Words {
        mesh: finished.mesh(),
        edge_lengths: finished.edge_lengths(),
        layers: finished.layers(),
        unit: finished.unit(),
    };
    let level = explanation.triangle.level();
    let mut lines = vec![match number(finished, id) {
        Some(number) => format!("Triangle {number} is of level {level}."),
        None => format!("The triangle is of level {level}."),
    }];
    lines.extend(words.sentences(explanation));
    lines.join("\n")
}

/// Returns the number of a triangle in files. None where it was changed along the outline.
fn number(finished: &FinishedMesh, id: TriangleId) -> Option<usize> {
    finished.extract().place_of(id).map(TriangleId::index)
}

/// The answer of `--json`.
#[derive(Serialize)]
struct WhyAnswer<'a> {
    /// The number in files.
    #[serde(skip_serializing_if = "Option::is_none")]
    triangle: Option<usize>,
    level: u32,
    /// The corners in world units: the apex, then the ends of the bisection edge.
    corners: [[f64; 2]; 3],
    /// "coarse", "rule", "compatibility", or "unneeded" where the mesh is not up to date.
    cause: &'static str,
    /// The triangles from the one that exceeds its target to the parent.
    chain: Vec<Link>,
    #[serde(skip_serializing_if = "Option::is_none")]
    demand: Option<SavedDemand<'a>>,
}

/// A triangle of the chain.
#[derive(Serialize)]
struct Link {
    level: u32,
    diameter: f64,
    corners: [[f64; 2]; 3],
}

/// The target that the first triangle of the chain exceeds.
#[derive(Serialize)]
#[serde(tag = "by", rename_all = "lowercase")]
enum SavedDemand<'a> {
    Outline,
    Target {
        target: f64,
        at: [f64; 2],
        from: [f64; 2],
        layer: Option<&'a str>,
        /// "smallest" or "largest", where that limit counts in place of what the layer asks for.
        #[serde(skip_serializing_if = "Option::is_none")]
        limit: Option<&'static str>,
    },
    Surface {
        /// By which error.
        norm: SavedNorm,
        /// The error of the triangle, and the place of the largest difference.
        error: f64,
        at: [f64; 2],
        layer: Option<&'a str>,
        /// The largest difference that the layer allows, or the error of the whole mesh.
        most: f64,
    },
}

impl<'a> WhyAnswer<'a> {
    fn new(finished: &'a FinishedMesh, id: TriangleId, explanation: &Explanation) -> Self {
        let (cause, chain) = match &explanation.cause {
            Cause::Coarse => ("coarse", Vec::new()),
            Cause::OwnRule { parent } => ("rule", vec![Link::new(finished, parent)]),
            Cause::Compatibility { chain } => {
                ("compatibility", chain.iter().map(|triangle| Link::new(finished, triangle)).collect())
            }
            _ => ("unneeded", Vec::new()),
        };
        let name = |id| finished.layers().iter().find(|layer| Some(layer.id) == id);
        let demand = explanation.demand.map(|demand| match demand {
            Demand::Outline => SavedDemand::Outline,
            Demand::Surface(SurfaceDemand { layer, norm, error, at, most }) => SavedDemand::Surface {
                norm: norm.into(),
                error,
                at: at.to_array(),
                layer: name(Some(layer)).map(|layer| layer.name.as_str()),
                most,
            },
            Demand::Target(least) => SavedDemand::Target {
                target: least.target,
                at: least.at.to_array(),
                from: least.from.to_array(),
                layer: name(least.layer).map(|layer| layer.name.as_str()),
                limit: least.limit.map(|limit| match limit {
                    DiameterLimit::Smallest => "smallest",
                    DiameterLimit::Largest => "largest",
                }),
            },
        });
        let triangle = number(finished, id);
        let Link { level, corners, .. } = Link::new(finished, &explanation.triangle);
        Self { triangle, level, corners, cause, chain, demand }
    }
}

impl Link {
    fn new(finished: &FinishedMesh, triangle: &TreeTriangle) -> Self {
        let world = |corner| finished.mesh().lattice().world_from_lattice(corner).to_array();
        Self {
            level: triangle.level(),
            diameter: finished.edge_lengths().of(triangle.corners(), triangle.level()),
            corners: triangle.corners().map(world),
        }
    }
}
