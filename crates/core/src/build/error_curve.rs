//! The error of meshes against the number of their triangles.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::search::Search;
use super::{BuildError, BuiltMesh, MeshBuilder, MeshSpec, Parts};
use crate::layers::{PaintLayers, Surface, SurfaceGoal, SurfaceNorm};
use crate::mesh::{Element, Limits, Mesh, Progress, Refiner, TriangleId};
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
    step: Option<ErrorCurveStep>,
    /// The samples of the surfaces, where they are known from the start.
    samples: Option<Arc<SurfaceSamples>>,
}

#[derive(Clone, Debug)]
enum ErrorCurveStep {
    Build(Box<MeshBuilder>),
    Sample(Box<(BuiltMesh, SurfaceSampling)>),
    Order(Box<(BuiltMesh, Search)>),
    Levels(Box<Levels>),
    Done,
}

/// Uniform meshes, one level after the other.
#[derive(Clone, Debug)]
struct Levels {
    /// What other layers ask for.
    built: BuiltMesh,
    rule: SurfaceRule,
    norm: SurfaceNorm,
    limits: Limits,
    /// The mesh of a level, or on the way to the next one.
    mesh: Mesh,
    level: u32,
    refiner: Refiner,
    /// The errors in the triangles of a complete mesh, as far as they are known; `None` outside the domain.
    errors: Option<Vec<Option<f64>>>,
}

impl MeshSpec {
    /// Returns the norm of the topmost visible surface, if a layer is one.
    pub fn surface_norm(&self) -> Option<SurfaceNorm> {
        let mut visible = self.field.layers.iter().rev().filter(|layer| layer.visible);
        visible.find_map(|layer| layer.kind.get()).map(|surface: &Surface| surface.norm)
    }

    /// Returns this description without goals for surfaces of a norm: all that the curves of the norm depend
    /// on, besides paint.
    pub fn without_goals(mut self, norm: SurfaceNorm) -> Self {
        let surfaces = self.field.layers.iter_mut().filter_map(|layer| layer.kind.get_mut::<Surface>());
        for surface in surfaces.filter(|surface| surface.norm == norm) {
            surface.goal = SurfaceGoal::AtMost(usize::MAX);
        }
        self
    }
}

impl CurveTracing {
    /// Most triangles of a curve for a person who waits for it.
    pub const DEFAULT_MOST: usize = 1 << 20;

    /// Returns the work on the curves of a document by a norm, with meshes of about `most` triangles at most.
    /// `parts` must be those of the spec.
    pub fn new(spec: MeshSpec, mut parts: Parts, norm: SurfaceNorm, most: usize) -> Self {
        let spec = spec.without_goals(norm);
        let mut others = spec.clone();
        others.field.layers.retain(|layer| !layer.kind.is::<Surface>());
        let samples = parts.samples.take();
        let builder = MeshBuilder::from_parts(others, parts);
        let most = most.min(spec.limits.most_triangles());
        let curves = ErrorCurves { norm, ..ErrorCurves::default() };
        Self { spec, most, curves, step: Some(ErrorCurveStep::Build(Box::new(builder))), samples }
    }

    /// Returns the curves so far.
    pub fn curves(&self) -> &ErrorCurves {
        &self.curves
    }

    /// Returns the number of triangles of the largest mesh so far, and that of the largest there can be.
    pub fn progress(&self) -> [usize; 2] {
        let triangles = match &self.step {
            Some(ErrorCurveStep::Build(builder)) => builder.triangles(),
            Some(ErrorCurveStep::Order(work)) => work.1.queue.triangles(),
            _ => 0,
        };
        [triangles.min(self.most), self.most]
    }

    /// One slice of work: about `budget` samples or triangles.
    ///
    /// # Errors
    /// Fails when the spec has no mesh.
    ///
    /// # Panics
    /// Panics when it is called again after an error.
    pub fn advance(&mut self, paint: Option<&PaintLayers>, budget: usize) -> Result<Progress, BuildError> {
        let step = self.step.take().expect("work that failed cannot go on");
        let next = match step {
            ErrorCurveStep::Build(mut builder) => match builder.advance(paint, budget)? {
                Progress::More => ErrorCurveStep::Build(builder),
                Progress::Done => self.begin_sampling(builder.finish()),
            },
            ErrorCurveStep::Sample(mut work) => {
                match work.1.advance(&work.0.domain, paint.unwrap_or(PaintLayers::blank()), budget) {
                    Progress::More => ErrorCurveStep::Sample(work),
                    Progress::Done => self.begin_order(work.0, Arc::new(work.1.take_found())),
                }
            }
            ErrorCurveStep::Order(mut work) => match work.1.advance(&work.0, paint, budget)? {
                Progress::More => ErrorCurveStep::Order(work),
                Progress::Done => self.begin_levels(*work)?,
            },
            ErrorCurveStep::Levels(mut levels) => match levels.advance(budget)? {
                Some(point) => self.take_level(levels, point),
                None => ErrorCurveStep::Levels(levels),
            },
            ErrorCurveStep::Done => ErrorCurveStep::Done,
        };
        let progress = if matches!(next, ErrorCurveStep::Done) { Progress::Done } else { Progress::More };
        self.step = Some(next);
        Ok(progress)
    }

