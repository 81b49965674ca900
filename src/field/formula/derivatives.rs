//! Bounds of a formula's derivatives over a rectangle: automatic differentiation with intervals.

use super::functions::{self, known};
use super::program::{Op, Program};
use super::{function_bounds, interval};
use crate::field::Bounds;
use crate::geometry::Rect;

/// Values over a rectangle, and their derivatives along x and y.
#[derive(Clone, Copy)]
struct Varying {
    value: Bounds,
    slopes: [Bounds; 2],
}

pub(super) const ZERO: Bounds = Bounds::new(0.0, 0.0);
const ONE: Bounds = Bounds::new(1.0, 1.0);

/// Bounds of the derivatives along x and y over a rectangle, with the given risks and their derivatives.
/// `None` where it may jump, or has a function whose derivative is not known here.
///
/// At kinks, as of `abs` and `max`, the bounds hold the derivatives on all sides.
pub(super) fn derivatives(
    program: &Program,
    rect: &Rect,
    (risk, risk_slopes): (Bounds, [Bounds; 2]),
) -> Option<[Bounds; 2]> {
    let mut stack: Vec<Varying> = Vec::with_capacity(program.slots());
    let mut acc = Varying::constant(ZERO);
    for &op in program.code() {
        let loaded = match op {
            Op::Number(value) => Some(Varying::constant(Bounds::one(value))),
            Op::X => Some(Varying { value: Bounds::new(rect.min.x, rect.max.x), slopes: [ONE, ZERO] }),
            Op::Y => Some(Varying { value: Bounds::new(rect.min.y, rect.max.y), slopes: [ZERO, ONE] }),
            Op::Risk => Some(Varying { value: risk, slopes: risk_slopes }),
            _ => None,
        };
        if let Some(loaded) = loaded {
            stack.push(acc);
            acc = loaded;
            continue;
        }
        acc = match operands(op)? {
            1 => of_one(op, acc)?,
            _ => of_two(op, stack.pop()?, acc)?,
        };
    }
    acc.slopes.iter().all(|slope| slope.valid && !slope.has_infinity()).then_some(acc.slopes)
}

/// The number of operands; `None` for operations that choose, compare, or join more.
fn operands(op: Op) -> Option<usize> {
    match op {
        Op::Negate | Op::Abs | Op::Sqrt | Op::One(..) => Some(1),
        Op::Add | Op::Subtract | Op::Multiply | Op::Divide | Op::Min | Op::Max | Op::Two(..) => Some(2),
        _ => None,
    }
}

impl Varying {
    fn constant(value: Bounds) -> Self {
        Self { value, slopes: [ZERO; 2] }
    }

    /// The same slopes, each times a factor.
    fn slopes_times(&self, factor: Bounds) -> [Bounds; 2] {
        self.slopes.map(|slope| times(slope, factor))
    }

    fn is_constant(&self) -> bool {
        self.value.is_one() && self.slopes == [ZERO; 2]
    }
}

/// A product; one with 0 is 0, whatever the other factor.
fn times(a: Bounds, b: Bounds) -> Bounds {
    if a == ZERO || b == ZERO { ZERO } else { a.times(b) }
}

fn sums([a, b]: [Bounds; 2], [c, d]: [Bounds; 2]) -> [Bounds; 2] {
    [a.plus(c), b.plus(d)]
}

fn of_one(op: Op, a: Varying) -> Option<Varying> {
    let value = interval::unary(op, a.value)?;
    let factor = match op {
        Op::Negate => Bounds::one(-1.0),
        Op::Abs if a.value.least >= 0.0 => ONE,
        Op::Abs if a.value.greatest <= 0.0 => Bounds::one(-1.0),
        Op::Abs => Bounds::new(-1.0, 1.0),
        Op::Sqrt => Bounds::one(0.5).over(value),
        Op::One(function, _) => slope_of_function(function, a.value, value)?,
        _ => return None,
    };
    Some(Varying { value, slopes: a.slopes_times(factor) })
}

/// The derivative of a function of one value, from its argument and its result.
fn slope_of_function(function: fn(f64) -> f64, a: Bounds, result: Bounds) -> Option<Bounds> {
    let is = |known: fn(f64) -> f64| std::ptr::fn_addr_eq(function, known);
    let slope = if is(known::exp) {
        result
    } else if is(known::log) {
        ONE.over(a)
    } else if is(known::sin) {
        function_bounds::cos(a)
    } else if is(known::cos) {
        function_bounds::sin(a).negated()
    } else if is(known::tanh) {
        ONE.minus(result.squared())
    } else if is(known::sinh) {
        function_bounds::cosh(a)
    } else if is(known::cosh) {
        function_bounds::sinh(a)
    } else if is(known::atan) {
        ONE.over(ONE.plus(a.squared()))
    } else {
        return None;
    };
    Some(slope)
}

fn of_two(op: Op, a: Varying, b: Varying) -> Option<Varying> {
    let value = interval::binary(op, a.value, b.value);
    let slopes = match op {
        Op::Add => sums(a.slopes, b.slopes),
        Op::Subtract => sums(a.slopes, b.slopes.map(Bounds::negated)),
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
                [0, 1].map(|axis| a.slopes[axis].union(b.slopes[axis]))
            }
        }
        Op::Two(function, _) => slopes_of_function(function, a, b, value)?,
        _ => return None,
    };
    Some(Varying { value, slopes })
}

/// The derivatives of a function of two values.
fn slopes_of_function(
    function: fn(f64, f64) -> f64,
    a: Varying,
    b: Varying,
    value: Bounds,
) -> Option<[Bounds; 2]> {
    let is = |known: fn(f64, f64) -> f64| std::ptr::fn_addr_eq(function, known);
    if is(functions::power) && b.is_constant() {
        // (aⁿ)′ = n aⁿ⁻¹ a′
        let less = interval::binary(Op::Two(functions::power, function_bounds::power), a.value, {
            Bounds::one(b.value.least - 1.0)
        });
        Some(a.slopes_times(times(b.value, less)))
    } else if is(known::hypot) {
        // √(a² + b²)′ = (a a′ + b b′) / √(a² + b²), with factors from −1 to 1
        let factor = |of: Bounds| of.over(value).intersection(Bounds::new(-1.0, 1.0));
        Some(sums(a.slopes_times(factor(a.value)), b.slopes_times(factor(b.value))))
    } else if is(functions::gauss) && b.is_constant() {
        // exp(−(d/s)²/2)′ = −d / s² · exp(−(d/s)²/2) · d′
        let factor = a.value.over(b.value.squared()).negated();
        Some(a.slopes_times(times(factor, value)))
    } else {
        None
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
