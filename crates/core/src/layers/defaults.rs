//! Layers as they are added: with numbers that suit their data and the limits of h̄.

use crate::layers::{BandLayer, DistanceLayer, RasterLayer};
use std::sync::Arc;

use super::{
    DepthRule, DepthSizes, Depths, DistanceTo, FeatureSize, FineAt, LayerKind, MedialAxis, MedialBalls,
    PositiveDepth, RasterReading, RasterSource, Shapes, Straits, Surface, SurfaceGoal, SurfaceNorm,
    SurfaceSource, ValueCurve,
};
use crate::field::{Formula, Transfer};
use crate::geometry::Rect;
use crate::text::round_below;

impl LayerKind {
    /// Returns a band of the middle third of a raster's values, with the geometric mean of `h_min` and
    /// `h_max` as its diameter. `None` if no pixel has a finite value.
    pub fn band_of(source: RasterSource, transfer: &Transfer) -> Option<Self> {
        let range = source.raster.finite_range()?;
        let [least, greatest] = [range.least, range.greatest].map(f64::from);
        let third = (greatest - least) / 3.0;
        let diameter = (transfer.h_min * transfer.h_max).sqrt();
        Some(Self::Band(BandLayer { source, between: [least + third, greatest - third], diameter }))
    }

    /// Returns a raster through a curve that is finest where its values are nearest to 0, as in shallow
    /// water. `None` if no pixel has a finite value.
    pub fn curve_of(source: RasterSource, transfer: &Transfer) -> Option<Self> {
        let values = source.raster.sorted_sample();
        let curve = ValueCurve::fine_at(FineAt::Zero, &values, transfer.h_min, transfer.h_max)?;
        Some(Self::Raster(RasterLayer { source, reading: RasterReading::Curve(Arc::new(curve)) }))
    }

    /// Returns depths that ask for thirty triangles in the length of a tide. Values are depths where none is
    /// below 0, and else heights. `None` if no pixel has a finite value.
    pub fn depths_of(source: RasterSource, _: &Transfer) -> Option<Self> {
        Self::depths(source, DepthRule::DEFAULT_WAVELENGTH)
    }

    /// Returns depths as [`Self::depths_of`] does, which ask for nothing.
    pub fn depths_without_sizes(source: RasterSource, _: &Transfer) -> Option<Self> {
        Self::depths(source, DepthRule::Nothing)
    }

    /// Returns the surface of a raster, within a hundredth of the range of its values. `None` if no pixel has
    /// a finite value.
    pub fn surface_of(source: RasterSource, _: &Transfer) -> Option<Self> {
        let goal = SurfaceGoal::Within(Self::default_error(&source)?);
        Some(Self::Surface(Surface {
            source: SurfaceSource::Raster(source),
            goal,
            norm: SurfaceNorm::default(),
        }))
    }

    /// Returns about a hundredth of the range of the values of a raster, as a round number. `None` if no
    /// pixel has a finite value.
    pub fn default_error(source: &RasterSource) -> Option<f64> {
        let range = source.raster.finite_range()?;
        let hundredth = 0.01 * (f64::from(range.greatest) - f64::from(range.least));
        Some(if hundredth > 0.0 { round_below(hundredth) } else { 1.0 })
    }

    /// Returns a hill in the middle of a domain as a surface, within a hundredth of its height.
    pub fn default_surface(bounds: &Rect) -> Self {
        let (at, width) = (bounds.center(), round_below(0.25 * bounds.size().min_element()));
        let text = format!("exp(-((x - {})^2 + (y - {})^2) / {width}^2)", at.x, at.y);
        let formula = Formula::parse(&text).unwrap_or_else(|_| Formula::constant_of(0.0));
        let (source, goal) = (SurfaceSource::Formula(formula), SurfaceGoal::Within(0.01));
        Self::Surface(Surface { source, goal, norm: SurfaceNorm::default() })
    }

