//! Computes the cost of a polyline.

use glam::DVec2;

use super::{CostDensity, CostRange};
use crate::geometry::{Rect, gauss_mean};

/// The figures of a polyline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathFigures {
    /// The integral of the cost, as computed.
    pub cost: f64,
    /// No less than the integral of the cost.
    pub upper: f64,
    /// Length in world units.
    pub length: f64,
    /// Length on the Earth, in the plane of a projection; otherwise the same.
    pub length_on_ground: f64,
}

/// How often a piece is halved at most.
const MOST_HALVINGS: u32 = 14;

/// A model is made for a rectangle with two sides: of a segment along an axis, this share of its length is
/// added on all sides.
const THIN: f64 = 1e-3;

/// Sums and products are off by less than this share.
const ROUNDING: f64 = 1e-12;

impl PathFigures {
    /// Returns the figures of a polyline.
    ///
    /// The upper bound adds up bounds of the cost over pieces. A piece is halved until its bounds differ by
    /// less than `tolerance` times their mean, so that the upper bound is above the integral by that share at
    /// most, except where the cost jumps. It is exact where the cost has one value.
    pub fn new(points: &[DVec2], density: &dyn CostDensity, tolerance: f64) -> Self {
        let mut figures = Self::default();
        for pair in points.windows(2) {
            figures.add_piece(pair[0], pair[1], density, tolerance, MOST_HALVINGS);
        }
        figures.upper *= 1.0 + ROUNDING;
        figures.cost = figures.cost.min(figures.upper);
        figures
    }

    /// Continues to a point: adds the figures of the segment from `last`, which the point replaces.
    pub(super) fn go_on(&mut self, last: &mut DVec2, to: DVec2, density: &dyn CostDensity, tolerance: f64) {
        let Self { cost, upper, length, length_on_ground } = Self::new(&[*last, to], density, tolerance);
        self.cost += cost;
        self.upper += upper;
        self.length += length;
        self.length_on_ground += length_on_ground;
        *last = to;
    }

    fn add_piece(&mut self, p: DVec2, q: DVec2, density: &dyn CostDensity, tolerance: f64, halvings: u32) {
        let length = p.distance(q);
        let range = mean_range(p, q, density, tolerance);
        let spread = range.greatest - range.least;
        if spread <= tolerance * (range.greatest + range.least) || halvings == 0 {
            let mean = if spread > 0.0 { mean_cost(p, q, density) } else { range.greatest };
            self.cost += length * mean.clamp(range.least, range.greatest);
            self.upper += length * range.greatest;
            self.length += length;
            self.length_on_ground += length * mean_inverse_scale(p, q, density);
            return;
        }
        let middle = p.midpoint(q);
        self.add_piece(p, middle, density, tolerance, halvings - 1);
        self.add_piece(middle, q, density, tolerance, halvings - 1);
    }
}

/// The risk along a polyline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RiskAlong {
    /// The integral of the risk over the length, on the Earth where the plane lies there.
    pub integral: f64,
    /// The greatest risk at the points that were looked at.
    pub highest: f64,
    /// Where that is: its distance from the start along the polyline.
    pub highest_at: f64,
}

/// A piece along which the risk varies by more is halved.
const MOST_RISK_SPREAD: f64 = 1.0 / 128.0;
/// How often a piece is halved at most for its risk.
const MOST_RISK_HALVINGS: u32 = 10;

impl RiskAlong {
    /// Returns the risk along a polyline, however long its pieces are: where the risk does not count, a path
    /// is straight and has few points.
    pub fn new(points: &[DVec2], density: &dyn CostDensity) -> Self {
        let mut along = Self::default();
        let mut walked = 0.0;
        if let Some(&start) = points.first() {
            along.look_at(start, 0.0, density);
        }
        for pair in points.windows(2) {
            along.add_piece([pair[0], pair[1]], walked, density, MOST_RISK_HALVINGS);
            walked += pair[0].distance(pair[1]);
            along.look_at(pair[1], walked, density);
        }
        along
    }

    /// Looks at a point at a distance from the start. Returns its risk.
    fn look_at(&mut self, point: DVec2, distance: f64, density: &dyn CostDensity) -> f64 {
        let risk = density.risk_at(point);
        if risk > self.highest {
            (self.highest, self.highest_at) = (risk, distance);
        }
        risk
    }

    /// Adds a piece that begins at the distance `walked` from the start.
    fn add_piece(&mut self, [p, q]: [DVec2; 2], walked: f64, density: &dyn CostDensity, halvings: u32) {
        let middle = p.midpoint(q);
        let range = density.risk_range(&Rect::spanning(p, q));
        if range.greatest - range.least <= MOST_RISK_SPREAD || halvings == 0 {
            let risk = self.look_at(middle, walked + p.distance(middle), density);
            self.integral += p.distance(q) * risk * mean_inverse_scale(p, q, density);
            return;
        }
        self.add_piece([p, middle], walked, density, halvings - 1);
        self.add_piece([middle, q], walked + p.distance(middle), density, halvings - 1);
    }
}

