//! What an edit costs, where there is no answer, and what is counted and equal.

use glam::dvec2;
use meshbrush_core::build::MeshSpec;
use meshbrush_core::document::{CountEstimate, Document, Follower, PathPlan, Setting, Settings, SizePricer};
use meshbrush_core::domain::{BoundaryTreatment, Domain, DomainShape};
use meshbrush_core::field::{Formula, RefinementRule};
use meshbrush_core::layers::{Layer, LayerKind, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource};
use meshbrush_core::paint::{Brush, Medium};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress};

use super::spec;

/// Settings that differ from others in the coarse grid, the domain or the treatment of its boundary alone.
fn other_grids(default: &Settings) -> [Settings; 3] {
    let shape = DomainShape::from(Formula::parse("x > -9").unwrap());
    let domain = Domain { shape, ..default.domain.clone() };
    assert_ne!(default.boundary, BoundaryTreatment::Report);
    [
        Settings { spacing: 0.5 * default.spacing, ..default.clone() },
        Settings { domain, ..default.clone() },
        Settings { boundary: BoundaryTreatment::Report, ..default.clone() },
    ]
}

#[test]
fn there_is_no_estimate_where_the_coarse_grid_is_another() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    let default = document.settings();
    assert!(CountEstimate::new(default, &follower).is_some());
    for other in other_grids(default) {
        assert!(CountEstimate::new(&other, &follower).is_none(), "{other:?}");
    }
    let [spacing, domain, _] = other_grids(default);
    for (settings, has_price) in [(default.clone(), true), (spacing, false), (domain, false)] {
        let mut pricer = SizePricer::default();
        pricer.ask(Some(&settings), &document, &follower);
        assert_eq!(pricer.progress() == Progress::More, has_price, "{settings:?}");
    }
}

#[test]
fn goals_of_other_norms_stay() {
    let norms = [SurfaceNorm::Largest, SurfaceNorm::RootMeanSquare, SurfaceNorm::Gradient];
    let goal = SurfaceGoal::Within(0.01);
    let source = SurfaceSource::Formula(Formula::parse("x*y").unwrap());
    let kinds = norms.map(|norm| LayerKind::Surface(Surface { source: source.clone(), goal, norm }));
    let domain = Domain::rectangle(Rect::UNIT);
    let mesh = MeshSpec {
        lattice: Lattice::covering(domain.bounds, 0.25, 100).unwrap(),
        domain,
        boundary: BoundaryTreatment::Report,
        lines: Default::default(),
        field: spec(Layer::stack(kinds)),
        rule: RefinementRule::Area,
        cleaning: Cleaning::NONE,
        limits: Limits::default(),
    };
    for norm in norms {
        let layers = mesh.clone().without_goals(norm).field.layers;
        for layer in &layers {
            let Some(surface) = layer.kind.get::<Surface>() else { panic!("{layer:?}") };
            let expected = if surface.norm == norm { SurfaceGoal::AtMost(usize::MAX) } else { goal };
            assert_eq!(surface.goal, expected, "{norm:?}");
        }
        assert_eq!(layers.len(), 3);
    }
}

#[test]
fn the_usual_surface_is_a_hill_of_a_quarter_of_the_shorter_side() {
    for (size, width) in [(dvec2(8.0, 20.0), 2.0), (dvec2(400.0, 300.0), 50.0), (dvec2(0.02, 0.02), 0.005)] {
        let bounds = Rect::new(dvec2(3.0, -5.0), dvec2(3.0, -5.0) + size);
        let LayerKind::Surface(surface) = LayerKind::default_surface(&bounds) else { panic!("a surface") };
        let SurfaceSource::Formula(formula) = &surface.source else { panic!("a formula") };
        for (away, height) in [(0.0, 1.0), (width, (-1.0_f64).exp()), (2.0 * width, (-4.0_f64).exp())] {
            let at = bounds.center() + dvec2(0.6, -0.8) * away;
            assert!((formula.eval(at.x, at.y) - height).abs() < 1e-9, "{size} {away}");
        }
    }
}

/// A stroke that was drawn to its last point ends at once: nothing more is drawn in the next frame.
#[test]
fn a_stroke_that_is_drawn_ends_when_the_pointer_is_lifted() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    let brush = Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 0.5, strength: 1.0 };
    document.begin_stroke(brush);
    document.draw_to(dvec2(0.4, 0.4));
    document.draw_to(dvec2(0.6, 0.5));
    while document.advance_stroke(1) == Progress::More {}
    assert!(document.is_stroke_drawn() && document.is_in_gesture());
    document.finish_stroke();
    assert!(!document.is_in_gesture());
}

#[test]
fn the_memory_of_a_plan_for_paths_grows_with_its_names() {
    let plan = |names: &[&str]| PathPlan {
        names: names.iter().map(|&name| name.into()).collect(),
        ..PathPlan::default()
    };
    let sizes = [plan(&[]), plan(&["ab"]), plan(&["abcdefgh"]), plan(&["ab", "cd"])].map(|plan| plan.bytes());
    let name = size_of::<String>();
    assert!(sizes[1] >= sizes[0] + name + 2, "{sizes:?}");
    assert!(sizes[2] >= sizes[0] + name + 8 && sizes[3] >= sizes[0] + 2 * name + 4, "{sizes:?}");
}

/// A mesh that is made again can fail long after somebody has changed the settings that make it too large.
#[test]
fn a_mistake_that_was_taken_back_meanwhile_is_not_reported() {
    let settings = Settings { rule: RefinementRule::Vertex, ..Settings::default() };
    let mut document = Document::new(settings, None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    document.set(Setting::LargestDiameter(0.05)).unwrap();
    document.set(Setting::MaxTriangles(5_000)).unwrap();
    while !follower.advance(&mut document, 1_000).unwrap().is_settled() {}
    let fingerprint = follower.mesh().fingerprint();
    for slices in [1, 3, 10, 30] {
        document.set(Setting::LargestDiameter(0.004)).unwrap();
        (0..slices).for_each(|_| _ = follower.advance(&mut document, 20).unwrap());
        document.set(Setting::LargestDiameter(0.05)).unwrap();
        while !follower.advance(&mut document, 20).unwrap().is_settled() {}
        assert_eq!(follower.mesh().fingerprint(), fingerprint, "{slices}");
    }
    document.set(Setting::LargestDiameter(0.004)).unwrap();
    let error = loop {
        match follower.advance(&mut document, 1_000) {
            Ok(stage) => assert!(!stage.is_settled(), "too many triangles"),
            Err(error) => break error,
        }
    };
    assert!(error.to_string().contains("5,000"), "{error}");
}
