//! Layers of a surface that the mesh is to be close to.

use eframe::egui::Ui;

use super::raster::source_rows;
use crate::app::features::domain::DomainCommand;
use crate::app::features::layers::{LayerEditor, OPEN_SURFACE};
use meshbrush_core::layers::{Layer, LayerKind, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource};
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand, ViewCommand};
use meshbrush_kit::kit::{
    Addition, FormulaRow, FrameState, LayerKindRow, add_layer, end_gesture_when_released, remark, set_kind,
    set_kind_once,
};
use meshbrush_mesh::text::round_below;
use meshbrush_ui::widgets::{ActionButton, Icon, NumberRow, ValueRow, format, segmented};

/// A raster or a formula as a surface.
pub static SURFACE: LayerKindRow = LayerKindRow {
    place: 10,
    is_of: |kind| kind.is::<Surface>(),
    icon: Icon::SURFACE,
    tool: None,
    additions: &[
        Addition {
            title: "surface of a file, within an error…",
            command: |_| Command::from(FileCommand::Ask(&OPEN_SURFACE)),
        },
        Addition {
            title: "surface of a formula, within an error",
            command: |state| {
                let bounds = state.session.document().settings().domain.bounds;
                add_layer(LayerKind::default_surface(&bounds))
            },
        },
    ],
    parameters,
};

/// Most triangles that can be asked for.
const MOST: f64 = 1e9;

/// The norms, and their names.
const NORMS: [(SurfaceNorm, &str); 3] = [
    (SurfaceNorm::Largest, "Largest"),
    (SurfaceNorm::RootMeanSquare, "Mean square"),
    (SurfaceNorm::Gradient, "Gradient"),
];

/// What is given, and what follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GivenGoal {
    Error,
    Triangles,
}

impl GivenGoal {
    const CHOICES: [(Self, &str); 2] = [(Self::Error, "Error"), (Self::Triangles, "Triangles")];

    fn of(goal: SurfaceGoal) -> Self {
        match goal {
            SurfaceGoal::Within(_) => Self::Error,
            SurfaceGoal::AtMost(_) => Self::Triangles,
        }
    }
}

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(surface) = layer.kind.get::<Surface>() else { return };
    let Surface { source, goal, norm } = surface;
    norm_row(ui, state, layer, surface, commands);
    goal_rows(ui, state, layer, surface, commands);
    fit_rows(ui, state, layer, commands);
    match source {
        SurfaceSource::Raster(source) => {
            source_rows(ui, state, source);
            missing_rows(ui, state, layer, commands);
        }
        SurfaceSource::Formula(formula) => {
            let row = FormulaRow {
                label: "Surface at (x, y)",
                hint: "sin(3*x) * exp(-y*y)",
                help: "The height at x and y, as a formula. It is compared with the mesh at 1024 places or more along the \
                       longer side of the domain.",
            };
            if let Some(Some(formula)) = row.show(ui, state, Some(formula)) {
                let source = SurfaceSource::Formula(formula);
                set_kind_once(layer, Surface { source, goal: *goal, norm: *norm }, commands);
            }
        }
    }
}

/// Shows which error is meant.
fn norm_row(
    ui: &mut Ui,
    state: &FrameState<'_>,
    layer: &Layer,
    surface: &Surface,
    commands: &mut Vec<Command>,
) {
    let mut norm = surface.norm;
    let help = "The error that is meant: the largest difference, for which the mesh is exactly the smallest, or a root mean \
                square over the mesh, of the differences or of those of the gradient, for which it is near it.";
    if segmented(ui, "Norm", &mut norm, &NORMS).on_hover_text(help).changed() {
        let fit = state.feature::<LayerEditor>().surface_fit.figures(state.session);
        let error = fit.map(|(fit, _)| fit.error(norm)).filter(|error| *error > 0.0 && error.is_finite());
        // An error of one norm says nothing about another one: the mesh as it is stays about as it is.
        let goal = match (surface.goal, error) {
            (SurfaceGoal::Within(_), Some(error)) => SurfaceGoal::Within(round_below(error)),
            (goal, _) => goal,
        };
        set_kind_once(layer, Surface { goal, norm, ..surface.clone() }, commands);
    }
}

