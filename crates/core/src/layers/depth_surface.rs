//! Several layers of depths as one surface.

use glam::DVec2;

use super::{Depths, Layer, LayerSource};
use crate::geometry::Rect;

/// The visible layers of depths of a stack. Each counts where it has a value and its mask covers, and no
/// layer above it does.
#[derive(Clone, Debug)]
pub struct DepthSurface<'a>(pub(super) Vec<(&'a Layer, &'a Depths)>);

impl<'a> DepthSurface<'a> {
    /// Returns the surface of a stack of layers, from the bottom to the top; `None` if no visible layer is
    /// one of depths.
    pub fn of(layers: &'a [Layer]) -> Option<Self> {
        let visible = layers.iter().rev().filter(|layer| layer.visible);
        let depths: Vec<_> = visible.filter_map(|layer| Some((layer, layer.kind.get()?))).collect();
        (!depths.is_empty()).then_some(Self(depths))
    }

    /// Returns the depth at a point, in metres, positive downwards: linear between the centres of pixels.
    /// `None` where no layer has a value.
    pub fn depth_at(&self, at: DVec2) -> Option<f64> {
        let covering = self.0.iter().filter(|(layer, _)| covers(layer, at));
        let mut values = covering.filter_map(|(_, depths)| {
            depths.source().raster.raster().linear_at(at).map(|value| depths.sizes().depth_of(value))
        });
        values.next()
    }

    /// Returns the greatest depth of any pixel, in metres; 0 where all is land.
    pub fn deepest(&self) -> f64 {
        let depths = self.0.iter().flat_map(|(_, depths)| {
            let range = depths.source().raster.finite_range();
            let ends = range.map(|range| [range.least, range.greatest].map(f64::from));
            ends.into_iter().flatten().map(|value| depths.sizes().depth_of(value))
        });
        depths.fold(0.0, f64::max)
    }
}

/// Returns the layers of depths above a layer of depths in its stack that hide it where they have values:
/// those of other files that ask for sizes.
pub(super) fn hiding<'a>(stack: &'a [Layer], layer: &Layer) -> impl Iterator<Item = (&'a Layer, &'a Depths)> {
    let own = layer.kind.get::<Depths>().map(|depths| depths.source().clone());
    let place = stack.iter().position(|other| other.id == layer.id);
    let above = place.map_or(&stack[..0], |place| &stack[place + 1..]);
    above.iter().filter(|above| above.visible).filter_map(move |above| {
        let (depths, own) = (above.kind.get::<Depths>()?, own.as_ref()?);
        (depths.asks_for_diameters() && depths.source() != own).then_some((above, depths))
    })
}

/// Returns rectangles that hold the places where a layer of depths is hidden in one of two stacks only.
pub(super) fn hidden_differently(layer: &Layer, new: &[Layer], old: &[Layer]) -> Vec<Rect> {
    let hides = |stack, (above, depths): &(&Layer, &Depths)| {
        hiding(stack, layer).any(|(other, own)| other.mask == above.mask && own.source() == depths.source())
    };
    let only = |stack, other| hiding(stack, layer).filter(move |above| !hides(other, above));
    only(new, old).chain(only(old, new)).map(|(_, depths)| depths.source().raster.raster().bounds()).collect()
}

/// Returns rectangles that hold the places where the surfaces of depths of two stacks differ. Below files
/// that both have at the top, and above those that both have at the bottom, each file counts somewhere.
pub(super) fn surface_changes(new: &[Layer], old: &[Layer]) -> Vec<Rect> {
    let files = |stack| DepthSurface::of(stack).map_or_else(Vec::new, |surface| surface.0);
    let (new, old) = (files(new), files(old));
    let is_same = |(a, b): &(&(&Layer, &Depths), &(&Layer, &Depths))| {
        let meaning = |depths: &Depths| (depths.sizes().positive, depths.sizes().offset);
        a.0.mask == b.0.mask && meaning(a.1) == meaning(b.1) && a.1.source() == b.1.source()
    };
    let first = new.iter().zip(&old).take_while(is_same).count();
    let (new, old) = (&new[first..], &old[first..]);
    let last = new.iter().rev().zip(old.iter().rev()).take_while(is_same).count();
    let changed = new[..new.len() - last].iter().chain(&old[..old.len() - last]);
    changed.map(|(_, depths)| depths.source().raster.raster().bounds()).collect()
}

pub(super) fn covers(layer: &Layer, at: DVec2) -> bool {
    layer.mask.as_ref().is_none_or(|mask| mask.contains(at))
}

pub(super) fn has_value(depths: &Depths, at: DVec2) -> bool {
    depths.source().raster.sample(at).is_some_and(|value| !value.is_nan())
}
