//! The path tool: sets the start and the goal of paths and the places in between, and moves them.

use eframe::egui::{Color32, CursorIcon, Key, Pos2, Stroke};
use glam::DVec2;

use super::colors::path_color;
use super::{PATH_OPTIONS, PathCommand};
use crate::app::features::paths::Paths;
use meshbrush_core::document::PathPlan;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, OverMesh, SettingsDrag, Tab, ToolSpec};
use meshbrush_ui::widgets::Hint::{self, Key as HintKey, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Edits the places of paths.
pub static PATH: ToolSpec = ToolSpec {
    place: 4,
    cursor: CursorIcon::Crosshair,
    tab: Some(Tab::Paths),
    options: &PATH_OPTIONS,
    hint: |state| if state.feature::<Paths>().tool.pending.is_some() { GOAL_HINT } else { HINT },
    paint,
    press: |press, pointer, commands| {
        let at = pointer.world(press.at);
        let reach = REACH_POINTS * pointer.px_per_point / pointer.camera.px_per_world();
        let is_between = press.modifiers.command;
        commands.push(Command::from(PathCommand::Press { at, reach, is_between }));
        Some(Box::new(SettingsDrag::new(press.at, |to| Command::from(PathCommand::DragTo(to)))))
    },
    menu: |state, point| {
        let plan = &state.session.document().settings().paths;
        let goal =
            state.feature::<Paths>().tool.pending.map(|_| ("Path to here", PathCommand::GoalAt(point)));
        let via =
            (!plan.routes.is_empty()).then_some(("Lead the path through here", PathCommand::ViaAt(point)));
        let selected = state.feature::<Paths>().tool.selected_in(plan);
        let delete = selected.map(|_| ("Delete the selected place", PathCommand::Delete));
        let entries = [Some(("Path from here", PathCommand::StartAt(point))), goal, via, delete];
        entries.into_iter().flatten().map(|(title, command)| (title, Command::from(command))).collect()
    },
    ..ToolSpec::new("Path", Key::P, Icon::PATH)
};

const HINT: &[Hint] = &[
    Text("Click the start of a path, then its goal; drag them"),
    HintKey("Ctrl+click"),
    Text("a place in between"),
    KeyOf("delete-the-selected-place-of-a-path"),
    Text("deletes it"),
];
const GOAL_HINT: &[Hint] =
    &[Text("Click the goal of the path"), KeyOf("cancel-or-deselect"), Text("no path")];

/// How far from a place a press still takes hold of it, in points.
const REACH_POINTS: f64 = 10.0;

/// The state of the path tool.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathTool {
    /// The selected place: the number of its route and its number there, from 0.
    pub selected: Option<(usize, usize)>,
    /// The start of a path that has no goal yet, in world units.
    pub pending: Option<DVec2>,
    /// The offset of the place that is dragged from the pointer, in world units.
    pub grip: Option<DVec2>,
    /// The distance from the start of the place that is marked, in world units.
    pub shown_distance: Option<f64>,
    /// How far points that files leave out are from the path, in world units; 0 leaves out none.
    pub export_tolerance: f64,
    /// The speed for the time of the path, in knots; 0 asks for no time.
    pub speed: f64,
}

impl PathTool {
    /// Returns the selected place. An undo can have removed it.
    pub fn selected_in(&self, plan: &PathPlan) -> Option<(usize, usize)> {
        self.selected
            .filter(|&(route, place)| plan.routes.get(route).is_some_and(|route| place < route.len()))
    }

    /// Returns the number of the route that is shown in the panel: that of the selected place, or else the
    /// first.
    pub fn route_in(&self, plan: &PathPlan) -> Option<usize> {
        let first = (!plan.routes.is_empty()).then_some(0);
        self.selected_in(plan).map(|(route, _)| route).or(first)
    }
}

/// Draws the start without a goal. Paths with their places are drawn with every tool.
fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let Some(pending) = state.feature::<Paths>().tool.pending else { return };
    let at = (over.screen_from_world)(pending);
    if let Some(pointer) = over.pointer {
        let ends = [at, pointer];
        over.painter.line_segment(ends, Stroke::new(3.0, Color32::from_black_alpha(150)));
        over.painter.line_segment(ends, Stroke::new(1.2, Color32::WHITE));
    }
    let number = state.session.document().settings().paths.routes.len();
    paint_place(over, at, PathPlace::Start, path_color(number), true);
}

/// The role of a point of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathPlace {
    /// Its start: a disc.
    Start,
    /// A place in between: a small disc.
    Via,
    /// Its goal: a ring around a disc.
    Goal,
}

/// Draws a place of a path in the colour of the path.
pub fn paint_place(over: &OverMesh<'_>, at: Pos2, place: PathPlace, color: Color32, is_selected: bool) {
    let radius = if place == PathPlace::Via { 4.5 } else { 6.0 };
    let rim = Stroke::new(if is_selected { 2.2 } else { 1.2 }, Color32::WHITE);
    over.painter.circle_filled(at, radius + 2.5, Color32::from_black_alpha(200));
    match place {
        PathPlace::Goal => {
            over.painter.circle(at, radius, Color32::BLACK, rim);
            over.painter.circle_filled(at, radius - 2.6, color);
        }
        _ => _ = over.painter.circle(at, radius, color, rim),
    }
}
