//! The risk of a stack of layers: at a point, and its range over a rectangle.

use glam::DVec2;

use super::engine::asked::Ternary;
use super::risk_pixels::{RiskWithGaps, range_within};
use super::risk_source::RiskSource;
use super::{Combine, Coverage, Layer, Mask, PaintLayers};
use crate::field::Bounds;
use crate::geometry::Rect;
use crate::raster::{ValueRange, ValueRanges};

/// The risk that a stack of layers has at each point, from 0 to 1.
///
/// Only visible layers that hold risk count: paint, rasters, threats and formulas of risk. Layers that hold
/// diameters do not. From the bottom up, inside the layer's mask and where the layer has a risk: *finest*
/// lets the greater risk count, *floor* the smaller, and *replace* the layer's alone. Where no layer has a
/// risk, it is 0.
///
/// Formulas and threats count with their values at the point itself. On a line between pixels, the smaller
/// risk of the pixels counts. Clones share the data.
#[derive(Clone, Debug, Default)]
pub struct RiskField {
    pub(super) layers: Vec<RiskLayer>,
    /// The domain without a thin rim, if it is known.
    pub(super) inside: Option<Rect>,
}

#[derive(Clone, Debug)]
pub(super) struct RiskLayer {
    pub combine: Combine,
    pub mask: Option<Mask>,
    pub source: RiskSource,
}

/// The risks of a layer in a rectangle, and where it has any.
pub(super) struct Risks {
    pub least: f64,
    pub greatest: f64,
    present: Ternary,
}

/// The width of the rim of a domain, as a share of its longer side. It is wider than
/// [`PIXEL_MARGIN`](super::risk_pixels::PIXEL_MARGIN).
const RIM: f64 = 1e-8;

impl RiskField {
    /// Returns the risk of a stack, from the bottom to the top, with the painted pixels of its layers.
    pub fn new(layers: &[Layer], paint: &PaintLayers) -> Self {
        let of = |layer: &Layer| {
            let source = layer.kind.risks(paint.get(layer.id))?;
            Some(RiskLayer { combine: layer.combine, mask: layer.mask.clone(), source })
        };
        let layers = layers.iter().filter(|layer| layer.visible).filter_map(of).collect();
        Self { layers, inside: None }
    }

    /// Returns the risk in a domain: on its border, pixels and masks count as they do just inside. Since the
    /// smaller risk beside a line counts, a raster that ends at the border would have no risk there, and a
    /// path along the border would avoid all of it.
    pub fn within(self, domain: &Rect) -> Self {
        let size = domain.size();
        let rim = (RIM * size.max_element()).min(0.25 * size.min_element());
        Self { inside: Some(domain.expanded(-rim)), ..self }
    }

    /// Returns the part of a rectangle whose pixels count: the nearest one inside the domain.
    pub(super) fn seen(&self, rectangle: &Rect) -> Rect {
        match self.inside {
            Some(Rect { min, max }) => {
                Rect::new(rectangle.min.max(min).min(max), rectangle.max.max(min).min(max))
            }
            None => *rectangle,
        }
    }

    /// Returns whether no layer holds a risk.
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// The risk at a point in world units.
    pub fn at(&self, point: DVec2) -> f64 {
        let place = self.seen(&Rect::new(point, point));
        self.layers.iter().fold(0.0, |below, layer| {
            if layer.mask.as_ref().is_some_and(|mask| !mask.contains(place.min)) {
                return below;
            }
            let risks = layer.source.at(point, &place);
            match (risks, layer.combine) {
                (None, _) => below,
                (Some(risk), Combine::Finest) => below.max(risk),
                (Some(risk), Combine::Floor) => below.min(risk),
                (Some(risk), Combine::Replace) => risk,
            }
        })
    }

