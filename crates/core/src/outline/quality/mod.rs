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
//! After an edit, only the islands that it touches are changed again
//! ([`DerivedFollower`](super::DerivedFollower)).

mod census;
mod repair;

use rayon::prelude::*;

use super::angles::{Angles, COT_25};
use super::islands::{ChangedIsland, IslandRule};
use super::lengths::{EdgeTargets, LengthRule};
use super::local::{LocalMesh, PatchedMesh, Replaced, rings_around};
use crate::domain::RegionOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, MeshPatch, NodeId};
pub(super) use census::BoundaryCensus;
use repair::DefectIsland;
pub(super) use repair::RepairRules;

impl<'a> RepairRules<'a> {
    /// Returns the rules for triangles along the outline of a region.
    pub(super) fn new(mesh: &Mesh, region: &'a RegionOnLattice, targets: Option<EdgeTargets<'a>>) -> Self {
        let angles = Angles::new(mesh.lattice().step());
        let (lengths, extent) = (LengthRule::new(targets, angles), mesh.lattice().extent());
        Self { angles, lengths, region, extent }
    }
}

impl IslandRule for RepairRules<'_> {
    /// The nodes of the last ring stay where they are.
    const RINGS: usize = 3;
    const COUNTS: bool = true;

    fn angles(&self) -> &Angles {
        &self.angles
    }

    fn is_seed(&self, nodes: [NodeId; 3], corners: [LatticePoint; 3], census: &BoundaryCensus) -> bool {
        census.has_defect(nodes, corners, &self.angles)
    }

    /// Nodes of a mesh of right-angled triangles have at most 8 of them.
    fn may_be_seed(&self, corners: [LatticePoint; 3]) -> bool {
        self.angles.worst(corners) > COT_25
    }

    fn is_on_outline(&self, p: LatticePoint) -> bool {
        let step = self.angles.step();
        self.region.nearest_on_outline(p.as_dvec2(), step.max_element(), step).is_some()
    }

    fn changed(&self, start: LocalMesh, census: &BoundaryCensus) -> ChangedIsland {
        let (now, asked) = DefectIsland::new(start.clone(), census, self).repaired();
        ChangedIsland { start, now, asked }
    }
}

/// Returns a mesh with a patch, with better triangles along the outline of a region, and the islands that
/// were changed.
pub(super) fn with_better_boundary(
    mesh: &Mesh,
    patch: &MeshPatch,
    region: &RegionOnLattice,
    targets: Option<EdgeTargets>,
) -> (MeshPatch, Vec<ChangedIsland>) {
    let whole = PatchedMesh::new(mesh, patch);
    let (rules, census) = (RepairRules::new(mesh, region, targets), BoundaryCensus::of_all(&whole));
    let (triangles, is_complete) = rings_around(&whole, RepairRules::RINGS, |t| {
        census.has_defect(t.corners, whole.corners(t), &rules.angles)
    });
    let on_outline = |p: LatticePoint| rules.is_on_outline(p);
    let near = LocalMesh::new(&whole.points, &triangles, &is_complete, &rules.angles, &on_outline);
    let parts = near.parts().into_par_iter();
    let islands: Vec<ChangedIsland> = parts.map(|part| rules.changed(near.part(&part), &census)).collect();
    let mut replaced = Replaced::default();
    for island in &islands {
        island.now.write(&whole, &island.start, &rules.angles, &mut replaced);
    }
    (replaced.into_patch(&whole), islands)
}
