//! Plots of the mesh, and of the time that meshes take on this machine.

mod command;
mod entries;
mod error_curve;
mod execute;
mod files;
mod panel;
#[cfg(test)]
mod tests;

use std::path::Path;
use std::sync::Arc;

pub use command::{PlotKind, PlotsCommand};
pub use entries::entries;
use error_curve::TracedCurves;
pub use panel::{HEIGHT, PLOTS, measuring};

use meshbrush_cli::cli::RunClock;
use meshbrush_core::build::RefinementCriterion;
use meshbrush_io::io;
use meshbrush_kit::kit::background::{Aim, Background, exported};
use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs, Output, Slot, Taken, Wanted};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::Progress;
use meshbrush_study::levels::{LevelFigures, bisections_plot, diameters_plot, triangles_plot};
use meshbrush_study::plot::{self, Plot};
use meshbrush_study::report::{Experiment, ExperimentRun};

/// The runs that are left of an experiment, each as its round and level.
type Order = Box<dyn Iterator<Item = (u32, u32)> + Send>;

const WITHOUT_SURFACE: &str =
    "The error is that from a surface. Add a layer of one, with the + above the layers.";

/// The data that the figures of the levels depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LevelPlotKey {
    mesh: MeasuredMesh,
    document: u64,
}

/// Computes what plots show, and keeps it.
pub struct Plots {
    kind: PlotKind,
    levels: Slot<LevelPlotKey, Vec<LevelFigures>>,
    errors: TracedCurves,
    experiment: Experiment,
    /// The runs of an experiment in progress, each with its round.
    measuring: Option<Job<Result<(u32, ExperimentRun), String>>>,
    /// How many runs were made so far.
    runs_done: usize,
    /// The deepest level of the experiment that is measured next, or is being measured.
    pub last_level: u32,
    /// How often each of its meshes is made.
    pub runs: u32,
}

impl Default for Plots {
    fn default() -> Self {
        Self {
            kind: PlotKind::Triangles,
            levels: Slot::default(),
            errors: TracedCurves::default(),
            experiment: Experiment::default(),
            measuring: None,
            runs_done: 0,
            last_level: Experiment::LAST_LEVEL,
            runs: 5,
        }
    }
}

impl Plots {
    /// Which plot is shown.
    pub fn kind(&self) -> PlotKind {
        self.kind
    }

    /// Chooses which plot is shown.
    pub fn choose(&mut self, kind: PlotKind) {
        self.kind = kind;
    }

    /// Returns the chosen plot, and whether it is that of the mesh as it is. `None` until it is known.
    pub fn plot(&self, session: &Session) -> Option<(Plot, bool)> {
        if self.kind.is_of_experiment() {
            let experiment = &self.experiment;
            let plot = if self.kind == PlotKind::Time {
                experiment.time_per_triangle()
            } else {
                experiment.figure_5()
            };
            return (!experiment.meshes.is_empty()).then_some((plot, true));
        }
        if self.kind == PlotKind::Errors {
            return self.errors.plot(session).ok().flatten();
        }
        let (key, levels) = self.levels.last()?;
        let plot = match self.kind {
            PlotKind::Triangles => triangles_plot(levels),
            PlotKind::Bisections => bisections_plot(levels),
            _ => diameters_plot(levels, session.document().settings().unit),
        };
        Some((plot, *key == LevelPlotKey::of(session)))
    }

    /// Returns whether there is a plot to show.
    pub fn is_known(&self) -> bool {
        match self.kind {
            PlotKind::Time | PlotKind::Figure5 => !self.experiment.meshes.is_empty(),
            PlotKind::Errors => self.errors.is_known(),
            _ => self.levels.last().is_some(),
        }
    }

    /// Returns why the chosen plot cannot be shown, if that is known.
    pub fn obstacle(&self, session: &Session) -> Option<String> {
        let has_surface = session.document().settings().has_surface();
        match self.kind {
            PlotKind::Errors if !has_surface => Some(WITHOUT_SURFACE.into()),
            PlotKind::Errors => self.errors.plot(session).err(),
            _ => None,
        }
    }

    /// Returns whether [`Self::compute`] would compute what the chosen plot shows.
    pub fn is_due(&self, session: &Session) -> bool {
        if self.kind == PlotKind::Errors {
            return self.errors.is_due(session);
        }
        let is_settled =
            MeasuredMesh::is_settled(session.document(), session.follower(), session.derivation());
        is_settled && !self.levels.is_running() && !self.levels.has(&LevelPlotKey::of(session))
    }

