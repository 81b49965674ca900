//! Target diameters from the depth of water, as models of coasts ask for them.
//!
//! Depths and lengths are in metres, and so are the world units of a document with such a layer.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec2;

use super::{Combine, RasterSource};
use crate::earth::{Ground, Projection};
use crate::raster::{Raster, RasterPyramid};

/// The acceleration of gravity, in m/s².
const GRAVITY: f64 = 9.81;
/// Least depth that counts in a formula, in metres: the formulas are for water, and end at the shore.
const LEAST_DEPTH: f64 = 1.0;
/// Steps of Newton's method for the length of a wave: more change nothing.
const NEWTON_STEPS: u32 = 6;

/// The direction in which the values of a raster grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositiveDepth {
    /// Values are heights: water is below 0.
    Up,
    /// Values are depths: water is above 0.
    Down,
}

/// How the depth decides the target diameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthRule {
    /// It does not: the depths are only for the nodes of files.
    Nothing,
    /// A number of triangles in the length of a wave, which follows from its period by the dispersion
    /// relation ω² = g κ tanh(κ H).
    Wavelength {
        /// The period of the wave, in seconds.
        period: f64,
        /// Triangles in the length of a wave.
        triangles: f64,
    },
    /// A number of triangles in the topographic length 2π H / |∇z|. In the plane of a projection, slopes are
    /// those on the ground.
    Slope {
        /// Triangles in that length.
        triangles: f64,
        /// The side of the square over which heights are averaged first, in metres; 0 for none.
        smoothing: f64,
    },
    /// The distance that a wave of 1 m travels in a time step, by the Courant number: u Δt / C, with
    /// u = √(g H) + √(g / H). A floor asks for twice that ([`DepthRule::factor_in`]).
    Courant {
        /// The time step, in seconds.
        time_step: f64,
        /// The Courant number.
        number: f64,
    },
}

/// What is asked of depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthSizes {
    /// The direction in which the values of the raster grow.
    pub positive: PositiveDepth,
    /// What is added to depths, in metres: where the zero of the values is not that of the others, as in a
    /// chart of depths below low water.
    pub offset: f64,
    /// The least and the greatest depth at which something is asked for, in metres. Land asks for nothing.
    pub between: [f64; 2],
    /// How the depth decides the target diameter.
    pub rule: DepthRule,
}

/// A raster of depths, and what is asked of them. Clones share the pixels.
#[derive(Clone, Debug)]
pub struct Depths {
    source: RasterSource,
    sizes: DepthSizes,
    /// The projection in whose plane the pixels lie, if they do. In a document it is that of its domain.
    projection: Option<Box<Projection>>,
    /// The topographic length by 2π, for [`DepthRule::Slope`].
    lengths: Option<Arc<RasterPyramid>>,
}

impl PartialEq for Depths {
    fn eq(&self, other: &Self) -> bool {
        self.sizes == other.sizes && self.source == other.source
    }
}

/// Why numbers cannot be asked of depths: the name of the number, and the rule for it.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("The {name} is {value}; it must be {rule}.")]
pub struct DepthError {
    /// The name of the number.
    pub name: &'static str,
    /// The number as it was given.
    pub value: f64,
    /// The rule.
    pub rule: &'static str,
}

impl DepthRule {
    /// Thirty triangles in the length of the semidiurnal lunar tide (M2).
    pub const DEFAULT_WAVELENGTH: Self = Self::Wavelength { period: 44_712.0, triangles: 30.0 };

    /// Returns the factor of the diameters in a layer that is combined in this way.
    ///
    /// A solver needs the Courant number kept along edges. A triangle whose diameter is just above a floor is
    /// bisected, and the shortest edges of its halves are half as long: so a floor for a Courant number is
    /// twice the distance that a wave travels.
    pub(super) fn factor_in(self, combine: Combine) -> f64 {
        match (self, combine) {
            (Self::Courant { .. }, Combine::Floor) => 2.0,
            _ => 1.0,
        }
    }
}

/// Returns the speed of a wave of 1 m, in m/s, at a depth of water in metres: u = √(g H) + √(g / H).
pub(super) fn wave_speed(depth: f64) -> f64 {
    let depth = depth.max(LEAST_DEPTH);
    libm::sqrt(GRAVITY * depth) + libm::sqrt(GRAVITY / depth)
}

