//! A document, its history, and the mesh that follows it.

use std::sync::Arc;

use crate::operations::{Operation, Scale, domains};
use crate::runs::runs;
use glam::{DVec2, dvec2};
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::document::{
    Document, Example, ExampleData, Follower, History, MeshChange, NoChange, Price, Pricer, SeaChart,
    Setting, Settings, Stage,
};
use meshbrush_core::domain::{
    BoundaryMarks, BoundaryPieces, BoundaryTreatment, BoundaryType, CutShape, Domain, DomainShape,
    NamedPolygon, Polygon, Region, corners,
};
use meshbrush_core::field::{Formula, RefinementRule};
use meshbrush_core::layers::{Layer, LayerId, LayerKind, RasterLayer, RasterReading, RasterSource};
use meshbrush_core::paint::{Brush, DiameterChange, Medium, Mirror, StrokePlan};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{MemoryLimit, Progress};
use meshbrush_mesh::text::Grouped;

/// Returns a square with a square hole.
fn sea() -> Vec<NamedPolygon> {
    let square = |half| corners(&Rect::around(DVec2::splat(3.0), half));
    vec![NamedPolygon { polygon: vec![square(3.0), square(1.0)], name: "Sea".into() }]
}

fn slope() -> Raster {
    let values = (0..64 * 48).map(|i| (i % 97) as f32 / 97.0).collect();
    Raster::from_values(Rect::new(DVec2::ZERO, dvec2(4.0, 3.0)), [64, 48], values)
}

/// A sea with one island that gets deeper westwards.
fn chart() -> SeaChart {
    let ring = |half: DVec2| corners(&Rect::new(dvec2(-3.5, 49.5) - half, dvec2(-3.5, 49.5) + half));
    let polygon = vec![ring(dvec2(3.5, 2.5)), ring(DVec2::splat(0.2))];
    let depths = (0..70 * 50).map(|i| (140 - 2 * (i % 70)) as f32).collect();
    let depths = Raster::from_values(Rect::new(dvec2(-7.0, 47.0), dvec2(0.0, 52.0)), [70, 50], depths);
    SeaChart { sea: vec![NamedPolygon { polygon, name: String::new() }], depths }
}

/// Data that is as large as a test needs.
struct Data;

impl ExampleData for Data {
    fn slope(&self) -> Raster {
        slope()
    }

    fn heights(&self) -> Raster {
        let heights = (0..129 * 129).map(|n| 20.0 * (n % 129) as f32 * ((n / 129) as f32 / 3.0).sin());
        Raster::from_values(Rect::new(dvec2(-84.4, 36.4), dvec2(-84.0, 36.8)), [129, 129], heights.collect())
    }

    fn sea(&self) -> Vec<NamedPolygon> {
        sea()
    }

    fn chart(&self) -> SeaChart {
        chart()
    }
}

fn with_base(base: LayerKind) -> Settings {
    Settings { layers: Layer::default_stack(base), ..Settings::default() }
}

fn risk_layer(name: &str, raster: RasterPyramid) -> LayerKind {
    let source = RasterSource { name: name.into(), raster: Arc::new(raster) };
    RasterLayer { source, reading: RasterReading::Risk }.into()
}

fn settle(follower: &mut Follower, document: &mut Document) {
    for _ in 0..1_000_000 {
        if follower.advance(document, 997).unwrap() == Stage::InStep {
            return;
        }
    }
    panic!("the follower never gets in step");
}

/// As large as a second of edits allows.
const SCALE: Scale = Scale { diameter: 0.01, smallest: 0.01, triangles: 2000 };

#[test]
fn every_example_opens() {
    for example in Example::ALL {
        let mut document = example.document(&Data);
        let follower = Follower::new(&mut document).unwrap();
        assert!(
            follower.mesh().raw_triangle_count() > 5000,
            "{}: {}",
            example.name(),
            follower.mesh().raw_triangle_count()
        );
        assert_eq!(follower.mesh().violations(), []);
    }
}

#[test]
fn the_diamond_is_figure_1() {
    let mut document = Example::Diamond.document(&Data);
    assert_eq!(Follower::new(&mut document).unwrap().mesh().raw_triangle_count(), 9560);
}

