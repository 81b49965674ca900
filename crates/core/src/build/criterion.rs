use crate::domain::DomainOnLattice;
use crate::field::{RefinementRule, VertexRule};
use crate::geometry::LatticePoint;
use crate::layers::{LeastTarget, PaintLayers, SettledSquares, SizeField};
use crate::mesh::{Element, InvalidTarget, LevelsWithin, RuleAnswers, SharedRule, bisection_edge_length};

/// The local refinement condition (Eq. 13 of \[Report\]) of a whole mesh: h̄ by a refinement rule, joined
/// with what the boundary of the domain asks for.
///
/// Builder, updates, prices and checks ask this one type, so they agree.
#[derive(Clone)]
pub struct RefinementCriterion<'a> {
    domain: &'a DomainOnLattice,
    field: &'a SizeField,
    rule: RefinementRule,
    paint: &'a PaintLayers,
    vertex_rule: VertexRule,
    /// What the field has answered by the area rule.
    squares: Option<SettledSquares>,
}

impl<'a> RefinementCriterion<'a> {
    /// The criterion of a field over a domain. Without `paint`, the paint layers are blank.
    pub fn new(
        domain: &'a DomainOnLattice,
        field: &'a SizeField,
        rule: RefinementRule,
        paint: Option<&'a PaintLayers>,
    ) -> Self {
        let paint = paint.unwrap_or(PaintLayers::blank());
        Self { domain, field, rule, paint, vertex_rule: VertexRule::default(), squares: None }
    }

    /// As [`Self::new`] by the area rule.
    pub fn by_area(domain: &'a DomainOnLattice, field: &'a SizeField, paint: &'a PaintLayers) -> Self {
        Self::new(domain, field, RefinementRule::Area, Some(paint))
    }

    /// The same criterion with the nodes that an earlier slice of the same work has evaluated
    /// ([`Self::into_vertex_rule`]).
    pub fn resumed(self, vertex_rule: VertexRule) -> Self {
        Self { vertex_rule, ..self }
    }

    /// What the vertex rule has evaluated so far.
    pub fn into_vertex_rule(self) -> VertexRule {
        self.vertex_rule
    }

    /// Whether an element's diameter exceeds its target.
    ///
    /// # Errors
    /// By the vertex rule, where h̄ is not a positive, finite length.
    #[inline]
    pub fn exceeds(&mut self, element: &Element) -> Result<bool, InvalidTarget> {
        let Self { domain, field, rule, paint, vertex_rule, squares } = self;
        domain.exceeds(element, |element| match rule {
            RefinementRule::Area => {
                let (corners, level) = (element.corners, element.triangle.level());
                let squares = squares.get_or_insert_default();
                Ok(field.asks_for_more_nearby(squares, paint, corners, level))
            }
            RefinementRule::Vertex => {
                vertex_rule.exceeds(element, |point| field.target_at_node(paint, point))
            }
        })
    }

    /// The area rule, for several threads.
    pub fn shared(&self) -> impl SharedRule {
        || AreaAnswers { criterion: self, squares: SettledSquares::default() }
    }

    /// Whether a triangle, by its corners and level, exceeds its target by the area rule.
    #[inline]
    pub fn exceeds_at(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        let by_field = || Ok::<_, InvalidTarget>(self.field.asks_for_more(self.paint, corners, level));
        self.domain.exceeds_at(corners, level, by_field).unwrap_or(false)
    }

    /// Whether a triangle, by its corners and level, exceeds its target by the rule of the criterion.
    ///
    /// [`Self::exceeds_at`] is faster by the area rule; this also knows the vertex rule, and counts
    /// impossible targets as none.
    pub fn asks_to_bisect(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        if self.rule == RefinementRule::Area {
            return self.exceeds_at(corners, level);
        }
        let lattice = self.field.lattice();
        let length = bisection_edge_length(lattice.spacing(), level);
        let by_vertices = || {
            let targets = corners
                .map(|corner| self.field.target_at_node(self.paint, lattice.world_from_lattice(corner)));
            Ok::<_, InvalidTarget>(targets.into_iter().any(|target| length > target))
        };
        self.domain.exceeds_at(corners, level, by_vertices).unwrap_or(false)
    }

    /// Whether a triangle, by its corners and level, is bisected for the outline of the domain, whatever h̄
    /// is.
    pub fn outline_asks(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        let never = || Ok::<_, InvalidTarget>(false);
        self.domain.exceeds_at(corners, level, never).unwrap_or(false)
    }

    /// The least h̄ that the rule sees in a triangle, and what decides it.
    pub fn least_within(&self, corners: [LatticePoint; 3]) -> LeastTarget {
        if self.rule == RefinementRule::Area {
            return self.field.least_within(self.paint, corners);
        }
        let points = corners.map(|corner| self.field.lattice().world_from_lattice(corner));
        let decided = points.map(|at| {
            let decision = self.field.decision_at(self.paint, at);
            LeastTarget { target: decision.target, at, from: decision.from, layer: decision.layer }
        });
        let [first, ..] = decided;
        let less = |a: LeastTarget, b: LeastTarget| if b.target < a.target { b } else { a };
        decided.into_iter().fold(first, less)
    }
}

/// Answers of the area rule for one thread.
struct AreaAnswers<'a> {
    criterion: &'a RefinementCriterion<'a>,
    squares: SettledSquares,
}

impl RuleAnswers for AreaAnswers<'_> {
    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> LevelsWithin {
        let RefinementCriterion { domain, field, paint, .. } = self.criterion;
        let by_field = || field.levels_within(&mut self.squares, paint, corners, level);
        domain.levels_within(corners, level, by_field)
    }
}
