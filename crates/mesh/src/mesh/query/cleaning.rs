//! Removes parts and pinches, which solvers cannot use.
//!
//! A *pinch*, or non-manifold vertex, is a node around which the triangles of the domain form several fans
//! that meet only in that node. The boundary touches itself there and encloses "holes" that are open to the
//! outside.
//!
//! ```text
//!   o-------o                       o-------o        around m, the triangles form two fans; the smaller
//!   | \     | \                     | \     |        fan is removed
//!   |   \   |   \                   |   \   |
//!   o-----m-------o      =>         o-----m
//!         |   \   |
//!         o-------o
//! ```
//!
//! The mesh itself does not change: a [`MeshPatch`] notes the removed triangles. The choice of these
//! triangles depends on the positions of the triangles and not on their numbers: two meshes with the same
//! triangles lose the same ones.

use std::cmp::{Ordering, Reverse};
use std::mem;

use glam::DVec2;

use super::forest::Forest;
use super::parts::{ExtractPart, Parts, place_key};
use crate::geometry::NumberMap;
use crate::mesh::extract::{Extract, MeshPatch};
use crate::mesh::kernel::{Mesh, NodeId, TriangleId};

/// Which triangles of a domain a mesh keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cleaning {
    /// The parts that stay. A part is joined by edges.
    pub parts: KeptParts,
    /// Whether nodes stay in which triangles meet without sharing an edge.
    pub keeps_pinches: bool,
    /// Whether triangles along the outline are changed for better angles, before parts are looked at.
    pub improves_boundary: bool,
}

/// Which parts of a mesh stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeptParts {
    /// All.
    All,
    /// The one with the largest area.
    Largest,
    /// All parts with at least this share of the area of the mesh, 0 to 1.
    Share(f64),
}

impl Cleaning {
    /// Nothing is removed.
    pub const NONE: Self = Self { parts: KeptParts::All, keeps_pinches: true, improves_boundary: false };
    /// One part without pinches, as solvers need it.
    pub const FOR_SOLVERS: Self =
        Self { parts: KeptParts::Largest, keeps_pinches: false, improves_boundary: false };
}

/// The parts and pinches that [`MeshPatch::clean`] removed.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Removed {
    /// The parts, the largest first.
    pub parts: Vec<RemovedPart>,
    /// Number of pinches that were resolved.
    pub pinches: usize,
    /// Number of removed triangles, of parts and at pinches.
    pub triangles: usize,
    /// The area of these triangles, in square world units.
    pub area: f64,
}

/// A part that was removed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RemovedPart {
    /// The centroid of one of its triangles, in world units.
    pub place: DVec2,
    /// Number of triangles of the part.
    pub triangles: usize,
    /// The area of the part, in square world units.
    pub area: f64,
}

impl MeshPatch {
    /// Removes parts and pinches of the mesh with this patch: their triangles become changed ones without
    /// pieces.
    ///
    /// Removing a pinch can separate a part, and removing a part can make a pinch, so both are repeated until
    /// nothing changes. Time and memory grow with the mesh.
    ///
    /// # Panics
    /// Panics when the patch is of another mesh.
    pub fn clean(&mut self, mesh: &Mesh, cleaning: &Cleaning) -> Removed {
        self.clean_and_report(mesh, cleaning, &mut |_| {})
    }

    /// [`Self::clean`], which passes to `on_removed` the corners of each removed triangle, anticlockwise.
    ///
    /// # Panics
    /// Panics when the patch is of another mesh.
    pub fn clean_and_report(
        &mut self,
        mesh: &Mesh,
        cleaning: &Cleaning,
        on_removed: &mut dyn FnMut([NodeId; 3]),
    ) -> Removed {
        if *cleaning == Cleaning::NONE {
            return Removed::default();
        }
        let extract = mesh.extract_with(self);
        let mut cleaner = Cleaner::new(&extract);
        cleaner.run(cleaning);
        let Cleaner { is_removed, removed, .. } = cleaner;
        drop(extract);
        if removed.triangles > 0 {
            self.remove(mesh, &is_removed, on_removed);
        }
        removed
    }

