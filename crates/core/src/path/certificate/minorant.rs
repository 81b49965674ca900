//! Affine functions below the cost density of a triangle.
//!
//! A plane is fitted to samples, and lowered by the least value of the density minus the plane. That value is
//! bounded by branch and bound over rectangles: the part of the triangle in each is a convex polygon, on
//! which the plane is known exactly and the density by its range.
//!
//! The density counts inside the triangle only, farther than `inset` from its edges. What it is on the edges
//! is looked at afterwards, for both triangles together (`edges.rs`): there a jump that follows the mesh
//! costs nothing.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec2, dvec2};

use super::clipped::{Clipped, clipped, least_on_polygon, quarters};
use super::triangle::{AffineFunction, FlatTriangle};
use crate::geometry::Rect;
use crate::path::{CostDensity, CostModel};

/// Samples for the plane, in each direction of the triangle.
const SAMPLES: usize = 5;
/// Most rectangles that are looked at for one bound.
const MOST_RECTANGLES: usize = 240;
/// Bound of the effect of rounding on a value, as a share of the value.
const ROUNDING: f64 = 1e-13;
/// A plane below this part of the least value at a corner is not used.
const LOWEST: f64 = 0.05;

/// Lower bounds of the cost density in a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Minorant {
    /// Values at the corners of an affine function that is below the density inside the triangle, and where
    /// [`lower_at_edges`](super::edges::lower_at_edges) needs it, on an edge.
    pub at_corners: [f64; 3],
    /// The density's mean over samples.
    pub mean: f64,
    /// A lower bound of the density inside the triangle.
    pub least: f64,
}

impl Minorant {
    /// Returns, of the affine functions tried, the one with the greatest mean. It is below the density at all
    /// points that are farther than `inset` from the edges.
    pub(super) fn new(cost: &dyn CostDensity, triangle: &FlatTriangle, inset: f64) -> Self {
        let samples = DensitySamples::new(cost, triangle);
        let inner = triangle.shrunk(inset);
        let tilted = Self::tilted(cost, triangle, &inner, &samples);
        // No constant is above the least sample.
        if let Some(tilted) = tilted
            && tilted.affine_mean() >= samples.least()
        {
            return tilted;
        }
        let flat = AffineFunction { value: 0.0, slope: DVec2::ZERO, origin: triangle.centroid() };
        let least = MinorantSearch::new(cost, &inner, flat, samples.least()).bound(0.002 * samples.least());
        match tilted {
            Some(tilted) if tilted.affine_mean() > least => Self { least, ..tilted },
            _ => Self { at_corners: [least; 3], mean: samples.mean(least), least },
        }
    }

    /// Returns the affine function from a plane fitted to the samples; `None` where it is useless.
    fn tilted(
        cost: &dyn CostDensity,
        triangle: &FlatTriangle,
        inner: &FlatTriangle,
        samples: &DensitySamples,
    ) -> Option<Self> {
        let mean = samples.mean(samples.least());
        if samples.spread() <= 1e-9 * mean {
            return None;
        }
        let plane = samples.fitted_plane(triangle.centroid())?;
        let above = samples.least_above(&plane);
        // To be worth it, the plane must gain on the constant.
        let gain = plane.value - samples.least();
        let shift = MinorantSearch::new(cost, inner, plane, above).bound(0.02 * (gain + above).max(0.0));
        let at_corners = triangle.corners.map(|corner| {
            let value = plane.at(corner) + shift;
            value - ROUNDING * (value.abs() + plane.value.abs() + shift.abs())
        });
        // An affine function is least at a corner.
        let least = at_corners.iter().copied().fold(f64::INFINITY, f64::min);
        (least >= LOWEST * samples.least()).then_some(Self { at_corners, mean, least })
    }

    /// Limits the lower bound of the cost to `most`. Values far above those on the best path make a program
    /// ill conditioned.
    pub(super) fn at_most(self, most: f64) -> Self {
        let greatest = self.at_corners.iter().copied().fold(0.0, f64::max);
        if greatest <= most {
            self
        } else if greatest.is_finite() {
            Self { at_corners: self.at_corners.map(|value| value * (most / greatest)), ..self }
        } else {
            Self { at_corners: [most; 3], ..self }
        }
    }

    /// Multiplies the affine function by a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        self.at_corners = self.at_corners.map(|value| value * factor);
        self.least *= factor;
    }

    /// Returns whether no affine function comes near the cost.
    pub(super) fn has_jump(&self) -> bool {
        self.mean > 1.1 * self.affine_mean()
    }

    /// Returns the mean of the affine function.
    pub(super) fn affine_mean(&self) -> f64 {
        self.at_corners.iter().sum::<f64>() / 3.0
    }
}

