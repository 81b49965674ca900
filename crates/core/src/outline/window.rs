//! A part of the band that is derived from scratch, around what an edit changed.

use rayon::prelude::*;

use super::band::{Band, GRAIN, RINGS};
use super::changes::FittedBand;
use super::line::OutlineOnLattice;
use super::numbers::{Numbers, Pages};
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, NodeId, TriangleId};

/// Rings within which steps look at others before any node acts.
pub(super) const LOCAL_RINGS: u32 = 4;
/// Rings at the edge of a window where the first steps do not see all that they look at.
const SURE_RINGS: u32 = LOCAL_RINGS + RINGS as u32;
/// Rings of triangles between two nodes of one island, at most.
const ISLAND_RINGS: u32 = 2;
/// Rings around islands whose nodes look at them, or at the same nodes.
const BESIDE_RINGS: u32 = 4;
/// Rings at the edge of a window where steps after the first ones are left out: what they do there is not
/// right, and the nodes within, where the first steps see enough, do not look so far.
const ZONE_RINGS: u32 = SURE_RINGS - 2;
/// Rings around the nodes where a window must be right, in which it is right, too: first, and how many more
/// in each wider window.
pub(super) const SLACK: u32 = 2;

/// Nodes with the number of rings of triangles between them and some of them.
pub(super) struct Rings {
    pub(super) nodes: Vec<NodeId>,
    /// Where the nodes of the last ring begin.
    last_ring: usize,
    rings: Pages,
}

impl Rings {
    /// Finds the nodes within a number of rings of the `first` ones, through triangles that `pass`.
    pub(super) fn around(
        mesh: &Mesh,
        first: impl IntoIterator<Item = NodeId>,
        rings: u32,
        pass: impl Fn(TriangleId) -> bool,
    ) -> Self {
        Self::with_triangles(mesh, first, rings, pass).0
    }

    /// [`Self::around`], with the triangles that were seen: those at all nodes but the ones of the last ring.
    fn with_triangles(
        mesh: &Mesh,
        first: impl IntoIterator<Item = NodeId>,
        rings: u32,
        pass: impl Fn(TriangleId) -> bool,
    ) -> (Self, Triangles) {
        let mut found =
            Self { nodes: Vec::new(), last_ring: 0, rings: Pages::for_entries(mesh.raw_nodes().len()) };
        let mut triangles = Triangles::new(mesh);
        first.into_iter().for_each(|node| found.add(node, 0));
        for ring in 1..=rings {
            let end = found.nodes.len();
            for n in found.last_ring..end {
                for id in mesh.all_triangles_around(found.nodes[n]) {
                    if triangles.add(id) && pass(id) {
                        mesh.triangle(id).vertices.into_iter().for_each(|node| found.add(node, ring));
                    }
                }
            }
            found.last_ring = end;
        }
        (found, triangles)
    }

    fn add(&mut self, node: NodeId, ring: u32) {
        if self.ring_of(node).is_none() {
            self.rings.set(node.index(), ring);
            self.nodes.push(node);
        }
    }

    pub(super) fn ring_of(&self, node: NodeId) -> Option<u32> {
        self.rings.get(node.index())
    }
}

/// Returns the nodes where a window must be right, if nodes act where they `acted` before: those around the
/// islands that touch the core, and around islands beside these. All are found through triangles that `pass`.
pub(super) fn expected(
    mesh: &Mesh,
    core: &[NodeId],
    acted: impl Fn(LatticePoint) -> bool,
    pass: impl Fn(TriangleId) -> bool + Copy,
) -> Vec<NodeId> {
    let near = |nodes: &[NodeId], rings| Rings::around(mesh, nodes.iter().copied(), rings, pass).nodes;
    let with_islands = |nodes: &[NodeId]| {
        let mut all = Rings::around(mesh, nodes.iter().copied(), 0, pass);
        let mut last = nodes.to_vec();
        while !last.is_empty() {
            let beside = near(&last, ISLAND_RINGS).into_iter();
            last = beside.filter(|&v| all.ring_of(v).is_none() && acted(mesh.node(v))).collect();
            last.iter().for_each(|&v| all.add(v, 0));
        }
        all
    };
    let islands = with_islands(core);
    let mut sure = near(&islands.nodes, BESIDE_RINGS);
    let others = sure.iter().copied().filter(|&v| islands.ring_of(v).is_none() && acted(mesh.node(v)));
    let others = with_islands(&others.collect::<Vec<_>>()).nodes;
    sure.extend(near(&others, ISLAND_RINGS));
    sure
}

