//! Layers that ask for nothing.

use super::engine::CompiledLayer;
use super::engine::cells::Cells;
use super::size_field::SizeField;
use super::{Layer, LayerId, PaintLayers};
use crate::field::Transfer;
use crate::geometry::{Lattice, LatticePoint, Octagon};

/// Most squares of the coarse grid that layers are asked about.
const MOST_SQUARES: u64 = 10_000;

impl SizeField {
    /// Returns the visible layers that change nothing: nowhere do they ask for less than the diameter of the
    /// coarse triangles, or than h_max. Floors, replacements, blank paint and layers that ask for no diameter
    /// by themselves are left out.
    pub fn idle_layers(&self, paint: &PaintLayers) -> Vec<LayerId> {
        let lattice = *self.lattice();
        let cells = lattice.cells().map(u64::from);
        if cells[0] * cells[1] > MOST_SQUARES {
            return Vec::new();
        }
        let center = lattice.nearest(lattice.bounds().center());
        let Transfer { h_max, .. } = self.spec().transfer;
        let place = lattice.world_from_lattice(center);
        let largest = h_max.min(self.longest());
        let level = self.level_of_diameter(largest, place).unwrap_or(0);
        let is_painted = |layer: &Layer| paint.get(layer.id).is_some() || layer.paints().is_none();
        let is_asked = |layer: &&Layer| layer.kind.asks_for_diameters() && is_painted(layer);
        let candidates: Vec<LayerId> =
            self.spec().layers.iter().filter(is_asked).map(|layer| layer.id).collect();
        let layers =
            self.stack.layers().iter().filter(|layer| layer.is_plain() && candidates.contains(&layer.id));
        // A diameter may say the limit itself, and what no mesh can meet is an error.
        let says_limit = |layer: &CompiledLayer| {
            let diameter = layer.diameter_at(paint, place);
            let is_diameter =
                self.spec().layers.iter().any(|one| one.id == layer.id && one.kind.says_diameters());
            diameter.is_nan() || diameter <= 0.0 || (is_diameter && diameter <= largest)
        };
        let is_idle = |layer: &&CompiledLayer| {
            !says_limit(layer)
                && !coarse_triangles(&lattice).any(|corners| {
                    let (triangle, limit) =
                        (Octagon::triangle(corners), self.edge_lengths().limit(corners, level));
                    let around = Cells::around(&triangle, lattice.extent());
                    limit.is_some_and(|limit| layer.any_below(paint, &triangle, around, limit, &lattice))
                })
        };
        layers.filter(is_idle).map(|layer| layer.id).collect()
    }
}

/// Returns triangles that cover the squares of the coarse grid.
fn coarse_triangles(lattice: &Lattice) -> impl Iterator<Item = [LatticePoint; 3]> {
    let ([columns, rows], side) = (lattice.cells(), 1 << lattice.halvings());
    let at = move |x: u32, y: u32| LatticePoint::new(x * side, y * side);
    let squares = (0..rows).flat_map(move |y| (0..columns).map(move |x| [x, y]));
    squares.flat_map(move |[x, y]| {
        let (low, high) = (at(x, y), at(x + 1, y + 1));
        [[low, at(x + 1, y), high], [low, high, at(x, y + 1)]]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Formula;
    use crate::geometry::Rect;
    use crate::layers::{FormulaLayer, LayerKind, Quantity, SizeFieldSpec};

    #[test]
    fn layers_of_errors_are_not_said_to_change_nothing() {
        let formula = Formula::parse("9 + x").unwrap();
        let errors = FormulaLayer { quantity: Quantity::Error, formula: formula.clone() };
        let spec = SizeFieldSpec {
            layers: Layer::stack([errors.into(), LayerKind::target(formula)]),
            transfer: Transfer::between(0.01, 1.0),
            unasked: 1.0,
            outline: None,
            gradation: None,
            projection: None,
        };
        let field = SizeField::new(spec, &Lattice::covering(Rect::UNIT, 0.25, 1000).unwrap());
        assert_eq!(field.idle_layers(PaintLayers::blank()), [LayerId(1)]);
    }
}