    /// Computes what the chosen plot shows on another thread, where that is due.
    pub fn compute(&mut self, session: &Session, jobs: &Jobs) {
        if !self.is_due(session) {
            return;
        }
        if self.kind == PlotKind::Errors {
            return self.errors.trace(session, jobs);
        }
        let follower = session.follower();
        let extract = session.derived().map(|derived| derived.shared_extract());
        let (mesh, domain, field) =
            (follower.shared_mesh(), follower.domain().clone(), follower.shared_field());
        let (rule, limits) = (follower.settings().rule, follower.settings().limits());
        let (paint, surface) = (session.document().paint().clone(), follower.surface().cloned());
        let compute = move |wanted: &Wanted| {
            let criterion = RefinementCriterion::new(&domain, &field, rule, Some(&paint))
                .with_surface(surface.as_deref());
            let extract = extract.unwrap_or_else(|| Arc::new(mesh.extract().into_owned()));
            wanted.goes_on().then(|| LevelFigures::new(&mesh, &extract, &criterion, &limits))
        };
        self.levels.start_wanted(LevelPlotKey::of(session), compute, jobs);
    }

    /// Takes what was computed and measured, waiting for figures of levels as long as the frame may. Returns
    /// whether some are being computed.
    ///
    /// # Errors
    /// Fails with a sentence, when the experiment failed.
    pub fn take(&mut self, session: &Session, jobs: &Jobs) -> Result<bool, String> {
        while let Some(measuring) = &self.measuring {
            match measuring.take_ready() {
                Taken::Value(Ok((round, run))) => {
                    self.runs_done += 1;
                    self.experiment.add(round, run);
                }
                Taken::Value(Err(problem)) => {
                    self.measuring = None;
                    return Err(problem);
                }
                Taken::Working => break,
                Taken::Ended => self.measuring = None,
            }
        }
        if MeasuredMesh::is_settled(session.document(), session.follower(), session.derivation()) {
            self.levels.want(&LevelPlotKey::of(session), jobs);
        }
        let is_tracing = self.errors.take(session, jobs);
        Ok(self.levels.take(jobs) || is_tracing)
    }

    /// Returns the measurements so far.
    pub fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// Returns whether the experiment is being measured.
    pub fn is_measuring(&self) -> bool {
        self.measuring.is_some()
    }

    /// Returns the run that is being made, as its round and level; `None` between two experiments.
    pub fn run_in_progress(&self) -> Option<(u32, u32)> {
        self.order().nth(self.runs_done).filter(|_| self.is_measuring())
    }

    fn order(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        Experiment::order(self.last_level, self.runs)
    }

    /// Measures the experiment on another thread. Nothing happens while it is being measured.
    pub fn measure(&mut self, jobs: &Jobs) {
        if self.is_measuring() {
            return;
        }
        (self.experiment, self.runs_done) = (Experiment::default(), 0);
        let order: Order = Box::new(self.order());
        let measure = |order: &mut Order, output: &Output<_>| {
            let Some((round, level)) = order.next() else { return Progress::Done };
            let clock = RunClock::start();
            let run = ExperimentRun::measure(level, || clock.now(), || output.is_wanted());
            let Some(run) = run.map_err(|error| error.to_string()).transpose() else { return Progress::Done };
            let failed = run.is_err();
            let goes_on = output.is_wanted() && output.send(run.map(|run| (round, run))) && !failed;
            if goes_on { Progress::More } else { Progress::Done }
        };
        self.measuring = Some(jobs.start_in_slices(JobKind::Compute, || Some(order), measure));
    }

    /// Ends the experiment. What was measured stays.
    pub fn cancel(&mut self) {
        self.measuring = None;
    }

    /// Returns the numbers of the chosen plot as text: a table of the experiment, or else the series.
    pub fn text(&self, session: &Session) -> Option<String> {
        if self.kind.is_of_experiment() {
            return (!self.experiment.meshes.is_empty()).then(|| self.experiment.table());
        }
        let mut text = Vec::new();
        plot::write_csv(&mut text, &self.plot(session)?.0).ok()?;
        String::from_utf8(text).ok()
    }

    /// Writes the chosen plot to a file: a drawing or a table, as the ending says.
    pub fn export(&self, session: &Session, background: &mut Background, path: &Path) {
        let Some((plot, _)) = self.plot(session) else { return };
        let file = path.to_owned();
        background.start(Aim::Export, path, move |meter| {
            let written = io::write_file_metered(&file, meter, |mut out| plot::write(&mut out, &plot, &file));
            exported(written, meter, &file, || format!("The plot was written to {}.", file.display()))
        });
    }
}

impl LevelPlotKey {
    fn of(session: &Session) -> Self {
        let mesh = MeasuredMesh::now(session.follower(), session.derivation());
        Self { mesh, document: session.document().revision() }
    }
}
