//! How well a mesh fits the lines of its document, as text and as JSON.

use serde::Serialize;

use super::build::FinishedMesh;
use super::summary::counted;
use meshbrush_core::outline::{LineFit, LineProblem, UnresolvedPlace};
use meshbrush_mesh::text::Number;

/// A line with what of it is on edges of the mesh. Lengths are in world units, with a projection in metres on
/// the ellipsoid.
#[derive(Clone, Debug, Serialize)]
pub struct LineSummary {
    /// The name of the line.
    pub name: String,
    /// The length of the line.
    pub length: f64,
    /// The length of what is on edges.
    pub length_on_edges: f64,
    /// How far it is at most from a point of the line to one that is on an edge, along the line.
    pub farthest: f64,
    /// The parts that are not on edges, along the line.
    pub unresolved: Vec<UnresolvedPart>,
}

/// A part of a line that is not on edges.
#[derive(Clone, Debug, Serialize)]
pub struct UnresolvedPart {
    /// Its middle.
    pub place: [f64; 2],
    /// Its length.
    pub length: f64,
    /// Why it is not on edges.
    pub reason: &'static str,
    /// About the diameter that would do there; none where no diameter would.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diameter: Option<f64>,
}

impl LineSummary {
    /// Returns the figures of a line.
    pub fn of(fit: &LineFit, finished: &FinishedMesh) -> Self {
        let domain = finished.domain();
        let part =
            |UnresolvedPlace { place, length, problem, diameter, .. }: &UnresolvedPlace| UnresolvedPart {
                place: place.to_array(),
                length: domain.on_earth(*length, *place),
                reason: reason(*problem),
                diameter: diameter.map(|diameter| domain.on_earth(diameter, *place)),
            };
        let middle = fit.unresolved.first().map_or(domain.bounds.center(), |part| part.place);
        let [length, length_on_edges] = lengths(fit, finished);
        Self {
            name: fit.name.clone(),
            length,
            length_on_edges,
            farthest: domain.on_earth(fit.farthest, middle),
            unresolved: fit.unresolved.iter().map(part).collect(),
        }
    }

    /// Returns a line of text.
    pub fn for_people(&self) -> String {
        let share = 100.0 * self.length_on_edges / self.length.max(f64::MIN_POSITIVE);
        let missing = match self.unresolved.as_slice() {
            [] => String::new(),
            [first, ..] => format!(
                "; {} of it are not, the first at {}, {}: {}{}",
                counted(self.unresolved.len(), "part"),
                Number(first.place[0]),
                Number(first.place[1]),
                first.reason,
                first.diameter.map_or(String::new(), |diameter| format!(" (about {})", short(diameter)))
            ),
        };
        format!("line “{}”: {share:.2} % of its length {} on edges{missing}\n", self.name, short(self.length))
    }
}

/// Returns the length of a line, and that of what is on edges.
fn lengths(fit: &LineFit, finished: &FinishedMesh) -> [f64; 2] {
    let domain = finished.domain();
    if domain.projection.is_none() {
        return [fit.length, fit.length_on_edges];
    }
    let edges = fit.edges.iter().map(|ends| {
        let ends = ends.map(|node| finished.mesh().lattice().world_from_lattice(node));
        finished.ground().length(ends)
    });
    let on_edges: f64 = edges.sum();
    let missing: f64 = fit.unresolved.iter().map(|part| domain.on_earth(part.length, part.place)).sum();
    [on_edges + missing, on_edges]
}

fn short(length: f64) -> Number {
    let digits = format!("{length:.5e}");
    Number(digits.parse().unwrap_or(length))
}

fn reason(problem: LineProblem) -> &'static str {
    match problem {
        LineProblem::TooCoarse => "the triangles are too large for what is near",
        LineProblem::OutsideDomain => "it is not in the domain",
        LineProblem::Tangled => "it crosses lines again and again within a few steps of the lattice",
        LineProblem::NoLength => "all its corners are one place",
        LineProblem::Removed => "its part of the mesh was removed",
        LineProblem::NotFinite => "a corner is not a finite number",
        _ => "the mesh has no edges there",
    }
}
