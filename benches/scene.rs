//! A document that is edited, followed and priced as in the window.

use std::time::{Duration, Instant};

use glam::DVec2;
use meshbrush_core::document::{Document, Follower, Price, Pricer, Setting, Stage};
use meshbrush_core::layers::{Layer, LayerId, Threats};
use meshbrush_core::paint::{Brush, StrokePlan};
use meshbrush_mesh::mesh::Progress;

use crate::documents::{THREATS, moved_threat};
use crate::window::{FRAME_BUDGET, Slices};

/// A document and its follower.
pub struct Scene {
    pub document: Document,
    pub follower: Follower,
    pricer: Pricer,
    pub slices: Slices,
    /// The time in which the mesh was made.
    pub scratch: Duration,
}

/// The times of bringing the mesh up to date.
#[derive(Clone, Copy, Default)]
pub struct Times {
    /// Until the mesh begins to change.
    pub first: Duration,
    /// Until the mesh is up to date.
    pub rest: Duration,
    /// Of the longest slice.
    pub slice: Duration,
}

impl Scene {
    /// Makes the mesh of a document.
    pub fn new(mut document: Document) -> Self {
        let began = Instant::now();
        let follower = Follower::new(&mut document).expect("it has a mesh");
        let scratch = began.elapsed();
        Self { document, follower, pricer: Pricer::default(), slices: Slices::default(), scratch }
    }

    /// Returns the number of triangles of the mesh.
    pub fn triangles(&self) -> usize {
        self.follower.mesh().raw_triangle_count()
    }

    /// Does one slice, and returns whether the mesh is up to date.
    pub fn slice(&mut self) -> bool {
        let Self { document, follower, slices, .. } = self;
        slices.one(|visits| follower.advance(document, visits).expect("the budget is far") == Stage::InStep)
    }

    /// Makes an edit and follows it until the mesh is up to date.
    pub fn edit(&mut self, edit: impl FnOnce(&mut Document)) -> Times {
        let (mut times, mut has_changed) = (Times::default(), false);
        self.follower.take_change();
        self.slices.longest = Duration::ZERO;
        let began = Instant::now();
        edit(&mut self.document);
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

    /// Returns the work of one frame: an edit, and slices until the mesh is up to date or the budget is
    /// spent; and whether it is up to date.
    pub fn frame(&mut self, edit: impl FnOnce(&mut Document)) -> (Duration, bool) {
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

    /// A gesture with one move in each of so many frames of 1/60 s, then undone. `step` is given the share of
    /// the way. Returns the work of each frame, the shortest first, and the time from the last one until the
    /// mesh is up to date.
    pub fn gesture(
        &mut self,
        frames: usize,
        mut step: impl FnMut(&mut Document, f64),
    ) -> (Vec<Duration>, Duration) {
        let mut is_done = true;
        let mut times: Vec<Duration> = (0..frames)
            .map(|n| {
                let (time, is_followed) =
                    self.frame(|document| step(document, n as f64 / (frames - 1) as f64));
                is_done = is_followed;
                time
            })
            .collect();
        self.document.end_stroke();
        self.document.end_gesture();
        let began = Instant::now();
        while !is_done {
            is_done = self.frame(|_| ()).1;
        }
        let behind = began.elapsed();
        assert!(self.document.undo());
        self.edit(|_| ());
        times.sort();
        (times, behind)
    }

    /// Paints a dab, and returns the time of following it. Drawing the pixels is not counted.
    pub fn dab(&mut self, brush: Brush, at: DVec2) -> Duration {
        self.dab_and_pixels(brush, at)[0]
    }

    /// Paints a dab, and returns the time of following it and that of drawing its pixels.
    pub fn dab_and_pixels(&mut self, brush: Brush, at: DVec2) -> [Duration; 2] {
        let began = Instant::now();
        paint_dab(&mut self.document, brush, at);
        let pixels = began.elapsed();
        [self.slices.follow(&mut self.document, &mut self.follower), pixels]
    }

    /// Returns the time in which the price of a dab is known, and the price. The first slices draw the dab on
    /// a copy.
    pub fn price(&mut self, brush: Brush, at: DVec2) -> (Duration, Price) {
        let Self { document, follower, pricer, slices, .. } = self;
        // The same price is not computed twice.
        pricer.ask(None, document, follower);
        pricer.ask(Some(StrokePlan::click(brush, at)), document, follower);
        let time = slices.run(|visits| pricer.advance(document, follower, visits) == Progress::Done);
        (time, pricer.price().expect("it is done"))
    }
}

/// Paints a dab.
pub fn paint_dab(document: &mut Document, brush: Brush, at: DVec2) {
    document.begin_stroke(brush);
    document.draw_to(at);
    document.end_stroke();
}

/// Moves the first threat of [`crate::documents::layered`] by a share of its way; the gesture goes on.
pub fn move_threat(document: &mut Document, share: f64) {
    change_layer(document, THREATS, |layer| {
        if let Some(threats) = layer.kind.get_mut::<Threats>() {
            threats.set(0, moved_threat(share)).expect("a valid threat");
        }
    });
}

/// Shows or hides the threats, as a gesture of its own.
pub fn show_threats(document: &mut Document, visible: bool) {
    change_layer(document, THREATS, |layer| layer.visible = visible);
    document.end_gesture();
}

fn change_layer(document: &mut Document, id: LayerId, change: impl Fn(&mut Layer)) {
    let mut layers = document.settings().layers.clone();
    layers.iter_mut().filter(|layer| layer.id == id).for_each(change);
    document.set(Setting::Layers(layers)).expect("valid layers");
}

/// Draws the brush of the window along most of a figure eight, 2.4 units long, a step for each call.
pub fn figure_eight(brush: Brush) -> impl FnMut(&mut Document, f64) {
    let mut has_begun = false;
    move |document, share| {
        if !std::mem::replace(&mut has_begun, true) {
            document.begin_stroke(brush);
        }
        let angle = 0.4 + 5.6 * share;
        document.draw_to(DVec2::new(0.5 + 0.36 * angle.cos(), 0.5 + 0.3 * (2.0 * angle).sin()));
    }
}
