//! Edges along lines inside the domain.
//!
//! This works on the mesh with its nodes on the outline, and changes only triangles around the lines
//! ([`local`](super::local)). First, corners, ends and crossings of the lines become nodes; then each
//! straight segment between two of them is followed from triangle to triangle. Where it crosses an edge, the
//! nearer end moves there, or the edge is flipped or gets a node ([`insert`]). Then edges are flipped, nodes
//! shifted and nodes that are too near to each other joined, as far as that makes the smallest angles larger
//! ([`Improver`](super::local::Improver)); nodes on a line stay on it.
//!
//! Where an angle is still too small or an edge longer than its target, the stretch of a line there is *left
//! out*, and everything is done again without it ([`island`]). So the mesh keeps the bounds on angles and
//! lengths that it had without lines, and what is left out is listed.
//!
//! Lines that meet at less than 18.4° make angles of at least 0.8 times theirs.
//!
//! [`OutlineFollower`](super::OutlineFollower) knows nothing of lines: after an edit, they are fitted anew to
//! the mesh that it derives ([`DerivedMesh::of_follower`](super::DerivedMesh::of_follower)). What is done at
//! a place of a line may depend on all of its island.
//!
//! Everything is decided by places on the lattice, in an order of places: the result does not depend on the
//! order and directions of the lines, on the order of the mesh's entries, or on the number of threads. Each
//! connected set of triangles around lines is an island; all threads work on different islands.

mod edges;
mod insert;
mod island;
mod report;
mod sharp;
mod stops;

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::angles::Angles;
use super::lengths::{EdgeTargets, LengthRule};
use super::local::{LocalMesh, PatchedMesh, PatchedTriangle, Replaced, rings_around};
use crate::domain::{LinesOnLattice, RegionOnLattice};
use crate::geometry::{BoxTree, LatticePoint};
use crate::mesh::{Mesh, MeshPatch};
pub use edges::{LineEdge, LineEdges, WeirEdges};
use island::{Island, Shared};
pub use report::{LineFit, LineProblem, UnresolvedPlace};
use sharp::SharpNodes;
use stops::{CutSegment, TriangleIndex, meets, rect_around};

/// Rings of triangles around those that a line touches. The nodes of the last one stay where they are.
const RINGS: usize = 4;

/// A mesh with edges along lines.
pub(super) struct FittedLines {
    /// The differences from the mesh.
    pub(super) patch: MeshPatch,
    /// How well each line fits.
    pub(super) fits: Vec<LineFit>,
    /// The cotangent of the smallest angle that is accepted where lines meet; 0 where that is not small.
    pub(super) corner_limit: f64,
}

/// Returns a mesh with a patch, changed so that it has edges along lines.
pub(super) fn fit_lines(
    mesh: &Mesh,
    patch: &MeshPatch,
    lines: &LinesOnLattice,
    region: Option<&RegionOnLattice>,
    targets: Option<EdgeTargets>,
) -> FittedLines {
    let whole = PatchedMesh::new(mesh, patch);
    let angles = Angles::new(mesh.lattice().step());
    let shared = Shared {
        mesh,
        angles,
        lengths: LengthRule::new(targets, angles),
        segments: &lines.segments,
        extent: mesh.lattice().extent(),
    };
    let boxes: Vec<_> = lines.segments.iter().map(|ends| rect_around(ends, 1.0)).collect();
    let tree = BoxTree::new(&boxes);
    let (triangles, is_complete) = around(&whole, &lines.segments, &tree);
    let on_outline = |p: LatticePoint| {
        let found = |region: &RegionOnLattice| {
            region.nearest_on_outline(p.as_dvec2(), shared.angles.step().max_element(), shared.angles.step())
        };
        region.and_then(found).is_some()
    };
    let near = LocalMesh::new(&whole, &triangles, &is_complete, &angles, &on_outline);
    let starts: Vec<LocalMesh> = near.parts().iter().map(|part| near.part(part)).collect();
    let fitted: Vec<(Island, LocalMesh)> = starts
        .into_par_iter()
        .map(|start| {
            let cuts = cuts(&start, &lines.segments, &tree, region);
            let mut island = Island::new(start, cuts, &shared);
            let local = island.fit();
            (island, local)
        })
        .collect();
    let mut replaced = Replaced::default();
    let mut corner_limit = 0.0f64;
    for (island, local) in &fitted {
        corner_limit = corner_limit.max(SharpNodes::new(local, &angles).largest());
        local.write(&whole, &island.start, &angles, &mut replaced);
    }
    let fits = report::fits(mesh, lines, &fitted);
    FittedLines { patch: replaced.into_patch(&whole), fits, corner_limit }
}

/// Returns the triangles around segments, and for each node whether all triangles at it are among them.
fn around(
    whole: &PatchedMesh,
    segments: &[[LatticePoint; 2]],
    tree: &BoxTree,
) -> (Vec<PatchedTriangle>, Vec<bool>) {
    let is_crossed = |t: &PatchedTriangle| {
        let rect = rect_around(&whole.corners(t), 1.0);
        let found = tree.visit_meeting(&rect, |n| match meets(&rect, segments[n as usize]) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        });
        found.is_break()
    };
    rings_around(whole, RINGS, is_crossed)
}

/// Cuts the segments that touch triangles, in their order.
fn cuts(
    start: &LocalMesh,
    segments: &[[LatticePoint; 2]],
    tree: &BoxTree,
    region: Option<&RegionOnLattice>,
) -> Vec<CutSegment> {
    let (index, mut near) = (TriangleIndex::new(start), Vec::new());
    let _ = tree.visit_meeting(&rect_around(&start.points, 1.0), |n| {
        near.push(n);
        ControlFlow::Continue(())
    });
    near.sort_unstable();
    near.into_iter().filter_map(|n| index.cut(n, segments[n as usize], region)).collect()
}
