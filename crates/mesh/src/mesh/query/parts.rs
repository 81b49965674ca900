//! The parts of an extract: the connected components of its triangles, joined by edges.

use std::cmp::Reverse;

use super::forest::Forest;
use crate::geometry::LatticePoint;
use crate::mesh::extract::Extract;
use crate::mesh::kernel::{NodeId, TriangleId};

/// A part. Parts compare by their area, then by place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ExtractPart {
    /// Twice the area, in squares of the lattice.
    pub doubled_area: u128,
    lowest: Reverse<[u64; 2]>,
    pub triangles: usize,
    /// The triangle at the lowest place.
    pub at: TriangleId,
}

/// The parts of an extract without some of its triangles.
pub(super) struct Parts {
    /// For each triangle, the index of its part in `parts`; without meaning for a triangle that is left out.
    numbers: Vec<u32>,
    parts: Vec<ExtractPart>,
}

impl Parts {
    /// Returns the parts of the triangles that are not `removed`.
    pub fn new(extract: &Extract, removed: &[bool]) -> Self {
        const UNKNOWN: u32 = u32::MAX;
        let count = extract.triangles().len();
        let stays = |index: &usize| !removed[*index];
        let mut forest = Forest::new(count);
        for index in (0..count).filter(stays) {
            let across = extract.triangles()[index].raw_neighbours.into_iter().filter_map(|n| n.triangle());
            across.map(TriangleId::index).filter(stays).for_each(|other| forest.join(index, other));
        }
        let (mut numbers, mut parts) = (vec![UNKNOWN; count], Vec::new());
        for index in (0..count).filter(stays) {
            let root = forest.root(index);
            let at = TriangleId::from_index(index);
            let lowest = Reverse(place_key(extract, at));
            if numbers[root] == UNKNOWN {
                numbers[root] = parts.len() as u32;
                parts.push(ExtractPart { doubled_area: 0, lowest, triangles: 0, at });
            }
            numbers[index] = numbers[root];
            let part = &mut parts[numbers[root] as usize];
            part.doubled_area += doubled_area(extract, at);
            part.triangles += 1;
            if lowest > part.lowest {
                (part.lowest, part.at) = (lowest, at);
            }
        }
        Self { numbers, parts }
    }

    /// Returns the part of a triangle that is not left out.
    pub fn of(&self, id: TriangleId) -> &ExtractPart {
        &self.parts[self.numbers[id.index()] as usize]
    }

    /// Returns all parts, in no order.
    pub fn iter(&self) -> impl Iterator<Item = &ExtractPart> {
        self.parts.iter()
    }
}

impl Extract<'_> {
    /// Returns for each triangle the number of its part, from 0 for the part with the largest area. A part is
    /// joined by edges; of equal ones the one at the lowest place comes first.
    pub fn part_numbers(&self) -> Vec<u32> {
        let Parts { numbers, parts } = Parts::new(self, &vec![false; self.triangles().len()]);
        let mut order: Vec<usize> = (0..parts.len()).collect();
        order.sort_unstable_by_key(|&number| Reverse(parts[number]));
        let mut ranks = vec![0; parts.len()];
        order.iter().zip(0..).for_each(|(&number, rank)| ranks[number] = rank);
        numbers.iter().map(|&number| ranks[number as usize]).collect()
    }

    /// Returns the number of triangles of each part, in the order of [`Self::part_numbers`].
    pub fn part_sizes(&self) -> Vec<usize> {
        let Parts { mut parts, .. } = Parts::new(self, &vec![false; self.triangles().len()]);
        parts.sort_unstable_by_key(|&part| Reverse(part));
        parts.iter().map(|part| part.triangles).collect()
    }
}

/// Returns three times the centroid in lattice coordinates, y first: no two triangles of a mesh share it.
pub(super) fn place_key(extract: &Extract, id: TriangleId) -> [u64; 2] {
    let corners = corners(extract, id);
    [corners.iter().map(|p| u64::from(p.y)).sum(), corners.iter().map(|p| u64::from(p.x)).sum()]
}

/// Returns twice the area of a triangle, in squares of the lattice.
fn doubled_area(extract: &Extract, id: TriangleId) -> u128 {
    let [a, b, c] = corners(extract, id).map(|p| [i128::from(p.x), i128::from(p.y)]);
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).unsigned_abs()
}

fn corners(extract: &Extract, id: TriangleId) -> [LatticePoint; 3] {
    extract.cell(id).corners.map(|node| extract.node(NodeId::from_index(node)))
}