#[test]
fn undo_to_the_start_and_redo_to_the_end_are_exact() {
    let mut random = fastrand::Rng::with_seed(12);
    let mut document = Document::new(Settings::default(), None).unwrap();
    let blank = document.paint().clone();
    let mut states = vec![];
    for i in 0..30 {
        states.push((document.settings().clone(), document.paint().clone()));
        match i % 5 {
            3 => document.set(Setting::TransferShape(0.5 + 0.1 * f64::from(i))).unwrap(),
            4 => document.set(Setting::LargestDiameter(0.19 - 0.005 * f64::from(i))).unwrap(),
            _ => Operation::stroke(&mut random, SCALE).apply(&mut document),
        }
        document.end_stroke();
        document.end_gesture();
    }
    let end = (document.settings().clone(), document.paint().clone());
    for state in states.iter().rev() {
        assert!(document.undo());
        assert_eq!(document.settings(), &state.0);
        assert!(document.paint() == &state.1, "{} entries are left", document.history().len());
    }
    assert!(!document.undo());
    assert!(document.paint() == &blank);
    while document.redo() {}
    assert_eq!(document.settings(), &end.0);
    assert!(document.paint() == &end.1);
}

#[test]
fn a_slider_drag_is_one_entry_and_idle_frames_add_none() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    let start = document.settings().clone();
    for i in 1..50 {
        document.set(Setting::Spacing(0.04 + f64::from(i) * 0.001)).unwrap();
    }
    document.end_gesture();
    for _ in 0..100 {
        let spacing = document.settings().spacing;
        document.set(Setting::Spacing(spacing)).unwrap();
        follower.advance(&mut document, 10_000).unwrap();
        document.end_gesture();
    }
    assert_eq!(document.history().len(), 1);
    assert!(document.undo());
    assert_eq!(document.settings(), &start);
}

#[test]
fn what_cannot_be_met_leaves_document_and_mesh_as_they_were() {
    let mut document = Example::Threats.document(&Data);
    let mut follower = Follower::new(&mut document).unwrap();
    let (settings, fingerprint) = (document.settings().clone(), follower.mesh().fingerprint());
    let bad = [
        Setting::Spacing(0.0),
        Setting::Spacing(f64::NAN),
        Setting::Spacing(1e-9),
        Setting::SmallestDiameter(-1.0),
        Setting::LargestDiameter(f64::INFINITY),
        Setting::TransferShape(0.0),
        Setting::Layers(Layer::default_stack(LayerKind::constant(0.0))),
        Setting::Layers(Layer::default_stack(LayerKind::target(Formula::parse("0 / 0").unwrap()))),
        Setting::Gradation(Some(0.0)),
        Setting::Gradation(Some(f64::NAN)),
        Setting::MaxMemory(0),
        Setting::Bounds(Rect::new(DVec2::ONE, DVec2::ZERO)),
    ];
    for setting in bad {
        let message = document.set(setting).unwrap_err().to_string();
        assert!(message.ends_with('.') && message.len() > 30, "{message}");
        assert_eq!(document.settings(), &settings);
    }
    // These are found only while layers are checked or the mesh is refined: the document takes them back.
    let formula = |text| Formula::parse(text).unwrap();
    let base = |text| Setting::Layers(Layer::default_stack(LayerKind::target(formula(text))));
    let late = [
        base("sqrt(0.5 - x)"),
        base("x - 0.7"),
        Setting::MaxTriangles(1300),
        Setting::MaxMemory(1_000_000),
        Setting::Domain(Domain {
            bounds: Rect::UNIT,
            shape: DomainShape::from(formula("x > 2")),
            projection: None,
        }),
    ];
    for setting in late {
        document.set(setting).unwrap();
        document.end_gesture();
        let error = loop {
            if let Err(error) = follower.advance(&mut document, 5000) {
                break error;
            }
        };
        assert!(error.to_string().ends_with('.'), "{error}");
        document.reject_last();
        settle(&mut follower, &mut document);
        assert_eq!((document.settings(), follower.settings()), (&settings, &settings));
        assert_eq!(follower.mesh().fingerprint(), fingerprint);
        assert!(document.history().is_empty() && document.history().redo_title().is_none());
    }
}

