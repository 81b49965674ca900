use glam::{DVec2, dvec2};

use super::KnownParts;
use super::counting::Counting;
use super::gradation::{self, Accuracy, GradationSearch};
use super::parts::LatticeSquare;
use super::place::{ConvexSet, Point};
use super::steepness::slopes;
use crate::domain::{BoundaryMarks, Domain, Ring};
use crate::field::{Formula, Transfer};
use crate::geometry::{Lattice, Rect};
use crate::layers::{
    DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, MedialBalls, PaintLayers, RasterLayer,
    RasterReading, RasterSource, ShapeList, Shapes, SizeField, SizeFieldSpec, Straits, Threat, ThreatLaw,
    Threats,
};
use crate::raster::{Raster, RasterPyramid};

const TRANSFER: Transfer = Transfer::between(0.001, 0.2);

fn field(kinds: impl IntoIterator<Item = LayerKind>, slope: f64) -> SizeField {
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 1 << 30).unwrap();
    let layers = Layer::stack(kinds);
    let spec = SizeFieldSpec {
        layers,
        transfer: TRANSFER,
        unasked: 0.2,
        outline: None,
        gradation: Some(slope),
        projection: None,
    };
    SizeField::new(spec, &lattice)
}

fn random_threat(random: &mut fastrand::Rng) -> Threat {
    Threat {
        at: dvec2(0.3 + 0.4 * random.f64(), 0.3 + 0.4 * random.f64()),
        range: 0.02 + 0.2 * random.f64(),
        peak: 0.5 + 0.5 * random.f64(),
        law: ThreatLaw::ALL[random.usize(..3)].0,
    }
}

/// Returns the least of h(ρ) + g |distance − ρ| over the distances ρ from a threat, by looking closer and
/// closer.
fn radial_referee(field: &SizeField, threat: &Threat, distance: f64, slope: f64) -> f64 {
    let carried = |radius: f64| {
        let at = threat.at + dvec2(radius, 0.0);
        field.stack.ungraded_at(PaintLayers::blank(), at).target + slope * (distance - radius).abs()
    };
    let (mut low, mut high) = (0.0, threat.range.min(distance));
    let mut best = carried(distance);
    for _ in 0..6 {
        let step = (high - low) / 2000.0;
        let radii = (0..=2000).map(|n| low + f64::from(n) * step);
        let (value, radius) = radii
            .map(|radius| (carried(radius), radius))
            .fold((best, low), |a, b| if b.0 <= a.0 { b } else { a });
        best = value;
        (low, high) = ((radius - 20.0 * step).max(0.0), (radius + 20.0 * step).min(distance));
    }
    best
}

#[test]
fn what_a_threat_carries_is_found_up_to_the_tolerance() {
    let mut random = fastrand::Rng::with_seed(41);
    let mut carried = 0;
    for _ in 0..150 {
        let (threat, slope) = (random_threat(&mut random), [0.5, 0.1][random.usize(..2)]);
        let field = field([LayerKind::Threats(Threats::new(vec![threat]).unwrap())], slope);
        let angle = 6.0 * random.f64();
        let distance = threat.range * (0.3 + 1.2 * random.f64());
        let point = threat.at + distance * dvec2(angle.cos(), angle.sin());
        let found = field.target_at(PaintLayers::blank(), point);
        let expected = radial_referee(&field, &threat, distance, slope);
        assert!((found / expected - 1.0).abs() < 2e-6, "{threat:?} {point}: {found}, not {expected}");
        carried += usize::from(found < 0.99 * field.stack.ungraded_at(PaintLayers::blank(), point).target);
    }
    assert!(carried > 60, "{carried}");
}

/// Returns the least value at places along the border of a rectangle, and how far it can be above the least
/// one.
fn least_on_border(rect: &Rect, value: impl Fn(DVec2) -> f64, steepest: f64) -> f64 {
    const COUNT: u32 = 300;
    let share = |n: u32| f64::from(n) / f64::from(COUNT);
    let sides = (0..=COUNT).flat_map(|n| {
        [dvec2(share(n), 0.0), dvec2(share(n), 1.0), dvec2(0.0, share(n)), dvec2(1.0, share(n))]
    });
    let values = sides.map(|at| value(rect.min + at * rect.size()));
    values.fold(f64::INFINITY, f64::min) - steepest * rect.size().max_element() / f64::from(COUNT)
}

