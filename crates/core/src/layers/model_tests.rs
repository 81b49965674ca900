use glam::{DVec2, dvec2};

use super::models::{MADE, ModelDomain};
use super::{
    Combine, Layer, LayerKind, LevelCache, Mask, PaintLayers, SizeField, SizeFieldSpec, Threat, ThreatLaw,
    Threats,
};
use crate::field::{Formula, TaylorModel, Transfer};
use crate::geometry::{Lattice, LatticePoint, Rect};
use crate::mesh::bisection_edge_length;

fn threats(random: &mut fastrand::Rng, count: usize, ranges: &[f64]) -> Threats {
    let mut threat = || Threat {
        at: dvec2(random.f64(), random.f64()),
        range: ranges[random.usize(..ranges.len())] * (0.5 + random.f64()),
        peak: [0.0, 1.0, 0.5 * random.f64(), random.f64(), 0.01][random.usize(..5)],
        law: ThreatLaw::ALL[random.usize(..3)].0,
    };
    Threats::new((0..count).map(|_| threat()).collect()).unwrap()
}

fn place(middle: DVec2, half: DVec2) -> ModelDomain {
    let rest = f64::EPSILON * (middle.abs() + half);
    let coordinates =
        [0, 1].map(|axis: usize| TaylorModel::coordinate(axis, middle[axis], half[axis], rest[axis]));
    ModelDomain { coordinates, middle, half, rest }
}

#[test]
fn the_rectangle_of_a_place_is_hardly_larger() {
    let rectangle = Rect::new(dvec2(3.0, -2.0), dvec2(3.5, -1.0));
    let rect = ModelDomain::of_rectangle(&rectangle).rect();
    assert!(rect.contains(rectangle.min) && rect.contains(rectangle.max));
    assert!((rect.size() - rectangle.size()).max_element() < 1e-9);
}

#[test]
fn the_risk_lies_within_its_model() {
    let mut random = fastrand::Rng::with_seed(51);
    let mut narrow = 0;
    for round in 0..1500 {
        let count = [1, 3, 20, 400][round % 4];
        let threats = threats(&mut random, count, &[1e-6, 0.01, 0.1, 0.4, 50.0]);
        for _ in 0..4 {
            let near = threats.list()[random.usize(..count)];
            let toward = near.range * 1.2 * dvec2(random.f64() - 0.5, random.f64() - 0.5) * 2.0;
            let middle = [near.at + toward, dvec2(random.f64(), random.f64())][random.usize(..2)];
            let side = [1e-9, 1e-4, 0.01, 0.1, 0.5][random.usize(..5)];
            let half = side * (0.5 + dvec2(random.f64(), random.f64()));
            let bounded = threats.bounded_model(&place(middle, half));
            let model = bounded.polynomial;
            let bounds = model.bounds().intersection(bounded.bounds);
            narrow += usize::from(bounds.greatest - bounds.least < 0.1);
            for _ in 0..8 {
                let mut share = || 2.0 * random.f64() - 1.0;
                let [u, v] = [share(), share()];
                let risk = threats.risk_at(middle + dvec2(u, v) * half);
                let at_point = model.bounds_over([u, v], [1e-15; 2]);
                assert!(bounds.contains(risk) && at_point.contains(risk), "{risk} {bounds:?} {at_point:?}");
            }
        }
    }
    assert!(narrow > 2500, "{narrow}");
}

/// Places of all sizes at all distances, and around the kinks at 1/2, 3/4 and 1 of the range.
#[test]
fn the_risk_of_one_threat_lies_within_its_model() {
    let mut random = fastrand::Rng::with_seed(54);
    let mut narrow = 0;
    for round in 0..30_000 {
        let law = ThreatLaw::ALL[round % 3].0;
        let range = [1e-3, 0.3, 40.0][random.usize(..3)];
        let at = dvec2(random.f64(), random.f64());
        let peak = [1.0, 1e-4, random.f64()][random.usize(..3)];
        let threats = Threats::new(vec![Threat { at, range, peak, law }]).unwrap();
        let half = range
            * [1e-6, 1e-3, 0.03, 0.1, 0.4][random.usize(..5)]
            * (0.5 + dvec2(random.f64(), random.f64()));
        let distance = [0.5, 0.75, 1.0, 1.2 * random.f64()][random.usize(..4)] * range;
        let beside = half * (2.0 * dvec2(random.f64(), random.f64()) - 1.0);
        let middle = at + distance * DVec2::from_angle(6.3 * random.f64()) + beside;
        let bounded = threats.bounded_model(&place(middle, half));
        let model = bounded.polynomial;
        // Of one threat, however large the place, no bound is beyond the peak.
        let bounds = model.bounds().intersection(bounded.bounds);
        assert!(bounds.greatest <= peak + 1e-12, "{law:?} {peak} {bounds:?}");
        narrow += usize::from(model.remainder() < 1e-3 * peak);
        for n in 0..8 {
            let corner = 2.0 * dvec2(f64::from(n & 1), f64::from(n >> 1 & 1)) - 1.0;
            let share = if n < 4 { corner } else { 2.0 * dvec2(random.f64(), random.f64()) - 1.0 };
            let risk = threats.risk_at(middle + share * half);
            let at_point = model.bounds_over(share.to_array(), [1e-15; 2]);
            let message = format!("{law:?} {risk} {bounds:?} {at_point:?} {middle} {half}");
            assert!(bounds.contains(risk) && at_point.contains(risk), "{message}");
        }
    }
    assert!(narrow > 12_000, "{narrow}");
}

