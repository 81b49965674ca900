//! The price of a stroke where every edit makes another mesh: close to a surface, and by the vertex rule.

use glam::dvec2;
use meshbrush_core::document::{Document, Follower, LEAST_MEMORY, NoChange, Price, Pricer, Settings, Stage};
use meshbrush_core::field::{Formula, RefinementRule};
use meshbrush_core::layers::{
    Layer, LayerId, LayerKind, Quantity, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium, StrokePlan};
use meshbrush_mesh::mesh::Progress;

use crate::runs::runs;

/// Layers for all kinds of paint above a surface within an error.
fn close_to_a_surface() -> Vec<Layer> {
    let source = SurfaceSource::Formula(Formula::parse("x^2 + y * x").unwrap());
    let surface = Surface { source, goal: SurfaceGoal::Within(0.01), norm: SurfaceNorm::Largest };
    let mut layers = Layer::default_stack(LayerKind::constant(0.4));
    layers.push(Layer::new(LayerId(10), "Surface", LayerKind::Surface(surface)));
    layers.push(Layer::new(LayerId(11), "Painted error", LayerKind::paint(Quantity::Error)));
    layers
}

fn price(pricer: &mut Pricer, plan: StrokePlan, document: &Document, follower: &Follower) -> Price {
    pricer.ask(Some(plan), document, follower);
    while pricer.advance(document, follower, 300) == Progress::More {}
    pricer.price().expect("the mesh is small")
}

fn paint(document: &mut Document, follower: &mut Follower, plan: StrokePlan) {
    document.begin_stroke(plan.brush);
    document.draw_to(plan.from);
    document.end_stroke();
    let settled = (0..100_000).any(|_| follower.advance(document, 997).unwrap() == Stage::InStep);
    assert!(settled);
}

#[test]
fn the_price_is_what_the_stroke_then_costs() {
    let finer = Medium::Diameter(0.02, DiameterChange::Finer);
    let cases = [
        (close_to_a_surface(), RefinementRule::Area, [Medium::Error(1e-4), finer, Medium::Eraser]),
        (
            Layer::default_stack(LayerKind::constant(0.2)),
            RefinementRule::Vertex,
            [Medium::Risk(1.0), finer, Medium::Eraser],
        ),
    ];
    let mut random = fastrand::Rng::with_seed(33);
    for (layers, rule, media) in cases {
        let settings = Settings { spacing: 0.2, rule, layers, ..Settings::default() };
        let mut document = Document::new(settings, None).unwrap();
        let mut follower = Follower::new(&mut document).unwrap();
        let mut pricer = Pricer::default();
        let [mut dearer, mut cheaper, mut same] = [0; 3];
        for run in 0..runs(24) {
            let medium = media[random.usize(..3)];
            let brush = Brush { medium, radius: 0.03 + 0.1 * random.f64(), hardness: 1.0, strength: 1.0 };
            let plan = StrokePlan::click(brush, dvec2(random.f64(), random.f64()));
            // The pointer was elsewhere before, and the price was perhaps not known.
            let before = StrokePlan::click(brush, dvec2(random.f64(), random.f64()));
            pricer.ask(Some(before), &document, &follower);
            for _ in 0..random.usize(..20) {
                pricer.advance(&document, &follower, 100);
            }
            let expected = price(&mut pricer, plan, &document, &follower);
            let (count, fingerprint) = (follower.mesh().triangle_count(), follower.mesh().fingerprint());
            paint(&mut document, &mut follower, plan);
            let change = follower.mesh().triangle_count() as i64 - count as i64;
            assert_eq!(expected.change(), change, "run {run}: {plan:?}");
            if let Price::Nothing(_) = expected {
                assert_eq!(fingerprint, follower.mesh().fingerprint(), "run {run}: {plan:?}");
            }
            dearer += usize::from(change > 0);
            cheaper += usize::from(change < 0);
            same += usize::from(change == 0);
        }
        assert!(dearer > 2 && cheaper > 0 && same > 0, "{rule:?}: {dearer} {cheaper} {same}");
    }
}

#[test]
fn an_error_that_the_mesh_keeps_already_is_no_matter_of_diameters() {
    let settings = Settings { spacing: 0.2, layers: close_to_a_surface(), ..Settings::default() };
    let mut document = Document::new(settings, None).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    let brush = Brush { medium: Medium::Error(0.5), radius: 0.01, hardness: 1.0, strength: 1.0 };
    let dab = StrokePlan::click(brush, dvec2(0.93, 0.07));
    let found = price(&mut Pricer::default(), dab, &document, &follower);
    assert_eq!(found, Price::Nothing(NoChange::TrianglesFit));
}

/// The price was said to be over 500,000 where less was too much for the memory of the document.
#[test]
fn a_price_that_the_memory_of_the_document_has_no_room_for_is_counted() {
    let (layers, max_memory) = (close_to_a_surface(), LEAST_MEMORY);
    let settings = Settings { spacing: 0.2, layers, max_memory, ..Settings::default() };
    let room = settings.limits().most_triangles();
    let mut document = Document::new(settings, None).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    let medium = Medium::Diameter(0.0024, DiameterChange::Finer);
    let brush = Brush { medium, radius: 0.12, hardness: 1.0, strength: 1.0 };
    let dab = StrokePlan::click(brush, dvec2(0.5, 0.5));
    match price(&mut Pricer::default(), dab, &document, &follower) {
        Price::Change(change) => assert!(change > room as i64, "{change} of {room}"),
        other => panic!("{other:?} beside a room of {room}"),
    }
}
