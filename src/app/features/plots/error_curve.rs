//! The curves of error against triangles, traced on another thread.

use meshbrush_core::build::{CurveTracing, ErrorCurves, MeshSpec, Parts};
use meshbrush_core::document::Pace;
use meshbrush_core::layers::{LayerKind, PaintLayers, Surface, SurfaceGoal, SurfaceNorm};
use meshbrush_core::surface::CurvePoint;
use meshbrush_kit::kit::Ctx;
use meshbrush_kit::kit::clock::Instant;
use meshbrush_kit::kit::command::{Command, EditCommand, LayerCommand};
use meshbrush_kit::kit::jobs::{Jobs, Slice, Slot};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::Progress;
use meshbrush_study::error_plot::error_plot;
use meshbrush_study::plot::Plot;

/// Traces the curves of the document, and keeps the last ones.
#[derive(Default)]
pub struct TracedCurves {
    /// By the number of [`CurveInputs`].
    curves: Slot<u64, Result<ErrorCurves, String>>,
    asked: Option<CurveInputs>,
}

/// What the curves of a document depend on.
struct CurveInputs {
    /// Of the document.
    revision: u64,
    /// Grows when anything below changes.
    number: u64,
    /// Without the goals of the surfaces; `None` where no visible layer is a surface.
    work: Option<(MeshSpec, SurfaceNorm)>,
    paint: PaintLayers,
}

impl TracedCurves {
    /// Returns whether [`Self::trace`] would trace the curves.
    pub fn is_due(&self, session: &Session) -> bool {
        let is_settled = session.follower().stage().is_settled() && !session.document().is_in_gesture();
        let is_new = self.asked.as_ref().is_none_or(|asked| {
            asked.revision != session.document().revision()
                || (asked.work.is_some() && !self.curves.has(&asked.number))
        });
        is_settled && is_new && !self.curves.is_running()
    }

    /// Traces the curves of the document, where that is due.
    pub fn trace(&mut self, session: &Session, jobs: &Jobs) {
        if !self.is_due(session) {
            return;
        }
        self.ask(session);
        let Some(CurveInputs { number, work: Some((spec, norm)), paint, .. }) = &self.asked else { return };
        let (spec, norm, paint) = (spec.clone(), *norm, paint.clone());
        let follower = session.follower();
        // A mesh that was given up is not that of the document.
        let parts = match follower.is_in_step(session.document()) {
            true => Parts {
                domain: Some(follower.domain().clone()),
                field: Some(follower.shared_field()),
                samples: follower.surface().map(|rule| rule.samples().clone()),
                spare: None,
            },
            false => Parts::default(),
        };
        let begin = move || {
            let tracing = CurveTracing::new(spec, parts, norm, CurveTracing::DEFAULT_MOST);
            Some((tracing, Pace::default()))
        };
        let trace = move |(tracing, pace): &mut (CurveTracing, Pace)| {
            let began = Instant::now();
            let progress = tracing.advance(Some(&paint), pace.visits());
            pace.took(began.elapsed().as_secs_f64());
            match progress {
                Ok(Progress::More) => Slice::More,
                Ok(Progress::Done) => Slice::Found(Ok(tracing.curves().clone())),
                Err(error) => Slice::Found(Err(error.to_string())),
            }
        };
        self.curves.start_in_slices(*number, begin, trace, jobs);
    }

    /// Notes what the document asks for.
    fn ask(&mut self, session: &Session) {
        let document = session.document();
        let spec = document.settings().mesh_spec().ok();
        let norm = spec.as_ref().and_then(MeshSpec::surface_norm);
        let work = spec.zip(norm).map(|(spec, norm)| (spec.without_goals(norm), norm));
        let (revision, paint) = (document.revision(), document.paint().clone());
        let number = match &self.asked {
            Some(asked) if asked.work == work && asked.paint == paint => asked.number,
            Some(asked) => asked.number + 1,
            None => 0,
        };
        self.asked = Some(CurveInputs { revision, number, work, paint });
    }

    /// Takes what was traced. Returns whether curves are being traced.
    pub fn take(&mut self, session: &Session, jobs: &Jobs) -> bool {
        let is_of_document = |asked: &&CurveInputs| {
            asked.revision == session.document().revision() || session.document().is_in_gesture()
        };
        if let Some(asked) = self.asked.as_ref().filter(is_of_document) {
            self.curves.want(&asked.number, jobs);
        }
        self.curves.take(jobs)
    }

    /// Returns the plot of the last curves, and whether they are those of the document as it is; or why there
    /// are none.
    pub fn plot(&self, session: &Session) -> Result<Option<(Plot, bool)>, String> {
        let Some((number, curves)) = self.curves.last() else { return Ok(None) };
        let curves = curves.as_ref().map_err(String::clone)?;
        let follower = session.follower();
        let error = follower.surface().and_then(|rule| rule.error_of(curves.norm));
        let here = error.map(|error| CurvePoint { triangles: follower.mesh().triangles().count(), error });
        let is_current = self
            .asked
            .as_ref()
            .is_some_and(|asked| asked.number == *number && asked.revision == session.document().revision());
        Ok(Some((error_plot(curves, here), is_current)))
    }

    /// Returns whether there is a plot to show.
    pub fn is_known(&self) -> bool {
        matches!(self.curves.last(), Some((_, Ok(_))))
    }
}

/// Makes the mesh of a point of the curve of the smallest meshes that of the document.
pub fn take_point(point: CurvePoint, ctx: &mut Ctx<'_>) {
    let settings = ctx.session.document().settings();
    let Some(norm) = settings.surfaces().last().map(|(_, surface)| surface.norm) else { return };
    let of_norm = settings.surfaces().filter(|(layer, surface)| surface.norm == norm && !layer.locked);
    let changes: Vec<_> = of_norm
        .map(|(layer, surface)| {
            let goal = match surface.goal {
                SurfaceGoal::Within(_) => SurfaceGoal::Within(point.error),
                SurfaceGoal::AtMost(_) => SurfaceGoal::AtMost(point.triangles),
            };
            let kind = LayerKind::Surface(Surface { goal, ..surface.clone() });
            Command::from(LayerCommand::SetKind(layer.id, Box::new(kind)))
        })
        .collect();
    changes.into_iter().for_each(|change| ctx.send(change));
    ctx.send(Command::from(EditCommand::EndGesture));
}