    fn depths(source: RasterSource, rule: DepthRule) -> Option<Self> {
        let has_heights = source.raster.finite_range()?.least < 0.0;
        let positive = if has_heights { PositiveDepth::Up } else { PositiveDepth::Down };
        let sizes = DepthSizes { positive, offset: 0.0, between: DepthSizes::ALL_WATER, rule };
        Some(Self::Depth(Depths::new(source, sizes)))
    }

    /// Returns four triangles across straits, which are not looked for yet: those that are as wide as four
    /// triangles of some diameter.
    pub fn straits(transfer: &Transfer) -> Self {
        const ACROSS: f64 = 4.0;
        let between = [transfer.h_min, transfer.h_max].map(|diameter| ACROSS * diameter);
        Self::Straits(Straits { across: ACROSS, found: MedialBalls::unknown(between) })
    }

    /// Returns three triangles across the water, whose middle is not looked for yet: where it is as wide as
    /// three triangles of some diameter.
    pub fn feature_size(transfer: &Transfer) -> Self {
        const ACROSS: f64 = 3.0;
        let between = [transfer.h_min, transfer.h_max].map(|diameter| ACROSS * diameter);
        Self::FeatureSize(FeatureSize { across: ACROSS, found: MedialAxis::unknown(between) })
    }

    /// `h_min` at distance 0, growing by `slope` per unit of length without an end.
    pub fn distance_to(to: DistanceTo, transfer: &Transfer, slope: f64) -> Self {
        Self::Distance(DistanceLayer { to, at_zero: transfer.h_min, slope, range: f64::INFINITY })
    }

    /// Returns a corridor along lines through a domain of this extent, in world units: a fiftieth of it wide.
    pub fn corridor(lines: Shapes, extent: f64, transfer: &Transfer, slope: f64) -> Self {
        Self::distance_to(DistanceTo::Corridor { lines, width: 0.02 * extent }, transfer, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;
    use crate::raster::{Raster, RasterPyramid};

    const TRANSFER: Transfer = Transfer::between(0.01, 0.16);

    fn source(values: [f32; 4]) -> RasterSource {
        let raster = Raster::from_values(Rect::UNIT, [2, 2], values.to_vec());
        RasterSource { name: "depth.asc".into(), raster: Arc::new(RasterPyramid::new(raster)) }
    }

    #[test]
    fn a_band_holds_the_middle_third_of_the_finite_values() {
        let of = |values| LayerKind::band_of(source(values), &TRANSFER);
        let Some(LayerKind::Band(BandLayer { between, diameter, .. })) =
            of([-30.0, f32::NAN, 60.0, f32::INFINITY])
        else {
            panic!("a band")
        };
        assert!((diameter - 0.04).abs() < 1e-15, "{diameter}");
        assert_eq!(between, [0.0, 30.0]);
        let Some(LayerKind::Band(BandLayer { between, .. })) = of([5.0; 4]) else { panic!("a band") };
        assert_eq!(between, [5.0, 5.0], "one value");
        assert_eq!(of([f32::NAN, f32::NAN, f32::INFINITY, f32::NEG_INFINITY]), None);
    }

    #[test]
    fn a_curve_spans_the_finite_values_and_is_finest_near_0() {
        let knots = |values| match LayerKind::curve_of(source(values), &TRANSFER)? {
            LayerKind::Raster(RasterLayer { reading: RasterReading::Curve(curve), .. }) => {
                Some(curve.knots().to_vec())
            }
            other => panic!("{other:?}"),
        };
        let shore = vec![[-30.0, 0.16], [0.0, 0.01], [60.0, 0.16]];
        assert_eq!(knots([-30.0, f32::NAN, 60.0, f32::INFINITY]), Some(shore));
        assert_eq!(knots([5.0; 4]), Some(vec![[5.0, 0.01]]));
        assert_eq!(knots([f32::NAN; 4]), None);
    }
}
