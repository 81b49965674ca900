//! Triangles of the bisection tree, whether they are in a mesh or not.

use super::coarsen::is_parents_apex;
use super::{Mesh, TriangleId};
use crate::geometry::{Lattice, LatticePoint};

/// A triangle of the bisection tree: one of a mesh, one that was bisected, or one that would come.
///
/// Parent, children and the triangle across the bisection edge follow from the corners alone; the head of
/// `coarsen.rs` shows why.
///
/// ```text
///            apex
///           /  |  \
///         /    |    \           a leaf of the tree is a triangle of the mesh
///       /  c0  | c1   \
///    end 0 --- m ---- end 1     m: the node that the bisection makes, the apex of both children
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeTriangle {
    apex: LatticePoint,
    ends: [LatticePoint; 2],
    level: u32,
}

impl TreeTriangle {
    /// Returns a triangle of a mesh.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    pub fn from_mesh(mesh: &Mesh, id: TriangleId) -> Self {
        let triangle = mesh.triangle(id);
        let ends = triangle.bisection_edge().map(|end| mesh.node(end));
        Self { apex: mesh.node(triangle.apex()), ends, level: triangle.level() }
    }

    /// Returns the corners: the apex, where the right angle is, and the ends of the bisection edge.
    #[inline]
    pub fn corners(&self) -> [LatticePoint; 3] {
        [self.apex, self.ends[0], self.ends[1]]
    }

    /// Returns how many bisections made this triangle from a coarse one, L(t).
    #[inline]
    pub fn level(&self) -> u32 {
        self.level
    }

    /// Returns the corner with the right angle: the newest node of the triangle, if it is not coarse.
    #[inline]
    pub fn apex(&self) -> LatticePoint {
        self.apex
    }

    /// Returns the node that a bisection of this triangle makes. Its level must not be the deepest of the
    /// lattice.
    #[inline]
    pub fn midpoint(&self) -> LatticePoint {
        self.ends[0].midpoint(self.ends[1])
    }

    /// Returns the two halves. The level must not be the deepest of the lattice.
    #[inline]
    pub fn children(&self) -> [Self; 2] {
        let apex = self.midpoint();
        self.ends.map(|end| Self { apex, ends: [end, self.apex], level: self.level + 1 })
    }

    /// Returns the triangle that this one is half of; `None` of a coarse triangle.
    pub fn parent(&self, lattice: &Lattice) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        let ([first, second], middle) = (self.ends, self.apex);
        let first_is_apex = is_parents_apex(first, middle, self.level, lattice);
        let (apex, end) = if first_is_apex { (first, second) } else { (second, first) };
        // No other triangle has this half of the cut edge: its other end is on the lattice.
        let far = LatticePoint::new(2 * middle.x - end.x, 2 * middle.y - end.y);
        Some(Self { apex, ends: [end, far], level })
    }

    /// Returns the other half of the parent; `None` of a coarse triangle.
    pub fn sibling(&self, lattice: &Lattice) -> Option<Self> {
        let children = self.parent(lattice)?.children();
        children.into_iter().find(|child| !child.is_same(self))
    }

    /// Returns the ancestors of this triangle, from the coarse one to its parent.
    pub fn ancestors(&self, lattice: &Lattice) -> Vec<Self> {
        let mut ancestors: Vec<_> =
            std::iter::successors(self.parent(lattice), |triangle| triangle.parent(lattice)).collect();
        ancestors.reverse();
        ancestors
    }

    /// Returns the mirror image across the bisection edge, `None` where the domain ends there.
    pub fn across(&self, mesh: &Mesh) -> Option<Self> {
        let [p, q] = self.ends;
        let mirrored = |p: u32, q: u32, apex: u32| (p + q).checked_sub(apex);
        let apex = LatticePoint::new(mirrored(p.x, q.x, self.apex.x)?, mirrored(p.y, q.y, self.apex.y)?);
        let image = Self { apex, ..*self };
        image.coarse_entry(mesh).map(|_| image)
    }

    /// Returns whether both are the same triangle. The ends may be in another order.
    #[inline]
    pub fn is_same(&self, other: &Self) -> bool {
        let [p, q] = other.ends;
        self.apex == other.apex && (self.ends == [p, q] || self.ends == [q, p])
    }

    /// Returns the number of the coarse triangle that this lies in, and its entry; `None` beyond the domain.
    pub(in crate::mesh) fn coarse_entry(&self, mesh: &Mesh) -> Option<(usize, TriangleId)> {
        // A point strictly inside, in quarters of a lattice step; there are a power of two of these in a
        // cell.
        let inner = |[apex, p, q]: [u32; 3]| 2 * u64::from(apex) + u64::from(p) + u64::from(q);
        let bits = mesh.lattice().halvings() + 2;
        let steps = 1 << bits;
        let (x, y) = (inner(self.corners().map(|c| c.x)), inner(self.corners().map(|c| c.y)));
        let [columns, rows] = mesh.lattice().cells().map(u64::from);
        let (column, row) = (x >> bits, y >> bits);
        if column >= columns || row >= rows {
            return None;
        }
        let upper = (x & (steps - 1)) + (y & (steps - 1)) > steps;
        let number = 2 * (row * columns + column) as usize + usize::from(upper);
        mesh.coarse.get(number).map(|entry| (number, entry))
    }
}
