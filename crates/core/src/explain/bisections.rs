//! Which bisections of a mesh its criterion asks for. All others only keep the mesh conforming.

use std::collections::HashSet;

use glam::DVec2;
use rayon::prelude::*;

use super::asks_to_bisect;
use crate::build::RefinementCriterion;
use crate::mesh::{Limits, Mesh, TreeTriangle};
use crate::surface::SurfaceDemand;

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
    /// The bisected triangles that the criterion asks to bisect, and what shows that.
    pub asked: Vec<(TreeTriangle, Witness)>,
}

/// What shows that a triangle exceeds its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Witness {
    /// The outline of the domain passes through it, and its diameter exceeds that of the boundary.
    Outline,
    /// A point of the triangle, in world units, at which h̄ is below its diameter.
    Target {
        /// The point.
        at: DVec2,
        /// h̄ there, in world units.
        target: f64,
    },
    /// A surface is farther from it than a layer allows.
    Surface(SurfaceDemand),
}

impl Bisections {
    /// Returns the bisections of a mesh that is up to date with a criterion and limits.
    pub fn of(mesh: &Mesh, criterion: &RefinementCriterion<'_>, limits: &Limits) -> Self {
        let leaves: Vec<_> = mesh.triangles().map(|(id, _)| TreeTriangle::from_mesh(mesh, id)).collect();
        let (mut coarse, mut bisected, mut known) = (Vec::new(), Vec::new(), HashSet::new());
        for leaf in &leaves {
            if leaf.level() == 0 {
                coarse.push(*leaf);
            }
            let mut above = leaf.parent(mesh.lattice());
            while let Some(triangle) = above.filter(|triangle| known.insert(key(triangle))) {
                bisected.push(triangle);
                above = triangle.parent(mesh.lattice());
                if above.is_none() {
                    coarse.push(triangle);
                }
            }
        }
        let asked = bisected.into_par_iter().filter(|triangle| asks_to_bisect(triangle, criterion, limits));
        let asked = asked.map(|triangle| (triangle, Witness::of(&triangle, mesh, criterion))).collect();
        Self { coarse, leaves, asked }
    }
}

impl Witness {
    /// Returns what shows that a triangle exceeds its target, if it does.
    fn of(triangle: &TreeTriangle, mesh: &Mesh, criterion: &RefinementCriterion<'_>) -> Self {
        let (corners, level) = (triangle.corners(), triangle.level());
        if criterion.outline_asks(corners, level) {
            return Self::Outline;
        }
        if let Some(demand) = criterion.surface_demand(corners) {
            return Self::Surface(demand);
        }
        // Any point will do. The least value takes a search.
        let [a, b, c] = corners.map(|corner| mesh.lattice().world_from_lattice(corner));
        let points = [a, b, c, a.midpoint(b), b.midpoint(c), c.midpoint(a), (a + b + c) / 3.0];
        let targets = points.map(|at| (at, criterion.target_at(at)));
        match targets.into_iter().find(|(_, target)| *target < criterion.diameter(corners, level)) {
            Some((at, target)) => Self::Target { at, target },
            None => {
                let least = criterion.least_within(corners);
                Self::Target { at: least.at, target: least.target }
            }
        }
    }
}

/// No two triangles have the same apex and the same middle of the bisection edge.
fn key(triangle: &TreeTriangle) -> [u32; 4] {
    let [apex, p, q] = triangle.corners();
    [apex.x, apex.y, p.x + q.x, p.y + q.y]
}
