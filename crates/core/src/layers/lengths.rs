//! Triangles that are not those of a mesh of bisected triangles, compared with h̄.

use super::engine::least;
use super::{LevelCache, PaintLayers, SizeField};
use crate::geometry::LatticePoint;

/// Lengths are rounded by less than this share.
const ROUNDING: f64 = 1e-12;

impl SizeField {
    /// Returns whether h̄ is below a length in the plane at some point of a closed triangle with any corners.
    /// A length on the Earth is taken to be no shorter than it is, and no longer than in a triangle of a mesh
    /// around it. `squares` must have been used for this field and these pixels only.
    pub(crate) fn is_below(
        &self,
        squares: &mut LevelCache,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        length: f64,
    ) -> bool {
        squares.make_room();
        let length = length * self.edge_lengths().of_unit_in(corners);
        // Nothing coarser matters to a mesh, and edits change nothing beyond.
        if length > self.longest() * (1.0 + ROUNDING) {
            return true;
        }
        match self.bounds_around(squares, paint, corners) {
            Some([least, _]) if length <= least => return false,
            Some([_, greatest]) if length > greatest * (1.0 + ROUNDING) => return true,
            _ => {}
        }
        least::any_below(&self.stack, paint, &mut squares.known, corners, length)
    }
}
