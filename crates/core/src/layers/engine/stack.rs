//! Visible layers on a lattice, asked as one.

use super::asked::Ternary;
use super::cells::{Cells, Cut};
use super::compiled::CompiledLayer;
use super::gradation;
use super::parts::{KnownParts, PartId};
use super::patch::TouchedCells;
use super::reading::{RangeAnswer, largest_below};
use super::search::any_cell;
use crate::earth::EdgeLengths;
use crate::geometry::{Lattice, LatticePoint, Octagon};
use crate::layers::{Combine, PaintLayers};

/// The visible layers of a field on a lattice, and the limits of h̄.
#[derive(Clone, Debug)]
pub struct Stack {
    lattice: Lattice,
    /// What targets are compared with.
    edge_lengths: EdgeLengths,
    /// From the bottom to the top.
    layers: Vec<CompiledLayer>,
    limits: StackLimits,
    /// Whether the finest of some pixels counts everywhere, and nothing else.
    has_pixels_only: bool,
}

/// The limits of h̄.
#[derive(Clone, Copy, Debug)]
pub struct StackLimits {
    /// The smallest h̄, in world units.
    pub h_min: f64,
    /// The largest h̄ that a layer asks for, in world units.
    pub h_max: f64,
    /// h̄ where no layer asks for a diameter, in world units.
    pub unasked: f64,
    /// The largest change of h̄ per unit of length in the plane; `None` for any change.
    pub slope: Option<f64>,
}

/// Facts that hold for all triangles in a square.
#[derive(Clone, Copy)]
pub struct Nearby<'a> {
    /// No point of a cell that touches one of them asks for less, in world units.
    pub least_asked: f64,
    /// The parts of the lattice from which gradation can carry to them.
    pub sources: &'a [PartId],
}

impl Stack {
    /// Returns layers, from the bottom to the top, on a lattice.
    pub fn new(
        mut layers: Vec<CompiledLayer>,
        limits: StackLimits,
        lattice: &Lattice,
        edge_lengths: EdgeLengths,
    ) -> Self {
        let has_pixels_only = has_pixels_only(&layers, &limits);
        let StackLimits { h_min, h_max, unasked, slope } = limits;
        if let (Some(slope), true) = (slope, layers.iter().all(CompiledLayer::is_plain)) {
            layers.iter_mut().for_each(|layer| layer.grade(slope, h_min, unasked.min(h_max), lattice));
        }
        Self { lattice: *lattice, edge_lengths, layers, limits, has_pixels_only }
    }

    /// Returns the stack of some of the layers, as they are here.
    pub fn with(&self, is_kept: impl Fn(usize, &CompiledLayer) -> bool) -> Self {
        let kept = self.layers.iter().enumerate().filter(|(number, layer)| is_kept(*number, layer));
        let layers: Vec<CompiledLayer> = kept.map(|(_, layer)| layer.clone()).collect();
        let has_pixels_only = has_pixels_only(&layers, &self.limits);
        Self { layers, has_pixels_only, edge_lengths: self.edge_lengths.clone(), ..*self }
    }

    /// Returns these layers without models of their functions: searches use bounds only.
    #[cfg(test)]
    pub fn without_models(self) -> Self {
        let layers = self.layers.into_iter().map(CompiledLayer::without_models).collect();
        Self { layers, ..self }
    }

    /// Returns the lattice.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns the diameters of triangles, which h̄ is compared with.
    pub fn edge_lengths(&self) -> &EdgeLengths {
        &self.edge_lengths
    }

    /// Returns the layers, from the bottom to the top.
    pub fn layers(&self) -> &[CompiledLayer] {
        &self.layers
    }

    /// Returns the limits of h̄.
    pub fn limits(&self) -> &StackLimits {
        &self.limits
    }

    /// Returns the largest change of h̄ per unit of length in the plane; `None` for any change.
    pub fn slope(&self) -> Option<f64> {
        self.limits.slope
    }

