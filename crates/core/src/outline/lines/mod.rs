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
//! What is done at a place of a line may depend on all of its island: after an edit, the islands that it
//! touches are fitted anew ([`DerivedFollower`](super::DerivedFollower)).
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
use super::islands::{ChangedIsland, IslandRule};
use super::lengths::{EdgeTargets, LengthRule};
use super::local::{LocalMesh, PatchedMesh, Replaced, rings_around};
use super::quality::BoundaryCensus;
use crate::domain::{LinesOnLattice, RegionOnLattice};
use crate::geometry::{BoxTree, LatticePoint};
use crate::mesh::{Mesh, MeshPatch, NodeId};
pub use edges::{LineEdge, LineEdges, WeirEdges};
use island::{Island, Shared};
pub use report::{LineFit, LineProblem, UnresolvedPlace};
use sharp::SharpNodes;
use stops::{CutSegment, TriangleIndex, meets, rect_around};

/// A mesh with edges along lines.
pub(super) struct FittedLines {
    /// The differences from the mesh.
    pub(super) patch: MeshPatch,
    /// How well each line fits.
    pub(super) fits: Vec<LineFit>,
    /// The cotangent of the smallest angle that is accepted where lines meet; 0 where that is not small.
    pub(super) corner_limit: f64,
    /// The islands that were changed.
    pub(super) islands: Vec<ChangedIsland>,
}

/// The segments of lines, found by rectangles around triangles.
pub(super) fn segment_tree(lines: &LinesOnLattice) -> BoxTree {
    let boxes: Vec<_> = lines.segments.iter().map(|ends| rect_around(ends, 1.0)).collect();
    BoxTree::new(&boxes)
}

/// Puts edges on lines.
pub(super) struct LineRule<'a> {
    shared: Shared<'a>,
    tree: &'a BoxTree,
    region: Option<&'a RegionOnLattice>,
}

impl<'a> LineRule<'a> {
    /// Returns the rule for lines with their [`segment_tree`].
    pub(super) fn new(
        mesh: &'a Mesh,
        lines: &'a LinesOnLattice,
        tree: &'a BoxTree,
        region: Option<&'a RegionOnLattice>,
        targets: Option<EdgeTargets<'a>>,
    ) -> Self {
        let angles = Angles::new(mesh.lattice().step());
        let (lengths, extent) = (LengthRule::new(targets, angles), mesh.lattice().extent());
        Self { shared: Shared { mesh, angles, lengths, segments: &lines.segments, extent }, tree, region }
    }

    /// Returns whether a segment may touch a triangle.
    fn is_crossed(&self, corners: [LatticePoint; 3]) -> bool {
        let rect = rect_around(&corners, 1.0);
        let found =
            self.tree.visit_meeting(&rect, |n| match meets(&rect, self.shared.segments[n as usize]) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            });
        found.is_break()
    }

    /// Cuts the segments that touch triangles, in their order.
    fn cuts(&self, start: &LocalMesh) -> Vec<CutSegment> {
        let (index, mut near) = (TriangleIndex::new(start), Vec::new());
        let _ = self.tree.visit_meeting(&rect_around(&start.points, 1.0), |n| {
            near.push(n);
            ControlFlow::Continue(())
        });
        near.sort_unstable();
        let cut = |n: u32| index.cut(n, self.shared.segments[n as usize], self.region);
        near.into_iter().filter_map(cut).collect()
    }

    /// Puts edges on the segments in connected triangles.
    fn fit(&self, start: LocalMesh) -> (Island<'_>, LocalMesh) {
        let cuts = self.cuts(&start);
        let mut island = Island::new(start, cuts, &self.shared);
        let local = island.fit();
        (island, local)
    }
}

impl IslandRule for LineRule<'_> {
    /// The nodes of the last ring stay where they are.
    const RINGS: usize = 4;
    const COUNTS: bool = false;

    fn angles(&self) -> &Angles {
        &self.shared.angles
    }

    fn is_seed(&self, _: [NodeId; 3], corners: [LatticePoint; 3], _: &BoundaryCensus) -> bool {
        self.is_crossed(corners)
    }

    fn may_be_seed(&self, corners: [LatticePoint; 3]) -> bool {
        self.is_crossed(corners)
    }

    fn is_on_outline(&self, p: LatticePoint) -> bool {
        let step = self.shared.angles.step();
        let nearest =
            |region: &RegionOnLattice| region.nearest_on_outline(p.as_dvec2(), step.max_element(), step);
        self.region.and_then(nearest).is_some()
    }

    fn changed(&self, start: LocalMesh, _: &BoundaryCensus) -> ChangedIsland {
        let (island, now) = self.fit(start);
        island.into_changed(now)
    }
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
    let tree = segment_tree(lines);
    let rule = LineRule::new(mesh, lines, &tree, region, targets);
    let (triangles, is_complete) =
        rings_around(&whole, LineRule::RINGS, |t| rule.is_crossed(whole.corners(t)));
    let on_outline = |p: LatticePoint| rule.is_on_outline(p);
    let near = LocalMesh::new(&whole.points, &triangles, &is_complete, rule.angles(), &on_outline);
    let starts: Vec<LocalMesh> = near.parts().iter().map(|part| near.part(part)).collect();
    let fitted: Vec<(Island, LocalMesh)> = starts.into_par_iter().map(|start| rule.fit(start)).collect();
    let mut replaced = Replaced::default();
    let mut corner_limit = 0.0f64;
    for (island, local) in &fitted {
        corner_limit = corner_limit.max(SharpNodes::new(local, rule.angles()).largest());
        local.write(&whole, &island.start, rule.angles(), &mut replaced);
    }
    let fits = report::fits(mesh, lines, &fitted);
    let islands = fitted.into_iter().map(|(island, now)| island.into_changed(now)).collect();
    FittedLines { patch: replaced.into_patch(&whole), fits, corner_limit, islands }
}
