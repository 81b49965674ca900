use glam::dvec2;

use super::Formula;
use crate::geometry::Rect;

/// Returns a random formula whose values over the unit square are moderate, so that their rounding does not
/// count.
fn random_formula(random: &mut fastrand::Rng, depth: usize) -> String {
    let number = |random: &mut fastrand::Rng| format!("{:.3}", 3.0 * random.f64() - 1.0);
    if depth == 0 {
        let leaves = ["x", "y", "(x-0.4)", "(y+0.2)", "(x+y)", "(2*x-y)"];
        return match random.usize(..8) {
            0 => number(random),
            1 => "r".to_owned(),
            n => leaves[n - 2].to_owned(),
        };
    }
    let mut part = || {
        let less = random.usize(1..=2).min(depth);
        random_formula(random, depth - less)
    };
    let (a, b, c) = (part(), part(), part());
    let factor = number(random);
    match random.usize(..18) {
        0 | 1 => format!("({a} + {b})"),
        2 => format!("({a} - {b})"),
        3 => format!("{factor}*({a})"),
        4 => format!("sin({a})*cos({b})"),
        5 | 6 => format!("hypot({a}, {b})"),
        7 => format!("sqrt(({a})^2 + ({b})^2)"),
        8 => format!("sqrt(0.5*(({a})^2 + 2*({b})^2) + ({c})^2/3)"),
        9 => format!("max({a}, {b}, {c})"),
        10 => format!("min({a}, {b})"),
        11 => format!("abs({a})"),
        12 => format!("gauss({a}, 0.3)"),
        13 => format!("({a})/(1.5 + tanh({b}))"),
        14 => format!("clamp({a}, {b}, {c})"),
        15 => format!("mix({a}, {b}, sin({c}))"),
        16 => format!("smoothstep(-0.3, 0.8, {a})"),
        _ => format!("exp(-abs({a}))*atan({b})"),
    }
}

/// Returns the largest slope in any direction; infinite where it is not known.
fn steepness(formula: &Formula, rect: &Rect) -> f64 {
    formula.slopes(rect).map_or(f64::INFINITY, |(_, length)| length)
}

/// Without a known slope, gradation searches far more of the lattice.
#[test]
fn smooth_formulas_have_a_known_slope_that_is_not_far_from_theirs() {
    let rect = Rect::new(dvec2(0.2, 0.3), dvec2(0.21, 0.31));
    for (source, steepest) in [
        ("x*y", 0.38),
        ("smoothstep(0, 1, x)", 1.0),
        ("mix(x, y, 0.5)", 0.71),
        ("clamp(x, 0, 1)", 1.0),
        ("gauss(hypot(x, y), 0.3)", 2.1),
        ("sqrt(x + y)", 1.0),
    ] {
        let most = steepness(&source.parse().unwrap(), &rect);
        assert!(most < 1.3 * steepest, "{source}: {most}");
    }
}

#[test]
fn no_formula_rises_faster_than_its_steepness() {
    let mut random = fastrand::Rng::with_seed(71);
    let (mut known, mut tight) = (0, 0);
    for _ in 0..3_000 {
        let depth = random.usize(1..5);
        let formula: Formula = random_formula(&mut random, depth).parse().unwrap();
        for _ in 0..4 {
            let corner = dvec2(random.f64(), random.f64()) * 2.0 - 1.0;
            let side = [1e-3, 0.05, 0.3, 1.0][random.usize(..4)];
            let rect = Rect::new(corner, corner + side * (0.1 + dvec2(random.f64(), random.f64())));
            let most = steepness(&formula, &rect);
            if !most.is_finite() {
                continue;
            }
            known += 1;
            let mut steepest = 0.0;
            for _ in 0..40 {
                let p = rect.min + rect.size() * dvec2(random.f64(), random.f64());
                let step = 1e-5 * rect.size().min_element();
                let towards = dvec2(random.f64() - 0.5, random.f64() - 0.5).normalize() * step;
                let q = (p + towards).clamp(rect.min, rect.max);
                let rise = (formula.eval(q.x, q.y) - formula.eval(p.x, p.y)).abs();
                // Differences of rounded values.
                let off = 1e-13 * (1.0 + most);
                assert!(rise <= most * q.distance(p) + off, "{formula}: {rise} {most} over {rect:?}");
                steepest = f64::max(steepest, rise / step);
            }
            tight += usize::from(steepest > 0.9 * most);
        }
    }
    assert!(known > 10_000 && tight > known / 4, "{known} {tight}");
}

/// Each of these formulas has the same slope in all directions, or in one; the bounds along the axes alone
/// would be larger by up to √2.
#[test]
fn distances_have_their_slope_over_any_rectangle() {
    let distances = [
        ("0.02+0.3*hypot(x-0.5,y-0.5)", 0.3),
        ("0.02+0.3*sqrt((x-0.5)^2+(y-0.5)^2)", 0.3),
        ("0.02+0.3*((x-0.5)^2+(y-0.5)^2)^0.5", 0.3),
        ("0.02+sqrt(0.09*((x-0.5)^2+(y-0.5)^2))", 0.3),
        ("0.1*r+0.2", 0.1),
        ("min(0.3*hypot(x-0.2,y-0.2),0.3*hypot(x-0.8,y-0.7))+0.01", 0.3),
        ("clamp(0.25*hypot(x-0.2,y-0.2),0.02,0.1)", 0.25),
        ("max(0.01,0.4*abs(hypot(x,y)-0.5))", 0.4),
        ("hypot(x+y,x-y)", 2f64.sqrt()),
        ("hypot(3*x,2*y,)", 3.0),
        ("hypot(hypot(x-0.5,y-0.5),0.1)", 1.0),
        ("0.02+0.1*hypot(x-0.5,y-0.5)+0.2*hypot(x-0.4,y-0.5)", 0.3),
    ];
    let mut random = fastrand::Rng::with_seed(72);
    for (source, slope) in distances {
        let formula: Formula = source.replace(",)", ")").parse().unwrap();
        for round in 0..50 {
            let corner = dvec2(random.f64(), random.f64());
            let rect = match round {
                0 => Rect::new(dvec2(-1.0, -1.0), dvec2(2.0, 2.0)),
                _ => Rect::new(corner, corner + dvec2(random.f64(), random.f64())),
            };
            let steepness = steepness(&formula, &rect);
            let off = if round == 0 { (steepness - slope).abs() } else { steepness - slope };
            assert!(off < 1e-12, "{source}: {steepness} over {rect:?}");
        }
    }
}

#[test]
fn jumps_and_poles_are_steep_without_limit() {
    for source in ["if(x > 0, 1, 2)", "floor(x)", "1/x", "sqrt(x)", "sqrt(abs(x))", "x % 0.5", "ln(x)"] {
        let formula: Formula = source.parse().unwrap();
        assert_eq!(
            steepness(&formula, &Rect::new(dvec2(-1.0, 0.0), dvec2(1.0, 1.0))),
            f64::INFINITY,
            "{source}"
        );
    }
}
