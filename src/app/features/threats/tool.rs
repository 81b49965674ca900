//! The threats tool: places threats of the selected layer, moves them and changes their ranges.

use eframe::egui::{Color32, CursorIcon, Key, Pos2, Rect, Stroke};
use glam::DVec2;

use super::options::THREAT_OPTIONS;
use super::{ThreatGrip, threats_layer};
use crate::app::features::threats::{ThreatEditor, ThreatsCommand};
use meshbrush_core::layers::Threat;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, OverMesh, SettingsDrag, ToolSpec, nearest_within};
use meshbrush_ui::widgets::Hint::{self, Key as HintKey, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Edits the threats of the selected layer.
pub static THREATS: ToolSpec = ToolSpec {
    place: 3,
    cursor: CursorIcon::Crosshair,
    hint: |_| HINT,
    options: &THREAT_OPTIONS,
    paint,
    press: |press, pointer, commands| {
        let at = pointer.world(press.at);
        let reach = pointer.grip_reach();
        let places = press.modifiers.command;
        commands.push(Command::from(ThreatsCommand::Press { at, reach, places }));
        Some(Box::new(SettingsDrag::new(press.at, |at| Command::from(ThreatsCommand::DragTo(at)))))
    },
    menu: |state, point| {
        let place = Command::from(ThreatsCommand::Place(point));
        let delete = Command::from(ThreatsCommand::Delete);
        let selected = state.feature::<ThreatEditor>().selected_in(state.session.document());
        let mut entries = vec![("Place a threat here", place)];
        entries.extend(selected.map(|_| ("Delete the selected threat", delete)));
        entries
    },
    ..ToolSpec::new("Threats", Key::K, Icon::THREATS)
};

const HINT: &[Hint] = &[
    Text("Click to place a threat, drag its middle or its ring"),
    HintKey("Ctrl+click"),
    Text("always places one"),
    KeyOf("delete-the-selected-threat"),
    Text("deletes it"),
];

/// The most threats whose middles and rings are drawn, besides the selected one: more would hide the mesh.
const MOST_DRAWN: usize = 2_000;

/// The threat that a press at `at` takes hold of, and what of it: the nearest middle within `reach`, or else
/// the nearest ring. All lengths are in world units.
pub(super) fn grip_at(threats: &[Threat], at: DVec2, reach: f64) -> Option<(usize, ThreatGrip)> {
    let from_middles = threats.iter().map(|threat| threat.at.distance(at));
    let from_rings = threats.iter().map(|threat| (threat.at.distance(at) - threat.range).abs());
    let middle = nearest_within(from_middles, reach);
    let middle = middle.map(|number| (number, ThreatGrip::Middle(threats[number].at - at)));
    let ring = || nearest_within(from_rings, reach);
    middle.or_else(|| Some((ring()?, ThreatGrip::Ring)))
}

/// Draws the middles and the rings of the threats in view, the selected one last and wider.
fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let Some((_, threats)) = threats_layer(state.session.document()) else { return };
    let selected = state.feature::<ThreatEditor>().selected_in(state.session.document());
    let others = threats.list().iter().enumerate().filter(|&(number, _)| Some(number) != selected);
    let circles = others.map(|(_, threat)| circle(threat, over));
    let visible = circles.filter(|&(at, radius)| is_in_view(at, radius, over.painter.clip_rect()));
    for (at, radius) in visible.take(MOST_DRAWN) {
        paint_threat(over, at, radius, 1.2);
    }
    if let Some(number) = selected {
        let (at, radius) = circle(&threats.list()[number], over);
        paint_threat(over, at, radius, 2.5);
    }
}

/// Returns the middle of a threat and the radius of its ring, in points.
fn circle(threat: &Threat, over: &OverMesh<'_>) -> (Pos2, f32) {
    let at = (over.screen_from_world)(threat.at);
    (at, at.distance((over.screen_from_world)(threat.at + DVec2::new(threat.range, 0.0))))
}

/// Returns whether the middle or a part of the ring may be in a view.
fn is_in_view(at: Pos2, radius: f32, view: Rect) -> bool {
    let corners = [view.left_top(), view.right_top(), view.left_bottom(), view.right_bottom()];
    let is_around_view = corners.iter().all(|corner| corner.distance(at) < radius);
    view.contains(at) || (view.distance_to_pos(at) <= radius && !is_around_view)
}

fn paint_threat(over: &OverMesh<'_>, at: Pos2, radius: f32, width: f32) {
    for (width, color) in [(width + 2.0, Color32::from_black_alpha(130)), (width, Color32::WHITE)] {
        over.painter.circle_stroke(at, radius, Stroke::new(width, color));
    }
    over.painter.circle(at, 2.5 + width, Color32::WHITE, Stroke::new(1.5, Color32::from_black_alpha(200)));
}
