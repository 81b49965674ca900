//! Depths of water and surfaces at the pixels of a picture: as a shaded relief with isobaths or contour
//! lines, and how far a mesh is from them.

use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::Range;

use glam::{DVec2, dvec2};

use crate::geometry::Rect;
use crate::layers::DepthSurface;
use crate::mesh::{MeshView, Progress};
use crate::pixels::values_by_pixel;
use crate::raster::{PixelRect, Raster};
use crate::surface::{SurfaceFit, SurfaceRule};

/// About how many isobaths there are from the shore to the deepest place.
const ISOBATHS: f64 = 10.0;
/// How high the deepest place would be drawn above a map, as a share of its longer side.
const RELIEF: f64 = 0.08;
/// The direction to the light, east, north and up: from the north-west.
const LIGHT: [f64; 3] = [-0.5, 0.5, FRAC_1_SQRT_2];
/// Depth that counts as least in relative differences, in metres.
const LEAST_DEPTH: f64 = 10.0;

/// A surface of depths, or of heights, at the pixels of a picture.
#[derive(Clone, Debug)]
pub struct Relief {
    /// Depths in metres, positive downwards; NaN without one.
    depths: Raster,
    /// Metres between isobaths.
    interval: f64,
    /// The depth from which on there are isobaths: the shore, or any height.
    first_isobath: f64,
    /// World units up in the relief for each metre.
    exaggeration: f64,
}

/// A relief whose surface is sampled row by row, from the lowest.
#[derive(Clone, Debug)]
pub struct ReliefSampling {
    relief: Relief,
    /// How many rows are sampled.
    rows: u32,
    /// 1 for depths, -1 for heights.
    sign: f64,
}

impl ReliefSampling {
    fn new(
        (deepest, first_isobath): (f64, f64),
        domain: Rect,
        (bounds, size): (Rect, [u32; 2]),
        sign: f64,
    ) -> Self {
        let deepest = deepest.max(f64::MIN_POSITIVE);
        let relief = Relief {
            depths: Raster::filled(bounds, size, f32::NAN),
            interval: isobath_interval(deepest),
            first_isobath,
            exaggeration: RELIEF * domain.size().max_element() / deepest,
        };
        Self { relief, rows: 0, sign }
    }

    /// Samples `rows` more rows of the surface of the relief. Returns whether there are more.
    pub fn advance(&mut self, rows: u32, value_at: impl Fn(DVec2) -> Option<f64>) -> Progress {
        let depths = &mut self.relief.depths;
        let ([columns, all], centers) = (depths.size(), depths.pixel_centers());
        let end = self.rows.saturating_add(rows.max(1)).min(all);
        for (x, y) in (PixelRect { min: [0, self.rows], max: [columns, end] }).pixels() {
            if let Some(value) = value_at(centers(x, y)) {
                depths.set(x, y, (self.sign * value) as f32);
            }
        }
        self.rows = end;
        if end < all { Progress::More } else { Progress::Done }
    }

    /// Returns the relief, once all rows are sampled.
    pub fn finish(self) -> Relief {
        self.relief
    }
}

/// What a pixel of a relief shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefPixel {
    /// The depth in metres, positive downwards.
    pub depth: f32,
    /// The light on it: 1 where the ground is level, 0 in full shade, up to 1.4.
    pub light: f32,
    /// Whether an isobath runs through it.
    pub is_isobath: bool,
}

impl Relief {
    /// Begins the relief of a surface of depths over `bounds` in world units; `size` is [columns, rows].
    /// `domain` is all that the relief could be drawn of: it says how steep the ground is drawn.
    pub fn from_depths(surface: &DepthSurface, domain: Rect, pixels: (Rect, [u32; 2])) -> ReliefSampling {
        ReliefSampling::new((surface.deepest(), 0.0), domain, pixels, 1.0)
    }

    /// Begins the relief of a surface of heights, as [`Self::from_depths`]: depths are minus the heights, and
    /// isobaths are contour lines. `rise` is the difference of the greatest and the least height.
    pub fn from_heights(rise: f64, domain: Rect, pixels: (Rect, [u32; 2])) -> ReliefSampling {
        ReliefSampling::new((rise, f64::NEG_INFINITY), domain, pixels, -1.0)
    }

