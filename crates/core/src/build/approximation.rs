//! The part of a builder's work that brings a mesh close to the surfaces of its layers.

use std::collections::VecDeque;
use std::sync::Arc;

use super::search::Search;
use super::{BuiltMesh, RefinementCriterion};
use crate::field::RefinementRule;
use crate::layers::{Layer, PaintLayers};
use crate::mesh::{Element, InvalidTarget, Limits, Progress, RefineError, Refiner};
use crate::surface::{QueueGoal, SurfaceNodes, SurfaceRule, SurfaceSamples, SurfaceSampling};

/// Refines a mesh that satisfies h̄ until it is close enough to surfaces, in slices.
///
/// ```text
///  find the samples ──▶ refine ──▶ done
///                         │ ▲
///  a layer has a goal     ▼ │   refines once more, by what was found
///  of the whole mesh:   find it
/// ```
#[derive(Clone, Debug)]
pub(super) struct Approximation {
    limits: Limits,
    /// The layers of surfaces, with all others.
    layers: Vec<Layer>,
    step: ApproximationStep,
    capped: usize,
}

#[derive(Clone, Debug)]
enum ApproximationStep {
    Sample(SurfaceSampling),
    Refine(Box<SurfaceRefinement>),
    /// A goal, with those that come after it.
    Find(Box<(Search, VecDeque<QueueGoal>)>),
}

#[derive(Clone, Debug)]
struct SurfaceRefinement {
    rule: SurfaceRule,
    refiner: Refiner,
    nodes: SurfaceNodes,
    /// The goals of the whole mesh that come next.
    goals: VecDeque<QueueGoal>,
}

impl Approximation {
    /// Returns the work for a mesh with these layers; `None` if no visible layer is a surface. `samples` are
    /// those of the layers, where they are known.
    pub(super) fn new(
        layers: &[Layer],
        samples: Option<Arc<SurfaceSamples>>,
        built: &BuiltMesh,
        limits: Limits,
    ) -> Option<Self> {
        let sampling = SurfaceSampling::new(layers, built.mesh.lattice())?;
        let step = match samples {
            Some(samples) => refine(SurfaceRule::new(samples, layers), None, built, limits),
            None => ApproximationStep::Sample(sampling),
        };
        Some(Self { limits, layers: layers.to_vec(), step, capped: 0 })
    }

    /// Returns the number of triangles that the mesh has so far.
    pub(super) fn triangles(&self, built: &BuiltMesh) -> usize {
        match &self.step {
            ApproximationStep::Find(work) => work.0.queue.triangles(),
            ApproximationStep::Sample(_) | ApproximationStep::Refine(_) => built.mesh.raw_triangle_count(),
        }
    }

    /// Returns the number of triangles that the level cap left with a larger error.
    pub(super) fn capped(&self) -> usize {
        self.capped
    }

    /// One slice of work: about `budget` samples or triangles.
    pub(super) fn advance(
        &mut self,
        built: &mut BuiltMesh,
        paint: Option<&PaintLayers>,
        budget: usize,
    ) -> Result<Progress, RefineError> {
        let next = match &mut self.step {
            ApproximationStep::Sample(sampling) => {
                match sampling.advance(&built.domain, paint.unwrap_or(PaintLayers::blank()), budget) {
                    Progress::More => None,
                    Progress::Done => {
                        let rule = SurfaceRule::new(Arc::new(sampling.take_found()), &self.layers);
                        Some(refine(rule, None, built, self.limits))
                    }
                }
            }
            ApproximationStep::Refine(work) => {
                if work.advance(built, paint, budget)? == Progress::More {
                    return Ok(Progress::More);
                }
                self.capped += work.refiner.capped();
                match work.goals.pop_front() {
                    None => {
                        built.surface = Some(Arc::new(work.rule.clone()));
                        return Ok(Progress::Done);
                    }
                    Some(goal) => {
                        let search = Search::new(built, work.rule.clone(), goal, &self.limits);
                        Some(ApproximationStep::Find(Box::new((search, std::mem::take(&mut work.goals)))))
                    }
                }
            }
            ApproximationStep::Find(work) => match work.0.advance(built, paint, budget)? {
                Progress::More => None,
                Progress::Done => {
                    let rule = work.0.rule.clone().with_found(&work.0.queue);
                    let goals = std::mem::take(&mut work.1);
                    Some(refine(rule, Some(goals), built, self.limits))
                }
            },
        };
        if let Some(next) = next {
            self.step = next;
        }
        Ok(Progress::More)
    }
}

/// Returns the refinement by a rule, before goals of the whole mesh: those of the rule, or what is left of
/// them.
fn refine(
    rule: SurfaceRule,
    goals: Option<VecDeque<QueueGoal>>,
    built: &BuiltMesh,
    limits: Limits,
) -> ApproximationStep {
    let goals = goals.unwrap_or_else(|| rule.goals().into());
    let refiner = Refiner::new(&built.mesh, limits);
    ApproximationStep::Refine(Box::new(SurfaceRefinement {
        rule,
        refiner,
        nodes: SurfaceNodes::default(),
        goals,
    }))
}

impl SurfaceRefinement {
    /// Triangles inside one that satisfies h̄ by the area rule satisfy it too: only the vertex rule is asked
    /// again.
    fn advance(
        &mut self,
        built: &mut BuiltMesh,
        paint: Option<&PaintLayers>,
        budget: usize,
    ) -> Result<Progress, RefineError> {
        let BuiltMesh { domain, field, rule, mesh, .. } = built;
        let mut criterion = RefinementCriterion::new(domain, field, *rule, paint);
        let vertex = *rule == RefinementRule::Vertex;
        let (surface, nodes) = (&self.rule, &mut self.nodes);
        let exceeds = |element: &Element| -> Result<bool, InvalidTarget> {
            Ok(surface.exceeds(element, nodes) || (vertex && criterion.exceeds(element)?))
        };
        self.refiner.advance(mesh, exceeds, budget)
    }
}
