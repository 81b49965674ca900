//! Several files of depths in one stack: after any edit the mesh is the one made from scratch.

use std::sync::Arc;

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, Setting, Settings, Stage};
use meshbrush_core::domain::corners;
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{
    Combine, DepthRule, DepthSizes, Depths, Layer, LayerId, LayerKind, Mask, PositiveDepth, RasterSource,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;

use crate::runs::seeds;

/// Depths in a part of the unit square, of which some pixels have none.
fn source(number: usize, random: &mut Rng) -> RasterSource {
    let corner = dvec2(random.f64(), random.f64()) - 0.3;
    let bounds = Rect::new(corner, corner + DVec2::splat(0.3 + random.f64()));
    let value = |_| if random.u8(..5) == 0 { f32::NAN } else { -1.0 - 60.0 * random.f32() };
    let raster = Raster::from_values(bounds, [6, 6], (0..36).map(value).collect());
    RasterSource { name: format!("depths {number}"), raster: Arc::new(RasterPyramid::new(raster)) }
}

fn layer(id: LayerId, sources: &[RasterSource], random: &mut Rng) -> Layer {
    let mask = (random.u8(..4) == 0).then(|| {
        let at = dvec2(random.f64(), random.f64());
        Mask::new(&[vec![corners(&Rect::around(at, 0.3))]]).unwrap()
    });
    let visible = random.u8(..5) > 0;
    let combine = [Combine::Finest, Combine::Finest, Combine::Floor][random.usize(..3)];
    if random.u8(..4) == 0 {
        let formula = ["0.02 + 0.004*depth", "if(depth > 30, 0.03 + 0.1*x, inf)"][random.usize(..2)];
        let kind = LayerKind::target(Formula::parse_of_size(formula).unwrap());
        return Layer { visible, mask, combine, ..Layer::new(id, "formula", kind) };
    }
    let rule = match random.u8(..5) {
        0 => DepthRule::Nothing,
        1 => DepthRule::Slope { triangles: 4000.0 * random.f64(), smoothing: 0.0 },
        _ => DepthRule::Wavelength { period: 8.0, triangles: 100.0 + 1500.0 * random.f64() },
    };
    let offset = [0.0, 0.0, 7.0][random.usize(..3)];
    let sizes = DepthSizes { positive: PositiveDepth::Up, offset, between: DepthSizes::ALL_WATER, rule };
    let source = sources[random.usize(..sources.len())].clone();
    Layer { visible, mask, ..Layer::new(id, "depths", Depths::new(source, sizes)) }
}

/// Changes a stack: another layer, one more or one less, or another order.
fn edit(layers: &mut Vec<Layer>, sources: &[RasterSource], random: &mut Rng) {
    let place = random.usize(..layers.len());
    match random.u8(..5) {
        0 => layers[place].visible ^= true,
        1 if layers.len() > 2 => _ = layers.remove(place),
        2 => {
            let moved = layers.remove(place);
            layers.insert(random.usize(..=layers.len()), moved);
        }
        3 => {
            let id = LayerId(layers.iter().map(|layer| layer.id.0).max().unwrap_or(0) + 1);
            layers.insert(place, layer(id, sources, random));
        }
        _ => layers[place] = layer(layers[place].id, sources, random),
    }
}

#[test]
fn edits_of_depths_that_hide_others_are_followed_in_place() {
    let (mut within, mut all) = (0, 0);
    for seed in seeds(20) {
        let mut random = Rng::with_seed(seed);
        let sources: Vec<RasterSource> = (0..3).map(|number| source(number, &mut random)).collect();
        let mut layers: Vec<Layer> = (1..4).map(|n| layer(LayerId(n), &sources, &mut random)).collect();
        while !layers.iter().any(|layer| layer.kind.is::<Depths>()) {
            layers[0] = layer(LayerId(1), &sources, &mut random);
        }
        let settings = Settings {
            layers: layers.clone(),
            transfer: Transfer::between(0.02, 0.3),
            spacing: 0.2,
            ..Settings::default()
        };
        let mut document = Document::new(settings, None).unwrap();
        let mut follower = Follower::new(&mut document).unwrap();
        for _ in 0..12 {
            edit(&mut layers, &sources, &mut random);
            match document.set(Setting::Layers(layers.clone())) {
                Ok(_) => {}
                Err(error) => {
                    assert!(error.to_string().contains("there are no depths"), "{error}");
                    layers.clone_from(&document.settings().layers);
                }
            }
            document.end_gesture();
            let before = follower.mesh().fingerprint();
            while follower.advance(&mut document, random.usize(1..2000)).unwrap() != Stage::InStep {}
            let from_scratch = Follower::new(&mut document.clone()).unwrap();
            let now = follower.mesh().fingerprint();
            assert_eq!(now, from_scratch.mesh().fingerprint(), "document {seed}");
            (within, all) = (within + usize::from(now != before), all + 1);
        }
    }
    assert!(3 * within > all, "{within} of {all} edits changed the mesh");
}
