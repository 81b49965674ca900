use crate::domain::DomainOnLattice;
use crate::field::{RefinementRule, VertexRule};
use crate::geometry::LatticePoint;
use crate::layers::{PaintLayers, SizeField};
use crate::mesh::{Element, InvalidTarget};

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
        Self { domain, field, rule, paint, vertex_rule: VertexRule::default() }
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
        let Self { domain, field, rule, paint, vertex_rule } = self;
        domain.exceeds(element, |element| match rule {
            RefinementRule::Area => Ok(field.exceeds(paint, element)),
            RefinementRule::Vertex => {
                vertex_rule.exceeds(element, |point| field.target_at_node(paint, point))
            }
        })
    }

    /// Whether a triangle, by its corners and level, exceeds its target by the area rule.
    #[inline]
    pub fn exceeds_at(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        let by_field = || Ok::<_, InvalidTarget>(self.field.asks_for_more(self.paint, corners, level));
        self.domain.exceeds_at(corners, level, by_field).unwrap_or(false)
    }
}