impl DepthSizes {
    /// The least and the greatest depth where all water counts.
    pub const ALL_WATER: [f64; 2] = [0.0, f64::INFINITY];

    /// Checks the numbers.
    ///
    /// # Errors
    /// Fails with the first one that cannot be used.
    pub fn check(&self) -> Result<(), DepthError> {
        let positive = |name, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(DepthError { name, value, rule: "a finite number above 0" }),
        };
        match self.rule {
            DepthRule::Nothing => {}
            DepthRule::Wavelength { period, triangles } => {
                positive("period", period)?;
                positive("number of triangles", triangles)?;
            }
            DepthRule::Slope { triangles, smoothing } => {
                positive("number of triangles", triangles)?;
                if !(smoothing >= 0.0 && smoothing.is_finite()) {
                    return Err(DepthError {
                        name: "smoothing",
                        value: smoothing,
                        rule: "0 or a finite length",
                    });
                }
            }
            DepthRule::Courant { time_step, number } => {
                positive("time step", time_step)?;
                positive("Courant number", number)?;
            }
        }
        if !self.offset.is_finite() {
            return Err(DepthError { name: "offset", value: self.offset, rule: "a finite number" });
        }
        let [least, greatest] = self.between;
        if !(least >= 0.0 && least.is_finite()) {
            return Err(DepthError { name: "least depth", value: least, rule: "0 or a finite depth" });
        }
        if greatest.is_nan() || greatest <= least {
            return Err(DepthError {
                name: "greatest depth",
                value: greatest,
                rule: "above the least depth",
            });
        }
        Ok(())
    }

    /// Returns the depth of a value of the raster.
    pub fn depth_of(&self, value: f64) -> f64 {
        let depth = match self.positive {
            PositiveDepth::Up => -value,
            PositiveDepth::Down => value,
        };
        depth + self.offset
    }

    /// Returns the target diameter at a depth of water above 0; infinite where nothing is asked for, and NaN
    /// for [`DepthRule::Slope`], where it does not follow from the depth.
    fn diameter_at(&self, depth: f64) -> f64 {
        match self.rule {
            DepthRule::Nothing => f64::INFINITY,
            DepthRule::Wavelength { period, triangles } => {
                wavelength(period, depth.max(LEAST_DEPTH)) / triangles
            }
            DepthRule::Slope { .. } => f64::NAN,
            DepthRule::Courant { time_step, number } => wave_speed(depth) * time_step / number,
        }
    }

    /// Returns whether a depth is one of water at which something is asked for.
    fn asks_at(&self, depth: f64) -> bool {
        let [least, greatest] = self.between;
        depth > 0.0 && depth >= least && depth <= greatest
    }
}

/// Returns the length of a wave, in metres, from its period in seconds and the depth in metres:
/// ω² = g κ tanh(κ H).
pub fn wavelength(period: f64, depth: f64) -> f64 {
    let omega = TAU / period;
    // x tanh x = y, with x = κ H
    let y = omega * omega * depth / GRAVITY;
    // Eckart's approximation, within 5 %.
    let mut x = y / libm::sqrt(libm::tanh(y));
    for _ in 0..NEWTON_STEPS {
        let t = libm::tanh(x);
        x -= (x * t - y) / (t + x * (1.0 - t * t));
    }
    TAU * depth / x
}

/// The least and the greatest target diameter for the values of a range, and whether any and all have one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AskedOfRange {
    pub(super) least: f64,
    pub(super) greatest: f64,
    pub(super) any: bool,
    pub(super) all: bool,
}

/// Share of a diameter by which bounds are wider than its values at both ends: far more than the rounding of
/// a formula that grows with the depth.
const SLACK: f64 = 1e-12;

impl Depths {
    /// Returns what is asked of the depths in a raster.
    pub fn new(source: RasterSource, sizes: DepthSizes) -> Self {
        Self::new_in_plane(source, sizes, None)
    }

    /// Returns what is asked of the depths in a raster in the plane of a projection, or of none.
    pub(crate) fn new_in_plane(
        source: RasterSource,
        sizes: DepthSizes,
        projection: Option<Projection>,
    ) -> Self {
        Self { source, sizes, projection: projection.map(Box::new), lengths: None }.computed_again()
    }