const LONG: [&str; 6] = [
    "0.004+0.003*(sin(17*x+3*y)^2+sin(5*x-31*y)^2+cos(11*x*y)+gauss(hypot(x-0.4,y-0.3),0.1))",
    "if(sin(9*x)+cos(7*y)>0.3, 0.01+0.02*x*y+0.03*abs(x-y), 0.05*max(0.2, sin(20*x)*cos(13*y)+1))",
    "max(0.0125, min(0.05, 0.2*hypot(x-0.5,y-0.5))) + 0*x + 0*y + 0*x*y + 0*sin(x) + 0*cos(y)",
    "0.01+0.02*floor(7*x+sin(3*y))^2+0.05*fract(3*x*y)+0.01*atan2(y-0.5,x-0.5)^2+x-x+y-y",
    "sqrt(x-0.3+0.001*sin(40*y)+0*cos(x)+0*cos(y)+0*tanh(x))*0.1+0.001*exp(-x*y)*ln(2+x)",
    "0.03125+(x-0.5)*(y-0.5)*0.1+0*x+0*y+0*x*y+0*sin(x*y)+0*cos(x-y)+0*x^2+0*y^2",
];

fn stack(random: &mut fastrand::Rng) -> Vec<Layer> {
    let mut layers = Layer::stack(
        (0..random.usize(1..4))
            .map(|_| match random.u32(..4) {
                0 | 1 => LayerKind::target(Formula::parse(LONG[random.usize(..LONG.len())]).unwrap()),
                2 => LayerKind::Threats(threats(random, 40, &[0.01, 0.1, 0.3])),
                _ => LayerKind::risk(
                    Formula::parse(&format!("8*({})", LONG[random.usize(..LONG.len())])).unwrap(),
                ),
            })
            .collect::<Vec<_>>(),
    );
    for layer in &mut layers {
        layer.combine = Combine::ALL[random.usize(..3)];
        if random.u32(..3) == 0 {
            let ring = [dvec2(0.1, 0.1), dvec2(0.9, 0.2), dvec2(0.5, 0.9)];
            layer.mask = Some(Mask::new(&[vec![ring.to_vec()]]).unwrap());
        }
    }
    layers
}

fn field(layers: Vec<Layer>, h_max: f64, lattice: &Lattice) -> SizeField {
    let transfer = Transfer::between(0.0005, h_max);
    let spec =
        SizeFieldSpec { layers, transfer, unasked: h_max, outline: None, gradation: None, projection: None };
    SizeField::new(spec, lattice)
}

/// Returns a triangle that bisection makes, with its level.
fn random_triangle(random: &mut fastrand::Rng, lattice: &Lattice) -> ([LatticePoint; 3], u32) {
    let level = random.u32(6..18);
    let leg = i64::from(lattice.cell_steps() >> (level / 2));
    let extent = lattice.extent();
    let cells = [extent.x, extent.y].map(|steps| i64::from(steps) / leg);
    let [x, y] = cells.map(|count| leg * random.i64(0..count));
    let point = |[i, j]: [i64; 2]| LatticePoint::new((x + i) as u32, (y + j) as u32);
    let square = [[0, 0], [leg, 0], [leg, leg], [0, leg]];
    let turn = random.usize(..4);
    let corner = |n: usize| point(square[(turn + n) % 4]);
    let last = match level % 2 {
        0 => corner(2),
        _ => point([leg / 2, leg / 2]),
    };
    ([corner(0), corner(1), last], level)
}