/// The oldest gestures are dropped once outlines or pictures pass the limit of the history.
#[test]
fn outlines_and_pictures_count_for_the_memory_limit_of_the_history() {
    let ring = |count: u32| -> Polygon {
        let corner = |k: u32| {
            let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
            DVec2::splat(0.5) + 0.4 * dvec2(angle.cos(), angle.sin())
        };
        vec![(0..count).map(corner).collect()]
    };
    let regions = [60_000, 60_001].map(|count| Region::new(&[ring(count)], Rect::UNIT));
    let raster = RasterPyramid::new(Raster::filled(Rect::UNIT, [2000, 2000], 0.5));
    // 16 bytes a corner, 4 bytes a pixel and a sixth of that for ranges.
    assert!((18_600_000..18_700_000).contains(&raster.bytes()));
    let changes: [(usize, &dyn Fn(usize) -> Setting); 2] = [
        (960_000, &|n| {
            let shape = DomainShape::Region(Arc::new(regions[n % 2].clone()));
            Setting::Domain(Domain { bounds: Rect::UNIT, shape, projection: None })
        }),
        (raster.bytes(), &|n| {
            Setting::Layers(Layer::default_stack(risk_layer(&format!("{n}.png"), raster.clone())))
        }),
    ];
    for (bytes, change) in changes {
        let mut document = Document::new(Settings::default(), None).unwrap();
        let room = History::MAX_BYTES / bytes;
        for n in 0..room + 5 {
            document.set(change(n)).unwrap();
            document.end_gesture();
        }
        let kept = document.history().len();
        // The first entry has neither outline nor picture, and the document holds the last one itself.
        assert!((room - 1..=room + 1).contains(&kept), "{kept} entries of {bytes} bytes");
    }
}

#[test]
fn the_risk_at_a_point_is_the_higher_of_paint_and_picture() {
    // Brightens from left to right, over the left half of the domain only.
    let values = (0..10).map(|column| column as f32 / 10.0).collect();
    let half = Rect::new(DVec2::ZERO, dvec2(0.5, 1.0));
    let base = risk_layer("slope.png", RasterPyramid::new(Raster::from_values(half, [10, 1], values)));
    let mut document = Document::new(with_base(base), None).unwrap();
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 1.0, strength: 0.5 });
    document.draw_to(dvec2(0.1, 0.5));
    document.draw_to(dvec2(0.9, 0.5));
    for (point, risk) in
        [([0.12, 0.5], 0.5), ([0.47, 0.5], 0.9), ([0.8, 0.5], 0.5), ([0.22, 0.9], 0.4), ([0.8, 0.9], 0.0)]
    {
        let found = document.risk_at(DVec2::from_array(point)).unwrap();
        assert!((found - risk).abs() < 1e-6, "{found} at {point:?}");
    }
    assert_eq!(document.risk_at(dvec2(1.1, 0.5)), None);
}

#[test]
fn undo_stops_where_another_document_was_opened() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 0.5, strength: 0.7 });
    document.draw_to(dvec2(0.3, 0.4));
    document.end_stroke();
    document.set(Setting::Spacing(0.1)).unwrap();
    document.undo();
    let (revision, version) = (document.revision(), document.version());
    let diamond = Example::Diamond.document(&Data);
    document.replace_with(diamond.clone());
    assert!(!document.undo() && !document.redo(), "nothing of the former document is kept");
    assert_eq!(document.settings(), diamond.settings());
    assert!(document.paint() == diamond.paint());
    assert!(document.revision() > revision && document.version() > version);
    settle(&mut follower, &mut document);
    assert_eq!(follower.mesh().raw_triangle_count(), 9560);
}

#[test]
fn a_formula_that_is_no_length_at_a_node_is_refused_by_the_vertex_rule_too() {
    // Below zero at a single node, between the middles of all pixels.
    let formula = Formula::parse("if(x == 0.5 and y == 0.5, -1, 0.2)").unwrap();
    let settings = Settings {
        spacing: 0.25,
        rule: RefinementRule::Vertex,
        layers: Layer::default_stack(LayerKind::target(formula)),
        ..Settings::default()
    };
    let error = Follower::new(&mut Document::new(settings, None).unwrap()).unwrap_err();
    assert!(error.to_string().contains("-1 at x = 0.5, y = 0.5"), "{error}");
}

#[test]
fn the_area_rule_implies_the_vertex_rule() {
    let mut document = Example::Threats.document(&Data);
    let follower = Follower::new(&mut document).unwrap();
    let mut by_vertex = document.clone();
    by_vertex.set(Setting::RefinementRule(RefinementRule::Vertex)).unwrap();
    let coarser = Follower::new(&mut by_vertex).unwrap();
    assert!(coarser.mesh().raw_triangle_count() < follower.mesh().raw_triangle_count());
    // No triangle of the area rule's mesh breaks the vertex rule.
    let paint = Some(document.paint());
    let (domain, field) = (follower.domain(), follower.field());
    let mut criterion = RefinementCriterion::new(domain, field, RefinementRule::Vertex, paint);
    assert_eq!(follower.mesh().unsatisfied(|element| criterion.exceeds(element)).unwrap(), []);
}

