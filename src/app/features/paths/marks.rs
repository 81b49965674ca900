//! The paths of the document over the mesh, with their places.

use eframe::egui::{Color32, Stroke};

use super::tool::{ALTERNATIVE_COLOR, PATH_COLOR, POINTED_COLOR, PathPlace, paint_place};
use super::work::FoundPath;
use super::{corridor_marks, keep_out_marks};
use crate::app::kit::marks::{paint_line, paint_line_preview};
use crate::app::kit::{FrameState, OverMesh};
use meshbrush_core::path::Solution;

/// Width of a path, in points.
const WIDTH: f32 = 2.5;
/// Width of an alternative.
const THIN: f32 = 1.5;
/// The colour of a path that is not up to date.
const OUTDATED: Color32 = Color32::from_gray(0xb0);

/// Draws the corridor, the regions that paths stay out of, and the paths.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    corridor_marks::paint(state, over);
    keep_out_marks::paint(state, over);
    paint_paths(state, over);
}

/// Draws all paths. Where there is none for a route as it is, the last one is grey, and the places are joined
/// by dashed lines.
fn paint_paths(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let plan = &state.session.document().settings().paths;
    let selected = state.features.paths.tool.selected_in(plan);
    paint_others(state, over);
    for (number, route) in plan.routes.iter().enumerate() {
        let shown = state.features.paths.finder.shown().get(number);
        let problem = shown.and_then(|shown| shown.problem.as_ref());
        if let Some(found) = shown.and_then(|shown| shown.found.as_ref()) {
            let points = found.solution.points.iter().map(|&point| (over.screen_from_world)(point));
            let color = if problem.is_some() { OUTDATED } else { PATH_COLOR };
            paint_line(over.painter, points, color, WIDTH);
        }
        let places: Vec<_> = route.iter().map(|&place| (over.screen_from_world)(place)).collect();
        if problem.is_some() {
            places.windows(2).for_each(|ends| paint_line_preview(over.painter, ends[0], ends[1]));
        }
        if Some(number) == state.features.paths.tool.route_in(plan) {
            paint_marked(state, over, shown.and_then(|shown| shown.found.as_ref()));
        }
        for (n, &at) in places.iter().enumerate() {
            let place = match n {
                0 => PathPlace::Start,
                n if n + 1 == places.len() => PathPlace::Goal,
                _ => PathPlace::Via,
            };
            paint_place(over, at, place, selected == Some((number, n)));
        }
    }
}

/// The alternatives, and the path that is pointed at in their list or on the front.
fn paint_others(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let line = |path: &Solution, color, width| {
        let points = path.points.iter().map(|&point| (over.screen_from_world)(point));
        paint_line(over.painter, points, color, width);
    };
    let alternatives = &state.features.paths.finder.alternatives;
    alternatives.paths().iter().for_each(|path| line(path, ALTERNATIVE_COLOR, THIN));
    let pointed = alternatives.pointed.and_then(|number| alternatives.paths().get(number));
    let of_front = state.features.paths.finder.front.pointed().map(|point| &point.solution);
    pointed.into_iter().chain(of_front).for_each(|path| line(path, POINTED_COLOR, WIDTH));
}

/// The place on a path that is pointed at in its profile.
fn paint_marked(state: &FrameState<'_>, over: &OverMesh<'_>, found: Option<&FoundPath>) {
    let (Some(found), Some(distance)) = (found, state.features.paths.tool.shown_distance) else { return };
    let nearest = found
        .profile
        .iter()
        .min_by(|a, b| (a.distance - distance).abs().total_cmp(&(b.distance - distance).abs()));
    if let Some(sample) = nearest {
        let at = (over.screen_from_world)(sample.point);
        over.painter.circle(at, 5.0, Color32::WHITE, Stroke::new(2.0, Color32::BLACK));
    }
}
