//! The next best paths that differ substantially, found on another thread.

use glam::DVec2;

use super::finder::PathsKey;
use super::prover::FoundPaths;
use meshbrush_core::path::{Alternatives, Difference, Solution};
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs, Output, Taken};
use meshbrush_mesh::geometry::nearest_on_segment;
use meshbrush_mesh::mesh::Progress;

/// Alternatives of a path, at most.
pub const MOST_ALTERNATIVES: usize = 5;

/// One thing to do with alternatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlternativesCommand {
    /// Shows them, or does not.
    Show(bool),
    /// Highlights one of them.
    Point(Option<usize>),
    /// Leads the path along one of them.
    Take(usize),
    /// Ends the search.
    Cancel,
}

/// Returns the place of a path that is farthest from the best one, with the number of its leg, from 0.
pub(super) fn farthest_place(best: &Solution, path: &Solution) -> Option<(usize, DVec2)> {
    let distance = |&point: &DVec2| {
        let pieces = best.points.windows(2);
        let distances =
            pieces.map(|ends| nearest_on_segment(point, [ends[0], ends[1]]).distance_squared(point));
        distances.fold(f64::INFINITY, f64::min)
    };
    let points = path.points.iter().enumerate();
    let (place, point) = points.max_by(|a, b| distance(a.1).total_cmp(&distance(b.1)))?;
    let leg = path.stops.windows(2).position(|ends| place < ends[1])?;
    Some((leg, *point))
}

/// Finds the alternatives of one path while they are shown.
#[derive(Default)]
pub struct AlternativesFinder {
    /// Whether they are shown.
    pub is_on: bool,
    /// The number of the one that is pointed at.
    pub pointed: Option<usize>,
    best: Option<Solution>,
    paths: Vec<Solution>,
    running: Option<Job<Solution>>,
    /// The paths and the route that they belong to.
    of: Option<(PathsKey, usize)>,
}

impl AlternativesFinder {
    /// Returns the alternatives so far, the cheapest first.
    pub fn paths(&self) -> &[Solution] {
        &self.paths
    }

    /// Returns how much more than the best path an alternative costs, as a share.
    pub fn excess(&self, path: &Solution) -> f64 {
        self.best.as_ref().map_or(0.0, |best| path.cost / best.cost - 1.0)
    }

    /// Returns whether the search goes on.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Returns a place that leads the path along an alternative: where that is farthest from the best path.
    /// With it is the number of the leg, from 0.
    pub fn place_on(&self, number: usize) -> Option<(usize, DVec2)> {
        farthest_place(self.best.as_ref()?, self.paths.get(number)?)
    }

    /// Ends the search. What was found stays.
    pub fn cancel(&mut self) {
        self.running = None;
    }

    /// Forgets all: there is no path.
    pub(super) fn clear(&mut self) {
        *self = Self { is_on: self.is_on, ..Self::default() };
    }

    /// Ends the search until the paths are complete again.
    pub(super) fn pause(&mut self) {
        if self.running.take().is_some() {
            self.of = None;
        }
    }

    /// Takes what was found, waiting as long as the frame may, and begins the search for those of
    /// another path.
    pub(super) fn advance(
        &mut self,
        of: (PathsKey, usize),
        (best, places): (&Solution, &[DVec2]),
        basis: &FoundPaths,
        jobs: &Jobs,
    ) {
        if !self.is_on {
            *self = Self::default();
            return;
        }
        if self.of != Some(of) {
            self.of = Some(of);
            self.start(best, places.to_vec(), basis, jobs);
        }
        while let Some(running) = &self.running {
            match running.take(jobs) {
                Taken::Value(path) => {
                    let place = self.paths.partition_point(|other| other.cost < path.cost);
                    self.paths.insert(place, path);
                    self.pointed = None;
                }
                Taken::Working => return,
                Taken::Ended => self.running = None,
            }
        }
    }

    fn start(&mut self, best: &Solution, places: Vec<DVec2>, basis: &FoundPaths, jobs: &Jobs) {
        (self.paths, self.pointed, self.best) = (Vec::new(), None, Some(best.clone()));
        let (mesh, best, density) = (basis.mesh.clone(), best.clone(), basis.density.clone());
        let begin = move || Some(Alternatives::new(mesh, places, best, Difference::default()));
        let advance = move |search: &mut Alternatives, output: &Output<Solution>| {
            if search.is_done() || search.paths().len() > MOST_ALTERNATIVES {
                return Progress::Done;
            }
            match search.advance(&*density) {
                Ok(Some(path)) if !output.send(path.clone()) => Progress::Done,
                Ok(_) => Progress::More,
                Err(_) => Progress::Done,
            }
        };
        self.running = Some(jobs.start_in_slices(JobKind::Compute, begin, advance));
    }
}
