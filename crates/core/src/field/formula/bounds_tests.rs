use std::f64::consts::{FRAC_PI_2, PI};

use glam::dvec2;

use super::{Formula, functions};
use crate::geometry::Rect;

/// Returns the numbers where functions have kinks, poles and limits, and numbers between.
fn coordinate(random: &mut fastrand::Rng) -> f64 {
    const SPECIAL: [f64; 14] =
        [0.0, -0.0, 1.0, -1.0, 2.0, 0.5, -0.5, 3.0, FRAC_PI_2, PI, 1e-9, -1e-300, 50.0, -7.0];
    match random.u8(..8) {
        0 | 1 => SPECIAL[random.usize(..SPECIAL.len())],
        2 => 1e3 * (random.f64() - 0.5),
        3 => 1e7 * (random.f64() - 0.5),
        _ => 8.0 * (random.f64() - 0.5),
    }
}

/// Returns a rectangle: a point, a line, small or large.
fn rectangle(random: &mut fastrand::Rng) -> Rect {
    let min = dvec2(coordinate(random), coordinate(random));
    let side = |random: &mut fastrand::Rng| match random.u8(..5) {
        0 => 0.0,
        1 => 1e-6 * random.f64(),
        2 => random.f64(),
        3 => 1.0,
        _ => 10.0 * random.f64(),
    };
    Rect::new(min, min + dvec2(side(random), side(random)))
}

/// Returns a number of a closed interval, often one of its ends or 0.
fn within(random: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    match random.u8(..6) {
        0 => low,
        1 => high,
        2 if low <= 0.0 && high >= 0.0 => [0.0, -0.0][random.usize(..2)],
        _ => (low + (high - low) * random.f64()).clamp(low, high),
    }
}

/// Compares bounds with values at random points, and returns how many points there were.
fn check(formula: &Formula, rect: &Rect, points: usize, random: &mut fastrand::Rng) -> usize {
    let bounds = formula.bounds(rect);
    for _ in 0..points {
        let [x, y] = [0, 1].map(|axis| within(random, rect.min[axis], rect.max[axis]));
        let value = formula.eval(x, y);
        let holds =
            if value.is_nan() { !bounds.valid } else { bounds.least <= value && value <= bounds.greatest };
        assert!(holds, "{formula} at {x:?}, {y:?} is {value:?}; over {rect:?}: {bounds:?}");
    }
    points
}

/// Returns a call of every function with simple values of x and y, and every operator.
pub(super) fn simple_formulas() -> Vec<String> {
    let values = ["x", "y", "x*y", "x-y", "2", "-0.5", "1/x", "x^3", "0", "sqrt(y)", "inf"];
    let mut all = Vec::new();
    for (call, _) in functions() {
        let name = call.split('(').next().unwrap();
        let count = call.matches(',').count() + 1;
        let count = if call.contains("...") { 2 } else { count };
        for n in 0..values.len().pow(count as u32) {
            let arguments: Vec<_> =
                (0..count).map(|place| values[n / values.len().pow(place as u32) % values.len()]).collect();
            all.push(format!("{name}({})", arguments.join(",")));
        }
    }
    for sign in ["+", "-", "*", "/", "%", "^", "<", "<=", ">", ">=", "==", "!=", "and", "or"] {
        for a in values {
            all.extend(values.iter().map(|b| format!("({a}) {sign} ({b})")));
        }
    }
    all.extend(
        values.iter().flat_map(|v| [format!("-({v})"), format!("!({v})"), format!("0 < {v} <= y < 3")]),
    );
    all
}

#[test]
fn values_of_every_function_lie_within_the_bounds() {
    let mut random = fastrand::Rng::with_seed(21);
    let mut points = 0;
    for source in simple_formulas() {
        let formula = Formula::parse(&source).unwrap_or_else(|e| panic!("{source}: {e}"));
        for _ in 0..12 {
            points += check(&formula, &rectangle(&mut random), 12, &mut random);
        }
    }
    assert!(points > 500_000, "{points}");
}

/// Returns a random formula as text, nested up to `depth` levels.
pub(super) fn grown(random: &mut fastrand::Rng, depth: usize) -> String {
    const LEAVES: [&str; 10] = ["x", "y", "x", "y", "r", "theta", "0.5", "2", "3.7", "-1"];
    const SIGNS: [&str; 14] = ["+", "-", "*", "/", "%", "^", "<", "<=", ">", ">=", "==", "!=", "and", "or"];
    if depth == 0 {
        return LEAVES[random.usize(..LEAVES.len())].into();
    }
    let mut child = || grown(random, depth - 1);
    let children = [child(), child(), child()];
    match random.u8(..10) {
        0..=4 => {
            let [a, b, _] = children;
            format!("({a}) {} ({b})", SIGNS[random.usize(..SIGNS.len())])
        }
        5 => format!("if({})", children.join(",")),
        6 => format!("!({})", children[0]),
        _ => {
            let calls: Vec<&str> = functions().map(|(call, _)| call).collect();
            let call = calls[random.usize(..calls.len())];
            let count = if call.contains("...") { 3 } else { call.matches(',').count() + 1 };
            format!("{}({})", call.split('(').next().unwrap(), children[..count].join(","))
        }
    }
}

