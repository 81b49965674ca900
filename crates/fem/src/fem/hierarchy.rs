//! The equations on the meshes that the bisection went through: Galerkin products along the tree.
//!
//! Nodes are eliminated from the newest to the oldest: a node gets a mean of its parents, with weights by the
//! entries of its row, which follow jumps of the coefficient \[AlcouffeBrandtDendyPainter1981\]. What is kept
//! of each age is what its smoothing needs: the rows of its new nodes and of their parents
//! \[ChenNochettoXu2012\]. Nodes without parents, as those that the outline added, get a weighted mean of the
//! neighbours that are older, by the entries of their row \[RugeStuben1987\].

use super::coarse_solver::CoarseSolver;
use super::fem_mesh::NONE;
use super::growing_rows::GrowingRows;
use super::matrix::Matrix;
use super::tree::NodeTree;

/// Nodes with which the rest is solved directly.
const FEW: usize = 200;

/// The levels of a multigrid method.
#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    /// From the newest nodes to the oldest.
    pub levels: Vec<AgeLevel>,
    /// What is solved directly.
    pub coarse: CoarseSolver,
}

/// The nodes of one age, with what smoothing and interpolation need.
#[derive(Clone, Debug, Default)]
pub(crate) struct AgeLevel {
    /// The new nodes, in the order of their elimination.
    pub new: Vec<u32>,
    /// Parents and weights of `new[n]` are those from `weight_start[n]` to `weight_start[n + 1]`.
    pub weight_start: Vec<u32>,
    pub weights: Vec<(u32, f64)>,
    /// The nodes that are smoothed: first the new ones.
    pub smoothed: Vec<u32>,
    /// Their rows.
    pub rows: Matrix,
}

impl Hierarchy {
    /// Builds the levels of a symmetric matrix. Rows of nodes where `is_free` is false are left out.
    pub fn of(matrix: &Matrix, tree: &NodeTree, is_free: &[bool]) -> Self {
        let mut by_class: Vec<Vec<u32>> = vec![Vec::new(); 256];
        let free = (0..is_free.len()).filter(|&node| is_free[node]);
        free.clone().for_each(|node| by_class[tree.class[node] as usize].push(node as u32));
        let mut building = Building {
            rows: GrowingRows::of(matrix),
            rank: vec![u64::MAX; is_free.len()],
            tree,
            is_free,
            left: free.count(),
        };
        for (class, nodes) in by_class.iter().enumerate() {
            for &node in nodes {
                building.rank[node as usize] = (class as u64) << 32 | u64::from(node);
            }
        }
        let mut levels = Vec::new();
        let mut waiting = Vec::new();
        while let Some(mut nodes) = by_class.pop() {
            if building.left <= FEW {
                waiting.append(&mut nodes);
                continue;
            }
            nodes.append(&mut waiting);
            let level = building.level(nodes, &mut waiting);
            if !level.new.is_empty() {
                levels.push(level);
            }
        }
        waiting.sort_unstable();
        Self { levels, coarse: CoarseSolver::new(&building.rows, waiting) }
    }
}

/// A hierarchy while it is built.
struct Building<'a> {
    rows: GrowingRows,
    /// Nodes by age: a node gets its value from nodes with less.
    rank: Vec<u64>,
    tree: &'a NodeTree,
    is_free: &'a [bool],
    /// Nodes that were not eliminated.
    left: usize,
}

impl Building<'_> {
    /// Makes a level of nodes and eliminates them. Nodes that nothing determines yet wait.
    fn level(&mut self, mut nodes: Vec<u32>, waiting: &mut Vec<u32>) -> AgeLevel {
        // So that a node that gets its value from another of the same age goes first.
        nodes.sort_unstable_by_key(|&node| std::cmp::Reverse(self.rank[node as usize]));
        let mut level = AgeLevel { weight_start: vec![0], ..AgeLevel::default() };
        for node in nodes {
            if self.find_weights(node, &mut level.weights) {
                level.new.push(node);
                level.weight_start.push(level.weights.len() as u32);
            } else {
                waiting.push(node);
            }
        }
        let mut parents: Vec<u32> = level.weights.iter().map(|(parent, _)| *parent).collect();
        parents.sort_unstable();
        parents.dedup();
        let is_new: std::collections::BTreeSet<u32> = match parents.last() {
            // Only nodes without parents of their own get values from nodes of the same age.
            Some(_) if level.new.iter().any(|&node| self.tree.parents[node as usize] == [NONE; 2]) => {
                level.new.iter().copied().collect()
            }
            _ => Default::default(),
        };
        parents.retain(|parent| !is_new.contains(parent));
        level.smoothed = [&level.new[..], &parents[..]].concat();
        level.rows = self.rows.copied(&level.smoothed);
        for n in 0..level.new.len() {
            let range = level.weight_start[n] as usize..level.weight_start[n + 1] as usize;
            self.rows.eliminate(level.new[n], &level.weights[range]);
        }
        self.left -= level.new.len();
        level
    }

    /// Appends the weights of the nodes that a node gets its value from. Returns false where it must wait.
    fn find_weights(&self, node: u32, weights: &mut Vec<(u32, f64)>) -> bool {
        let parents = self.tree.parents[node as usize];
        let known = parents.into_iter().filter(|&parent| parent != NONE);
        let count = known.clone().count();
        if count > 0 {
            let weight = 1.0 / count as f64;
            // A parent where u is given has no correction.
            let free = known.filter(|&parent| self.is_free[parent as usize]);
            if let Some(shares) = self.shares_of_parents(node) {
                weights.extend(free.zip(shares));
                return true;
            }
            weights.extend(free.map(|parent| (parent, weight)));
            return true;
        }
        self.find_weights_of_row(node, weights)
    }

    /// Returns the weights of two parents where u is not given, by the entries of the row: where the
    /// coefficient jumps between them, the value follows the side on which more diffuses.
    fn shares_of_parents(&self, node: u32) -> Option<[f64; 2]> {
        let parents = self.tree.parents[node as usize];
        if !parents.iter().all(|&parent| parent != NONE && self.is_free[parent as usize]) {
            return None;
        }
        let (_, row) = self.rows.row(node);
        let entry =
            |parent: u32| row.iter().find(|(other, _)| *other == parent).map_or(0.0, |entry| -entry.1);
        let [first, second] = parents.map(entry);
        (first > 0.0 && second > 0.0).then(|| [first, second].map(|entry| entry / (first + second)))
    }

    /// Appends weights by the entries of the row.
    fn find_weights_of_row(&self, node: u32, weights: &mut Vec<(u32, f64)>) -> bool {
        let rank = self.rank[node as usize];
        let (diagonal, row) = self.rows.row(node);
        if row.is_empty() {
            return false;
        }
        let class = rank >> 32;
        let is_older = |other: u32, of_class: bool| {
            let other = self.rank[other as usize];
            if of_class { other >> 32 < class } else { other < rank }
        };
        // Nodes of older ages if there are any, or else of its own.
        for of_class in [true, false] {
            let sources = row.iter().filter(|(other, value)| *value < 0.0 && is_older(*other, of_class));
            let strength: f64 = sources.clone().map(|(_, value)| value).sum();
            if strength < 0.0 {
                let all: f64 = row.iter().map(|(_, value)| value).sum();
                // Constants stay what they are where nothing holds them.
                let share = (-all / diagonal).clamp(0.0, 1.0);
                weights.extend(sources.map(|(other, value)| (*other, share * value / strength)));
                return true;
            }
        }
        false
    }
}
