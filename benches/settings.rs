//! Changes of settings on meshes of half a million and two million triangles: how long until the window shows
//! the first of it, and until the mesh is that of the settings.
//!
//! The follower works as in the window: in slices, 7 ms of each frame. Times are those of the work alone, as
//! if nothing were drawn. *from scratch* makes the mesh of the new settings on all cores, without frames.
//!
//! Then the same on a sea of a million triangles: the example *Celtic Sea with depths* with smaller triangles,
//! in which the period of the waves or the gradation is dragged, or a layer is hidden.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use meshbrush_benches::window::{FRAME_BUDGET, Slices};
use meshbrush_core::document::{Document, Follower, Setting, Settings, Stage};
use meshbrush_core::layers::{
    DepthRule, DepthSizes, Depths, Layer, LayerKind, RasterLayer, RasterReading, RasterSource,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::{Meter, recipe};
use meshbrush_mesh::geometry::Rect;

/// How often each change is repeated; medians are printed.
const ROUNDS: usize = 3;

/// Pixels along a side of the risk.
const SIDE: u32 = 1024;

/// Returns a hill and a ridge of risk on the unit square, as the pixels of a raster.
fn document(h_min: f64) -> Document {
    let mut settings = Settings::default();
    (settings.transfer.h_min, settings.transfer.h_risk) = (h_min, h_min);
    let risk = |n: u32| {
        let [x, y] = [n % SIDE, n / SIDE].map(|n| (f64::from(n) + 0.5) / f64::from(SIDE));
        let hill = (-30.0 * ((x - 0.3).powi(2) + (y - 0.6).powi(2))).exp();
        let ridge = (-200.0 * (y - 0.3 - 0.1 * (6.0 * x).sin()).powi(2)).exp();
        hill.max(ridge) as f32
    };
    let raster = Raster::from_values(Rect::UNIT, [SIDE; 2], (0..SIDE * SIDE).map(risk).collect());
    let source = RasterSource { name: "risk".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    settings.layers =
        Layer::default_stack(LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk }));
    Document::new(settings, None).expect("valid settings")
}

/// The file of the example with depths.
const SEA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/celtic_sea.toml");
/// Triangles are so many times smaller than in the example.
const FINER: f64 = 5.0;

/// Returns the example of a sea with so small triangles that there are about a million of them.
fn sea() -> Document {
    let opened = recipe::open(Path::new(SEA), &Meter::default()).expect("the example is valid");
    let mut settings = opened.document.settings().clone();
    let transfer = settings.transfer;
    (settings.transfer.h_min, settings.transfer.h_risk) = (transfer.h_min / FINER, transfer.h_risk / FINER);
    for layer in &mut settings.layers {
        *layer = with_rule(layer, |rule| match rule {
            DepthRule::Wavelength { period, triangles } => {
                DepthRule::Wavelength { period, triangles: FINER * triangles }
            }
            DepthRule::Slope { triangles, smoothing } => {
                DepthRule::Slope { triangles: FINER * triangles, smoothing }
            }
            other => other,
        });
    }
    (settings.max_triangles, settings.max_memory) = (100_000_000, 8_000_000_000);
    Document::new(settings, None).expect("valid settings")
}

/// Returns a layer with another rule for its depths, if it has depths.
fn with_rule(layer: &Layer, change: impl Fn(DepthRule) -> DepthRule) -> Layer {
    let mut layer = layer.clone();
    if let Some(depths) = layer.kind.get::<Depths>() {
        let sizes = DepthSizes { rule: change(depths.sizes().rule), ..*depths.sizes() };
        layer.kind = LayerKind::Depth(depths.with_sizes(sizes));
    }
    layer
}

/// Returns the layers with another period of the waves.
fn with_period(layers: &[Layer], share: f64) -> Setting {
    let change = |rule: DepthRule| match rule {
        DepthRule::Wavelength { period, triangles } => {
            DepthRule::Wavelength { period: share * period, triangles }
        }
        other => other,
    };
    Setting::Layers(layers.iter().map(|layer| with_rule(layer, change)).collect())
}

