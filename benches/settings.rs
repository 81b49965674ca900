//! Changes of settings on meshes of half a million and two million triangles: how long until the window shows
//! the first of it, and until the mesh is that of the settings.
//!
//! The follower works as in the window: in slices, 7 ms of each frame. Times are those of the work alone, as
//! if nothing were drawn. *from scratch* makes the mesh of the new settings on all cores, without frames.

use std::sync::Arc;
use std::time::{Duration, Instant};

use meshbrush_benches::window::{FRAME_BUDGET, Slices};
use meshbrush_core::document::{Document, Follower, Setting, Settings, Stage};
use meshbrush_core::layers::{Layer, LayerKind, RasterReading, RasterSource};
use meshbrush_core::raster::{Raster, RasterPyramid};
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
    settings.layers = Layer::usual(LayerKind::Raster { source, reading: RasterReading::Risk });
    Document::new(settings, None).expect("valid settings")
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

fn main() {
    for h_min in [0.0008, 0.0004] {
        let mut document = document(h_min);
        let follower = Follower::new(&mut document).expect("it has a mesh");
        let shape = document.settings().transfer.shape;
        println!("A mesh of {} triangles", follower.mesh().raw_triangle_count());
        println!(
            "{:24} {:>10} {:>10} {:>10} {:>10} {:>12}",
            "ms", "first", "rest", "longest", "scratch", "triangles"
        );
        for (name, wanted) in [
            ("h_risk halved", Setting::DiameterAtRiskOne(h_min / 2.0)),
            ("h_risk doubled", Setting::DiameterAtRiskOne(2.0 * h_min)),
            ("h_risk 10 % less", Setting::DiameterAtRiskOne(0.9 * h_min)),
            ("curve moved", Setting::TransferShape(1.2 * shape)),
        ] {
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
}