    /// Returns bounds of the risk over a closed rectangle in world units; they may be wider than the values.
    pub fn range(&self, rectangle: &Rect) -> Bounds {
        let seen = self.seen(rectangle);
        self.layers.iter().fold(Bounds::one(0.0), |below, layer| {
            let mut risks = layer.source.range(rectangle, &seen);
            if let Some(mask) = &layer.mask {
                match mask.classify(&seen) {
                    Coverage::Inside => {}
                    Coverage::Outside => return below,
                    Coverage::Mixed => risks.present = risks.present.masked(),
                }
            }
            risks.over(below, layer.combine)
        })
    }
}

impl Risks {
    fn new(range: ValueRange, none: f32) -> Self {
        let present = match (range.least > none, range.greatest > none) {
            (true, _) => Ternary::Always,
            (false, true) => Ternary::Maybe,
            (false, false) => Ternary::Never,
        };
        let [least, greatest] = [range.least, range.greatest].map(|v| f64::from(v).clamp(0.0, 1.0));
        Self { least, greatest, present }
    }

    /// Returns whether the layer has a risk at every point.
    pub fn is_everywhere(&self) -> bool {
        self.present == Ternary::Always
    }

    /// Returns whether the layer has no risk at any point.
    pub fn is_nowhere(&self) -> bool {
        self.present == Ternary::Never
    }

    /// Returns the bounds of the result, from those of the layers below.
    pub fn over(&self, below: Bounds, combine: Combine) -> Bounds {
        let Self { least, greatest, present } = *self;
        let own = Bounds::new(least, greatest);
        let result = match combine {
            Combine::Finest => Bounds::new(below.least.max(least), below.greatest.max(greatest)),
            Combine::Floor => Bounds::new(below.least.min(least), below.greatest.min(greatest)),
            Combine::Replace => own,
        };
        match present {
            Ternary::Never => below,
            Ternary::Maybe => below.union(result),
            Ternary::Always => result,
        }
    }
}

impl RiskSource {
    /// `None` where the layer has no risk. `place` is that of the pixels that count.
    fn at(&self, point: DVec2, place: &Rect) -> Option<f64> {
        match self {
            Self::Paint(_) | Self::Raster(_) => {
                let Risks { least, present, .. } = self.range(place, place);
                (present == Ternary::Always).then_some(least)
            }
            Self::Formula(formula) => {
                let risk = formula.eval(point.x, point.y);
                (!risk.is_nan()).then_some(risk.clamp(0.0, 1.0))
            }
            Self::Threats(threats) => Some(threats.risk_at(point)).filter(|risk| *risk > 0.0),
        }
    }

