use super::BuiltMesh;
use crate::field::RefinementRule;
use crate::layers::PaintLayers;
use crate::mesh::{Element, Limits, Progress, RefineError};
use crate::surface::{ErrorQueue, QueueGoal, SurfaceRule};

/// Looks for a goal of the whole mesh, from a mesh on that meets everything else.
#[derive(Clone, Debug)]
pub(super) struct Search {
    pub(super) rule: SurfaceRule,
    pub(super) queue: ErrorQueue,
}

impl Search {
    pub(super) fn new(built: &BuiltMesh, rule: SurfaceRule, goal: QueueGoal, limits: &Limits) -> Self {
        Self { rule, queue: ErrorQueue::new(built.mesh.clone(), goal, limits) }
    }

    /// One slice of work: about `budget` triangles of the mesh that the search began with.
    pub(super) fn advance(
        &mut self,
        built: &BuiltMesh,
        paint: Option<&PaintLayers>,
        budget: usize,
    ) -> Result<Progress, RefineError> {
        let mut criterion = built.criterion(paint);
        // By the area rule, triangles inside one that satisfies h̄ satisfy it, too.
        let vertex = built.rule == RefinementRule::Vertex;
        let is_bound = |element: &Element| Ok(vertex && criterion.exceeds(element)?);
        let progress = self.queue.advance(&self.rule, &built.domain, is_bound, budget);
        progress.map_err(RefineError::Rule)
    }
}
