use std::borrow::Borrow;
use std::convert::Infallible;

use glam::DVec2;

use crate::domain::DomainOnLattice;
use crate::field::{RefinementRule, VertexRule};
use crate::geometry::LatticePoint;
use crate::layers::{Decision, LeastTarget, LevelCache, LevelCachePool, PaintLayers, SizeField};
use crate::mesh::{Element, InvalidTarget, LevelsWithin, RuleAnswers, SharedRule};
use crate::surface::{SurfaceDemand, SurfaceNodes, SurfaceRule};

/// The local refinement condition (Eq. 13 of \[Report\]) of a whole mesh: h̄ by a refinement rule, combined
/// with the condition of the boundary of the domain.
///
/// Builder, updates, prices and checks all use this type, so they agree.
#[derive(Clone)]
pub struct RefinementCriterion<'a> {
    domain: &'a DomainOnLattice,
    field: &'a SizeField,
    rule: RefinementRule,
    paint: &'a PaintLayers,
    /// How close the mesh is to be to surfaces, with the heights at nodes.
    surface: Option<(&'a SurfaceRule, SurfaceNodes)>,
    vertex_rule: VertexRule,
    /// The field's answers by the area rule so far.
    squares: Option<LevelCache>,
}

impl<'a> RefinementCriterion<'a> {
    /// Creates the criterion of a field over a domain. Without `paint`, the paint layers are blank.
    pub fn new(
        domain: &'a DomainOnLattice,
        field: &'a SizeField,
        rule: RefinementRule,
        paint: Option<&'a PaintLayers>,
    ) -> Self {
        let paint = paint.unwrap_or(PaintLayers::blank());
        let vertex_rule = VertexRule::default();
        Self { domain, field, rule, paint, surface: None, vertex_rule, squares: None }
    }

    /// Returns this criterion for a mesh that is to be close to surfaces as well.
    pub fn with_surface(self, surface: Option<&'a SurfaceRule>) -> Self {
        Self { surface: surface.map(|rule| (rule, SurfaceNodes::default())), ..self }
    }

    /// Creates the criterion of a field over a domain by the area rule, with the pixels of `paint`.
    pub fn by_area(domain: &'a DomainOnLattice, field: &'a SizeField, paint: &'a PaintLayers) -> Self {
        Self::new(domain, field, RefinementRule::Area, Some(paint))
    }

    /// Continues this criterion with the nodes that an earlier slice of the same work has evaluated
    /// ([`Self::into_vertex_rule`]).
    pub fn resumed(self, vertex_rule: VertexRule) -> Self {
        Self { vertex_rule, ..self }
    }

    /// Returns the nodes that the vertex rule has evaluated so far.
    pub fn into_vertex_rule(self) -> VertexRule {
        self.vertex_rule
    }

    /// Returns whether an element's diameter exceeds its target, or its error that of a surface.
    ///
    /// # Errors
    /// Fails by the vertex rule where h̄ is not a positive, finite length.
    #[inline]
    pub fn exceeds(&mut self, element: &Element) -> Result<bool, InvalidTarget> {
        let Self { domain, field, rule, paint, surface, vertex_rule, squares } = self;
        if surface.as_mut().is_some_and(|(rule, nodes)| rule.exceeds(element, nodes)) {
            return Ok(true);
        }
        domain.exceeds(element, |element| match rule {
            RefinementRule::Area => {
                let (corners, level) = (element.corners, element.triangle.level());
                let squares = squares.get_or_insert_default();
                Ok(field.asks_for_more_nearby(squares, paint, corners, level))
            }
            RefinementRule::Vertex => {
                let diameter = field.edge_lengths().of(element.corners, element.triangle.level());
                vertex_rule.diameter_exceeds(element, diameter, |point| field.target_at_node(paint, point))
            }
        })
    }

    /// Returns the area rule in a form that several threads can share.
    pub fn shared(&self) -> impl SharedRule<Error = Infallible> {
        let questions_per_thread = self.field.questions_per_thread();
        SharedArea { criterion: self, known: LevelCachePool::default(), questions_per_thread }
    }

