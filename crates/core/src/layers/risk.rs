//! The risk of a stack of layers: at a point, and its range over a rectangle.

use std::sync::Arc;

use glam::DVec2;

use super::engine::asked::Share;
use super::{Combine, Coverage, Layer, LayerKind, Mask, PaintLayers, Quantity, RasterReading, Threats};
use crate::field::{Bounds, Formula};
use crate::geometry::Rect;
use crate::raster::{PixelGrid, RasterPyramid, TiledRaster, ValueRange, ValueRanges, exponent, power_of_two};

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
}

#[derive(Clone, Debug)]
pub(super) struct RiskLayer {
    pub combine: Combine,
    pub mask: Option<Mask>,
    pub source: RiskSource,
}

#[derive(Clone, Debug)]
pub(super) enum RiskSource {
    Paint(TiledRaster),
    Raster(Arc<RasterPyramid>),
    Formula(Formula),
    Threats(Threats),
}

/// The risks of a layer in a rectangle, and where it has any.
pub(super) struct Risks {
    pub least: f64,
    pub greatest: f64,
    present: Share,
}

/// Pixels this near to a rectangle, as a share of their side, count: places are rounded.
const PIXEL_MARGIN: f64 = 1e-9;

/// A square this many times finer than a pixel has one value.
const FINEST_SCALE: i32 = -60;

impl RiskField {
    /// Returns the risk of a stack, from the bottom to the top, with the painted pixels of its layers.
    pub fn new(layers: &[Layer], paint: &PaintLayers) -> Self {
        let of = |layer: &Layer| {
            let source = match &layer.kind {
                LayerKind::Paint(Quantity::Risk) => RiskSource::Paint(paint.get(layer.id)?.clone()),
                LayerKind::Formula { quantity: Quantity::Risk, formula } => {
                    RiskSource::Formula(formula.clone())
                }
                LayerKind::Raster { source, reading: RasterReading::Risk } => {
                    RiskSource::Raster(source.raster.clone())
                }
                LayerKind::Threats(threats) => RiskSource::Threats(threats.clone()),
                _ => return None,
            };
            Some(RiskLayer { combine: layer.combine, mask: layer.mask.clone(), source })
        };
        Self { layers: layers.iter().filter(|layer| layer.visible).filter_map(of).collect() }
    }

