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

use glam::{DVec2, dvec2};
use meshbrush_benches::documents::{THREATS, layered, moved_threat};
use meshbrush_benches::window::{BRUSH, FRAME_BUDGET, Slices};
use meshbrush_core::document::{Document, Follower, Readings, Setting, Stage};
use meshbrush_core::layers::{Layer, LayerId, LayerKind};

const FRAMES: usize = 120;
/// The points that the pointer rests on.
const HOVERS: usize = 2_000;
/// How often each edit is repeated.
const ROUNDS: usize = 5;

/// Returns the most of a figure eight, 2.4 units long.
fn stroke_at(share: f64) -> DVec2 {
    let angle = 0.4 + 5.6 * share;
    dvec2(0.5 + 0.36 * angle.cos(), 0.5 + 0.3 * (2.0 * angle).sin())
}

/// The times of bringing the mesh up to date.
#[derive(Clone, Copy, Default)]
struct Times {
    first: Duration,
    rest: Duration,
    slice: Duration,
}

struct Bench {
    document: Document,
    follower: Follower,
    slices: Slices,
}

impl Bench {
    fn new(gradation: Option<f64>) -> Self {
        let mut document = layered(0.0011, gradation);
        let began = Instant::now();
        let follower = Follower::new(&mut document).expect("it has a mesh");
        let triangles = follower.mesh().raw_triangle_count();
        eprintln!("Gradation {gradation:?}: {triangles} triangles, from scratch in {:.2?}", began.elapsed());
        Self { document, follower, slices: Slices::default() }
    }

    /// Makes an edit and follows it until the mesh is up to date.
    fn follow(&mut self, edit: impl FnOnce(&mut Document)) -> Times {
        let (mut times, mut has_changed) = (Times::default(), false);
        self.follower.take_change();
        let began = Instant::now();
        edit(&mut self.document);
        self.slices.longest = Duration::ZERO;
        loop {
            let is_done = self.slice();
            if !has_changed && self.follower.take_change().is_some() {
                (times.first, has_changed) = (began.elapsed(), true);
            }
            if is_done {
                assert!(has_changed, "an edit that changes nothing measures nothing");
                (times.rest, times.slice) = (began.elapsed(), self.slices.longest);
                return times;
            }
        }
    }

    /// Does one slice, and returns whether the mesh is up to date.
    fn slice(&mut self) -> bool {
        let Self { document, follower, slices } = self;
        slices.one(|visits| follower.advance(document, visits).expect("the budget is far") == Stage::InStep)
    }

    /// Returns the work of one frame: an edit, and slices until the mesh is up to date or the budget is
    /// spent; and whether it is up to date.
    fn frame(&mut self, edit: impl FnOnce(&mut Document)) -> (Duration, bool) {
        let began = Instant::now();
        edit(&mut self.document);
        let deadline = Instant::now() + FRAME_BUDGET;
        loop {
            let is_done = self.slice();
            if is_done || Instant::now() >= deadline {
                self.follower.take_change();
                return (began.elapsed(), is_done);
            }
        }
    }

    /// A gesture with one move per frame, then undone.
    fn gesture(&mut self, name: &str, mut step: impl FnMut(&mut Document, f64)) {
        let mut frames = Vec::new();
        let mut is_done = true;
        for n in 0..FRAMES {
            let (time, is_followed) = self.frame(|document| step(document, n as f64 / (FRAMES - 1) as f64));
            frames.push(time);
            is_done = is_followed;
        }
        self.document.end_stroke();
        self.document.end_gesture();
        let began = Instant::now();
        while !is_done {
            is_done = self.frame(|_| ()).1;
        }
        let behind = began.elapsed();
        frames.sort();
        let at = |share: f64| milliseconds(frames[(share * FRAMES as f64).ceil() as usize - 1]);
        let (median, most, worst) = (at(0.5), at(0.99), at(1.0));
        eprintln!(
            "  {name:15} frame {median} median {most} 99 % {worst} worst; behind {}",
            milliseconds(behind)
        );
        assert!(self.document.undo());
        self.follow(|_| ());
    }

    /// Repeats an edit and what takes it back, and reports both.
    fn pair(&mut self, names: [&str; 2], edits: [&dyn Fn(&mut Document); 2]) {
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..ROUNDS {
            for (times, edit) in times.iter_mut().zip(edits) {
                times.push(self.follow(edit));
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
}

impl Bench {
    /// Reads h̄ at random points.
    fn hover(&self) {
        let (mut random, mut readings) = (fastrand::Rng::with_seed(4), Readings::default());
        let mut times: Vec<Duration> = (0..HOVERS)
            .map(|_| {
                let point = dvec2(random.f64(), random.f64());
                let began = Instant::now();
                black_box(readings.decision_at(&self.document, &self.follower, point));
                began.elapsed()
            })
            .collect();
        times.sort();
        let at = |share: f64| milliseconds(times[(share * HOVERS as f64).ceil() as usize - 1]);
        eprintln!("  {:15} median {} 99 % {} worst {}", "hover", at(0.5), at(0.99), at(1.0));
    }
}

fn milliseconds(time: Duration) -> String {
    format!("{:8.3} ms", 1e3 * time.as_secs_f64())
}

/// Changes one layer of a document.
fn change_layer(document: &mut Document, id: LayerId, change: impl Fn(&mut Layer)) {
    let mut layers = document.settings().layers.clone();
    layers.iter_mut().filter(|layer| layer.id == id).for_each(change);
    document.set(Setting::Layers(layers)).expect("valid layers");
}

fn move_threat(document: &mut Document, share: f64) {
    change_layer(document, THREATS, |layer| {
        if let LayerKind::Threats(threats) = &mut layer.kind {
            threats.set(0, moved_threat(share)).expect("a valid threat");
        }
    });
}

/// Shows or hides the threats, as a gesture of its own.
fn show_threats(document: &mut Document, visible: bool) {
    change_layer(document, THREATS, |layer| layer.visible = visible);
    document.end_gesture();
}

fn dab(document: &mut Document) {
    document.begin_stroke(BRUSH);
    document.draw_to(dvec2(0.5, 0.62));
    document.end_stroke();
}

fn undo(document: &mut Document) {
    assert!(document.undo());
}

fn main() {
    for gradation in [None, Some(0.5), Some(0.1)] {
        let mut bench = Bench::new(gradation);
        bench.hover();
        bench.pair(["dab", "dab undone"], [&dab, &undo]);
        let there = |document: &mut Document| {
            move_threat(document, 0.5);
            document.end_gesture();
        };
        bench.pair(["threat moved", "move undone"], [&there, &undo]);
        let (hide, show) =
            (|d: &mut Document| show_threats(d, false), |d: &mut Document| show_threats(d, true));
        bench.pair(["layer hidden", "layer shown"], [&hide, &show]);
        let mut begun = false;
        bench.gesture("stroke", |document, share| {
            if !std::mem::replace(&mut begun, true) {
                document.begin_stroke(BRUSH);
            }
            document.draw_to(stroke_at(share));
        });
        bench.gesture("threat dragged", move_threat);
    }
}