    /// Returns the binary logarithm of the side of the squares, in lattice steps, that searches divide at
    /// lines between pixels: those that are about as large as the largest pixels.
    pub fn pixel_bits(&self, paint: &PaintLayers) -> u32 {
        let bits = self.layers.iter().filter_map(|layer| layer.pixel_bits(paint, &self.lattice));
        bits.max().map_or(0, |bits| bits + 1)
    }

    /// Returns whether h̄ is below the diameter of a triangle with these corners and this level at some point
    /// of it. `known` must have been used for this stack and these pixels only; `nearby` is what is known of
    /// a square that holds the triangle.
    #[inline]
    pub fn asks_with(
        &self,
        known: &mut KnownParts,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
        nearby: Option<Nearby>,
    ) -> bool {
        let Some(limit) = self.edge_lengths.limit(corners, level) else { return false };
        if let Some(asks) = self.limits_decide(limit) {
            return asks;
        }
        let length = self.edge_lengths.table()[limit];
        let triangle = Octagon::triangle(corners);
        let around = Cells::around(&triangle, self.lattice.extent());
        match self.limits.slope {
            None => self.any_below(paint, &triangle, around, limit),
            Some(slope) => {
                let sources = nearby.map(|nearby| nearby.sources);
                let can_ask = nearby.is_none_or(|nearby| nearby.least_asked < length);
                // What is carried is rounded up as diameters are: distances are rounded, and rounding must
                // not decide where exactly ℓ is carried.
                let carried = f64::from(largest_below(length)).next_up();
                (can_ask && self.any_below(paint, &triangle, around, limit))
                    || gradation::any_below(self, paint, known, corners, (slope, carried), sources)
            }
        }
    }

    /// Returns whether the finest of some pixels counts everywhere, and nothing else: then those that touch a
    /// triangle answer for it and for all triangles within it.
    pub fn has_pixels_only(&self) -> bool {
        self.has_pixels_only
    }

    /// Returns the least and the greatest diameter that pixels which touch a triangle ask for, and whether
    /// the triangle exceeds its target. For a stack that [`Self::has_pixels_only`]; `None` where the pixels
    /// are too many, or not quick to read.
    pub fn asked_by_pixels(
        &self,
        paint: &PaintLayers,
        corners: [LatticePoint; 3],
        level: u32,
    ) -> Option<([f64; 2], bool)> {
        let limit = self.edge_lengths.limit(corners, level)?;
        let triangle = Octagon::triangle(corners);
        let around = Cells::around(&triangle, self.lattice.extent());
        let (mut asked, mut exceeds) = ([f64::INFINITY; 2], false);
        for layer in &self.layers {
            let (of_layer, asks) =
                layer.asked_by_pixels(paint, (&triangle, &around), limit, &self.lattice)?;
            asked = [asked[0].min(of_layer.least), asked[1].min(of_layer.greatest)];
            exceeds |= asks;
        }
        Some((asked, self.limits_decide(limit).unwrap_or(exceeds)))
    }

    /// Returns the answer for all triangles with a limit that no layer can change: no point asks for less
    /// than h_min or for more than h_max.
    #[inline]
    fn limits_decide(&self, limit: usize) -> Option<bool> {
        let length = self.edge_lengths.table()[limit];
        let StackLimits { h_min, h_max, .. } = self.limits;
        if length <= h_min {
            return Some(false);
        }
        (length > h_max).then_some(true)
    }

    /// Returns whether a cell that touches the triangle asks for less than a limit, before gradation.
    ///
    /// From the top down, a layer is tested alone as long as no floor and no replacement above it counts in
    /// the cells around the triangle: the search then divides them for this layer only. Those from the first
    /// floor or replacement that counts down to the bottom are tested together.
    fn any_below(&self, paint: &PaintLayers, triangle: &Octagon, around: Cells, limit: usize) -> bool {
        let mut count = self.layers.len();
        while let Some(layer) = count.checked_sub(1).map(|top| &self.layers[top]) {
            if layer.is_plain() {
                if layer.any_below(paint, triangle, around, limit, &self.lattice) {
                    return true;
                }
            } else if !layer.is_masked_out(&around, &self.lattice) {
                let mut ask =
                    |cells: &Cells| self.asks(count, paint, &TouchedCells::touching(*cells, triangle), limit);
                return any_cell(triangle, around, &mut ask);
            }
            count -= 1;
        }
        false
    }

