//! Builds the index of a region on the lattice of a mesh, in slices.

use std::sync::Arc;

use glam::DVec2;

use super::Region;
use super::on_lattice::{RegionOnLattice, SquareState, TreeLevel, middle_of_row};
use super::outline_edge::OutlineEdge;
use super::region::EdgeCursor;
use crate::geometry::Lattice;
use crate::mesh::Progress;

/// Number of smallest squares for each edge, about, within bounds.
const SQUARES_PER_EDGE: usize = 4;
const MOST_SQUARES: usize = 1 << 20;
/// Most entries of edges in squares, about.
const MOST_ENTRIES: u64 = 1 << 26;

/// Builds a [`RegionOnLattice`].
#[derive(Clone, Debug)]
pub(super) struct RegionOnLatticeBuilder {
    region: Arc<Region>,
    lattice: Lattice,
    most_entries: u64,
    /// Sum of the lengths of all edges along x and along y, in lattice steps.
    length: u64,
    /// How many times the root squares are halved.
    halvings: u32,
    index: RegionOnLattice,
    step: IndexStep,
}

/// The current step of the work.
#[derive(Clone, Copy, Debug)]
enum IndexStep {
    /// Corners are moved to the nearest lattice points.
    Moving(EdgeCursor),
    /// The squares that each edge touches are counted, from this edge on.
    Counting(usize),
    /// Each edge is entered into its squares, from this edge on.
    Sorting(usize),
    /// The states of the smallest squares are found, from this row on.
    Filling(u32),
    Done,
}

impl RegionOnLatticeBuilder {
    pub(super) fn new(region: &Arc<Region>, lattice: &Lattice) -> Self {
        Self::within(region, lattice, MOST_ENTRIES)
    }

    /// Creates a builder that makes at most about `most_entries` entries of edges in squares.
    pub(super) fn within(region: &Arc<Region>, lattice: &Lattice, most_entries: u64) -> Self {
        Self {
            region: region.clone(),
            lattice: *lattice,
            most_entries,
            length: 0,
            halvings: 0,
            index: RegionOnLattice::without_edges(lattice),
            step: IndexStep::Moving(EdgeCursor::default()),
        }
    }

    /// One slice of work: about `budget` edges or squares.
    pub(super) fn advance(&mut self, budget: usize) -> Progress {
        self.step = match self.step {
            IndexStep::Moving(cursor) => self.move_corners(cursor, budget),
            IndexStep::Counting(first) => self.count_squares(first, budget),
            IndexStep::Sorting(first) => self.sort_edges(first, budget),
            IndexStep::Filling(first) => self.fill_rows(first, budget),
            IndexStep::Done => IndexStep::Done,
        };
        if matches!(self.step, IndexStep::Done) { Progress::Done } else { Progress::More }
    }

    /// Returns the index. Work that is left is done in one go.
    pub(super) fn finish(mut self) -> RegionOnLattice {
        while self.advance(usize::MAX) == Progress::More {}
        self.index
    }

    fn move_corners(&mut self, mut cursor: EdgeCursor, budget: usize) -> IndexStep {
        let extent = self.lattice.extent();
        let place = |p: DVec2| {
            let p = self.lattice.nearest(p);
            [i64::from(p.x), i64::from(p.y)]
        };
        let sides = [[0, i64::from(extent.x)], [0, i64::from(extent.y)]];
        let on_side =
            |[a, b]: [[i64; 2]; 2], axis: usize| a[axis] == b[axis] && sides[axis].contains(&a[axis]);
        for _ in 0..budget {
            let Some(edge) = cursor.next(&self.region) else {
                self.choose_squares();
                return IndexStep::Counting(0);
            };
            let ends = edge.map(place);
            if ends[0] != ends[1] {
                let edge = OutlineEdge { ends, on_frame: on_side(ends, 0) || on_side(ends, 1) };
                self.length += edge.length();
                self.index.edges.push(edge);
            }
        }
        IndexStep::Moving(cursor)
    }

    /// Chooses the sizes of the largest and the smallest squares of the quadtree.
    fn choose_squares(&mut self) {
        let Self { index, length, most_entries, .. } = self;
        let (cells, root_bits) = (self.lattice.cells(), self.lattice.halvings());
        let wanted = (SQUARES_PER_EDGE * index.edges.len()).clamp(1 << 12, MOST_SQUARES);
        let roots = cells[0] as usize * cells[1] as usize;
        let mut halvings = 0;
        while halvings < root_bits && (roots << (2 * (halvings + 1))) <= wanted {
            halvings += 1;
        }
        // Long edges pass through many squares: too many, perhaps, even at the root.
        while halvings > 0 && *length >> (root_bits - halvings) > *most_entries {
            halvings -= 1;
        }
        (index.cells, index.root_bits) = (cells, root_bits);
        while *length >> index.root_bits > *most_entries && index.cells != [1, 1] {
            (index.cells, index.root_bits) = (index.cells.map(|n| n.div_ceil(2)), index.root_bits + 1);
        }
        self.halvings = halvings;
        let [columns, rows] = self.counts();
        self.index.ends = vec![0; columns as usize * rows as usize];
    }

