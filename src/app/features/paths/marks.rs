//! The paths of the document over the mesh, with their places.

use eframe::egui::{Align2, Color32, Pos2, Rect, Role, Sense, Stroke, WidgetInfo, vec2};

use super::colors::{ALTERNATIVE_COLOR, POINTED_COLOR, path_color};
use super::tool::{PathPlace, paint_place};
use super::work::FoundPath;
use super::{corridor_marks, keep_out_marks};
use crate::app::features::paths::Paths;
use meshbrush_core::path::Solution;
use meshbrush_kit::kit::marks::{paint_line, paint_line_preview, paint_rimmed_line};
use meshbrush_kit::kit::{FrameState, OverMesh};
use meshbrush_ui::theme::font;

/// Width of the path that is shown in the panel, in points.
const SELECTED_WIDTH: f32 = 4.0;
/// Width of other paths.
const WIDTH: f32 = 2.0;
/// Width of an alternative.
const THIN: f32 = 1.5;
/// Most letters of a name beside an end of a path.
const MOST_OF_NAME: usize = 24;
/// The colour of a path that is not up to date.
const OUTDATED: Color32 = Color32::from_gray(0xb0);

/// Draws the corridor, the regions that paths stay out of, and the paths.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    corridor_marks::paint(state, over);
    keep_out_marks::paint(state, over);
    paint_paths(state, over);
}

/// Draws all paths, the one that is shown in the panel last and heavier. Where there is none for a route as
/// it is, the last one is grey, and the places are joined by dashed lines.
fn paint_paths(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let plan = &state.session.document().settings().paths;
    let selected = state.feature::<Paths>().tool.route_in(plan);
    paint_others(state, over);
    let others = (0..plan.routes.len()).filter(|&number| Some(number) != selected);
    others.chain(selected).for_each(|number| paint_path(state, over, number));
}

fn paint_path(state: &FrameState<'_>, over: &OverMesh<'_>, number: usize) {
    let plan = &state.session.document().settings().paths;
    let tool = &state.feature::<Paths>().tool;
    let is_selected = tool.route_in(plan) == Some(number);
    let shown = state.feature::<Paths>().finder.shown().get(number);
    let found = shown.and_then(|shown| shown.found.as_ref());
    let problem = shown.and_then(|shown| shown.problem.as_ref());
    let color = path_color(number);
    if let Some(found) = found {
        let points = over.line(found.solution.points.iter().copied()).into_iter();
        let color = if problem.is_some() { OUTDATED } else { color };
        match is_selected {
            true => paint_rimmed_line(over.painter, points, color, SELECTED_WIDTH),
            false => _ = paint_line(over.painter, points, color, WIDTH),
        }
    }
    let places: Vec<_> = plan.routes[number].iter().map(|&place| (over.screen_from_world)(place)).collect();
    if problem.is_some() {
        places.windows(2).for_each(|ends| paint_line_preview(over.painter, ends[0], ends[1]));
    }
    if is_selected {
        paint_marked(state, over, found);
    }
    for (n, &at) in places.iter().enumerate() {
        let place = match n {
            0 => PathPlace::Start,
            n if n + 1 == places.len() => PathPlace::Goal,
            _ => PathPlace::Via,
        };
        paint_place(over, at, place, color, tool.selected_in(plan) == Some((number, n)));
    }
    for (end, at) in [("start", places.first()), ("goal", places.last())] {
        let name = shortened(plan.name(number));
        at.into_iter().for_each(|&at| label_end(over, at, &format!("{name}: {end}"), (number, end)));
    }
}

/// Writes what an end of a path is beside it, on a dark ground in either theme.
fn label_end(over: &OverMesh<'_>, at: Pos2, text: &str, of: (usize, &str)) {
    if !over.canvas.contains(at) {
        return;
    }
    let galley = over.painter.layout_no_wrap(text.to_owned(), font::caption(), Color32::WHITE);
    let size = galley.size() + vec2(10.0, 4.0);
    let is_right = at.x + 14.0 + size.x <= over.canvas.right();
    let (anchor, align) = match is_right {
        true => (at + vec2(14.0, 0.0), Align2::LEFT_CENTER),
        false => (at - vec2(14.0, 0.0), Align2::RIGHT_CENTER),
    };
    let place: Rect = align.anchor_size(anchor, size);
    let response = over.ui.interact(place, over.ui.scope_id().with(("end of a path", of)), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
    over.painter.rect_filled(place, 4.0, GROUND);
    over.painter.galley(place.min + vec2(5.0, 2.0), galley, Color32::WHITE);
}

/// The ground of a label: white on it has a contrast above 7 over any colour.
const GROUND: Color32 = Color32::from_black_alpha(215);

/// Returns a name with as many letters as a label has room for.
fn shortened(name: String) -> String {
    match name.chars().count() {
        ..=MOST_OF_NAME => name,
        _ => name.chars().take(MOST_OF_NAME - 1).chain(['…']).collect(),
    }
}

/// The alternatives, the path before its proof, and the path that is pointed at in their list or on the
/// front.
fn paint_others(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let line = |path: &Solution, color, width| {
        let points = over.line(path.points.iter().copied()).into_iter();
        paint_line(over.painter, points, color, width);
    };
    let alternatives = &state.feature::<Paths>().finder.alternatives;
    alternatives.paths().iter().for_each(|path| line(path, ALTERNATIVE_COLOR, THIN));
    let selected = state.feature::<Paths>().tool.route_in(&state.session.document().settings().paths);
    let shown = selected.and_then(|number| state.feature::<Paths>().finder.shown().get(number));
    let former = shown.and_then(|shown| shown.found.as_ref()?.former.as_deref());
    former.into_iter().for_each(|path| line(path, ALTERNATIVE_COLOR, THIN));
    let pointed = alternatives.pointed.and_then(|number| alternatives.paths().get(number));
    let of_front = state.feature::<Paths>().finder.front.pointed().map(|point| &point.solution);
    pointed.into_iter().chain(of_front).for_each(|path| line(path, POINTED_COLOR, WIDTH));
}

/// The place on a path that is pointed at in its profile.
fn paint_marked(state: &FrameState<'_>, over: &OverMesh<'_>, found: Option<&FoundPath>) {
    let (Some(found), Some(distance)) = (found, state.feature::<Paths>().tool.shown_distance) else { return };
    let nearest = found
        .profile
        .iter()
        .min_by(|a, b| (a.distance - distance).abs().total_cmp(&(b.distance - distance).abs()));
    if let Some(sample) = nearest {
        let at = (over.screen_from_world)(sample.point);
        over.painter.circle(at, 5.0, Color32::WHITE, Stroke::new(2.0, Color32::BLACK));
    }
}
