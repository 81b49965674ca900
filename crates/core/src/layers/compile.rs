//! Prepares layers for questions on a lattice.

use super::engine::{CompiledLayer, CompiledPlane, Cover, Stack, StackLimits, Values};
use super::{DepthSizes, DepthSurface, Depths, Layer, SizeFieldSpec, hiding};
use crate::earth::EdgeLengths;
use crate::field::Transfer;
use crate::geometry::Lattice;

impl SizeFieldSpec {
    /// Returns the visible layers on a lattice.
    pub(super) fn compile(&self, lattice: &Lattice, edge_lengths: EdgeLengths) -> Stack {
        let Self { layers, transfer, outline, .. } = self;
        let visible = || layers.iter().filter(|layer| layer.visible);
        let uses_depth = visible().any(|layer| layer.kind.uses_depth());
        let depths = if uses_depth { depths_of(layers, lattice) } else { Vec::new() };
        let outline = outline.as_ref();
        let plane =
            CompiledPlane { depths: &depths, transfer, lattice, outline, edge_lengths: &edge_lengths };
        let compiled = visible().map(|layer| layer.compile(layers, &plane)).collect();
        let slope = self.gradation.map(|gradation| gradation / edge_lengths.greatest_scale());
        let Transfer { h_min, h_max, .. } = *transfer;
        let limits = StackLimits { h_min, h_max, unasked: self.unasked, slope };
        Stack::new(compiled, limits, lattice, edge_lengths)
    }
}

impl Layer {
    /// Returns a layer of a stack on a lattice.
    fn compile(&self, stack: &[Self], plane: &CompiledPlane) -> CompiledLayer {
        let asked = match self.is_of_errors() {
            true => (plane.diameters(), Values::Nothing),
            false => self.kind.compile(self.slot(), plane),
        };
        let covers = hiding(stack, self)
            .map(|(above, depths)| Cover::new(&depths.source().raster, above.mask.as_ref(), plane.lattice))
            .collect();
        CompiledLayer::new((self.id, self.combine), asked).within(self.mask.clone(), covers)
    }
}

/// Returns the files of depths of a stack, from the top to the bottom, with the meaning of their values.
pub(super) fn depths_of(stack: &[Layer], lattice: &Lattice) -> Vec<(Cover, DepthSizes)> {
    let files = DepthSurface::of(stack).map_or_else(Vec::new, |surface| surface.0);
    let file = |(layer, depths): (&Layer, &Depths)| {
        (Cover::new(&depths.source().raster, layer.mask.as_ref(), lattice), *depths.sizes())
    };
    files.into_iter().map(file).collect()
}
