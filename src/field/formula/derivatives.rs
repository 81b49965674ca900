//! Bounds of a formula's derivatives over a rectangle: automatic differentiation with intervals.

use super::functions::OfThree;
use super::interval;
use super::machine::{self, Values};
use super::program::{Op, Program};
use crate::field::Bounds;
use crate::geometry::Rect;

/// Values over a rectangle, and their derivatives along x and y.
#[derive(Clone, Copy)]
pub(super) struct Varying {
    pub value: Bounds,
    /// `None` where the values may jump, or a derivative is not known.
    pub slopes: Option<[Bounds; 2]>,
}

pub(super) const ZERO: Bounds = Bounds::new(0.0, 0.0);
pub(super) const ONE: Bounds = Bounds::new(1.0, 1.0);

/// Bounds of the derivatives along x and y over a rectangle, with the given risks and their derivatives.
/// `None` where it may jump, or has a function whose derivative is not known here.
///
/// At kinks, as of `abs` and `max`, the bounds hold the derivatives on all sides.
pub(super) fn derivatives(
    program: &Program,
    rect: &Rect,
    (risk, risk_slopes): (Bounds, [Bounds; 2]),
) -> Option<[Bounds; 2]> {
    let coordinate = |axis: usize, slopes| Varying {
        value: Bounds::new(rect.min[axis], rect.max[axis]),
        slopes: Some(slopes),
    };
    let risk = Varying { value: risk, slopes: Some(risk_slopes) };
    let values = [coordinate(0, [ONE, ZERO]), coordinate(1, [ZERO, ONE]), risk];
    let slopes = machine::run(program, values).slopes?;
    slopes.iter().all(|slope| slope.valid && !slope.has_infinity()).then_some(slopes)
}

impl Values for Varying {
    /// Without derivatives, unless the bounds are a number: other bounds may come from a jump.
    fn of_bounds(value: Bounds) -> Self {
        Self { value, slopes: value.is_one().then_some([ZERO; 2]) }
    }

    fn bounds(&self) -> Bounds {
        self.value
    }

    fn one(op: Op, a: Self) -> Self {
        let value = interval::unary(op, a.value);
        let slopes = factor(op, a.value, value).and_then(|factor| a.slopes_times(factor));
        Self { value, slopes }
    }

    fn two(op: Op, a: Self, b: Self) -> Self {
        let value = interval::binary(op, a.value, b.value);
        Self { value, slopes: slopes_of_two(op, a, b, value) }
    }

    fn three(function: &OfThree, a: Self, b: Self, c: Self) -> Self {
        Self::of_bounds((function.bounds)(a.value, b.value, c.value))
    }

    fn either(self, other: Self) -> Self {
        Self::of_bounds(self.value.union(other.value))
    }
}

impl Varying {
    /// The slopes, each times a factor.
    pub fn slopes_times(&self, factor: Bounds) -> Option<[Bounds; 2]> {
        Some(self.slopes?.map(|slope| times(slope, factor)))
    }

    pub fn is_constant(&self) -> bool {
        self.value.is_one() && self.slopes == Some([ZERO; 2])
    }
}

/// A product; one with 0 is 0, whatever the other factor.
pub(super) fn times(a: Bounds, b: Bounds) -> Bounds {
    if a == ZERO || b == ZERO { ZERO } else { a.times(b) }
}

/// Sums of slopes, where both are known.
pub(super) fn sums(a: Option<[Bounds; 2]>, b: Option<[Bounds; 2]>) -> Option<[Bounds; 2]> {
    let ([a, b], [c, d]) = (a?, b?);
    Some([a.plus(c), b.plus(d)])
}

/// The derivative of an operation on one value, from its argument and its result.
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

fn slopes_of_two(op: Op, a: Varying, b: Varying, value: Bounds) -> Option<[Bounds; 2]> {
    match op {
        Op::Add => sums(a.slopes, b.slopes),
        Op::Subtract => sums(a.slopes, b.slopes_times(Bounds::one(-1.0))),
        Op::Multiply => sums(a.slopes_times(b.value), b.slopes_times(a.value)),
        Op::Divide => {
            let inverse = ONE.over(b.value);
            sums(a.slopes_times(inverse), b.slopes_times(times(value, inverse).negated()))
        }
        Op::Min | Op::Max => {
            let (low, high) = if matches!(op, Op::Min) { (a, b) } else { (b, a) };
            if low.value.greatest < high.value.least {
                a.slopes
            } else if high.value.greatest < low.value.least {
                b.slopes
            } else {
                let (a, b) = (a.slopes?, b.slopes?);
                Some([0, 1].map(|axis: usize| a[axis].union(b[axis])))
            }
        }
        Op::Two(function) => (function.slopes?)(a, b, value),
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
