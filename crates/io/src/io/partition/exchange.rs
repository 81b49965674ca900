//! Fewer cut edges between two halves, by an exchange of cells along their border: the method of Fiduccia and
//! Mattheyses (A linear-time heuristic for improving network partitions, 1982), which keeps both sizes.
//!
//! In a pass each cell moves once at most: always the one with the largest gain, from the side that has given
//! fewer. Moves that lose are taken, too, as others can gain by them. In the end those after the best state
//! are taken back; only states count in which both halves have their sizes.

use std::collections::BTreeSet;

use super::cell_graph::CellGraph;

/// Most passes.
const MOST_PASSES: usize = 8;
/// Moves without a better state after which a pass ends.
const MOST_IN_VAIN: usize = 200;
/// How many more cells one side can have given than the other.
const MOST_AHEAD: isize = 2;

/// Returns which cells are in the second half after an exchange.
pub fn exchanged(graph: &CellGraph, is_second: Vec<bool>) -> Vec<bool> {
    let mut halves = Halves { graph, is_second };
    for _ in 0..MOST_PASSES {
        if !halves.pass() {
            break;
        }
    }
    halves.is_second
}

struct Halves<'a> {
    graph: &'a CellGraph,
    is_second: Vec<bool>,
}

/// The cells that can move, the best first, and those that have moved.
#[derive(Default)]
struct Queue {
    /// By side: the gain, negative so that the largest is the first, and the cell.
    sides: [BTreeSet<(i32, u32)>; 2],
}

impl Halves<'_> {
    /// Returns for each neighbour of a cell whether it is on the other side.
    fn across(&self, cell: usize) -> impl Iterator<Item = bool> + '_ {
        let side = self.is_second[cell];
        self.graph.beside(cell).iter().map(move |&other| self.is_second[other as usize] != side)
    }

    /// Returns by how much fewer edges would be cut if a cell changed its side.
    fn gain(&self, cell: usize) -> i32 {
        self.across(cell).map(|is_across| if is_across { 1 } else { -1 }).sum()
    }

    /// Exchanges cells, and returns whether fewer edges are cut.
    fn pass(&mut self) -> bool {
        let (mut queue, mut has_moved) = (Queue::default(), vec![false; self.graph.len()]);
        for cell in 0..self.graph.len() {
            if self.across(cell).any(|is_across| is_across) {
                queue.insert(self, cell);
            }
        }
        let (mut moved, mut ahead) = (Vec::new(), 0);
        let (mut gained, mut best, mut best_length) = (0, 0, 0);
        while moved.len() - best_length < MOST_IN_VAIN {
            let Some((gain, cell)) = queue.next(ahead) else { break };
            ahead += if self.is_second[cell] { -1 } else { 1 };
            gained += gain;
            self.change(cell, &mut queue, &mut has_moved);
            moved.push(cell);
            if ahead == 0 && gained > best {
                (best, best_length) = (gained, moved.len());
            }
        }
        for &cell in &moved[best_length..] {
            self.is_second[cell] = !self.is_second[cell];
        }
        best > 0
    }

    /// Moves a cell that is no longer in the queue to the other side.
    fn change(&mut self, cell: usize, queue: &mut Queue, has_moved: &mut [bool]) {
        has_moved[cell] = true;
        let graph = self.graph;
        let others = || graph.beside(cell).iter().map(|&other| other as usize);
        let free: Vec<usize> = others().filter(|&other| !has_moved[other]).collect();
        free.iter().for_each(|&other| queue.remove(self, other));
        self.is_second[cell] = !self.is_second[cell];
        free.iter().for_each(|&other| queue.insert(self, other));
    }
}

impl Queue {
    fn insert(&mut self, halves: &Halves, cell: usize) {
        self.sides[usize::from(halves.is_second[cell])].insert((-halves.gain(cell), cell as u32));
    }

    fn remove(&mut self, halves: &Halves, cell: usize) {
        self.sides[usize::from(halves.is_second[cell])].remove(&(-halves.gain(cell), cell as u32));
    }

    /// Takes the next cell to move, with its gain, where the first half has given so many more cells than the
    /// second.
    fn next(&mut self, ahead: isize) -> Option<(i32, usize)> {
        let [first, second] = self.sides.each_ref().map(|side| side.first().map(|&(loss, _)| loss));
        let side = match (first, second) {
            _ if ahead >= MOST_AHEAD => 1,
            _ if ahead <= -MOST_AHEAD => 0,
            (Some(a), Some(b)) => usize::from(b < a || (a == b && ahead > 0)),
            (None, _) => 1,
            (_, None) => 0,
        };
        self.sides[side].pop_first().map(|(loss, cell)| (-loss, cell as usize))
    }
}
