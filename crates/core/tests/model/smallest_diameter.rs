//! The smallest diameter, the diameter at risk 1, and the price of lowering them.

use glam::dvec2;
use meshbrush_core::document::{Document, Follower, Price, Setting, Settings, TransferPricer};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Progress;

use crate::runs::runs;

/// Paints with the middle of a brush at a point.
fn dab(document: &mut Document, medium: Medium, radius: f64, [x, y]: [f64; 2]) {
    document.begin_stroke(Brush { medium, radius, hardness: 0.5, strength: 1.0 });
    document.draw_to(dvec2(x, y));
    document.end_stroke();
}

fn settle(follower: &mut Follower, document: &mut Document) {
    while !follower.advance(document, 1000).unwrap().is_settled() {}
}

#[test]
fn the_price_of_other_limits_is_what_they_then_cost() {
    let mut random = fastrand::Rng::with_seed(22);
    let [mut local, mut spread] = [0; 2];
    for run in 0..runs(24) {
        let settings = Settings {
            layers: Layer::default_stack(LayerKind::constant(0.05 + 0.1 * random.f64())),
            spacing: 0.2,
            transfer: Transfer { h_min: 0.02, h_risk: 0.03, h_max: 0.2, shape: 1.0 },
            ..Settings::default()
        };
        let mut document = Document::new(settings, None).unwrap();
        for medium in [Medium::Risk(1.0), Medium::Diameter(0.008, DiameterChange::Finer)] {
            let (radius, at) = (0.05 + 0.1 * random.f64(), [random.f64(), random.f64()]);
            dab(&mut document, medium, radius, at);
        }
        let mut follower = Follower::new(&mut document).unwrap();
        let lowered = document.settings().transfer.with_smallest(0.01);
        let transfer = if run % 2 == 0 { lowered } else { Transfer { h_risk: 0.01, ..lowered } };
        let area = Rect::around(dvec2(0.5, 0.5), random.f64());
        let mut pricer = TransferPricer::default();
        pricer.ask(Some((transfer, area)), &document, &follower);
        while pricer.advance(&document, &follower, 1 + random.usize(..500)) == Progress::More {}
        let price = pricer.price().unwrap();
        let before = follower.mesh().triangle_count() as i64;
        let setting = if run % 2 == 0 { Setting::SmallestDiameter } else { Setting::DiameterAtRiskOne };
        document.set(setting(0.01)).unwrap();
        assert_eq!(document.settings().transfer, transfer);
        settle(&mut follower, &mut document);
        let change = follower.mesh().triangle_count() as i64 - before;
        assert_eq!(price.everywhere, Price::Change(change), "run {run}");
        let Some(Price::Change(elsewhere)) = price.elsewhere() else { panic!("counted: run {run}") };
        assert!((0..=change).contains(&elsewhere), "{elsewhere} of {change}");
        local += usize::from(elsewhere < change);
        spread += usize::from(elsewhere > 0);
    }
    assert!(local > 5 && spread > 5, "{local} {spread}");
}

/// Risk decides the mesh, and a smaller limit leaves it alone; so does what is derived from it.
#[test]
fn a_smaller_limit_changes_only_what_it_limited() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    dab(&mut document, Medium::Risk(1.0), 0.1, [0.5, 0.5]);
    let mut follower = Follower::new(&mut document).unwrap();
    let before = follower.mesh().fingerprint();
    document.set(Setting::SmallestDiameter(0.0001)).unwrap();
    settle(&mut follower, &mut document);
    assert_eq!(follower.mesh().fingerprint(), before);
    document.set(Setting::DiameterAtRiskOne(0.002)).unwrap();
    settle(&mut follower, &mut document);
    assert_ne!(follower.mesh().fingerprint(), before);
    let from_scratch = Follower::new(&mut document).unwrap();
    assert_eq!(follower.mesh().fingerprint(), from_scratch.mesh().fingerprint());
}
