use glam::DVec2;

use super::engine::least;
use super::{DiameterLimit, LayerId, PaintLayers, SizeField};
use crate::geometry::LatticePoint;

/// The least h̄ in a closed triangle, and what decides it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastTarget {
    /// The target diameter in world units.
    pub target: f64,
    /// A point of the triangle that has it, in world units.
    pub at: DVec2,
    /// The nearest place whose diameter makes it so, in world units: the same point, or one from which
    /// gradation carries it.
    pub from: DVec2,
    /// The layer that decides there; `None` where no layer asks for anything.
    pub layer: Option<LayerId>,
    /// The limit that counts there in place of what the layer asks for, if one does.
    pub limit: Option<DiameterLimit>,
}

impl SizeField {
    /// Returns the least h̄ in the closed triangle with these corners: what the area rule compares with ℓ_b.
    pub fn least_within(&self, paint: &PaintLayers, corners: [LatticePoint; 3]) -> LeastTarget {
        let least::Least { target, at, from } = least::least_within(&self.stack, paint, corners);
        // A point on the rim of a pixel may belong to its neighbour.
        let step = self.lattice().step();
        let nudged = [DVec2::ZERO, step, -step, step * DVec2::new(1.0, -1.0), step * DVec2::new(-1.0, 1.0)];
        let decided = nudged.map(|by| self.stack.ungraded_at(paint, from + 0.5 * by));
        let decided = decided.into_iter().min_by(|a, b| a.target.total_cmp(&b.target));
        let (layer, limit) = decided.map_or((None, None), |decided| (decided.layer, decided.limit));
        LeastTarget { target, at, from, layer, limit }
    }
}
