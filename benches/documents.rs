//! The documents that benches edit.

use std::sync::Arc;

use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{
    BandLayer, Combine, DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, Mask, PaintLayers, Quantity,
    RasterLayer, RasterReading, RasterSource, ShapeList, Shapes, Threat, ThreatLaw, Threats, ValueCurve,
};
use meshbrush_core::raster::{PixelGrid, PixelRect, Raster, RasterPyramid, TILE, TilePlace, TiledRaster};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::bisection_edge_length;

use crate::window::wave;

/// Pixels along a side of the painted field.
pub const SIDE: u32 = 2048;
/// The coarse spacing of [`painted`].
pub const SPACING: f64 = 1.0 / 16.0;
/// Pixels along a side of the raster of the layers.
const RASTER_SIDE: u32 = 2048;

/// Returns a document with plain paint on the unit square, 512 coarse triangles and no other layer. The right
/// half needs `level` below the given row, which determines the size of the mesh.
pub fn painted(level: u8, rows: u32) -> Document {
    let layer = LayerId(0);
    let grid = PixelGrid::filling(&Rect::UNIT, [SIDE; 2]);
    let mut raster = TiledRaster::new(grid, f32::INFINITY);
    set(&mut raster, PixelRect { min: [SIDE / 2 + 1, 0], max: [SIDE, rows] }, level);
    // The same finest pixel in every mesh: the rule returns early where nothing is finer than a triangle.
    set(&mut raster, PixelRect { min: [SIDE - 1; 2], max: [SIDE; 2] }, 16);
    let mut paint = PaintLayers::default();
    paint.insert(layer, raster);
    let settings = Settings {
        domain: Domain::rectangle(Rect::UNIT),
        spacing: SPACING,
        transfer: Transfer::between(1e-9, 1.0),
        layers: Layer::stack([LayerKind::paint(Quantity::Diameter)]),
        gradation: None,
        max_memory: MEMORY,
        max_triangles: TRIANGLES,
        ..Settings::default()
    };
    Document::new(settings, Some(paint)).expect("valid settings")
}

/// Enough for the largest mesh.
const MEMORY: usize = 12_000_000_000;
const TRIANGLES: usize = 100_000_000;

/// Returns the diameter of triangles of a level, with the coarse spacing of [`painted`].
pub fn diameter(level: u8) -> f64 {
    bisection_edge_length(SPACING, u32::from(level))
}

/// Sets the pixels of an area to the diameter of a level.
fn set(raster: &mut TiledRaster, area: PixelRect, level: u8) {
    let side = TILE as u32;
    let tiles = PixelRect { min: area.min.map(|v| v / side), max: area.max.map(|v| v.div_ceil(side)) };
    for (column, row) in tiles.pixels() {
        let place = TilePlace { depth: 0, x: column as i32, y: row as i32 };
        if raster.tile(place).is_none() {
            let blank = raster.inherited(place);
            raster.exchange(place, Some(blank.into()));
        }
        raster.change(place, |tile| {
            let [x0, y0] = [column * side, row * side];
            for (x, y) in (PixelRect { min: [x0, y0], max: [x0 + side, y0 + side] }).pixels() {
                if area.contains(x, y) {
                    tile.set((x - x0) as i32, (y - y0) as i32, diameter(level) as f32);
                }
            }
        });
    }
}

/// Returns the outlines of a lake and of its island on the unit square: 200,000 corners, most of them closer to
/// each other than the triangles of a mesh of two million.
pub fn lake() -> Vec<Vec<Vec<DVec2>>> {
    const CORNERS: u32 = 100_000;
    let ring = |radius: f64| -> Vec<DVec2> {
        let corner = |k: u32| {
            let angle = f64::from(k) / f64::from(CORNERS) * std::f64::consts::TAU;
            let bays = 0.01 * (99.0 * angle).sin() + 0.0005 * (4999.0 * angle).sin();
            dvec2(0.5, 0.5) + (radius + bays) * DVec2::from_angle(angle)
        };
        (0..CORNERS).map(corner).collect()
    };
    vec![vec![ring(0.48), ring(0.25)]]
}