/// Returns the layers without that of a name.
fn without(layers: &[Layer], name: &str) -> Setting {
    let hidden = |layer: &Layer| Layer { visible: layer.visible && layer.name != name, ..layer.clone() };
    Setting::Layers(layers.iter().map(hidden).collect())
}

/// Times from a change of a setting.
struct Times {
    /// Until a frame shows another mesh, and until the mesh is that of the settings.
    first: Duration,
    rest: Duration,
    /// The longest slice of work: what a frame can be late by.
    longest_slice: Duration,
    from_scratch: Duration,
    triangles: usize,
}

fn change(document: &Document, follower: &Follower, setting: &Setting) -> Times {
    let (mut document, mut follower) = (document.clone(), follower.clone());
    let revision = follower.revision();
    document.set(setting.clone()).expect("a valid setting");
    let (began, mut first, mut slices) = (Instant::now(), None, Slices::default());
    loop {
        let deadline = Instant::now() + FRAME_BUDGET;
        let is_done = loop {
            let is_done = slices.one(|visits| {
                follower.advance(&mut document, visits).expect("the budget is far") == Stage::InStep
            });
            if is_done || Instant::now() >= deadline {
                break is_done;
            }
        };
        follower.take_change();
        if follower.revision() > revision {
            first.get_or_insert(began.elapsed());
        }
        if is_done {
            break;
        }
    }
    let rest = began.elapsed();
    let began = Instant::now();
    let scratch = Follower::new(&mut document).expect("it has a mesh");
    let from_scratch = began.elapsed();
    assert_eq!(scratch.mesh().fingerprint(), follower.mesh().fingerprint());
    let triangles = follower.mesh().raw_triangle_count();
    let longest_slice = slices.longest;
    Times { first: first.unwrap_or(rest), rest, longest_slice, from_scratch, triangles }
}

/// Prints the times of changes of a document.
fn report(mut document: Document, changes: impl Fn(&Settings) -> Vec<(&'static str, Setting)>) {
    let follower = Follower::new(&mut document).expect("it has a mesh");
    println!("A mesh of {} triangles", follower.mesh().raw_triangle_count());
    println!(
        "{:24} {:>10} {:>10} {:>10} {:>10} {:>12}",
        "ms", "first", "rest", "longest", "scratch", "triangles"
    );
    for (name, wanted) in changes(document.settings()) {
        let times: Vec<_> = (0..ROUNDS).map(|_| change(&document, &follower, &wanted)).collect();
        let median = |part: fn(&Times) -> Duration| {
            let mut of_part: Vec<_> = times.iter().map(part).collect();
            of_part.sort();
            1e3 * of_part[ROUNDS / 2].as_secs_f64()
        };
        println!(
            "{name:24} {:10.0} {:10.0} {:10.1} {:10.0} {:12}",
            median(|t| t.first),
            median(|t| t.rest),
            median(|t| t.longest_slice),
            median(|t| t.from_scratch),
            times[0].triangles,
        );
    }
}

fn main() {
    for h_min in [0.0008, 0.0004] {
        report(document(h_min), |settings| {
            vec![
                ("h_risk halved", Setting::DiameterAtRiskOne(h_min / 2.0)),
                ("h_risk doubled", Setting::DiameterAtRiskOne(2.0 * h_min)),
                ("h_risk 10 % less", Setting::DiameterAtRiskOne(0.9 * h_min)),
                ("curve moved", Setting::TransferShape(1.2 * settings.transfer.shape)),
            ]
        });
    }
    report(sea(), |settings| {
        let layers = &settings.layers;
        vec![
            ("period 2 % longer", with_period(layers, 1.02)),
            ("period 2 % shorter", with_period(layers, 0.98)),
            ("gradation 0.25 to 0.24", Setting::Gradation(Some(0.24))),
            ("gradation 0.25 to 0.27", Setting::Gradation(Some(0.27))),
            ("slopes hidden", without(layers, "Slopes")),
        ]
    });
}
