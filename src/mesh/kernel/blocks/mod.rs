//! Refinement on all threads, in blocks that fit into the cache of a core.
//!
//! ```text
//!   small    refine in the order of Algorithm 12, unless the mesh becomes large      one thread
//!   plan     refine until each triangle stands for the work of a block at most       one thread
//!   refine   each block alone; edges between blocks count as boundary: seams         all threads
//!   join     number the nodes that blocks share; append the blocks to the mesh       all threads
//!   sew      bisect what does not match across the seams; make neighbours            one thread
//! ```
//!
//! Every bisection is necessary: those of a block, because a triangle exceeds its target or because of
//! another one in the block; those at a seam, because the other side has a node there. So the mesh is the
//! smallest conforming refinement that satisfies the rule, as without blocks. The rule must be monotone:
//! children of a triangle that satisfies it satisfy it too.
//!
//! Blocks are planned, numbered and appended in an order that depends on the rule and the mesh only. So the
//! arrays are the same for any number of threads. Their order is not that of Algorithm 12, which
//! [`Refiner`] follows.

mod block;
mod plan;
mod seams;

use rayon::prelude::*;

use super::{Element, Limits, Mesh, Progress, RefineError, Refiner};
use crate::geometry::LatticePoint;
use block::Block;
use plan::{BLOCK_TRIANGLES, Plan, Planner};
use seams::Seams;

/// A refinement rule that several threads can ask. It must be monotone.
pub trait SharedRule: Sync {
    /// Answers whether a triangle, by its corners in any order and its level, exceeds its target. Each thread
    /// has its own, which may keep what helps with the next triangles nearby.
    fn exceeds(&self) -> impl FnMut([LatticePoint; 3], u32) -> bool;
}

impl<F, Q> SharedRule for F
where
    F: Fn() -> Q + Sync,
    Q: FnMut([LatticePoint; 3], u32) -> bool,
{
    fn exceeds(&self) -> impl FnMut([LatticePoint; 3], u32) -> bool {
        self()
    }
}

/// Meshes with fewer triangles than this are refined without a plan, which would cost them more than it
/// saves. For larger ones this much work is done twice.
const SMALL: usize = BLOCK_TRIANGLES as usize;

/// Refinement of a mesh in blocks, on the threads of the current pool of rayon, in slices.
///
/// The mesh does not conform between slices. The arrays of small meshes have the order of [`Refiner`].
#[derive(Clone, Debug)]
pub struct BlockRefiner {
    limits: Limits,
    stage: Stage,
    capped: usize,
}

#[derive(Clone, Debug)]
enum Stage {
    /// As long as the mesh is small; with the mesh to begin with again.
    Small(Box<Mesh>, Refiner),
    Plan(Planner),
    /// There is only one block.
    Whole(Refiner),
    Refine(Box<Blocks>),
    Sew(Seams),
    Done,
}

/// The blocks, and how far they are.
#[derive(Clone, Debug)]
struct Blocks {
    plan: Plan,
    seams: Seams,
    /// The first block that is not refined.
    next: usize,
    /// Memory for the blocks that are refined together.
    slots: Vec<Block>,
}

impl BlockRefiner {
    /// Work that visits every triangle of `mesh` and all their descendants.
    pub fn new(mesh: &Mesh, limits: Limits) -> Self {
        let stage = if mesh.raw_triangle_count() < SMALL {
            let max_triangles = limits.max_triangles.min(SMALL);
            Stage::Small(Box::new(mesh.clone()), Refiner::new(mesh, Limits { max_triangles, ..limits }))
        } else {
            Stage::Plan(Planner::new(mesh, limits))
        };
        Self { limits, stage, capped: 0 }
    }

    /// Refines until done or until about `visits` triangles were asked about; at least one block for each
    /// thread.
    ///
    /// # Errors
    /// When a limit is reached. The mesh is then of no use.
    pub fn advance(
        &mut self,
        mesh: &mut Mesh,
        rule: &impl SharedRule,
        visits: usize,
    ) -> Result<Progress, RefineError> {
        match &mut self.stage {
            Stage::Small(coarse, refiner) => match refine_in_order(refiner, mesh, rule, visits) {
                Ok(Progress::More) => {}
                Ok(Progress::Done) => {
                    self.capped = refiner.capped();
                    self.stage = Stage::Done;
                }
                Err(error) if error.is_over_budget() && self.limits.most_triangles() > SMALL => {
                    mesh.clone_from(coarse);
                    self.stage = Stage::Plan(Planner::new(mesh, self.limits));
                }
                Err(error) => return Err(error),
            },
            Stage::Plan(planner) => {
                if let Some(plan) = planner.advance(mesh, rule, visits)? {
                    self.stage = if plan.blocks() == 1 {
                        Stage::Whole(Refiner::new(mesh, self.limits))
                    } else {
                        Stage::Refine(Box::new(Blocks::new(plan, mesh)))
                    };
                }
            }
            Stage::Whole(refiner) => {
                if refine_in_order(refiner, mesh, rule, visits)? == Progress::Done {
                    self.capped = refiner.capped();
                    self.stage = Stage::Done;
                }
            }
            Stage::Refine(blocks) => {
                self.capped += blocks.advance(mesh, &self.limits, rule, visits)?;
                if blocks.next == blocks.plan.blocks() {
                    self.stage = Stage::Sew(std::mem::take(&mut blocks.seams));
                }
            }
            Stage::Sew(seams) => {
                if seams.sew(mesh, &self.limits, visits)? == Progress::Done {
                    self.stage = Stage::Done;
                }
            }
            Stage::Done => {}
        }
        Ok(if matches!(self.stage, Stage::Done) { Progress::Done } else { Progress::More })
    }

