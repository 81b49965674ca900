//! Cells divided into parts: in two again and again, by a straight line and an exchange along it.
//!
//! A line across the longer side has the right number of cells on either side. Then cells beside it go to the
//! other side, one here for one there, as long as fewer edges are cut in the end
//! ([`exchange`](super::exchange)), and both sides are divided in the same way. All of it is in integers, and
//! cells are in the order of their places, so the parts depend on the mesh alone.
//!
//! Lines in the direction that leaves the fewest cut edges cut a fifth less. But after a dab another
//! direction can be the best, and then a third of all cells have another owner.

use super::cell_graph::CellGraph;
use super::exchange::exchanged;

/// Returns the part of each cell. There are at least as many cells as parts, and no part has more than one
/// cell more than another.
pub fn divided(graph: &CellGraph, parts: u32) -> Vec<u32> {
    let mut owners = vec![0; graph.len()];
    let all: Vec<u32> = (0..graph.len() as u32).collect();
    divide(graph, &all, [0, parts], (graph.len(), parts), &mut owners);
    owners
}

/// Divides cells into the parts of a range. `cells` are their numbers in the whole mesh, which has so many
/// cells and parts.
fn divide(graph: &CellGraph, cells: &[u32], [from, to]: [u32; 2], whole: (usize, u32), owners: &mut [u32]) {
    if to - from == 1 {
        cells.iter().for_each(|&cell| owners[cell as usize] = from);
        return;
    }
    let middle = from + (to - from) / 2;
    let is_second = halved(graph, start(middle, whole) - start(from, whole));
    for (second, range) in [(false, [from, middle]), (true, [middle, to])] {
        let half: Vec<u32> =
            (0..graph.len() as u32).filter(|&cell| is_second[cell as usize] == second).collect();
        let of_whole: Vec<u32> = half.iter().map(|&cell| cells[cell as usize]).collect();
        divide(&graph.some(&half), &of_whole, range, whole, owners);
    }
}

/// Returns the number of cells of all parts before one.
fn start(part: u32, (cells, parts): (usize, u32)) -> usize {
    (cells as u64 * u64::from(part)).div_ceil(u64::from(parts)) as usize
}

/// Returns which cells are not among the first so many.
fn halved(graph: &CellGraph, first: usize) -> Vec<bool> {
    let axis = longer_side(graph);
    let mut order: Vec<u32> = (0..graph.len() as u32).collect();
    order.select_nth_unstable_by_key(first, |&cell| (graph.place(cell)[axis], cell));
    let mut is_second = vec![true; graph.len()];
    order[..first].iter().for_each(|&cell| is_second[cell as usize] = false);
    exchanged(graph, is_second)
}

/// Returns the axis along which the cells reach farther.
fn longer_side(graph: &CellGraph) -> usize {
    let [width, height] = [0, 1].map(|axis| {
        let along = || (0..graph.len() as u32).map(|cell| graph.place(cell)[axis]);
        along().max().zip(along().min()).map_or(0, |(greatest, least)| greatest - least)
    });
    usize::from(height > width)
}
