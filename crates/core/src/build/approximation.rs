//! The part of a builder's work that brings a mesh close to the surfaces of its layers.

use std::sync::Arc;

use super::{BuiltMesh, RefinementCriterion};
use crate::field::RefinementRule;
use crate::layers::{Layer, PaintLayers};
use crate::mesh::{Element, InvalidTarget, Limits, Progress, RefineError, Refiner};
use crate::surface::{ErrorQueue, SurfaceNodes, SurfaceRule, SurfaceSampling};

/// Refines a mesh that satisfies h̄ until it is close enough to surfaces, in slices.
///
/// ```text
///  find the samples ──▶ refine ──▶ done
///                         │ ▲
///  a layer asks for       ▼ │   refines once more, by the least error
///  a number of triangles: find it
/// ```
#[derive(Clone, Debug)]
pub(super) struct Approximation {
    limits: Limits,
    step: Step,
    capped: usize,
}

#[derive(Clone, Debug)]
enum Step {
    Sample(SurfaceSampling),
    Refine(Box<Refinement>),
    Count(SurfaceRule, Box<ErrorQueue>),
}

#[derive(Clone, Debug)]
struct Refinement {
    rule: SurfaceRule,
    refiner: Refiner,
    nodes: SurfaceNodes,
    /// Whether the least error of a number of triangles is found next.
    counts_next: bool,
}

impl Approximation {
    /// Returns the work for a mesh with these layers; `None` if no visible layer is a surface.
    pub(super) fn new(layers: &[Layer], built: &BuiltMesh, limits: Limits) -> Option<Self> {
        let sampling = SurfaceSampling::new(layers, built.mesh.lattice())?;
        Some(Self { limits, step: Step::Sample(sampling), capped: 0 })
    }

    /// Returns the number of triangles that the mesh has so far.
    pub(super) fn triangles(&self, built: &BuiltMesh) -> usize {
        match &self.step {
            Step::Count(_, queue) => queue.triangles(),
            Step::Sample(_) | Step::Refine(_) => built.mesh.raw_triangle_count(),
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
            Step::Sample(sampling) => {
                match sampling.advance(&built.domain, paint.unwrap_or(PaintLayers::blank()), budget) {
                    Progress::More => None,
                    Progress::Done => {
                        let rule = SurfaceRule::new(Arc::new(sampling.take_found()));
                        let counts_next = rule.most_triangles().is_some();
                        Some(self.refine(rule, counts_next, built))
                    }
                }
            }
            Step::Refine(work) => {
                if work.advance(built, paint, budget)? == Progress::More {
                    return Ok(Progress::More);
                }
                self.capped += work.refiner.capped();
                match work.rule.most_triangles().filter(|_| work.counts_next) {
                    None => {
                        built.surface = Some(Arc::new(work.rule.clone()));
                        return Ok(Progress::Done);
                    }
                    Some(most) => {
                        let queue = ErrorQueue::new(built.mesh.clone(), most, &self.limits);
                        Some(Step::Count(work.rule.clone(), Box::new(queue)))
                    }
                }
            }
            Step::Count(rule, queue) => {
                let mut criterion = built.criterion(paint);
                let vertex = built.rule == RefinementRule::Vertex;
                let is_bound = |element: &Element| Ok(vertex && criterion.exceeds(element)?);
                let progress = queue.advance(rule, &built.domain, is_bound, budget);
                match progress.map_err(RefineError::Rule)? {
                    Progress::More => None,
                    Progress::Done => {
                        let least = queue.least_error().unwrap_or(f64::INFINITY);
                        let rule = rule.clone().counted(least);
                        Some(self.refine(rule, false, built))
                    }
                }
            }
        };
        if let Some(next) = next {
            self.step = next;
        }
        Ok(Progress::More)
    }

    fn refine(&self, rule: SurfaceRule, counts_next: bool, built: &BuiltMesh) -> Step {
        let refiner = Refiner::new(&built.mesh, self.limits);
        Step::Refine(Box::new(Refinement { rule, refiner, nodes: SurfaceNodes::default(), counts_next }))
    }
}

impl Refinement {
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