    /// `seen` has the pixels that count in a rectangle.
    pub(super) fn range(&self, rectangle: &Rect, seen: &Rect) -> Risks {
        let of_bounds = |bounds: Bounds, none: f64| {
            let present = match (bounds.valid && bounds.least > none, bounds.greatest > none) {
                (true, _) => Ternary::Always,
                (false, true) => Ternary::Maybe,
                (false, false) => Ternary::Never,
            };
            let [least, greatest] = [bounds.least, bounds.greatest].map(|v| v.clamp(0.0, 1.0));
            Risks { least, greatest, present }
        };
        match self {
            // Risk 0 is blank paint.
            Self::Paint(raster) => Risks::new(range_within(raster, seen, raster.grid(), 0.0), 0.0),
            Self::Raster(raster) => {
                let with_gaps = RiskWithGaps(raster);
                let range = range_within(&with_gaps, seen, raster.grid(), f32::NEG_INFINITY);
                Risks::new(range, f32::NEG_INFINITY)
            }
            // A risk of −∞ counts as 0.
            Self::Formula(formula) => {
                let bounds = formula.bounds(rectangle);
                let least = if bounds.valid { bounds.least.max(0.0) } else { 0.0 };
                of_bounds(Bounds { least, greatest: bounds.greatest.max(0.0), ..bounds }, -1.0)
            }
            Self::Threats(threats) => of_bounds(threats.bounds(rectangle), 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::Formula;
    use crate::layers::{
        LayerId, LayerKind, PaintLayer, Quantity, RasterLayer, RasterReading, RasterSource, Threat,
        ThreatLaw, Threats,
    };
    use crate::raster::{PixelGrid, Raster, RasterPyramid, Tile, TilePlace, TiledRaster};

    fn layers(random: &mut fastrand::Rng) -> (Vec<Layer>, PaintLayers) {
        let mut paint = PaintLayers::default();
        let mut layers = Vec::new();
        for id in 0..random.u32(1..5) {
            let kind = match random.u32(..4) {
                0 => {
                    let mut tile = Tile::filled(0.0);
                    for _ in 0..60 {
                        tile.set(random.i32(0..16), random.i32(0..16), random.f32());
                    }
                    let mut raster = TiledRaster::new(PixelGrid::filling(&Rect::UNIT, [16, 16]), 0.0);
                    raster.exchange(TilePlace { depth: 0, x: 0, y: 0 }, Some(tile.into()));
                    paint.insert(LayerId(id), raster);
                    LayerKind::paint(Quantity::Risk)
                }
                1 => LayerKind::risk(Formula::parse("x*y+0.3*sin(9*x)").unwrap()),
                2 => {
                    let values =
                        (0..60).map(|_| if random.u32(..5) == 0 { f32::NAN } else { random.f32() }).collect();
                    let bounds = Rect::new(dvec2(0.1, 0.2), dvec2(0.8, 0.9));
                    let raster = RasterPyramid::new(Raster::from_values(bounds, [10, 6], values)).into();
                    let source = RasterSource { name: String::new(), raster };
                    RasterLayer { source, reading: RasterReading::Risk }.into()
                }
                _ => {
                    let threat = |random: &mut fastrand::Rng| Threat {
                        at: dvec2(random.f64(), random.f64()),
                        range: 0.05 + 0.3 * random.f64(),
                        peak: random.f64(),
                        law: ThreatLaw::ALL[random.usize(..3)].0,
                    };
                    LayerKind::Threats(Threats::new((0..4).map(|_| threat(random)).collect()).unwrap())
                }
            };
            let mut layer = Layer::new(LayerId(id), "", kind);
            layer.combine = Combine::ALL[random.usize(..3)];
            if random.bool() {
                let corner = dvec2(0.5 * random.f64(), 0.5 * random.f64());
                let ring = [dvec2(0.0, 0.0), dvec2(0.5, 0.1), dvec2(0.3, 0.4)].map(|p| corner + p);
                layer.mask = Some(Mask::new(&[vec![ring.to_vec()]]).unwrap());
            }
            layers.push(layer);
        }
        (layers, paint)
    }

    /// Returns the risk by definition: each layer asked by itself.
    fn by_definition(layers: &[Layer], paint: &PaintLayers, p: DVec2) -> f64 {
        let mut result = 0.0;
        for layer in layers {
            let Some(risk) = layer.risk_at(paint, p).filter(|risk| !risk.is_nan()) else { continue };
            let asks = !(layer.kind.is::<PaintLayer>() || layer.kind.is::<Threats>()) || risk > 0.0;
            let risk = risk.clamp(0.0, 1.0);
            result = match layer.combine {
                _ if !asks => result,
                Combine::Finest => f64::max(result, risk),
                Combine::Floor => f64::min(result, risk),
                Combine::Replace => risk,
            };
        }
        result
    }

    #[test]
    fn the_risk_is_that_of_its_definition_and_lies_in_the_range_of_every_rectangle() {
        let mut random = fastrand::Rng::with_seed(1401);
        let mut exact = 0;
        for _ in 0..200 {
            let (layers, paint) = layers(&mut random);
            let field = RiskField::new(&layers, &paint);
            for _ in 0..40 {
                let min = dvec2(1.2 * random.f64() - 0.1, 1.2 * random.f64() - 0.1);
                let side = [0.0, 1e-4, 0.05, 0.6][random.usize(..4)];
                let rect = Rect::new(min, min + side * dvec2(random.f64(), random.f64()));
                let range = field.range(&rect);
                exact += usize::from(range.is_one());
                for _ in 0..10 {
                    let share = dvec2(random.f64(), random.f64());
                    let p = (rect.min + share * rect.size()).clamp(rect.min, rect.max);
                    let risk = field.at(p);
                    assert_eq!(risk, by_definition(&layers, &paint, p), "{p}");
                    assert!(range.contains(risk), "{risk} at {p} in {range:?} of {rect:?}");
                }
            }
        }
        assert!(exact > 2000, "{exact}");
    }

    #[test]
    fn on_a_line_between_pixels_the_smaller_risk_counts() {
        let raster = Raster::from_values(Rect::UNIT, [2, 1], vec![0.75, 0.25]);
        let source = RasterSource { name: String::new(), raster: RasterPyramid::new(raster).into() };
        let kind = LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk });
        let field = RiskField::new(&Layer::stack([kind]), PaintLayers::blank());
        assert_eq!(field.at(dvec2(0.5, 0.5)), 0.25);
        assert_eq!(field.at(dvec2(0.4, 0.5)), 0.75);
        let line = Rect::new(dvec2(0.5, 0.1), dvec2(0.5, 0.9));
        assert_eq!(field.range(&line), Bounds::new(0.25, 0.75));
    }

    #[test]
    fn on_the_border_of_a_domain_pixels_count_as_just_inside() {
        let raster = Raster::from_values(Rect::UNIT, [3, 2], vec![0.75; 6]);
        let source = RasterSource { name: String::new(), raster: RasterPyramid::new(raster).into() };
        let mut layer = Layer::stack([RasterLayer { source, reading: RasterReading::Risk }]);
        let ring = [dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(1.0, 1.0), dvec2(0.0, 1.0)];
        for mask in [None, Some(Mask::new(&[vec![ring.to_vec()]]).unwrap())] {
            layer[0].mask = mask;
            let open = RiskField::new(&layer, PaintLayers::blank());
            let field = open.clone().within(&Rect::UNIT);
            for (from, to) in [((0.0, 0.0), (1.0, 0.0)), ((0.2, 1.0), (0.7, 1.0)), ((1.0, 0.5), (1.0, 1.0))] {
                let [from, to] = [from, to].map(|(x, y)| dvec2(x, y));
                let rectangle = Rect::spanning(from, to);
                assert_eq!(field.range(&rectangle), Bounds::one(0.75));
                assert_eq!([from, from.midpoint(to), to].map(|p| field.at(p)), [0.75; 3]);
                assert_eq!(field.derivatives(&rectangle).unwrap(), [Bounds::one(0.0); 2]);
                assert_eq!(open.range(&rectangle).least, 0.0);
            }
        }
        let half = Rect::new(DVec2::ZERO, dvec2(2.0, 1.0));
        let field = RiskField::new(&layer, PaintLayers::blank()).within(&half);
        assert_eq!(field.range(&half), Bounds::new(0.0, 0.75));
    }

    #[test]
    fn a_raster_far_from_a_rectangle_has_no_risk_there() {
        for (bounds, at) in [
            (Rect::new(DVec2::ZERO, DVec2::splat(1e-9)), dvec2(10.0, -10.0)),
            (Rect::new(DVec2::ZERO, DVec2::splat(1e-30)), dvec2(1.0, 0.0)),
        ] {
            let raster = RasterPyramid::new(Raster::from_values(bounds, [2, 2], vec![0.75; 4]));
            let source = RasterSource { name: String::new(), raster: raster.into() };
            let kind = LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk });
            let field = RiskField::new(&Layer::stack([kind]), PaintLayers::blank());
            assert_eq!(field.at(bounds.center()), 0.75);
            assert_eq!(field.at(at), 0.0);
            assert_eq!(field.range(&Rect::spanning(at, bounds.center())), Bounds::new(0.0, 0.75));
        }
    }

    #[test]
    fn layers_of_diameters_do_not_count() {
        let stack = Layer::stack([
            LayerKind::constant(0.5),
            LayerKind::risk(Formula::constant_of(0.25)),
            LayerKind::paint(Quantity::Diameter),
        ]);
        assert_eq!(RiskField::new(&stack, PaintLayers::blank()).at(dvec2(0.5, 0.5)), 0.25);
        assert!(RiskField::new(&stack[..1], PaintLayers::blank()).is_empty());
    }
}