fn any_brush(random: &mut fastrand::Rng) -> Brush {
    let diameter = |change| Medium::Diameter(0.01, change);
    let media = [
        Medium::Risk(1.0),
        Medium::Risk(0.4),
        Medium::Risk(0.0),
        diameter(DiameterChange::Finer),
        diameter(DiameterChange::Any),
        diameter(DiameterChange::Coarser),
        Medium::Eraser,
        Medium::Eraser,
    ];
    let medium = media[random.usize(..media.len())];
    Brush { medium, radius: 0.15 * random.f64(), hardness: random.f64(), strength: random.f64() }
}

#[test]
fn the_price_of_a_stroke_is_what_it_then_costs() {
    let mut random = fastrand::Rng::with_seed(21);
    let [mut dearer, mut cheaper, mut same] = [0; 3];
    for domain in domains() {
        let settings = Settings { domain, spacing: 0.2, ..Settings::default() };
        let mut document = Document::new(settings, None).unwrap();
        let mut follower = Follower::new(&mut document).unwrap();
        let mut pricer = Pricer::default();
        for stroke in 0..runs(40) {
            let brush = any_brush(&mut random);
            let plan = any_plan(brush, &mut random);
            // Now and then the pointer moves on before the price is known.
            for _ in 0..random.usize(..8) {
                let from = plan.from + 0.01 * random.f64();
                pricer.ask(Some(StrokePlan { from, ..plan }), &document, &follower);
                pricer.advance(&document, &follower, random.usize(1..2000));
            }
            let before = (follower.mesh().triangle_count(), follower.revision(), document.revision());
            let fingerprint_before = follower.mesh().fingerprint();
            pricer.ask(Some(plan), &document, &follower);
            let slice = 1 << random.u32(4..14);
            while pricer.advance(&document, &follower, slice) == Progress::More {}
            let price = pricer.price().unwrap();
            let after = (follower.mesh().triangle_count(), follower.revision(), document.revision());
            assert_eq!(before, after, "asking changes nothing");

            document.begin_mirrored_stroke(brush, plan.mirror);
            [plan.from, plan.to].into_iter().for_each(|point| document.draw_to(point));
            document.end_stroke();
            settle(&mut follower, &mut document);
            let change = follower.mesh().triangle_count() as i64 - before.0 as i64;
            assert_eq!(price.change(), change, "stroke {stroke}: {plan:?}");
            if let Price::Nothing(_) = price {
                assert_eq!((change, fingerprint_before), (0, follower.mesh().fingerprint()), "{plan:?}");
            }
            dearer += usize::from(change > 0);
            cheaper += usize::from(change < 0);
            same += usize::from(change == 0);
        }
    }
    assert!(dearer > 20 && cheaper > 20 && same > 2, "{dearer} {cheaper} {same}");
}

/// Returns a click or a line, in the square and beside it, now and then mirrored.
fn any_plan(brush: Brush, random: &mut fastrand::Rng) -> StrokePlan {
    let mut point = || dvec2(random.f64(), random.f64()) * 1.2 - 0.1;
    let (from, to) = (point(), point());
    let to = if random.bool() { from } else { to };
    let mut line = || (random.usize(..4) == 0).then(|| random.f64());
    StrokePlan { brush, mirror: Mirror { x: line(), y: line() }, from, to }
}

/// With gradation, what the pointer would have painted elsewhere reaches far. It must be forgotten.
#[test]
fn a_price_does_not_depend_on_where_the_pointer_was_before() {
    let mut document =
        Document::new(Settings { spacing: 0.1, ..with_base(LayerKind::constant(0.2)) }, None).unwrap();
    document.set(Setting::Gradation(Some(0.2))).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    let price = |pricer: &mut Pricer, diameter, x| {
        let medium = Medium::Diameter(diameter, DiameterChange::Finer);
        let brush = Brush { medium, radius: 0.04, hardness: 1.0, strength: 1.0 };
        pricer.ask(Some(StrokePlan::click(brush, dvec2(x, 0.5))), &document, &follower);
        while pricer.advance(&document, &follower, 1000) == Progress::More {}
        pricer.price().unwrap()
    };
    let mut kept = Pricer::default();
    for (diameter, x) in [(0.01, 0.3), (0.05, 0.5), (0.02, 0.6), (0.04, 0.4)] {
        let alone = price(&mut Pricer::default(), diameter, x);
        assert!(alone.change() > 0, "{alone:?}");
        assert_eq!(price(&mut kept, diameter, x), alone, "{diameter} at {x}");
    }
}