/// Triangles, each once.
struct Triangles {
    ids: Vec<TriangleId>,
    is_known: Pages,
}

impl Triangles {
    fn new(mesh: &Mesh) -> Self {
        Self { ids: Vec::new(), is_known: Pages::for_entries(mesh.raw_triangle_count()) }
    }

    /// Adds a triangle, and returns whether it is new.
    fn add(&mut self, id: TriangleId) -> bool {
        let is_new = self.is_known.set(id.index(), 0);
        if is_new {
            self.ids.push(id);
        }
        is_new
    }
}

/// A part of the band that is derived from scratch.
pub(super) struct Window {
    core: Vec<NodeId>,
    /// Number of rings around the nodes where it must be right.
    reach: u32,
    /// These rings, and all triangles at their nodes.
    rings: Rings,
    pub(super) triangles: Vec<TriangleId>,
    pub(super) fitted: FittedBand,
    /// For the nodes and triangles of the band, their numbers there.
    numbers: [Pages; 2],
}

impl Window {
    /// Derives the window in which a number of rings around some nodes are right, through triangles that
    /// `pass`: all that may be in the band. `touches` says of a triangle whether the outline touches it.
    pub(super) fn new(
        mesh: &Mesh,
        outline: &OutlineOnLattice,
        core: Vec<NodeId>,
        (sure, slack): (Vec<NodeId>, u32),
        pass: impl Fn(TriangleId) -> bool,
        touches: impl Fn(TriangleId) -> bool + Sync,
    ) -> Self {
        let reach = SURE_RINGS + slack;
        let (rings, mut all) = Rings::with_triangles(mesh, sure, reach, pass);
        for &node in &rings.nodes[rings.last_ring..] {
            mesh.all_triangles_around(node).for_each(|id| _ = all.add(id));
        }
        let around = all.ids;
        let touched: Vec<TriangleId> =
            around.par_iter().with_min_len(GRAIN).copied().filter(|&id| touches(id)).collect();
        let (band, numbers) = Band::around::<Pages>(mesh, outline.region, &touched);
        let is_in_zone = |&node: &NodeId| rings.ring_of(node).is_some_and(|ring| ring + ZONE_RINGS <= reach);
        let zone = band.node_ids.iter().map(is_in_zone).collect();
        Self {
            numbers,
            core,
            reach,
            rings,
            triangles: around,
            fitted: FittedBand::new(mesh, band, zone, outline, &mut |_, _| {}),
        }
    }

    pub(super) fn number_of(&self, node: NodeId) -> Option<u32> {
        self.numbers[0].get(node.index())
    }

    pub(super) fn number_of_triangle(&self, id: TriangleId) -> Option<u32> {
        self.numbers[1].get(id.index())
    }

    /// Returns whether the first steps see all that they look at around a node.
    pub(super) fn is_sure(&self, node: NodeId) -> bool {
        self.rings.ring_of(node).is_some_and(|ring| ring + SURE_RINGS <= self.reach)
    }

    /// Returns the nodes of the core and others, and of the islands that touch them. `acted` says of a node
    /// whether it was part of an island before.
    pub(super) fn reached(&self, others: &[NodeId], acted: impl Fn(LatticePoint) -> bool) -> Reached {
        let band = &self.fitted.band;
        let acts_now = self.fitted.acted();
        // Nodes where the window is not right do not matter: where one is near, a wider window is derived.
        let acted = |(&id, &point): (&NodeId, &LatticePoint)| self.is_sure(id) && acted(point);
        let acted: Vec<bool> = band.node_ids.iter().zip(&band.points).map(acted).collect();
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
        let beside = band.near(reached, BESIDE_RINGS as usize);
        if !beside.iter().all(is_sure) {
            return false;
        }
        let mut others: Vec<u32> = beside.into_iter().filter(|&v| acts(v) && !is_known[v as usize]).collect();
        others.iter().for_each(|&v| is_known[v as usize] = true);
        self.add_islands(&mut others, &mut is_known, acts);
        others.iter().all(|&v| acted(v)) && band.near(&others, ISLAND_RINGS as usize).iter().all(is_sure)
    }
}

/// The nodes whose places or triangles may have changed.
pub(super) struct Reached {
    pub(super) nodes: Vec<NodeId>,
    /// Whether the window is right about all of them.
    pub(super) is_sure: bool,
}