    /// Returns the pixels of some rows, row by row from the lowest; `None` for those without a depth.
    pub fn rows(&self, rows: Range<u32>) -> impl Iterator<Item = Option<ReliefPixel>> + '_ {
        let [columns, all] = self.depths.size();
        let rows = PixelRect { min: [0, rows.start], max: [columns, rows.end.min(all)] };
        rows.pixels().map(|(x, y)| {
            let depth = self.depths.get(x, y);
            (!depth.is_nan()).then(|| ReliefPixel {
                depth,
                light: self.light(x, y) as f32,
                is_isobath: self.is_isobath(x, y),
            })
        })
    }

    /// Returns the light on a pixel, by the slope to its neighbours.
    fn light(&self, x: u32, y: u32) -> f64 {
        let pixel = self.depths.pixel_size();
        let here = f64::from(self.depths.get(x, y));
        let at = |dx: i64, dy: i64| {
            self.depths.known(i64::from(x) + dx, i64::from(y) + dy).map_or(here, f64::from)
        };
        // Heights, so that depths count against them.
        let rise = 0.5 * self.exaggeration * dvec2(at(-1, 0) - at(1, 0), at(0, -1) - at(0, 1));
        let slope = rise / pixel;
        let [east, north, up] = LIGHT;
        let facing = (up - slope.x * east - slope.y * north) / (1.0 + slope.length_squared()).sqrt();
        (facing / up).max(0.0)
    }

    /// Returns whether an isobath runs between a pixel and the one to its right or above it. That of depth 0
    /// is the shore.
    fn is_isobath(&self, x: u32, y: u32) -> bool {
        let band = |depth: f32| (f64::from(depth) / self.interval).floor();
        let here = band(self.depths.get(x, y));
        let beside = [(1, 0), (0, 1)].map(|(dx, dy)| self.depths.known(i64::from(x) + dx, i64::from(y) + dy));
        beside
            .into_iter()
            .flatten()
            .any(|depth| band(depth) != here && band(depth).max(here) >= self.first_isobath)
    }
}