/// Returns bounds of the mean of the cost over a segment, by a polynomial near the cost or by derivatives.
///
/// With the derivative along the segment between a and b, the cost at a distance t after the middle m is
/// between c(m) + a t and c(m) + b t, and before m the other way round. So the mean differs from c(m) by
/// (b − a) · length / 8 at most.
fn mean_range(p: DVec2, q: DVec2, density: &dyn CostDensity, tolerance: f64) -> CostRange {
    let rectangle = Rect::spanning(p, q);
    let range = density.range(&rectangle);
    if range.greatest - range.least <= tolerance * (range.greatest + range.least) {
        return range;
    }
    if let Some((mean, most)) = mean_of_model(p, q, &rectangle, density) {
        return within(range, mean, most);
    }
    let Some(slopes) = density.derivatives(&rectangle) else { return range };
    let way = (q - p).abs();
    // The derivative times the length.
    let spread: f64 =
        (0..2).map(|axis: usize| way[axis] * (slopes[axis].greatest - slopes[axis].least)).sum();
    let middle = density.at(p.midpoint(q));
    // The middle is rounded, and so are the bounds.
    let steepest = (0..2).map(|axis: usize| slopes[axis].greatest.abs().max(slopes[axis].least.abs()));
    let reach = p.abs().max(q.abs()).max_element();
    let rounding = ROUNDING * middle + 4.0 * f64::EPSILON * reach * steepest.sum::<f64>();
    let most = 0.125 * spread + rounding;
    if most.is_nan() || !rises_as_said(p, q, density, &slopes, rounding) {
        return range;
    }
    within(range, middle, most)
}

/// Returns the part of a range that differs from a value by at most `most`.
fn within(range: CostRange, value: f64, most: f64) -> CostRange {
    CostRange { least: range.least.max(value - most), greatest: range.greatest.min(value + most) }
}

/// Returns the mean of a polynomial of degree 2 near the cost over a segment, and a bound of how much the
/// mean of the cost differs. `None` where no such polynomial is known.
///
/// Its error is of third order in the length, that of derivatives of second order: for the same tolerance the
/// pieces are several times as long.
fn mean_of_model(p: DVec2, q: DVec2, rectangle: &Rect, density: &dyn CostDensity) -> Option<(f64, f64)> {
    let sides = rectangle.size();
    let is_thin = sides.min_element() == 0.0;
    let place = if is_thin { rectangle.expanded(THIN * sides.max_element()) } else { *rectangle };
    let model = density.model(&place)?;
    let size: f64 = model.coefficients.iter().map(|coefficient| coefficient.abs()).sum();
    // The ends of the segment are rounded by some ulps.
    let (middle, half) = (place.center(), 0.5 * place.size());
    let moved = 8.0 * f64::EPSILON * (middle.abs() + half) / half;
    let most = model.remainder + ROUNDING * (size + model.remainder) + model.steepest().dot(moved);
    (most < f64::INFINITY).then(|| (model.mean_along(0.5 * (q - p) / half), most))
}

/// Returns whether the cost rises from the middle of a segment to its ends as bounds of its derivatives say.
/// A cost that loses digits, such as `(1e15 + x) - 1e15`, is a staircase, and its derivatives are not those
/// of the formula: then they are not used.
fn rises_as_said(
    p: DVec2,
    q: DVec2,
    density: &dyn CostDensity,
    slopes: &[CostRange; 2],
    rounding: f64,
) -> bool {
    let middle = p.midpoint(q);
    let at_middle = density.at(middle);
    [p, q].into_iter().all(|end| {
        let (way, rise) = (end - middle, density.at(end) - at_middle);
        let mut said = CostRange { least: -2.0 * rounding, greatest: 2.0 * rounding };
        for axis in 0..2 {
            let [a, b] = [way[axis] * slopes[axis].least, way[axis] * slopes[axis].greatest];
            said.least += a.min(b);
            said.greatest += a.max(b);
        }
        (said.least..=said.greatest).contains(&rise)
    })
}

/// Returns the mean of the cost over a segment, by Gauss's rule with two points.
pub(super) fn mean_cost(p: DVec2, q: DVec2, density: &dyn CostDensity) -> f64 {
    gauss_mean(|share| density.at(p.lerp(q, share)))
}

/// A segment is divided until its halves change its cost by less than this share.
const CHANGE_BY_HALVES: f64 = 1e-13;
/// How often a segment is divided at most for that.
const MOST_HALVINGS_OF_SMOOTH: u32 = 10;

