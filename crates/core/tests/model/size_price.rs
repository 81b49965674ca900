//! Estimates of the number of triangles, against the meshes that are then made.

use glam::dvec2;
use meshbrush_core::document::{
    CountEstimate, Document, Example, ExampleData, Follower, Price, Setting, Settings, SizePricer,
};
use meshbrush_core::domain::NamedPolygon;
use meshbrush_core::field::{Formula, RefinementRule};
use meshbrush_core::layers::{
    DistanceLayer, DistanceTo, Layer, LayerKind, ShapeList, Shapes, Threat, ThreatLaw, Threats,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_mesh::mesh::Progress;

/// Estimates are within this factor of the true number.
const FACTOR: f64 = 1.25;

/// Returns the estimate for settings on the mesh of a document.
fn estimate(settings: &Settings, document: &Document, follower: &Follower) -> f64 {
    let mut estimate = CountEstimate::new(settings, follower).unwrap();
    while estimate.advance(document, follower, 500) == Progress::More {}
    estimate.triangles() as f64
}

/// Estimates what settings would need, then makes the mesh. Returns both numbers.
fn estimated_and_made(mut document: Document, settings: &[Setting]) -> [f64; 2] {
    let follower = Follower::new(&mut document).unwrap();
    let wanted = settings
        .iter()
        .fold(document.settings().clone(), |settings, setting| setting.clone().applied_to(&settings));
    let estimated = estimate(&wanted, &document, &follower);
    let mut made = Document::new(wanted, Some(document.paint().clone())).unwrap();
    let made = Follower::new(&mut made).unwrap().mesh().triangle_count() as f64;
    [estimated, made]
}

fn document(layer: LayerKind) -> Document {
    let settings = Settings { layers: Layer::stack([layer]), ..Settings::default() };
    Document::new(settings, None).unwrap()
}

/// A distance to a slanted line: fine triangles along a curve, as on a coast.
fn line() -> LayerKind {
    let line = vec![dvec2(0.05, 0.13), dvec2(0.4, 0.6), dvec2(0.93, 0.71)];
    let shapes = Shapes::new(ShapeList { lines: vec![line], ..ShapeList::default() }, false).unwrap();
    let to = DistanceTo::Shapes { name: String::new(), shapes };
    DistanceLayer { to, at_zero: 0.0005, slope: 0.2, range: 2.0 }.into()
}

fn threats() -> LayerKind {
    let at = [[0.2, 0.3], [0.7, 0.8], [0.6, 0.2]];
    let threat = |at| Threat { at, range: 0.2, peak: 1.0, law: ThreatLaw::ALL[0].0 };
    Threats::new(at.map(|[x, y]| threat(dvec2(x, y))).to_vec()).unwrap().into()
}

struct Coast(NamedPolygon);

impl ExampleData for Coast {
    fn sea(&self) -> Vec<NamedPolygon> {
        vec![self.0.clone()]
    }
}

/// A sea with a ragged coast, finer along it.
fn coast() -> Document {
    let corner = |n: usize| {
        let angle = std::f64::consts::TAU * n as f64 / 240.0;
        (4.0 + 0.5 * (7.0 * angle).sin() + 0.2 * (31.0 * angle).cos()) * dvec2(angle.cos(), angle.sin())
    };
    let sea = NamedPolygon { polygon: vec![(0..240).map(corner).collect()], name: String::new() };
    Example::Aegean.document(&Coast(sea))
}

/// The default document with a diameter painted in one small place.
fn painted() -> Document {
    let mut document = Document::new(Settings::default(), None).unwrap();
    let medium = Medium::Diameter(0.0005, DiameterChange::Finer);
    document.begin_stroke(Brush { medium, radius: 0.03, hardness: 0.5, strength: 1.0 });
    document.draw_to(dvec2(0.31, 0.62));
    document.end_stroke();
    document
}

#[test]
fn an_estimate_is_close_to_the_mesh_that_is_made() {
    let formula = |text| LayerKind::target(Formula::parse(text).unwrap());
    let uniform = || document(LayerKind::constant(0.2));
    let point = "0.0004 + 0.02*hypot(x - 0.3, y - 0.6)";
    for (name, document, settings) in [
        ("uniform", uniform(), vec![Setting::LargestDiameter(0.003)]),
        ("no change", uniform(), vec![]),
        ("line", document(line()), vec![Setting::SmallestDiameter(0.0005)]),
        (
            "line, graded",
            document(line()),
            vec![Setting::SmallestDiameter(0.0008), Setting::Gradation(Some(0.1))],
        ),
        ("point", document(formula(point)), vec![Setting::SmallestDiameter(0.0003)]),
        ("step", document(formula("if(x < 0.37, 0.002, 0.2)")), vec![Setting::SmallestDiameter(0.001)]),
        ("threats", document(threats()), vec![Setting::DiameterAtRiskOne(0.001)]),
        ("painted", painted(), vec![Setting::SmallestDiameter(0.0003)]),
        (
            "vertex rule",
            document(formula("0.002 + 0.1*abs(x - y)")),
            vec![Setting::SmallestDiameter(0.0015), Setting::RefinementRule(RefinementRule::Vertex)],
        ),
        ("coast", coast(), vec![]),
        ("coast, finer", coast(), vec![Setting::LargestDiameter(0.02)]),
    ] {
        let [estimated, made] = estimated_and_made(document, &settings);
        eprintln!("{name}: about {estimated}, made {made}: {:.3}", estimated / made);
        assert!((1.0 / FACTOR..FACTOR).contains(&(estimated / made)), "{name}: {estimated} of {made}");
    }
}

/// Returns the price of a setting, as it is computed in slices.
fn price(setting: Setting, document: &Document, follower: &Follower) -> Option<Price> {
    let mut pricer = SizePricer::default();
    let settings = setting.applied_to(document.settings());
    pricer.ask(Some(&settings), document, follower);
    while pricer.advance(document, follower, 300) == Progress::More {}
    pricer.price()
}

#[test]
fn the_price_of_a_setting_is_counted_and_beyond_that_estimated() {
    let mut document = document(line());
    let mut follower = Follower::new(&mut document).unwrap();
    for setting in [Setting::Gradation(Some(0.15)), Setting::LargestDiameter(0.05)] {
        let before = follower.mesh().triangle_count() as i64;
        let price = price(setting.clone(), &document, &follower);
        document.set(setting).unwrap();
        while !follower.advance(&mut document, 1000).unwrap().is_settled() {}
        let change = follower.mesh().triangle_count() as i64 - before;
        assert!(change > 0);
        assert_eq!(price, Some(Price::Change(change)));
    }
    // 75 million triangles would take minutes to count. For a uniform mesh their number is known.
    let Some(Price::About(change)) = price(Setting::LargestDiameter(0.0003), &document, &follower) else {
        panic!("an estimate")
    };
    let level_diameter = (1.0 / 24.0) * 2f64.sqrt() / 2f64.powi(8);
    let uniform = 4.0 / level_diameter.powi(2);
    let all = change as f64 + follower.mesh().triangle_count() as f64;
    assert!((0.8..1.25).contains(&(all / uniform)), "{all} of {uniform}");
    document.set(Setting::RefinementRule(RefinementRule::Vertex)).unwrap();
    while !follower.advance(&mut document, 1000).unwrap().is_settled() {}
    assert_eq!(price(Setting::Gradation(None), &document, &follower), None, "every edit builds another mesh");
}
