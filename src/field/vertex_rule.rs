use glam::DVec2;

use super::checked_target;
use crate::mesh::{Element, InvalidTarget};

/// The report's own rule (Eqs. 12 and 13): a triangle's target is the minimum of h̄ over its three vertices.
///
/// h̄ is asked once for each node and remembered, as up to eight triangles at many levels share a node.
pub struct VertexRule<F> {
    target: F,
    known: Vec<f64>,
}

impl<F: FnMut(DVec2) -> f64> VertexRule<F> {
    /// The rule for a target diameter given by point; both in world units.
    pub fn new(target: F) -> Self {
        Self::resumed(target, Vec::new())
    }

    /// The rule with what an earlier slice of the same work came to know ([`Self::into_known`]).
    pub fn resumed(target: F, known: Vec<f64>) -> Self {
        Self { target, known }
    }

    /// Whether the element's diameter exceeds its target.
    ///
    /// # Errors
    /// Where h̄ is not a positive, finite length.
    pub fn exceeds(&mut self, element: &Element) -> Result<bool, InvalidTarget> {
        let mut smallest = f64::INFINITY;
        for (&node, &corner) in element.triangle.vertices.iter().zip(&element.corners) {
            smallest =
                smallest.min(self.target_at(node.index(), || element.lattice.world_from_lattice(corner))?);
        }
        Ok(element.diameter() > smallest)
    }

    fn target_at(&mut self, node: usize, world: impl FnOnce() -> DVec2) -> Result<f64, InvalidTarget> {
        if let Some(&value) = self.known.get(node)
            && !value.is_nan()
        {
            return Ok(value);
        }
        let point = world();
        let value = checked_target((self.target)(point), point)?;
        if node >= self.known.len() {
            self.known.resize(node + 1, f64::NAN);
        }
        self.known[node] = value;
        Ok(value)
    }

    /// What is known of h̄ by node, NaN where it was not asked.
    pub fn into_known(self) -> Vec<f64> {
        self.known
    }
}