    /// Returns the columns and rows of the smallest squares.
    fn counts(&self) -> [u32; 2] {
        self.index.cells.map(|n| n << self.halvings)
    }

    /// Returns the binary logarithm of their side in lattice steps.
    fn bits(&self) -> u32 {
        self.index.root_bits - self.halvings
    }

    fn count_squares(&mut self, first: usize, budget: usize) -> IndexStep {
        let (counts, bits) = (self.counts(), self.bits());
        let RegionOnLattice { edges, ends, .. } = &mut self.index;
        let end = first.saturating_add(budget).min(edges.len());
        for edge in &edges[first..end] {
            edge.squares_touched(counts, bits, |square| ends[square] += 1);
        }
        if end < edges.len() {
            return IndexStep::Counting(end);
        }
        let mut count = 0;
        for end in ends.iter_mut() {
            // The start of its part, for now; it becomes the end as edges are entered.
            count += std::mem::replace(end, count);
        }
        self.index.edges_of_square = vec![0; count as usize];
        IndexStep::Sorting(0)
    }

    fn sort_edges(&mut self, first: usize, budget: usize) -> IndexStep {
        let (counts, bits) = (self.counts(), self.bits());
        let RegionOnLattice { edges, ends, edges_of_square, .. } = &mut self.index;
        let end = first.saturating_add(budget).min(edges.len());
        for (n, edge) in edges.iter().enumerate().take(end).skip(first) {
            edge.squares_touched(counts, bits, |square| {
                edges_of_square[ends[square] as usize] = n as u32;
                ends[square] += 1;
            });
        }
        if end < edges.len() {
            return IndexStep::Sorting(end);
        }
        self.index.levels = vec![TreeLevel { columns: counts[0], states: Vec::with_capacity(ends.len()) }];
        IndexStep::Filling(0)
    }

    /// Finds the states of the smallest squares along the middle line of each row, and at the end the states
    /// of the larger squares.
    fn fill_rows(&mut self, first: u32, budget: usize) -> IndexStep {
        let [columns, rows] = self.counts();
        let at_once = (budget / columns as usize).clamp(1, rows as usize) as u32;
        let end = first.saturating_add(at_once).min(rows);
        for row in first..end {
            self.fill_row(row);
        }
        if end < rows {
            return IndexStep::Filling(end);
        }
        self.join_squares();
        IndexStep::Done
    }

    fn fill_row(&mut self, row: u32) {
        let [columns, _] = self.counts();
        let mut inside = false;
        for column in 0..columns {
            let square = row as usize * columns as usize + column as usize;
            self.index.inside_at_left.push(inside);
            let state = match (self.index.edges_in(square).next().is_some(), inside) {
                (true, _) => SquareState::Crossed,
                (false, true) => SquareState::Inside,
                (false, false) => SquareState::Outside,
            };
            if state == SquareState::Crossed {
                inside ^= self.crossings_of_middle(column, row) % 2 == 1;
            }
            self.index.levels[0].states.push(state);
        }
    }

    /// Returns how many edges cross the middle line of a smallest square, each counted in one square of the
    /// row.
    fn crossings_of_middle(&self, column: u32, row: u32) -> usize {
        let ([columns, _], bits) = (self.counts(), self.bits());
        let left = if column == 0 { i64::MIN } else { 3 * (i64::from(column) << bits) };
        let right = if column + 1 == columns { i64::MAX } else { 3 * (i64::from(column + 1) << bits) };
        let height = middle_of_row(i64::from(row), bits);
        let square = row as usize * columns as usize + column as usize;
        let crossing = |edge: &&OutlineEdge| edge.crosses_between(left, right, [i64::MAX, height]);
        self.index.edges_in(square).filter(crossing).count()
    }

    fn join_squares(&mut self) {
        for depth in (0..self.halvings).rev() {
            let [columns, rows] = self.index.cells.map(|n| n << depth);
            let finer = &self.index.levels[0];
            let squares = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
            let tree_level =
                TreeLevel { columns, states: squares.map(|square| finer.joined(square)).collect() };
            self.index.levels.insert(0, tree_level);
        }
    }
}
