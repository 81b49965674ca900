//! Bisection of triangles for paths, where the display mesh is too coarse for the cost.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Passage;
use super::path_mesh::{NONE, PathMesh, PathTriangle, obtuse_corner};
use crate::mesh::Progress;

/// A triangle that waits for bisection, the most important first.
#[derive(Clone, Copy, PartialEq)]
struct Waiting {
    importance: f64,
    triangle: u32,
    /// How often the triangle was bisected when it was put.
    version: u32,
}

impl Eq for Waiting {}
impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.importance.total_cmp(&other.importance).then(other.triangle.cmp(&self.triangle))
    }
}
impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The work of [`PathMesh::bisect`], in slices. What was derived from its mesh must be
/// [forgotten](PathMesh::clear_indices) afterwards.
pub(super) struct Bisection {
    waiting: BinaryHeap<Waiting>,
    /// How often each triangle was bisected.
    versions: Vec<u32>,
    /// The triangles that the mesh may have.
    most: usize,
}

impl Bisection {
    pub fn new(mesh: &PathMesh, wanted: Vec<(f64, u32)>, most: usize) -> Self {
        let first = |(importance, triangle)| Waiting { importance, triangle, version: 0 };
        let waiting = wanted.into_iter().map(first).collect();
        let count = mesh.triangles.len();
        Self { waiting, versions: vec![0; count], most: count.saturating_add(most) }
    }

    /// Bisects a limited number of triangles, the most important first, with those that must be bisected
    /// before.
    ///
    /// # Errors
    /// Fails as [`PathMesh::bisect`] does.
    pub fn advance<E>(
        &mut self,
        mesh: &mut PathMesh,
        triangles: usize,
        importance: &mut impl FnMut(&PathMesh, u32) -> Result<f64, E>,
    ) -> Result<Progress, E> {
        let mut changed = Vec::new();
        let mut left = triangles;
        while let Some(Waiting { triangle, version, .. }) = self.waiting.pop() {
            if self.versions[triangle as usize] != version {
                continue;
            }
            if mesh.triangles.len() >= self.most {
                break;
            }
            mesh.bisect_one(triangle, &mut changed);
            self.versions.resize(mesh.triangles.len(), 0);
            for &triangle in &changed {
                self.versions[triangle as usize] += 1;
            }
            changed.sort_unstable();
            changed.dedup();
            for triangle in changed.drain(..) {
                let importance = importance(mesh, triangle)?;
                if importance > 0.0 {
                    let version = self.versions[triangle as usize];
                    self.waiting.push(Waiting { importance, triangle, version });
                }
            }
            left -= 1;
            if left == 0 {
                return Ok(Progress::More);
            }
        }
        Ok(Progress::Done)
    }
}

impl PathMesh {
    /// Bisects triangles, the most important first, until none is important or there are `most` more.
    ///
    /// `wanted` has triangles to bisect with their importance. `importance` is asked about the parts of each
    /// bisected triangle; 0 asks for nothing. The mesh stays conforming: a triangle is bisected at its
    /// longest edge, together with the one across, which is bisected before if another edge of it is longer
    /// (Rivara's method). In a mesh of the bisection forest these are its own bisections. Nodes keep their
    /// numbers, new ones follow; one part of a triangle keeps its number, the other follows.
    ///
    /// # Errors
    /// Fails with the errors of `importance`; the mesh is of no use then.
    pub(super) fn bisect<E>(
        &mut self,
        wanted: Vec<(f64, u32)>,
        most: usize,
        mut importance: impl FnMut(&Self, u32) -> Result<f64, E>,
    ) -> Result<(), E> {
        if wanted.is_empty() {
            return Ok(());
        }
        Bisection::new(self, wanted, most).advance(self, usize::MAX, &mut importance)?;
        self.clear_indices();
        Ok(())
    }

    /// Bisects a triangle, and before it those that must be. `changed` gets all parts.
    fn bisect_one(&mut self, triangle: u32, changed: &mut Vec<u32>) {
        let mut stack = vec![triangle];
        // Ends: each triangle on the stack has a longer longest edge than the one below it.
        while let Some(&t) = stack.last() {
            let edge = self.longest_edge(t);
            let across = self.across[t as usize][edge];
            if across == NONE {
                self.split(t, edge, changed);
            } else {
                let other = self.longest_edge(across);
                if self.across[across as usize][other] != t {
                    stack.push(across);
                    continue;
                }
                self.split_both([t, across], [edge, other], changed);
            }
            stack.pop();
        }
    }

    /// Returns the place of the first end of the longest edge among the corners. Of edges of equal length,
    /// the one with the greater numbers: all triangles agree.
    fn longest_edge(&self, t: u32) -> usize {
        let corners = self.triangles[t as usize].corners;
        let key = |edge: usize| {
            let [a, b] = [corners[edge], corners[(edge + 1) % 3]];
            let squared = self.nodes[a as usize].distance_squared(self.nodes[b as usize]);
            (squared, a.max(b), a.min(b))
        };
        let greater = |a: usize, b: usize| if key(b) > key(a) { b } else { a };
        greater(greater(0, 1), 2)
    }