    /// Returns the same for pixels in the plane of another projection, or of none.
    pub fn in_plane(&self, projection: Option<Projection>) -> Self {
        let same = self.clone();
        match projection.as_ref() == self.projection.as_deref() {
            true => same,
            false => Self { projection: projection.map(Box::new), ..same }.computed_again(),
        }
    }

    /// Computes what does not follow from the depth of a pixel alone.
    fn computed_again(self) -> Self {
        let lengths = match self.sizes.rule {
            DepthRule::Slope { smoothing, .. } => {
                let heights = self.source.raster.raster();
                let ground = Ground::new(self.projection.as_deref(), &heights.bounds());
                let lengths = lengths_of_change(heights, &self.sizes, smoothing, &ground);
                Some(Arc::new(RasterPyramid::new(lengths)))
            }
            DepthRule::Nothing | DepthRule::Wavelength { .. } | DepthRule::Courant { .. } => None,
        };
        Self { lengths, ..self }
    }

    /// Returns these depths with something else asked of them.
    pub fn with_sizes(&self, sizes: DepthSizes) -> Self {
        let smoothing = |sizes: &DepthSizes| match sizes.rule {
            DepthRule::Slope { smoothing, .. } => Some(smoothing),
            _ => None,
        };
        let key = |sizes: &DepthSizes| (sizes.positive, sizes.offset, sizes.between, smoothing(sizes));
        let is_alike = key(&self.sizes) == key(&sizes);
        let depths = Self { sizes, ..self.clone() };
        if is_alike { depths } else { depths.computed_again() }
    }

    /// Returns the raster of heights or depths.
    pub fn source(&self) -> &RasterSource {
        &self.source
    }

    /// Returns what is asked of the depths.
    pub fn sizes(&self) -> &DepthSizes {
        &self.sizes
    }

    /// Returns the raster whose values decide the target diameters.
    pub(super) fn deciding(&self) -> &Arc<RasterPyramid> {
        self.lengths.as_ref().unwrap_or(&self.source.raster)
    }

    /// Returns the raster that was computed for the sizes, if there is one.
    pub(super) fn computed(&self) -> Option<&Arc<RasterPyramid>> {
        self.lengths.as_ref()
    }

    /// Returns the target diameters for finite values of [`Self::deciding`], from `least` to `greatest`,
    /// without the factor of a combination ([`DepthRule::factor_in`]).
    pub(super) fn asked(&self, least: f64, greatest: f64) -> AskedOfRange {
        if let DepthRule::Slope { triangles, .. } = self.sizes.rule {
            let [least, greatest] = [least, greatest].map(|length| TAU * length / triangles);
            return AskedOfRange { least, greatest, any: true, all: true };
        }
        let sizes = &self.sizes;
        let finite = |value: f64| value.clamp(f64::from(f32::MIN), f64::from(f32::MAX));
        let [one, other] = [least, greatest].map(|value| sizes.depth_of(finite(value)));
        let (shallow, deep) = (one.min(other), one.max(other));
        let [from, to] = sizes.between;
        let (any, all) = match sizes.rule {
            DepthRule::Nothing => (false, false),
            _ => (deep > 0.0 && deep >= from && shallow <= to, sizes.asks_at(shallow) && sizes.asks_at(deep)),
        };
        if !any {
            return AskedOfRange { least: f64::INFINITY, greatest: f64::INFINITY, any, all };
        }
        // A wave is longer, and faster, in deeper water.
        let finest = sizes.diameter_at(shallow.max(from));
        if shallow == deep {
            return AskedOfRange { least: finest, greatest: finest, any, all };
        }
        let (coarsest, slack) = (sizes.diameter_at(deep.min(to)), SLACK);
        AskedOfRange { least: finest * (1.0 - slack), greatest: coarsest * (1.0 + slack), any, all }
    }
}

