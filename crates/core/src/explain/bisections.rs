//! Which bisections of a mesh its criterion asks for. All others only keep the mesh conforming.

use std::collections::HashSet;

use super::{Demand, asks_to_bisect};
use crate::build::RefinementCriterion;
use crate::mesh::{Limits, Mesh, TreeTriangle};

/// The bisections of a mesh.
///
/// Let B be all bisected triangles of the forest. Every conforming mesh of the forest in which no triangle
/// exceeds its target bisects [`Self::asked`], their ancestors, and with each triangle the one across its
/// bisection edge. If this closure is all of B, no such mesh is smaller.
#[derive(Clone, Debug, PartialEq)]
pub struct Bisections {
    /// The coarse triangles.
    pub coarse: Vec<TreeTriangle>,
    /// The triangles of the mesh.
    pub leaves: Vec<TreeTriangle>,
    /// The bisected triangles that the criterion asks to bisect, and why.
    pub asked: Vec<(TreeTriangle, Demand)>,
}

impl Bisections {
    /// Returns the bisections of a mesh that is up to date with a criterion and limits.
    pub fn of(mesh: &Mesh, criterion: &RefinementCriterion<'_>, limits: &Limits) -> Self {
        let leaves: Vec<_> = mesh.triangles().map(|(id, _)| TreeTriangle::of(mesh, id)).collect();
        let (mut coarse, mut asked, mut known) = (Vec::new(), Vec::new(), HashSet::new());
        for leaf in &leaves {
            if leaf.level() == 0 {
                coarse.push(*leaf);
            }
            let mut above = leaf.parent(mesh.lattice());
            while let Some(triangle) = above.filter(|triangle| known.insert(key(triangle))) {
                if asks_to_bisect(&triangle, criterion, limits) {
                    asked.push((triangle, Demand::of(&triangle, criterion)));
                }
                above = triangle.parent(mesh.lattice());
                if above.is_none() {
                    coarse.push(triangle);
                }
            }
        }
        Self { coarse, leaves, asked }
    }
}

/// No two triangles have the same apex and the same middle of the bisection edge.
fn key(triangle: &TreeTriangle) -> [u32; 4] {
    let [apex, p, q] = triangle.corners();
    [apex.x, apex.y, p.x + q.x, p.y + q.y]
}