    fn begin_sampling(&mut self, built: BuiltMesh) -> ErrorCurveStep {
        if let Some(samples) = self.samples.take() {
            return self.begin_order(built, samples);
        }
        match SurfaceSampling::new(&self.spec.field.layers, built.mesh.lattice()) {
            Some(sampling) => ErrorCurveStep::Sample(Box::new((built, sampling))),
            None => ErrorCurveStep::Done,
        }
    }

    fn begin_order(&mut self, built: BuiltMesh, samples: Arc<SurfaceSamples>) -> ErrorCurveStep {
        let rule = SurfaceRule::new(samples, &self.spec.field.layers);
        let norm = self.curves.norm;
        self.curves.samples = rule.samples().count().known;
        self.curves.others = Some(point_of(&built.mesh, &built, &rule, norm));
        let goal = QueueGoal { norm, within: None, at_most: Some(self.most) };
        let search = Search::new(&built, rule, goal, &self.spec.limits);
        ErrorCurveStep::Order(Box::new((built, search)))
    }

    fn begin_levels(&mut self, (built, search): (BuiltMesh, Search)) -> Result<ErrorCurveStep, BuildError> {
        let Search { rule, queue } = search;
        self.curves.least = queue.curve().collect();
        let MeshSpec { lattice, limits, .. } = &self.spec;
        let mesh = Mesh::coarse_grid(lattice, |node| built.domain.admits(node), limits)?;
        let (norm, limits) = (self.curves.norm, *limits);
        let refiner = Refiner::new(&mesh, limits);
        let errors = Some(Vec::new());
        Ok(ErrorCurveStep::Levels(Box::new(Levels {
            built,
            rule,
            norm,
            limits,
            mesh,
            level: 0,
            refiner,
            errors,
        })))
    }

    /// Takes the point of a level. Returns the work on the next one, if there is one.
    fn take_level(&mut self, mut levels: Box<Levels>, point: CurvePoint) -> ErrorCurveStep {
        if levels.level == 0 {
            self.curves.others.take_if(|others| others.triangles <= point.triangles);
        }
        self.curves.uniform.push(point);
        let is_last = point.error == 0.0
            || 2 * point.triangles > self.most
            || levels.level == levels.mesh.lattice().deepest_level();
        if is_last {
            return ErrorCurveStep::Done;
        }
        levels.refiner = Refiner::new(&levels.mesh, levels.limits);
        levels.level += 1;
        ErrorCurveStep::Levels(levels)
    }
}

impl Levels {
    /// One slice of work: about `budget` triangles. Returns the point of a level once its mesh is measured.
    fn advance(&mut self, budget: usize) -> Result<Option<CurvePoint>, BuildError> {
        let Self { built, rule, norm, mesh, level, refiner, errors, .. } = self;
        let Some(known) = errors else {
            let is_coarse = |element: &Element| Ok(element.triangle.level() < *level);
            if refiner.advance(mesh, is_coarse, budget)? == Progress::Done {
                *errors = Some(Vec::new());
            }
            return Ok(None);
        };
        let next = known.len()..mesh.raw_triangle_count().min(known.len().saturating_add(budget));
        known.extend(errors_in(next, mesh, built, rule, *norm));
        if known.len() < mesh.raw_triangle_count() {
            return Ok(None);
        }
        let point = point_of_errors(known, rule, *norm);
        *errors = None;
        Ok(Some(point))
    }
}

/// Returns the number of triangles of a mesh in the domain, and its error.
fn point_of(mesh: &Mesh, built: &BuiltMesh, rule: &SurfaceRule, norm: SurfaceNorm) -> CurvePoint {
    point_of_errors(&errors_in(0..mesh.raw_triangle_count(), mesh, built, rule, norm), rule, norm)
}

/// Returns the errors in some triangles of a mesh, in their order; `None` outside the domain.
fn errors_in(
    triangles: Range<usize>,
    mesh: &Mesh,
    built: &BuiltMesh,
    rule: &SurfaceRule,
    norm: SurfaceNorm,
) -> Vec<Option<f64>> {
    let errors = triangles.into_par_iter().map(|index| {
        let element = mesh.element(TriangleId::from_index(index));
        let is_inside = !built.domain.excludes(&element);
        is_inside.then(|| rule.error_at(element.corners, mesh.lattice(), norm))
    });
    errors.collect()
}

/// Returns the number of triangles in the domain, and the error of all.
fn point_of_errors(errors: &[Option<f64>], rule: &SurfaceRule, norm: SurfaceNorm) -> CurvePoint {
    // In order, so that a sum does not depend on the number of threads.
    let errors = || errors.iter().flatten().copied();
    let error = match norm {
        SurfaceNorm::Largest => errors().fold(0.0, f64::max),
        SurfaceNorm::RootMeanSquare | SurfaceNorm::Gradient => {
            rule.samples().root_of_mean(errors().sum(), norm)
        }
    };
    CurvePoint { triangles: errors().count(), error }
}
