use glam::dvec2;

use super::*;
use crate::layers::{DistanceLayer, DistanceTo, LayerKind, ShapeList, Shapes};

const LONGEST: f64 = 0.5;

fn spec(layer: Layer, outline: Option<Shapes>) -> SizeFieldSpec {
    let transfer = Transfer::between(1e-4, 10.0);
    SizeFieldSpec { layers: vec![layer], transfer, unasked: 10.0, outline, gradation: None, projection: None }
}

fn lines(rows: &[f64]) -> Shapes {
    let lines = rows.iter().map(|&y| vec![dvec2(0.0, y), dvec2(1.0, y)]).collect();
    Shapes::new(ShapeList { lines, ..ShapeList::default() }, false).unwrap()
}

fn steps(new: &SizeFieldSpec, old: &SizeFieldSpec, outline_areas: Option<&[Rect]>) -> Vec<SpecChange> {
    let paint = PaintLayers::blank();
    new.difference(old, &Circumstances { paint, longest: LONGEST, greatest_scale: 1.0, outline_areas })
}

/// Returns the directions of the steps whose area has a place.
fn at(steps: &[SpecChange], y: f64) -> Vec<TargetChange> {
    let has = |area: &Extent| match area {
        Extent::Everywhere => true,
        Extent::Within(rects) => rects.iter().any(|rect| rect.contains(dvec2(0.5, y))),
    };
    steps.iter().filter(|step| has(&step.area)).map(|step| step.change).collect()
}

#[test]
fn a_line_that_leaves_makes_coarser_and_one_that_joins_makes_finer_around_it() {
    let mut layer = Layer::stack([LayerKind::constant(1.0)]).remove(0);
    let mut on = |rows: &[f64], combine| {
        let to = DistanceTo::Shapes { name: String::new(), shapes: lines(rows) };
        layer.kind = LayerKind::Distance(DistanceLayer { to, at_zero: 0.1, slope: 1.0, range: 0.3 });
        layer.combine = combine;
        spec(layer.clone(), None)
    };
    for (combine, joins, leaves) in [(Combine::Finest, Finer, Coarser), (Combine::Replace, Any, Any)] {
        let changes = steps(&on(&[0.0, 5.0], combine), &on(&[0.0, 9.0], combine), None);
        assert_eq!([at(&changes, 5.2), at(&changes, 9.2)], [vec![joins], vec![leaves]], "{changes:?}");
        assert_eq!([at(&changes, 0.0), at(&changes, 5.4)], [vec![], vec![]], "{changes:?}");
    }
}

/// Only where the outline alone differs are its edges all that counts.
#[test]
fn another_outline_changes_the_distance_to_it_around_the_edges_that_differ() {
    let mut layer = Layer::stack([LayerKind::constant(1.0)]).remove(0);
    let mut on = |at_zero, rows: Option<&[f64]>| {
        layer.kind =
            LayerKind::Distance(DistanceLayer { to: DistanceTo::Outline, at_zero, slope: 1.0, range: 0.3 });
        spec(layer.clone(), rows.map(lines))
    };
    let before = on(0.1, Some(&[0.0, 5.0]));
    let edges = [Rect::new(dvec2(0.0, 5.0), dvec2(1.0, 5.1))];
    let is_known_at = |new: &SizeFieldSpec, y| at(&steps(new, &before, Some(&edges)), y).is_empty();
    let moved = on(0.1, Some(&[0.0, 5.1]));
    assert!(is_known_at(&moved, 0.2) && is_known_at(&moved, 5.5) && !is_known_at(&moved, 5.3));
    assert!(!is_known_at(&on(0.2, Some(&[0.0, 5.1])), 0.2), "the layer is another besides");
}