#[test]
fn values_of_random_formulas_lie_within_the_bounds() {
    let mut random = fastrand::Rng::with_seed(22);
    let (mut points, mut bounded) = (0, 0);
    for _ in 0..5_000 {
        let depth = random.usize(1..5);
        let formula: Formula = grown(&mut random, depth).parse().unwrap();
        for _ in 0..4 {
            let rect = rectangle(&mut random);
            points += check(&formula, &rect, 10, &mut random);
            let bounds = formula.bounds(&rect);
            bounded += usize::from(bounds.valid && bounds.least.is_finite() && bounds.greatest.is_finite());
        }
    }
    assert!(points >= 200_000 && bounded > 10_000, "{points} points, {bounded} finite bounds");
}

#[test]
fn bounds_of_a_point_are_its_value() {
    let mut random = fastrand::Rng::with_seed(23);
    let mut numbers = 0;
    for _ in 0..5_000 {
        let depth = random.usize(1..5);
        let formula: Formula = grown(&mut random, depth).parse().unwrap();
        let p = dvec2(8.0 * random.f64() - 4.0, 8.0 * random.f64() - 4.0);
        let (bounds, value) = (formula.bounds(&Rect::new(p, p)), formula.eval(p.x, p.y));
        // Zeros within a formula have no known sign; the functions that see it are rare.
        if bounds.valid && bounds.least.is_finite() && bounds.greatest.is_finite() {
            let close = (bounds.greatest - bounds.least) <= 1e-12 * value.abs().max(1.0);
            numbers += usize::from(close);
        }
    }
    assert!(numbers > 3_000, "{numbers}");
    for source in ["x^2 + sin(y)/3", "if(x<y, 0.1, hypot(x, y))", "gauss(r, 0.3)", "clamp(x, 0.1, 2) % 0.7"] {
        let formula: Formula = source.parse().unwrap();
        let bounds = formula.bounds(&Rect::new(dvec2(0.3, 0.7), dvec2(0.3, 0.7)));
        assert_eq!(
            (bounds.least, bounds.greatest, bounds.valid),
            (formula.eval(0.3, 0.7), bounds.least, true)
        );
    }
}

#[test]
fn bounds_shrink_with_the_rectangle() {
    let smooth = [
        "0.01 + 0.1*r",
        "sin(3*x)*cos(y) + 2",
        "gauss(hypot(x-1, y), 0.4)",
        "smoothstep(0, 2, r)",
        "mix(x, y, 0.3)",
    ];
    for source in smooth {
        let formula: Formula = source.parse().unwrap();
        let mut before = f64::INFINITY;
        for halvings in 0..30 {
            let side = 1.0 / f64::from(1u32 << halvings);
            let min = dvec2(0.61, 0.37);
            let bounds = formula.bounds(&Rect::new(min, min + side));
            let width = bounds.greatest - bounds.least;
            assert!(width <= before && width <= 8.0 * side + 1e-14, "{source}: {width} over {side}");
            before = width;
        }
    }
}

#[test]
fn a_choice_that_the_rectangle_decides_has_one_branch() {
    let formula: Formula = "if(abs(x)+abs(y)<0.4, 0.0125, 1)".parse().unwrap();
    let over = |x: [f64; 2], y: [f64; 2]| {
        let bounds = formula.bounds(&Rect::new(dvec2(x[0], y[0]), dvec2(x[1], y[1])));
        (bounds.least, bounds.greatest, bounds.valid)
    };
    assert_eq!(over([-0.1, 0.1], [-0.2, 0.2]), (0.0125, 0.0125, true));
    assert_eq!(over([0.4, 1.0], [0.0, 1.0]), (1.0, 1.0, true));
    assert_eq!(over([0.0, 1.0], [0.0, 1.0]), (0.0125, 1.0, true));
    let guarded: Formula = "if(x > 0 and ln(x) < 1, sqrt(x), 2)".parse().unwrap();
    assert!(guarded.bounds(&Rect::new(dvec2(-2.0, 0.0), dvec2(-1.0, 0.0))).valid);
    assert!(!guarded.bounds(&Rect::new(dvec2(-1.0, 0.0), dvec2(1.0, 0.0))).valid);
}

/// Functions of libm that are not monotone to the last bit, over intervals of a few neighbouring numbers.
#[test]
fn bounds_hold_to_the_last_bit() {
    let mut random = fastrand::Rng::with_seed(24);
    let calls = functions().filter(|(call, _)| call.matches(',').count() == 0);
    let mut sources: Vec<String> =
        calls.map(|(call, _)| format!("{}(x)", call.split('(').next().unwrap())).collect();
    sources.extend(
        ["pow(x, 1.7)", "2^x", "hypot(x, 0.3)", "atan2(x, 0.7)", "gauss(x, 0.8)", "mix(3, 0.1, x)"]
            .map(String::from),
    );
    for source in sources {
        let formula: Formula = source.parse().unwrap();
        for _ in 0..4_000 {
            let low = [4.0, 0.9, 40.0][random.usize(..3)] * (random.f64() - 0.3);
            let near: Vec<f64> = std::iter::successors(Some(low), |v| Some(v.next_up())).take(6).collect();
            let bounds = formula.bounds(&Rect::new(dvec2(low, 0.0), dvec2(near[5], 0.0)));
            for x in near {
                let value = formula.eval(x, 0.0);
                assert!(value.is_nan() || bounds.contains(value), "{source} at {x:?}: {value:?}, {bounds:?}");
            }
        }
    }
}

#[test]
fn minus_zero_counts_as_zero() {
    let rect = Rect::new(dvec2(0.0, -3.0), dvec2(1.0, -1.0));
    for source in ["x^y", "1/x", "atan2(x, y)"] {
        let formula: Formula = source.parse().unwrap();
        for zero in [0.0, -0.0] {
            assert!(formula.bounds(&rect).contains(formula.eval(zero, -1.0)), "{source}");
        }
    }
}
