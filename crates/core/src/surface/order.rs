//! The order in which triangles are bisected for a surface.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::SurfaceNodes;
use super::two_sum::TwoSum;
use crate::geometry::LatticePoint;
use crate::layers::SurfaceNorm;
use crate::mesh::{Element, Mesh, TriangleId, fingerprint_of};

/// A mesh whose triangles are bisected one after the other, those that count most first.
///
/// For the largest difference, the triangle of the largest error comes first. For a sum of squares, it is
/// that of the largest part of the sum; a triangle whose part is larger than that of one above it in the tree
/// counts with the smaller one, so that no bisection is before the one that makes its triangle. The error
/// falls with the number of triangles at the best rate there is for the surface \[BDDP2002\].
#[derive(Clone, Debug)]
pub(super) struct BisectionOrder {
    mesh: Mesh,
    shares: Shares,
    /// The least key of the triangles that were bisected so far.
    least: f64,
    /// The triangles that were bisected so far, as [`triangle_key`]; not those that had to be bisected with
    /// them.
    bisected: Vec<u64>,
    chain: Vec<TriangleId>,
}

/// What is known of the triangles of a mesh.
#[derive(Clone, Debug)]
struct Shares {
    norm: SurfaceNorm,
    /// Triangles at this level are not bisected.
    deepest_level: u32,
    nodes: SurfaceNodes,
    queue: BinaryHeap<OrderEntry>,
    /// By triangle; those of the first mesh after these are not known yet.
    shares: Vec<TriangleShare>,
    /// Triangles of the domain.
    counted: usize,
    /// The sum of the squares of all triangles.
    squares: TwoSum,
}

/// What a rule says about a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeasuredTriangle {
    /// Whether it must be bisected in any case.
    pub(super) is_bound: bool,
    /// Its largest difference, or its part of a sum of squares.
    pub(super) error: f64,
    /// Whether it is large enough to be bisected for its error.
    pub(super) may_be_bisected: bool,
    /// Whether it is in the domain.
    pub(super) is_inside: bool,
}

/// What is known of a triangle.
#[derive(Clone, Copy, Debug, Default)]
struct TriangleShare {
    /// Its part of the sum of squares.
    squares: f64,
    /// What it counts with: the least part of it and of those above it in the tree.
    order: f64,
    is_inside: bool,
}

/// A triangle in the queue. It counts as long as the triangle has this level: bisected, it has the next.
#[derive(Clone, Copy, Debug)]
struct OrderEntry {
    key: f64,
    id: TriangleId,
    level: u32,
}

impl PartialEq for OrderEntry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for OrderEntry {}

impl PartialOrd for OrderEntry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OrderEntry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key.total_cmp(&other.key).then(other.id.cmp(&self.id))
    }
}

/// Returns a number that tells triangles, given by their corners, apart.
pub(super) fn triangle_key(corners: [LatticePoint; 3]) -> u64 {
    fingerprint_of([corners]).0 as u64
}

impl BisectionOrder {
    /// Creates the order from a mesh on.
    pub(super) fn new(mesh: Mesh, norm: SurfaceNorm, deepest_level: u32) -> Self {
        let shares = Shares {
            norm,
            deepest_level,
            nodes: SurfaceNodes::default(),
            queue: BinaryHeap::new(),
            shares: Vec::with_capacity(mesh.raw_triangle_count()),
            counted: 0,
            squares: TwoSum::default(),
        };
        Self { mesh, shares, least: f64::INFINITY, bisected: Vec::new(), chain: Vec::new() }
    }

    /// Returns the number of triangles, those outside the domain included.
    pub(super) fn triangles(&self) -> usize {
        self.mesh.raw_triangle_count()
    }

    /// Returns the number of triangles in the domain.
    pub(super) fn counted(&self) -> usize {
        self.shares.counted
    }

    /// Returns the sum of the parts of all triangles.
    pub(super) fn squares(&self) -> f64 {
        self.shares.squares.value()
    }

