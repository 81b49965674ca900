//! Other paths than the best: the corridor of nearly best ones, alternatives, and the front of length against
//! risk.

use eframe::egui::Ui;

use crate::app::features::paths::{
    AlternativesCommand, FRONT_PATHS, FoundPath, FrontCommand, MOST_ALTERNATIVES, PathCommand, Paths,
};
use meshbrush_core::document::PathCost;
use meshbrush_core::path::{FrontPoint, Solution};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, remark};
use meshbrush_study::plot::{Axis, Mark, Plot, Scale, Series};
use meshbrush_ui::widgets::{
    ActionButton, Section, SliderRow, ValueRow, format, plot_picker, toggle_row, value_row,
};

/// The panel of other paths, shown as long as there is a path.
pub static OTHER_PATHS: Panel = Panel { name: "other paths", tab: Tab::Paths, place: 1, show };

/// Height of the plot, in points.
const HEIGHT: f32 = 190.0;
/// The title of the plot.
const FRONT: &str = "Length against risk";

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(route) = state.feature::<Paths>().tool.route_in(&state.session.document().settings().paths)
    else {
        return;
    };
    let shown = state.feature::<Paths>().finder.shown().get(route);
    let Some(found) = shown.and_then(|shown| shown.found.as_ref()) else { return };
    let mut sent = Vec::new();
    Section::new("Other paths").show(ui, |ui| {
        corridor(ui, state, &mut sent);
        alternatives(ui, state, &mut sent);
        front(ui, state, found, &mut sent);
    });
    commands.extend(sent.into_iter().map(Command::from));
}

fn corridor(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<PathCommand>) {
    let corridor = &state.feature::<Paths>().finder.corridor;
    if !corridor.is_on {
        return;
    }
    let mut percent = 100.0 * corridor.share;
    let row = SliderRow::new("Above best", &mut percent, 0.1..=50.0).logarithmic().unit("%").default(5.0);
    let help = "How much more than the best path the paths in the corridor cost at most.";
    if row.help(help).show(ui).changed() {
        commands.push(PathCommand::CorridorShare(percent / 100.0));
    }
    ui.add_space(4.0);
}

fn alternatives(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<PathCommand>) {
    let finder = &state.feature::<Paths>().finder.alternatives;
    if !finder.is_on {
        return;
    }
    if !finder.paths().is_empty() {
        remark(ui, "Cost above the best · length · accumulated risk");
    }
    let is_current = state.feature::<Paths>().finder.is_current(state.session);
    let mut pointed = None;
    for (number, path) in finder.paths().iter().enumerate() {
        let row = alternative_row(ui, state, (number, path), is_current);
        if row.hovered() || row.has_focus() {
            pointed = Some(number);
        }
        if row.clicked() && is_current {
            commands.push(PathCommand::Alternatives(AlternativesCommand::Take(number)));
        }
    }
    if pointed != finder.pointed {
        commands.push(PathCommand::Alternatives(AlternativesCommand::Point(pointed)));
    }
    if finder.is_running() {
        value_row(ui, "Searching", &format!("{} of {MOST_ALTERNATIVES}", finder.paths().len()));
        if ui.add(ActionButton::new("Cancel search").vanishing()).clicked() {
            commands.push(PathCommand::Alternatives(AlternativesCommand::Cancel));
        }
    } else if finder.paths().is_empty() && is_current {
        remark(ui, "No path that differs substantially costs less than twice the best.");
    }
    ui.add_space(4.0);
}

fn alternative_row(
    ui: &mut Ui,
    state: &FrameState<'_>,
    (number, path): (usize, &Solution),
    is_current: bool,
) -> eframe::egui::Response {
    let percent = format::significant(100.0 * state.feature::<Paths>().finder.alternatives.excess(path), 2);
    let length = format::length(path.length_on_ground, state.unit());
    let risk = format::significant(path.risk, 3);
    let label = format!("Alternative {}", number + 1);
    let value = format!("+{percent} % · {length} · {risk}");
    let help = "Resting the pointer here highlights this path; a click leads the path along it, by a place in between.";
    let row = ValueRow::new(&label, &value).help(help);
    if is_current { row.link().show(ui) } else { row.show(ui) }
}

fn front(ui: &mut Ui, state: &FrameState<'_>, found: &FoundPath, commands: &mut Vec<PathCommand>) {
    let finder = &state.feature::<Paths>().finder.front;
    let mut send = |command| commands.push(PathCommand::Front(command));
    let mut is_on = finder.is_on;
    if toggle_row(ui, "Front", &mut is_on).changed() {
        send(FrontCommand::Show(is_on));
    }
    if !finder.is_on {
        return;
    }
    ui.add_space(4.0);
    let points = finder.points();
    let tip = |number: usize| tip_of(&points[number], state);
    let picked = plot_picker(ui, FRONT, &front_plot(state, found), HEIGHT, tip);
    let pointed = picked.as_ref().map(|picked| picked.point);
    if pointed != finder.pointed {
        send(FrontCommand::Point(pointed));
    }
    if let Some(picked) = picked.filter(|picked| picked.is_clicked) {
        send(FrontCommand::Take(picked.point));
    }
    if let Some(done) = finder.progress() {
        value_row(ui, "Finding paths", &format!("{done} of {FRONT_PATHS}"));
        if ui.add(ActionButton::new("Cancel front").vanishing()).clicked() {
            send(FrontCommand::Cancel);
        }
    }
    let can = |is_safer| match &state.session.document().settings().paths.cost {
        PathCost::Weighted(weights) => finder.next(*weights, is_safer).is_some(),
        PathCost::Formula(_) => false,
    };
    let row = [
        ("Shorter path", can(false), PathCommand::Front(FrontCommand::Shorter)),
        ("Safer path", can(true), PathCommand::Front(FrontCommand::Safer)),
    ];
    button_rows(ui, [row], commands);
}

fn tip_of(point: &FrontPoint, state: &FrameState<'_>) -> String {
    format!(
        "Length {}, accumulated risk {}\nWeight of risk {}; a click takes it.",
        format::length(point.solution.length_on_ground, state.unit()),
        format::significant(point.solution.risk, 3),
        format::significant(point.weights.risk, 3),
    )
}

/// Returns the paths of the front, and the path as it is.
fn front_plot(state: &FrameState<'_>, found: &FoundPath) -> Plot {
    let place = |path: &Solution| [path.length_on_ground, path.risk];
    let front =
        state.feature::<Paths>().finder.front.points().iter().map(|point| place(&point.solution)).collect();
    Plot {
        title: FRONT.into(),
        x: Axis::new("Length", Scale::Linear).unit(state.unit().symbol()),
        y: Axis::new("Accumulated risk", Scale::Linear),
        series: vec![
            Series::new("Best paths", Mark::Points, front),
            Series::new("This path", Mark::Points, vec![place(&found.solution)]),
        ],
        note: String::new(),
    }
}