/// Shows the goal.
fn goal_rows(
    ui: &mut Ui,
    state: &FrameState<'_>,
    layer: &Layer,
    surface: &Surface,
    commands: &mut Vec<Command>,
) {
    let with = |goal| LayerKind::Surface(Surface { goal, ..surface.clone() });
    let mut given = GivenGoal::of(surface.goal);
    if segmented(ui, "What is given", &mut given, &GivenGoal::CHOICES).changed() {
        return set_kind_once(layer, with(other_goal(state, layer, given)), commands);
    }
    let (response, goal) = match surface.goal {
        SurfaceGoal::Within(mut error) => {
            let help = "The error that the mesh has at most, by the norm that is chosen above.";
            let row =
                NumberRow::new("Largest error", &mut error).range(f64::MIN_POSITIVE..=f64::MAX).help(help);
            (row.show(ui), SurfaceGoal::Within(error))
        }
        SurfaceGoal::AtMost(count) => {
            let mut count = count as f64;
            let help = "The mesh has the least error that is possible with so many triangles. Nodes that move onto an \
                        outline afterwards do not count.";
            let row = NumberRow::new("Most triangles", &mut count).range(1.0..=MOST).integer().help(help);
            (row.show(ui), SurfaceGoal::AtMost(count as usize))
        }
    };
    if response.changed() {
        set_kind(layer, with(goal), commands);
    }
    end_gesture_when_released(&response, commands);
}

/// Returns the goal of the other sort that the mesh as it is meets.
fn other_goal(state: &FrameState<'_>, layer: &Layer, given: GivenGoal) -> SurfaceGoal {
    let follower = state.session.follower();
    match given {
        GivenGoal::Triangles => SurfaceGoal::AtMost(follower.mesh().triangles().count().max(1)),
        GivenGoal::Error => {
            let mut errors = follower.surface().into_iter().flat_map(|rule| rule.errors());
            let error = errors.find(|(id, _)| *id == layer.id).map(|(_, error)| error);
            let error = error.filter(|error| *error > 0.0 && error.is_finite());
            SurfaceGoal::Within(error.or(default_error(layer)).unwrap_or(1.0))
        }
    }
}

fn default_error(layer: &Layer) -> Option<f64> {
    let Surface { source, .. } = layer.kind.get()?;
    LayerKind::default_error(source.raster()?)
}

/// Shows how many samples have no value, and what takes them out of the domain.
fn missing_rows(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let count = state.session.follower().surface().map(|rule| rule.samples().count());
    if let Some(count) = count.filter(|count| count.missing > 0) {
        let share = format::digits(100.0 * count.missing_share(), 3);
        let text = format!("{} ({share} %)", format::count(count.missing as u64));
        let help = "Samples in the domain at which no surface has a value. They are left out: the mesh is not refined there.";
        ValueRow::new("Without a value", &text).help(help).show(ui);
    }
    let button = ActionButton::new("Use the area with values as the domain");
    if ui.add(button).clicked() {
        commands.push(Command::from(DomainCommand::UseValues(layer.id)));
    }
}

/// Shows how far the mesh is from the surfaces.
fn fit_rows(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let measured = &state.feature::<LayerEditor>().surface_fit;
    if measured.is_due(state.session) {
        commands.push(Command::from(LayerCommand::MeasureSurface));
    }
    let rule = state.session.follower().surface();
    if layer.visible && rule.is_some_and(|rule| rule.exceeded_count().is_some()) {
        remark(
            ui,
            "The mesh has more triangles already without this layer: ask for more, or take a larger spacing.",
        );
    }
    let Some((fit, is_current)) = measured.figures(state.session) else {
        ValueRow::new("Error", "being measured").show(ui);
        return;
    };
    ui.scope(|ui| {
        if !is_current {
            ui.disable();
        }
        let help = "The largest difference of a sample of the surfaces from the mesh. A click goes there.";
        if ValueRow::new("Error", &format::digits(fit.largest, 5)).help(help).link().show(ui).clicked() {
            commands.push(Command::from(ViewCommand::LookAt(fit.at)));
        }
        let help = "The square root of the mean of the squares of all differences.";
        ValueRow::new("Root mean square", &format::digits(fit.rms, 5)).help(help).show(ui);
        let help = "The same of the differences between the gradients of the surface and of the mesh.";
        ValueRow::new("Gradient", &format::digits(fit.gradient, 5)).help(help).show(ui);
    });
}
