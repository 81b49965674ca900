//! Smaller triangles where the rim of the area of paths passes: along all of it, around places beside it, and
//! where it leaves no way between two places.

use std::convert::Infallible;
use std::sync::Arc;

use glam::DVec2;

use super::Passage;
use super::bisection::Bisection;
use super::obstacle::parts;
use super::path_mesh::{NONE, PathMesh, contains};
use crate::geometry::BestFirst;
use crate::mesh::Progress;

/// Triangles along the rim are bisected until their diameter is this part of the longer side of all of them,
const COARSEST: f64 = 1.0 / 250.0;
/// and so often at least: their diameter is then a quarter of what it was.
const DIVISIONS: u8 = 4;
/// The most triangles that bisection along the rim adds.
const MOST_ALONG: usize = 100_000;
/// The most triangles that bisection adds for the places of paths, each time.
const MOST_FOR_PLACES: usize = 20_000;
/// The diameter of triangles around a place, as a part of the distance from it and of its own distance from
/// the rim.
const GRADING: [f64; 2] = [0.3, 0.25];
/// How often the triangles on a way are divided that the rim blocks.
const MOST_ROUNDS: usize = 5;
/// The search for ways avoids triangles through which the rim passes: lengths in them count this many times.
const DETOUR: f64 = 3.0;

/// Bisection of the triangles through which the rim of the area passes, the largest first, in slices.
pub(super) struct RimDivision {
    bisection: Bisection,
    coarsest: f64,
    /// The number of triangles before.
    before: usize,
}

impl RimDivision {
    /// Begins; `None` where no triangle is bisected.
    pub fn new(mesh: &mut PathMesh) -> Option<Self> {
        if !mesh.area().divides_meshes() {
            return None;
        }
        let before = mesh.triangle_count();
        let coarsest = COARSEST * mesh.bounds().map_or(0.0, |bounds| bounds.size().max_element());
        let partly = mesh.partly();
        partly.iter().for_each(|&t| mesh.triangles[t as usize].divisions = DIVISIONS);
        let wanted = partly.iter().map(|&t| (importance_at_rim(mesh, t, coarsest), t));
        let wanted: Vec<(f64, u32)> = wanted.filter(|wanted| wanted.0 > 0.0).collect();
        let bisection = Bisection::new(mesh, wanted, MOST_ALONG);
        Some(Self { bisection, coarsest, before })
    }

    /// Bisects `triangles` triangles.
    pub fn advance(&mut self, mesh: &mut PathMesh, triangles: usize) -> Progress {
        let mut importance =
            |mesh: &PathMesh, t: u32| Ok::<_, Infallible>(importance_at_rim(mesh, t, self.coarsest));
        let Ok(progress) = self.bisection.advance(mesh, triangles, &mut importance);
        progress
    }

    /// Returns whether any triangle was bisected.
    pub fn has_changed(&self, mesh: &PathMesh) -> bool {
        mesh.triangle_count() > self.before
    }
}

fn importance_at_rim(mesh: &PathMesh, t: u32, coarsest: f64) -> f64 {
    if_partly(mesh, t, |mesh, t| {
        let (diameter, divisions) = (mesh.diameter(t), mesh.triangles[t as usize].divisions);
        if diameter > coarsest || divisions > 0 { diameter } else { 0.0 }
    })
}

/// Returns the importance of a triangle through which the rim passes; that of others is 0.
fn if_partly(mesh: &PathMesh, t: u32, importance: impl Fn(&PathMesh, u32) -> f64) -> f64 {
    match mesh.passage(t) {
        Passage::Partly => importance(mesh, t),
        Passage::Closed | Passage::Open => 0.0,
    }
}

impl PathMesh {
    /// Returns the mesh with smaller triangles for paths that visit places: around those beside the rim of
    /// the area, and on ways between them that are as narrow as a triangle. It depends on nothing but the
    /// mesh and the places, and is the mesh itself where neither is needed.
    pub fn detailed(self: &Arc<Self>, routes: &[Vec<DVec2>]) -> Arc<Self> {
        if self.area().is_everything() {
            return Arc::clone(self);
        }
        let mut mesh = Arc::clone(self);
        let closed = routes.iter().flatten().filter(|&&place| place.is_finite());
        let closed: Vec<(DVec2, f64)> = closed.filter_map(|&place| mesh.closed_place(place)).collect();
        if !closed.is_empty() {
            Arc::make_mut(&mut mesh).divide_around(&closed);
        }
        for _ in 0..MOST_ROUNDS {
            let on_ways = mesh.partly_on_ways(routes);
            if on_ways.is_empty() {
                break;
            }
            Arc::make_mut(&mut mesh).divide_ways(&on_ways);
        }
        if mesh.triangle_count() > self.triangle_count() {
            let mesh = Arc::make_mut(&mut mesh);
            mesh.sort_along_curve();
        }
        mesh
    }

    /// Returns the triangles through which the rim of the area passes.
    fn partly(&self) -> Vec<u32> {
        (0..self.triangles.len() as u32).filter(|&t| self.passage(t) == Passage::Partly).collect()
    }

