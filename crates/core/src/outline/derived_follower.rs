//! Keeps a derived mesh in step with a mesh that changes where it is.
//!
//! ```text
//!   mesh ──▶ nodes on the outline ──▶ better boundary ──▶ edges along lines
//!            OutlineFollower          KeptIslands         KeptIslands
//! ```
//!
//! Each of these takes the entries whose pieces may have changed from the one before, and hands on those
//! that it changes itself. Some of them are not there: a rectangle has no outline, and most meshes no lines.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::OutlineFollower;
use super::angles::Angles;
use super::islands::{
    ChangeBelow, ChangedIsland, DerivedIslands, KeptIslands, LayeredPieces, PieceSource, PlainPieces,
    in_groups,
};
use super::lengths::EdgeTargets;
use super::lines::{LineRule, segment_tree};
use super::quality::RepairRules;
use crate::domain::DomainOnLattice;
use crate::geometry::{BoxTree, LatticePoint};
use crate::mesh::{Changes, Cleaning, Mesh, Replacement, TriangleId};

/// The triangles of a derived mesh before its cleaning: on the outline of a domain, with a better boundary
/// and with edges along lines, each where that is asked for. They are those of
/// [`DerivedMesh::new`](super::DerivedMesh::new).
#[derive(Clone, Debug)]
pub struct DerivedFollower {
    domain: DomainOnLattice,
    outline: Option<OutlineFollower>,
    better: Option<KeptIslands>,
    lines: Option<KeptLines>,
}

/// Islands along lines, with the tree that finds segments of the lines.
#[derive(Clone, Debug)]
struct KeptLines {
    islands: KeptIslands,
    tree: Arc<BoxTree>,
}

impl DerivedFollower {
    /// Returns whether the derived mesh of a domain can be kept in step.
    ///
    /// Not where neither an outline nor lines are asked for. Where coarse triangles are left out of a grid,
    /// parts of the domain can meet in nodes where the mesh does not lead from one to the other, so lines
    /// there cannot be followed, either.
    pub fn can_follow(domain: &DomainOnLattice) -> bool {
        let leaves_out = !domain.is_whole() && !domain.is_fitted();
        domain.region_on_outline().is_some() || (domain.lines().is_some() && !leaves_out)
    }

    /// Returns whether it keeps what cleaning asks for in place of the mesh of a domain in step.
    pub fn is_of(&self, domain: &DomainOnLattice, cleaning: &Cleaning) -> bool {
        let regions = [&self.domain, domain].map(|domain| domain.region_on_outline());
        let lines = [&self.domain, domain].map(|domain| domain.lines());
        let improves = cleaning.improves_boundary && domain.region_on_outline().is_some();
        are_same(regions) && are_same(lines) && improves == self.better.is_some() && Self::can_follow(domain)
    }

    /// Takes in what changed in the mesh, and where targets may have changed, and returns the entries whose
    /// pieces may have changed, in ascending order; `None` if more triangles than `most` came near the
    /// outline, or are to be changed along lines or for a better boundary. Then nothing is in step with the
    /// mesh any more.
    pub fn update(
        &mut self,
        mesh: &Mesh,
        targets: Option<EdgeTargets>,
        changes: &Changes,
        most: usize,
    ) -> Option<Vec<TriangleId>> {
        let mut entries = match &mut self.outline {
            Some(outline) => outline.update_few(mesh, targets, changes, most)?,
            None => Vec::new(),
        };
        if self.better.is_none() && self.lines.is_none() {
            return Some(entries);
        }
        let count = mesh.raw_triangle_count();
        let others = changes.triangles.iter().flat_map(|ids| ids.start..ids.end.min(count));
        entries.extend(others.map(TriangleId::from_index));
        entries.sort_unstable();
        entries.dedup();
        let retargeted = &changes.retargeted;
        let outline = self.outline.as_ref().map(OutlinePieces);
        let below: &dyn PieceSource = outline.as_ref().map_or(&PlainPieces, |outline| outline);
        if let (Some(better), Some(region)) = (&mut self.better, self.domain.region_on_outline()) {
            let rules = RepairRules::new(mesh, region, targets);
            let change = ChangeBelow { entries: &entries, retargeted, most };
            entries = better.update(mesh, below, &rules, change)?;
        }
        let layered = self.better.as_ref().map(|islands| LayeredPieces { below, islands });
        let below = layered.as_ref().map_or(below, |layered| layered);
        if let (Some(kept), Some(lines)) = (&mut self.lines, self.domain.lines()) {
            let rule = LineRule::new(mesh, lines, &kept.tree, self.domain.region_on_outline(), targets);
            let change = ChangeBelow { entries: &entries, retargeted, most };
            entries = kept.islands.update(mesh, below, &rule, change)?;
        }
        Some(entries)
    }