/// Values of the density at points inside a triangle.
struct DensitySamples(Vec<(DVec2, f64)>);

impl DensitySamples {
    fn new(cost: &dyn CostDensity, triangle: &FlatTriangle) -> Self {
        let most = (SAMPLES - 1) as f64;
        let rows = (0..SAMPLES).flat_map(|i| (0..SAMPLES - i).map(move |j| (i, j)));
        let points = rows.map(|(i, j)| {
            // A little inside, so that a jump along an edge is not met.
            let [a, b] = [i, j].map(|n| (n as f64 / most - 1.0 / 3.0) * (1.0 - 1e-6) + 1.0 / 3.0);
            triangle.point([a, b, 1.0 - a - b])
        });
        Self(points.map(|point| (point, cost.at(point))).collect())
    }

    fn least(&self) -> f64 {
        self.0.iter().fold(f64::INFINITY, |least, (_, value)| least.min(*value))
    }

    fn spread(&self) -> f64 {
        let greatest = self.0.iter().fold(f64::NEG_INFINITY, |most, (_, value)| most.max(*value));
        greatest - self.least()
    }

    /// Returns the mean, where an infinite value counts as the least value of the triangle.
    fn mean(&self, least: f64) -> f64 {
        let finite = |value: f64| if value.is_finite() { value } else { least };
        self.0.iter().map(|(_, value)| finite(*value)).sum::<f64>() / self.0.len() as f64
    }

    fn least_above(&self, plane: &AffineFunction) -> f64 {
        self.0.iter().fold(f64::INFINITY, |least, (point, value)| least.min(value - plane.at(*point)))
    }

    /// Returns the plane with the least squares of deviations; `None` where it is not finite.
    fn fitted_plane(&self, origin: DVec2) -> Option<AffineFunction> {
        let count = self.0.len() as f64;
        // The samples lie evenly around the centroid: the value is the mean, and the slope has two equations.
        let value = self.0.iter().map(|(_, value)| value).sum::<f64>() / count;
        let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for (point, sample) in &self.0 {
            let offset = *point - origin;
            xx += offset.x * offset.x;
            xy += offset.x * offset.y;
            yy += offset.y * offset.y;
            right += offset * (sample - value);
        }
        let slope = dvec2(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / (xx * yy - xy * xy);
        (value.is_finite() && slope.is_finite()).then_some(AffineFunction { value, slope, origin })
    }
}

/// Branch and bound for the least value of the density minus a plane inside a triangle.
struct MinorantSearch<'a> {
    cost: &'a dyn CostDensity,
    triangle: &'a FlatTriangle,
    plane: AffineFunction,
    /// A value that is attained, as far as samples tell.
    attained: f64,
    open: BinaryHeap<BoundedPart>,
    looked_at: usize,
    tolerance: f64,
}

/// The part of the triangle in a rectangle, with a lower bound of the density minus the plane there.
struct BoundedPart {
    rectangle: Rect,
    bound: f64,
    /// Whether dividing it does not help.
    is_exact: bool,
}

impl<'a> MinorantSearch<'a> {
    fn new(
        cost: &'a dyn CostDensity,
        triangle: &'a FlatTriangle,
        plane: AffineFunction,
        attained: f64,
    ) -> Self {
        let (open, looked_at, tolerance) = (BinaryHeap::new(), 0, 0.0);
        Self { cost, triangle, plane, attained, open, looked_at, tolerance }
    }

    /// Returns a lower bound, within `tolerance` of the least value if the budget of rectangles suffices.
    fn bound(mut self, tolerance: f64) -> f64 {
        self.tolerance = tolerance;
        let [a, b, c] = self.triangle.corners;
        self.add(Rect::spanning(a, b).union(&Rect::new(c, c)), f64::NEG_INFINITY);
        // Ends: the allowance shrinks with every turn.
        while let Some(part) = self.open.pop() {
            if part.is_exact || self.is_close(part.bound) || self.looked_at >= MOST_RECTANGLES {
                return part.bound;
            }
            for quarter in quarters(&part.rectangle) {
                self.add(quarter, part.bound);
            }
        }
        // No rectangle contains a part of the triangle, so it is degenerate: nothing is known.
        f64::NEG_INFINITY
    }

    /// Returns whether a lower bound is near enough to a value that is attained.
    fn is_close(&self, bound: f64) -> bool {
        bound >= self.attained - self.tolerance
    }