    /// Splits a triangle at the middle of an edge, and returns the node there and the new part.
    ///
    /// ```text
    ///         apex
    ///        / | \          t keeps the part at a
    ///       / t|new\
    ///      a---m---b
    /// ```
    fn split_at(&mut self, t: u32, edge: usize, middle: u32, changed: &mut Vec<u32>) -> u32 {
        let old = self.triangles[t as usize];
        let [a, b, apex] = [0, 1, 2].map(|step| old.corners[(edge + step) % 3]);
        let [_, beyond_b, beyond_a] = [0, 1, 2].map(|step| self.across[t as usize][(edge + step) % 3]);
        let new = self.triangles.len() as u32;
        for (slot, corners, across) in
            [(t, [a, middle, apex], [NONE, new, beyond_a]), (new, [middle, b, apex], [NONE, beyond_b, t])]
        {
            let places = corners.map(|node| self.nodes[node as usize]);
            let mut triangle = PathTriangle { corners, obtuse: obtuse_corner(&places), ..old };
            triangle.divisions = old.divisions.saturating_sub(1);
            if old.passage == Passage::Partly && !self.area().is_everything() {
                triangle.passage = self.area().passage(&places);
                triangle.is_kept_out = triangle.passage == Passage::Closed;
            }
            let obtuse = triangle.obtuse;
            self.has_obtuse |= obtuse < 3 && triangle.is_passable();
            if slot == t {
                (self.triangles[t as usize], self.across[t as usize]) = (triangle, across);
            } else {
                self.triangles.push(triangle);
                self.across.push(across);
            }
        }
        if beyond_b != NONE {
            let edge = self.across[beyond_b as usize].iter_mut().find(|across| **across == t);
            *edge.expect("neighbours know each other") = new;
        }
        changed.extend([t, new]);
        new
    }

    fn middle_of(&mut self, t: u32, edge: usize) -> u32 {
        let corners = self.triangles[t as usize].corners;
        let [a, b] = [corners[edge], corners[(edge + 1) % 3]].map(|node| self.nodes[node as usize]);
        self.nodes.push(a.midpoint(b));
        self.nodes.len() as u32 - 1
    }

    fn split(&mut self, t: u32, edge: usize, changed: &mut Vec<u32>) {
        let middle = self.middle_of(t, edge);
        self.split_at(t, edge, middle, changed);
    }

    /// Splits two triangles at the edge that they share.
    fn split_both(&mut self, [s, t]: [u32; 2], [edge_s, edge_t]: [usize; 2], changed: &mut Vec<u32>) {
        let middle = self.middle_of(s, edge_s);
        let new_s = self.split_at(s, edge_s, middle, changed);
        let new_t = self.split_at(t, edge_t, middle, changed);
        // s has the part at its first end, which is the second end for t.
        self.across[s as usize][0] = new_t;
        self.across[new_t as usize][0] = s;
        self.across[t as usize][0] = new_s;
        self.across[new_s as usize][0] = t;
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use glam::{DVec2, dvec2};

    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Mesh};
    use crate::path::Passage;

    /// Triangles cover what they did, each edge has its triangles, and rows their nodes.
    fn assert_sound(mesh: &PathMesh, area: f64) {
        let twice_area = |t: u32| {
            let [a, b, c] = mesh.corners(t);
            (b - a).perp_dot(c - a)
        };
        let all = 0..mesh.triangle_count() as u32;
        assert!(all.clone().all(|t| twice_area(t) > 0.0));
        assert!((all.clone().map(twice_area).sum::<f64>() - 2.0 * area).abs() < 1e-9 * area);
        let mut edges = std::collections::BTreeMap::new();
        for t in all.clone() {
            for edge in 0..3 {
                let corners = mesh.triangles[t as usize].corners;
                assert!(edges.insert((corners[edge], corners[(edge + 1) % 3]), t).is_none());
                assert!(mesh.around(corners[edge]).contains(&t));
            }
        }
        for t in all {
            for edge in 0..3 {
                let corners = mesh.triangles[t as usize].corners;
                let across = edges.get(&(corners[(edge + 1) % 3], corners[edge]));
                assert_eq!(mesh.across[t as usize][edge], across.copied().unwrap_or(NONE));
            }
        }
    }

    #[test]
    fn bisected_meshes_conform_and_cover_the_same() {
        let mut random = fastrand::Rng::with_seed(1410);
        for _ in 0..20 {
            let lattice = Lattice::covering(Rect::UNIT, 0.3, 1000).unwrap();
            let coarse = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
            let mut mesh = PathMesh::new(coarse.view());
            // Nodes inside are moved, so that the longest edges are any.
            let inside = |p: DVec2| p.min(1.0 - p).min_element() > 0.01;
            let moved = random.bool();
            for node in mesh.nodes.iter_mut().filter(|node| moved && inside(**node)) {
                *node += 0.05 * dvec2(random.f64() - 0.5, random.f64() - 0.5);
            }
            let near = dvec2(random.f64(), random.f64());
            let wants = |mesh: &PathMesh, t: u32| {
                let [a, b, c] = mesh.corners(t);
                let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
                let target = 0.02 + 0.2 * ((a + b + c) / 3.0).distance(near);
                Ok::<f64, Infallible>((longest - target).max(0.0))
            };
            let all = |mesh: &PathMesh| (0..mesh.triangle_count() as u32).map(|t| (1.0, t)).collect();
            let wanted = (0..mesh.triangle_count() as u32).map(|t| (wants(&mesh, t).unwrap(), t));
            mesh.bisect(wanted.filter(|wanted| wanted.0 > 0.0).collect(), usize::MAX, wants).unwrap();
            assert_sound(&mesh, 1.0);
            assert!((0..mesh.triangle_count() as u32).all(|t| wants(&mesh, t) == Ok(0.0)));
            assert!(mesh.locate(near, Passage::Open).is_some());
            let before = mesh.triangle_count();
            mesh.bisect(all(&mesh), 10, |_, _| Ok::<f64, Infallible>(1.0)).unwrap();
            assert_sound(&mesh, 1.0);
            assert!((before + 10..before + 60).contains(&mesh.triangle_count()));
        }
    }
}
