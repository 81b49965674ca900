//! The figures of the mesh, which are computed on another thread: a large mesh takes longer than a frame.

use std::sync::Arc;

use super::{Statistics, StatisticsCommand, levels::LEVELS, panel::STATISTICS};
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::layers::{LargestTimeStep, NodeDepths};
use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::jobs::{Jobs, Wanted};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::{Ctx, Feature, Row};
use meshbrush_mesh::mesh::{MeshStatistics, TriangleId};

/// The figures of a mesh as files get it.
pub struct Measured {
    /// Edges, areas, angles and gradation; `None` without triangles.
    pub statistics: Option<MeshStatistics>,
    /// The largest stable time step, where layers have depths at all nodes and lengths are no degrees.
    pub time_step: Option<LargestTimeStep>,
    /// Area in square world units.
    pub area: f64,
    /// Nodes.
    pub nodes: usize,
    /// Triangles of each connected part, the part with the largest area first.
    pub part_sizes: Vec<usize>,
    /// The fingerprint of the mesh that was refined, as the command line prints it.
    pub fingerprint: String,
    /// The triangles of that mesh which exceed their target, or `None` where h̄ cannot be evaluated.
    pub too_coarse: Option<Vec<TriangleId>>,
}

impl Feature for Statistics {
    type Command = StatisticsCommand;
    const ROW: Row = Row { panels: &[&LEVELS, &STATISTICS], ..Row::EMPTY };

    fn execute(&mut self, command: StatisticsCommand, ctx: &mut Ctx<'_>) {
        match command {
            StatisticsCommand::Measure => self.measure(ctx.session, ctx.jobs),
        }
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let (follower, derivation) = (ctx.session.follower(), ctx.session.derivation());
        if MeasuredMesh::is_settled(ctx.session.document(), follower, derivation) {
            self.0.want(&MeasuredMesh::now(follower, derivation), ctx.jobs);
        }
        self.0.take(ctx.jobs)
    }
}

impl Statistics {
    /// Returns the last figures, and whether they are those of the mesh as it is.
    pub fn figures(&self, session: &Session) -> Option<(&Measured, bool)> {
        let now = MeasuredMesh::now(session.follower(), session.derivation());
        self.0.last().map(|(key, measured)| (measured, *key == now))
    }

    /// Returns whether the mesh is settled and was not measured yet.
    pub fn is_due(&self, session: &Session) -> bool {
        let (follower, derivation) = (session.follower(), session.derivation());
        let is_known = self.0.is_running() || self.0.has(&MeasuredMesh::now(follower, derivation));
        !is_known && MeasuredMesh::is_settled(session.document(), follower, derivation)
    }

    /// Measures the mesh, where that is due.
    fn measure(&mut self, session: &Session, jobs: &Jobs) {
        if !self.is_due(session) {
            return;
        }
        let follower = session.follower();
        let extract = session.derived().map(|derived| derived.shared_extract());
        let (mesh, domain, field) =
            (follower.shared_mesh(), follower.domain().clone(), follower.field().clone());
        let layers = session.document().settings().layers.clone();
        let unit = session.document().settings().unit;
        let ground_of = session.document().settings().domain.clone();
        let (rule, paint) = (follower.settings().rule, session.document().paint().clone());
        let surface = follower.surface().cloned();
        let measure = move |wanted: &Wanted| {
            let mut criterion = RefinementCriterion::new(&domain, &field, rule, Some(&paint))
                .with_surface(surface.as_deref());
            let extract = extract.unwrap_or_else(|| Arc::new(mesh.extract().into_owned()));
            let go_on = || wanted.goes_on().then_some(());
            go_on()?;
            let ground = ground_of.ground();
            let statistics = ground.statistics(&extract);
            go_on()?;
            let depths = NodeDepths::of(&layers, extract.view());
            let time_step = depths.and_then(Result::ok).and_then(|NodeDepths { depths, .. }| {
                LargestTimeStep::of(extract.view(), &depths, unit, |ends| ground.length(ends))
            });
            go_on()?;
            let (area, part_sizes) = (ground.mesh_area(&extract), extract.part_sizes());
            go_on()?;
            let fingerprint = mesh.fingerprint().to_string();
            go_on()?;
            let too_coarse = mesh.unsatisfied(|element| criterion.exceeds(element)).ok();
            Some(Measured {
                statistics,
                time_step,
                area,
                nodes: extract.nodes().len(),
                part_sizes,
                fingerprint,
                too_coarse,
            })
        };
        self.0.start_wanted(MeasuredMesh::now(follower, session.derivation()), measure, jobs);
    }
}
