use std::sync::Arc;

use super::approximation::Approximation;
use super::{MeshSpec, RefinementCriterion};
use crate::domain::{DomainOnLattice, DomainOnLatticeBuilder};
use crate::field::{RefinementRule, VertexRule};
use crate::geometry::{GridError, NumberSet};
use crate::layers::{InvalidLayer, LayerCheck, LevelCachePool, PaintLayers, SizeField};
use crate::mesh::{
    BlockRefiner, CoarseError, Element, InvalidTarget, Limits, Mesh, Progress, RefineError, Refiner,
    TriangleId,
};
use crate::outline::{EdgeTargets, PlaceKey, triangle_place};
use crate::surface::{SurfaceRule, SurfaceSamples};

/// Makes the mesh of a [`MeshSpec`] in slices.
///
/// ```text
///  index the outline ──▶ coarse grid ──▶ check the layers ──▶ refine ──▶ approximate ──▶ classify ──▶ done
///  (polygons only)                       (area rule)                  (surfaces only)  (fitted only)
/// ```
#[derive(Clone, Debug)]
pub struct MeshBuilder {
    spec: MeshSpec,
    /// The field, if the caller gave one.
    given_field: Option<Arc<SizeField>>,
    /// The samples of surfaces, if the caller gave them.
    given_samples: Option<Arc<SurfaceSamples>>,
    /// A mesh whose memory is reused.
    spare: Option<Mesh>,
    /// `None` once an error has ended the work.
    step: Option<BuildStep>,
    /// Triangles that the level cap left coarser than their target.
    capped: usize,
    /// See [`Self::scaled`].
    scale: f64,
}

/// The current step of the work, with everything that it needs.
#[derive(Clone, Debug)]
enum BuildStep {
    /// The outline is indexed on the lattice.
    Index(DomainOnLatticeBuilder),
    /// The coarse grid comes next.
    Grid(DomainOnLattice),
    /// The formulas of the layers are checked.
    Check {
        domain: DomainOnLattice,
        mesh: Mesh,
        field: Arc<SizeField>,
        check: LayerCheck,
    },
    Refine(Box<RuleRefinement>),
    /// The mesh is brought close to surfaces.
    Approximate(Box<(BuiltMesh, Approximation)>),
    /// Triangles outside a fitted domain are marked; those before `first` are done.
    Classify {
        built: BuiltMesh,
        first: usize,
    },
    Done(BuiltMesh),
}

#[derive(Clone, Debug)]
struct RuleRefinement {
    built: BuiltMesh,
    refiner: RefinerByRule,
}

#[derive(Clone, Debug)]
enum RefinerByRule {
    /// With what the rule has answered.
    Area(BlockRefiner, LevelCachePool),
    /// The vertex rule is not monotone, so that blocks would not fit together.
    Vertex(Refiner, VertexRule),
}

/// A mesh, with the domain, field and rule that it was made from.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BuiltMesh {
    /// The domain on the lattice of the mesh.
    pub domain: DomainOnLattice,
    /// h̄.
    pub field: Arc<SizeField>,
    /// The points of a triangle whose target diameters count.
    pub rule: RefinementRule,
    /// How close the mesh is to surfaces, if a layer is one.
    pub surface: Option<Arc<SurfaceRule>>,
    /// The mesh. Triangles outside a fitted domain are marked.
    pub mesh: Mesh,
}

impl BuiltMesh {
    /// Returns what the edges of the derived mesh are compared with, for the pixels that the mesh was made
    /// from; `None` by the vertex rule, which knows h̄ at the nodes of the mesh only.
    pub fn edge_targets<'a>(&'a self, paint: &'a PaintLayers) -> Option<EdgeTargets<'a>> {
        EdgeTargets::by_rule(self.rule, &self.field, paint)
    }
}

/// The parts that a builder may take over from an earlier mesh.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// The domain of the spec on the lattice of the spec, with any treatment of the boundary.
    pub domain: Option<DomainOnLattice>,
    /// The field of the spec on the lattice of the spec, whose layers are valid.
    pub field: Option<Arc<SizeField>>,
    /// The samples of the surfaces of the spec in its domain, on its lattice.
    pub samples: Option<Arc<SurfaceSamples>>,
    /// A mesh that is no longer needed. Reusing its memory saves about a third of the time.
    pub spare: Option<Mesh>,
}

