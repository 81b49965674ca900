//! When bisection made a node, and between which two others: from its place on the lattice alone.

use rayon::prelude::*;

use super::fem_mesh::{FemMesh, NONE};
use crate::geometry::{LatticePoint, interleaved};

/// Ages and parents of nodes.
///
/// The *age class* of a node grows with the number of bisections before it; it goes on below the coarse grid,
/// whose nodes are treated as if the squares of the grid had been bisected from larger ones.
#[derive(Clone, Debug)]
pub(crate) struct NodeTree {
    /// The age class of each node: nodes with the greatest are the newest.
    pub class: Vec<u8>,
    /// The nodes at the ends of the edge that each node halved; [`NONE`] where there is no such node.
    pub parents: Vec<[u32; 2]>,
}

/// The class of nodes that no bisection made.
pub(crate) const ADDED: u8 = 70;
/// Halvings of the plane that are counted: more than a lattice has bits.
const SCALES: u32 = 32;

/// Returns the age class of a place.
fn class_of(at: LatticePoint) -> u8 {
    let [x, y] = [at.x, at.y].map(|v| v.trailing_zeros().min(SCALES));
    let scale = x.min(y);
    let is_middle_of_square = x == y && scale < SCALES;
    (2 * (SCALES - scale) - u32::from(is_middle_of_square)) as u8
}

impl NodeTree {
    /// Finds ages and parents.
    pub fn of(mesh: &FemMesh) -> Self {
        let places = PlaceTable::new(&mesh.homes);
        let class_at = |node: usize| mesh.homes[node].map_or(ADDED, class_of);
        let class: Vec<u8> = (0..mesh.node_count()).into_par_iter().map(class_at).collect();
        let parents = |home: &Option<LatticePoint>| home.map_or([NONE; 2], |at| places.parents(at));
        let parents = mesh.homes.par_iter().map(parents).collect();
        Self { class, parents }
    }
}

/// Finds nodes by their places: open addressing.
struct PlaceTable<'a> {
    homes: &'a [Option<LatticePoint>],
    slots: Vec<u32>,
    shift: u32,
}

impl<'a> PlaceTable<'a> {
    fn new(homes: &'a [Option<LatticePoint>]) -> Self {
        let bits = (2 * homes.len().max(2)).next_power_of_two().trailing_zeros();
        let mut table = Self { homes, slots: vec![NONE; 1 << bits], shift: 64 - bits };
        for (node, home) in homes.iter().enumerate() {
            let Some(home) = home else { continue };
            let mut slot = table.first_slot(*home);
            while table.slots[slot] != NONE {
                slot = (slot + 1) % table.slots.len();
            }
            table.slots[slot] = node as u32;
        }
        table
    }

    #[inline]
    fn first_slot(&self, at: LatticePoint) -> usize {
        (interleaved(at.x, at.y).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> self.shift) as usize
    }

    fn find(&self, at: LatticePoint) -> u32 {
        let mut slot = self.first_slot(at);
        loop {
            let node = self.slots[slot];
            if node == NONE || self.homes[node as usize] == Some(at) {
                return node;
            }
            slot = (slot + 1) % self.slots.len();
        }
    }

    /// Returns the parents of the node at a place.
    fn parents(&self, at: LatticePoint) -> [u32; 2] {
        let [x, y] = [at.x, at.y].map(|v| v.trailing_zeros().min(SCALES));
        let scale = x.min(y);
        if scale >= LARGEST {
            return [NONE; 2];
        }
        let step = 1 << scale;
        if x != y {
            let ends = if x < y { [[-step, 0], [step, 0]] } else { [[0, -step], [0, step]] };
            return ends.map(|end| self.beside(at, end));
        }
        // A square's middle halves the diagonal whose ends are older: those of the other were made by the
        // bisections just before it, or are missing.
        let class = class_of(at);
        let diagonals = [[[-step, -step], [step, step]], [[-step, step], [step, -step]]];
        let ages = diagonals.map(|ends| {
            let older = |end: [i64; 2]| moved(at, end).is_some_and(|at| class_of(at) + 1 < class);
            ends.into_iter().filter(|&end| older(end)).count()
        });
        let found = diagonals.map(|ends| ends.map(|end| self.beside(at, end)));
        let present = |n: usize| found[n].iter().filter(|node| **node != NONE).count();
        if (ages[1], present(1)) > (ages[0], present(0)) { found[1] } else { found[0] }
    }

    fn beside(&self, at: LatticePoint, step: [i64; 2]) -> u32 {
        moved(at, step).map_or(NONE, |at| self.find(at))
    }
}

/// Steps along the lattice beyond this power of two leave it.
const LARGEST: u32 = 31;

fn moved(at: LatticePoint, [x, y]: [i64; 2]) -> Option<LatticePoint> {
    let x = u32::try_from(i64::from(at.x) + x).ok()?;
    let y = u32::try_from(i64::from(at.y) + y).ok()?;
    Some(LatticePoint::new(x, y))
}