    fn add(&mut self, rectangle: Rect, bound_of_whole: f64) {
        let polygon = clipped(self.triangle, &rectangle);
        if polygon.is_flat() {
            return;
        }
        self.looked_at += 1;
        let of_model = self.bound_by_model(&rectangle, &polygon);
        let by_slopes = match of_model {
            Some(bound) => bound,
            None => self.bound_by_slopes(&rectangle),
        };
        let by_slopes = by_slopes.max(bound_of_whole);
        if self.is_close(by_slopes) {
            self.open.push(BoundedPart { rectangle, bound: by_slopes, is_exact: false });
            return;
        }
        let range = self.cost.range(&rectangle);
        let highest = polygon.corners().iter().map(|&p| self.plane.at(p)).fold(f64::NEG_INFINITY, f64::max);
        let below = |value: f64| value - ROUNDING * (value.abs() + highest.abs());
        let is_exact = range.least == range.greatest;
        let bound = below(range.least) - highest;
        if is_exact {
            self.attained = self.attained.min(bound);
        }
        self.open.push(BoundedPart { rectangle, bound: bound.max(by_slopes), is_exact });
    }

    /// Returns the least value of a polynomial near the density, minus the plane, over the part of the
    /// triangle in a rectangle, rounded down.
    fn bound_by_model(&self, rectangle: &Rect, part: &Clipped) -> Option<f64> {
        let half = 0.5 * rectangle.size();
        if half.min_element() <= 0.0 {
            return None;
        }
        let CostModel { coefficients, remainder } = self.cost.model(rectangle)?;
        let middle = rectangle.center();
        let plane = [self.plane.at(middle), self.plane.slope.x * half.x, self.plane.slope.y * half.y];
        let mut of_both = coefficients;
        plane.iter().zip(&mut of_both).for_each(|(plane, own)| *own -= plane);
        let size: f64 = coefficients.iter().chain(&plane).map(|c| c.abs()).sum();
        let corners = part.corners().iter().map(|&corner| (corner - middle) / half);
        let least = least_on_polygon(&of_both, corners);
        // Corners are rounded by some ulps.
        let steepest: f64 = 2.0 * of_both[1..].iter().map(|c| c.abs()).sum::<f64>();
        let moved = 8.0 * f64::EPSILON * ((middle.abs() + half) / half).max_element();
        let bound = least - remainder - ROUNDING * (size + remainder) - steepest * moved;
        (!bound.is_nan()).then_some(bound)
    }

    /// Returns the bound by the mean value theorem, f ≥ f(m) − Σ |x − m| · greatest |∂f|, for the density
    /// minus the plane.
    fn bound_by_slopes(&self, rectangle: &Rect) -> f64 {
        let Some(slopes) = self.cost.derivatives(rectangle) else { return f64::NEG_INFINITY };
        let middle = rectangle.center();
        let value = self.cost.at(middle);
        let half = 0.5 * rectangle.size();
        let steepest = |axis: usize| {
            let plane = self.plane.slope[axis];
            (slopes[axis].least - plane).abs().max((slopes[axis].greatest - plane).abs())
        };
        let plane = self.plane.at(middle);
        let fall = half.x * steepest(0) + half.y * steepest(1);
        let bound = value - plane - fall - ROUNDING * (value.abs() + plane.abs() + fall);
        if bound.is_nan() { f64::NEG_INFINITY } else { bound }
    }
}

// The part with the least bound comes first.
impl Ord for BoundedPart {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}
impl PartialOrd for BoundedPart {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for BoundedPart {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for BoundedPart {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::CostFormula;
    use crate::layers::RiskField;
    use crate::path::FormulaCost;

    #[test]
    fn affine_functions_are_below_the_cost_inside_their_triangles() {
        let formulas =
            ["1 + x*x + y*y", "exp(2*x - y)", "2 + sin(9*x)*cos(7*y)", "if(x < 0.4, 1, 3)", "3 - x*y"];
        let mut random = fastrand::Rng::with_seed(1412);
        let mut sloped = 0;
        for source in formulas {
            let formula = CostFormula::parse(source).unwrap();
            let cost = FormulaCost { formula, risk: RiskField::default() };
            for _ in 0..40 {
                let corner = dvec2(random.f64(), random.f64());
                let side = 0.02 + 0.5 * random.f64();
                let corners = [dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)];
                let triangle = FlatTriangle::new(corners.map(|p| corner + side * p));
                let minorant = Minorant::new(&cost, &triangle, 0.0);
                let [at_a, at_b, at_c] = minorant.at_corners;
                sloped += usize::from(at_a != at_b || at_b != at_c);
                for _ in 0..200 {
                    let [mut b, mut c] = [random.f64(), random.f64()];
                    if b + c > 1.0 {
                        (b, c) = (1.0 - b, 1.0 - c);
                    }
                    let a = 1.0 - b - c;
                    let (affine, real) = (a * at_a + b * at_b + c * at_c, cost.at(triangle.point([a, b, c])));
                    assert!(affine <= real * (1.0 + 1e-12), "{source}: {affine} {real} in {corners:?}");
                }
            }
        }
        assert!(sloped > 100, "{sloped}");
    }
}
