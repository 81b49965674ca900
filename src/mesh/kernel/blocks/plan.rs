//! Which triangles make a block.

use std::ops::Range;

use super::SharedRule;
use crate::geometry::{LatticePoint, interleaved};
use crate::mesh::kernel::{Element, Limits, Mesh, Progress, RefineError, Refiner, TreeTriangle, TriangleId};

/// About the number of triangles that a block has at least, and half of the number that it has at most:
/// 0.7 to 1.4 MB, for caches of 2 MB and more.
pub(super) const BLOCK_TRIANGLES: f64 = 16_384.0;

/// Paths down the bisection tree from which the number of triangles is estimated.
const PATHS: u64 = 2;
/// About so many questions are asked about each triangle of the plan.
const QUESTIONS: usize = 32;

/// Refines a mesh until each of its triangles stands for at most one block.
#[derive(Clone, Debug)]
pub(super) struct Planner {
    refiner: Refiner,
    limits: Limits,
    /// How many triangles each triangle stands for, by its corners from the apex.
    estimates: Vec<([LatticePoint; 3], f64)>,
}

/// A mesh in blocks: its triangles along a curve that fills the plane, and where blocks begin.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// In the order of the blocks.
    roots: Vec<TriangleId>,
    /// Parts of `roots`.
    blocks: Vec<Range<usize>>,
    /// For each triangle its place in `roots`, and its block.
    places: Vec<(u32, u32)>,
}

/// The edges between blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct PlannedSeams {
    /// For each triangle and edge the number of the seam.
    pub numbers: Vec<[Option<u32>; 3]>,
    /// Where each seam begins.
    pub origins: Vec<LatticePoint>,
}

impl Planner {
    pub fn new(mesh: &Mesh, limits: Limits) -> Self {
        Self { refiner: Refiner::new(mesh, limits), limits, estimates: Vec::new() }
    }

    /// Asks about `visits` triangles or a little more.
    pub fn advance(
        &mut self,
        mesh: &mut Mesh,
        rule: &impl SharedRule,
        visits: usize,
    ) -> Result<Option<Plan>, RefineError> {
        let (deepest, cap) = (mesh.lattice().deepest_level(), self.limits.level_cap());
        let mut estimate = Estimate { exceeds: rule.exceeds(), deepest, cap, too_fine: None };
        let estimates = &mut self.estimates;
        let is_too_large = |element: &Element| {
            let second = element.triangle.bisection_end();
            let corners = [3 - second, 0, second].map(|place| element.corners[place]);
            let triangle = TreeTriangle::from_corners(corners, element.triangle.level());
            let triangles = estimate.triangles(&triangle);
            estimates.push((corners, triangles));
            Ok(triangles > BLOCK_TRIANGLES && estimate.too_fine.is_none())
        };
        let progress = self.refiner.advance(mesh, is_too_large, visits / QUESTIONS + 1)?;
        if let Some(at) = estimate.too_fine {
            return Err(RefineError::too_fine(mesh.lattice(), at));
        }
        Ok((progress == Progress::Done).then(|| self.plan(mesh)))
    }

    /// The triangles in the order of a Z-curve, cut where the estimates add up to a block.
    fn plan(&mut self, mesh: &Mesh) -> Plan {
        let mut estimates = std::mem::take(&mut self.estimates);
        estimates.sort_unstable_by_key(|&(corners, _)| corners);
        let estimate = |corners| {
            let place = estimates.binary_search_by_key(&corners, |&(corners, _)| corners);
            place.map_or(1.0, |place| estimates[place].1)
        };
        let ids = (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
        let mut keyed: Vec<_> = ids
            .map(|id| {
                let corners = TreeTriangle::of(mesh, id).corners();
                (z_order(corners), id, estimate(corners))
            })
            .collect();
        keyed.sort_unstable_by_key(|&(key, id, _)| (key, id));
        let (mut blocks, mut first, mut size) = (Vec::new(), 0, 0.0);
        let mut places = vec![(0, 0); keyed.len()];
        for (place, &(_, id, triangles)) in keyed.iter().enumerate() {
            places[id.index()] = (place as u32, blocks.len() as u32);
            size += triangles;
            if size >= BLOCK_TRIANGLES || place + 1 == keyed.len() {
                blocks.push(first..place + 1);
                (first, size) = (place + 1, 0.0);
            }
        }
        Plan { roots: keyed.into_iter().map(|(_, id, _)| id).collect(), blocks, places }
    }
}

/// How many triangles a triangle will be refined into.
///
/// One path down the bisection tree: where both children exceed their target, it follows one of them and
/// counts the other as equally many; where one does, it follows that one. The average over all paths is the
/// number of triangles without those that compatibility asks for \[Knuth1975\].
struct Estimate<E> {
    exceeds: E,
    /// The deepest level of the lattice, and that of the limits.
    deepest: u32,
    cap: u32,
    /// A corner of a triangle that exceeds its target at the deepest level of the lattice: there is no mesh.
    too_fine: Option<LatticePoint>,
}

impl<E: FnMut([LatticePoint; 3], u32) -> bool> Estimate<E> {
    fn triangles(&mut self, triangle: &TreeTriangle) -> f64 {
        if !self.is_bisected(triangle) {
            return 1.0;
        }
        (0..PATHS).map(|path| self.along(path, *triangle)).sum::<f64>() / PATHS as f64
    }

