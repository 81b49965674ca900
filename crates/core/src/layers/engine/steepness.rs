//! How fast h̄ can change before gradation.

use glam::DVec2;

use crate::field::Bounds;
use crate::layers::{Combine, PaintLayers, SizeField};

use super::asked::Share;
use super::cells::Cells;

/// Bounds of slopes are rounded up. Where h is steeper than g by this share of g alone, gradation takes at
/// most this share of h̄ away: it carries values of at least 0 over distances up to h̄ / g.
const MARGIN: f64 = 1e-9;

/// Whether h̄ before gradation may change by more than the gradation per unit of length in some cells, or
/// jumps there or at their border. Without gradation it never does.
///
/// A layer whose values are above those of another one all over does not count where the finest counts.
pub fn is_steep(field: &SizeField, paint: &PaintLayers, cells: &Cells) -> bool {
    let Some(slope) = field.spec().gradation else { return false };
    // Values on both sides of the border count.
    let cells = &cells.with_neighbours(field.lattice().extent());
    let asked: Vec<_> = field
        .compiled()
        .iter()
        .map(|layer| (layer, layer.diameters(paint, cells, field.lattice()).0))
        .filter(|(_, diameters)| diameters.present != Share::None)
        .collect();
    let is_minimum = asked.iter().all(|(layer, _)| layer.combine == Combine::Finest);
    let h_max = field.spec().transfer.h_max;
    // Where nothing asks, h̄ is h_max: as if a layer asked for it.
    let mut decides = if field.spec().unasked >= h_max { h_max } else { f64::INFINITY };
    let is_background = decides < f64::INFINITY;
    for (_, diameters) in asked.iter().filter(|(_, diameters)| diameters.present == Share::All) {
        decides = decides.min(diameters.greatest);
    }
    asked.iter().any(|(layer, diameters)| {
        if is_minimum && diameters.least >= decides {
            return false;
        }
        let fades = is_minimum && is_background && layer.fades_to(h_max, cells, field.lattice());
        if diameters.present != Share::All && !fades {
            return true;
        }
        let steepness = layer.steepness(cells, diameters, field.lattice());
        steepness > slope * (1.0 + MARGIN) || steepness.is_nan()
    })
}

/// The largest slope in any direction, from bounds of the derivatives along x and y.
pub fn steepest([x, y]: [Bounds; 2]) -> f64 {
    let most = |slope: Bounds| slope.least.abs().max(slope.greatest.abs());
    DVec2::new(most(x), most(y)).length()
}
