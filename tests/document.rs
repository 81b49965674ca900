//! A document, its history, and the mesh that follows it.

mod operations;

use glam::{DVec2, dvec2};
use meshbrush::document::{Base, Document, Example, Follower, Setting, Settings, Stage};
use meshbrush::domain::{Domain, Polygon, Shape, corners};
use meshbrush::field::{Formula, Rule, VertexRule};
use meshbrush::geometry::Rect;
use meshbrush::raster::Raster;
use operations::{Choices, Driver, Operation, Scale, domains, run_bytes};

/// A square with a square hole.
fn sea() -> Vec<Polygon> {
    let square = |half| corners(&Rect::around(DVec2::splat(3.0), half));
    vec![vec![square(3.0), square(1.0)]]
}

fn slope() -> Raster {
    let values = (0..64 * 48).map(|i| (i % 97) as f32 / 97.0).collect();
    Raster::from_values(Rect::new(DVec2::ZERO, dvec2(4.0, 3.0)), [64, 48], values)
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
const SCALE: Scale = Scale { diameter: 0.01, pixels: 100, triangles: 2000 };

impl Choices for fastrand::Rng {
    fn below(&mut self, count: usize) -> usize {
        self.usize(..count)
    }

    fn share(&mut self) -> f64 {
        self.f64()
    }
}

#[test]
fn every_example_opens() {
    for example in Example::ALL {
        let mut document = example.document(slope, sea);
        let follower = Follower::new(&mut document).unwrap();
        assert!(
            follower.mesh().triangles().len() > 5000,
            "{}: {}",
            example.name(),
            follower.mesh().triangles().len()
        );
        assert_eq!(follower.mesh().violations(), []);
    }
}

#[test]
fn the_diamond_is_figure_1() {
    let mut document = Example::Diamond.document(slope, sea);
    assert_eq!(Follower::new(&mut document).unwrap().mesh().triangles().len(), 9560);
}

/// `MESHBRUSH_EDITS` says how many edits; the default takes a second.
#[test]
fn after_any_edits_the_mesh_is_the_one_made_from_scratch() {
    let edits: usize = std::env::var("MESHBRUSH_EDITS").map_or(600, |n| n.parse().unwrap());
    let mut random = fastrand::Rng::with_seed(11);
    let [mut in_place, mut compared] = [0; 2];
    for domain in domains() {
        let settings = Settings { domain, resolution: 128, spacing: 0.2, ..Settings::default() };
        let mut driver = Driver::new(settings.clone());
        for edit in 0..edits / 3 {
            if edit % 100 == 99 {
                // Paint piles up until strokes change nothing any more: begin with a blank document now and then.
                driver = Driver::new(settings.clone());
            }
            driver.apply(Operation::choose(&mut random, SCALE));
            // Often the next edit comes while the mesh is still in the making.
            if random.bool() {
                let before = driver.changes_within;
                // The field is read first: with few slices the mesh would never be cut.
                (0..random.usize(1..40)).for_each(|_| driver.advance(random.usize(1..3000)));
                in_place += driver.changes_within - before;
            } else {
                let before = driver.compared;
                driver.settle();
                compared += driver.compared - before;
            }
        }
    }
    assert!(in_place > edits / 20 && compared > edits / 3, "{in_place} {compared} of {edits}");
}

/// What `fuzz/` runs, on a few bytes.
#[test]
fn edits_from_bytes_hold_what_random_edits_do() {
    let mut random = fastrand::Rng::with_seed(13);
    for _ in 0..200 {
        let bytes: Vec<u8> = (0..random.usize(..300)).map(|_| random.u8(..)).collect();
        run_bytes(&bytes);
    }
}

#[test]
fn undo_to_the_start_and_redo_to_the_end_are_exact() {
    let mut random = fastrand::Rng::with_seed(12);
    let mut document = Document::new(Settings { resolution: 200, ..Settings::default() }, None).unwrap();
    let blank = document.layers().clone();
    let mut states = vec![];
    for i in 0..30 {
        states.push((document.settings().clone(), document.layers().clone()));
        match i % 5 {
            3 => document.set(Setting::Resolution(150 + i)).unwrap(),
            4 => document.set(Setting::LargestDiameter(0.19 - 0.005 * f64::from(i))).unwrap(),
            _ => Operation::stroke(&mut random).apply(&mut document),
        }
        document.end_gesture();
    }
    let end = (document.settings().clone(), document.layers().clone());
    for state in states.iter().rev() {
        assert!(document.undo());
        assert_eq!((document.settings(), document.layers()), (&state.0, &state.1));
    }
    assert!(!document.undo());
    assert_eq!(document.layers(), &blank);
    while document.redo() {}
    assert_eq!((document.settings(), document.layers()), (&end.0, &end.1));
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
    let mut document = Example::Threats.document(slope, sea);
    let mut follower = Follower::new(&mut document).unwrap();
    let (settings, fingerprint) = (document.settings().clone(), follower.mesh().fingerprint());
    let bad = [
        Setting::Spacing(0.0),
        Setting::Spacing(f64::NAN),
        Setting::Spacing(1e-9),
        Setting::SmallestDiameter(-1.0),
        Setting::LargestDiameter(f64::INFINITY),
        Setting::TransferShape(0.0),
        Setting::Base(Base::Constant(0.0)),
        Setting::Resolution(0),
        Setting::Bounds(Rect::new(DVec2::ONE, DVec2::ZERO)),
    ];
    for setting in bad {
        let message = document.set(setting).unwrap_err().to_string();
        assert!(message.ends_with('.') && message.len() > 30, "{message}");
        assert_eq!(document.settings(), &settings);
    }
    // These are found only while sampling or refining: the document takes them back.
    let formula = |text| Formula::parse(text).unwrap();
    let late = [
        Setting::Base(Base::Formula(formula("sqrt(0.5 - x)"))),
        Setting::Base(Base::Formula(formula("x - 0.7"))),
        Setting::Base(Base::Formula(formula("1 / 0"))),
        Setting::MaxTriangles(1300),
        Setting::Domain(Domain { bounds: Rect::UNIT, shape: Shape::Formula(formula("x > 2")) }),
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

#[test]
fn a_formula_that_is_no_length_at_a_node_is_refused_by_the_vertex_rule_too() {
    // Below zero at a single node, between the middles of all pixels.
    let formula = Formula::parse("if(x == 0.5 and y == 0.5, -1, 0.2)").unwrap();
    let settings =
        Settings { spacing: 0.25, rule: Rule::Vertex, base: Base::Formula(formula), ..Settings::default() };
    let error = Follower::new(&mut Document::new(settings, None).unwrap()).unwrap_err();
    assert!(error.to_string().contains("-1 at x = 0.5, y = 0.5"), "{error}");
}

#[test]
fn the_area_rule_implies_the_vertex_rule() {
    let mut document = Example::Threats.document(slope, sea);
    let follower = Follower::new(&mut document).unwrap();
    let mut by_vertex = document.clone();
    by_vertex.set(Setting::Rule(Rule::Vertex)).unwrap();
    let coarser = Follower::new(&mut by_vertex).unwrap();
    assert!(coarser.mesh().triangles().len() < follower.mesh().triangles().len());
    // No triangle of the area rule's mesh breaks the vertex rule.
    let (field, paint) = (follower.field(), document.layers().as_paint());
    let mut rule = VertexRule::new(|point| field.target_at_node(paint, point));
    assert_eq!(follower.mesh().unsatisfied(|element| rule.exceeds(element)).unwrap(), []);
}
