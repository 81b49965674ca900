//! Questions whose second branch ordinary meshes do not need: each has the smallest input that does.

mod bisections;
mod fields;
mod paths;
mod prices;

use glam::{DVec2, dvec2};
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::document::{Document, OutlineError, Setting, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain, DomainOnLattice, DomainShape, NamedPolygon};
use meshbrush_core::earth::Projection;
use meshbrush_core::field::{CostFormula, Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{
    Layer, LayerCheck, LayerKind, PaintLayers, RiskField, SizeField, SizeFieldSpec,
};
use meshbrush_core::paint::{Brush, Medium, StrokePlan};
use meshbrush_core::path::{FormulaCost, PathFigures};
use meshbrush_core::raster::{PixelRect, Raster, RasterPyramid};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::Progress;

fn spec(layers: Vec<Layer>) -> SizeFieldSpec {
    let transfer = Transfer::between(1e-4, 1e6);
    SizeFieldSpec { layers, transfer, unasked: 1e6, outline: None, gradation: None, projection: None }
}

fn target(formula: &str) -> LayerKind {
    LayerKind::target(Formula::parse(formula).unwrap())
}

/// A thin feature between the nodes: the area rule sees it, the vertex rule does not.
#[test]
fn a_criterion_asks_by_its_own_rule() {
    let lattice = Lattice::covering(Rect::UNIT, 1.0, 10).unwrap();
    let domain = DomainOnLattice::new(&Domain::rectangle(Rect::UNIT), BoundaryTreatment::Report, &lattice);
    let field = SizeField::new(spec(Layer::stack([target("if(abs(x - 0.3) < 0.01, 0.001, 2)")])), &lattice);
    let side = 1 << lattice.halvings();
    let corners = [LatticePoint::new(side, 0), LatticePoint::new(0, side), LatticePoint::new(0, 0)];
    for (rule, sees) in [(RefinementRule::Area, true), (RefinementRule::Vertex, false)] {
        let criterion = RefinementCriterion::new(&domain, &field, rule, None);
        assert_eq!(criterion.asks_to_bisect(corners, 1), sees, "{rule:?}");
        assert_eq!(criterion.least_within(corners).target < 0.01, sees, "{rule:?}");
    }
}

#[test]
fn a_field_goes_over_to_the_lengths_of_another_projection() {
    let bounds = Rect::new(dvec2(4e5, 7e6), dvec2(5e5, 7.1e6));
    let lattice = Lattice::covering(bounds, 1e4, 1000).unwrap();
    let texts = [
        "+proj=merc +lat_ts=0 +ellps=WGS84 +units=m",
        "+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m",
    ];
    let [mercator, transverse] = texts.map(|text| text.parse::<Projection>().unwrap());
    let projections = [None, Some(mercator), Some(transverse)];
    let on = |projection: &Option<Projection>| {
        let projection = *projection;
        SizeFieldSpec { projection, ..spec(Layer::stack([target("5000")])) }
    };
    let corners = [LatticePoint::new(64, 0), LatticePoint::new(0, 64), LatticePoint::new(0, 0)];
    let mut lengths = Vec::new();
    for before in &projections {
        for after in &projections {
            let followed = SizeField::new(on(before), &lattice).with_spec(on(after));
            let fresh = SizeField::new(on(after), &lattice);
            let [followed, fresh] = [&followed, &fresh].map(|field| field.edge_lengths().of(corners, 1));
            assert_eq!(followed, fresh, "{before:?} {after:?}");
            lengths.push(fresh);
        }
    }
    assert!(lengths[0] != lengths[1] && lengths[1] != lengths[2] && lengths[2] != lengths[0]);
}

#[test]
fn the_message_about_a_value_names_its_layer() {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 100).unwrap();
    for wrong in 0..3 {
        let kinds = (0..3).map(|n| target(if n == wrong { "x - 0.5" } else { "0.1 + x" }));
        let mut layers = Layer::stack(kinds);
        layers.iter_mut().enumerate().for_each(|(n, layer)| layer.name = format!("layer {n}"));
        let field = SizeField::new(spec(layers), &lattice);
        let mut check = LayerCheck::new(&field);
        let error = loop {
            match check.advance(&field, 100) {
                Ok(progress) => assert_eq!(progress, Progress::More, "there is a mistake"),
                Err(error) => break error,
            }
        };
        assert_eq!(error.layer, format!("layer {wrong}"));
        assert!(error.value <= 0.0 && error.at.x <= 0.5);
    }
}

#[test]
fn a_new_document_has_24_cells_along_a_side_and_the_usual_boundary() {
    let settings = Settings::default();
    assert_eq!(settings.boundary, BoundaryTreatment::default_for(settings.spacing));
    let lattice = Lattice::covering(settings.domain.bounds, settings.spacing, 10_000).unwrap();
    assert_eq!(lattice.cells(), [24, 24]);
}

