//! The least error that is possible with a number of triangles.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::{SurfaceNodes, SurfaceRule};
use crate::domain::DomainOnLattice;
use crate::mesh::{Element, Limits, Mesh, Progress, TriangleId};

/// Finds the least error that a mesh of at most so many triangles can have, in slices.
///
/// The triangle of the largest error is bisected, again and again. Each time that all errors are below those
/// of the triangles bisected so far, the mesh is the smallest of its largest error; the last one with no more
/// triangles than asked for has the least.
#[derive(Clone, Debug)]
pub struct ErrorQueue {
    mesh: Mesh,
    most: usize,
    /// Triangles at this level are not bisected.
    deepest_level: u32,
    nodes: SurfaceNodes,
    queue: BinaryHeap<Entry>,
    /// Triangles whose error is not known yet.
    new: Vec<TriangleId>,
    /// By triangle, whether it is counted: it is in the domain.
    is_counted: Vec<bool>,
    counted: usize,
    /// The least error of the triangles that were bisected.
    bisected: f64,
    /// The largest error of the last mesh with few enough triangles.
    least: Option<f64>,
    chain: Vec<TriangleId>,
}

/// A triangle with its error. It counts as long as the triangle has this level: bisected, it has the next.
#[derive(Clone, Copy, Debug)]
struct Entry {
    error: f64,
    id: TriangleId,
    level: u32,
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error).then(other.id.cmp(&self.id))
    }
}

impl ErrorQueue {
    /// Returns the work on a mesh that meets everything else that is asked of it.
    pub fn new(mesh: Mesh, most: usize, limits: &Limits) -> Self {
        let deepest = mesh.lattice().deepest_level();
        Self {
            most: most.min(limits.most_triangles()),
            deepest_level: limits.max_level.unwrap_or(deepest).min(deepest),
            nodes: SurfaceNodes::default(),
            queue: BinaryHeap::new(),
            new: (0..mesh.raw_triangle_count()).map(TriangleId::from_index).collect(),
            is_counted: Vec::new(),
            counted: 0,
            bisected: f64::INFINITY,
            least: None,
            chain: Vec::new(),
            mesh,
        }
    }

    /// Returns the number of triangles so far.
    pub fn triangles(&self) -> usize {
        self.mesh.raw_triangle_count()
    }

    /// One slice of work: about `budget` triangles. `is_bound` says which triangles must be bisected by
    /// another rule that is not monotone.
    ///
    /// # Errors
    /// Fails with the errors of `is_bound`.
    pub fn advance<E>(
        &mut self,
        rule: &SurfaceRule,
        domain: &DomainOnLattice,
        mut is_bound: impl FnMut(&Element) -> Result<bool, E>,
        budget: usize,
    ) -> Result<Progress, E> {
        for _ in 0..budget {
            if let Some(id) = self.new.pop() {
                self.add(id, rule, domain, &mut is_bound)?;
            } else if self.is_finished() {
                return Ok(Progress::Done);
            } else {
                self.bisect_largest();
            }
        }
        Ok(Progress::More)
    }

    /// Returns the largest error of the mesh with the least; `None` where the mesh has too many triangles
    /// from the start.
    pub fn least_error(&self) -> Option<f64> {
        self.least
    }

    /// Notes the error of a triangle, and counts it.
    fn add<E>(
        &mut self,
        id: TriangleId,
        rule: &SurfaceRule,
        domain: &DomainOnLattice,
        is_bound: &mut impl FnMut(&Element) -> Result<bool, E>,
    ) -> Result<(), E> {
        let element = self.mesh.element(id);
        let level = element.triangle.level();
        let is_inside = !domain.excludes(&element);
        if level < self.deepest_level {
            let error = match is_bound(&element)? {
                true => f64::INFINITY,
                false => rule.counted_error(&element, &mut self.nodes),
            };
            if error > 0.0 {
                self.queue.push(Entry { error, id, level });
            }
        }
        if id.index() >= self.is_counted.len() {
            self.is_counted.resize(id.index() + 1, false);
        }
        let was_inside = std::mem::replace(&mut self.is_counted[id.index()], is_inside);
        self.counted = self.counted + usize::from(is_inside) - usize::from(was_inside);
        Ok(())
    }

    /// Returns whether no further triangle can be bisected. Notes the mesh as it is where it is the smallest
    /// of its error.
    fn is_finished(&mut self) -> bool {
        while self.queue.peek().is_some_and(|top| self.mesh.triangle(top.id).level() != top.level) {
            self.queue.pop();
        }
        let largest = self.queue.peek().map_or(0.0, |top| top.error);
        if self.counted > self.most {
            return true;
        }
        if largest < self.bisected {
            self.least = Some(largest);
        }
        largest == 0.0
    }

    /// Bisects the triangle of the largest error, and those that must be bisected with it.
    fn bisect_largest(&mut self) {
        let Some(Entry { error, id, .. }) = self.queue.pop() else { return };
        self.bisected = self.bisected.min(error);
        let (first, new) = (self.mesh.raw_triangle_count(), &mut self.new);
        self.mesh.refine_triangle_with(id, &mut self.chain, |_, parent| new.push(parent));
        self.new.extend((first..self.mesh.raw_triangle_count()).map(TriangleId::from_index));
    }
}