/// Returns the cost of a segment along which the cost density is smooth, nearly to rounding. Gauss's rule
/// over a long segment is farther off than two ways of nearly the same cost are apart.
pub(super) fn smooth_cost(p: DVec2, q: DVec2, density: &dyn CostDensity) -> f64 {
    let by_rule = |p: DVec2, q: DVec2| p.distance(q) * mean_cost(p, q, density);
    divided_cost(&by_rule, [p, q], by_rule(p, q), MOST_HALVINGS_OF_SMOOTH)
}

/// Returns the cost of a segment by a rule for its parts. `whole` is what the rule says of all of it.
fn divided_cost(
    by_rule: &impl Fn(DVec2, DVec2) -> f64,
    [p, q]: [DVec2; 2],
    whole: f64,
    halvings: u32,
) -> f64 {
    let middle = p.midpoint(q);
    let halves = [[p, middle], [middle, q]].map(|half| (half, by_rule(half[0], half[1])));
    let sum: f64 = halves.iter().map(|half| half.1).sum();
    // False for infinite costs: halves do not change them.
    let has_changed = (sum - whole).abs() > CHANGE_BY_HALVES * sum;
    if halvings == 0 || !has_changed {
        return sum;
    }
    halves.into_iter().map(|(half, cost)| divided_cost(by_rule, half, cost, halvings - 1)).sum()
}

/// Returns the mean of the inverse scale over a segment, by [Gauss's rule](mean_cost).
fn mean_inverse_scale(p: DVec2, q: DVec2, density: &dyn CostDensity) -> f64 {
    gauss_mean(|share| density.inverse_scale_at(p.lerp(q, share)))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::{CostFormula, Formula};
    use crate::layers::{Layer, LayerKind, PaintLayers, RiskField};
    use crate::path::FormulaCost;

    #[test]
    fn the_risk_along_a_path_is_its_integral() {
        let risk = Layer::stack([LayerKind::risk(Formula::parse("x^2").unwrap())]);
        let risk = RiskField::new(&risk, PaintLayers::blank());
        let cost = FormulaCost { formula: CostFormula::parse("1").unwrap(), risk };
        let along = RiskAlong::new(&[dvec2(0.0, 0.5), dvec2(1.0, 0.5)], &cost);
        assert!((along.integral - 1.0 / 3.0).abs() < 1e-4, "{along:?}");
        assert!((along.highest - 1.0).abs() < 1e-9 && (along.highest_at - 1.0).abs() < 1e-9, "{along:?}");
    }

    /// The mean over a segment is within the bounds by an integral of many points, also along an axis, far
    /// from the origin, and where the cost has kinks.
    #[test]
    fn the_mean_over_a_segment_is_within_its_bounds() {
        let mut random = fastrand::Rng::with_seed(1490);
        let costs = [
            "1 + 3*exp(-9*((x - 0.4)^2 + (y - 0.6)^2))",
            "2 + sin(9*x)*cos(7*y)",
            "1 + max(0, 1 - 5*hypot(x - 0.5, y - 0.5))",
            "1 + x*y + x^2",
            "2 + sin(1e-3*(x - 1e6)) + cos(2e-3*(y + 2e6))",
        ];
        let (mut known, mut close) = (0, 0);
        for round in 0..2000 {
            let source = costs[round % costs.len()];
            let (origin, size) =
                if source.contains("1e6") { (dvec2(1e6, -2e6), 1e3) } else { (DVec2::ZERO, 1.0) };
            let density =
                FormulaCost { formula: CostFormula::parse(source).unwrap(), risk: RiskField::default() };
            let length = size * libm::exp2(-12.0 * random.f64());
            let along_axis = [dvec2(1.0, 0.0), dvec2(0.0, -1.0), dvec2(1.0, 1e-9)];
            let direction = match random.usize(..6) {
                axis @ 0..3 => along_axis[axis],
                _ => DVec2::from_angle(7.0 * random.f64()),
            };
            let p = origin + size * dvec2(random.f64(), random.f64());
            let q = p + length * direction;
            let Some((mean, most)) = mean_of_model(p, q, &Rect::spanning(p, q), &density) else { continue };
            let values = (0..2000).map(|n| density.at(p.lerp(q, (f64::from(n) + 0.5) / 2000.0)));
            let expected = values.sum::<f64>() / 2000.0;
            // The sum of many points is exact but for the second derivative.
            let error = 1e-5 * length * length / (size * size) + 1e-9;
            assert!((mean - expected).abs() <= most + error, "{source} {p} {q}: {mean} {expected} {most}");
            known += 1;
            close += usize::from(most < 1e-6);
        }
        assert!(known > 1900 && close > 500, "{known} {close}");
    }
}