#[test]
fn the_price_of_a_stroke_that_changes_nothing_says_why() {
    let risk = |aim, radius| Brush { medium: Medium::Risk(aim), radius, hardness: 1.0, strength: 1.0 };
    let diameter = |target, change| Brush { medium: Medium::Diameter(target, change), ..risk(1.0, 0.2) };
    let eraser = Brush { medium: Medium::Eraser, ..risk(1.0, 0.1) };
    let reason = |base: LayerKind, before: &[Brush], brush: Brush, at: DVec2| {
        let settings = Settings { spacing: 0.1, ..with_base(base) };
        let mut document = Document::new(settings, None).unwrap();
        for &brush in before {
            document.begin_stroke(brush);
            document.draw_to(dvec2(0.5, 0.5));
            document.end_stroke();
        }
        let follower = Follower::new(&mut document).unwrap();
        let mut pricer = Pricer::default();
        pricer.ask(Some(StrokePlan::click(brush, at)), &document, &follower);
        while pricer.advance(&document, &follower, 1000) == Progress::More {}
        match pricer.price() {
            Some(Price::Nothing(reason)) => Some(reason),
            _ => None,
        }
    };
    let [middle, beside] = [dvec2(0.5, 0.5), dvec2(3.0, 3.0)];
    let (wide, narrow) = (risk(1.0, 0.3), risk(1.0, 0.02));
    let coarse = || LayerKind::constant(0.2);
    assert_eq!(reason(coarse(), &[], narrow, middle), None, "it refines");
    assert_eq!(reason(coarse(), &[], narrow, beside), Some(NoChange::OutsideField));
    assert_eq!(reason(coarse(), &[wide], narrow, middle), Some(NoChange::PaintedAlready));
    assert_eq!(reason(coarse(), &[], eraser, middle), Some(NoChange::PaintedAlready));
    let at_most_coarse = diameter(0.15, DiameterChange::Finer);
    assert_eq!(reason(coarse(), &[], at_most_coarse, middle), Some(NoChange::CoarserThanGrid));
    let finer = diameter(0.02, DiameterChange::Finer);
    assert_eq!(
        reason(LayerKind::constant(0.01), &[], finer, middle),
        Some(NoChange::LayerDecides(LayerId(0)))
    );
    assert_eq!(
        reason(LayerKind::constant(0.01), &[finer], eraser, middle),
        Some(NoChange::LayerDecides(LayerId(0)))
    );
    assert_eq!(reason(coarse(), &[wide], finer, middle), Some(NoChange::LayerDecides(LayerId(2))));
    // Under a triangle that is finer than its pixels ask for, because of its neighbours.
    let beside_fine = diameter(0.095, DiameterChange::Finer);
    let fine = Brush { radius: 0.1, ..diameter(0.004, DiameterChange::Finer) };
    let dab = Brush { radius: 0.005, ..beside_fine };
    assert_eq!(reason(coarse(), &[fine], dab, dvec2(0.605, 0.5)), Some(NoChange::TrianglesFit));
}

#[test]
fn a_stroke_that_bisects_but_adds_no_triangle_in_the_domain_has_a_price_of_zero() {
    // Along the lower side a strip that is narrower than the cells: of a bisected triangle with its centroid in
    // the strip, one half has its own there, and of the triangle across none of them do.
    let rectangle = |low: DVec2, high: DVec2| vec![corners(&Rect::new(low, high))];
    let polygons = [rectangle(DVec2::ZERO, dvec2(1.0, 0.04)), rectangle(dvec2(0.9, 0.9), DVec2::ONE)];
    let domain = Domain::of_polygons(&polygons).unwrap();
    let boundary = BoundaryTreatment::Fitted { diameter: 0.5 };
    let settings = Settings { domain, boundary, spacing: 0.1, ..with_base(LayerKind::constant(0.5)) };
    let mut document = Document::new(settings, None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    // Between the diameters of levels 0 and 1.
    let medium = Medium::Diameter(0.12, DiameterChange::Finer);
    let dab = Brush { medium, radius: 0.005, hardness: 1.0, strength: 1.0 };
    let at = dvec2(0.05, 0.02);
    let mut pricer = Pricer::default();
    pricer.ask(Some(StrokePlan::click(dab, at)), &document, &follower);
    while pricer.advance(&document, &follower, 1000) == Progress::More {}
    assert_eq!(pricer.price(), Some(Price::Change(0)));

    let before = (follower.mesh().triangle_count(), follower.mesh().raw_triangle_count());
    document.begin_stroke(dab);
    document.draw_to(at);
    document.end_stroke();
    settle(&mut follower, &mut document);
    let after = (follower.mesh().triangle_count(), follower.mesh().raw_triangle_count());
    assert_eq!(after, (before.0, before.1 + 2), "one triangle in the domain and one beyond it are bisected");
}

#[test]
fn there_is_no_price_where_there_can_be_none() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    let mut pricer = Pricer::default();
    let brush = Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 1.0, strength: 1.0 };
    let dab = Some(StrokePlan::click(brush, dvec2(0.5, 0.5)));
    let mut asked = |dab, document: &Document, follower: &Follower| {
        pricer.ask(dab, document, follower);
        while pricer.advance(document, follower, 1000) == Progress::More {}
        pricer.price()
    };
    assert!(matches!(asked(dab, &document, &follower), Some(Price::Change(1..))));
    assert_eq!(asked(None, &document, &follower), None);
    assert_eq!(asked(Some(StrokePlan::click(brush, dvec2(f64::NAN, 0.5))), &document, &follower), None);
    // Nor is there one before the mesh shows what was painted, and while one paints.
    document.begin_stroke(brush);
    document.draw_to(dvec2(0.2, 0.2));
    assert_eq!(asked(dab, &document, &follower), None);
    settle(&mut follower, &mut document);
    assert_eq!(asked(dab, &document, &follower), None);
    document.end_stroke();
    assert!(asked(dab, &document, &follower).is_some());
    document.undo();
    assert_eq!(asked(dab, &document, &follower), None);
    settle(&mut follower, &mut document);
    assert!(asked(dab, &document, &follower).is_some());
}

