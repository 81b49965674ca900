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
        first_depth(self.0.iter().copied(), at)
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

/// The surface of a [`DepthSurface`] with layers of its own, whose rasters it shares, for work on other
/// threads.
#[derive(Clone, Debug)]
pub struct DepthField {
    /// From the top to the bottom.
    layers: Vec<Layer>,
    deepest: f64,
}

/// The depths in a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// The least and the greatest depth in metres, positive downwards, or a wider range; `None` where no
    /// layer has a value.
    pub ends: Option<[f64; 2]>,
    /// Whether some points may have no depth.
    pub has_gaps: bool,
}

impl DepthField {
    /// Returns the surface of a stack of layers, from the bottom to the top; `None` if no visible layer is
    /// one of depths.
    pub fn of(layers: &[Layer]) -> Option<Self> {
        let surface = DepthSurface::of(layers)?;
        let layers = surface.0.iter().map(|&(layer, _)| layer.clone()).collect();
        Some(Self { layers, deepest: surface.deepest() })
    }

    fn depths(&self) -> impl Iterator<Item = (&Layer, &Depths)> {
        self.layers.iter().filter_map(|layer| Some((layer, layer.kind.get()?)))
    }

    /// See [`DepthSurface::depth_at`].
    pub fn depth_at(&self, at: DVec2) -> Option<f64> {
        first_depth(self.depths(), at)
    }

    /// Returns the depths in a closed rectangle in world units.
    pub fn range_in(&self, area: &Rect) -> DepthRange {
        let mut all = DepthRange { ends: None, has_gaps: true };
        for (layer, depths) in self.depths() {
            let values = depths.source().raster.values_in(area);
            if let Some(range) = values.range {
                let [a, b] =
                    [range.least, range.greatest].map(|value| depths.sizes().depth_of(f64::from(value)));
                let (least, greatest) = (a.min(b), a.max(b));
                let joined = |ends: [f64; 2]| [ends[0].min(least), ends[1].max(greatest)];
                all.ends = Some(all.ends.map_or([least, greatest], joined));
            }
            if layer.mask.is_none() && !values.has_gaps {
                // What is below this layer does not count.
                all.has_gaps = false;
                break;
            }
        }
        all
    }

    /// See [`DepthSurface::deepest`].
    pub fn deepest(&self) -> f64 {
        self.deepest
    }

    /// Returns the shortest side of a pixel, in world units.
    pub fn pixel_size(&self) -> f64 {
        let sides = self.depths().map(|(_, depths)| depths.source().raster.raster().pixel_size());
        sides.map(DVec2::min_element).fold(f64::INFINITY, f64::min)
    }
}

/// Returns the depth at a point of the first of some layers that covers it and has a value.
fn first_depth<'a>(mut layers: impl Iterator<Item = (&'a Layer, &'a Depths)>, at: DVec2) -> Option<f64> {
    layers.find_map(|(layer, depths)| {
        let value = depths.source().raster.raster().linear_at(at).filter(|_| covers(layer, at))?;
        Some(depths.sizes().depth_of(value))
    })
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