#[test]
fn models_change_no_answer() {
    let runs = 20 * std::env::var("MESHBRUSH_LONG").map_or(1, |text| text.parse().unwrap());
    let mut random = fastrand::Rng::with_seed(52);
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 1_000_000).unwrap();
    let mut asked = [0; 2];
    for run in 0..runs {
        let layers = stack(&mut random);
        // Where nothing is asked for, h̄ is above all diameters, or one of them: then any risk refines.
        let h_max = [0.2, 0.025, 0.003125][run % 3];
        let with = field(layers, h_max, &lattice);
        let without = with.clone().without_models();
        let (paint, mut squares) = (PaintLayers::blank(), LevelCache::default());
        for _ in 0..60 {
            let (corners, level) = random_triangle(&mut random, &lattice);
            let asks = without.asks_for_more(paint, corners, level);
            assert_eq!(with.asks_for_more(paint, corners, level), asks, "run {run}: {corners:?} {level}");
            assert_eq!(with.asks_for_more_nearby(&mut squares, paint, corners, level), asks, "run {run}");
            asked[usize::from(asks)] += 1;
        }
    }
    assert!(asked.iter().all(|&count| count > runs * 6), "{asked:?}");
}

/// Asks about all triangles of a mesh from scratch with coarse cells of a quarter, and returns how many it
/// has and how often a whole function was evaluated.
fn leaves_and_evaluations(field: &SizeField, lattice: &Lattice) -> [usize; 2] {
    let (paint, mut squares) = (PaintLayers::blank(), LevelCache::default());
    let before = MADE.get();
    let mut leaves = 0;
    // From the two triangles of each cell down the bisection tree: [right angle, and the ends of the longest
    // edge].
    let steps = lattice.cell_steps();
    let cells = (0..16).map(|n| [steps * (n % 4), steps * (n / 4)]);
    let mut open: Vec<([LatticePoint; 3], u32)> = cells
        .flat_map(|[x, y]| {
            let corner = |i: u32, j: u32| LatticePoint::new(x + i * steps, y + j * steps);
            [[corner(1, 0), corner(0, 0), corner(1, 1)], [corner(0, 1), corner(1, 1), corner(0, 0)]]
        })
        .map(|corners| (corners, 0))
        .collect();
    while let Some(([apex, a, b], level)) = open.pop() {
        if !field.asks_for_more_nearby(&mut squares, paint, [apex, a, b], level) {
            leaves += 1;
            continue;
        }
        let middle = LatticePoint::new((a.x + b.x) / 2, (a.y + b.y) / 2);
        open.extend([[middle, apex, a], [middle, b, apex]].map(|corners| (corners, level + 1)));
    }
    [leaves, MADE.get() - before]
}

/// The cost of the area rule follows the mesh, not the length of the formula.
#[test]
fn a_long_sum_is_evaluated_about_once_for_each_triangle() {
    let mut random = fastrand::Rng::with_seed(53);
    let terms: Vec<String> =
        (0..20).map(|_| format!("sin({}*x+{}*y)^2", 30.0 * random.f64(), 30.0 * random.f64())).collect();
    let formula = Formula::parse(&format!("0.002+0.001*({})", terms.join("+"))).unwrap();
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap();
    let field = field(Layer::stack([LayerKind::target(formula)]), 0.2, &lattice);
    let [leaves, made] = leaves_and_evaluations(&field, &lattice);
    assert!(leaves > 1000 && made < 3 * leaves / 2, "{made} evaluations for {leaves} triangles");
}

/// Along the edge of a plateau of the risk, models of a square are never close. But none asks for more than
/// the plateau does.
#[test]
fn the_edge_of_a_plateau_that_is_just_satisfied_needs_few_evaluations() {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap();
    // The target of the plateau is 0.1 % above the diameter of level 9.
    let [h_min, h_max] = [0.0005f64, 0.2];
    let asked: f64 = 1.001 * bisection_edge_length(lattice.spacing(), 9);
    let peak = (h_max / asked).ln() / (h_max / h_min).ln();
    for law in [ThreatLaw::Radar, ThreatLaw::Disc] {
        let list = (0..9).map(|n| Threat { at: dvec2(0.1 * f64::from(n), 0.43), range: 0.049, peak, law });
        let threats = Threats::new(list.collect()).unwrap();
        let field = field(Layer::stack([threats]), h_max, &lattice);
        let [leaves, made] = leaves_and_evaluations(&field, &lattice);
        assert!(made < 20 * leaves, "{law:?}: {made} evaluations for {leaves} triangles");
    }
}