    /// Removes triangles by their place in the extract.
    fn remove(&mut self, mesh: &Mesh, is_removed: &[bool], on_removed: &mut dyn FnMut([NodeId; 3])) {
        let old_pieces = mem::take(&mut self.pieces);
        let mut old_changed = mem::take(&mut self.changed).into_iter().peekable();
        let mut is_removed = is_removed.iter().copied();
        let mut next_is_removed = |corners: [NodeId; 3]| {
            let is_removed = is_removed.next().expect("one for each triangle of the extract");
            if is_removed {
                on_removed(corners);
            }
            is_removed
        };
        for (index, triangle) in mesh.raw_triangles().iter().enumerate() {
            let id = TriangleId::from_index(index);
            if let Some((_, pieces)) = old_changed.next_if(|(changed, _)| *changed == id) {
                let first = self.pieces.len();
                self.pieces.extend(old_pieces[pieces].iter().filter(|piece| !next_is_removed(piece.corners)));
                self.changed.push((id, first..self.pieces.len()));
            } else if !triangle.is_outside() && next_is_removed(triangle.edge_nodes().map(|(from, _)| from)) {
                self.changed.push((id, self.pieces.len()..self.pieces.len()));
            }
        }
    }
}

impl Extract<'_> {
    /// Returns the nodes in which triangles meet without sharing an edge, in their order.
    pub fn pinches(&self) -> Vec<NodeId> {
        Cleaner::new(self).pinches()
    }
}

/// Removes triangles from an extract.
struct Cleaner<'a> {
    extract: &'a Extract<'a>,
    is_removed: Vec<bool>,
    removed: Removed,
}

impl<'a> Cleaner<'a> {
    fn new(extract: &'a Extract<'a>) -> Self {
        Self { extract, is_removed: vec![false; extract.triangles().len()], removed: Removed::default() }
    }

    fn run(&mut self, cleaning: &Cleaning) {
        let mut parts = self.parts();
        let whole: u128 = parts.iter().map(|part| part.doubled_area).sum();
        // Ends: each round but the last removes a triangle.
        loop {
            if self.remove_parts(&parts, cleaning.parts, whole) {
                parts = self.parts();
            }
            let pinches = if cleaning.keeps_pinches { Vec::new() } else { self.pinches() };
            if pinches.is_empty() {
                break;
            }
            self.remove_fans(&pinches, &parts);
            parts = self.parts();
        }
        let doubled: u128 = parts.iter().map(|part| part.doubled_area).sum();
        self.removed.area = self.area(whole - doubled);
        self.removed.triangles = self.is_removed.iter().filter(|&&is_removed| is_removed).count();
        self.removed.parts.sort_by(by_area_and_place);
    }

    fn parts(&self) -> Parts {
        Parts::new(self.extract, &self.is_removed)
    }

    /// Removes the parts that do not stay, where all parts had the doubled area `whole` at first. The largest
    /// part always stays. Returns whether there were any.
    fn remove_parts(&mut self, parts: &Parts, kept: KeptParts, whole: u128) -> bool {
        let Some(largest) = parts.iter().max() else { return false };
        let stays = |part: &ExtractPart| match kept {
            KeptParts::All => true,
            KeptParts::Largest => part == largest,
            KeptParts::Share(share) => part == largest || part.doubled_area as f64 >= share * whole as f64,
        };
        let small = parts.iter().filter(|part| !stays(part));
        let described: Vec<RemovedPart> = small.map(|part| self.describe(part)).collect();
        if described.is_empty() {
            return false;
        }
        for index in 0..self.is_removed.len() {
            let removes = !self.is_removed[index] && !stays(parts.of(TriangleId::from_index(index)));
            self.is_removed[index] |= removes;
        }
        self.removed.parts.extend(described);
        true
    }

    fn describe(&self, part: &ExtractPart) -> RemovedPart {
        let corners = self.extract.cell(part.at).corners.map(NodeId::from_index);
        RemovedPart {
            place: corners.map(|node| self.extract.world(node)).iter().sum::<DVec2>() / 3.0,
            triangles: part.triangles,
            area: self.area(part.doubled_area),
        }
    }

