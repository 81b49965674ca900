//! Better triangles along the outline, for solvers that need them.
//!
//! A *defect* is a triangle with an angle below 25°, one with all three nodes on the boundary, or a node with
//! more than 8 triangles. Triangles around defects are changed as those around lines are: edges are flipped,
//! nodes inside are shifted or joined, nodes on a straight or smooth part of the outline slide along it, and
//! nodes are put into the middles of edges. A change stays if there are fewer defects after it ([`repair`]).
//!
//! ```text
//!   ~~~●~~~~~~●~~~ outline      ~~~●~~~~~~●~~~
//!       ╲    ╱ ╲                    ╲    ╱│╲        three nodes on the boundary:
//!        ╲  ╱   ╲      -->           ╲ ○──┤ ...     a node in an edge between them
//!   ~~~~~~●~~~~~~●~~ outline    ~~~~~~●~~~~~~●~~
//! ```
//!
//! Corners of the outline stay nodes. What remains are angles of the outline itself, narrow channels, and
//! places where triangles of very different sizes meet.
//!
//! The defects and the triangles around them fall into islands, which all threads work on. An island is
//! numbered by places on the lattice, so the result depends on neither the number of threads nor the order of
//! the mesh's entries.

mod census;
mod repair;

use rayon::prelude::*;

use super::angles::Angles;
use super::lengths::{EdgeTargets, LengthRule};
use super::local::{LocalMesh, PatchedMesh, Replaced, rings_around};
use crate::domain::RegionOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, MeshPatch};
use census::BoundaryCensus;
use repair::{DefectIsland, RepairRules};

/// Rings of triangles around a defect. The nodes of the last one stay where they are.
const RINGS: usize = 3;

/// Returns a mesh with a patch, with better triangles along the outline of a region.
pub(super) fn with_better_boundary(
    mesh: &Mesh,
    patch: &MeshPatch,
    region: &RegionOnLattice,
    targets: Option<EdgeTargets>,
) -> MeshPatch {
    let whole = PatchedMesh::new(mesh, patch);
    let angles = Angles::new(mesh.lattice().step());
    let census = BoundaryCensus::new(&whole);
    let (triangles, is_complete) = rings_around(&whole, RINGS, |t| census.has_defect(&whole, t, &angles));
    let on_outline = |p: LatticePoint| {
        region.nearest_on_outline(p.as_dvec2(), angles.step().max_element(), angles.step()).is_some()
    };
    let near = LocalMesh::new(&whole, &triangles, &is_complete, &angles, &on_outline);
    let lengths = LengthRule::new(targets, angles);
    let rules = RepairRules { angles: &angles, lengths: &lengths, region, extent: mesh.lattice().extent() };
    let repaired: Vec<[LocalMesh; 2]> = near
        .parts()
        .into_par_iter()
        .map(|part| {
            let start = near.part(&part);
            let repaired = DefectIsland::new(start.clone(), &census, &rules).repaired();
            [start, repaired]
        })
        .collect();
    let mut replaced = Replaced::default();
    for [start, local] in &repaired {
        local.write(&whole, start, &angles, &mut replaced);
    }
    replaced.into_patch(&whole)
}
