//! Refinement on all threads, in blocks: triangles that are refined to one depth everywhere.
//!
//! ```text
//!   survey    which triangles of the bisection tree exceed their target?                 all threads
//!   skeleton  bisect until each triangle is a block, and blocks match at their edges     one thread
//!   write     number the triangles and nodes of all blocks, copy them from templates     all threads
//! ```
//!
//! Away from the lines where the level changes, a mesh is uniform: nearly all triangles belong to blocks of
//! hundreds, which need not be bisected one by one. A *template* has its triangles in the order in which
//! bisection makes them, so that they have the vertices, orientations and neighbours that Algorithm 12 gives
//! them.
//!
//! The skeleton is made in the arrays of the mesh itself, and the blocks are written around it: an entry of
//! the skeleton is read until the block of that entry is written. What the neighbours of a block must know
//! about it is kept in two bytes, so that nothing is stored twice.
//!
//! Every bisection is necessary: those of the survey, because a triangle exceeds its target; those of the
//! skeleton besides, because the triangle across an edge has a node there. So the mesh is the smallest
//! conforming refinement that satisfies the rule. The rule must be monotone: children of a triangle that
//! satisfies it satisfy it too.
//!
//! The result depends on the rule and the mesh only, so the arrays are the same for any number of threads.
//! Their order is not that of Algorithm 12, which [`Refiner`](super::Refiner) follows.

mod rule;
mod shape;
mod skeleton;
mod survey;
mod template;
mod write;

use super::{LimitError, Limits, Mesh, Progress, RefineError};
pub use rule::{LevelsWithin, RuleAnswers, SharedRule};
use skeleton::Skeleton;
use survey::Survey;
use write::Writer;

/// Refinement of a mesh in blocks, on the threads of the current pool of rayon, in slices.
///
/// The mesh does not conform between slices.
#[derive(Clone, Debug)]
pub struct BlockRefiner {
    limits: Limits,
    stage: BlockStage,
    triangles: usize,
    capped: usize,
}

#[derive(Clone, Debug)]
enum BlockStage {
    Survey(Survey),
    Skeleton(Box<Skeleton>),
    Write(Box<Writer>),
    Done,
}

impl BlockRefiner {
    /// Creates the work that visits every triangle of `mesh` and all their descendants.
    pub fn new(mesh: &Mesh, limits: Limits) -> Self {
        Self { limits, stage: BlockStage::Survey(Survey::new(mesh)), triangles: 0, capped: 0 }
    }

    /// Refines until done or until about `visits` triangles were asked about or written; a little on each
    /// thread at least.
    ///
    /// # Errors
    /// Fails when the rule fails, or a limit is reached. The mesh is then of no use.
    pub fn advance<R: SharedRule>(
        &mut self,
        mesh: &mut Mesh,
        rule: &R,
        visits: usize,
    ) -> Result<Progress, RefineError<R::Error>> {
        self.stage = match std::mem::replace(&mut self.stage, BlockStage::Done) {
            BlockStage::Survey(mut survey) => {
                let progress = survey.advance(mesh, &self.limits, rule, visits)?;
                (self.triangles, self.capped) = (survey.triangles(), survey.capped());
                match progress {
                    Progress::More => BlockStage::Survey(survey),
                    Progress::Done => BlockStage::Skeleton(Box::new(Skeleton::new(mesh, survey.finish()))),
                }
            }
            BlockStage::Skeleton(mut skeleton) => {
                match skeleton.advance(mesh, &self.limits, visits).map_err(LimitError::with_rule)? {
                    Progress::More => BlockStage::Skeleton(skeleton),
                    Progress::Done => {
                        self.begin_writing(mesh, skeleton.finish()).map_err(LimitError::with_rule)?
                    }
                }
            }
            BlockStage::Write(mut writer) => {
                match writer.advance(mesh, &self.limits, visits).map_err(LimitError::with_rule)? {
                    Progress::More => BlockStage::Write(writer),
                    Progress::Done => BlockStage::Done,
                }
            }
            BlockStage::Done => BlockStage::Done,
        };
        Ok(if matches!(self.stage, BlockStage::Done) { Progress::Done } else { Progress::More })
    }

    fn begin_writing(&mut self, skeleton: &Mesh, depths: Vec<u8>) -> Result<BlockStage, LimitError> {
        self.triangles = depths.iter().map(|&depth| 1 << depth).sum();
        if self.triangles > self.limits.most_triangles() {
            return Err(self.limits.passed());
        }
        Ok(BlockStage::Write(Box::new(Writer::new(skeleton, depths))))
    }

    /// Returns how many triangles the mesh will have, as far as that is known.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Returns how many triangles asked for more than [`Limits::max_level`] allows.
    pub fn capped(&self) -> usize {
        self.capped
    }
}

impl Mesh {
    /// Refines on all threads, in one go. Returns how many triangles the level cap left coarser than their
    /// target.
    ///
    /// The rule is asked by several threads, so it is a closure that returns a closure for each of them. A
    /// triangle is given by its corners and its level:
    ///
    /// ```
    /// use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
    /// use meshbrush_mesh::mesh::{Limits, Mesh, bisection_edge_length};
    ///
    /// let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000)?;
    /// let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default())?;
    /// let rule = || {
    ///     |corners: [LatticePoint; 3], level: u32| {
    ///         let near = corners.iter().any(|&p| lattice.world_from_lattice(p).length() < 0.3);
    ///         bisection_edge_length(lattice.spacing(), level) > if near { 0.01 } else { 0.1 }
    ///     }
    /// };
    /// mesh.refine_in_blocks(&Limits::default(), &rule)?;
    /// assert!(mesh.violations().is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Fails when the rule fails, or a limit is reached. The mesh is then of no use.
    pub fn refine_in_blocks<R: SharedRule>(
        &mut self,
        limits: &Limits,
        rule: &R,
    ) -> Result<usize, RefineError<R::Error>> {
        let mut refiner = BlockRefiner::new(self, *limits);
        while refiner.advance(self, rule, usize::MAX)? == Progress::More {}
        Ok(refiner.capped())
    }
}
