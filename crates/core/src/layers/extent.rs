//! The area in which a layer can have a target diameter.

use super::{
    Combine, DepthRule, DistanceTo, FeatureSize, Layer, LayerKind, Mask, PaintLayers, Quantity,
    RasterReading, SizeFieldSpec, Threats, surface_changes,
};
use crate::geometry::{Rect, z_order};
use crate::raster::ValueRanges;

/// A part of the plane, in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent {
    /// All of it.
    Everywhere,
    /// These closed rectangles, which may overlap; the list may be empty.
    Within(Vec<Rect>),
}

/// The data besides the layer that decide its extent.
#[derive(Clone, Copy, Debug)]
pub struct ExtentContext<'a> {
    /// The size field that the layer belongs to.
    pub spec: &'a SizeFieldSpec,
    /// The painted pixels.
    pub paint: &'a PaintLayers,
    /// The diameter of a coarse triangle in world units: nothing coarser than this matters to a mesh.
    pub longest: f64,
    /// How many times longer than on the Earth a length counts in the plane; 1 without a projection.
    pub greatest_scale: f64,
}

/// Most rectangles of an extent; more are joined, those that are near to each other first.
const MOST_RECTS: usize = 64;

impl Extent {
    /// Returns a part of the plane with these rectangles, of which many are joined.
    pub fn of(rects: impl IntoIterator<Item = Rect>) -> Self {
        Self::Within(joined(rects.into_iter().collect(), MOST_RECTS))
    }

    /// Returns the rectangles of the part of the plane in `bounds`.
    pub fn rects_within(self, bounds: Rect) -> Vec<Rect> {
        match self {
            Self::Everywhere => vec![bounds],
            Self::Within(rects) => rects,
        }
    }

    /// Returns the part that lies in the bounds of a mask, if there is one.
    pub fn within_mask(self, mask: Option<&Mask>) -> Self {
        let Some(mask) = mask else { return self };
        match self {
            Self::Everywhere => Self::Within(vec![mask.bounds()]),
            Self::Within(rects) => {
                let bounds = mask.bounds();
                Self::Within(rects.iter().filter_map(|rect| rect.intersection(&bounds)).collect())
            }
        }
    }
}

/// Joins near rectangles until there are at most `most`.
pub fn joined(mut rects: Vec<Rect>, most: usize) -> Vec<Rect> {
    let bounds = rects.iter().copied().reduce(|a, b| a.union(&b));
    let Some(bounds) = bounds.filter(|_| rects.len() > most) else { return rects };
    rects.sort_by_key(|rect| z_order(rect.center(), &bounds));
    let groups = rects.chunks(rects.len().div_ceil(most));
    groups.filter_map(|group| group.iter().copied().reduce(|a, b| a.union(&b))).collect()
}

impl ExtentContext<'_> {
    /// Returns a diameter from which on it makes no difference to the mesh what a layer in which the finest
    /// counts asks for, in world units. Infinite where no such layer may be left out.
    fn ceiling(&self) -> f64 {
        let ceiling = self.spec.transfer.h_max.min(self.longest);
        if self.spec.unasked >= ceiling { ceiling } else { f64::INFINITY }
    }
}

impl Layer {
    /// Returns whether its values are risks, so that the transfer curve matters.
    pub fn is_of_risk(&self) -> bool {
        match &self.kind {
            LayerKind::Paint(quantity) | LayerKind::Formula { quantity, formula: _ } => {
                *quantity == Quantity::Risk
            }
            LayerKind::Raster { reading, source: _ } => *reading == RasterReading::Risk,
            LayerKind::Threats(_) => true,
            LayerKind::Distance { .. }
            | LayerKind::Band { .. }
            | LayerKind::Depth(_)
            | LayerKind::Straits(_)
            | LayerKind::FeatureSize(_)
            | LayerKind::Surface(_) => false,
        }
    }

    /// Returns whether it changes with the boundary of the domain.
    pub fn follows_outline(&self) -> bool {
        match &self.kind {
            LayerKind::Distance { to, .. } => to.shapes().is_none(),
            LayerKind::Straits(_) | LayerKind::FeatureSize(_) => true,
            _ => false,
        }
    }

