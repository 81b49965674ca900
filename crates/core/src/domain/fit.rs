//! How a mesh meets the boundary of its domain.

use std::convert::Infallible;
use std::sync::Arc;

use glam::DVec2;

use super::region_builder::RegionOnLatticeBuilder;
use super::zero_line::{ZeroLine, ZeroLineTracer};
use super::{Domain, DomainShape, FormulaShape, Line, LinesOnLattice, RegionOnLattice};
use crate::earth::EdgeLengths;
use crate::field::Formula;
use crate::geometry::{Lattice, LatticePoint, Rect};
use crate::mesh::{Element, LevelsWithin, Progress, bisection_edge_length};

/// How the mesh meets the boundary of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoundaryTreatment {
    /// Appendix A: a coarse triangle belongs to the mesh when its three nodes lie inside.
    Report,
    /// The mesh is refined towards the boundary; then a triangle belongs to it when its centroid lies inside.
    Fitted {
        /// Largest diameter of a triangle that the boundary passes through, in world units.
        diameter: f64,
    },
    /// The mesh is refined as for [`Self::Fitted`]. What is exported along the boundary is derived from it,
    /// with nodes on the polygons and edges that are not longer than their targets.
    OnOutline {
        /// Largest diameter of a triangle of the mesh that the boundary passes through, in world units.
        diameter: f64,
    },
}

impl BoundaryTreatment {
    /// Returns this treatment with another diameter, in world units; unchanged if it has none.
    pub fn with_diameter(self, diameter: f64) -> Self {
        match self {
            Self::Report => Self::Report,
            Self::Fitted { .. } => Self::Fitted { diameter },
            Self::OnOutline { .. } => Self::OnOutline { diameter },
        }
    }

    /// Returns the largest diameter of a triangle that the boundary passes through, in world units; `None`
    /// where the mesh is not refined along it.
    pub fn diameter(&self) -> Option<f64> {
        match *self {
            Self::Report => None,
            Self::Fitted { diameter } | Self::OnOutline { diameter } => Some(diameter),
        }
    }

    /// Returns the default treatment: nodes on the outline, and a diameter that is quick to mesh and shows
    /// the shape.
    pub fn default_for(spacing: f64) -> Self {
        Self::OnOutline { diameter: Self::default_diameter(spacing) }
    }

    /// Returns the diameter of level 7: an eighth of the spacing δ̄. Both are in world units.
    pub fn default_diameter(spacing: f64) -> f64 {
        bisection_edge_length(spacing, 7)
    }
}

/// Indexes a domain on a lattice, in slices.
#[derive(Clone, Debug)]
pub struct DomainOnLatticeBuilder {
    /// All but the region.
    indexed: DomainOnLattice,
    boundary: BoundaryTreatment,
    outline: OutlineIndexing,
}

/// The work that the outline of a domain needs.
#[derive(Clone, Debug)]
enum OutlineIndexing {
    /// There is none, or none that is followed.
    Nothing,
    /// The zero line of a formula in a rectangle is followed first.
    Tracing(FormulaShape, Rect, Box<ZeroLineTracer>),
    Indexing(Box<RegionOnLatticeBuilder>),
}

impl OutlineIndexing {
    fn new(domain: &Domain, boundary: BoundaryTreatment, lattice: &Lattice) -> Self {
        match &domain.shape {
            DomainShape::Whole => Self::Nothing,
            DomainShape::Formula(_) if boundary == BoundaryTreatment::Report => Self::Nothing,
            DomainShape::Formula(shape) => match shape.known_outline(&domain.bounds) {
                Some(outline) => Self::indexing(outline, lattice),
                None => {
                    let tracer = ZeroLineTracer::new(shape.formula().clone(), domain.bounds);
                    Self::Tracing(shape.clone(), domain.bounds, Box::new(tracer))
                }
            },
            DomainShape::Region(region) => Self::indexing(Ok(region.clone()), lattice),
        }
    }

    fn indexing(outline: ZeroLine, lattice: &Lattice) -> Self {
        outline.map_or(Self::Nothing, |region| {
            Self::Indexing(Box::new(RegionOnLatticeBuilder::new(&region, lattice)))
        })
    }

    /// One slice of work: about `budget` edges of the outline.
    fn advance(&mut self, budget: usize, lattice: &Lattice) -> Progress {
        match self {
            Self::Nothing => Progress::Done,
            Self::Tracing(shape, bounds, tracer) => {
                if tracer.advance() == Progress::Done {
                    let outline = shape.keep_outline(*bounds, tracer.clone().finish());
                    *self = Self::indexing(outline, lattice);
                }
                Progress::More
            }
            Self::Indexing(region) => region.advance(budget),
        }
    }
}