    /// Whether a triangle exceeds its target and may be bisected.
    fn is_bisected(&mut self, triangle: &TreeTriangle) -> bool {
        let level = triangle.level();
        if level >= self.cap || !(self.exceeds)(triangle.corners(), level) {
            return false;
        }
        if level >= self.deepest {
            self.too_fine = Some(triangle.apex());
        }
        level < self.deepest
    }

    /// The estimate of one path, for a triangle that exceeds its target.
    fn along(&mut self, path: u64, mut triangle: TreeTriangle) -> f64 {
        let (mut triangles, mut weight) = (0.0, 1.0);
        loop {
            let children = triangle.children();
            let exceed = children.map(|child| self.is_bisected(&child));
            triangle = match exceed {
                [false, false] => return triangles + 2.0 * weight,
                [true, false] | [false, true] => {
                    triangles += weight;
                    children[usize::from(exceed[1])]
                }
                [true, true] => {
                    weight *= 2.0;
                    children[usize::from(is_second(path, triangle.apex()))]
                }
            };
        }
    }
}

/// As good as random, and the same on every run.
fn is_second(path: u64, apex: LatticePoint) -> bool {
    let word = (u64::from(apex.x) << 32 | u64::from(apex.y)) ^ (path << 31);
    (word.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 60).is_multiple_of(2)
}

/// The place of a triangle along a Z-curve.
fn z_order(corners: [LatticePoint; 3]) -> u64 {
    let mean = |of: fn(&LatticePoint) -> u32| corners.iter().map(of).map(u64::from).sum::<u64>() / 3;
    interleaved(mean(|p| p.x) as u32, mean(|p| p.y) as u32)
}

impl Plan {
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// The triangles of a block.
    pub fn roots(&self, block: usize) -> &[TriangleId] {
        &self.roots[self.blocks[block].clone()]
    }

    /// The number of a triangle among those of a block, if it is one of them.
    pub fn place_in(&self, block: usize, id: TriangleId) -> Option<usize> {
        let (place, of) = self.places[id.index()];
        (of as usize == block).then(|| place as usize - self.blocks[block].start)
    }

    /// The edges between blocks, numbered.
    pub fn seams(&self, mesh: &Mesh) -> PlannedSeams {
        let mut numbers = vec![[None; 3]; self.places.len()];
        let mut origins = Vec::new();
        for id in (0..self.places.len()).map(TriangleId::from_index) {
            let triangle = mesh.triangle(id);
            for (edge, (from, to)) in triangle.edge_nodes().into_iter().enumerate() {
                let Some(across) = triangle.raw_neighbours[edge].triangle() else { continue };
                if across < id || self.places[id.index()].1 == self.places[across.index()].1 {
                    continue;
                }
                let there =
                    mesh.triangle(across).raw_neighbours.iter().position(|n| n.triangle() == Some(id));
                let number = Some(origins.len() as u32);
                numbers[id.index()][edge] = number;
                numbers[across.index()][there.expect("neighbours are symmetric")] = number;
                origins.push(mesh.node(from).min(mesh.node(to)));
            }
        }
        PlannedSeams { numbers, origins }
    }
}