    /// Bisects triangles as long as they and their parts are important.
    fn divide(&mut self, triangles: &[u32], most: usize, importance: impl Fn(&Self, u32) -> f64) {
        let of_partly = |mesh: &Self, t: u32| if_partly(mesh, t, &importance);
        let wanted = triangles.iter().map(|&t| (of_partly(self, t), t)).filter(|wanted| wanted.0 > 0.0);
        let Ok(()) = self.bisect(wanted.collect(), most, |mesh, t| Ok::<_, Infallible>(of_partly(mesh, t)));
    }

    /// Returns a place of the area that no open triangle holds, with its distance from the rim.
    fn closed_place(&self, place: DVec2) -> Option<(DVec2, f64)> {
        if self.open_triangle_at(place).is_some() || self.locate(place, Passage::Partly).is_none() {
            return None;
        }
        Some((place, self.area().slack(place))).filter(|&(_, slack)| slack > 0.0)
    }

    /// Bisects triangles around places, the more the nearer.
    fn divide_around(&mut self, places: &[(DVec2, f64)]) {
        let [away, of_slack] = GRADING;
        let partly = self.partly();
        self.divide(&partly, MOST_FOR_PLACES, |mesh, t| {
            let (diameter, corners) = (mesh.diameter(t), mesh.corners(t));
            let excess = |&(place, slack): &(DVec2, f64)| {
                let distance =
                    if contains(&corners, place) { 0.0 } else { corners[0].distance(place) - diameter };
                diameter - away * distance.max(0.0) - of_slack * slack
            };
            places.iter().map(excess).fold(0.0, f64::max)
        });
    }

    /// Returns the triangles through which the rim passes on ways between successive places, and beside them,
    /// that open triangles do not connect.
    fn partly_on_ways(&self, routes: &[Vec<DVec2>]) -> Vec<u32> {
        let [mut open, mut passable] =
            [Passage::Open, Passage::Partly].map(|least| parts(self, |triangle| triangle.passage >= least));
        let mut found = Vec::new();
        for pair in routes.iter().flat_map(|route| route.windows(2)) {
            let [Some(from), Some(to)] = [pair[0], pair[1]].map(|place| self.open_triangle_at(place)) else {
                continue;
            };
            let [a, b] = [from, to].map(|t| self.triangles[t as usize].corners[0] as usize);
            if open.root(a) == open.root(b) || passable.root(a) != passable.root(b) {
                continue;
            }
            let nodes = self.way(from, to).into_iter().flat_map(|t| self.triangles[t as usize].corners);
            found.extend(nodes.flat_map(|node| self.around(node).iter().copied()));
        }
        found.sort_unstable();
        found.dedup();
        found.retain(|&t| self.passage(t) == Passage::Partly);
        found
    }

    /// Bisects triangles on ways that are not open.
    fn divide_ways(&mut self, triangles: &[u32]) {
        self.triangles.iter_mut().for_each(|triangle| triangle.divisions = 0);
        triangles.iter().for_each(|&t| self.triangles[t as usize].divisions = DIVISIONS);
        self.divide(triangles, MOST_FOR_PLACES, |mesh, t| {
            if mesh.triangles[t as usize].divisions > 0 { mesh.diameter(t) } else { 0.0 }
        });
    }

    /// Returns the triangles of a short way from one to another through those that are not closed: from node
    /// to node, so that it also finds parts that only share a node.
    fn way(&self, from: u32, to: u32) -> Vec<u32> {
        let mut known = vec![(f64::INFINITY, NONE, NONE); self.nodes.len()];
        let mut waiting = BestFirst::default();
        for node in self.triangles[from as usize].corners {
            known[node as usize] = (0.0, NONE, from);
            waiting.push(0.0, node);
        }
        while let Some((length, node)) = waiting.pop() {
            if length > known[node as usize].0 {
                continue;
            }
            for &t in self.around(node) {
                let factor = if self.passage(t) == Passage::Open { 1.0 } else { DETOUR };
                for next in self.triangles[t as usize].corners {
                    let step = self.nodes[node as usize].distance(self.nodes[next as usize]);
                    let length = length + factor * step;
                    if length < known[next as usize].0 {
                        known[next as usize] = (length, node, t);
                        waiting.push(length, next);
                    }
                }
            }
        }
        let mut way = Vec::new();
        let mut node = self.triangles[to as usize].corners[0];
        // Ends: each node has a shorter way than the one after it.
        while node != NONE {
            let (_, before, through) = known[node as usize];
            if through != NONE {
                way.push(through);
            }
            node = before;
        }
        way
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Mesh};

    #[test]
    fn a_way_leads_through_triangles_that_touch_from_one_to_another() {
        let lattice = Lattice::covering(Rect::UNIT, 0.1, 10_000).unwrap();
        let mesh = PathMesh::new(Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap().view());
        let at = |x, y| mesh.open_triangle_at(DVec2::new(x, y)).unwrap();
        for (from, to) in [(at(0.03, 0.04), at(0.97, 0.52)), (at(0.51, 0.9), at(0.52, 0.13))] {
            let way = mesh.way(from, to);
            let touch = |a: u32, b: u32| {
                let [a, b] = [a, b].map(|t| mesh.triangles[t as usize].corners);
                a.iter().any(|node| b.contains(node))
            };
            let ends = [to, from];
            let all: Vec<u32> = ends[..1].iter().chain(&way).chain(&ends[1..]).copied().collect();
            assert!(way.len() > 5 && all.windows(2).all(|pair| touch(pair[0], pair[1])), "{way:?}");
        }
    }
}
