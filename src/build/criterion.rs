use crate::domain::DomainOnLattice;
use crate::field::{PaintRef, RefinementRule, TargetField, VertexRule};
use crate::geometry::LatticePoint;
use crate::mesh::{Element, InvalidTarget};
use crate::raster::MaxMipmap;

/// The local refinement condition (Eq. 13 of \[Report\]) of a whole mesh: h̄ by a refinement rule, joined
/// with what the boundary of the domain asks for.
///
/// Builder, updates, prices and checks ask this one type, so they agree.
#[derive(Clone)]
pub struct RefinementCriterion<'a> {
    domain: &'a DomainOnLattice,
    field: &'a TargetField,
    rule: RefinementRule,
    paint: Option<PaintRef<'a>>,
    vertex_rule: VertexRule,
}

impl<'a> RefinementCriterion<'a> {
    /// The criterion of a field over a domain. `paint` is for the vertex rule, which samples it at nodes; the
    /// area rule finds it in the field.
    pub fn new(
        domain: &'a DomainOnLattice,
        field: &'a TargetField,
        rule: RefinementRule,
        paint: Option<PaintRef<'a>>,
    ) -> Self {
        Self { domain, field, rule, paint, vertex_rule: VertexRule::default() }
    }

    /// As [`Self::new`] by the area rule, which needs no paint.
    pub fn by_area(domain: &'a DomainOnLattice, field: &'a TargetField) -> Self {
        Self::new(domain, field, RefinementRule::Area, None)
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
            RefinementRule::Area => Ok(field.exceeds(element)),
            RefinementRule::Vertex => {
                vertex_rule.exceeds(element, |point| field.target_at_node(*paint, point))
            }
        })
    }

    /// Whether a triangle, by its corners and level, would exceed its target by the area rule if the pixels
    /// asked for `levels`.
    #[inline]
    pub fn would_exceed(&self, levels: &MaxMipmap<u8>, corners: [LatticePoint; 3], level: u32) -> bool {
        let by_field = || Ok::<_, InvalidTarget>(self.field.would_exceed(levels, corners, level));
        self.domain.exceeds_at(corners, level, by_field).unwrap_or(false)
    }
}