#[test]
fn squares_that_are_left_out_have_no_least_value_inside() {
    let mut random = fastrand::Rng::with_seed(42);
    let paint = PaintLayers::blank();
    let mut steep_ones = 0;
    for _ in 0..40 {
        let threats = (0..random.usize(1..4)).map(|_| random_threat(&mut random)).collect();
        let formula = "0.02 + 0.1*abs(sin(7*x + 3*y)) + 0.2*x*y";
        let kinds = [
            LayerKind::target(Formula::parse(formula).unwrap()),
            LayerKind::Threats(Threats::new(threats).unwrap()),
        ];
        let (count, slope) = (random.usize(1..3), 0.05 + 0.5 * random.f64());
        let field = field(kinds.into_iter().skip(2 - count), slope);
        let origin = field.lattice().bounds().min;
        let place = Point(dvec2(random.f64(), random.f64()));
        let value = |p: DVec2| {
            field.stack.ungraded_at(paint, origin + p).target + slope * p.distance(place.nearest(p))
        };
        let search = GradationSearch { stack: &field.stack, paint, place: Point(place.0), slope, finest: 4 };
        let known = &mut KnownParts::default();
        for _ in 0..300 {
            let bits = random.u32(22..30);
            let [column, row] = [0, 0].map(|_| random.u32(0..1 << (30 - bits)));
            let square = LatticeSquare { bits, column, row };
            let Some(cells) = square.cells(field.lattice().extent()) else { continue };
            let id = known.square(&field.stack, paint, square);
            let Some((_, part)) = search.part(known, id, f64::INFINITY) else { continue };
            if search.is_steep(known, id) {
                continue;
            }
            let rect = search.rect(known, id);
            let (of_square, _) = slopes(&field.stack, paint, &cells, Counting::ALL);
            steep_ones += usize::from(of_square.exceed(slope));
            let mut least = least_on_border(&rect, value, of_square.longest() + slope);
            if part.distance == 0.0 {
                least = least.min(value(place.0));
            }
            for _ in 0..100 {
                let at = rect.min + rect.size() * dvec2(random.f64(), random.f64());
                assert!(value(at) >= least * (1.0 - 1e-6), "{square:?} {at}: {} {least}", value(at));
            }
        }
    }
    assert!(steep_ones > 300, "{steep_ones}");
}

/// A ring of water around an island, and what is asked of it: straits, a distance from a line, and pixels.
fn sea(random: &mut fastrand::Rng) -> [LayerKind; 3] {
    let ring = |radius: f64| -> Ring {
        let angle = |n: u32| std::f64::consts::TAU * f64::from(n) / 40.0;
        let radius = |n| radius + 0.03 * (5.0 * angle(n)).sin();
        (0..40).map(|n| dvec2(0.5, 0.5) + radius(n) * DVec2::from_angle(angle(n))).collect()
    };
    let island = ring(0.2 + 0.1 * random.f64()).into_iter().rev().collect();
    let water = Domain::of_polygons(&[vec![ring(0.4), island]]).unwrap();
    let found = MedialBalls::of(&water, &BoundaryMarks::default(), [0.02, 0.5]);
    assert!(!found.discs().is_empty());
    let lines = vec![vec![dvec2(0.1, 0.1), dvec2(random.f64(), 0.9)]];
    let shapes = Shapes::new(ShapeList { lines, ..ShapeList::default() }, false).unwrap();
    let values = (0..256).map(|_| 0.05 + 0.15 * random.f32()).collect();
    let raster = RasterPyramid::new(Raster::from_values(Rect::UNIT, [16; 2], values));
    let source = RasterSource { name: "pixels".into(), raster: std::sync::Arc::new(raster) };
    [
        LayerKind::Straits(Straits { across: 3.0, found }),
        LayerKind::Distance(DistanceLayer {
            to: DistanceTo::Shapes { shapes, name: String::new() },
            at_zero: 0.04 + 0.05 * random.f64(),
            slope: random.f64(),
            range: 0.3,
        }),
        LayerKind::Raster(RasterLayer { source, reading: RasterReading::Diameter }),
    ]
}

#[test]
fn closed_forms_give_a_value_that_is_carried_and_no_more_than_a_search_through_all_layers_finds() {
    let mut random = fastrand::Rng::with_seed(11);
    let (mut by_straits, mut equal) = (0, 0);
    for _ in 0..8 {
        let slope = 0.1 + 0.4 * random.f64();
        let (field, paint) = (field(sea(&mut random), slope), PaintLayers::blank());
        for _ in 0..40 {
            let point = dvec2(random.f64(), random.f64());
            let before = (field.stack.ungraded_at(paint, point).target, point);
            let all = &mut KnownParts::of(Counting::ALL);
            let (searched, _) =
                gradation::least(&field.stack, paint, all, point, (slope, Accuracy::Close), before);
            let decision = field.decision_at(paint, point);
            let found = field.target_at(paint, point);
            assert_eq!(found, decision.target);
            // A search gives up after many rectangles: at straits, h̄ jumps everywhere.
            assert!(found <= searched * (1.0 + 2e-6), "{found} {searched} at {point}");
            equal += usize::from(found > searched * (1.0 - 2e-6));
            let nudges = (0..16).map(|n| decision.from + 1e-9 * DVec2::from_angle(f64::from(n)));
            let carried = nudges
                .chain([decision.from])
                .map(|from| field.stack.ungraded_at(paint, from).target + slope * from.distance(point));
            let carried = carried.fold(f64::INFINITY, f64::min);
            assert!((carried / found - 1.0).abs() < 1e-6, "{carried} {found} at {point}");
            by_straits += usize::from(decision.from != point && decision.layer == Some(LayerId(0)));
        }
    }
    assert!(by_straits > 30 && equal > 200, "{by_straits} {equal}");
}
