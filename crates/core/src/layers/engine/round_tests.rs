//! Round numbers, with which h̄ is exactly ℓ along lines, need no longer searches than others.

use glam::{DVec2, dvec2};

use super::search::LOOKED_AT;
use crate::domain::corners;
use crate::field::{Formula, Transfer};
use crate::geometry::{Lattice, Rect};
use crate::layers::{
    DistanceLayer, DistanceTo, Layer, LayerKind, LevelCache, PaintLayers, ShapeList, Shapes, SizeField,
    SizeFieldSpec,
};
use crate::mesh::{Limits, Mesh};

/// Returns the triangles of the mesh of a layer, and the number of rectangles at which searches look.
fn looks(kind: LayerKind) -> [usize; 2] {
    let lattice = Lattice::covering(Rect::UNIT, 0.5, 1000).unwrap();
    let spec = SizeFieldSpec {
        layers: Layer::stack([kind]),
        transfer: Transfer::between(0.01, 0.5),
        unasked: 0.5,
        outline: None,
        gradation: None,
        projection: None,
    };
    let (field, mut squares) = (SizeField::new(spec, &lattice), LevelCache::default());
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    LOOKED_AT.set(0);
    let mut asks =
        |corners, level| field.asks_for_more_nearby(&mut squares, PaintLayers::blank(), corners, level);
    mesh.refine(&Limits::default(), |element| asks(element.corners, element.triangle.level())).unwrap();
    [mesh.raw_triangle_count(), LOOKED_AT.get()]
}

fn distance(list: ShapeList, factor: f64) -> LayerKind {
    let shapes = Shapes::new(list, false).unwrap();
    let to = DistanceTo::Shapes { name: String::new(), shapes };
    DistanceLayer { to, at_zero: 0.05 * factor, slope: 0.2, range: f64::INFINITY }.into()
}

#[test]
fn round_numbers_need_no_longer_searches() {
    let frame = ShapeList { polygons: vec![vec![corners(&Rect::UNIT)]], ..ShapeList::default() };
    let diagonal = ShapeList { lines: vec![vec![DVec2::ZERO, DVec2::ONE]], ..ShapeList::default() };
    let points = ShapeList { points: vec![dvec2(0.5, 0.5), dvec2(0.25, 1.0)], ..ShapeList::default() };
    let formulas = [
        "0.05*F + 0.2*abs(x - 0.5)",
        "0.05*F + 0.2*(x + y)",
        "0.05*F + 0.1*abs(x - y)",
        "0.05*F + 0.2*(abs(x - 0.5) + abs(y - 0.5))",
        "0.05*F + 0.2*hypot(x - 0.5, y - 0.5)",
        "0.05*F + 0.2*(x - y)^2",
    ];
    let of_formula = |text: &str, factor: f64| {
        LayerKind::target(Formula::parse(&text.replace('F', &factor.to_string())).unwrap())
    };
    let mut kinds: Vec<Box<dyn Fn(f64) -> LayerKind>> = Vec::new();
    for list in [frame, diagonal, points] {
        kinds.push(Box::new(move |factor| distance(list.clone(), factor)));
    }
    for text in formulas {
        kinds.push(Box::new(move |factor| of_formula(text, factor)));
    }
    for (number, kind) in kinds.iter().enumerate() {
        let [[triangles, round], below, above] = [1.0, 0.998, 1.002].map(|factor| looks(kind(factor)));
        let beside = below[1].max(above[1]);
        assert!(triangles > 100, "{number}: {triangles}");
        assert!(2 * round <= 3 * beside + 200, "{number}: {round} rectangles, beside {beside}");
        assert!(round <= 100 * triangles, "{number}: {round} rectangles for {triangles} triangles");
    }
}
