//! The paths: what they cost, how far from the best they can be, and the risk along them.

use eframe::egui::{RichText, Ui};

use super::{Panel, button_rows, end_gesture_when_released, remark};
use crate::app::command::Command;
use crate::app::frame::FrameState;
use crate::app::paths::{FoundPath, PathCommand};
use crate::app::theme::{font, tokens};
use crate::app::widgets::{Icon, NumberRow, Section, ValueRow, dropdown_row, empty_state, format, plot_view};
use crate::document::PathCost;
use crate::path::Weights;
use crate::plot::{Axis, Mark, Plot, Scale, Series};

/// The path of the selected place, or else the first; with the tool for it, and as long as there are paths.
pub static PATH: Panel = Panel { name: "path", only_with_tool: false, show };

/// Height of the profile, in points.
const HEIGHT: f32 = 150.0;
/// Widths of the interval that can be asked for, with their names.
const WIDTHS: [(f64, &str); 5] =
    [(1.0, "As it is"), (0.05, "5 %"), (0.01, "1 %"), (0.001, "0.1 %"), (0.0001, "0.01 %")];

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let plan = &state.session.document().settings().paths;
    let route = state.tools.path.route_in(plan);
    let is_tool = state.tools.tool.panels.iter().any(|panel| panel.name == PATH.name);
    if route.is_none() && !is_tool {
        return;
    }
    let note = match plan.routes.len() {
        0 | 1 => String::new(),
        count => format!("{} of {count}", route.map_or(0, |route| route + 1)),
    };
    Section::new("Path").note(&note).show(ui, |ui| {
        let Some(route) = route else {
            let text = "Click the start and then the goal with the path tool (P).";
            return empty_state(ui, Icon::PATH, "No path", text);
        };
        let shown = state.paths.shown().get(route);
        if let Some(problem) = shown.and_then(|shown| shown.problem.as_ref()) {
            let text = RichText::new(format!("{problem} The path that is shown is outdated."));
            ui.label(text.font(font::body()).color(tokens(ui).danger));
            ui.add_space(4.0);
        }
        match shown.and_then(|shown| shown.found.as_ref()) {
            Some(found) => figures(ui, state, found, commands),
            None => remark(ui, "The path is being found."),
        }
        cost_rows(ui, &plan.cost, commands);
        let is_selected = state.tools.path.selected_in(plan).is_some();
        let path = |command| Command::Path(command);
        let rows = [[
            ("Swap start and goal", true, path(PathCommand::Swap)),
            ("Delete place", is_selected, path(PathCommand::Delete)),
        ]];
        button_rows(ui, rows, commands);
        button_rows(ui, [[("Delete all paths", true, path(PathCommand::DeleteAll))]], commands);
    });
}

fn figures(ui: &mut Ui, state: &FrameState<'_>, found: &FoundPath, commands: &mut Vec<Command>) {
    let solution = &found.solution;
    let number = |value: f64| format::significant(value, 4);
    let has_bound = solution.lower > 0.0;
    let gap = match has_bound {
        true => format!("within {} of optimal", percent(solution.gap())),
        false => "…".to_owned(),
    };
    let optimum = format!("{} … {}", number(solution.lower), number(solution.upper));
    let rows = [
        ("Cost", number(solution.cost), "The cost density, summed up along the path."),
        ("Proved", gap, "How much less the best path can cost at most; the bound is proved, not estimated."),
        ("Least possible cost", optimum, "The best path costs no less and no more than these."),
        ("Length", format::length(solution.length, state.unit()), "In the unit of the document."),
        ("Accumulated risk", number(solution.risk), "The risk, summed up along the path."),
        ("Highest risk", number(solution.highest_risk), "The highest risk on the way, 0 to 1."),
    ];
    for (label, value, help) in rows {
        ValueRow::new(label, &value).help(help).show(ui);
    }
    let mut width = state.paths.width();
    if dropdown_row(ui, "Prove within", &mut width, &WIDTHS).changed() {
        commands.push(Command::Path(PathCommand::Width(width)));
    }
    match (state.paths.is_current(state.session), state.paths.is_proving()) {
        (false, _) => remark(ui, "The path is being found."),
        (true, true) => remark(ui, "The bound is being improved."),
        (true, false) if solution.gap() > state.paths.width() => {
            remark(ui, "The certificate ended here. A finer mesh may give a better path.");
        }
        (true, false) => remark(ui, "Path and bound are up to date."),
    }
    ui.add_space(4.0);
    if let Some(distance) = plot_view(ui, "Risk along the path", &profile(state, found), HEIGHT) {
        commands.push(Command::Path(PathCommand::ShowDistance(Some(distance))));
    } else if state.tools.path.shown_distance.is_some() {
        commands.push(Command::Path(PathCommand::ShowDistance(None)));
    }
    ui.add_space(4.0);
}

/// Risk over the distance from the start.
fn profile(state: &FrameState<'_>, found: &FoundPath) -> Plot {
    let points = found.profile.iter().map(|sample| [sample.distance, sample.risk]).collect();
    Plot {
        title: "Risk along the path".into(),
        x: Axis::new("Distance", Scale::Linear).unit(state.unit().symbol()),
        y: Axis::new("Risk", Scale::Linear),
        series: vec![Series { name: "Risk".into(), mark: Mark::Line, points }],
        note: String::new(),
    }
}

/// What a path costs: the weights, or the formula.
fn cost_rows(ui: &mut Ui, cost: &PathCost, commands: &mut Vec<Command>) {
    match cost {
        PathCost::Weighted(weights) => {
            let Weights { mut length, mut risk } = *weights;
            let row = NumberRow::new("Weight of length", &mut length).range(0.0..=1e6);
            let by_length = row.help("λ: what a unit of length costs without risk.").show(ui);
            let row = NumberRow::new("Weight of risk", &mut risk).range(0.0..=1e6);
            let by_risk = row.help("κ: what a unit of length costs more at risk 1.").show(ui);
            if by_length.changed() || by_risk.changed() {
                let cost = PathCost::Weighted(Weights { length, risk });
                commands.push(Command::Path(PathCommand::Cost(cost)));
            }
            end_gesture_when_released(&by_length, commands);
            end_gesture_when_released(&by_risk, commands);
        }
        PathCost::Formula(formula) => {
            ValueRow::new("Cost per length", formula.source()).help("The formula of x, y and risk.").show(ui);
        }
    }
    ui.add_space(4.0);
}

/// A share in percent, rounded up.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = if percent < 0.1 { 1000.0 } else { 100.0 };
    format!("{} %", (percent * digits).ceil() / digits)
}