    /// Returns whether no layer holds a risk.
    pub fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// The risk at a point in world units.
    pub fn at(&self, point: DVec2) -> f64 {
        let place = Rect::new(point, point);
        self.layers.iter().fold(0.0, |below, layer| {
            if layer.mask.as_ref().is_some_and(|mask| !mask.contains(point)) {
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
        self.layers.iter().fold(Bounds::one(0.0), |below, layer| {
            let mut risks = layer.source.range(rectangle);
            if let Some(mask) = &layer.mask {
                match mask.classify(rectangle) {
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
            (true, _) => Share::All,
            (false, true) => Share::Some,
            (false, false) => Share::None,
        };
        let [least, greatest] = [range.least, range.greatest].map(|v| f64::from(v).clamp(0.0, 1.0));
        Self { least, greatest, present }
    }

    /// Returns whether the layer has a risk at every point.
    pub fn is_everywhere(&self) -> bool {
        self.present == Share::All
    }

    /// Returns whether the layer has no risk at any point.
    pub fn is_nowhere(&self) -> bool {
        self.present == Share::None
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
            Share::None => below,
            Share::Some => below.union(result),
            Share::All => result,
        }
    }
}

impl RiskSource {
    /// `None` where the layer has no risk.
    fn at(&self, point: DVec2, place: &Rect) -> Option<f64> {
        match self {
            Self::Paint(_) | Self::Raster(_) => {
                let Risks { least, present, .. } = self.range(place);
                (present == Share::All).then_some(least)
            }
            Self::Formula(formula) => {
                let risk = formula.eval(point.x, point.y);
                (!risk.is_nan()).then_some(risk.clamp(0.0, 1.0))
            }
            Self::Threats(threats) => Some(threats.risk_at(point)).filter(|risk| *risk > 0.0),
        }
    }

    pub fn range(&self, rectangle: &Rect) -> Risks {
        let of_bounds = |bounds: Bounds, none: f64| {
            let present = match (bounds.valid && bounds.least > none, bounds.greatest > none) {
                (true, _) => Share::All,
                (false, true) => Share::Some,
                (false, false) => Share::None,
            };
            let [least, greatest] = [bounds.least, bounds.greatest].map(|v| v.clamp(0.0, 1.0));
            Risks { least, greatest, present }
        };
        match self {
            // Risk 0 is blank paint.
            Self::Paint(raster) => Risks::new(range_within(raster, rectangle, raster.grid(), 0.0), 0.0),
            Self::Raster(raster) => {
                let with_gaps = WithGaps(raster);
                let range = range_within(&with_gaps, rectangle, raster.grid(), f32::NEG_INFINITY);
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

/// A raster whose gaps have a risk of −∞.
struct WithGaps<'a>(&'a RasterPyramid);

impl ValueRanges for WithGaps<'_> {
    fn grid(&self) -> &PixelGrid {
        self.0.grid()
    }

    fn coarsest(&self) -> i32 {
        self.0.coarsest()
    }

    fn range(&self, scale: i32, x: i32, y: i32) -> ValueRange {
        self.0.square(scale, x, y).with_gaps(f32::NEG_INFINITY)
    }

    fn whole_range(&self) -> ValueRange {
        self.0.whole().with_gaps(f32::NEG_INFINITY)
    }
}

/// Returns the range of the pixels that touch a closed rectangle in world units, and of some around it.
fn range_within(raster: &impl ValueRanges, rectangle: &Rect, grid: &PixelGrid, gap: f32) -> ValueRange {
    let whole = raster.whole_range().union(ValueRange::one(gap));
    if whole.is_one() {
        return whole;
    }
    let [min, max] = [rectangle.min, rectangle.max].map(|corner| grid.pixel_from_world(corner));
    let side = (max - min).max_element();
    // Squares of about a quarter of the rectangle.
    let finest = if side > 0.0 { exponent(side) - 2 } else { FINEST_SCALE }.max(FINEST_SCALE);
    let start = if side > 1.0 { exponent(side) + 1 } else { 0 };
    if start > raster.coarsest() + 1 {
        return whole;
    }
    let search = Descent { raster, min: min.to_array(), max: max.to_array(), finest };
    let [first, last] = search.places(power_of_two(start));
    let mut range: Option<ValueRange> = None;
    for y in first[1]..=last[1] {
        for x in first[0]..=last[0] {
            let found = search.square(start, x, y);
            range = Some(range.map_or(found, |range| range.union(found)));
        }
    }
    range.unwrap_or(whole)
}

struct Descent<'a, R> {
    raster: &'a R,
    /// The corners of the rectangle in pixels.
    min: [f64; 2],
    max: [f64; 2],
    /// The scale at which descending ends.
    finest: i32,
}

impl<R: ValueRanges> Descent<'_, R> {
    /// Returns the first and the last column and row of squares of a side in pixels that touch the rectangle.
    fn places(&self, side: f64) -> [[i64; 2]; 2] {
        let margin = PIXEL_MARGIN * side.min(1.0);
        let first = self.min.map(|v| (((v - margin) / side).ceil() as i64).saturating_sub(1));
        let last = self.max.map(|v| ((v + margin) / side).floor() as i64);
        // The ceiling of a place between two lines belongs to the square before it.
        let first = [0, 1].map(|axis: usize| first[axis].min(last[axis]));
        [first, last]
    }

    fn square(&self, scale: i32, x: i64, y: i64) -> ValueRange {
        let range = self.raster.range_anywhere(scale, [x, y]);
        if range.is_one() || scale <= self.finest {
            return range;
        }
        let Some([x, y]) = x.checked_mul(2).zip(y.checked_mul(2)).map(|(x, y)| [x, y]) else { return range };
        let [first, last] = self.places(power_of_two(scale - 1));
        let columns = x.max(first[0])..=(x + 1).min(last[0]);
        let rows = y.max(first[1])..=(y + 1).min(last[1]);
        let parts = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        parts.map(|(x, y)| self.square(scale - 1, x, y)).reduce(ValueRange::union).unwrap_or(range)
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::layers::{LayerId, RasterSource, Threat, ThreatLaw};
    use crate::raster::{Raster, Tile, TilePlace};

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
                    LayerKind::Paint(Quantity::Risk)
                }
                1 => LayerKind::risk(Formula::parse("x*y+0.3*sin(9*x)").unwrap()),
                2 => {
                    let values =
                        (0..60).map(|_| if random.u32(..5) == 0 { f32::NAN } else { random.f32() }).collect();
                    let bounds = Rect::new(dvec2(0.1, 0.2), dvec2(0.8, 0.9));
                    let raster = RasterPyramid::new(Raster::from_values(bounds, [10, 6], values)).into();
                    let source = RasterSource { name: String::new(), raster };
                    LayerKind::Raster { source, reading: RasterReading::Risk }
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
            let asks = !matches!(layer.kind, LayerKind::Paint(_) | LayerKind::Threats(_)) || risk > 0.0;
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
        let kind = LayerKind::Raster { source, reading: RasterReading::Risk };
        let field = RiskField::new(&Layer::stack([kind]), PaintLayers::blank());
        assert_eq!(field.at(dvec2(0.5, 0.5)), 0.25);
        assert_eq!(field.at(dvec2(0.4, 0.5)), 0.75);
        let line = Rect::new(dvec2(0.5, 0.1), dvec2(0.5, 0.9));
        assert_eq!(field.range(&line), Bounds::new(0.25, 0.75));
    }

    #[test]
    fn a_raster_far_from_a_rectangle_has_no_risk_there() {
        for (bounds, at) in [
            (Rect::new(DVec2::ZERO, DVec2::splat(1e-9)), dvec2(10.0, -10.0)),
            (Rect::new(DVec2::ZERO, DVec2::splat(1e-30)), dvec2(1.0, 0.0)),
        ] {
            let raster = RasterPyramid::new(Raster::from_values(bounds, [2, 2], vec![0.75; 4]));
            let source = RasterSource { name: String::new(), raster: raster.into() };
            let kind = LayerKind::Raster { source, reading: RasterReading::Risk };
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
            LayerKind::Paint(Quantity::Diameter),
        ]);
        assert_eq!(RiskField::new(&stack, PaintLayers::blank()).at(dvec2(0.5, 0.5)), 0.25);
        assert!(RiskField::new(&stack[..1], PaintLayers::blank()).is_empty());
    }
}