/// Returns the metres between isobaths of a sea: 1, 2 or 5 times a power of ten.
pub fn isobath_interval(deepest: f64) -> f64 {
    let about = deepest / ISOBATHS;
    let power = libm::pow(10.0, libm::log10(about).floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    let off = |step: f64| libm::log(step / about).abs();
    steps.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(power)
}

/// Returns how much deeper a mesh is than the surface at the pixels over `bounds`, as a share of the depth
/// there, or of 10 m where it is less; NaN beyond the mesh, and without a depth. `depths` are those at the
/// nodes of the mesh. `None` where `goes_on` says that nobody wants it any more.
pub fn depth_differences(
    mesh: MeshView,
    depths: &[f64],
    surface: &DepthSurface,
    pixels: (Rect, [u32; 2]),
    goes_on: &dyn Fn() -> bool,
) -> Option<Raster> {
    let share = |at, of_mesh: f64| {
        let depth = surface.depth_at(at)?;
        Some((of_mesh - depth) / depth.abs().max(LEAST_DEPTH))
    };
    differences(mesh, |node| depths[node], share, pixels, goes_on)
}

/// Returns how much higher a mesh is than surfaces at the pixels over `bounds`, as a share of the difference
/// that is allowed there, or of the largest one where the error of the surface is another one; NaN beyond the
/// mesh, and without a surface. `None` where `goes_on` says that nobody wants it any more.
pub fn surface_differences(
    mesh: MeshView,
    fit: &SurfaceFit,
    rule: &SurfaceRule,
    pixels: (Rect, [u32; 2]),
    goes_on: &dyn Fn() -> bool,
) -> Option<Raster> {
    let share = |at, of_mesh: f64| {
        let (height, allowed) = rule.allowed_at(at)?;
        Some((of_mesh - height) / if allowed.is_finite() { allowed } else { fit.largest })
    };
    differences(mesh, |node| fit.heights[node].unwrap_or(f64::NAN), share, pixels, goes_on)
}

/// Returns `difference` of the place of each pixel and the value of the mesh there; NaN where there is none.
fn differences(
    mesh: MeshView,
    at_node: impl Fn(usize) -> f64,
    difference: impl Fn(DVec2, f64) -> Option<f64>,
    pixels: (Rect, [u32; 2]),
    goes_on: &dyn Fn() -> bool,
) -> Option<Raster> {
    values_by_pixel(mesh, pixels, goes_on, |number, at, weights| {
        let nodes = mesh.triangles()[number].vertices;
        let of_mesh = (0..3).map(|n| weights[n] * at_node(nodes[n].index())).sum();
        difference(at, of_mesh)
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::field::{Formula, RefinementRule};
    use crate::fixture;
    use crate::layers::{
        DepthRule, DepthSizes, Depths, Layer, LayerKind, NodeDepths, PositiveDepth, RasterSource, Surface,
        SurfaceGoal, SurfaceNorm, SurfaceSource,
    };
    use crate::mesh::Limits;
    use crate::raster::RasterPyramid;

    /// Returns a stack with depths over the unit square, in 100 × 100 pixels.
    fn depths(depth: impl Fn(DVec2) -> f64) -> Vec<Layer> {
        let mut raster = Raster::filled(Rect::UNIT, [100, 100], 0.0_f32);
        for (x, y) in raster.all().pixels() {
            let at = raster.pixel_center(x, y);
            raster.set(x, y, depth(at) as f32);
        }
        let source = RasterSource { name: "depth.asc".into(), raster: Arc::new(RasterPyramid::new(raster)) };
        let sizes = DepthSizes {
            positive: PositiveDepth::Down,
            offset: 0.0,
            rule: DepthRule::Nothing,
            between: DepthSizes::ALL_WATER,
        };
        Layer::stack([Depths::new(source, sizes)])
    }

    fn relief(layers: &[Layer]) -> Relief {
        let surface = DepthSurface::of(layers).unwrap();
        let sampling = Relief::from_depths(&surface, Rect::UNIT, (Rect::UNIT, [200; 2]));
        sampled(sampling, |point| surface.depth_at(point))
    }

    /// Returns a relief that is sampled in steps of different sizes.
    fn sampled(mut sampling: ReliefSampling, value_at: impl Fn(DVec2) -> Option<f64>) -> Relief {
        let steps = (0..).take_while(|&rows| sampling.advance(rows, &value_at) == Progress::More).count();
        assert!(steps > 4, "{steps}");
        sampling.finish()
    }

    fn pixels(relief: &Relief) -> Vec<Option<ReliefPixel>> {
        [0..7, 7..8, 8..u32::MAX].into_iter().flat_map(|rows| relief.rows(rows)).collect()
    }

    #[test]
    fn slopes_to_the_north_west_are_lit_and_the_others_in_shade() {
        // A hill in a sea of 100 m.
        let layers = depths(|at| 100.0 * (1.0 - (1.0 - 2.5 * at.distance(dvec2(0.5, 0.5))).max(0.0)));
        let relief = relief(&layers);
        let pixels: Vec<ReliefPixel> = pixels(&relief).into_iter().map(Option::unwrap).collect();
        let at = |x: usize, y: usize| pixels[200 * y + x];
        assert!(at(70, 130).light > 1.05 && at(130, 70).light < 0.95, "{:?} {:?}", at(70, 130), at(130, 70));
        assert_eq!(at(5, 5), ReliefPixel { depth: 100.0, light: 1.0, is_isobath: false });
        // From the top to the west: isobaths every 10 m.
        assert_eq!(isobath_interval(100.0), 10.0);
        let crossed = (20..=100).filter(|&x| at(x, 100).is_isobath).count();
        assert!((9..=22).contains(&crossed), "{crossed}");
    }

    #[test]
    fn heights_are_lit_like_depths_and_have_contour_lines_everywhere() {
        // A hill of 100 from 30 below zero, and nothing in the east.
        let height = |at: DVec2| 100.0 * (1.0 - 2.5 * at.distance(dvec2(0.5, 0.5))).max(0.0) - 30.0;
        let height_at = |at: DVec2| (at.x < 0.9).then(|| height(at));
        let relief = sampled(Relief::from_heights(100.0, Rect::UNIT, (Rect::UNIT, [200; 2])), height_at);
        let pixels = pixels(&relief);
        let at = |x: usize, y: usize| pixels[200 * y + x].unwrap();
        assert!(pixels[199].is_none() && pixels[200 * 100 + 190].is_none());
        assert!(at(70, 130).light > 1.05 && at(130, 70).light < 0.95, "{:?} {:?}", at(70, 130), at(130, 70));
        assert_eq!(at(5, 5), ReliefPixel { depth: 30.0, light: 1.0, is_isobath: false });
        let crossed = (20..=100).filter(|&x| at(x, 100).is_isobath).count();
        assert!((9..=22).contains(&crossed), "{crossed}");
        // The shore of depths has no lines above it.
        let above = |x: &usize| at(*x, 100).is_isobath && at(*x, 100).depth < -15.0;
        assert!((20..=100).filter(above).count() > 4);
    }

    #[test]
    fn a_plane_is_lit_by_its_slope() {
        for slope in [dvec2(0.0, 0.0), dvec2(9.0, 0.0), dvec2(0.0, 9.0), dvec2(-4.0, 7.0), dvec2(8.0, -8.0)] {
            let sampling = Relief::from_heights(10.0, Rect::UNIT, (Rect::UNIT, [20; 2]));
            let relief = sampled(sampling, |at| Some(slope.dot(at)));
            let slope = relief.exaggeration * slope;
            let [east, north, up] = LIGHT;
            let light = (up - slope.x * east - slope.y * north) / (1.0 + slope.length_squared()).sqrt() / up;
            let seen = f64::from(pixels(&relief)[20 * 7 + 9].unwrap().light);
            assert!((seen - light.max(0.0)).abs() < 1e-4, "{slope}: {seen} {light}");
        }
    }

    #[test]
    fn an_isobath_is_drawn_below_it_and_to_its_left() {
        for axis in 0..2 {
            let height = |at: DVec2| Some(if at[axis] < 0.5 { -5.0 } else { -15.0 });
            let relief = sampled(Relief::from_heights(100.0, Rect::UNIT, (Rect::UNIT, [20; 2])), height);
            for (number, pixel) in pixels(&relief).into_iter().map(Option::unwrap).enumerate() {
                assert_eq!(pixel.is_isobath, [number % 20, number / 20][axis] == 9, "{axis} {number}");
            }
        }
    }

    #[test]
    fn intervals_are_1_2_or_5_times_a_power_of_ten() {
        for (deepest, interval) in [(100.0, 10.0), (7000.0, 500.0), (0.3, 0.02), (2500.0, 200.0), (9.0, 1.0)]
        {
            assert!((isobath_interval(deepest) - interval).abs() < 1e-9 * interval, "{deepest}");
        }
    }

    /// A mesh through points of a parabola lies above it everywhere, by the allowed difference at most.
    #[test]
    fn a_mesh_is_higher_than_a_parabola_by_up_to_what_is_allowed() {
        let within = SurfaceGoal::Within(0.01);
        for (norm, goal) in [
            (SurfaceNorm::Largest, within),
            (SurfaceNorm::RootMeanSquare, within),
            (SurfaceNorm::RootMeanSquare, SurfaceGoal::AtMost(500)),
        ] {
            let source = SurfaceSource::Formula(Formula::parse("100 + 3*x^2").unwrap());
            let layer = LayerKind::Surface(Surface { source, goal, norm });
            let built = fixture::built_with(Layer::stack([layer]), RefinementRule::Area, Limits::default());
            let (extract, rule) = (built.mesh.extract(), built.surface.as_ref().unwrap());
            let fit = rule.samples().fit(extract.view());
            let pixels = (Rect::UNIT, [150, 150]);
            let differences = surface_differences(extract.view(), &fit, rule, pixels, &|| true).unwrap();
            let (least, greatest) = differences
                .values()
                .iter()
                .fold((f32::MAX, f32::MIN), |(low, high), value| (low.min(*value), high.max(*value)));
            // The whole is what is allowed of each difference, or else the largest one.
            let whole = if norm == SurfaceNorm::Largest { 0.01 } else { fit.largest };
            let share = f64::from(greatest) * whole / fit.largest;
            assert!(least > -1e-3 && (0.9..1.01).contains(&share), "{norm:?} {goal:?}: {least}, {share}");
            assert!(norm != SurfaceNorm::Largest || fit.largest < 0.85 * whole, "{}", fit.largest);
            let nobody = surface_differences(extract.view(), &fit, rule, pixels, &|| false);
            assert!(nobody.is_none());
        }
    }

    #[test]
    fn a_mesh_is_as_deep_as_a_plane_and_too_shallow_in_a_trench() {
        let built = fixture::built("0.3", RefinementRule::Area, Limits::default());
        let extract = built.mesh.extract();
        let differences = |layers: &[Layer]| {
            let at_nodes = NodeDepths::of(layers, extract.view()).unwrap().unwrap();
            let surface = DepthSurface::of(layers).unwrap();
            let pixels = (Rect::UNIT, [150, 150]);
            depth_differences(extract.view(), &at_nodes.depths, &surface, pixels, &|| true).unwrap()
        };
        let plane = differences(&depths(|at| 50.0 + 20.0 * at.x - 10.0 * at.y));
        // Beside the rim, the half of the last pixels is level.
        let inner = plane.pixels_touching(&Rect::new(dvec2(0.15, 0.15), dvec2(0.85, 0.85)));
        assert!(inner.pixels().all(|(x, y)| plane.get(x, y).abs() < 1e-3));
        assert!(plane.values().iter().all(|difference| !difference.is_nan()));
        let trench = depths(|at| if (at.x - 0.54).abs() < 0.015 { 100.0 } else { 20.0 });
        let trench = differences(&trench);
        assert!(trench.get(81, 70) < -0.5, "{}", trench.get(81, 70));
    }
}
