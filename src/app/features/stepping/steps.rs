//! The steps of the refinement of one document, and which of them is shown.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::Context;
use glam::DVec2;

use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::outline::EdgeTargets;
use meshbrush_kit::kit::document_id::DocumentId;
use meshbrush_kit::kit::jobs::{Jobs, Slot};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::{Mesh, Progress, barycentric};
use meshbrush_render::colormap::Ground;
use meshbrush_study::report::ReportFigure;
use meshbrush_study::steps::{Names, Recording, StepAction, StepPlayer, StepRecorder};

/// A mesh with more triangles is recorded up to here: nobody follows more steps.
pub const MOST_TRIANGLES: usize = 20_000;
/// Steps per second that can be chosen, with their names.
pub const SPEEDS: [(f64, &str); 5] = [(1.0, "1"), (3.0, "3"), (10.0, "10"), (30.0, "30"), (300.0, "300")];
/// How many steps are exported if nothing else is chosen.
const FIRST_EXPORTED: usize = 50;
/// Triangles that are asked about between two looks at the clock.
const SLICE: usize = 4096;

/// The steps of one document.
pub struct Steps {
    document: DocumentState,
    recording: Slot<(), Result<Recorded, String>>,
    /// The figure of the report that the first step shown is to show.
    pub(super) figure: Option<ReportFigure>,
    /// The point, in world units, to whose triangle the first step shown belongs.
    queried: Option<DVec2>,
    /// How many steps are done at first, where that was asked for.
    first: Option<usize>,
    player: Option<StepPlayer>,
    /// The time up to which steps were played, in seconds, while it goes forwards by itself.
    played_until: Option<f64>,
    speed: f64,
    /// Whether the next and the previous step are bisections, and stages after them.
    pub only_bisections: bool,
    /// The first and the last step to be exported.
    pub(super) export_range: [usize; 2],
    /// The ground of exported drawings, where it was chosen; else that of the window.
    pub(super) export_ground: Option<Ground>,
}

/// What was recorded on another thread.
#[derive(Clone)]
struct Recorded {
    recording: Arc<Recording>,
    /// The index of the bisection that made the triangle around the queried point.
    made_queried: Option<usize>,
}

/// Identifies a document and its state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct DocumentState {
    document: DocumentId,
    revision: u64,
}

impl DocumentState {
    fn of(session: &Session) -> Self {
        Self { document: session.document_id(), revision: session.document().revision() }
    }
}

impl Steps {
    /// Returns the steps of the document of a session: to begin at the one that a figure of the report shows,
    /// at the one that made the triangle around a point in world units, or before the first one.
    pub fn new(session: &Session, figure: Option<ReportFigure>, queried: Option<DVec2>) -> Self {
        Self {
            document: DocumentState::of(session),
            recording: Slot::default(),
            figure,
            queried,
            first: None,
            player: None,
            played_until: None,
            speed: SPEEDS[1].0,
            only_bisections: false,
            export_range: [0, FIRST_EXPORTED],
            export_ground: None,
        }
    }

    /// Returns the steps, to begin where so many are done.
    pub fn at(self, position: usize) -> Self {
        Self { first: Some(position), ..self }
    }

    /// Returns the arrays at the step that is shown; `None` until the steps are recorded.
    pub fn player(&self) -> Option<&StepPlayer> {
        self.player.as_ref()
    }

    /// Returns whether it goes forwards by itself.
    pub fn is_playing(&self) -> bool {
        self.played_until.is_some()
    }

    /// Returns the steps per second.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Returns whether the document is still the one that is stepped through.
    pub fn belongs_to(&self, session: &Session) -> bool {
        self.document == DocumentState::of(session)
    }

    /// Takes what was recorded, waiting for it as long as the frame may, and plays. Returns whether anything
    /// is being recorded.
    ///
    /// # Errors
    /// Fails with a sentence when there are no steps to show.
    pub fn advance(&mut self, session: &Session, jobs: &Jobs, ctx: &Context) -> Result<bool, String> {
        if self.player.is_some() {
            self.play(ctx);
            return Ok(false);
        }
        if self.recording.has(&()) {
            let works = self.recording.take(jobs);
            if let Some((_, recorded)) = self.recording.last() {
                let Recorded { recording, made_queried } = recorded.clone()?;
                let mut player = StepPlayer::new(recording);
                let steps = player.recording().steps();
                let shown =
                    steps.iter().position(|step| self.figure.is_some_and(|figure| figure.shows(step)));
                let shown = shown.or(made_queried).map(|index| index + 1);
                player.go_to(self.first.or(shown).unwrap_or(0));
                self.player = Some(player);
                self.recording = Slot::default();
            }
            return Ok(works);
        }
        if session.follower().is_in_step(session.document()) {
            self.recording.start((), record(session, self.queried)?, jobs);
        } else if session.stage().is_settled() {
            return Err("There are no steps to show, as the mesh is not up to date with the document.".into());
        }
        Ok(true)
    }

    /// Goes to where `position` steps are done.
    pub fn go_to(&mut self, position: usize) {
        if let Some(player) = &mut self.player {
            player.go_to(position);
        }
    }