    /// Returns the triangles that were bisected so far, in order, as [`triangle_key`].
    pub(super) fn bisected(&self) -> &[u64] {
        &self.bisected
    }

    /// Measures the next triangle of the first mesh. Returns `false` when all are known.
    pub(super) fn measure_next<E>(
        &mut self,
        measure: impl FnOnce(&Element, &mut SurfaceNodes) -> Result<MeasuredTriangle, E>,
    ) -> Result<bool, E> {
        let Self { mesh, shares, .. } = self;
        if shares.shares.len() == mesh.raw_triangle_count() {
            return Ok(false);
        }
        let id = TriangleId::from_index(shares.shares.len());
        shares.shares.push(TriangleShare::default());
        shares.put(mesh, id, f64::INFINITY, measure)?;
        Ok(true)
    }

    /// Returns the key of the triangle that is next, 0 where none is left, and whether the mesh consists of
    /// the bisections with a larger key.
    pub(super) fn next_key(&mut self) -> (f64, bool) {
        let Self { mesh, shares, least, .. } = self;
        while shares.queue.peek().is_some_and(|top| mesh.triangle(top.id).level() != top.level) {
            shares.queue.pop();
        }
        let key = shares.queue.peek().map_or(0.0, |top| top.key);
        (key, key < *least)
    }

    /// Bisects the next triangle, and those that must be bisected with it.
    pub(super) fn bisect_next<E>(
        &mut self,
        mut measure: impl FnMut(&Element, &mut SurfaceNodes) -> Result<MeasuredTriangle, E>,
    ) -> Result<(), E> {
        let Self { mesh, shares, least, bisected, chain } = self;
        let Some(OrderEntry { key, id, .. }) = shares.queue.pop() else { return Ok(()) };
        *least = least.min(key);
        bisected.push(triangle_key(mesh.corners(id)));
        let mut result = Ok(());
        // Measured at once: a triangle of one bisection can be bisected by the next one.
        mesh.refine_triangle_with(id, chain, |mesh, parent| {
            let above = shares.take(parent);
            let child = TriangleId::from_index(shares.shares.len());
            shares.shares.push(TriangleShare::default());
            for id in [parent, child] {
                if result.is_ok() {
                    result = shares.put(mesh, id, above, &mut measure);
                }
            }
        });
        result
    }
}

impl Shares {
    /// Takes the part of a triangle away, which was bisected, and returns what it counted with.
    fn take(&mut self, id: TriangleId) -> f64 {
        let TriangleShare { squares, order, is_inside } = std::mem::take(&mut self.shares[id.index()]);
        self.counted -= usize::from(is_inside);
        self.squares.add(-squares);
        order
    }

    /// Measures a triangle, whose triangle above counted with `above`, and puts it into the queue.
    fn put<E>(
        &mut self,
        mesh: &Mesh,
        id: TriangleId,
        above: f64,
        measure: impl FnOnce(&Element, &mut SurfaceNodes) -> Result<MeasuredTriangle, E>,
    ) -> Result<(), E> {
        let element = mesh.element(id);
        let MeasuredTriangle { is_bound, error, may_be_bisected, is_inside } =
            measure(&element, &mut self.nodes)?;
        let order = error.min(above);
        let (key, squares) = match self.norm {
            SurfaceNorm::Largest => (error, 0.0),
            SurfaceNorm::RootMeanSquare | SurfaceNorm::Gradient => (order, error),
        };
        let key = if is_bound { f64::INFINITY } else { key };
        let level = element.triangle.level();
        if level < self.deepest_level && key > 0.0 && (is_bound || may_be_bisected) {
            self.queue.push(OrderEntry { key, id, level });
        }
        self.counted += usize::from(is_inside);
        self.squares.add(squares);
        self.shares[id.index()] = TriangleShare { squares, order, is_inside };
        Ok(())
    }
}