#[test]
fn all_of_a_square_raster_has_no_gaps_up_to_its_rim() {
    for size in [[1, 1], [2, 2], [8, 8], [32, 32]] {
        let values = (0..size[0] * size[1]).map(|n| n as f32).collect();
        let bounds = Rect::new(dvec2(-1.0, 2.0), dvec2(2.0, 3.0));
        let pyramid = RasterPyramid::new(Raster::from_values(bounds, size, values));
        let whole = pyramid.values_in(&bounds);
        assert!(!whole.has_gaps, "{size:?}");
        let range = whole.range.unwrap();
        assert_eq!((range.least, range.greatest), (0.0, (size[0] * size[1] - 1) as f32));
        let last = Rect::new(bounds.max - 1e-6, bounds.max);
        assert!(!pyramid.values_in(&last).has_gaps, "{size:?}");
    }
}

#[test]
fn an_empty_stack_of_layers_asks_for_nothing() {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 100).unwrap();
    let field = SizeField::new(spec(Vec::new()), &lattice);
    let corners = [LatticePoint::new(64, 0), LatticePoint::new(0, 64), LatticePoint::new(0, 0)];
    assert!(!field.asks_for_more(PaintLayers::blank(), corners, 1));
    let least = field.least_within(PaintLayers::blank(), corners);
    assert_eq!((least.layer, least.target), (None, 1e6));
}

/// A slider that is dragged sends the same setting again and again.
#[test]
fn each_change_of_a_gesture_is_reported() {
    let mut document = Document::new(Settings::default(), None).unwrap();
    assert!(!document.is_in_gesture());
    document.take_edits();
    for diameter in [0.01, 0.02, 0.03] {
        document.set(Setting::SmallestDiameter(diameter)).unwrap();
        assert!(document.is_in_gesture());
        assert!(document.take_edits().settings, "{diameter}");
    }
    document.set(Setting::SmallestDiameter(0.03)).unwrap();
    assert!(document.take_edits().is_empty(), "nothing changed");
    document.end_gesture();
    assert!(!document.is_in_gesture());
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 0.5, strength: 1.0 });
    assert!(document.is_in_gesture());
    document.end_stroke();
    assert!(!document.is_in_gesture());
}

#[test]
fn polygons_are_not_added_to_a_domain_of_a_formula() {
    let ring = vec![dvec2(0.2, 0.2), dvec2(0.8, 0.2), dvec2(0.5, 0.8)];
    let polygons = [NamedPolygon { name: String::new(), polygon: vec![ring] }];
    let shape = DomainShape::from(Formula::parse("r < 1").unwrap());
    let domain = Domain { shape, ..Domain::rectangle(Rect::UNIT) };
    let settings = Settings { domain, ..Settings::default() };
    assert_eq!(settings.with_outline(&polygons), Err(OutlineError::Formula));
    assert!(Settings::default().with_outline(&polygons).is_ok());
}

#[test]
fn a_stroke_with_one_end_at_infinity_is_not_finite() {
    let brush = Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 0.5, strength: 1.0 };
    let plan = StrokePlan::click(brush, DVec2::ZERO);
    assert!(plan.is_finite());
    for bad in [f64::INFINITY, f64::NAN] {
        assert!(!StrokePlan { from: dvec2(bad, 0.0), ..plan }.is_finite());
        assert!(!StrokePlan { to: dvec2(0.0, bad), ..plan }.is_finite());
    }
}

#[test]
fn pixels_are_none_without_columns_or_without_rows() {
    let rect = |min, max| PixelRect { min, max };
    assert!(!rect([1, 1], [2, 2]).is_empty());
    assert!(rect([1, 1], [1, 5]).is_empty() && rect([1, 1], [5, 1]).is_empty());
    let (empty, full) = (rect([0, 9], [9, 9]), rect([2, 3], [4, 4]));
    assert_eq!([full.union(&empty), empty.union(&full)], [full; 2]);
    assert_eq!(full.union(&rect([3, 0], [5, 1])), rect([2, 0], [5, 4]));
    let raster = Raster::filled(Rect::UNIT, [8, 8], 0.0);
    let within_one = Rect::new(dvec2(0.3, 0.55), dvec2(0.35, 0.6));
    assert_eq!(raster.pixels_touching(&within_one), rect([2, 4], [3, 5]));
}

#[test]
fn the_upper_bound_of_a_cost_is_as_close_as_asked_for() {
    let formula = CostFormula::parse("exp(3*x)").unwrap();
    let cost = FormulaCost { formula, risk: RiskField::default() };
    let exact = (3.0_f64.exp() - 1.0) / 3.0;
    for tolerance in [1e-2, 1e-4, 1e-6] {
        let figures = PathFigures::new(&[DVec2::ZERO, dvec2(1.0, 0.0)], &cost, tolerance);
        assert!(figures.upper >= exact && figures.upper <= exact * (1.0 + 2.0 * tolerance), "{figures:?}");
        assert!((figures.cost - exact).abs() <= tolerance * exact);
    }
}