    /// Returns the share of some cells in which the lowest `count` layers together ask for less than a limit,
    /// and the cut that divides them for a closer answer.
    fn asks(
        &self,
        count: usize,
        paint: &PaintLayers,
        patch: &TouchedCells,
        limit: usize,
    ) -> (Ternary, Option<Cut>) {
        let Some(below) = count.checked_sub(1) else { return (Ternary::Never, None) };
        let layer = &self.layers[below];
        let (RangeAnswer { asks, present }, cut) = layer.answer(paint, patch, limit, &self.lattice);
        let permits = present.not().or(asks);
        match layer.combine {
            Combine::Finest if asks == Ternary::Always => return (Ternary::Always, None),
            Combine::Floor if permits == Ternary::Never => return (Ternary::Never, None),
            Combine::Replace if present == Ternary::Always => return (asks, cut),
            _ => {}
        }
        let (rest, rest_cut) = self.asks(below, paint, patch, limit);
        let share = match layer.combine {
            Combine::Finest => rest.or(asks),
            Combine::Floor => rest.and(permits),
            Combine::Replace if present == Ternary::Never => rest,
            Combine::Replace if permits == Ternary::Always && rest == Ternary::Always => Ternary::Always,
            Combine::Replace if asks == Ternary::Never && rest == Ternary::Never => Ternary::Never,
            Combine::Replace => Ternary::Maybe,
        };
        (share, cut.or(rest_cut))
    }
}

/// Returns whether the finest of some pixels counts everywhere, and nothing else.
fn has_pixels_only(layers: &[CompiledLayer], limits: &StackLimits) -> bool {
    let is_one = |layer: &CompiledLayer| layer.is_plain() && layer.has_pixels_only();
    limits.slope.is_none() && layers.iter().all(is_one)
}

#[cfg(test)]
mod tests {
    use super::super::analytic::{Analytic, Function};
    use super::super::counting::Counting;
    use super::super::reading::Reading;
    use super::super::values::Values;
    use super::*;
    use crate::field::Formula;
    use crate::geometry::Rect;
    use crate::layers::{LayerId, Quantity};

    #[test]
    fn a_stack_without_a_field_has_the_diameters_of_its_layers_within_the_limits() {
        let lattice = Lattice::covering(Rect::UNIT, 0.25, 1000).unwrap();
        let edge_lengths = EdgeLengths::new(None, &lattice);
        let layer = |(id, combine), diameter| {
            let function = Function::Formula(Formula::constant_of(diameter));
            let values = Values::Constant(Analytic::new(function, Quantity::Diameter));
            CompiledLayer::new((LayerId(id), combine), (Reading::diameter(edge_lengths.table()), values))
        };
        let layers = vec![layer((0, Combine::Finest), 0.125), layer((1, Combine::Floor), 0.25)];
        let limits = StackLimits { h_min: 0.01, h_max: 1.0, unasked: 1.0, slope: None };
        let stack = Stack::new(layers, limits, &lattice, edge_lengths.clone());
        let (paint, all) = (PaintLayers::blank(), Cells::all(lattice.extent()));
        let diameters = |stack: &Stack| stack.diameters(paint, &all, Counting::ALL).0;
        assert_eq!(diameters(&stack), [0.25; 2]);
        assert_eq!(stack.ungraded_at(paint, lattice.bounds().center()).layer, Some(LayerId(1)));
        assert_eq!(diameters(&stack.with(|number, _| number == 0)), [0.125; 2]);
        assert_eq!(diameters(&stack.with(|_, _| false)), [1.0; 2]);
    }
}
