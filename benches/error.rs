//! The smallest mesh within an error of 4097 × 4097 heights: from a move of the slider until the window shows
//! the mesh, for ten thousand to ten million triangles, on one and two threads; and what the curve of error
//! against triangles takes.
//!
//! The follower works as in the window, in slices. *samples* is the time to find which samples count, once
//! for a document, and what it takes for each.

use std::sync::Arc;
use std::time::{Duration, Instant};

use meshbrush_benches::window::{Slices, median_ms, pools};
use meshbrush_core::build::{CurveTracing, Parts};
use meshbrush_core::document::{Document, Follower, Setting, Settings};
use meshbrush_core::domain::Domain;
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{
    Layer, LayerKind, PaintLayers, RasterSource, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_core::surface::SurfaceSampling;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Progress;

/// Heights along a side.
const SIDE: u32 = 4097;
/// How often the slider moves; medians are printed.
const ROUNDS: usize = 3;
/// Triangles of the meshes, about.
const TRIANGLES: [usize; 4] = [10_000, 100_000, 1_000_000, 10_000_000];
/// Share by which the slider moves.
const MOVE: f64 = 1.001;

/// Returns hills of all sizes: each octave has half the width and half the height.
fn heights() -> Raster {
    let height = |n: u32| {
        let [x, y] = [n % SIDE, n / SIDE].map(|n| f64::from(n) / f64::from(SIDE - 1));
        let octave = |k: i32| {
            let wide = f64::from(1 << k);
            let phase = f64::from(k * k);
            let [u, v] = [8.0 * x + 3.0 * y, 7.0 * y - 4.0 * x].map(|w| w * wide);
            ((u + phase).sin() * (v - phase).cos()) / wide
        };
        (1000.0 * (0..10).map(octave).sum::<f64>()) as f32
    };
    let half = 0.5;
    let bounds =
        Rect::around(glam::DVec2::splat(0.5 * f64::from(SIDE - 1)), 0.5 * f64::from(SIDE - 1) + half);
    Raster::from_values(bounds, [SIDE; 2], (0..SIDE * SIDE).map(height).collect())
}

fn surface(source: &RasterSource, goal: SurfaceGoal) -> LayerKind {
    let source = SurfaceSource::Raster(source.clone());
    Surface { source, goal, norm: SurfaceNorm::Largest }.into()
}

fn settings(source: &RasterSource, goal: SurfaceGoal) -> Settings {
    let kind = surface(source, goal);
    let settings = Settings {
        domain: Domain::rectangle(source.raster.raster().bounds()),
        transfer: Transfer::between(1e-6, f64::MAX),
        max_triangles: 100_000_000,
        max_memory: 16_000_000_000,
        ..Settings::default()
    };
    Settings { layers: Layer::default_stack(kind.clone()), ..settings.with_nodes_on_samples(&kind) }
}

/// Returns the error of the curve with about so many triangles.
fn error_with(curve: &[meshbrush_core::surface::CurvePoint], triangles: usize) -> Option<f64> {
    curve.iter().rev().find(|point| point.triangles <= triangles).map(|point| point.error)
}

fn main() {
    let source = RasterSource { name: "heights".into(), raster: Arc::new(RasterPyramid::new(heights())) };
    let settings_within = |error| settings(&source, SurfaceGoal::Within(error));
    let start = settings_within(1.0);
    let samples = u64::from(SIDE) * u64::from(SIDE);
    let lattice = start.lattice().expect("a valid grid");
    let spec = start.mesh_spec().expect("a valid grid");

    let began = Instant::now();
    let mut tracing = CurveTracing::new(spec, Parts::default(), SurfaceNorm::Largest, 1 + TRIANGLES[3]);
    while tracing.advance(None, 1 << 18).expect("the curve can be traced") == Progress::More {}
    let curve = &tracing.curves().least;
    println!(
        "{samples} heights; curve up to {} triangles in {:.1} s",
        curve.last().map_or(0, |point| point.triangles),
        began.elapsed().as_secs_f64()
    );
    let coarse = Follower::new(&mut Document::new(settings_within(1e9), None).expect("valid settings"));
    let domain = coarse.expect("a valid grid").domain().clone();
    println!("{:>8} {:>12} {:>12} {:>12} {:>14}", "threads", "triangles", "error", "ms", "ns/triangle");
    for pool in pools() {
        pool.run(|| {
            let began = Instant::now();
            let mut sampling = SurfaceSampling::new(&start.layers, &lattice).expect("a layer is a surface");
            while sampling.advance(&domain, PaintLayers::blank(), 1 << 18) == Progress::More {}
            let each = began.elapsed().as_nanos() as f64 / samples as f64;
            println!("samples: {each:.2} ns each");
        });
        for triangles in TRIANGLES {
            let Some(error) = error_with(curve, triangles) else { continue };
            let (count, times) = pool.run(|| slider(settings_within(error), &source, error));
            let ms = median_ms(times);
            println!(
                "{:>8} {count:>12} {error:>12.4} {ms:>12.1} {:>14.1}",
                pool.threads,
                1e6 * ms / count as f64
            );
        }
    }
}

/// Moves the slider to and fro. Returns the number of triangles and the times until the mesh is shown.
fn slider(settings: Settings, source: &RasterSource, error: f64) -> (usize, Vec<Duration>) {
    let mut document = Document::new(settings, None).expect("valid settings");
    let mut follower = Follower::new(&mut document).expect("a valid grid");
    let mut slices = Slices::default();
    slices.follow(&mut document, &mut follower);
    let mut times = Vec::new();
    for round in 0..ROUNDS {
        let moved = if round % 2 == 0 { MOVE * error } else { error };
        let mut layers = document.settings().layers.clone();
        for layer in &mut layers {
            if layer.kind.is::<Surface>() {
                layer.kind = surface(source, SurfaceGoal::Within(moved));
            }
        }
        document.set(Setting::Layers(layers)).expect("a valid error");
        document.end_gesture();
        times.push(slices.follow(&mut document, &mut follower));
    }
    (follower.mesh().raw_triangle_count(), times)
}