/// Returns the topographic length by 2π: max(H, 1) / |∇z|, on the ground. It has no value where
/// nothing is asked for, or heights are unknown.
fn lengths_of_change(heights: &Raster, sizes: &DepthSizes, smoothing: f64, ground: &Ground) -> Raster {
    let smoothed = smoothed(heights, smoothing, ground);
    let [columns, rows] = heights.size();
    let pixel = heights.pixel_size();
    let at = |x: u32, y: u32| f64::from(smoothed[(y * columns) as usize + x as usize]);
    // Between the neighbours on both sides, or on one where the other has no value.
    let slope = |here: f64, before: Option<f64>, after: Option<f64>, side: f64| match (before, after) {
        (Some(before), Some(after)) => (after - before) / (2.0 * side),
        (Some(before), None) => (here - before) / side,
        (None, Some(after)) => (after - here) / side,
        (None, None) => 0.0,
    };
    let known = |value: f64| (!value.is_nan()).then_some(value);
    let mut lengths = Raster::filled(heights.bounds(), heights.size(), f32::NAN);
    for (x, y) in heights.all().pixels() {
        let (here, depth) = (at(x, y), sizes.depth_of(f64::from(heights.get(x, y))));
        if here.is_nan() || !sizes.asks_at(depth) {
            continue;
        }
        let neighbour = |is_there: bool, x: u32, y: u32| if is_there { known(at(x, y)) } else { None };
        let along_x = slope(
            here,
            neighbour(x > 0, x.wrapping_sub(1), y),
            neighbour(x + 1 < columns, x + 1, y),
            pixel.x,
        );
        let along_y =
            slope(here, neighbour(y > 0, x, y.wrapping_sub(1)), neighbour(y + 1 < rows, x, y + 1), pixel.y);
        let in_plane = depth.max(LEAST_DEPTH) / DVec2::new(along_x, along_y).length();
        let length = in_plane * ground.inverse_scale_at(heights.pixel_center(x, y));
        // Flat ground asks for nothing.
        if length < f64::from(f32::MAX) {
            lengths.set(x, y, length as f32);
        }
    }
    lengths
}

/// Returns the values, each averaged over the square of this side around it, of pixels that have a value. The
/// side is a length on the ground.
fn smoothed(heights: &Raster, side: f64, ground: &Ground) -> Vec<f32> {
    if side == 0.0 {
        return heights.values().to_vec();
    }
    let [columns, rows] = heights.size().map(|side| side as usize);
    let pixel = heights.pixel_size().to_array();
    let reach = |axis: usize| {
        move |entry: usize| {
            let center = heights.pixel_center((entry % columns) as u32, (entry / columns) as u32);
            (0.5 * side / (pixel[axis] * ground.inverse_scale_at(center))).floor() as usize
        }
    };
    let known = |&value: &f32| if value.is_nan() { [0.0; 2] } else { [f64::from(value), 1.0] };
    let sums: Vec<[f64; 2]> = heights.values().iter().map(known).collect();
    let sums = window_sums(&sums, [columns, rows], reach(0), [1, columns]);
    let sums = window_sums(&sums, [rows, columns], reach(1), [columns, 1]);
    let mean = |(value, [sum, count]): (&f32, &[f64; 2])| {
        if value.is_nan() { f32::NAN } else { (sum / count) as f32 }
    };
    heights.values().iter().zip(&sums).map(mean).collect()
}

