use glam::DVec2;

use super::checked_target;
use crate::mesh::{Element, InvalidTarget};

/// The report's own rule (Eqs. 12 and 13 of \[Report\]): a triangle's target is the minimum of h̄ over its
/// three vertices.
///
/// h̄ is evaluated once for each node and kept, as up to eight triangles at many levels share a node.
#[derive(Clone, Debug, Default)]
pub struct VertexRule {
    /// h̄ by node, NaN where it was not evaluated yet.
    target_of_node: Vec<f64>,
}

impl VertexRule {
    /// Returns whether the element's diameter exceeds its target. `target` is h̄ at a point, both in world
    /// units; it must be the same function in every call.
    ///
    /// # Errors
    /// Fails where h̄ is not a positive, finite length.
    #[inline]
    pub fn exceeds(
        &mut self,
        element: &Element,
        target: impl Fn(DVec2) -> f64,
    ) -> Result<bool, InvalidTarget> {
        self.diameter_exceeds(element, element.diameter(), target)
    }

    /// [`Self::exceeds`] of a diameter in another unit than world units, which is that of h̄.
    ///
    /// # Errors
    /// Fails as [`Self::exceeds`] does.
    #[inline]
    pub fn diameter_exceeds(
        &mut self,
        element: &Element,
        diameter: f64,
        target: impl Fn(DVec2) -> f64,
    ) -> Result<bool, InvalidTarget> {
        let mut smallest = f64::INFINITY;
        for (&node, &corner) in element.triangle.vertices.iter().zip(&element.corners) {
            let known = self.target_of_node.get(node.index()).copied().unwrap_or(f64::NAN);
            let target_of_node = if known.is_nan() {
                let point = element.lattice.world_from_lattice(corner);
                self.evaluate(node.index(), point, &target)?
            } else {
                known
            };
            smallest = smallest.min(target_of_node);
        }
        Ok(diameter > smallest)
    }

    /// Evaluates h̄ at a node for the first time. Not inlined: most nodes are known.
    #[inline(never)]
    fn evaluate(
        &mut self,
        node: usize,
        point: DVec2,
        target: impl Fn(DVec2) -> f64,
    ) -> Result<f64, InvalidTarget> {
        let value = checked_target(target(point), point)?;
        if node >= self.target_of_node.len() {
            self.target_of_node.resize(node + 1, f64::NAN);
        }
        self.target_of_node[node] = value;
        Ok(value)
    }
}