/// Returns a document of 1.8 million triangles with nodes on the outlines of [`lake`].
pub fn lake_document() -> Document {
    let domain = Domain::of_polygons(&lake()).expect("rings");
    let boundary = BoundaryTreatment::OnOutline { diameter: 0.0011 };
    let layers = Layer::stack([wave(0.65, 0.0011)]);
    let mut settings = Settings { domain, boundary, layers, ..Settings::default() };
    (settings.transfer.h_min, settings.transfer.h_risk) = (0.0002, 0.0002);
    Document::new(settings, None).expect("valid settings")
}

/// Returns a document with eight layers on the unit square; `fine` decides the size of the mesh, 0.0011 for two
/// million triangles.
pub fn layered(fine: f64, gradation: Option<f64>) -> Document {
    let mut settings = Settings {
        layers: layers(fine),
        gradation,
        max_memory: MEMORY,
        max_triangles: TRIANGLES,
        ..Settings::default()
    };
    (settings.transfer.h_min, settings.transfer.h_risk) = (fine, fine);
    Document::new(settings, None).expect("valid settings")
}

/// Eight layers, of which the first determines the size of the mesh.
fn layers(fine: f64) -> Vec<Layer> {
    let source = RasterSource { name: "hills".into(), raster: Arc::new(RasterPyramid::new(hills())) };
    let curve = ValueCurve::new(vec![[0.5, 0.2], [1.0, 0.01]]).expect("values that increase");
    let line = [dvec2(0.05, 0.9), dvec2(0.4, 0.7), dvec2(0.95, 0.85)];
    let lines = ShapeList { lines: vec![line.to_vec()], ..ShapeList::default() };
    let shapes = Shapes::new(lines, false).expect("a line");
    let to = DistanceTo::Shapes { name: "road".into(), shapes };
    let mut layers = Layer::stack([
        wave(0.45, fine),
        LayerKind::Raster(RasterLayer {
            source: source.clone(),
            reading: RasterReading::Curve(Arc::new(curve)),
        }),
        LayerKind::Band(BandLayer { source, between: [0.9, 0.95], diameter: 0.02 }),
        LayerKind::Distance(DistanceLayer { to, at_zero: 0.005, slope: 0.3, range: 0.2 }),
        LayerKind::Threats(threats()),
        LayerKind::constant(0.01),
        LayerKind::paint(Quantity::Diameter),
        LayerKind::paint(Quantity::Risk),
    ]);
    let corners = [dvec2(0.7, 0.1), dvec2(0.9, 0.12), dvec2(0.85, 0.3), dvec2(0.72, 0.25)];
    layers[5].mask = Some(Mask::new(&[vec![corners.to_vec()]]).expect("a polygon"));
    layers[5].combine = Combine::Floor;
    layers
}

fn hills() -> Raster {
    let share = |n: u32| f64::from(n) / f64::from(RASTER_SIDE);
    let height =
        |x: f64, y: f64| 0.5 + 0.25 * (9.0 * x + 2.0 * y).sin() + 0.25 * (11.0 * y - 3.0 * x * x).cos();
    let pixel = |n: u32| height(share(n % RASTER_SIDE), share(n / RASTER_SIDE)) as f32;
    let values = (0..RASTER_SIDE * RASTER_SIDE).map(pixel).collect();
    Raster::from_values(Rect::UNIT, [RASTER_SIDE; 2], values)
}

/// Returns shapes of which the first is large and lies above the wave; the others are small and spread over
/// the square.
fn threats() -> Threats {
    let mut random = fastrand::Rng::with_seed(12);
    let mut threats = vec![moved_threat(0.0)];
    threats.extend((1..100).map(|n| Threat {
        at: dvec2(random.f64(), random.f64()),
        range: 0.01 + 0.02 * random.f64(),
        peak: 0.7,
        law: ThreatLaw::ALL[n % 3].0,
    }));
    Threats::new(threats).expect("valid threats")
}

/// The layer of threats of [`layered`].
pub const THREATS: LayerId = LayerId(4);

/// Returns the first threat, after a share of the way along which it is dragged.
pub fn moved_threat(share: f64) -> Threat {
    Threat { at: dvec2(0.3 + 0.4 * share, 0.75), range: 0.08, peak: 0.75, law: ThreatLaw::Radar }
}
