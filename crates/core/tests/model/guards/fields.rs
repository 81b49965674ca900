//! Values, ranges and areas of size fields, where another branch decides than in ordinary meshes.

use glam::dvec2;
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::domain::{BoundaryTreatment, Domain, DomainOnLattice, DomainShape};
use meshbrush_core::field::{Bounds, Formula, RefinementRule};
use meshbrush_core::layers::{Layer, PaintLayers, SizeField, SizeFieldSpec};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

use super::{spec, target};

/// By the vertex rule, the least of the three corners counts, whichever it is.
#[test]
fn the_corner_with_the_least_target_counts() {
    let lattice = Lattice::covering(Rect::UNIT, 1.0, 10).unwrap();
    let domain = DomainOnLattice::new(&Domain::rectangle(Rect::UNIT), BoundaryTreatment::Report, &lattice);
    let side = 1 << lattice.halvings();
    let corners = [LatticePoint::new(side, 0), LatticePoint::new(0, side), LatticePoint::new(0, 0)];
    for (formula, corner) in [("0.1 + x + y", 2), ("0.1 + abs(x - 1) + y", 0), ("0.1 + x + abs(y - 1)", 1)] {
        let field = SizeField::new(spec(Layer::stack([target(formula)])), &lattice);
        let criterion = RefinementCriterion::new(&domain, &field, RefinementRule::Vertex, None);
        let least = criterion.least_within(corners);
        assert!((least.target - 0.1).abs() < 1e-6, "{formula}: {least:?}");
        assert_eq!(least.at, lattice.world_from_lattice(corners[corner]), "{formula}");
    }
}

/// Gradation carries a small diameter to where another layer asks for more: that layer is not the cause.
#[test]
fn the_layer_behind_gradation_is_that_of_the_place_it_comes_from() {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 100).unwrap();
    let layers = Layer::stack([target("0.5"), target("if(hypot(x - 0.2, y - 0.5) < 0.05, 0.01, 1e9)")]);
    let [wide, small] = [layers[0].id, layers[1].id];
    let field = SizeField::new(SizeFieldSpec { gradation: Some(0.3), ..spec(layers) }, &lattice);
    for (x, is_carried) in [(0.2, false), (0.4, true), (0.8, true)] {
        let at = dvec2(x, 0.5);
        let decision = field.decision_at(PaintLayers::blank(), at);
        assert_eq!(decision.layer, Some(small), "{decision:?}");
        assert_eq!(decision.from != at, is_carried, "{decision:?}");
        assert_eq!(decision.asked[0], (wide, Some(0.5)));
        assert!(decision.from.distance(dvec2(0.2, 0.5)) < 0.05 + 1e-6 && decision.target < 0.5);
    }
}

#[test]
fn bounds_say_whether_a_value_may_be_no_number() {
    let bounds = Bounds::new(-1.0, 2.0);
    for (value, holds) in [(-1.0, true), (2.0, true), (0.0, true), (2.1, false), (f64::NAN, false)] {
        assert_eq!(bounds.contains(value), holds, "{value}");
    }
    assert!(Bounds { valid: false, ..bounds }.contains(f64::NAN));
}

/// The domain of a formula, where its sign is known all over a triangle.
#[test]
fn a_triangle_has_nothing_of_a_domain_only_if_all_of_it_is_beyond() {
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 1_000).unwrap();
    let shape = DomainShape::from(Formula::parse("x + 2*y < 1.2").unwrap());
    let domain = Domain { shape, ..Domain::rectangle(Rect::UNIT) };
    let domain = DomainOnLattice::new(&domain, BoundaryTreatment::Report, &lattice);
    let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    let mut counts = [0; 3];
    for (id, _) in mesh.triangles() {
        let element = mesh.element(id);
        let corners = mesh.world_corners(id);
        let rectangle = element.world_rectangle();
        assert_eq!((rectangle.min, rectangle.max), {
            let [a, b, c] = corners;
            (a.min(b).min(c), a.max(b).max(c))
        });
        let value = |x: f64, y: f64| x + 2.0 * y < 1.2;
        let [low, high] = [rectangle.min, rectangle.max].map(|at| value(at.x, at.y));
        let has_none = domain.has_none_of(&element);
        // By its rectangle: the formula grows along both axes.
        assert_eq!(has_none, !low, "{corners:?}");
        counts[usize::from(low) + usize::from(high)] += 1;
    }
    assert!(counts.iter().all(|&count| count > 5), "{counts:?}");
}
