//! A part of the band that is derived from scratch, around what an edit changed.

use rayon::prelude::*;

use super::band::{Band, GRAIN, RINGS};
use super::changes::{FittedBand, Outline};
use super::numbers::{NumberMap, Numbers};
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, NodeId, TriangleId};

/// Rings within which steps look at others before any node acts.
pub(super) const LOCAL_RINGS: u32 = 4;
/// Rings around islands whose nodes look at them, or at the same nodes.
const BESIDE_RINGS: usize = 4;
/// Rings of a window around its core, at first.
pub(super) const WINDOW_RINGS: u32 = 20;

/// Nodes with the number of rings of triangles between them and some of them.
pub(super) struct Rings {
    pub(super) nodes: Vec<NodeId>,
    rings: NumberMap<u32, u32>,
}

impl Rings {
    /// Finds the nodes within so many rings of the `first` ones, through triangles that `pass`.
    pub(super) fn around(
        mesh: &Mesh,
        first: impl IntoIterator<Item = NodeId>,
        rings: u32,
        pass: impl Fn(TriangleId) -> bool,
    ) -> Self {
        let mut found = Self { nodes: Vec::new(), rings: NumberMap::default() };
        first.into_iter().for_each(|node| found.add(node, 0));
        let mut start = 0;
        for ring in 1..=rings {
            let end = found.nodes.len();
            for n in start..end {
                for id in mesh.all_triangles_around(found.nodes[n]).filter(|&id| pass(id)) {
                    mesh.triangle(id).vertices.into_iter().for_each(|node| found.add(node, ring));
                }
            }
            start = end;
        }
        found
    }

    fn add(&mut self, node: NodeId, ring: u32) {
        if self.ring_of(node).is_none() {
            self.rings.insert(node.index() as u32, ring);
            self.nodes.push(node);
        }
    }

    pub(super) fn ring_of(&self, node: NodeId) -> Option<u32> {
        Numbers::get(&self.rings, node.index())
    }
}

/// A part of the band that is derived from scratch.
pub(super) struct Window {
    core: Vec<NodeId>,
    /// Number of rings around the core.
    reach: u32,
    /// The rings around the core, and all triangles at their nodes.
    rings: Rings,
    pub(super) triangles: Vec<TriangleId>,
    pub(super) fitted: FittedBand,
    /// For the nodes and triangles of the band, their numbers there.
    numbers: NumberMap<u32, u32>,
    pub(super) numbers_of_triangles: NumberMap<u32, u32>,
}

impl Window {
    /// Derives the window around a core, through triangles that `pass`: all that may be in the band.
    pub(super) fn new(
        mesh: &Mesh,
        outline: &Outline,
        core: Vec<NodeId>,
        reach: u32,
        pass: impl Fn(TriangleId) -> bool,
    ) -> Self {
        let rings = Rings::around(mesh, core.iter().copied(), reach, pass);
        let mut all = NumberMap::<u32, u32>::default();
        let around = rings.nodes.iter().flat_map(|&node| mesh.all_triangles_around(node));
        let around: Vec<TriangleId> = around.filter(|id| all.set(id.index(), 0)).collect();
        let touches =
            |id: &TriangleId| outline.region.side_of(mesh.corners(*id), mesh.triangle(*id).level()).is_none();
        let touched: Vec<TriangleId> =
            around.par_iter().with_min_len(GRAIN).copied().filter(touches).collect();
        let band = Band::around::<NumberMap<u32, u32>>(mesh, outline.region, &touched);
        let numbered = |ids: &mut dyn Iterator<Item = usize>| ids.map(|id| id as u32).zip(0..).collect();
        Self {
            numbers: numbered(&mut band.node_ids.iter().map(|id| id.index())),
            numbers_of_triangles: numbered(&mut band.ids.iter().map(|id| id.index())),
            core,
            reach,
            rings,
            triangles: around,
            fitted: FittedBand::new(mesh, band, outline, &mut |_, _| {}),
        }
    }