#[test]
fn a_dab_too_dear_to_count_is_said_to_be() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    document.set(Setting::DiameterAtRiskOne(1e-4)).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    let brush = Brush { medium: Medium::Risk(1.0), radius: 0.3, hardness: 1.0, strength: 1.0 };
    let mut pricer = Pricer::default();
    pricer.ask(Some(StrokePlan::click(brush, dvec2(0.5, 0.5))), &document, &follower);
    while pricer.advance(&document, &follower, 10_000) == Progress::More {}
    assert_eq!(pricer.price(), Some(Price::MoreThan(Price::MOST as i64)));
}

#[test]
fn the_memory_budget_holds_while_one_paints_and_while_another_mesh_is_made() {
    let settings = Settings { max_memory: 2_000_000, ..Settings::default() };
    let mut document = Document::new(settings, None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    let room = 2_000_000 / MemoryLimit::TWO_MESHES;
    let brush = Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 1.0, strength: 1.0 };
    let stroke = |document: &mut Document, y: f64| {
        document.begin_stroke(brush);
        document.draw_to(dvec2(0.1, y));
        document.draw_to(dvec2(0.9, y));
        document.end_stroke();
    };
    stroke(&mut document, 0.2);
    let error = loop {
        match follower.advance(&mut document, 5000) {
            Ok(Stage::InStep) => panic!("the budget was passed"),
            Ok(_) => {}
            Err(error) => break error.to_string(),
        }
    };
    assert!(error.contains("2 MB of memory") && error.contains("which is the limit"), "{error}");
    let count = follower.mesh().raw_triangle_count();
    assert!((room - 100..=room).contains(&count), "{count} of {room}");
    assert!(2 * follower.mesh().bytes() <= 2_000_000);
    assert_eq!(follower.mesh().violations(), []);
    // A larger triangle budget does not help, more memory does.
    document.set(Setting::MaxTriangles(50_000_000)).unwrap();
    while follower.advance(&mut document, 5000).is_ok_and(|stage| !stage.is_settled()) {}
    assert!(follower.mesh().raw_triangle_count() <= room);
    document.set(Setting::MaxMemory(Settings::MAX_MEMORY)).unwrap();
    settle(&mut follower, &mut document);
    let rebuilt = Follower::new(&mut document.clone()).unwrap();
    assert_eq!(follower.mesh().fingerprint(), rebuilt.mesh().fingerprint());
    assert!(follower.mesh().raw_triangle_count() > room);
}

/// Returns a document whose mesh met the triangle budget in the middle of a stroke, with the follower's
/// error.
fn stopped_at_the_budget() -> (Document, Follower, usize) {
    let settings = Settings::default();
    let mut document = Document::new(settings, None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    let budget = follower.mesh().raw_triangle_count() + 3000;
    document.set(Setting::MaxTriangles(budget)).unwrap();
    settle(&mut follower, &mut document);
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.05, hardness: 1.0, strength: 1.0 });
    document.draw_to(dvec2(0.2, 0.3));
    document.draw_to(dvec2(0.8, 0.3));
    document.end_stroke();
    while follower.advance(&mut document, 997).is_ok() {}
    assert!((budget - 100..=budget).contains(&follower.mesh().raw_triangle_count()));
    (document, follower, budget)
}

fn assert_as_from_scratch(follower: &Follower, document: &Document) {
    let rebuilt = Follower::new(&mut document.clone()).unwrap();
    assert_eq!(follower.mesh().fingerprint(), rebuilt.mesh().fingerprint());
    assert_eq!(follower.stopped(), None);
}

