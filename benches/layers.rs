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
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DVec2, dvec2};
use meshbrush_benches::window::{BRUSH, FRAME_BUDGET, MESH_SLICE, wave};
use meshbrush_core::document::{Document, Follower, Readings, Setting, Settings, Stage};
use meshbrush_core::layers::{
    Combine, DistanceTo, Layer, LayerId, LayerKind, Mask, Quantity, RasterReading, RasterSource, ShapeList,
    Shapes, Threat, ThreatLaw, Threats, ValueCurve,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;

const FRAMES: usize = 120;
/// The points that the pointer rests on.
const HOVERS: usize = 2_000;
/// How often each edit is repeated.
const ROUNDS: usize = 5;
/// The layer of threats.
const THREATS: LayerId = LayerId(4);
/// Pixels along a side of the raster.
const RASTER_SIDE: u32 = 2048;

/// Eight layers, of which the first determines the size of the mesh.
fn layers() -> Vec<Layer> {
    let source = RasterSource { name: "hills".into(), raster: Arc::new(RasterPyramid::new(hills())) };
    let curve = ValueCurve::new(vec![[0.5, 0.2], [1.0, 0.01]]).expect("values that increase");
    let line = [dvec2(0.05, 0.9), dvec2(0.4, 0.7), dvec2(0.95, 0.85)];
    let lines = ShapeList { lines: vec![line.to_vec()], ..ShapeList::default() };
    let shapes = Shapes::new(lines, false).expect("a line");
    let to = DistanceTo::Shapes { name: "road".into(), shapes };
    let mut layers = Layer::stack([
        wave(0.45, 0.0011),
        LayerKind::Raster { source: source.clone(), reading: RasterReading::Curve(Arc::new(curve)) },
        LayerKind::Band { source, between: [0.9, 0.95], diameter: 0.02 },
        LayerKind::Distance { to, at_zero: 0.005, slope: 0.3, range: 0.2 },
        LayerKind::Threats(threats()),
        LayerKind::constant(0.01),
        LayerKind::Paint(Quantity::Diameter),
        LayerKind::Paint(Quantity::Risk),
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

/// Returns the first threat, after a share of the way along which it is dragged.
fn moved_threat(share: f64) -> Threat {
    Threat { at: dvec2(0.3 + 0.4 * share, 0.75), range: 0.08, peak: 0.75, law: ThreatLaw::Radar }
}

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
}

impl Bench {
    fn new(gradation: Option<f64>) -> Self {
        let mut settings = Settings { layers: layers(), gradation, ..Settings::default() };
        (settings.transfer.h_min, settings.transfer.h_risk) = (0.0011, 0.0011);
        let mut document = Document::new(settings, None).expect("valid settings");
        let began = Instant::now();
        let follower = Follower::new(&mut document).expect("it has a mesh");
        let triangles = follower.mesh().raw_triangle_count();
        eprintln!("Gradation {gradation:?}: {triangles} triangles, from scratch in {:.2?}", began.elapsed());
        Self { document, follower }
    }

    /// Makes an edit and follows it until the mesh is up to date.
    fn follow(&mut self, edit: impl FnOnce(&mut Document)) -> Times {
        let (mut times, mut has_changed) = (Times::default(), false);
        self.follower.take_change();
        let began = Instant::now();
        edit(&mut self.document);
        loop {
            let slice = Instant::now();
            let stage = self.follower.advance(&mut self.document, MESH_SLICE).expect("the budget is far");
            times.slice = times.slice.max(slice.elapsed());
            if !has_changed && self.follower.take_change().is_some() {
                (times.first, has_changed) = (began.elapsed(), true);
            }
            if stage == Stage::InStep {
                assert!(has_changed, "an edit that changes nothing measures nothing");
                times.rest = began.elapsed();
                return times;
            }
        }
    }

    /// Returns the work of one frame: an edit, and slices until the mesh is up to date or the budget is
    /// spent.
    fn frame(&mut self, edit: impl FnOnce(&mut Document)) -> (Duration, Stage) {
        let began = Instant::now();
        edit(&mut self.document);
        let deadline = Instant::now() + FRAME_BUDGET;
        loop {
            let stage = self.follower.advance(&mut self.document, MESH_SLICE).expect("the budget is far");
            if stage == Stage::InStep || Instant::now() >= deadline {
                self.follower.take_change();
                return (began.elapsed(), stage);
            }
        }
    }

    /// A gesture with one move per frame, then undone.
    fn gesture(&mut self, name: &str, mut step: impl FnMut(&mut Document, f64)) {
        let mut frames = Vec::new();
        let mut stage = Stage::InStep;
        for n in 0..FRAMES {
            let (time, reached) = self.frame(|document| step(document, n as f64 / (FRAMES - 1) as f64));
            frames.push(time);
            stage = reached;
        }
        self.document.end_stroke();
        self.document.end_gesture();
        let began = Instant::now();
        while stage != Stage::InStep {
            stage = self.frame(|_| ()).1;
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
