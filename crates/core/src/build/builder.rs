use std::sync::Arc;

use super::{MeshSpec, RefinementCriterion};
use crate::domain::{DomainOnLattice, DomainOnLatticeBuilder};
use crate::field::{RefinementRule, VertexRule};
use crate::geometry::GridError;
use crate::layers::{InvalidLayer, LayerCheck, PaintLayers, SizeField};
use crate::mesh::{
    BlockRefiner, CoarseError, Element, InvalidTarget, Mesh, Progress, RefineError, Refiner, TriangleId,
};

/// Makes the mesh of a [`MeshSpec`] in slices.
///
/// ```text
///  index the outline ──▶ coarse grid ──▶ check the layers ──▶ refine ──▶ classify ──▶ done
///  (polygons only)                       (area rule)                   (fitted only)
/// ```
#[derive(Clone, Debug)]
pub struct MeshBuilder {
    spec: MeshSpec,
    /// The field, where it was given.
    given_field: Option<Arc<SizeField>>,
    /// A mesh whose memory is used again.
    spare: Option<Mesh>,
    /// `None` once an error has ended the work.
    step: Option<Step>,
    /// Triangles that the level cap left coarser than their target.
    capped: usize,
}

/// What is being done, with all that it needs.
#[derive(Clone, Debug)]
enum Step {
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
    Refine(Box<Refinement>),
    /// Triangles outside a fitted domain are marked; those before `first` are done.
    Classify {
        built: BuiltMesh,
        first: usize,
    },
    Done(BuiltMesh),
}

#[derive(Clone, Debug)]
struct Refinement {
    built: BuiltMesh,
    refiner: RefinerByRule,
}

#[derive(Clone, Debug)]
enum RefinerByRule {
    Area(BlockRefiner),
    /// The vertex rule is not monotone, so that blocks would not fit together.
    Vertex(Refiner, VertexRule),
}

/// A mesh, and what decided it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BuiltMesh {
    /// The domain on the lattice of the mesh.
    pub domain: DomainOnLattice,
    /// h̄.
    pub field: Arc<SizeField>,
    /// Which points of a triangle count.
    pub rule: RefinementRule,
    /// The mesh. Triangles outside a fitted domain are marked.
    pub mesh: Mesh,
}

/// What a builder may take over from an earlier mesh.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// The domain of the spec on the lattice of the spec, with any treatment of the boundary.
    pub domain: Option<DomainOnLattice>,
    /// The field of the spec on the lattice of the spec, whose layers are valid.
    pub field: Option<Arc<SizeField>>,
    /// A mesh that is no longer needed. Its memory is used again, which saves about a third of the time.
    pub spare: Option<Mesh>,
}