    /// Returns a doubled area on the lattice in square world units.
    fn area(&self, doubled: u128) -> f64 {
        let step = self.extract.lattice().step();
        0.5 * doubled as f64 * step.x * step.y
    }

    /// Returns the triangles across the edges of one.
    fn neighbours(&self, index: usize) -> [Option<usize>; 3] {
        let across = self.extract.triangles()[index].raw_neighbours;
        across.map(|n| n.triangle().map(TriangleId::index).filter(|&other| !self.is_removed[other]))
    }

    fn pinches(&self) -> Vec<NodeId> {
        // A node on the boundary has two edges there, or four and more.
        let mut boundary_edges = vec![0u8; self.extract.nodes().len()];
        for index in self.left() {
            let sides = self.extract.triangles()[index].edge_nodes().into_iter().zip(self.neighbours(index));
            for ((from, to), _) in sides.filter(|(_, across)| across.is_none()) {
                boundary_edges[from.index()] += 1;
                boundary_edges[to.index()] += 1;
            }
        }
        let pinched = boundary_edges.iter().enumerate().filter(|&(_, &edges)| edges > 2);
        pinched.map(|(node, _)| NodeId::from_index(node)).collect()
    }

    /// Returns the triangles that are not removed.
    fn left(&self) -> impl Iterator<Item = usize> {
        (0..self.is_removed.len()).filter(|&index| !self.is_removed[index])
    }

    /// Removes the smaller fans at pinches, all at once.
    fn remove_fans(&mut self, pinches: &[NodeId], parts: &Parts) {
        let mut around: NumberMap<NodeId, Vec<usize>> =
            pinches.iter().map(|&node| (node, Vec::new())).collect();
        for index in self.left() {
            for node in self.extract.triangles()[index].vertices {
                if let Some(triangles) = around.get_mut(&node) {
                    triangles.push(index);
                }
            }
        }
        let fans: Vec<usize> =
            around.iter().flat_map(|(&node, around)| self.smaller_fans(node, around, parts)).collect();
        self.removed.pinches += pinches.len();
        fans.into_iter().for_each(|index| self.is_removed[index] = true);
    }

    /// Returns the triangles `around` a node, except for the fan that stays: the one of the largest part,
    /// then the one with the widest angle, then the one at the lowest place.
    fn smaller_fans(&self, node: NodeId, around: &[usize], parts: &Parts) -> Vec<usize> {
        let mut fans = self.fans(around);
        fans.sort_by_key(|fan| {
            let eighths = |&index: &usize| if self.extract.triangles()[index].apex() == node { 2 } else { 1 };
            let angle: u32 = fan.iter().map(eighths).sum();
            let place = fan.iter().map(|&index| place_key(self.extract, TriangleId::from_index(index))).min();
            (Reverse(parts.of(TriangleId::from_index(fan[0]))), Reverse(angle), place)
        });
        fans.into_iter().skip(1).flatten().collect()
    }

    /// Returns the triangles around a node in groups that are joined by edges.
    fn fans(&self, around: &[usize]) -> Vec<Vec<usize>> {
        let mut groups = Forest::new(around.len());
        for (n, &index) in around.iter().enumerate() {
            for across in self.neighbours(index).into_iter().flatten() {
                if let Some(other) = around.iter().position(|&other| other == across) {
                    groups.join(n, other);
                }
            }
        }
        let mut fans: NumberMap<usize, Vec<usize>> = NumberMap::default();
        for (n, &index) in around.iter().enumerate() {
            fans.entry(groups.root(n)).or_default().push(index);
        }
        fans.into_values().collect()
    }
}

/// Returns the largest area first, then the lowest place.
fn by_area_and_place(a: &RemovedPart, b: &RemovedPart) -> Ordering {
    let place = |part: &RemovedPart| [part.place.y, part.place.x];
    b.area.total_cmp(&a.area).then(place(a).partial_cmp(&place(b)).unwrap_or(Ordering::Equal))
}