/// The current stage of a builder's work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildStage {
    /// The outline of the domain is indexed on the lattice.
    Indexing,
    /// The formulas of the layers are checked.
    Checking,
    /// The mesh is refined; so far it has this many triangles.
    Refining {
        /// Triangles so far.
        triangles: usize,
    },
    /// Triangles outside the domain are marked.
    Classifying {
        /// Triangles of the mesh.
        triangles: usize,
    },
}

/// The reason why no mesh was made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// The coarse grid is impossible or empty.
    #[error(transparent)]
    Coarse(#[from] CoarseError),
    /// A layer has a value that is not a valid risk or target diameter.
    #[error(transparent)]
    InvalidLayer(#[from] InvalidLayer),
    /// At some point, h̄ is not a positive, finite length.
    #[error(transparent)]
    InvalidTarget(#[from] InvalidTarget),
    /// The refinement reached a limit.
    #[error(transparent)]
    Refine(#[from] RefineError),
}

impl From<GridError> for BuildError {
    fn from(error: GridError) -> Self {
        Self::Coarse(error.into())
    }
}

impl MeshBuilder {
    /// Creates a builder that makes the mesh of `spec` from scratch.
    pub fn new(spec: MeshSpec) -> Self {
        Self::from_parts(spec, Parts::default())
    }

    /// Creates a builder that takes over parts of an earlier mesh. The parts must be those of `spec`.
    pub fn from_parts(spec: MeshSpec, parts: Parts) -> Self {
        let Parts { domain, field: given_field, samples: given_samples, spare } = parts;
        let step = match domain {
            Some(domain) => BuildStep::Grid(domain.with_boundary(spec.boundary).with_lines(&spec.lines)),
            None => BuildStep::Index(DomainOnLatticeBuilder::new(&spec.domain, spec.boundary, &spec.lattice)),
        };
        Self { spec, given_field, given_samples, spare, step: Some(step), capped: 0, scale: 1.0 }
    }

    /// Returns the builder of a mesh whose targets are h̄ times a number ([`SizeField::scaled`]). A field
    /// that the caller gave is taken as it is.
    #[must_use]
    pub fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// Returns the description of the mesh.
    pub fn spec(&self) -> &MeshSpec {
        &self.spec
    }

    /// Returns the current stage.
    pub fn stage(&self) -> BuildStage {
        let triangles = self.triangles();
        match &self.step {
            None | Some(BuildStep::Index(_)) => BuildStage::Indexing,
            Some(BuildStep::Check { .. }) => BuildStage::Checking,
            Some(BuildStep::Grid(_) | BuildStep::Refine(_) | BuildStep::Approximate(_)) => {
                BuildStage::Refining { triangles }
            }
            Some(BuildStep::Classify { .. } | BuildStep::Done(_)) => BuildStage::Classifying { triangles },
        }
    }

    /// Returns the number of triangles that the mesh has so far.
    pub fn triangles(&self) -> usize {
        let mesh = match &self.step {
            None | Some(BuildStep::Index(_) | BuildStep::Grid(_)) => return 0,
            Some(BuildStep::Check { mesh, .. }) => mesh,
            Some(BuildStep::Refine(refinement)) => return refinement.triangles(),
            Some(BuildStep::Approximate(work)) => return work.1.triangles(&work.0),
            Some(BuildStep::Classify { built, .. } | BuildStep::Done(built)) => &built.mesh,
        };
        mesh.raw_triangle_count()
    }

    /// Returns the number of triangles that were not bisected although they exceed their target, because of
    /// [`Limits::max_level`](crate::mesh::Limits).
    pub fn capped(&self) -> usize {
        self.capped
    }

    /// Does one slice of work: about `budget` edges, pixels or triangles. The coarse grid is made in one
    /// call.
    ///
    /// `paint` has the pixels of the paint layers; without it they are blank. It may change between two
    /// calls: the mesh must then be updated where it changed.
    ///
    /// # Errors
    /// Fails when the spec has no mesh.
    ///
    /// # Panics
    /// Panics when it is called again after an error.
    pub fn advance(&mut self, paint: Option<&PaintLayers>, budget: usize) -> Result<Progress, BuildError> {
        let step = self.step.take().expect("work that failed cannot go on");
        let next = match step {
            BuildStep::Index(mut index) => match index.advance(budget) {
                Progress::More => BuildStep::Index(index),
                Progress::Done => BuildStep::Grid(index.finish().with_lines(&self.spec.lines)),
            },
            BuildStep::Grid(domain) => self.begin_field(domain)?,
            BuildStep::Check { domain, mesh, field, mut check } => match check.advance(&field, budget)? {
                Progress::More => BuildStep::Check { domain, mesh, field, check },
                Progress::Done => self.begin_refinement(domain, field, mesh),
            },
            BuildStep::Refine(mut refinement) => match refinement.advance(paint, budget)? {
                Progress::More => BuildStep::Refine(refinement),
                Progress::Done => {
                    self.capped = refinement.capped();
                    self.begin_approximation(refinement.built)
                }
            },
            BuildStep::Approximate(mut work) => match work.1.advance(&mut work.0, paint, budget)? {
                Progress::More => BuildStep::Approximate(work),
                Progress::Done => {
                    self.capped += work.1.capped();
                    self.begin_classification(work.0)
                }
            },
            BuildStep::Classify { built, first } => self.classify(built, first, budget),
            BuildStep::Done(built) => BuildStep::Done(built),
        };
        let progress = if matches!(next, BuildStep::Done(_)) { Progress::Done } else { Progress::More };
        self.step = Some(next);
        Ok(progress)
    }

    /// Returns the mesh.
    ///
    /// # Panics
    /// Panics when the work is not done.
    pub fn finish(self) -> BuiltMesh {
        match self.step {
            Some(BuildStep::Done(built)) => built,
            _ => panic!("the mesh is finished once `advance` returns `Progress::Done`"),
        }
    }

    fn begin_field(&mut self, domain: DomainOnLattice) -> Result<BuildStep, BuildError> {
        let MeshSpec { lattice, limits, .. } = &self.spec;
        let coarse = Mesh::coarse_grid(lattice, |node| domain.admits(node), limits)?;
        let mesh = match self.spare.take() {
            Some(mut spare) => {
                spare.clone_from(&coarse);
                spare
            }
            None => coarse,
        };
        if let Some(field) = self.given_field.take() {
            return Ok(self.begin_refinement(domain, field, mesh));
        }
        let field = SizeField::new(self.spec.field.clone(), lattice);
        let field = Arc::new(if self.scale == 1.0 { field } else { field.scaled(self.scale) });
        if self.spec.rule == RefinementRule::Vertex {
            // The rule checks h̄ at each node itself.
            return Ok(self.begin_refinement(domain, field, mesh));
        }
        let check = LayerCheck::new(&field);
        Ok(BuildStep::Check { domain, mesh, field, check })
    }

    fn begin_refinement(&self, domain: DomainOnLattice, field: Arc<SizeField>, mesh: Mesh) -> BuildStep {
        let MeshSpec { limits, rule, .. } = self.spec;
        let refiner = match rule {
            RefinementRule::Area => {
                RefinerByRule::Area(BlockRefiner::new(&mesh, limits), LevelCachePool::default())
            }
            RefinementRule::Vertex => {
                RefinerByRule::Vertex(Refiner::new(&mesh, limits), VertexRule::default())
            }
        };
        let built = BuiltMesh { domain, field, rule, surface: None, mesh };
        BuildStep::Refine(Box::new(RuleRefinement { built, refiner }))
    }
}

impl MeshBuilder {
    fn begin_approximation(&mut self, built: BuiltMesh) -> BuildStep {
        let samples = self.given_samples.take();
        match Approximation::new(&self.spec.field.layers, samples, &built, self.spec.limits) {
            Some(work) => BuildStep::Approximate(Box::new((built, work))),
            None => self.begin_classification(built),
        }
    }

    fn begin_classification(&self, built: BuiltMesh) -> BuildStep {
        if built.domain.is_fitted() {
            BuildStep::Classify { built, first: 0 }
        } else {
            BuildStep::Done(built)
        }
    }

    /// Marks about `budget` of the triangles outside a fitted domain, from `first` on.
    fn classify(&self, mut built: BuiltMesh, first: usize, budget: usize) -> BuildStep {
        let BuiltMesh { domain, mesh, .. } = &mut built;
        let all = mesh.raw_triangle_count();
        let end = first.saturating_add(budget).min(all);
        mesh.classify(first..end, |element| domain.excludes(element));
        if end == all { BuildStep::Done(built) } else { BuildStep::Classify { built, first: end } }
    }
}

impl RuleRefinement {
    fn advance(&mut self, paint: Option<&PaintLayers>, budget: usize) -> Result<Progress, RefineError> {
        let BuiltMesh { domain, field, rule, mesh, .. } = &mut self.built;
        let criterion = RefinementCriterion::new(domain, field, *rule, paint);
        match &mut self.refiner {
            RefinerByRule::Area(refiner, known) => refiner
                .advance(mesh, &criterion.shared_with(known, field.questions_per_thread()), budget)
                .map_err(|error| error.map_rule(|never| match never {})),
            RefinerByRule::Vertex(refiner, vertex_rule) => {
                let mut criterion = criterion.resumed(std::mem::take(vertex_rule));
                let progress = refiner.advance(mesh, |element| criterion.exceeds(element), budget);
                *vertex_rule = criterion.into_vertex_rule();
                progress
            }
        }
    }

    /// Returns the number of triangles that the mesh has or will have, as far as it is known.
    fn triangles(&self) -> usize {
        let so_far = self.built.mesh.raw_triangle_count();
        match &self.refiner {
            RefinerByRule::Area(refiner, _) => refiner.triangles().max(so_far),
            RefinerByRule::Vertex(..) => so_far,
        }
    }

    fn capped(&self) -> usize {
        match &self.refiner {
            RefinerByRule::Area(refiner, _) => refiner.capped(),
            RefinerByRule::Vertex(refiner, _) => refiner.capped(),
        }
    }
}

impl BuiltMesh {
    /// Returns the criterion that the mesh satisfies, for the paint that it was made with.
    pub fn criterion<'a>(&'a self, paint: Option<&'a PaintLayers>) -> RefinementCriterion<'a> {
        RefinementCriterion::new(&self.domain, &self.field, self.rule, paint)
            .with_surface(self.surface.as_deref())
    }

    /// Bisects triangles, and others only to keep the mesh conforming. The result does not depend on the
    /// order in which they are given.
    ///
    /// # Errors
    /// Fails when a limit is reached; the mesh is then refined in part.
    pub fn bisect(&mut self, marked: &[TriangleId], limits: &Limits) -> Result<(), RefineError> {
        let marked: NumberSet<PlaceKey> =
            marked.iter().map(|&id| triangle_place(self.mesh.corners(id))).collect();
        let exceeds = |element: &Element| marked.contains(&triangle_place(element.corners));
        self.mesh.refine(limits, exceeds).map_err(|error| error.map_rule(|never| match never {}))?;
        if self.domain.is_fitted() {
            let (domain, all) = (&self.domain, self.mesh.raw_triangle_count());
            self.mesh.classify(0..all, |element| domain.excludes(element));
        }
        Ok(())
    }

    /// Returns the triangles whose diameter exceeds their target, for the paint that the mesh was made with.
    ///
    /// # Errors
    /// Fails when a target is not a positive, finite length.
    pub fn unsatisfied(&self, paint: Option<&PaintLayers>) -> Result<Vec<TriangleId>, InvalidTarget> {
        let mut criterion = self.criterion(paint);
        self.mesh.unsatisfied(|element: &Element| criterion.exceeds(element))
    }
}
