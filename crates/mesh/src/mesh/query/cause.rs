//! Finds out why a triangle is in a mesh: because of the rule, or because of compatibility.
//!
//! A triangle t was created when its parent p was bisected, together with the triangle across p's bisection
//! edge. One of these two exceeds its target, or some triangle farther away does, and RefineTriangle
//! (Algorithm 2) reached p through a chain of coarser and coarser triangles:
//!
//! ```text
//!    t0 ──▶ t1 ──▶ t2 ──▶ p        t0 exceeds its target; across the bisection edge of each lies the next,
//!                                  coarser by one level, which has to be bisected first
//! ```
//!
//! To find t0, follow what depends on the node m that the bisection of p made: a half of one of the two
//! parents can be bisected only if m is there. In the smallest mesh for a rule, each node is needed by the
//! rule or by another node, so every such step leads to a triangle one level deeper. Then RefineTriangle is
//! run from the coarse grid for t0 and the triangles that t0 is part of, on a set of nodes: this gives the
//! chain, and proves it. Both take time that grows with the number of levels, not with the mesh.

use std::collections::HashSet;

use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Mesh, TreeTriangle};

/// Why a triangle is in a mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// The triangle belongs to the coarse grid.
    Coarse,
    /// The triangle's parent exceeds its target.
    OwnRule {
        /// The parent.
        parent: TreeTriangle,
    },
    /// The triangle's parent was bisected to keep the mesh compatible.
    Compatibility {
        /// The triangles from the one that exceeds its target to the parent. Each triangle is across the
        /// bisection edge of the previous one: coarser by one level and bisected before it, or, at the last
        /// step only, of the same level and bisected together with it.
        chain: Vec<TreeTriangle>,
    },
    /// No triangle that exceeds its target needs the triangle: the mesh is not up to date with the rule.
    Unneeded,
}

impl Cause {
    /// Returns the triangle whose violation of the rule is the cause.
    pub fn required_by(&self) -> Option<&TreeTriangle> {
        match self {
            Self::OwnRule { parent } => Some(parent),
            Self::Compatibility { chain } => chain.first(),
            Self::Coarse | Self::Unneeded => None,
        }
    }
}

/// More nodes than this are not searched for a cause. With a monotone rule the search takes one step for each
/// level.
const MOST_NODES: usize = 100_000;

impl Mesh {
    /// Returns why a triangle of the bisection tree is in the mesh, or was before it was bisected.
    ///
    /// `exceeds` is the rule that the mesh is up to date with: whether a triangle exceeds its target. Where
    /// it is monotone, as the area rule is, the answer is exact: refining the coarse grid for
    /// [`Cause::required_by`] and what that is part of, and nothing else, makes the triangle. With another
    /// rule, the triangles that the cause is part of need not exceed their targets.
    pub fn cause_of(&self, triangle: &TreeTriangle, mut exceeds: impl FnMut(&TreeTriangle) -> bool) -> Cause {
        let Some(parent) = triangle.parent(self.lattice()) else { return Cause::Coarse };
        if exceeds(&parent) {
            return Cause::OwnRule { parent };
        }
        let chain = self.exceeding_near(&parent, exceeds).and_then(|start| self.chain_to(&parent, &start));
        chain.map_or(Cause::Unneeded, |chain| Cause::Compatibility { chain })
    }

    /// Returns a triangle that exceeds its target and needs the bisection of `parent`.
    fn exceeding_near(
        &self,
        parent: &TreeTriangle,
        mut exceeds: impl FnMut(&TreeTriangle) -> bool,
    ) -> Option<TreeTriangle> {
        let (mut stack, mut seen, mut doubtful) = (vec![*parent], HashSet::new(), None);
        while let Some(triangle) = stack.pop() {
            if !seen.insert(triangle.midpoint()) || seen.len() > MOST_NODES {
                continue;
            }
            let pair = [Some(triangle), triangle.across(self)];
            for one in pair.iter().flatten().filter(|one| exceeds(one)).collect::<Vec<_>>() {
                // With a rule that is not monotone, some triangle above it may be there for other reasons.
                if one.ancestors(self.lattice()).iter().all(&mut exceeds) {
                    return Some(*one);
                }
                doubtful.get_or_insert(*one);
            }
            let halves = pair.iter().flatten().flat_map(TreeTriangle::children);
            stack.extend(halves.filter(|half| self.is_bisected(half)));
        }
        doubtful
    }

    /// Returns the chain from a triangle that exceeds its target, or from one of its ancestors, to `end`.
    fn chain_to(&self, end: &TreeTriangle, start: &TreeTriangle) -> Option<Vec<TreeTriangle>> {
        let wanted = end.midpoint();
        let mut nodes = HashSet::new();
        let mut line = start.ancestors(self.lattice());
        line.push(*start);
        for triangle in line {
            let mut chain = self.refined_with(&triangle, &mut nodes);
            if let Some(last) = chain.iter().position(|link| link.midpoint() == wanted) {
                chain.truncate(last + 1);
                if !chain[last].is_same(end) {
                    chain.push(*end);
                }
                return Some(chain);
            }
        }
        None
    }

    /// RefineTriangle on the coarse grid with some nodes more: adds the nodes that it makes, and returns the
    /// triangles that it calls itself with, the first one first.
    fn refined_with(&self, triangle: &TreeTriangle, nodes: &mut HashSet<LatticePoint>) -> Vec<TreeTriangle> {
        if nodes.contains(&triangle.midpoint()) {
            return Vec::new();
        }
        let mut chain = vec![*triangle];
        let mut current = *triangle;
        // Ends: each turn goes one level up.
        while let Some(across) = current.across(self)
            && !nodes.contains(&across.apex())
            && let Some(coarser) = across.parent(self.lattice())
        {
            chain.push(coarser);
            current = coarser;
        }
        nodes.extend(chain.iter().map(TreeTriangle::midpoint));
        chain
    }
}
