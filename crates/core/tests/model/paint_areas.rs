//! Where a mesh is searched after paint: only where that can matter.

use glam::{DVec2, dvec2};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{
    Layer, LayerKind, LevelCache, PaintChange, PaintLayers, Quantity, SizeField, SizeFieldSpec,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium, Preview, Repaint, StrokePlan};
use meshbrush_core::raster::{PixelGrid, TiledRaster};
use meshbrush_mesh::geometry::{Lattice, Rect};

/// Returns the areas in which a click with a brush on the upper of two layers can change the mesh. The lower
/// one asks for 0.01 on the left of x = 0.5, and for 0.2 on the right.
fn areas_of_click(at: DVec2, target: f64, gradation: Option<f64>) -> Vec<Rect> {
    let formula = Formula::parse("if(x < 0.5, 0.01, 0.2)").unwrap();
    let layers = Layer::stack([LayerKind::target(formula), LayerKind::paint(Quantity::Diameter)]);
    let (layer, lattice) = (layers[1].id, Lattice::covering(Rect::UNIT, 0.25, 1 << 28).unwrap());
    let transfer = Transfer::between(1e-9, 0.2);
    let spec = SizeFieldSpec { layers, transfer, unasked: 0.2, outline: None, gradation, projection: None };
    let field = SizeField::new(spec, &lattice);

    let medium = Medium::Diameter(target, DiameterChange::Finer);
    let brush = Brush { medium, radius: 0.1, hardness: 1.0, strength: 1.0 };
    let blank =
        TiledRaster::new(PixelGrid { origin: DVec2::ZERO, pixel: DVec2::splat(0.002) }, f32::INFINITY);
    let (raster, changed) = Preview::new(&StrokePlan::click(brush, at), 0.2, Rect::UNIT, &blank).finish();
    let mut paint = PaintLayers::default();
    paint.insert(layer, raster);
    let painted: Vec<_> = changed
        .iter()
        .map(|&Repaint { area, before, change }| PaintChange { layer, area, before, change })
        .collect();
    let areas = field.changes_by_paint(&mut LevelCache::default(), &painted, &paint);
    let world = |corner| lattice.world_from_lattice(corner);
    areas.iter().map(|area| Rect::new(world(area.rect.min), world(area.rect.max))).collect()
}

/// Where another layer asks for less, the mesh stays as it is and is not searched.
#[test]
fn paint_concerns_no_triangle_where_another_layer_asks_for_less() {
    for gradation in [None, Some(0.5)] {
        // With gradation, it can matter to the coarse triangles on the right, which are few.
        let areas = areas_of_click(dvec2(0.3, 0.5), 0.02, gradation);
        assert!(areas.iter().all(|area| gradation.is_some() && area.min.x > 0.6), "{areas:?}");
        let beside = areas_of_click(dvec2(0.5, 0.5), 0.02, gradation);
        let least = beside.iter().map(|area| area.min.x).reduce(f64::min).unwrap();
        assert!((0.44..0.501).contains(&least), "{gradation:?}: {least}");
        assert!(beside.iter().any(|area| area.contains(dvec2(0.58, 0.5))), "{gradation:?}");
        let finest: Vec<_> = areas_of_click(dvec2(0.3, 0.5), 0.005, gradation);
        assert!(finest.iter().any(|area| area.contains(dvec2(0.3, 0.5))), "{gradation:?}");
    }
}

/// Parts with few triangles of the smallest diameters would be without number.
#[test]
fn paint_that_asks_for_tiny_triangles_has_few_areas() {
    let areas = areas_of_click(dvec2(0.6, 0.5), 1e-9, Some(0.5));
    assert!((1..2_000).contains(&areas.len()), "{}", areas.len());
    assert!(areas.iter().any(|area| area.contains(dvec2(0.6, 0.5))));
}