    /// Returns whether it asks for the distance to the whole boundary of the domain.
    pub fn is_of_outline(&self) -> bool {
        matches!(self.kind, LayerKind::Distance { to: DistanceTo::Outline, .. })
    }

    /// Returns where the layer, if it is visible, can ask for something that matters to the mesh.
    pub(super) fn extent(&self, context: &ExtentContext) -> Extent {
        self.extent_of_kind(context).within_mask(self.mask.as_ref())
    }

    fn extent_of_kind(&self, context: &ExtentContext) -> Extent {
        match &self.kind {
            _ if self.is_of_errors() => Extent::Within(Vec::new()),
            LayerKind::Paint(_) => {
                let raster = context.paint.get(self.id);
                let tiles = raster
                    .into_iter()
                    .flat_map(|raster| raster.tiles().map(|(place, _)| place.area(raster.grid())));
                Extent::of(tiles)
            }
            LayerKind::Formula { quantity: _, formula } if formula.uses_depth() => {
                Extent::of(surface_changes(&context.spec.layers, &[]))
            }
            LayerKind::Formula { quantity, formula } => match (quantity, formula.constant()) {
                (Quantity::Diameter, Some(f64::INFINITY)) => Extent::Within(Vec::new()),
                _ => Extent::Everywhere,
            },
            LayerKind::Raster { source, reading: _ }
            | LayerKind::Band { source, between: _, diameter: _ } => {
                Extent::of([source.raster.raster().bounds()])
            }
            LayerKind::Depth(depths) if depths.sizes().rule == DepthRule::Nothing => {
                Extent::Within(Vec::new())
            }
            LayerKind::Surface(_) => Extent::Within(Vec::new()),
            LayerKind::Depth(depths) => Extent::of([depths.source().raster.raster().bounds()]),
            LayerKind::Straits(straits) => Extent::of(straits.found.extent()),
            LayerKind::FeatureSize(size) => self.extent_of_feature_size(size, context),
            LayerKind::Threats(threats) => Extent::of(threats.reaches()),
            LayerKind::Distance { to, at_zero, slope, range } => {
                let farthest = self.farthest_in_plane([*at_zero, *slope, *range], context);
                let shapes =
                    if *to == DistanceTo::Outline { context.spec.outline.as_ref() } else { to.shapes() };
                match shapes {
                    None => Extent::Within(Vec::new()),
                    Some(_) if farthest < 0.0 => Extent::Within(Vec::new()),
                    Some(shapes) if farthest.is_finite() => {
                        let reach = context.greatest_scale * to.reach();
                        Extent::of([shapes.extent().expanded(reach + farthest)])
                    }
                    Some(_) => Extent::Everywhere,
                }
            }
        }
    }

    /// It grows with the way from the middle of the water.
    fn extent_of_feature_size(&self, size: &FeatureSize, context: &ExtentContext) -> Extent {
        let ceiling = if self.combine == Combine::Finest { context.ceiling() } else { f64::INFINITY };
        match size.found.extent() {
            Some(_) if ceiling == f64::INFINITY => Extent::Everywhere,
            Some(middle) => {
                let reach = size.farthest(context.greatest_scale * ceiling);
                Extent::of([middle.expanded(reach)])
            }
            None => Extent::Within(Vec::new()),
        }
    }

    /// Returns the distance from which on a layer of the distance with these numbers asks for nothing, or for
    /// too large a diameter to matter, in world units: below zero where it never matters, infinite where it
    /// always can.
    pub(super) fn farthest_in_plane(
        &self,
        [at_zero, slope, range]: [f64; 3],
        context: &ExtentContext,
    ) -> f64 {
        let ceiling = context.ceiling();
        let has_end = self.combine == Combine::Finest && ceiling != f64::INFINITY && slope > 0.0;
        // A little more, because the value at a distance is rounded.
        let below_ceiling = if has_end { (ceiling * (1.0 + 1e-9) - at_zero) / slope } else { f64::INFINITY };
        context.greatest_scale * (1.0 + 1e-9) * range.min(below_ceiling)
    }
}

impl Threats {
    /// Returns the rectangles beyond which there is no risk, in world units.
    fn reaches(&self) -> impl Iterator<Item = Rect> {
        self.list().iter().filter(|threat| threat.peak > 0.0).map(super::Threat::reach)
    }
}
