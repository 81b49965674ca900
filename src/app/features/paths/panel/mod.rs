//! The paths: what they cost, how far from the best they can be, and the risk along them.

mod cost;
mod export;
mod keep_out;
mod others;

use eframe::egui::{RichText, Ui};

use crate::app::features::paths::{FoundPath, PathCommand, Paths, ShownPath};
use meshbrush_core::document::PathPlan;
use meshbrush_core::earth::{Speed, hours_and_minutes};
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, remark};
use meshbrush_mesh::text::{LengthUnit, percent_above};
use meshbrush_study::plot::{Axis, Mark, Plot, Scale, Series};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{
    Icon, NumberRow, Section, TextRow, ValueRow, dropdown_row, empty_state, format, plot_view,
};

pub use cost::MOST_WEIGHT;
pub use others::OTHER_PATHS;

/// The path of the selected place, or else the first.
pub static PATH_PANEL: Panel = Panel { name: "path", tab: Tab::Paths, place: 0, show };

/// The highest speed, in knots.
const MOST_KNOTS: f64 = 1000.0;
/// Height of the profile, in points.
const HEIGHT: f32 = 120.0;
/// The text for a certificate that has no triangle for the path.
const NO_PROOF: &str = "There is no proof for this path.";
/// Widths of the interval that can be asked for, with their names.
const WIDTHS: [(f64, &str); 5] =
    [(1.0, "As it is"), (0.05, "5 %"), (0.01, "1 %"), (0.001, "0.1 %"), (0.0001, "0.01 %")];

/// The sentences about the bounds of the cost, and about the lengths.
const PROVED: &str = "The best of all paths through the domain costs at most so much less than this one. It is \
                      proved for the domain itself, not for the mesh, and not estimated.";
const LEAST_POSSIBLE: &str = "Two proved bounds of the cost of the best path: no path through the domain costs less than \
                              the first number, and one that was found costs the second.";
const IN_THE_PLANE: &str =
    "The length in the plane, in the unit of the document. Costs are summed up over this length.";
const ON_THE_ELLIPSOID: &str =
    "The length in metres on the ellipsoid WGS 84. Costs are summed up over this length.";
const IN_DEGREES: &str = "The length in degrees, as if one of longitude were as long as one of latitude. Costs are summed \
                          up over this length, so a path of least cost is not the shortest in metres.";

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let plan = &state.session.document().settings().paths;
    let route = state.feature::<Paths>().tool.route_in(plan);
    let note = match plan.routes.len() {
        0 | 1 => String::new(),
        count => format!("{} of {count}", route.map_or(0, |route| route + 1)),
    };
    Section::new("Path").note(&note).show(ui, |ui| {
        let Some(route) = route else {
            let text = "Click the start and then the goal with the path tool[ ({path})].";
            return empty_state(ui, Icon::PATH, "No path", text);
        };
        name_row(ui, plan, route, commands);
        let shown = state.feature::<Paths>().finder.shown().get(route);
        if let Some(problem) = shown.and_then(|shown| shown.problem.as_ref()) {
            let text = RichText::new(format!("{problem} The path that is shown is outdated."));
            ui.label(text.font(font::body()).color(tokens(ui).danger));
            ui.add_space(4.0);
        }
        let Some(shown) = shown else { return };
        match &shown.found {
            Some(found) => {
                figures(ui, state, found);
                time_rows(ui, state, found, commands);
                former_row(ui, state, (route, found), commands);
                proof(ui, state, shown, commands);
                profile_view(ui, state, found, commands);
            }
            None if shown.problem.is_none() => remark(ui, "The path is being found."),
            None => {}
        }
    });
}

/// What paths cost, the regions that they stay out of, and what is done with them as a whole.
pub static PATH_COST: Panel = Panel { name: "cost of paths", tab: Tab::Paths, place: 2, show: show_cost };

fn show_cost(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let plan = &state.session.document().settings().paths;
    Section::new("Cost, regions and files").id("cost of paths").show(ui, |ui| {
        cost::rows(ui, state, &plan.cost, commands);
        keep_out::clearance_row(ui, state, commands);
        keep_out::rows(ui, state, commands);
        if plan.routes.is_empty() {
            return;
        }
        let is_selected = state.feature::<Paths>().tool.selected_in(plan).is_some();
        let path = |command| Command::from(command);
        let rows = [[
            ("Delete place", is_selected, path(PathCommand::Delete)),
            ("Delete all paths", true, path(PathCommand::DeleteAll)),
        ]];
        button_rows(ui, rows, commands);
        export::rows(ui, state, commands);
    });
}

/// The name of the path, to be typed.
fn name_row(ui: &mut Ui, plan: &PathPlan, route: usize, commands: &mut Vec<Command>) {
    let mut name = plan.names.get(route).cloned().unwrap_or_default();
    let default = PathPlan::default().name(route);
    let row = TextRow::new("Name", &mut name).hint(&default);
    let response = row.help("The name of the path, beside its ends on the canvas.").show(ui);
    if response.changed() {
        commands.push(Command::from(PathCommand::Name(name)));
    }
    if response.lost_focus() {
        commands.push(Command::from(EditCommand::EndGesture));
    }
    ui.add_space(4.0);
}

