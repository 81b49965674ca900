//! The cost of each frame while painting: a recorded stroke of two seconds, replayed on a mesh of two million
//! triangles.
//!
//! Processor time is measured for each frame of 1/60 s. *stamp* rasterizes the reported mouse positions into
//! the painted rasters. *update* brings field and mesh up to date. *upload* hands the changed ranges to the
//! graphics driver and submits them. The bench waits for the GPU's own work, or lavapipe's, but does not
//! count it.
//!
//! Paint and erase strokes are each repeated five times. A frame counts with the median of its five times,
//! per part.
//!
//! *whole work*: every frame updates until the mesh is up to date. *in the window*: a frame stops at the
//! window's budget and the next one continues; the frames needed after the end of the stroke are reported.
//!
//! All of it is measured on a square, and on a lake with an island whose outlines have 200,000 corners: there
//! the update includes retiring pieces of the mesh that is derived along the outlines.
//!
//! Without a graphics driver, upload is not measured.

use std::ops::Range;
use std::time::{Duration, Instant};

use glam::{DVec2, dvec2};
use meshbrush_benches::documents;
use meshbrush_benches::window::{BRUSH, FRAME_BUDGET, Slices, wave};
use meshbrush_core::document::{Document, Follower, MeshChange, Settings, Stage};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::layers::Layer;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::paint::{Brush, Medium};
use meshbrush_mesh::mesh::{PatchPieces, TriangleId};
use meshbrush_render::render::gpu::Offscreen;

const FRAMES: usize = 120;
/// Number of points that a mouse reports in a frame, at 120 points a second.
const POINTS_PER_FRAME: usize = 2;
/// How often each stroke is repeated.
const ROUNDS: usize = 5;

const ERASER: Brush = Brush { medium: Medium::Eraser, strength: 1.0, ..BRUSH };

/// Returns the position of the mouse after a share of the stroke: most of a figure eight, 2.4 units long,
/// slow in the bends.
fn recorded(share: f64) -> DVec2 {
    let progress = share - 0.05 * (12.0 * share).sin();
    let angle = 0.4 + 5.6 * progress;
    dvec2(0.5 + 0.36 * angle.cos(), 0.5 + 0.3 * (2.0 * angle).sin())
}

fn points_of(frame: usize) -> impl Iterator<Item = DVec2> {
    let last = (FRAMES * POINTS_PER_FRAME - 1) as f64;
    (0..POINTS_PER_FRAME).map(move |i| recorded((frame * POINTS_PER_FRAME + i) as f64 / last))
}

/// Fine below a wave at this height.
fn settings(height: f64) -> Settings {
    let mut settings = Settings::default();
    (settings.transfer.h_min, settings.transfer.h_risk) = (0.0011, 0.0011);
    settings.layers = Layer::default_stack(wave(height, 0.0011));
    settings
}

fn square() -> Document {
    Document::new(settings(0.45), None).expect("valid settings")
}

/// Returns a document with the field in a lake with an island, with nodes on both outlines.
fn lake() -> Document {
    let domain = Domain::of_polygons(&documents::lake()).expect("two rings");
    let boundary = BoundaryTreatment::OnOutline { diameter: 0.0011 };
    let settings = Settings { domain, boundary, ..settings(0.65) };
    Document::new(settings, None).expect("valid settings")
}

/// Times of the parts of one frame.
#[derive(Clone, Copy)]
struct Frame {
    stamp: Duration,
    update: Duration,
    upload: Duration,
}

/// Document, mesh and GPU copy.
struct Bench {
    document: Document,
    follower: Follower,
    pieces: PatchPieces,
    screen: Screen,
    slices: Slices,
}

impl Bench {
    /// Creates a document whose mesh is up to date and derived, on the screen.
    fn new(mut document: Document) -> Self {
        let follower = Follower::new(&mut document).expect("it has a mesh");
        let began = Instant::now();
        let cleaning = follower.settings().derived_cleaning();
        let targets = follower.edge_targets(document.paint());
        let derived = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning);
        let extract = derived.extract(follower.mesh());
        let pieces = PatchPieces::new(follower.mesh(), derived.patch(), &extract);
        let (triangles, count) = (follower.mesh().raw_triangle_count(), pieces.triangles().len());
        eprintln!("A mesh of {triangles} triangles; {count} pieces derived in {:.2?}", began.elapsed());
        drop(extract);
        let mut bench =
            Self { document, follower, pieces, screen: Screen::open(), slices: Slices::default() };
        bench.frame(std::iter::empty(), FRAME_BUDGET);
        let began = Instant::now();
        bench.screen.set_pieces(&bench.pieces);
        eprintln!("Pieces uploaded in {:.2?}", began.elapsed());
        bench
    }

    fn frame(&mut self, points: impl Iterator<Item = DVec2>, budget: Duration) -> (Frame, Stage) {
        let began = Instant::now();
        points.for_each(|point| self.document.draw_to(point));
        let stamped = Instant::now();
        let stage = self.follow(stamped + budget);
        let change = self.follower.take_change();
        let touched = match &change {
            Some(MeshChange::Within(changes)) => self.pieces.retire(self.follower.mesh(), changes),
            _ => Vec::new(),
        };
        let updated = Instant::now();
        if let Some(change) = change {
            self.screen.show(&self.follower, &change, &self.pieces, &touched);
        }
        let uploaded = Instant::now();
        self.screen.wait();
        let times = Frame { stamp: stamped - began, update: updated - stamped, upload: uploaded - updated };
        (times, stage)
    }

    /// Follows the document as `Session::follow` does.
    fn follow(&mut self, deadline: Instant) -> Stage {
        loop {
            let Self { document, follower, slices, .. } = self;
            let mut stage = Stage::InStep;
            slices.one(|visits| {
                stage = follower.advance(document, visits).expect("the budget is far");
                stage == Stage::InStep
            });
            if stage == Stage::InStep || Instant::now() >= deadline {
                return stage;
            }
        }
    }

    /// Draws the stroke frame by frame, then runs frames until the mesh is up to date.
    fn stroke(&mut self, brush: Brush, budget: Duration) -> Stroke {
        let mut stroke = Stroke { frames: Vec::new(), behind: 0 };
        let mut stage = Stage::InStep;
        self.document.begin_stroke(brush);
        for frame in 0..FRAMES {
            let (times, reached) = self.frame(points_of(frame), budget);
            stroke.frames.push(times);
            stage = reached;
        }
        self.document.end_stroke();
        while stage != Stage::InStep {
            let (times, reached) = self.frame(std::iter::empty(), budget);
            stroke.frames.push(times);
            stroke.behind += 1;
            stage = reached;
        }
        stroke
    }

    fn undo(&mut self) {
        assert!(self.document.undo());
        self.frame(std::iter::empty(), Duration::MAX / 4);
    }
}