    /// Returns what is drawn in place of a triangle of the mesh, which must be the one of the last update.
    pub fn replacement(&self, mesh: &Mesh, id: TriangleId) -> Replacement {
        let outline = self.outline.as_ref().map(OutlinePieces);
        let below: &dyn PieceSource = outline.as_ref().map_or(&PlainPieces, |outline| outline);
        let better = self.better.as_ref().map(|islands| LayeredPieces { below, islands });
        let below = better.as_ref().map_or(below, |layered| layered);
        match &self.lines {
            Some(KeptLines { islands, .. }) => LayeredPieces { below, islands }.replacement(mesh, id),
            None => below.replacement(mesh, id),
        }
    }

    /// Returns the nodes on the outline, where the domain requires them.
    pub fn outline(&self) -> Option<&OutlineFollower> {
        self.outline.as_ref()
    }
}

/// Returns whether two are one and the same, or neither is there.
fn are_same<T>(both: [Option<&T>; 2]) -> bool {
    let [a, b] = both.map(|one| one.map(std::ptr::from_ref));
    a == b
}

/// The triangles of a mesh with nodes on an outline.
struct OutlinePieces<'a>(&'a OutlineFollower);

impl PieceSource for OutlinePieces<'_> {
    fn replacement(&self, mesh: &Mesh, id: TriangleId) -> Replacement {
        self.0.replacement(mesh, id)
    }

    fn is_empty(&self, mesh: &Mesh, id: TriangleId) -> bool {
        self.0.number_of_pieces(id).unwrap_or_else(|| usize::from(mesh.is_in_domain(id))) == 0
    }

    fn is_near_boundary(&self, mesh: &Mesh, id: TriangleId) -> bool {
        let extent = mesh.lattice().extent();
        let is_on_side = |p: LatticePoint| p.x == 0 || p.y == 0 || p.x == extent.x || p.y == extent.y;
        self.0.knows(mesh, id) || mesh.corners(id).into_iter().any(is_on_side)
    }
}

/// A follower takes in the islands of a derived mesh, some triangles at a time.
pub(super) struct IslandMaking {
    follower: DerivedFollower,
    better: Vec<Vec<ChangedIsland>>,
    lines: Vec<Vec<ChangedIsland>>,
}

impl IslandMaking {
    /// Begins with the nodes on the outline.
    pub(super) fn new(
        mesh: &Mesh,
        domain: &DomainOnLattice,
        outline: Option<OutlineFollower>,
        islands: DerivedIslands,
    ) -> Self {
        let none = || KeptIslands::none(mesh);
        let lines = islands.lines.as_ref().and(domain.lines());
        let lines = lines.map(|lines| KeptLines { islands: none(), tree: Arc::new(segment_tree(lines)) });
        let better = islands.better.as_ref().map(|_| none());
        let follower = DerivedFollower { domain: domain.clone(), outline, better, lines };
        let grouped = |islands: Option<Vec<ChangedIsland>>| in_groups(islands.unwrap_or_default());
        Self { follower, better: grouped(islands.better), lines: grouped(islands.lines) }
    }

    /// Takes in islands until these have as many triangles. Returns the follower at the end.
    pub(super) fn advance(mut self, mesh: &Mesh, most: usize) -> ControlFlow<DerivedFollower, Self> {
        let angles = Angles::new(mesh.lattice().step());
        let (mut done, mut changed) = (0, Vec::new());
        let DerivedFollower { outline, better, lines, .. } = &mut self.follower;
        let outline = outline.as_ref().map(OutlinePieces);
        let below: &dyn PieceSource = outline.as_ref().map_or(&PlainPieces, |outline| outline);
        while done < most {
            let of_better = better.as_mut().and_then(|better| Some((better, self.better.pop()?)));
            if let Some((better, group)) = of_better {
                done += size(&group);
                better.write(mesh, below, &angles, &group, &mut changed);
                continue;
            }
            let of_lines = lines.as_mut().and_then(|lines| Some((lines, self.lines.pop()?)));
            let Some((lines, group)) = of_lines else {
                return ControlFlow::Break(self.follower);
            };
            let layered = better.as_ref().map(|islands| LayeredPieces { below, islands });
            let below = layered.as_ref().map_or(below, |layered| layered);
            done += size(&group);
            lines.islands.write(mesh, below, &angles, &group, &mut changed);
        }
        ControlFlow::Continue(self)
    }
}

fn size(group: &[ChangedIsland]) -> usize {
    group.iter().map(|island| island.start.triangles.len()).sum()
}
