use glam::{DVec2, dvec2};

use super::Formula;
use super::bounds_tests::{grown, simple_formulas};
use crate::field::{Bounds, TaylorModel};

/// Returns a model of a formula over a square.
fn model(formula: &Formula, middle: DVec2, half: f64) -> TaylorModel {
    let remainder = f64::EPSILON * (middle.abs() + half);
    let coordinates =
        [0, 1].map(|axis: usize| TaylorModel::coordinate(axis, middle[axis], half, remainder[axis]));
    formula.model(coordinates)
}

/// Compares a model with values at random points of a square and of a part of it. Returns whether the model
/// contains more than the fact that the values are numbers.
fn check(formula: &Formula, middle: DVec2, half: f64, random: &mut fastrand::Rng) -> bool {
    let model = model(formula, middle, half);
    for _ in 0..6 {
        let mut number = || 2.0 * random.f64() - 1.0;
        let (center, reach) = ([number(), number()], [number().abs(), number().abs()]);
        let part = [0, 1].map(|axis: usize| {
            let ends = [center[axis] - reach[axis], center[axis] + reach[axis]].map(|v| v.clamp(-1.0, 1.0));
            [0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])]
        });
        let bounds = model.bounds_over([part[0][0], part[1][0]], [part[0][1], part[1][1]]);
        for _ in 0..3 {
            let mut share = |axis: usize| part[axis][0] + 0.999_999 * part[axis][1] * number();
            let p = middle + half * dvec2(share(0), share(1));
            let value = formula.eval(p.x, p.y);
            let holds = if value.is_nan() { !bounds.valid } else { bounds.contains(value) };
            assert!(
                holds,
                "{formula} at {p:?} is {value:?}, not in {bounds:?}; {middle:?} ± {half}: {model:?}"
            );
        }
    }
    model.bounds() != Bounds::ANYTHING
}

fn place(random: &mut fastrand::Rng) -> (DVec2, f64) {
    let scale = [1.0, 3.0, 30.0, 1e4][random.usize(..4)];
    let middle = scale * dvec2(random.f64() - 0.5, random.f64() - 0.5);
    (middle, scale * [1e-9, 1e-4, 0.01, 0.1, 0.5][random.usize(..5)] * random.f64())
}

/// A model that knows nothing is never wrong, but leaves the search to divide rectangles.
#[test]
fn the_angle_of_a_direction_has_a_close_model_away_from_its_jump() {
    let formula: Formula = "atan2(y, x)".parse().unwrap();
    for middle in [dvec2(1.0, 0.0), dvec2(0.0, 1.0), dvec2(0.0, -1.0), dvec2(-1.0, 1.0), dvec2(-1.0, -1.0)] {
        let bounds = model(&formula, middle, 0.1).bounds();
        let width = bounds.greatest - bounds.least;
        assert!(bounds.valid && width < 0.25, "{middle}: {bounds:?}");
        assert!(bounds.contains(formula.eval(middle.x, middle.y)));
    }
}

#[test]
fn values_lie_within_the_models_of_every_function() {
    let mut random = fastrand::Rng::with_seed(31);
    let (mut known, mut all) = (0, 0);
    for source in simple_formulas() {
        let formula: Formula = source.parse().unwrap();
        for _ in 0..6 {
            let (middle, half) = place(&mut random);
            known += usize::from(check(&formula, middle, half, &mut random));
            all += 1;
        }
    }
    assert!(known > all / 2, "{known} of {all}");
}

#[test]
fn values_lie_within_the_models_of_random_formulas() {
    let mut random = fastrand::Rng::with_seed(32);
    let mut known = 0;
    for _ in 0..6_000 {
        let depth = random.usize(1..6);
        let formula: Formula = grown(&mut random, depth).parse().unwrap();
        for _ in 0..3 {
            let (middle, half) = place(&mut random);
            known += usize::from(check(&formula, middle, half, &mut random));
        }
    }
    assert!(known > 9_000, "{known}");
}

#[test]
fn the_rest_shrinks_with_the_third_power_of_the_side() {
    let smooth = [
        "sin(3*x)*cos(y) + 2",
        "gauss(hypot(x-1, y), 0.4)",
        "exp(x*y)/(2 + x^2) + ln(3 + y)",
        "x^3 - y^-2 + (2 + x)^0.7 + sqrt(y)",
        "tanh(x) + atan(y) + sinh(x*y) + cosh(x - y) + tan(0.5*x)",
        "atan2(y, x) + log2(y) + log10(y) + 2^x",
        "mix(sin(x), cos(y), x*y) + smoothstep(-1, 2, x) + clamp(sin(x), -1.5, 1.5) + abs(y)",
    ];
    for source in smooth {
        let formula: Formula = source.parse().unwrap();
        let remainder = |half: f64| model(&formula, dvec2(0.61, 0.87), half).remainder();
        let (coarse, fine) = (remainder(1e-2), remainder(1e-4));
        assert!(coarse < 1e-3 && fine < 2e-6 * coarse, "{source}: {coarse:e}, {fine:e}");
    }
}

#[test]
fn numbers_and_decided_choices_are_exact() {
    for source in
        ["if(x < 2, 0.0125, sin(x))", "max(0.0125, x - 9)", "clamp(x, 3, 0.0125)", "step(x, 5)*0.0125"]
    {
        let formula: Formula = source.parse().unwrap();
        assert_eq!(model(&formula, dvec2(0.5, 0.5), 0.5), TaylorModel::constant(0.0125), "{source}");
    }
}