/// Returns the sums over windows of `2 reach + 1` entries along lines of values, with a reach of each entry.
/// There are `[length, lines]` entries; `steps` lead from one entry of a line to the next, and from one line
/// to the next.
fn window_sums(
    values: &[[f64; 2]],
    [length, lines]: [usize; 2],
    reach: impl Fn(usize) -> usize,
    [step, line_step]: [usize; 2],
) -> Vec<[f64; 2]> {
    let mut sums = vec![[0.0; 2]; values.len()];
    let mut before = vec![[0.0; 2]; length + 1];
    for line in 0..lines {
        for n in 0..length {
            let [value, count] = values[line * line_step + n * step];
            before[n + 1] = [before[n][0] + value, before[n][1] + count];
        }
        for n in 0..length {
            let entry = line * line_step + n * step;
            let reach = reach(entry).min(length);
            let (from, to) = (n.saturating_sub(reach), (n + reach + 1).min(length));
            sums[entry] = [before[to][0] - before[from][0], before[to][1] - before[from][1]];
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;

    fn depths(values: Vec<f32>, size: [u32; 2], sizes: DepthSizes) -> Depths {
        let bounds = Rect::new(DVec2::ZERO, 100.0 * DVec2::new(f64::from(size[0]), f64::from(size[1])));
        let raster = Arc::new(RasterPyramid::new(Raster::from_values(bounds, size, values)));
        Depths::new(RasterSource { name: "depth.asc".into(), raster }, sizes)
    }

    fn sizes(positive: PositiveDepth, rule: DepthRule) -> DepthSizes {
        DepthSizes { positive, offset: 0.0, between: DepthSizes::ALL_WATER, rule }
    }

    #[test]
    fn a_wave_has_the_length_of_the_dispersion_relation() {
        let mut random = fastrand::Rng::with_seed(2);
        for _ in 0..20_000 {
            let period = libm::pow(10.0, 5.0 * random.f64());
            let depth = libm::pow(10.0, 4.0 * random.f64());
            let wave_number = TAU / wavelength(period, depth);
            let (omega, left) = (TAU / period, GRAVITY * wave_number * libm::tanh(wave_number * depth));
            assert!((left / (omega * omega) - 1.0).abs() < 1e-12, "{period} s in {depth} m");
        }
        // Tides are long: T √(g H). Waves of 10 s are short in deep water: g T² / 2π.
        let tide = 12.42 * 3600.0;
        assert!((wavelength(tide, 100.0) / (tide * (GRAVITY * 100.0f64).sqrt()) - 1.0).abs() < 1e-5);
        assert!((wavelength(10.0, 4000.0) / (GRAVITY * 100.0 / TAU) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn bounds_hold_what_every_value_asks_for() {
        let mut random = fastrand::Rng::with_seed(4);
        let rules = [
            DepthRule::Wavelength { period: 12.0, triangles: 7.0 },
            DepthRule::Wavelength { period: 44_712.0, triangles: 30.0 },
            DepthRule::Courant { time_step: 2.0, number: 0.5 },
            DepthRule::Nothing,
        ];
        for round in 0..4000 {
            let positive = if random.bool() { PositiveDepth::Up } else { PositiveDepth::Down };
            let between = if random.bool() { DepthSizes::ALL_WATER } else { [5.0, 30.0] };
            let offset = [0.0, 3.5, -8.0][round % 3];
            let sizes = DepthSizes { offset, between, ..sizes(positive, rules[round % 4]) };
            let depths = depths(vec![0.0], [1, 1], sizes);
            let low = 80.0 * random.f64() - 40.0;
            let high = low + [0.0, 1e-6, 5.0, 60.0][random.usize(..4)] * random.f64();
            let range = depths.asked(low, high);
            let (mut any, mut all) = (false, true);
            for n in 0..=50 {
                let value = (low + (high - low) * f64::from(n) / 50.0).clamp(low, high);
                let one = depths.asked(value, value);
                let depth = offset + if positive == PositiveDepth::Up { -value } else { value };
                let is_asked = depth > 0.0 && depth >= between[0] && depth <= between[1];
                assert_eq!(one.any, is_asked && rules[round % 4] != DepthRule::Nothing);
                assert_eq!(one.any, one.all);
                if one.any {
                    assert!(range.least <= one.least && one.greatest <= range.greatest, "{value}: {range:?}");
                }
                (any, all) = (any | one.any, all & one.all);
            }
            assert!((!any || range.any) && (!range.all || all), "{low} to {high}: {range:?}");
        }
    }

    #[test]
    fn a_slope_asks_for_the_length_in_which_the_depth_changes_by_itself() {
        // 2 m deeper with each pixel of 100 m, from 30 m on.
        let values: Vec<f32> = (0..20 * 9).map(|n| -30.0 - 2.0 * (n % 20) as f32).collect();
        for smoothing in [0.0, 500.0] {
            let rule = DepthRule::Slope { triangles: 10.0, smoothing };
            let depths = depths(values.clone(), [20, 9], sizes(PositiveDepth::Up, rule));
            for column in 4..15 {
                let length = depths.deciding().raster().get(column, 4);
                let expected = (30.0 + 2.0 * f64::from(column)) / 0.02;
                assert!((f64::from(length) / expected - 1.0).abs() < 1e-5, "{length} of {expected}");
                let asked = depths.asked(f64::from(length), f64::from(length));
                assert!((asked.least / (TAU * expected / 10.0) - 1.0).abs() < 1e-5);
            }
        }
    }

    /// On a chart in Mercator lengths at 60° N are twice those on the ground, so slopes look half as steep.
    #[test]
    fn slopes_in_the_plane_of_a_projection_are_those_on_the_ground() {
        let projection: Projection = "+proj=merc +lon_0=0".parse().unwrap();
        let corner = projection.plane_from_geographic(DVec2::new(0.0, 60.0));
        let bounds = Rect::new(corner, corner + DVec2::splat(40_000.0));
        let heights: Vec<f32> = (0..40 * 40).map(|n| -30.0 - 2.0 * (n % 40) as f32).collect();
        let raster = Arc::new(RasterPyramid::new(Raster::from_values(bounds, [40, 40], heights)));
        for (smoothing, rows) in [(0.0, 0..40), (9000.0, 12..28)] {
            let sizes = sizes(PositiveDepth::Up, DepthRule::Slope { triangles: 10.0, smoothing });
            let plane = Depths::new(RasterSource { name: "chart".into(), raster: raster.clone() }, sizes);
            let ground = plane.in_plane(Some(projection));
            assert_eq!(
                ground.in_plane(None).deciding().raster().values()[90],
                plane.deciding().raster().values()[90]
            );
            for row in rows {
                let at = projection.geographic_from_plane(raster.raster().pixel_center(20, row));
                // The radius of a parallel of the ellipsoid is that of the equator by the scale.
                let (sine, cosine) = at.y.to_radians().sin_cos();
                let scale = (1.0 - 6.694_379_990_141_317e-3 * sine * sine).sqrt() / cosine;
                let expected = (30.0 + 2.0 * 20.0) / (2.0 / (1000.0 / scale));
                let found = f64::from(ground.deciding().raster().get(20, row));
                assert!((1.99..2.1).contains(&scale), "{scale}");
                assert!((found / expected - 1.0).abs() < 1e-4, "{found} of {expected} in row {row}");
            }
        }
    }

    #[test]
    fn averages_are_those_of_all_pixels_in_the_square() {
        let mut random = fastrand::Rng::with_seed(9);
        let size = [23, 17];
        let values: Vec<f32> =
            (0..23 * 17).map(|_| if random.u8(..8) == 0 { f32::NAN } else { random.f32() * 100.0 }).collect();
        let bounds = Rect::new(DVec2::ZERO, DVec2::new(2300.0, 850.0));
        let raster = Raster::from_values(bounds, size, values);
        let found = smoothed(&raster, 500.0, &Ground::default());
        for (x, y) in raster.all().pixels() {
            let near = |(u, v): &(u32, u32)| u.abs_diff(x) <= 2 && v.abs_diff(y) <= 5;
            let known = raster.all().pixels().filter(near).map(|(u, v)| raster.get(u, v));
            let known: Vec<f64> = known.filter(|value| !value.is_nan()).map(f64::from).collect();
            let mean = known.iter().sum::<f64>() / known.len() as f64;
            let value = found[(y * 23 + x) as usize];
            assert_eq!(value.is_nan(), raster.get(x, y).is_nan());
            assert!(value.is_nan() || (f64::from(value) - mean).abs() < 1e-4, "{value} of {mean}");
        }
    }

    #[test]
    fn numbers_that_cannot_be_used_are_named() {
        let of = |rule| sizes(PositiveDepth::Up, rule).check().map_err(|error| error.name);
        assert_eq!(of(DepthRule::Wavelength { period: 0.0, triangles: 2.0 }), Err("period"));
        assert_eq!(of(DepthRule::Courant { time_step: 1.0, number: f64::NAN }), Err("Courant number"));
        assert_eq!(of(DepthRule::Slope { triangles: 1.0, smoothing: -1.0 }), Err("smoothing"));
        assert_eq!(of(DepthRule::Nothing), Ok(()));
        let band = DepthSizes { between: [30.0, 5.0], ..sizes(PositiveDepth::Up, DepthRule::Nothing) };
        assert_eq!(band.check().unwrap_err().name, "greatest depth");
    }
}