impl DomainOnLatticeBuilder {
    /// Returns the work for a domain on a lattice that covers its bounds.
    pub fn new(domain: &Domain, boundary: BoundaryTreatment, lattice: &Lattice) -> Self {
        Self::with_lengths(domain, boundary, lattice, EdgeLengths::new(domain.projection.as_ref(), lattice))
    }

    /// Returns the work of [`Self::new`]; the lengths are those of the lattice in the plane of the domain.
    pub(crate) fn with_lengths(
        domain: &Domain,
        boundary: BoundaryTreatment,
        lattice: &Lattice,
        edge_lengths: EdgeLengths,
    ) -> Self {
        let formula = domain.formula().cloned();
        let indexed = DomainOnLattice {
            bounds: domain.bounds,
            lattice: *lattice,
            formula,
            region: None,
            fitted: None,
            edge_lengths,
            on_outline: false,
            lines: None,
        };
        Self { indexed, boundary, outline: OutlineIndexing::new(domain, boundary, lattice) }
    }

    /// One slice of work: about `budget` edges of the outline.
    pub fn advance(&mut self, budget: usize) -> Progress {
        self.outline.advance(budget, &self.indexed.lattice)
    }

    /// Returns the domain. Work that is left is done in one go.
    pub fn finish(mut self) -> DomainOnLattice {
        while self.advance(usize::MAX) == Progress::More {}
        let region = match self.outline {
            OutlineIndexing::Indexing(region) => Some(Arc::new(region.finish())),
            OutlineIndexing::Nothing | OutlineIndexing::Tracing(..) => None,
        };
        DomainOnLattice { region, ..self.indexed }.with_boundary(self.boundary)
    }
}

/// A domain on the lattice of a mesh, for the coarse grid, the refinement criterion and
/// [`Mesh::classify`](crate::mesh::Mesh::classify).
#[derive(Clone, Debug)]
pub struct DomainOnLattice {
    bounds: Rect,
    lattice: Lattice,
    formula: Option<Formula>,
    /// Shared, so that a copy costs nothing.
    region: Option<Arc<RegionOnLattice>>,
    /// The largest diameter of triangles on the boundary, where the mesh is fitted to it.
    fitted: Option<f64>,
    edge_lengths: EdgeLengths,
    /// Whether nodes along the boundary are moved onto it.
    on_outline: bool,
    /// Lines along which a derived mesh has edges; `None` without any.
    lines: Option<Arc<LinesOnLattice>>,
}

impl DomainOnLattice {
    /// Indexes a domain on a lattice that covers its bounds, in one step. A formula whose zero line cannot be
    /// followed is treated as in the report.
    pub fn new(domain: &Domain, boundary: BoundaryTreatment, lattice: &Lattice) -> Self {
        DomainOnLatticeBuilder::new(domain, boundary, lattice).finish()
    }

    /// Returns whether [`Self::with_boundary`] gives what [`Self::new`] does: the zero line of a formula is
    /// not known where no treatment has asked for it.
    pub fn serves(&self, boundary: BoundaryTreatment) -> bool {
        boundary == BoundaryTreatment::Report || self.formula.is_none() || self.region.is_some()
    }

    /// Returns this domain on this lattice, with another treatment of its boundary. Of a formula, that must
    /// be one that it [`serves`](Self::serves).
    pub fn with_boundary(&self, boundary: BoundaryTreatment) -> Self {
        let fitted = boundary.diameter().filter(|_| self.region.is_some());
        let on_outline = fitted.is_some() && matches!(boundary, BoundaryTreatment::OnOutline { .. });
        Self { fitted, on_outline, ..self.clone() }
    }

    /// Returns this domain with lines in place of former ones. A mesh is not refined for them; what is
    /// derived from it has edges along them ([`DerivedMesh`](crate::outline::DerivedMesh)).
    #[must_use]
    pub fn with_lines(self, lines: &[Line]) -> Self {
        let lines = (!lines.is_empty()).then(|| Arc::new(LinesOnLattice::of(lines, &self.lattice)));
        Self { lines, ..self }
    }

    /// Returns the lines along which a derived mesh has edges.
    pub fn lines(&self) -> Option<&LinesOnLattice> {
        self.lines.as_deref()
    }

    /// Returns the lattice that the domain is indexed on.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns whether no point of an element belongs to the domain itself, whatever the boundary treatment.
    /// Of the domain of a formula, this is known where interval arithmetic shows it.
    pub fn has_none_of(&self, element: &Element) -> bool {
        match (&self.region, &self.formula) {
            (Some(region), _) => region.lies_outside(element.corners, element.triangle.level()),
            (None, Some(formula)) => {
                let bounds = formula.bounds(&element.world_rectangle());
                bounds.least == 0.0 && bounds.greatest == 0.0
            }
            (None, None) => false,
        }
    }

