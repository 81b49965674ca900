//! The error of meshes against the number of their triangles.

use std::sync::Arc;

use rayon::prelude::*;

use super::search::Search;
use super::{BuildError, BuiltMesh, MeshBuilder, MeshSpec, Parts};
use crate::layers::{LayerKind, PaintLayers, SurfaceGoal, SurfaceNorm};
use crate::mesh::{Element, Mesh, Progress, Refiner, TriangleId};
use crate::surface::{CurvePoint, QueueGoal, SurfaceRule, SurfaceSamples, SurfaceSampling};

/// The error of meshes against the number of their triangles, by one norm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorCurves {
    /// Which error.
    pub norm: SurfaceNorm,
    /// Those of the least error, which also meet what other layers ask for, from the fewest triangles on.
    pub least: Vec<CurvePoint>,
    /// Those whose triangles all have one level, from the coarse grid on.
    pub uniform: Vec<CurvePoint>,
    /// The number of samples of the surface.
    pub samples: usize,
    /// That of everything but the surfaces, if it is finer than the coarse grid.
    pub others: Option<CurvePoint>,
}

/// Finds [`ErrorCurves`] in slices.
///
/// ```text
///  mesh of the other layers ──▶ samples ──▶ least errors ──▶ uniform meshes
/// ```
#[derive(Clone, Debug)]
pub struct CurveTracing {
    spec: MeshSpec,
    /// No curve has more triangles.
    most: usize,
    curves: ErrorCurves,
    /// `None` once an error has ended the work.
    step: Option<Step>,
    /// The samples of the surfaces, where they are known from the start.
    samples: Option<Arc<SurfaceSamples>>,
}

#[derive(Clone, Debug)]
enum Step {
    Build(Box<MeshBuilder>),
    Sample(Box<(BuiltMesh, SurfaceSampling)>),
    Order(Box<(BuiltMesh, Search)>),
    /// The uniform mesh of the next level.
    Level(Box<(BuiltMesh, SurfaceRule, Mesh, u32)>),
    Done,
}

impl MeshSpec {
    /// Returns the norm of the topmost visible surface, if a layer is one.
    pub fn surface_norm(&self) -> Option<SurfaceNorm> {
        let mut visible = self.field.layers.iter().rev().filter(|layer| layer.visible);
        visible.find_map(|layer| match &layer.kind {
            LayerKind::Surface(surface) => Some(surface.norm),
            _ => None,
        })
    }

    /// Returns this description without goals for surfaces of a norm: all that the curves of the norm depend
    /// on, besides paint.
    pub fn without_goals(mut self, norm: SurfaceNorm) -> Self {
        for layer in &mut self.field.layers {
            match &mut layer.kind {
                LayerKind::Surface(surface) if surface.norm == norm => {
                    surface.goal = SurfaceGoal::AtMost(usize::MAX);
                }
                _ => {}
            }
        }
        self
    }
}

impl CurveTracing {
    /// Most triangles of a curve for a person who waits for it.
    pub const USUAL_MOST: usize = 1 << 20;

    /// Returns the work on the curves of a document by a norm, with meshes of about `most` triangles at most.
    /// `parts` must be those of the spec.
    pub fn new(spec: MeshSpec, mut parts: Parts, norm: SurfaceNorm, most: usize) -> Self {
        let spec = spec.without_goals(norm);
        let mut others = spec.clone();
        others.field.layers.retain(|layer| !matches!(layer.kind, LayerKind::Surface(_)));
        let samples = parts.samples.take();
        let builder = MeshBuilder::from_parts(others, parts);
        let most = most.min(spec.limits.most_triangles());
        let curves = ErrorCurves { norm, ..ErrorCurves::default() };
        Self { spec, most, curves, step: Some(Step::Build(Box::new(builder))), samples }
    }

    /// Returns the curves so far.
    pub fn curves(&self) -> &ErrorCurves {
        &self.curves
    }

    /// Returns the number of triangles of the largest mesh so far, and that of the largest there can be.
    pub fn progress(&self) -> [usize; 2] {
        let triangles = match &self.step {
            Some(Step::Build(builder)) => builder.triangles(),
            Some(Step::Order(work)) => work.1.queue.triangles(),
            _ => 0,
        };
        [triangles.min(self.most), self.most]
    }