fn figures(ui: &mut Ui, state: &FrameState<'_>, found: &FoundPath) {
    let solution = &found.solution;
    let number = |value: f64| format::significant(value, 4);
    let has_bound = solution.lower > 0.0;
    let gap = match has_bound {
        true => format!("within {} of optimal", percent_above(solution.gap())),
        false => "…".to_owned(),
    };
    let optimum = format::interval(solution.lower, solution.upper);
    let (length, metric) = match found.length_on_the_ellipsoid() {
        Some(metres) => (format::length(metres, LengthUnit::Metre), ON_THE_ELLIPSOID),
        None if state.unit() == LengthUnit::Degree => {
            (format::length(solution.length, state.unit()), IN_DEGREES)
        }
        None => (format::length(solution.length, state.unit()), IN_THE_PLANE),
    };
    let cost = match has_bound {
        true => format::beside_interval(solution.cost, solution.lower, solution.upper),
        false => number(solution.cost),
    };
    let rows = [
        ("Cost", cost, "The integral of the cost per length along the path that is shown."),
        ("Proved", gap, PROVED),
        ("Least possible cost", optimum, LEAST_POSSIBLE),
        ("Length", length, metric),
        ("Accumulated risk", number(solution.risk), "The risk, summed up along the path."),
        (
            "Highest risk",
            number(found.highest_risk()),
            "The highest risk on the way, 0 to 1: the top of the plot.",
        ),
    ];
    ui.scope(|ui| {
        // The figures and the profile are in sight together.
        ui.spacing_mut().item_spacing.y = 0.0;
        for (label, value, help) in rows {
            ValueRow::new(label, &value).help(help).show(ui);
        }
    });
    if state.unit() == LengthUnit::Degree {
        remark(ui, "Lengths and costs are measured in degrees of the plane, not in metres on the earth.");
    }
}

/// Asks for a speed, and shows the time of the path, where lengths in metres are known.
fn time_rows(ui: &mut Ui, state: &FrameState<'_>, found: &FoundPath, commands: &mut Vec<Command>) {
    let Some(metres) = found.metres else { return };
    let mut knots = state.feature::<Paths>().tool.speed;
    let row = NumberRow::new("Speed", &mut knots).range(0.0..=MOST_KNOTS).default(0.0).unit("kn");
    if row.help("The speed for the time of the path, in knots; 0: no time is shown.").show(ui).changed() {
        commands.push(Command::from(PathCommand::Speed(knots)));
    }
    if let Some(speed) = Speed::from_knots(knots) {
        let help = "The time that the path takes at this speed, in hours and minutes.";
        ValueRow::new("Time", &hours_and_minutes(speed.seconds(metres))).help(help).show(ui);
    }
}

/// Shows the path before its proof found a better one, if there was one.
fn former_row(
    ui: &mut Ui,
    state: &FrameState<'_>,
    (route, found): (usize, &FoundPath),
    commands: &mut Vec<Command>,
) {
    let Some((former, excess)) = found.former.as_ref().zip(found.former_excess()) else { return };
    let (excess, length) =
        (format::percent_above(excess), format::length(former.length_on_ground, state.unit()));
    let value = format!("+{excess} · {length}");
    let help = "The proof found the better path that is shown; this is the one before it, thin on the canvas, with its \
                cost above the better one and its length. A click leads the path along it, by a place in between.";
    let row = ValueRow::new("Path before the proof", &value).help(help);
    if row.link().show(ui).clicked() {
        commands.push(Command::from(PathCommand::KeepFormer(route)));
    }
}

/// Asks for the width of the interval, and says how far the proof is.
fn proof(ui: &mut Ui, state: &FrameState<'_>, shown: &ShownPath, commands: &mut Vec<Command>) {
    let mut width = state.feature::<Paths>().finder.width();
    if dropdown_row(ui, "Prove within", &mut width, &WIDTHS).changed() {
        commands.push(Command::from(PathCommand::Width(width)));
    }
    remark(ui, &state_of(state, shown));
}

/// Returns a sentence that says how far the work on a path is.
fn state_of(state: &FrameState<'_>, shown: &ShownPath) -> String {
    let finder = &state.feature::<Paths>().finder;
    let found = shown.found.as_ref();
    match (finder.is_current(state.session), finder.is_proving()) {
        (false, _) => "The path is being found.".to_owned(),
        _ if shown.problem.is_some() => "The figures are those of the outdated path.".to_owned(),
        (true, true) => "The bound is being improved.".to_owned(),
        (true, false) if found.is_some_and(|found| found.solution.gap() > finder.width()) => {
            let end = found.and_then(|found| found.end);
            end.map_or_else(|| NO_PROOF.to_owned(), |end| end.to_string())
        }
        (true, false) => "Path and bound are up to date.".to_owned(),
    }
}

fn profile_view(ui: &mut Ui, state: &FrameState<'_>, found: &FoundPath, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    let distance = plot_view(ui, "Risk along the path", &profile(state, found), HEIGHT);
    if distance != state.feature::<Paths>().tool.shown_distance {
        commands.push(Command::from(PathCommand::ShowDistance(distance)));
    }
    ui.add_space(4.0);
}

/// Returns risk over the distance from the start.
fn profile(state: &FrameState<'_>, found: &FoundPath) -> Plot {
    let points = found.profile.iter().map(|sample| [sample.distance, sample.risk]).collect();
    Plot {
        title: "Risk along the path".into(),
        x: Axis::new("Distance", Scale::Linear).unit(state.unit().symbol()),
        y: Axis::new("Risk", Scale::Linear),
        series: vec![Series::new("Risk", Mark::Line, points)],
        note: String::new(),
    }
}