    /// How many triangles asked for more than [`Limits::max_level`] allows.
    pub fn capped(&self) -> usize {
        self.capped
    }
}

/// Asks about `visits` triangles in the order of Algorithm 12.
fn refine_in_order(
    refiner: &mut Refiner,
    mesh: &mut Mesh,
    rule: &impl SharedRule,
    visits: usize,
) -> Result<Progress, RefineError> {
    let mut exceeds = rule.exceeds();
    refiner.advance(mesh, |element: &Element| Ok(exceeds(element.corners, element.triangle.level())), visits)
}

impl Mesh {
    /// Refines on all threads, in one go. Returns how many triangles the level cap left
    /// coarser than their target.
    ///
    /// # Errors
    /// When a limit is reached. The mesh is then of no use.
    pub fn refine_in_blocks(
        &mut self,
        limits: &Limits,
        rule: &impl SharedRule,
    ) -> Result<usize, RefineError> {
        let mut refiner = BlockRefiner::new(self, *limits);
        while refiner.advance(self, rule, usize::MAX)? == Progress::More {}
        Ok(refiner.capped())
    }
}

impl Blocks {
    fn new(plan: Plan, mesh: &Mesh) -> Self {
        let seams = Seams::new(plan.seams(mesh));
        let count = (2 * rayon::current_num_threads() + 2).min(plan.blocks());
        let slots = (0..count).map(|_| Block::new(mesh.lattice())).collect();
        Self { plan, seams, next: 0, slots }
    }

    /// Refines some blocks and appends them to the mesh. Returns how many triangles the level cap stopped.
    fn advance(
        &mut self,
        mesh: &mut Mesh,
        limits: &Limits,
        rule: &impl SharedRule,
        visits: usize,
    ) -> Result<usize, RefineError> {
        let (mut capped, mut visited) = (0, 0);
        while self.next < self.plan.blocks() && visited < visits {
            let count = self.slots.len().min(self.plan.blocks() - self.next);
            let (plan, seams, next) = (&self.plan, &self.seams, self.next);
            let slots = &mut self.slots[..count];
            let whole: &Mesh = mesh;
            slots.par_iter_mut().enumerate().with_max_len(1).try_for_each(|(slot, block)| {
                block.load(whole, plan, next + slot, seams);
                block.refine(limits, rule)?;
                block.find_edges(seams);
                Ok::<_, RefineError>(())
            })?;
            self.append(mesh, limits, count)?;
            self.next += count;
            capped += self.slots[..count].iter().map(Block::capped).sum::<usize>();
            visited += 2 * self.slots[..count].iter().map(Block::triangle_count).sum::<usize>();
        }
        Ok(capped)
    }

    /// Appends the first blocks of the slots to the mesh.
    fn append(&mut self, mesh: &mut Mesh, limits: &Limits, count: usize) -> Result<(), RefineError> {
        let blocks = &mut self.slots[..count];
        let (mut triangles, mut nodes) = (mesh.triangles.len(), mesh.nodes.len());
        for block in &mut *blocks {
            block.join(&mut self.seams, triangles, nodes);
            triangles += block.own_triangles();
            nodes += block.own_nodes();
        }
        if triangles > limits.most_triangles() {
            return Err(limits.passed());
        }
        mesh.make_room(triangles - mesh.triangles.len(), limits.most_triangles());
        mesh.append_blocks(blocks);
        Ok(())
    }
}

impl Mesh {
    /// Appends blocks that were joined, and changes the entries of their first triangles and nodes.
    fn append_blocks(&mut self, blocks: &[Block]) {
        use super::memory::append_pieces;
        let triangle_counts = blocks.iter().map(Block::own_triangles);
        let node_counts = || blocks.iter().map(Block::own_nodes);
        append_pieces(&mut self.triangles, triangle_counts, |triangles| {
            append_pieces(&mut self.nodes, node_counts(), |nodes| {
                append_pieces(&mut self.triangle_at, node_counts(), |triangle_at| {
                    let pieces = triangles.par_iter_mut().zip(nodes).zip(triangle_at).zip(blocks);
                    pieces.with_max_len(1).for_each(|(((triangles, nodes), triangle_at), block)| {
                        block.write_triangles(triangles);
                        block.write_nodes(nodes, triangle_at);
                    });
                });
            });
        });
        for block in blocks {
            for (id, triangle) in block.roots() {
                self.triangles[id.index()] = triangle;
            }
            for (node, triangle) in block.root_nodes() {
                self.triangle_at[node.index()] = triangle;
            }
            block.count(&mut self.counts);
        }
    }
}