struct Stroke {
    frames: Vec<Frame>,
    /// Frames between the end of the stroke and the mesh being up to date.
    behind: usize,
}

fn report(name: &str, strokes: &[Stroke]) {
    let behind = strokes.iter().map(|stroke| stroke.behind).max().unwrap_or(0);
    eprintln!("{name}: {behind} frames at most until the mesh is up to date");
    eprintln!("            median       99 %      worst");
    let row = |part: &str, time: fn(&Frame) -> Duration| {
        let of_frame =
            |frame: usize| sorted(strokes.iter().map(|stroke| time(&stroke.frames[frame])))[ROUNDS / 2];
        let times = sorted((0..FRAMES).map(of_frame));
        let at = |share: f64| 1e3 * times[(share * FRAMES as f64).ceil() as usize - 1].as_secs_f64();
        eprintln!("  {part:6} {:7.2} ms {:7.2} ms {:7.2} ms", at(0.5), at(0.99), at(1.0));
    };
    row("stamp", |frame| frame.stamp);
    row("update", |frame| frame.update);
    row("upload", |frame| frame.upload);
    row("whole", |frame| frame.stamp + frame.update + frame.upload);
}

fn sorted(times: impl Iterator<Item = Duration>) -> Vec<Duration> {
    let mut times: Vec<_> = times.collect();
    times.sort();
    times
}

/// The mesh on the GPU, if there is one.
struct Screen(Option<Offscreen>);

impl Screen {
    fn open() -> Self {
        let offscreen = Offscreen::new();
        match &offscreen {
            Ok(offscreen) => eprintln!("Adapter: {}", offscreen.adapter()),
            Err(e) => eprintln!("Upload is not measured. {e}"),
        }
        Self(offscreen.ok())
    }

    /// Uploads a change as the window does.
    fn show(
        &mut self,
        follower: &Follower,
        change: &MeshChange,
        pieces: &PatchPieces,
        touched: &[(TriangleId, Range<usize>)],
    ) {
        let Some(offscreen) = &mut self.0 else { return };
        let (mesh, revision) = (follower.mesh(), follower.revision());
        let mirror = offscreen.renderer().mirror_mut();
        match change {
            MeshChange::Replaced => mirror.upload(mesh, revision),
            MeshChange::Within(changes) => mirror.apply_changes(mesh, revision, changes),
        }
        .and_then(|()| mirror.change_pieces(pieces, touched))
        .expect("the mesh fits the graphics memory");
        offscreen.queue().submit([]);
    }

    fn set_pieces(&mut self, pieces: &PatchPieces) {
        let Some(offscreen) = &mut self.0 else { return };
        let mirror = offscreen.renderer().mirror_mut();
        mirror.set_pieces(Some(pieces)).expect("the pieces fit the graphics memory");
        offscreen.queue().submit([]);
    }

    fn wait(&self) {
        if let Some(offscreen) = &self.0 {
            offscreen.device().poll(wgpu::PollType::wait_indefinitely()).expect("the device is not lost");
        }
    }
}

fn main() {
    for (domain, document) in [("Square", square()), ("Lake", lake())] {
        eprintln!("{domain}");
        run(&mut Bench::new(document));
    }
}

fn run(bench: &mut Bench) {
    for (name, budget) in [("whole work", Duration::MAX / 4), ("in the window", FRAME_BUDGET)] {
        let (mut painted, mut erased) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            painted.push(bench.stroke(BRUSH, budget));
            erased.push(bench.stroke(ERASER, budget));
            bench.undo();
            bench.undo();
        }
        report(&format!("{name}, paint"), &painted);
        report(&format!("{name}, erase"), &erased);
    }
}
