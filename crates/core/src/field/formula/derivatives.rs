//! Bounds of a formula's derivatives over a rectangle: automatic differentiation with intervals.

use super::functions::OfThree;
use super::gradient::{Along, Gradient, GradientBounds, ZERO, are_known, times};
use super::interval;
use super::machine::{self, Enclosure};
use super::program::{Op, Program};
use crate::field::Bounds;
use crate::geometry::Rect;

/// Values over a rectangle, and their gradient.
#[derive(Clone, Copy)]
pub(super) struct Varying<G: GradientBounds> {
    pub value: Bounds,
    /// `None` where the values may jump, or a derivative is not known.
    pub gradient: Option<G>,
    /// The gradient of a function whose square is the value, if one is known. Then the square root has no
    /// pole at 0: √(x² + y²) is a distance.
    of_root: G::Root,
}

pub(super) const ONE: Bounds = Bounds::new(1.0, 1.0);

/// Returns bounds of the derivatives along x and y over a rectangle, with the given risks and their
/// derivatives. Returns `None` if the program may jump, or has a function whose derivative is not known here.
///
/// At kinks, for example of `abs` and `max`, the bounds contain the derivatives on all sides.
pub(super) fn derivatives(
    program: &Program,
    rect: &Rect,
    risk: (Bounds, [Bounds; 2]),
) -> Option<[Bounds; 2]> {
    let along = match program.takes_roots() {
        true => gradient(program, rect, risk, Gradient::of)?.along,
        false => gradient(program, rect, risk, |along| along)?,
    };
    are_known(&along).then_some(along)
}

/// Returns bounds of the derivatives along x and y, with any risk and no slope of it, and the largest slope
/// in any direction; `None` where one of them is not known.
pub(super) fn slopes(program: &Program, rect: &Rect) -> Option<([Bounds; 2], f64)> {
    let Gradient { along, length } = gradient(program, rect, (Bounds::ANYTHING, [ZERO; 2]), Gradient::of)?;
    are_known(&along).then_some((along, length))
}

/// Returns the gradient of a program, if it is known. `of` makes a gradient from derivatives along the axes.
fn gradient<G: GradientBounds>(
    program: &Program,
    rect: &Rect,
    (risk, risk_slopes): (Bounds, Along),
    of: fn(Along) -> G,
) -> Option<G> {
    let coordinate = |axis: usize, slopes| {
        let value = Bounds::new(rect.min[axis], rect.max[axis]);
        Varying::new(value, Some(of(slopes)))
    };
    let risk = Varying::new(risk, Some(of(risk_slopes)));
    let values = [coordinate(0, [ONE, ZERO]), coordinate(1, [ZERO, ONE]), risk];
    machine::run(program, values).gradient
}

impl<G: GradientBounds> Enclosure for Varying<G> {
    /// Returns values without derivatives, unless the bounds are one number: other bounds may come from a
    /// jump.
    fn from_bounds(value: Bounds) -> Self {
        let gradient = value.is_one().then_some(G::NONE);
        Self { value, gradient, of_root: G::keep(gradient.filter(|_| value.least >= 0.0)) }
    }

    fn bounds(&self) -> Bounds {
        self.value
    }

    fn one(op: Op, a: Self) -> Self {
        let value = interval::unary(op, a.value);
        let gradient = factor(op, a.value, value).and_then(|factor| a.gradient_times(factor));
        Self::new(value, if matches!(op, Op::Sqrt) { a.gradient_of_root(gradient) } else { gradient })
    }

    fn two(op: Op, a: Self, b: Self) -> Self {
        let value = interval::binary(op, a.value, b.value);
        match op {
            Op::Two(function) => match G::of_two(function) {
                Some(derivative) => derivative(a, b, value),
                None => Self::from_bounds(value),
            },
            _ => Self::with_root(value, of_two(op, &a, &b, value), root_of_two(op, &a, &b)),
        }
    }

    fn three(function: &OfThree, a: Self, b: Self, c: Self) -> Self {
        let value = (function.bounds)(a.value, b.value, c.value);
        Self::new(value, G::of_three(function, [a, b, c]))
    }

    fn either(self, other: Self) -> Self {
        Self::from_bounds(self.value.union(other.value))
    }
}

impl<G: GradientBounds> Varying<G> {
    /// Returns values that are no squares as far as is known.
    pub fn new(value: Bounds, gradient: Option<G>) -> Self {
        Self::with_root(value, gradient, None)
    }

    /// Returns values that are the square of a function with the gradient `of_root`, if one is known.
    pub fn with_root(value: Bounds, gradient: Option<G>, of_root: Option<G>) -> Self {
        Self { value, gradient, of_root: G::keep(of_root) }
    }

    fn of_root(&self) -> Option<G> {
        G::kept(self.of_root)
    }

    /// Returns the gradient times a factor.
    pub fn gradient_times(&self, factor: Bounds) -> Option<G> {
        Some(self.gradient?.times(factor))
    }

    /// Returns the gradient of the square root, from what its derivative gives.
    pub fn gradient_of_root(&self, by_derivative: Option<G>) -> Option<G> {
        // The root that is known may have the other sign.
        let of_size = |root: G| G::of_hypot(&root, &G::NONE);
        match (by_derivative, self.of_root().map(of_size)) {
            (Some(gradient), Some(root)) => Some(gradient.or(root)),
            (gradient, root) => gradient.or(root),
        }
    }