    /// Goes so many steps, or bisections, forwards or backwards, and ends the playing.
    pub fn go_by(&mut self, steps: isize) {
        self.played_until = None;
        let only_bisections = self.only_bisections;
        if let Some(player) = &mut self.player {
            go(player, steps, only_bisections);
        }
    }

    /// Begins or ends to go forwards by itself. At the end it begins again.
    pub fn toggle_play(&mut self, ctx: &Context) {
        let Some(player) = &mut self.player else { return };
        self.played_until = match self.played_until {
            Some(_) => None,
            None => {
                if player.position() == player.len() {
                    player.go_to(0);
                }
                Some(ctx.input(|input| input.time))
            }
        };
    }

    /// Sets how many steps it goes in a second.
    pub fn set_speed(&mut self, speed: f64) {
        self.speed = speed;
    }

    /// Returns the middle of the triangle that the step is about, in world units.
    pub fn place(&self) -> Option<DVec2> {
        let player = self.player.as_ref()?;
        let number = player.step()?.triangle;
        let lattice = &player.recording().lattice;
        (number > 0).then(|| {
            player.corners(number).map(|corner| lattice.world_from_lattice(corner)).iter().sum::<DVec2>()
                / 3.0
        })
    }

    fn play(&mut self, ctx: &Context) {
        let (Some(player), Some(until)) = (&mut self.player, &mut self.played_until) else { return };
        let steps = ((ctx.input(|input| input.time) - *until) * self.speed).max(0.0).floor();
        go(player, steps as isize, self.only_bisections);
        *until += steps / self.speed;
        if player.position() == player.len() {
            self.played_until = None;
        } else {
            ctx.request_repaint_after(Duration::from_secs_f64(1.0 / self.speed));
        }
    }
}

/// Returns the letters of a step: those of its lines, and of a figure of the report that is shown.
pub fn names_of(player: &StepPlayer, figure: Option<ReportFigure>) -> Names {
    let mut names = player.names();
    if let Some(figure) = figure {
        figure.add_letters(player, &mut names);
    }
    names
}

/// Goes so many steps forwards or backwards, or so many that change the mesh: where no more follow, to the
/// end.
fn go(player: &mut StepPlayer, steps: isize, only_bisections: bool) {
    if !only_bisections {
        return player.go_to(player.position().saturating_add_signed(steps));
    }
    let (mut position, mut left) = (player.position(), steps.unsigned_abs());
    let recorded = player.recording().steps();
    while left > 0 && if steps > 0 { position < recorded.len() } else { position > 0 } {
        position = position.saturating_add_signed(steps.signum());
        left -= usize::from(position > 0 && recorded[position - 1].changes_mesh());
    }
    player.go_to(position);
}

/// Returns the index of the last bisection of a triangle around a point in world units.
fn bisection_around(recording: &Arc<Recording>, point: DVec2) -> Option<usize> {
    let mut player = StepPlayer::new(recording.clone());
    let at = recording.lattice.lattice_from_world(point);
    let mut last = None;
    for (index, step) in recording.steps().iter().enumerate() {
        if step.action != StepAction::Bisect {
            continue;
        }
        player.go_to(index);
        let divided = [Some(step.triangle), step.across];
        let is_around = |number| barycentric(player.corners(number), at).iter().all(|share| *share >= 0.0);
        if divided.into_iter().flatten().any(is_around) {
            last = Some(index);
        }
    }
    last
}

/// Returns the work of recording, for another thread.
fn record(
    session: &Session,
    queried: Option<DVec2>,
) -> Result<impl FnOnce() -> Result<Recorded, String> + Send + 'static, String> {
    let follower = session.follower();
    let spec = follower.settings().mesh_spec().map_err(|error| error.to_string())?;
    let (domain, field) = (follower.domain().clone(), follower.shared_field());
    let surface = follower.surface().cloned();
    let (rule, cleaning, paint) = (spec.rule, spec.cleaning, session.document().paint().clone());
    let coarse = Mesh::coarse_grid(&spec.lattice, |node| domain.admits(node), &spec.limits)
        .map_err(|error| error.to_string())?;
    if coarse.raw_triangle_count() > MOST_TRIANGLES {
        return Err(format!(
            "The coarse grid has {} triangles, and steps are shown of up to {MOST_TRIANGLES}. Set a larger grid spacing.",
            coarse.raw_triangle_count()
        ));
    }
    Ok(move || {
        let mut recorder = StepRecorder::new(coarse, spec.limits, MOST_TRIANGLES);
        let mut criterion =
            RefinementCriterion::new(&domain, &field, rule, Some(&paint)).with_surface(surface.as_deref());
        while recorder
            .advance(|element| criterion.exceeds(element), SLICE)
            .map_err(|error| error.to_string())?
            == Progress::More
        {}
        let targets = EdgeTargets::by_rule(rule, &field, &paint);
        let recording = Arc::new(recorder.finish_on(&domain, targets, &cleaning));
        let made_queried = queried.and_then(|point| bisection_around(&recording, point));
        Ok(Recorded { recording, made_queried })
    })
}
