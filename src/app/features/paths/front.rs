//! The front of length against risk, found on another thread.

use std::sync::Arc;

use glam::DVec2;

use super::finder::{MeshKey, PathsKey};
use meshbrush_core::document::KeepOut;
use meshbrush_core::domain::{Domain, DomainShape};
use meshbrush_core::layers::{Layer, PaintLayers, RiskField};
use meshbrush_core::path::{Front, FrontPoint, PathMesh, Weights};
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs, Output, Taken};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::Progress;

/// Paths of a front, at most.
pub const FRONT_PATHS: usize = 20;

/// One thing to do with the front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrontCommand {
    /// Shows it, or does not.
    Show(bool),
    /// Shows one of its paths on the canvas.
    Point(Option<usize>),
    /// Gives paths the weights of one of its paths.
    Take(usize),
    /// Takes the next shorter path.
    Shorter,
    /// Takes the next safer path.
    Safer,
    /// Ends the work on it.
    Cancel,
}

/// The data that a front depends on; the cost of paths is not among them.
#[derive(Clone, PartialEq)]
struct FrontKey {
    mesh: MeshKey,
    places: Vec<DVec2>,
    keep_out: Arc<[KeepOut]>,
    clearance: f64,
    layers: Vec<Layer>,
    paint: PaintLayers,
    /// Its bounds, and where it lies on the Earth.
    domain: Domain,
}

/// The front so far.
struct News {
    points: Vec<FrontPoint>,
    remaining: usize,
}

/// Finds the front of one route while it is shown.
#[derive(Default)]
pub struct FrontFinder {
    /// Whether it is shown.
    pub is_on: bool,
    /// The number of the path that is pointed at.
    pub pointed: Option<usize>,
    points: Vec<FrontPoint>,
    remaining: usize,
    running: Option<Job<News>>,
    of: Option<FrontKey>,
    /// The paths and the route for which `of` was checked last.
    checked: Option<(PathsKey, usize)>,
}

impl FrontFinder {
    /// Returns the front so far, from the shortest path to the safest.
    pub fn points(&self) -> &[FrontPoint] {
        &self.points
    }

    /// Returns how many of [`FRONT_PATHS`] are done, while they are being found.
    pub fn progress(&self) -> Option<usize> {
        self.running.as_ref().map(|_| FRONT_PATHS - self.remaining.min(FRONT_PATHS))
    }

    /// Returns the path that is pointed at.
    pub fn pointed(&self) -> Option<&FrontPoint> {
        self.points.get(self.pointed?).filter(|_| self.is_on)
    }

    /// Returns the weights of the next path that is safer, or shorter, than that of the given weights.
    pub fn next(&self, weights: Weights, is_safer: bool) -> Option<Weights> {
        let caution = |weights: &Weights| weights.risk / weights.length;
        let now = caution(&weights);
        let mut all = self.points.iter().map(|point| point.weights);
        match is_safer {
            true => all.find(|weights| caution(weights) > now),
            false => all.rfind(|weights| caution(weights) < now),
        }
    }

    /// Ends the work. What was found stays.
    pub fn cancel(&mut self) {
        self.running = None;
    }

    /// Ends the work until the paths are complete again.
    pub(super) fn pause(&mut self) {
        if self.running.take().is_some() {
            (self.of, self.checked) = (None, None);
        }
    }

    /// Takes what was found, waiting as long as the frame may, and begins the front of a route where it
    /// is not known.
    pub(super) fn advance(
        &mut self,
        session: &Session,
        (key, route): (PathsKey, usize),
        mesh: &Arc<PathMesh>,
        jobs: &Jobs,
    ) {
        if !self.is_on {
            *self = Self::default();
            return;
        }
        if self.checked != Some((key, route)) {
            self.checked = Some((key, route));
            let settings = session.document().settings();
            let (places, keep_out) = (settings.paths.routes[route].clone(), settings.paths.keep_out.clone());
            let (layers, paint) = (settings.layers.clone(), session.document().paint().clone());
            let domain = Domain { shape: DomainShape::Whole, ..settings.domain };
            let clearance = settings.paths.clearance;
            let of = FrontKey { mesh: key.mesh, places, keep_out, clearance, layers, paint, domain };
            if self.of.as_ref() != Some(&of) {
                self.start(mesh.clone(), of, jobs);
            }
        }
        while let Some(running) = &self.running {
            match running.take(jobs) {
                Taken::Value(news) => (self.points, self.remaining) = (news.points, news.remaining),
                Taken::Working => return,
                Taken::Ended => self.running = None,
            }
        }
    }

    fn start(&mut self, mesh: Arc<PathMesh>, of: FrontKey, jobs: &Jobs) {
        (self.points, self.pointed, self.remaining) = (Vec::new(), None, FRONT_PATHS);
        let places = of.places.clone();
        let risk = RiskField::new(&of.layers, &of.paint).within(&of.domain.bounds);
        let domain = of.domain.clone();
        self.of = Some(of);
        let begin = move || Some(Front::new(mesh, risk, places, FRONT_PATHS).measured_on(domain.ground()));
        let advance = |front: &mut Front, output: &Output<News>| {
            let goes_on = front.advance().unwrap_or(false);
            let news = News { points: front.points().to_vec(), remaining: front.remaining() };
            if output.send(news) && goes_on { Progress::More } else { Progress::Done }
        };
        self.running = Some(jobs.start_in_slices(JobKind::Compute, begin, advance));
    }
}
