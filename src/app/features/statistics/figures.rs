//! The figures of the mesh, which are computed on another thread: a large mesh takes longer than a frame.

use super::{
    Measured, Measuring, Statistics, StatisticsCommand, levels::LEVELS, panel::STATISTICS,
    preflight::PREFLIGHT, preflight::Preflight, quality::QUALITY, repair::Repair,
};
use meshbrush_core::quality::QualityMeasure;
use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::jobs::{Jobs, Slot};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::{Ctx, Feature, Row};

/// The Courant numbers that can be asked for.
pub const COURANT: std::ops::RangeInclusive<f64> = 0.01..=1000.0;

impl Default for Statistics {
    fn default() -> Self {
        Self {
            figures: Slot::default(),
            courant: 1.0,
            preflight: Preflight::default(),
            repair: Repair::default(),
        }
    }
}

impl Feature for Statistics {
    type Command = StatisticsCommand;
    const ROW: Row = Row { panels: &[&LEVELS, &STATISTICS, &QUALITY, &PREFLIGHT], ..Row::EMPTY };

    fn execute(&mut self, command: StatisticsCommand, ctx: &mut Ctx<'_>) {
        match command {
            StatisticsCommand::Measure => self.measure(ctx.session, ctx.jobs),
            StatisticsCommand::SetCourant(number) => self.set_courant(number),
            StatisticsCommand::ChooseSolver(solver) => self.preflight.solver = solver,
            StatisticsCommand::CheckRules => self.preflight.check(ctx.session, ctx.view, ctx.jobs),
            StatisticsCommand::Repair => self.repair.begin(ctx.session, self.preflight.solver, ctx.jobs),
            StatisticsCommand::StopRepair => self.repair.stop(ctx.jobs),
        }
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let (follower, derivation) = (ctx.session.follower(), ctx.session.derivation());
        if MeasuredMesh::is_settled(ctx.session.document(), follower, derivation) {
            self.figures.want(&MeasuredMesh::now(follower, derivation), ctx.jobs);
        }
        let checks = self.preflight.follow(ctx.session, ctx.jobs);
        let repairs = self.repair.follow(ctx.session, ctx.jobs);
        self.figures.take(ctx.jobs) || checks || repairs
    }

    fn for_next_document(self) -> Self {
        Self { courant: self.courant, preflight: self.preflight.for_next_document(), ..Self::default() }
    }
}

impl Statistics {
    /// Returns the last figures, and whether they are those of the mesh as it is.
    pub fn figures(&self, session: &Session) -> Option<(&Measured, bool)> {
        let now = MeasuredMesh::now(session.follower(), session.derivation());
        self.figures.last().map(|(key, measured)| (measured, *key == now))
    }

    /// Returns the smallest time step of the mesh for the person's Courant number, in seconds, where it is
    /// known.
    pub fn smallest_time_step(&self, session: &Session) -> Option<f64> {
        let (measured, _) = self.figures(session).filter(|(_, is_current)| *is_current)?;
        Some(self.courant * measured.quality.get(QualityMeasure::TimeStep)?.least.value)
    }

    /// Returns the Courant number that time steps are shown for.
    pub fn courant(&self) -> f64 {
        self.courant
    }

    /// Shows time steps for another Courant number, the nearest that can be asked for.
    pub fn set_courant(&mut self, number: f64) {
        if !number.is_nan() {
            self.courant = number.clamp(*COURANT.start(), *COURANT.end());
        }
    }

    /// Returns whether the mesh is settled and was not measured yet.
    pub fn is_due(&self, session: &Session) -> bool {
        let (follower, derivation) = (session.follower(), session.derivation());
        let is_known =
            self.figures.is_running() || self.figures.has(&MeasuredMesh::now(follower, derivation));
        !is_known && MeasuredMesh::is_settled(session.document(), follower, derivation)
    }

    /// Measures the mesh, where that is due.
    fn measure(&mut self, session: &Session, jobs: &Jobs) {
        if !self.is_due(session) {
            return;
        }
        let measuring = Measuring::of(session);
        let key = MeasuredMesh::now(session.follower(), session.derivation());
        self.figures.start_wanted(key, move |wanted| measuring.run(wanted), jobs);
    }
}