    /// One slice of work: about `budget` samples or triangles; the uniform mesh of a level is made at once.
    ///
    /// # Errors
    /// Fails when the spec has no mesh.
    ///
    /// # Panics
    /// Panics when it is called again after an error.
    pub fn advance(&mut self, paint: Option<&PaintLayers>, budget: usize) -> Result<Progress, BuildError> {
        let step = self.step.take().expect("work that failed cannot go on");
        let next = match step {
            Step::Build(mut builder) => match builder.advance(paint, budget)? {
                Progress::More => Step::Build(builder),
                Progress::Done => self.begin_sampling(builder.finish()),
            },
            Step::Sample(mut work) => {
                match work.1.advance(&work.0.domain, paint.unwrap_or(PaintLayers::blank()), budget) {
                    Progress::More => Step::Sample(work),
                    Progress::Done => self.begin_order(work.0, Arc::new(work.1.take_found())),
                }
            }
            Step::Order(mut work) => match work.1.advance(&work.0, paint, budget)? {
                Progress::More => Step::Order(work),
                Progress::Done => self.begin_levels(*work)?,
            },
            Step::Level(work) => self.next_level(*work)?,
            Step::Done => Step::Done,
        };
        let progress = if matches!(next, Step::Done) { Progress::Done } else { Progress::More };
        self.step = Some(next);
        Ok(progress)
    }

    fn begin_sampling(&mut self, built: BuiltMesh) -> Step {
        if let Some(samples) = self.samples.take() {
            return self.begin_order(built, samples);
        }
        match SurfaceSampling::new(&self.spec.field.layers, built.mesh.lattice()) {
            Some(sampling) => Step::Sample(Box::new((built, sampling))),
            None => Step::Done,
        }
    }

    fn begin_order(&mut self, built: BuiltMesh, samples: Arc<SurfaceSamples>) -> Step {
        let rule = SurfaceRule::new(samples, &self.spec.field.layers);
        let norm = self.curves.norm;
        self.curves.samples = rule.samples().count().known;
        self.curves.others = Some(point_of(&built.mesh, &built, &rule, norm));
        let goal = QueueGoal { norm, within: None, at_most: Some(self.most) };
        let search = Search::new(&built, rule, goal, &self.spec.limits);
        Step::Order(Box::new((built, search)))
    }

    fn begin_levels(&mut self, (built, search): (BuiltMesh, Search)) -> Result<Step, BuildError> {
        let Search { rule, queue } = search;
        self.curves.least = queue.curve().collect();
        let MeshSpec { lattice, limits, .. } = &self.spec;
        let coarse = Mesh::coarse_grid(lattice, |node| built.domain.admits(node), limits)?;
        Ok(Step::Level(Box::new((built, rule, coarse, 0))))
    }

    fn next_level(
        &mut self,
        (built, rule, mut mesh, level): (BuiltMesh, SurfaceRule, Mesh, u32),
    ) -> Result<Step, BuildError> {
        let point = point_of(&mesh, &built, &rule, self.curves.norm);
        if level == 0 {
            self.curves.others.take_if(|others| others.triangles <= point.triangles);
        }
        self.curves.uniform.push(point);
        let deepest = mesh.lattice().deepest_level();
        if point.error == 0.0 || 2 * point.triangles > self.most || level == deepest {
            return Ok(Step::Done);
        }
        let mut refiner = Refiner::new(&mesh, self.spec.limits);
        let is_coarse = |element: &Element| Ok(element.triangle.level() <= level);
        while refiner.advance(&mut mesh, is_coarse, usize::MAX)? == Progress::More {}
        Ok(Step::Level(Box::new((built, rule, mesh, level + 1))))
    }
}

/// Returns the number of triangles of a mesh in the domain, and its error.
fn point_of(mesh: &Mesh, built: &BuiltMesh, rule: &SurfaceRule, norm: SurfaceNorm) -> CurvePoint {
    let errors = (0..mesh.raw_triangle_count()).into_par_iter().map(|index| {
        let element = mesh.element(TriangleId::from_index(index));
        let is_inside = !built.domain.excludes(&element);
        is_inside.then(|| rule.error_at(element.corners, mesh.lattice(), norm))
    });
    // In order, so that a sum does not depend on the number of threads.
    let errors: Vec<Option<f64>> = errors.collect();
    let errors = || errors.iter().flatten().copied();
    let error = match norm {
        SurfaceNorm::Largest => errors().fold(0.0, f64::max),
        SurfaceNorm::RootMeanSquare | SurfaceNorm::Gradient => {
            rule.samples().root_of_mean(errors().sum(), norm)
        }
    };
    CurvePoint { triangles: errors().count(), error }
}