    pub(super) fn number_of(&self, node: NodeId) -> Option<u32> {
        Numbers::get(&self.numbers, node.index())
    }

    /// Returns whether the first steps see all that they look at around a node.
    pub(super) fn is_sure(&self, node: NodeId) -> bool {
        self.rings.ring_of(node).is_some_and(|ring| ring + LOCAL_RINGS + RINGS as u32 <= self.reach)
    }

    /// Returns the nodes of the core and others, and of the islands that touch them. `acted` says of a node
    /// whether it was part of an island before.
    pub(super) fn reached(&self, others: &[NodeId], acted: impl Fn(LatticePoint) -> bool) -> Reached {
        let band = &self.fitted.band;
        let acts_now = self.fitted.acted();
        let acted: Vec<bool> = band.points.iter().map(|&point| acted(point)).collect();
        let acts = |v: u32| acts_now[v as usize] || acted[v as usize];
        let first = || self.core.iter().chain(others).copied();
        let mut is_reached = vec![false; band.points.len()];
        let mut reached: Vec<u32> = first().filter_map(|node| self.number_of(node)).collect();
        reached.retain(|&v| !std::mem::replace(&mut is_reached[v as usize], true));
        self.add_islands(&mut reached, &mut is_reached, acts);
        let is_sure = self.is_separate(&reached, is_reached, acts, |v| acted[v as usize]);
        let mut nodes: Vec<NodeId> = first().filter(|&node| self.number_of(node).is_none()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes.extend(reached.into_iter().map(|v| band.node_ids[v as usize]));
        Reached { nodes, is_sure }
    }

    /// Adds the islands that touch some nodes: those that act with less than two triangles between them.
    fn add_islands(&self, reached: &mut Vec<u32>, is_reached: &mut [bool], acts: impl Fn(u32) -> bool) {
        let triangles = &self.fitted.band.triangles;
        let mut is_beside = vec![false; is_reached.len()];
        let (mut star, mut far_star, mut next) = (Vec::new(), Vec::new(), 0);
        while next < reached.len() {
            triangles.star(reached[next], &mut star);
            next += 1;
            for w in star.iter().flat_map(|&(t, _)| triangles.corners[t as usize]) {
                if std::mem::replace(&mut is_beside[w as usize], true) {
                    continue;
                }
                triangles.star(w, &mut far_star);
                for z in far_star.iter().flat_map(|&(t, _)| triangles.corners[t as usize]) {
                    if acts(z) && !std::mem::replace(&mut is_reached[z as usize], true) {
                        reached.push(z);
                    }
                }
            }
        }
    }

    /// Returns whether nothing but what was reached can have changed, and the window is right about it.
    ///
    /// A node beside the islands that were reached acts only because of them, or of other islands beside it.
    /// Those are as before if they lie where the first steps see enough, and none of the nodes around them
    /// acts that did not act before.
    fn is_separate(
        &self,
        reached: &[u32],
        mut is_known: Vec<bool>,
        acts: impl Fn(u32) -> bool + Copy,
        acted: impl Fn(u32) -> bool,
    ) -> bool {
        let band = &self.fitted.band;
        let is_sure = |&v: &u32| self.is_sure(band.node_ids[v as usize]);
        let beside = band.near(reached, BESIDE_RINGS);
        if !beside.iter().all(is_sure) {
            return false;
        }
        let mut others: Vec<u32> = beside.into_iter().filter(|&v| acts(v) && !is_known[v as usize]).collect();
        others.iter().for_each(|&v| is_known[v as usize] = true);
        self.add_islands(&mut others, &mut is_known, acts);
        others.iter().all(|&v| acted(v)) && band.near(&others, 2).iter().all(is_sure)
    }
}

/// The nodes whose places or triangles may be others than before.
pub(super) struct Reached {
    pub(super) nodes: Vec<NodeId>,
    /// Whether the window is right about all of them.
    pub(super) is_sure: bool,
}
