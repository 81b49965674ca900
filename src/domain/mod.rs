//! Ω, the domain: a rectangle, or the part of it where a formula holds.

use glam::DVec2;

use crate::field::Formula;
use crate::geometry::Rect;

/// A domain in world units. A coarse triangle belongs to the mesh when its three nodes lie inside (Appendix A).
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// The rectangle that the coarse grid covers.
    pub bounds: Rect,
    /// Where it is not zero lies the domain; `None` for the whole rectangle.
    pub inside: Option<Formula>,
}

impl Domain {
    /// The whole of a rectangle.
    pub fn rectangle(bounds: Rect) -> Self {
        Self { bounds, inside: None }
    }

    /// Whether a point in world units lies in the domain: the report's `DomainQ`. A formula that gives NaN excludes it.
    pub fn contains(&self, point: DVec2) -> bool {
        let by_formula = self.inside.as_ref().is_none_or(|formula| {
            let value = formula.eval(point.x, point.y);
            value != 0.0 && !value.is_nan()
        });
        by_formula && self.bounds.contains(point)
    }
}
