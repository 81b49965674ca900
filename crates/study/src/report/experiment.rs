//! The experiment of Section 5.4 of the report: the mesh of Figure 1 with targets of several sizes, and how
//! the time to make it grows with the number of triangles (Figure 5).
//!
//! Every mesh is made several times, on one thread as in the report, and in rounds: each round makes all
//! sizes, so that a load on the machine hits all of them alike.

use serde::Serialize;

use super::power_law::PowerLaw;
use super::times::{RunTime, is_spread, span};
use crate::build::{BuildError, MeshBuilder};
use crate::document::{Example, Settings};
use crate::field::{Formula, Transfer};
use crate::layers::{Layer, LayerKind};
use crate::mesh::{Mesh, Progress, bisection_edge_length};

/// The level of the smallest mesh of the report: all its times are in proportion to that.
pub(super) const FIRST_LEVEL: u32 = 5;
/// The numbers of triangles that the report states, by level: its smallest and its largest mesh.
pub(super) const STATED_TRIANGLES: [(u32, usize); 2] = [(FIRST_LEVEL, 9_560), (13, 2_113_944)];
/// Triangles between two looks at whether to go on.
const SLICE: usize = 1 << 16;

/// The measurements, the smallest mesh first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Experiment {
    /// A mesh for each level.
    pub meshes: Vec<ExperimentMesh>,
}

/// One mesh of the experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExperimentMesh {
    /// The deepest level.
    pub level: u32,
    /// Number of triangles.
    pub triangles: usize,
    /// The number that the report states, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub triangles_in_report: Option<usize>,
    /// The time of each run, in the order in which they were made.
    pub runs: Vec<RunTime>,
}

/// One run: a mesh that was made once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExperimentRun {
    /// The deepest level.
    pub level: u32,
    /// Number of triangles.
    pub triangles: usize,
    /// The time that it took.
    pub time: RunTime,
}

impl ExperimentRun {
    /// Makes the mesh of a level on one thread, on which it reads `clock`. `None` if `goes_on` said no, which
    /// is asked now and then.
    ///
    /// # Errors
    /// Fails when there is not enough memory.
    pub fn measure(
        level: u32,
        clock: impl Fn() -> RunTime + Send,
        goes_on: impl Fn() -> bool + Send,
    ) -> Result<Option<Self>, BuildError> {
        let spec = settings(level).mesh_spec().expect("the settings of the experiment are valid");
        let make = move || {
            let start = clock();
            let mut builder = MeshBuilder::new(spec);
            while builder.advance(None, SLICE)? == Progress::More {
                if !goes_on() {
                    return Ok(None);
                }
            }
            let time = clock().since(start);
            let triangles = Mesh::triangle_count(&builder.finish().mesh);
            Ok(Some(Self { level, triangles, time }))
        };
        let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        match one_thread {
            Ok(thread) => thread.install(make),
            // Without another thread, on all those that the program has.
            Err(_) => make(),
        }
    }
}

impl ExperimentMesh {
    /// Returns the least time of all runs, in seconds: whatever disturbs a run only adds to it.
    pub fn seconds(&self) -> f64 {
        self.span()[0]
    }

    /// Returns the minimum and the maximum time of all runs, in seconds.
    pub fn span(&self) -> [f64; 2] {
        span(&self.runs)
    }

    /// Returns whether other work disturbed most of the runs: it had the processor meanwhile, or their times
    /// are far apart.
    pub fn is_disturbed(&self) -> bool {
        let interrupted = self.runs.iter().filter(|run| run.is_interrupted()).count();
        2 * interrupted > self.runs.len() || is_spread(&self.runs)
    }
}

/// Returns the diamond of Figure 1 with a target diameter that needs `level` levels.
fn settings(level: u32) -> Settings {
    let document = Example::Diamond.without_data();
    let mut settings = document.settings().clone();
    // A hair above the diameter of the level, which is irrational at even levels.
    let target = bisection_edge_length(settings.spacing, level) * (1.0 + 1e-12);
    let formula = format!("if(abs(x) + abs(y) < 8, {target:?}, 20)");
    settings.layers = Layer::stack([LayerKind::target(Formula::parse(&formula).expect("a valid formula"))]);
    settings.transfer = Transfer::between(0.5 * target, settings.transfer.h_max);
    settings
}

impl Experiment {
    /// The deepest level of the report.
    pub const LAST_LEVEL: u32 = 13;
    /// The gradient of the line of best fit in Figure 5.
    pub const STATED_GRADIENT: f64 = 1.01;

