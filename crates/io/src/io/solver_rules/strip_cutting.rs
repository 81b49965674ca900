//! A sea without the strips in which its frame runs along a coast.
//!
//! The domain itself is cut, and not the file: rings around the triangles of each strip are taken away from
//! it, the mesh of what is left is looked at again, and so on until no strip is left. Towards the sea a ring
//! follows edges of the mesh, which stay where they are. Over land and beyond the frame it goes on by half an
//! edge, so that no sliver of water stays.

use std::collections::{HashMap, HashSet};

use glam::DVec2;

use super::strips::{strip_cuts, strips_along_frame};
use super::{BrokenPlace, Solver, WrittenMesh, plain_mesh, rules_of};
use crate::io::settings::{SavedRing, written_ring};
use meshbrush_core::domain::{BoundaryMarks, Domain, Polygon, Region, Ring};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Extract;

/// The most meshes that are cut.
const MOST_ROUNDS: usize = 4;
/// How far a ring goes on over land, as a share of the edge there.
const OVER_LAND: f64 = 0.5;

/// Rings to be cut off a domain, found from one mesh after another.
#[derive(Debug)]
pub struct StripCutting {
    solver: Solver,
    rings: Vec<SavedRing>,
    rounds: usize,
    cut: usize,
    left: Vec<BrokenPlace>,
}

impl StripCutting {
    /// Begins for a solver; `None` where it takes strips as they are.
    pub fn new(solver: Solver) -> Option<Self> {
        let has_rule = rules_of(solver).any(|rule| rule.name == RULE);
        has_rule.then(|| Self { solver, rings: Vec::new(), rounds: 0, cut: 0, left: Vec::new() })
    }

    /// Looks at the mesh of the domain without the rings so far. Returns whether there are further ones.
    pub fn look(&mut self, extract: &Extract, domain: &Domain, marks: &BoundaryMarks) -> bool {
        let mesh = plain_mesh(extract, domain, marks, self.solver);
        self.left = strips_along_frame(&mesh);
        if self.rounds == MOST_ROUNDS {
            return false;
        }
        let rings_before = self.rings.len();
        for cut in strip_cuts(&mesh) {
            match cut.triangles {
                Ok(triangles) => {
                    let rings = rings_around(&mesh, &triangles);
                    self.rings.extend(rings.iter().map(|ring| written_ring(domain, ring)));
                    self.cut += 1;
                }
                Err(problem) => self.explain(cut.place, &problem),
            }
        }
        self.rounds += 1;
        self.rings.len() > rings_before
    }

    /// Adds to what is said about the strips nearest to a place why it was not cut off.
    fn explain(&mut self, place: DVec2, problem: &str) {
        let distance = |found: &BrokenPlace| found.place.distance_squared(place);
        let nearest = self.left.iter_mut().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(found) = nearest {
            found.sentence += &format!(" It is not cut off: {problem}.");
        }
    }

    /// Returns the rings to be cut off, after those of the domain, as a recipe has them.
    pub fn rings(&self) -> &[SavedRing] {
        &self.rings
    }

    /// Returns how many strips were cut off.
    pub fn cut(&self) -> usize {
        self.cut
    }

    /// Returns the strips that are left, in the coordinates of the plane.
    pub fn left(&self) -> &[BrokenPlace] {
        &self.left
    }
}

const RULE: &str = "strip_along_frame";

/// Returns rings around triangles, a little wider over land.
fn rings_around(mesh: &WrittenMesh, triangles: &[usize]) -> Vec<Ring> {
    let corners = triangles.iter().map(|&triangle| mesh.corners(triangle).to_vec());
    let covered: Vec<Polygon> = corners.chain(land_beside(mesh, triangles)).map(|ring| vec![ring]).collect();
    let Some(frame) = Rect::holding(covered.iter().flatten().flatten().copied()) else { return Vec::new() };
    let region = Region::new(&covered, frame);
    region.polygons().iter().filter_map(|rings| rings.first()).cloned().collect()
}

/// Returns quadrilaterals beyond the edges of the boundary that triangles have, and the triangles that close
/// the gaps between two of them.
///
/// ```text
///       ┌─────────┐  ╲
///       │  land   │ ╲  ╲
///   ────a─────────b─────        b - a turned to the right points away from the triangle
///         ╲     ╱
/// ```
fn land_beside(mesh: &WrittenMesh, triangles: &[usize]) -> Vec<Ring> {
    let corners = triangles.iter().map(|&triangle| mesh.triangles[triangle]);
    let of_cut: HashSet<[usize; 2]> = corners.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let edges = mesh.boundary().iter().filter(|edge| of_cut.contains(*edge));
    let beyond = |&[from, to]: &[usize; 2]| {
        let along = mesh.nodes[to] - mesh.nodes[from];
        OVER_LAND * DVec2::new(along.y, -along.x)
    };
    let edges: Vec<([usize; 2], DVec2)> = edges.map(|edge| (*edge, beyond(edge))).collect();
    let leaving: HashMap<usize, DVec2> = edges.iter().map(|([from, _], beyond)| (*from, *beyond)).collect();
    let mut rings = Vec::new();
    for ([from, to], beyond) in &edges {
        let [from, end] = [from, to].map(|&node| mesh.nodes[node]);
        rings.push(vec![from, from + *beyond, end + *beyond, end]);
        if let Some(next) = leaving.get(to) {
            rings.push(vec![end, end + *beyond, end + *next]);
        }
    }
    rings
}