/// What a builder is busy with.
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

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// The coarse grid is impossible, or empty.
    #[error(transparent)]
    Coarse(#[from] CoarseError),
    /// A layer has a value that no mesh can meet.
    #[error(transparent)]
    InvalidLayer(#[from] InvalidLayer),
    /// h̄ is no length somewhere.
    #[error(transparent)]
    InvalidTarget(#[from] InvalidTarget),
    /// The refinement met a limit.
    #[error(transparent)]
    Refine(#[from] RefineError),
}

impl From<GridError> for BuildError {
    fn from(error: GridError) -> Self {
        Self::Coarse(error.into())
    }
}

impl MeshBuilder {
    /// Work from scratch.
    pub fn new(spec: MeshSpec) -> Self {
        Self::from_parts(spec, Parts::default())
    }

    /// Work that takes over what an earlier mesh has already. The parts must be those of `spec`.
    pub fn from_parts(spec: MeshSpec, parts: Parts) -> Self {
        let Parts { domain, field: given_field, spare } = parts;
        let step = match domain {
            Some(domain) => Step::Grid(domain.with_boundary(spec.boundary)),
            None => Step::Index(DomainOnLatticeBuilder::new(&spec.domain, spec.boundary, &spec.lattice)),
        };
        Self { spec, given_field, spare, step: Some(step), capped: 0 }
    }

    /// What the mesh is made from.
    pub fn spec(&self) -> &MeshSpec {
        &self.spec
    }

    /// What is being done.
    pub fn stage(&self) -> BuildStage {
        let triangles = self.triangles();
        match &self.step {
            None | Some(Step::Index(_)) => BuildStage::Indexing,
            Some(Step::Check { .. }) => BuildStage::Checking,
            Some(Step::Grid(_) | Step::Refine(_)) => BuildStage::Refining { triangles },
            Some(Step::Classify { .. } | Step::Done(_)) => BuildStage::Classifying { triangles },
        }
    }

    /// How many triangles the mesh has so far.
    pub fn triangles(&self) -> usize {
        let mesh = match &self.step {
            None | Some(Step::Index(_) | Step::Grid(_)) => return 0,
            Some(Step::Check { mesh, .. }) => mesh,
            Some(Step::Refine(refinement)) => return refinement.triangles(),
            Some(Step::Classify { built, .. } | Step::Done(built)) => &built.mesh,
        };
        mesh.raw_triangle_count()
    }

    /// How many triangles asked for more than [`Limits::max_level`](crate::mesh::Limits) allows.
    pub fn capped(&self) -> usize {
        self.capped
    }

    /// One slice of work: about `budget` edges, pixels or triangles. The coarse grid is made in one go.
    ///
    /// `paint` has the pixels of the paint layers; without it they are blank. It may change between two
    /// calls: the mesh must then be updated where it changed.
    ///
    /// # Errors
    /// When the spec has no mesh.
    ///
    /// # Panics
    /// When it is called again after an error.
    pub fn advance(&mut self, paint: Option<&PaintLayers>, budget: usize) -> Result<Progress, BuildError> {
        let step = self.step.take().expect("work that failed cannot go on");
        let next = match step {
            Step::Index(mut index) => match index.advance(budget) {
                Progress::More => Step::Index(index),
                Progress::Done => Step::Grid(index.finish()),
            },
            Step::Grid(domain) => self.begin_field(domain)?,
            Step::Check { domain, mesh, field, mut check } => match check.advance(&field, budget)? {
                Progress::More => Step::Check { domain, mesh, field, check },
                Progress::Done => self.begin_refinement(domain, field, mesh),
            },
            Step::Refine(mut refinement) => match refinement.advance(paint, budget)? {
                Progress::More => Step::Refine(refinement),
                Progress::Done => {
                    self.capped = refinement.capped();
                    self.begin_classification(refinement.built)
                }
            },
            Step::Classify { built, first } => self.classify(built, first, budget),
            Step::Done(built) => Step::Done(built),
        };
        let progress = if matches!(next, Step::Done(_)) { Progress::Done } else { Progress::More };
        self.step = Some(next);
        Ok(progress)
    }

    /// The mesh.
    ///
    /// # Panics
    /// When the work is not done.
    pub fn finish(self) -> BuiltMesh {
        match self.step {
            Some(Step::Done(built)) => built,
            _ => panic!("the mesh is finished once `advance` returns `Progress::Done`"),
        }
    }

    fn begin_field(&mut self, domain: DomainOnLattice) -> Result<Step, BuildError> {
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
        let field = Arc::new(SizeField::new(self.spec.field.clone(), lattice));
        if self.spec.rule == RefinementRule::Vertex {
            // The rule checks h̄ at each node itself.
            return Ok(self.begin_refinement(domain, field, mesh));
        }
        let check = LayerCheck::new(&field);
        Ok(Step::Check { domain, mesh, field, check })
    }

    fn begin_refinement(&self, domain: DomainOnLattice, field: Arc<SizeField>, mesh: Mesh) -> Step {
        let MeshSpec { limits, rule, .. } = self.spec;
        let refiner = match rule {
            RefinementRule::Area => RefinerByRule::Area(BlockRefiner::new(&mesh, limits)),
            RefinementRule::Vertex => {
                RefinerByRule::Vertex(Refiner::new(&mesh, limits), VertexRule::default())
            }
        };
        let built = BuiltMesh { domain, field, rule, mesh };
        Step::Refine(Box::new(Refinement { built, refiner }))
    }
}

impl MeshBuilder {
    fn begin_classification(&self, built: BuiltMesh) -> Step {
        if built.domain.is_fitted() { Step::Classify { built, first: 0 } } else { Step::Done(built) }
    }

    /// Marks about `budget` of the triangles outside a fitted domain, from `first` on.
    fn classify(&self, mut built: BuiltMesh, first: usize, budget: usize) -> Step {
        let BuiltMesh { domain, mesh, .. } = &mut built;
        let all = mesh.raw_triangle_count();
        let end = first.saturating_add(budget).min(all);
        mesh.classify(first..end, |element| domain.excludes(element));
        if end == all { Step::Done(built) } else { Step::Classify { built, first: end } }
    }
}

impl Refinement {
    fn advance(&mut self, paint: Option<&PaintLayers>, budget: usize) -> Result<Progress, RefineError> {
        let BuiltMesh { domain, field, rule, mesh, .. } = &mut self.built;
        let criterion = RefinementCriterion::new(domain, field, *rule, paint);
        match &mut self.refiner {
            RefinerByRule::Area(refiner) => refiner.advance(mesh, &criterion.shared(), budget),
            RefinerByRule::Vertex(refiner, vertex_rule) => {
                let mut criterion = criterion.resumed(std::mem::take(vertex_rule));
                let progress = refiner.advance(mesh, |element| criterion.exceeds(element), budget);
                *vertex_rule = criterion.into_vertex_rule();
                progress
            }
        }
    }

    /// How many triangles the mesh has or will have, as far as that is known.
    fn triangles(&self) -> usize {
        let so_far = self.built.mesh.raw_triangle_count();
        match &self.refiner {
            RefinerByRule::Area(refiner) => refiner.triangles().max(so_far),
            RefinerByRule::Vertex(..) => so_far,
        }
    }

    fn capped(&self) -> usize {
        match &self.refiner {
            RefinerByRule::Area(refiner) => refiner.capped(),
            RefinerByRule::Vertex(refiner, _) => refiner.capped(),
        }
    }
}

impl BuiltMesh {
    /// The criterion that the mesh satisfies, for the paint that it was made with.
    pub fn criterion<'a>(&'a self, paint: Option<&'a PaintLayers>) -> RefinementCriterion<'a> {
        RefinementCriterion::new(&self.domain, &self.field, self.rule, paint)
    }

    /// The triangles whose diameter exceeds their target, for the paint that the mesh was made with.
    ///
    /// # Errors
    /// When a target is impossible.
    pub fn unsatisfied(&self, paint: Option<&PaintLayers>) -> Result<Vec<TriangleId>, InvalidTarget> {
        let mut criterion = self.criterion(paint);
        self.mesh.unsatisfied(|element: &Element| criterion.exceeds(element))
    }
}