    /// Returns the round and the level of each run, in the order in which they are made: round by round. The
    /// mesh of level 1 comes first of all in round 0, which does not count: it brings code and memory to
    /// where later runs find them.
    pub fn order(last_level: u32, runs: u32) -> impl Iterator<Item = (u32, u32)> + Clone {
        let rounds = (1..=runs).flat_map(move |round| (1..=last_level).map(move |level| (round, level)));
        std::iter::once((0, 1)).chain(rounds)
    }

    /// Adds a run of some round to those of its mesh.
    pub fn add(&mut self, round: u32, run: ExperimentRun) {
        if round == 0 {
            return;
        }
        let place = self.meshes.partition_point(|mesh| mesh.level < run.level);
        if self.meshes.get(place).is_none_or(|mesh| mesh.level != run.level) {
            let stated = STATED_TRIANGLES.iter().find(|(level, _)| *level == run.level);
            let triangles_in_report = stated.map(|(_, triangles)| *triangles);
            let ExperimentRun { level, triangles, .. } = run;
            self.meshes
                .insert(place, ExperimentMesh { level, triangles, triangles_in_report, runs: Vec::new() });
        }
        self.meshes[place].runs.push(run.time);
    }

    /// Returns the power law of time over triangles, both in proportion to the smallest mesh of the report,
    /// from that mesh on: its exponent is the gradient of the line of best fit in Figure 5. `None` with fewer
    /// than two meshes.
    pub fn power_law(&self) -> Option<PowerLaw> {
        PowerLaw::fitted(&self.scaled(ExperimentMesh::seconds))
    }

    /// Returns whether the runs of some mesh that the power law is fitted to were disturbed.
    pub fn is_disturbed(&self) -> bool {
        self.fitted_meshes().iter().any(ExperimentMesh::is_disturbed)
    }

    /// Returns the meshes from the smallest one of the report on.
    fn fitted_meshes(&self) -> &[ExperimentMesh] {
        &self.meshes[self.meshes.partition_point(|mesh| mesh.level < FIRST_LEVEL)..]
    }

    /// Returns the triangles and some time of each mesh from the smallest one of the report on, in proportion
    /// to the triangles and the least time of that one.
    pub(super) fn scaled(&self, seconds: impl Fn(&ExperimentMesh) -> f64) -> Vec<[f64; 2]> {
        let meshes = self.fitted_meshes();
        let scaled = |mesh: &ExperimentMesh| {
            [mesh.triangles as f64 / meshes[0].triangles as f64, seconds(mesh) / meshes[0].seconds()]
        };
        meshes.iter().map(scaled).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;

    #[test]
    fn a_run_has_the_triangles_of_the_report_and_the_time_of_the_clock() {
        let readings = AtomicU32::new(0);
        let clock = || {
            let wall = f64::from(readings.fetch_add(1, Ordering::Relaxed));
            RunTime { wall, processor: Some(0.5 * wall) }
        };
        let run = ExperimentRun::measure(5, clock, || true).unwrap().unwrap();
        assert_eq!((run.triangles, run.time), (9_560, RunTime { wall: 1.0, processor: Some(0.5) }));
    }

    #[test]
    fn a_run_is_made_on_one_thread() {
        let threads = std::sync::Mutex::new(Vec::new());
        let clock = || {
            threads.lock().unwrap().push((std::thread::current().id(), rayon::current_num_threads()));
            RunTime { wall: 0.0, processor: None }
        };
        ExperimentRun::measure(4, clock, || true).unwrap();
        let threads = threads.into_inner().unwrap();
        assert!(threads[0] == threads[1] && threads[0].1 == 1, "{threads:?}");
    }

    #[test]
    fn every_round_makes_all_sizes_after_one_that_does_not_count() {
        let order: Vec<_> = Experiment::order(3, 2).collect();
        assert_eq!(order, [(0, 1), (1, 1), (1, 2), (1, 3), (2, 1), (2, 2), (2, 3)]);
        let mut experiment = Experiment::default();
        for (number, (round, level)) in order.into_iter().enumerate() {
            let time = RunTime { wall: number as f64, processor: None };
            experiment.add(round, ExperimentRun { level, triangles: 10, time });
        }
        let spans: Vec<_> = experiment.meshes.iter().map(ExperimentMesh::span).collect();
        assert_eq!(spans, [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]);
    }

    #[test]
    fn measuring_ends_when_it_is_cancelled() {
        let clock = || RunTime { wall: 0.0, processor: None };
        assert_eq!(ExperimentRun::measure(9, clock, || false).unwrap(), None);
    }
}