    /// Returns whether the boundary of the domain itself may pass through an element.
    pub fn may_cut(&self, element: &Element) -> bool {
        match (&self.region, &self.formula) {
            (Some(region), _) => region.outline_crosses(element.corners, element.triangle.level()),
            (None, Some(formula)) => {
                let bounds = formula.bounds(&element.world_rectangle());
                !bounds.valid || (bounds.least <= 0.0 && bounds.greatest >= 0.0)
            }
            (None, None) => false,
        }
    }

    /// Returns the region, where nodes along its outline are moved onto it
    /// ([`BoundaryTreatment::OnOutline`]).
    pub fn region_on_outline(&self) -> Option<&RegionOnLattice> {
        self.region.as_deref().filter(|_| self.on_outline)
    }

    /// Returns whether the mesh is fitted to the boundary: refined along it, with the triangles outside
    /// marked.
    pub fn is_fitted(&self) -> bool {
        self.fitted.is_some()
    }

    /// Returns whether a node of the coarse grid, in world units, is in the domain: the report's `DomainQ`. A
    /// coarse triangle stays when its three nodes are. Where the mesh is fitted to the boundary every node
    /// counts as inside.
    pub fn admits(&self, node: DVec2) -> bool {
        if self.is_fitted() {
            return true;
        }
        self.contains(node)
    }

    /// Returns whether a point, in world units, is in the domain itself, whatever the boundary treatment.
    pub fn contains(&self, point: DVec2) -> bool {
        if let Some(formula) = &self.formula {
            let value = formula.eval(point.x, point.y);
            return value != 0.0 && !value.is_nan() && self.bounds.contains(point);
        }
        match &self.region {
            Some(region) => region.contains(self.lattice.nearest(point)),
            None => self.bounds.contains(point),
        }
    }

    /// Returns whether the domain is all of its bounds.
    pub fn is_whole(&self) -> bool {
        self.formula.is_none() && self.region.is_none()
    }

    /// Returns whether an element's diameter exceeds its target, given whether it exceeds h̄. A triangle
    /// outside the domain never exceeds it; a triangle that the boundary crosses exceeds it until it is as
    /// small as the boundary treatment requires.
    ///
    /// The result is monotone if `by_field` is: the parts of a triangle that is outside the domain, or that
    /// the boundary does not cross, have the same property.
    ///
    /// # Errors
    /// Fails with the errors of `by_field`.
    #[inline]
    pub fn exceeds<E>(
        &self,
        element: &Element,
        by_field: impl FnOnce(&Element) -> Result<bool, E>,
    ) -> Result<bool, E> {
        self.exceeds_at(element.corners, element.triangle.level(), || by_field(element))
    }

    /// Returns whether the centroid of an element is outside a fitted domain.
    #[inline]
    pub fn excludes(&self, element: &Element) -> bool {
        self.excludes_at(element.corners)
    }

    /// Does the work of [`Self::exceeds`] for a triangle given by its corners and level; it need not be in
    /// the mesh.
    ///
    /// # Errors
    /// Fails with the errors of `by_field`.
    #[inline]
    pub fn exceeds_at<E>(
        &self,
        corners: [LatticePoint; 3],
        level: u32,
        by_field: impl FnOnce() -> Result<bool, E>,
    ) -> Result<bool, E> {
        let (Some(fitted), Some(region)) = (self.fitted, &self.region) else { return by_field() };
        if self.edge_lengths.of(corners, level) > fitted && region.outline_crosses(corners, level) {
            return Ok(true);
        }
        Ok(by_field()? && !region.lies_outside(corners, level))
    }

    /// Does the work of [`Self::exceeds_at`] for all triangles within a triangle at once, as far as their
    /// answers are known.
    pub(crate) fn levels_within(
        &self,
        corners: [LatticePoint; 3],
        level: u32,
        by_field: impl FnOnce() -> LevelsWithin,
    ) -> LevelsWithin {
        let Some(region) = self.region.as_ref().filter(|_| self.is_fitted()) else { return by_field() };
        match region.side_of(corners, level) {
            Some(true) => by_field(),
            Some(false) => LevelsWithin::single(level, false),
            None => {
                let by_field = || Ok::<_, Infallible>(by_field().exceeds(level) == Some(true));
                let Ok(exceeds) = self.exceeds_at(corners, level, by_field);
                LevelsWithin::single(level, exceeds)
            }
        }
    }

    /// Does the work of [`Self::excludes`] for a triangle given by its corners.
    #[inline]
    pub fn excludes_at(&self, corners: [LatticePoint; 3]) -> bool {
        match &self.region {
            Some(region) if self.is_fitted() => !region.has_centroid_of(corners),
            _ => false,
        }
    }
}
