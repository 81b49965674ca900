//! Whether the numbers of a layer are ones that it may have.

use glam::DVec2;

use crate::geometry::Lattice;

use super::cells::Cells;
use super::compiled::CompiledLayer;
use super::values::Values;

impl CompiledLayer {
    /// Returns whether its numbers come from a function, so that some may be invalid.
    pub fn can_be_invalid(&self) -> bool {
        self.analytic().is_some() || matches!(self.values, Values::Depth(_))
    }

    /// Returns whether the numbers in some cells are certainly valid.
    pub fn is_valid_in(&self, cells: &Cells, lattice: &Lattice) -> bool {
        match &self.values {
            Values::Constant(analytic) | Values::Analytic(analytic) => {
                analytic.is_valid_within(&cells.world_rect(lattice))
            }
            Values::Depth(formula) => formula.is_valid_in(cells, lattice),
            Values::Nothing | Values::Paint(_) | Values::Raster { .. } => true,
        }
    }

    /// Returns the number at a point in world units, and the rule for it, if it is not valid.
    pub fn invalid_number_at(&self, point: DVec2) -> Option<(f64, &'static str)> {
        let (value, analytic) = match &self.values {
            Values::Constant(analytic) | Values::Analytic(analytic) => (analytic.raw(point), analytic),
            Values::Depth(formula) => (formula.raw(point)?, formula.values()),
            Values::Nothing | Values::Paint(_) | Values::Raster { .. } => return None,
        };
        (!analytic.is_valid(value)).then(|| (value, analytic.rule()))
    }
}