    pub fn is_constant(&self) -> bool {
        self.value.is_one() && self.gradient == Some(G::NONE)
    }
}

/// Returns the sum of gradients, where both are known.
fn sum<G: GradientBounds>(a: Option<G>, b: Option<G>) -> Option<G> {
    Some(a?.plus(&b?))
}

/// Returns the derivative of an operation on one value, from its argument and its result.
fn factor(op: Op, a: Bounds, result: Bounds) -> Option<Bounds> {
    Some(match op {
        Op::Negate => Bounds::one(-1.0),
        Op::Abs if a.least >= 0.0 => ONE,
        Op::Abs if a.greatest <= 0.0 => Bounds::one(-1.0),
        Op::Abs => Bounds::new(-1.0, 1.0),
        Op::Sqrt => Bounds::one(0.5).over(result),
        Op::One(function) => (function.slope?)(a, result),
        _ => return None,
    })
}

fn of_two<G: GradientBounds>(op: Op, a: &Varying<G>, b: &Varying<G>, value: Bounds) -> Option<G> {
    match op {
        Op::Add => sum(a.gradient, b.gradient),
        Op::Subtract => sum(a.gradient, b.gradient_times(Bounds::one(-1.0))),
        Op::Multiply => sum(a.gradient_times(b.value), b.gradient_times(a.value)),
        Op::Divide => {
            let inverse = ONE.over(b.value);
            sum(a.gradient_times(inverse), b.gradient_times(times(value, inverse).negated()))
        }
        Op::Min | Op::Max => {
            let (low, high) = if matches!(op, Op::Min) { (a, b) } else { (b, a) };
            if low.value.greatest < high.value.least {
                a.gradient
            } else if high.value.greatest < low.value.least {
                b.gradient
            } else {
                Some(a.gradient?.union(&b.gradient?))
            }
        }
        _ => None,
    }
}

/// Returns the gradient of a root of a sum of squares, or of a multiple of one.
fn root_of_two<G: GradientBounds>(op: Op, a: &Varying<G>, b: &Varying<G>) -> Option<G> {
    let multiple = |root: G, factor: &Varying<G>, size: fn(f64) -> f64| {
        let is_positive = factor.is_constant() && factor.value.least > 0.0;
        is_positive.then(|| root.times(Bounds::one(size(factor.value.least))))
    };
    match op {
        Op::Add => Some(G::of_hypot(&a.of_root()?, &b.of_root()?)),
        Op::Multiply if a.is_constant() => multiple(b.of_root()?, a, f64::sqrt),
        Op::Multiply => multiple(a.of_root()?, b, f64::sqrt),
        Op::Divide => multiple(a.of_root()?, b, |divisor| (1.0 / divisor).sqrt()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::CostFormula;

    #[test]
    fn derivatives_enclose_differences_between_random_points() {
        let formulas = [
            "1 + x*y - 3*x",
            "1/(0.5 + x^2 + y^2)",
            "exp(0.7*x - y) + 2",
            "(x^2 + y^2 + 0.1)^-1.5",
            "2 + sin(3*x)*cos(2*y + x)",
            "hypot(x - 0.3, y + 0.2) + 0.1",
            "max(x, y, 0.2) + abs(x - y)",
            "1 + 3*gauss(hypot(x - 0.1, y), 0.4) + risk",
            "sqrt(2 + x) + ln(3 + y) + tanh(x*y) + atan(x)",
            "min(1, x^3) + cosh(x) - sinh(y)/4",
            "r + 1",
        ];
        let mut random = fastrand::Rng::with_seed(9);
        for source in formulas {
            let formula = CostFormula::parse(source).unwrap();
            let mut known = 0;
            for _ in 0..300 {
                let corner = dvec2(random.f64(), random.f64()) * 2.0 - 1.0;
                let size = 0.3 * dvec2(random.f64(), random.f64()) + 1e-3;
                let rect = Rect::new(corner, corner + size);
                let Some(slopes) = formula.derivatives(&rect, Bounds::one(0.25), None) else { continue };
                known += 1;
                for _ in 0..20 {
                    let [p, q] = [(); 2].map(|()| corner + size * dvec2(random.f64(), random.f64()));
                    let at = |x: f64, y: f64| formula.eval(x, y, 0.25);
                    let along = [
                        (at(q.x, p.y) - at(p.x, p.y)) / (q.x - p.x),
                        (at(p.x, q.y) - at(p.x, p.y)) / (q.y - p.y),
                    ];
                    for (slope, along) in slopes.into_iter().zip(along) {
                        let off = (slope.least - along).max(along - slope.greatest);
                        assert!(off < 1e-6 * (1.0 + along.abs()), "{source} {rect:?} {slope:?} {along}");
                    }
                }
            }
            assert!(known > 200, "{source}: {known}");
        }
    }

    #[test]
    fn jumps_have_no_derivatives() {
        for source in ["if(x > 0, 1, 2)", "floor(x)", "1 + (x > 0.5)", "1/x", "sqrt(x)", "x % 0.5"] {
            let formula = CostFormula::parse(source).unwrap();
            let rect = Rect::new(dvec2(-1.0, 0.0), dvec2(1.0, 1.0));
            assert_eq!(formula.derivatives(&rect, Bounds::one(0.0), None), None, "{source}");
        }
        let of_risk = CostFormula::parse("1 + risk").unwrap();
        assert_eq!(of_risk.derivatives(&Rect::UNIT, Bounds::new(0.0, 1.0), None), None);
    }
}