#[test]
fn a_mesh_that_met_its_budget_says_so_until_it_is_the_documents_again() {
    let (mut document, mut follower, budget) = stopped_at_the_budget();
    let count = follower.mesh().raw_triangle_count();
    for _ in 0..10 {
        let stage = follower.advance(&mut document, 997).unwrap();
        assert_eq!(stage, Stage::GaveUp(follower.stopped().cloned()), "it is not tried again and again");
        assert!(follower.stopped().unwrap().to_string().contains(&Grouped(budget).to_string()));
        assert!(!follower.is_in_step(&document));
    }
    assert_ne!(follower.stage(), Stage::InStep, "gave up is not in step");
    assert_eq!(follower.mesh().raw_triangle_count(), count);
    // More paint does not help, and says the same.
    Operation::stroke(&mut fastrand::Rng::with_seed(5), SCALE).apply(&mut document);
    document.end_stroke();
    while follower.advance(&mut document, 997).is_ok() {
        assert!(follower.stopped().is_some());
    }
    document.undo();
    assert!(follower.advance(&mut document, usize::MAX).is_err() || follower.stopped().is_some());
    assert_eq!(follower.mesh().violations(), []);
    document.undo();
    settle(&mut follower, &mut document);
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn work_that_a_budget_stopped_goes_on_when_it_is_raised_and_when_paint_is_erased() {
    let (mut document, mut follower, budget) = stopped_at_the_budget();
    follower.take_change();
    document.set(Setting::MaxTriangles(100 * budget)).unwrap();
    settle(&mut follower, &mut document);
    assert!(follower.mesh().raw_triangle_count() > budget);
    assert_as_from_scratch(&follower, &document);
    let change = follower.take_change();
    assert!(matches!(change, Some(MeshChange::Within(_))), "it went on from where it was: {change:?}");

    let (mut document, mut follower, _) = stopped_at_the_budget();
    document.begin_stroke(Brush { medium: Medium::Eraser, radius: 0.1, hardness: 1.0, strength: 1.0 });
    document.draw_to(dvec2(0.26, 0.3));
    document.draw_to(dvec2(0.9, 0.3));
    document.end_stroke();
    settle(&mut follower, &mut document);
    assert!(!document.paint().is_blank());
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn a_setting_changed_there_and_back_makes_no_other_mesh() {
    let mut document = Example::Threats.document(&Data);
    let mut follower = Follower::new(&mut document).unwrap();
    follower.take_change();
    let shape = document.settings().transfer.shape;
    document.set(Setting::TransferShape(2.0 * shape)).unwrap();
    for _ in 0..5 {
        assert_ne!(follower.advance(&mut document, 10_000), Ok(Stage::InStep));
    }
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.05, hardness: 1.0, strength: 1.0 });
    document.draw_to(dvec2(0.9, 0.5));
    document.end_stroke();
    follower.advance(&mut document, 10_000).unwrap();
    document.set(Setting::TransferShape(shape)).unwrap();
    settle(&mut follower, &mut document);
    let change = follower.take_change();
    assert!(matches!(change, Some(MeshChange::Within(_))), "only the stroke: {change:?}");
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn names_and_types_of_the_boundary_are_undone_and_leave_the_mesh_alone() {
    let mut document = Example::Aegean.document(&Data);
    let mut follower = Follower::new(&mut document).unwrap();
    follower.take_change();
    let settings = document.settings().clone();
    let pieces = BoundaryPieces::of_domain(&settings.domain, &settings.boundary_marks).unwrap();
    let names: Vec<&str> = pieces.list().iter().map(|piece| piece.name.as_str()).collect();
    assert_eq!(names, ["open south", "open east", "open north", "open west", "Sea island 1"]);
    let marks = pieces.renamed(&settings.boundary_marks, 4, "Rock");
    let marks = pieces.retyped(&marks, 0, Some(BoundaryType::NaturalInflow));
    document.set(Setting::BoundaryMarks(marks.clone())).unwrap();
    document.end_gesture();
    assert_eq!(document.history().undo_title(), Some("boundary pieces"));
    assert_eq!(follower.advance(&mut document, 1).unwrap(), Stage::InStep);
    assert_eq!((follower.take_change(), follower.settings()), (None, document.settings()));
    // Also while the mesh is busy with a cut.
    let square = CutShape::Ring(corners(&Rect::around(dvec2(1.0, 1.0), 0.5)));
    let cut = document.settings().domain.reshaped(&square, false).unwrap();
    document.set(Setting::Domain(cut)).unwrap();
    document.end_gesture();
    follower.advance(&mut document, 10).unwrap();
    document.set(Setting::BoundaryMarks(BoundaryMarks::default())).unwrap();
    document.end_gesture();
    settle(&mut follower, &mut document);
    assert!(matches!(follower.take_change(), Some(MeshChange::Within(_))), "no other mesh is built");
    assert_as_from_scratch(&follower, &document);
    document.undo();
    assert_eq!(*document.settings().boundary_marks, marks);
    while document.undo() {}
    assert_eq!(*document.settings(), settings);
}

#[test]
fn a_large_outline_is_followed_in_slices_and_cuts_made_meanwhile_join() {
    const VISITS: usize = 2048;
    let corner = |k: u32| {
        let angle = f64::from(k) / 60_000.0 * std::f64::consts::TAU;
        (0.4 + 0.05 * (37.0 * angle).sin()) * dvec2(angle.cos(), angle.sin())
    };
    let coast = Domain::of_polygons(&[vec![(0..60_000).map(corner).collect()]]).unwrap();
    let mut document = Document::new(Settings::for_domain("coast".into(), coast), None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    let cut = |document: &mut Document, at: DVec2| {
        let dab = CutShape::Stroke { path: vec![at], radius: 0.05 };
        let domain = document.settings().domain.reshaped(&dab, false).unwrap();
        document.set(Setting::Domain(domain)).unwrap();
        document.end_gesture();
    };
    let mut outlining = 0;
    cut(&mut document, dvec2(0.4, 0.0));
    while follower.advance(&mut document, VISITS).unwrap() == Stage::Indexing {
        outlining += 1;
        match outlining {
            20 => cut(&mut document, dvec2(-0.4, 0.0)),
            40 => cut(&mut document, dvec2(0.0, 0.4)),
            _ => {}
        }
    }
    // Twice, each with 60,000 edges to compare, to lay and to sort into squares: the cuts in the middle are
    // one.
    assert!(outlining > 2 * 4 * 60_000 / VISITS, "{outlining} slices");
    settle(&mut follower, &mut document);
    assert_as_from_scratch(&follower, &document);

    // A setting in the middle of a cut, and the cut undone in the middle of it.
    cut(&mut document, dvec2(0.0, -0.4));
    assert_eq!(follower.advance(&mut document, VISITS), Ok(Stage::Indexing));
    document.set(Setting::SmallestDiameter(0.01)).unwrap();
    assert_eq!(follower.advance(&mut document, VISITS), Ok(Stage::Indexing));
    settle(&mut follower, &mut document);
    assert_as_from_scratch(&follower, &document);
    document.undo();
    settle(&mut follower, &mut document);
    document.undo();
    assert_eq!(follower.advance(&mut document, VISITS), Ok(Stage::Indexing));
    document.redo();
    assert_eq!(follower.advance(&mut document, VISITS), Ok(Stage::InStep));
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn a_stroke_drawn_in_slices_is_one_entry_once_lifted_and_others_wait_for_it() {
    let blank = || Document::new(Settings::default(), None).unwrap();
    let brush = Brush { medium: Medium::Risk(1.0), radius: 0.3, hardness: 0.5, strength: 0.8 };
    let way = [dvec2(0.2, 0.3), dvec2(0.8, 0.6)];
    let lead = |document: &mut Document| {
        document.begin_stroke(brush);
        way.iter().for_each(|&point| document.extend_stroke(point));
    };
    let mut at_once = blank();
    at_once.begin_stroke(brush);
    way.iter().for_each(|&point| at_once.draw_to(point));
    at_once.end_stroke();

    let mut document = blank();
    lead(&mut document);
    document.finish_stroke();
    assert!(document.stroke().is_some() && document.paint().is_blank());
    let slices = (1..).find(|_| document.advance_stroke(1000) == Progress::Done).unwrap();
    assert!(slices > 50, "{slices}");
    assert_eq!((document.stroke().is_none(), document.history().len()), (true, 1));
    assert!(document.paint() == at_once.paint());

    // Where it is not drawn yet, what comes next finds it drawn; taken back, nothing of it is left.
    let mut document = blank();
    lead(&mut document);
    document.advance_stroke(1000);
    document.set(Setting::Spacing(0.11)).unwrap();
    assert_eq!(document.history().len(), 2);
    assert!(document.paint() == at_once.paint());
    let mut document = blank();
    lead(&mut document);
    document.advance_stroke(1000);
    document.finish_stroke();
    assert!(document.undo() && document.stroke().is_none());
    assert!(document.paint().is_blank() && document.is_stroke_drawn());
    assert_eq!(document.advance_stroke(1000), Progress::Done);
}