    /// Returns the area rule as [`Self::shared`] does. `known` keeps what the threads find out: it must have
    /// been used for this field and these pixels only. `questions_per_thread` questions are worth a thread.
    pub(crate) fn shared_with<'b>(
        &'b self,
        known: &'b LevelCachePool,
        questions_per_thread: usize,
    ) -> impl SharedRule<Error = Infallible> {
        SharedArea { criterion: self, known, questions_per_thread }
    }

    /// Returns whether a triangle, by its corners and level, exceeds its target by the area rule.
    #[inline]
    pub fn exceeds_at(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        let by_field = || Ok::<_, InvalidTarget>(self.field.asks_for_more(self.paint, corners, level));
        self.domain.exceeds_at(corners, level, by_field).unwrap_or(false)
    }

    /// Returns whether a triangle, given by its corners and level, exceeds its target by the rule of the
    /// criterion.
    ///
    /// [`Self::exceeds_at`] is faster by the area rule; this function also knows the vertex rule and
    /// surfaces, and ignores impossible targets.
    pub fn asks_to_bisect(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        if self.surface_asks(corners) {
            return true;
        }
        if self.rule == RefinementRule::Area {
            return self.exceeds_at(corners, level);
        }
        let lattice = self.field.lattice();
        let length = self.diameter(corners, level);
        let by_vertices = || {
            let targets = corners
                .map(|corner| self.field.target_at_node(self.paint, lattice.world_from_lattice(corner)));
            Ok::<_, InvalidTarget>(targets.into_iter().any(|target| length > target))
        };
        self.domain.exceeds_at(corners, level, by_vertices).unwrap_or(false)
    }

    /// Returns h̄ at a point, in world units.
    pub fn target_at(&self, point: DVec2) -> f64 {
        self.field.target_at_node(self.paint, point)
    }

    /// Returns the diameter of a triangle, by its corners and level, that is compared with its target.
    pub fn diameter(&self, corners: [LatticePoint; 3], level: u32) -> f64 {
        self.field.edge_lengths().of(corners, level)
    }

    /// Returns whether a triangle, given by its corners, is bisected because of a surface.
    fn surface_asks(&self, corners: [LatticePoint; 3]) -> bool {
        self.surface.as_ref().is_some_and(|(rule, _)| rule.exceeds_at(corners, self.field.lattice()))
    }

    /// Returns why a triangle, given by its corners, is bisected because of a surface, if it is.
    pub fn surface_demand(&self, corners: [LatticePoint; 3]) -> Option<SurfaceDemand> {
        let (rule, _) = self.surface.as_ref()?;
        rule.demand_in(corners, self.field.lattice())
    }

    /// Returns whether a triangle, given by its corners and level, is bisected because of the outline of the
    /// domain, whatever h̄ is.
    pub fn outline_asks(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        let never = || Ok::<_, InvalidTarget>(false);
        self.domain.exceeds_at(corners, level, never).unwrap_or(false)
    }

    /// Returns the least h̄ that the rule sees in a triangle, and the source of this value.
    pub fn least_within(&self, corners: [LatticePoint; 3]) -> LeastTarget {
        if self.rule == RefinementRule::Area {
            return self.field.least_within(self.paint, corners);
        }
        let points = corners.map(|corner| self.field.lattice().world_from_lattice(corner));
        let decided = points.map(|at| {
            let decision = self.field.decision_at(self.paint, at);
            let Decision { target, layer, limit, from, asked: _ } = decision;
            LeastTarget { target, at, from, layer, limit }
        });
        let [first, ..] = decided;
        let less = |a: LeastTarget, b: LeastTarget| if b.target < a.target { b } else { a };
        decided.into_iter().fold(first, less)
    }
}

/// The area rule, for several threads.
struct SharedArea<'a, K> {
    criterion: &'a RefinementCriterion<'a>,
    known: K,
    questions_per_thread: usize,
}

impl<K: Borrow<LevelCachePool> + Sync> SharedRule for SharedArea<'_, K> {
    type Error = Infallible;

    fn answers(&self) -> impl RuleAnswers<Error = Infallible> {
        let (criterion, known) = (self.criterion, self.known.borrow());
        AreaAnswers { criterion, known, squares: Some(known.take()) }
    }

    fn questions_per_thread(&self) -> usize {
        self.questions_per_thread
    }
}

/// The answers of the area rule for one thread.
struct AreaAnswers<'a> {
    criterion: &'a RefinementCriterion<'a>,
    known: &'a LevelCachePool,
    /// Some until it is put back.
    squares: Option<LevelCache>,
}

impl Drop for AreaAnswers<'_> {
    fn drop(&mut self) {
        self.squares.take().into_iter().for_each(|squares| self.known.put_back(squares));
    }
}

impl RuleAnswers for AreaAnswers<'_> {
    type Error = Infallible;

    #[inline]
    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> Result<LevelsWithin, Infallible> {
        let Self { criterion: RefinementCriterion { domain, field, paint, .. }, squares, .. } = self;
        let squares = squares.as_mut().expect("it is not put back yet");
        let by_field = || field.levels_within(squares, paint, corners, level);
        Ok(domain.levels_within(corners, level, by_field))
    }

    #[inline]
    fn exceeds(&mut self, corners: [LatticePoint; 3], level: u32) -> Result<bool, Infallible> {
        let Self { criterion: RefinementCriterion { domain, field, paint, .. }, squares, .. } = self;
        let squares = squares.as_mut().expect("it is not put back yet");
        let by_field = || Ok(field.asks_for_more_nearby(squares, paint, corners, level));
        domain.exceeds_at(corners, level, by_field)
    }
}
