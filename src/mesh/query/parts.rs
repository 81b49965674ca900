//! The parts of an extract: triangles that edges join.

use std::cmp::Reverse;
use std::collections::HashMap;

use super::forest::Forest;
use crate::geometry::LatticePoint;
use crate::mesh::extract::Extract;
use crate::mesh::kernel::{NodeId, TriangleId};

/// A part. Parts compare by their area, then by place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Part {
    /// Twice the area, in squares of the lattice.
    pub doubled_area: u128,
    lowest: Reverse<[u64; 2]>,
    pub triangles: usize,
    /// The triangle at the lowest place.
    pub at: TriangleId,
}

/// The parts of an extract without some of its triangles.
pub(super) struct Parts {
    /// For each triangle the one that stands for its part; of no meaning where it is left out.
    roots: Vec<usize>,
    by_root: HashMap<usize, Part>,
}

impl Parts {
    /// The parts of the triangles that are not `removed`.
    pub fn new(extract: &Extract, removed: &[bool]) -> Self {
        let count = extract.triangles().len();
        let stays = |index: &usize| !removed[*index];
        let mut forest = Forest::new(count);
        for index in (0..count).filter(stays) {
            let across = extract.triangles()[index].raw_neighbours.into_iter().filter_map(|n| n.triangle());
            across.map(TriangleId::index).filter(stays).for_each(|other| forest.join(index, other));
        }
        let roots: Vec<usize> = (0..count).map(|index| forest.root(index)).collect();
        let mut by_root = HashMap::new();
        for index in (0..count).filter(stays) {
            let at = TriangleId::from_index(index);
            let lowest = Reverse(place_key(extract, at));
            let none = Part { doubled_area: 0, lowest, triangles: 0, at };
            let part: &mut Part = by_root.entry(roots[index]).or_insert(none);
            part.doubled_area += doubled_area(extract, at);
            part.triangles += 1;
            if lowest > part.lowest {
                (part.lowest, part.at) = (lowest, at);
            }
        }
        Self { roots, by_root }
    }

    /// The part of a triangle that is not left out.
    pub fn of(&self, id: TriangleId) -> &Part {
        &self.by_root[&self.roots[id.index()]]
    }

    /// All parts, in no order.
    pub fn iter(&self) -> impl Iterator<Item = &Part> {
        self.by_root.values()
    }
}

impl Extract<'_> {
    /// For each triangle the number of its part, from 0 for the part with the largest area. A part is joined
    /// by edges; of equal ones the one at the lowest place comes first.
    pub fn part_numbers(&self) -> Vec<u32> {
        let Parts { roots, by_root } = Parts::new(self, &vec![false; self.triangles().len()]);
        let mut order: Vec<(Reverse<Part>, usize)> =
            by_root.into_iter().map(|(root, part)| (Reverse(part), root)).collect();
        order.sort_unstable();
        let numbers: HashMap<usize, u32> = order.into_iter().map(|(_, root)| root).zip(0..).collect();
        roots.iter().map(|root| numbers[root]).collect()
    }
}

/// Three times the centroid in lattice coordinates, y first: no two triangles of a mesh share it.
pub(super) fn place_key(extract: &Extract, id: TriangleId) -> [u64; 2] {
    let corners = corners(extract, id);
    [corners.iter().map(|p| u64::from(p.y)).sum(), corners.iter().map(|p| u64::from(p.x)).sum()]
}

/// Twice the area of a triangle, in squares of the lattice.
fn doubled_area(extract: &Extract, id: TriangleId) -> u128 {
    let [a, b, c] = corners(extract, id).map(|p| [i128::from(p.x), i128::from(p.y)]);
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).unsigned_abs()
}

fn corners(extract: &Extract, id: TriangleId) -> [LatticePoint; 3] {
    extract.cell(id).corners.map(|node| extract.node(NodeId::from_index(node)))
}
