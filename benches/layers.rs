//! Edits of a stack of eight layers on a mesh of two million triangles.
//!
//! The stack has a formula, a raster through a curve, a band, the distance to lines, a hundred threats, a
//! floor within a mask, and paint of both quantities. It is measured without a limit of gradation and with
//! one.
//!
//! A dab, a moved threat, a layer that is hidden and the same layer shown: *first* is the time from the edit
//! to the first slice after which the mesh differs, *rest* the time until it is up to date. Both are medians
//! of five. *slice* is the longest time that a single slice took in any of them.
//!
//! *hover* is what the window reads at a point under the pointer: h̄, the layer that decides it, and the
//! place from which gradation carries it.
//!
//! A stroke and a dragged threat, one move per frame of 1/60 s: the work of a frame is the edit and the
//! slices after it, until the mesh is up to date or the window's budget is spent. The times between frames
//! are not waited for.

use std::hint::black_box;
use std::time::{Duration, Instant};

use glam::dvec2;
use meshbrush_benches::documents::layered;
use meshbrush_benches::scene::{Scene, Times, figure_eight, move_threat, paint_dab, show_threats};
use meshbrush_benches::window::BRUSH;
use meshbrush_core::document::{Document, Readings};

const FRAMES: usize = 120;
/// The points that the pointer rests on.
const HOVERS: usize = 2_000;
/// How often each edit is repeated.
const ROUNDS: usize = 5;

/// A gesture with one move per frame, then undone.
fn gesture(scene: &mut Scene, name: &str, step: impl FnMut(&mut Document, f64)) {
    let (frames, behind) = scene.gesture(FRAMES, step);
    let at = |share: f64| milliseconds(frames[(share * FRAMES as f64).ceil() as usize - 1]);
    let (median, most, worst) = (at(0.5), at(0.99), at(1.0));
    let behind = milliseconds(behind);
    eprintln!("  {name:15} frame {median} median {most} 99 % {worst} worst; behind {behind}");
}

/// Repeats an edit and what takes it back, and reports both.
fn pair(scene: &mut Scene, names: [&str; 2], edits: [&dyn Fn(&mut Document); 2]) {
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        for (times, edit) in times.iter_mut().zip(edits) {
            times.push(scene.edit(edit));
        }
    }
    for (name, times) in names.iter().zip(&times) {
        let median = |time: fn(&Times) -> Duration| {
            let mut sorted: Vec<Duration> = times.iter().map(time).collect();
            sorted.sort();
            milliseconds(sorted[ROUNDS / 2])
        };
        let slice = times.iter().map(|times| times.slice).max().unwrap_or_default();
        let (first, rest) = (median(|times| times.first), median(|times| times.rest));
        eprintln!("  {name:15} first {first} rest {rest} slice {}", milliseconds(slice));
    }
}

/// Reads h̄ at random points.
fn hover(scene: &Scene) {
    let (mut random, mut readings) = (fastrand::Rng::with_seed(4), Readings::default());
    let mut times: Vec<Duration> = (0..HOVERS)
        .map(|_| {
            let point = dvec2(random.f64(), random.f64());
            let began = Instant::now();
            black_box(readings.decision_at(&scene.document, &scene.follower, point));
            began.elapsed()
        })
        .collect();
    times.sort();
    let at = |share: f64| milliseconds(times[(share * HOVERS as f64).ceil() as usize - 1]);
    eprintln!("  {:15} median {} 99 % {} worst {}", "hover", at(0.5), at(0.99), at(1.0));
}

fn milliseconds(time: Duration) -> String {
    format!("{:8.3} ms", 1e3 * time.as_secs_f64())
}

fn undo(document: &mut Document) {
    assert!(document.undo());
}

fn main() {
    for gradation in [None, Some(0.5), Some(0.1)] {
        let mut scene = Scene::new(layered(0.0011, gradation));
        let (triangles, scratch) = (scene.triangles(), scene.scratch);
        eprintln!("Gradation {gradation:?}: {triangles} triangles, from scratch in {scratch:.2?}");
        hover(&scene);
        let dab = |document: &mut Document| paint_dab(document, BRUSH, dvec2(0.5, 0.62));
        pair(&mut scene, ["dab", "dab undone"], [&dab, &undo]);
        let there = |document: &mut Document| {
            move_threat(document, 0.5);
            document.end_gesture();
        };
        pair(&mut scene, ["threat moved", "move undone"], [&there, &undo]);
        let (hide, show) =
            (|d: &mut Document| show_threats(d, false), |d: &mut Document| show_threats(d, true));
        pair(&mut scene, ["layer hidden", "layer shown"], [&hide, &show]);
        gesture(&mut scene, "stroke", figure_eight(BRUSH));
        gesture(&mut scene, "threat dragged", move_threat);
    }
}
