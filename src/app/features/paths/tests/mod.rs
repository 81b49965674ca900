//! Paths: set with the tool, followed through edits, certified, and read in the panel.

mod corridor;
mod cost;
mod detail;
mod export;
mod keep_out;
mod names;
mod others;
mod truth;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::paths::Paths;
use crate::app::features::paths::work::ShownPath;
use crate::app::features::paths::{PATH, PathCommand};
use crate::app::tests::{
    TALL, Window, click, key, move_to, open_tab, press, release, send, set, settings, stroke, wait_until,
    window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{PathMesh, PathRequest, Planner};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand};

const START: DVec2 = dvec2(0.05, 0.1);
const GOAL: DVec2 = dvec2(0.95, 0.9);

fn shown(window: &Window) -> &[ShownPath] {
    window.state().paths().shown()
}

fn is_complete(window: &Window) -> bool {
    let paths = window.state().paths();
    paths.is_current(window.state().session()) && !paths.is_proving()
}

pub(super) fn wait_for_paths(window: &mut Window) {
    wait_until(window, is_complete);
}

/// Returns a window with the path tool and a complete path from [`START`] to [`GOAL`], on a coarse mesh. Its
/// bound is that of the solver: certificates take seconds.
fn window_with_path() -> Window {
    let mut window = window_of(TALL);
    set(&mut window, Setting::SmallestDiameter(0.03));
    send(&mut window, Command::from(PathCommand::Width(1.0)));
    key(&mut window, Modifiers::NONE, Key::P);
    assert_eq!(window.state().tools().tool, &PATH);
    click(&mut window, START, Modifiers::NONE);
    assert!(settings(&window).paths.routes.is_empty(), "a start alone is no path");
    click(&mut window, GOAL, Modifiers::NONE);
    wait_for_paths(&mut window);
    window
}

fn row(window: &Window, name: &str) -> String {
    window.get_by_role_and_label(Role::Definition, name).value().unwrap()
}

#[test]
fn two_clicks_make_a_path_whose_bound_is_proved() {
    let mut window = window_with_path();
    let places = &settings(&window).paths.routes[0];
    assert!(places[0].distance(START) < 0.01 && places[1].distance(GOAL) < 0.01, "{places:?}");
    let solution = &shown(&window)[0].found.as_ref().unwrap().solution;
    assert_eq!([solution.points[0], *solution.points.last().unwrap()], [places[0], places[1]]);
    assert!(solution.length >= places[0].distance(places[1]) && solution.cost >= solution.length);
    let before = solution.gap();
    assert!(before > 0.02 && before < 0.3, "{before}");
    assert!(row(&window, "Proved").contains("of optimal"), "{}", row(&window, "Proved"));
    assert!(window.query_by_label("Risk along the path").is_some());
    send(&mut window, Command::from(PathCommand::Width(before / 2.0)));
    wait_for_paths(&mut window);
    let after = shown(&window)[0].found.as_ref().unwrap().solution.gap();
    assert!(after <= before / 2.0, "{before} {after}");
}

#[test]
fn a_dragged_goal_and_painted_risk_move_the_path() {
    let mut window = window_with_path();
    let cost = |window: &Window| shown(window)[0].found.as_ref().unwrap().solution.cost;
    let before = cost(&window);
    press(&mut window, GOAL, Modifiers::NONE);
    move_to(&mut window, dvec2(0.6, 0.5));
    release(&mut window, dvec2(0.6, 0.5));
    wait_for_paths(&mut window);
    assert!(cost(&window) < before, "a nearer goal");
    send(&mut window, Command::from(EditCommand::Undo));
    wait_for_paths(&mut window);
    assert_eq!(cost(&window), before, "the drag was one gesture");
    key(&mut window, Modifiers::NONE, Key::B);
    stroke(&mut window, START + dvec2(0.05, -0.05), START + dvec2(-0.03, 0.1));
    wait_for_paths(&mut window);
    assert!(cost(&window) > before, "risk was painted across the path");
}

#[test]
fn a_stroke_that_changes_the_mesh_keeps_the_planner_and_gives_the_path_of_a_new_one() {
    let mut window = window_with_path();
    let moves = |window: &Window| window.state().paths().moves();
    let mesh = |window: &Window| window.state().session().follower().shared_mesh();
    let solution = |window: &Window| shown(window)[0].found.clone().unwrap().solution;
    key(&mut window, Modifiers::NONE, Key::B);
    for stroked in 1..=3 {
        let (before, x) = (mesh(&window).raw_triangle_count(), 0.2 * f64::from(stroked));
        stroke(&mut window, dvec2(x, 0.3), dvec2(x, 0.5));
        wait_for_paths(&mut window);
        assert_ne!(mesh(&window).raw_triangle_count(), before);
        assert_eq!(moves(&window), Some(stroked as usize));
        let settings = settings(&window).clone();
        let risk = RiskField::new(&settings.layers, window.state().session().document().paint())
            .within(&settings.domain.bounds);
        let density = settings.paths.cost.density(risk, &settings.domain).unwrap();
        let path_mesh = PathMesh::new(mesh(&window).view());
        let mut planner = Planner::new(path_mesh, &*density).unwrap();
        let fresh = planner.solve(&*density, &settings.paths.routes[0], PathRequest::FULL).unwrap();
        assert_eq!(solution(&window), fresh);
    }
}

#[test]
fn a_place_in_between_is_visited_and_deleted_again() {
    let mut window = window_with_path();
    click(&mut window, dvec2(0.1, 0.9), Modifiers::COMMAND);
    let places = settings(&window).paths.routes[0].clone();
    assert_eq!(places.len(), 3);
    wait_for_paths(&mut window);
    let solution = &shown(&window)[0].found.as_ref().unwrap().solution;
    assert_eq!(solution.points[solution.stops[1]], places[1]);
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!(settings(&window).paths.routes[0].len(), 2);
    send(&mut window, Command::from(PathCommand::Swap));
    assert_eq!(settings(&window).paths.routes[0], [places[2], places[0]]);
}

#[test]
fn an_impossible_goal_keeps_the_last_path_and_says_why() {
    let mut window = window_with_path();
    let before = shown(&window)[0].found.clone().unwrap().solution;
    press(&mut window, GOAL, Modifiers::NONE);
    move_to(&mut window, dvec2(0.9, 1.05));
    release(&mut window, dvec2(0.9, 1.05));
    wait_until(&mut window, |window| window.state().paths().shown()[0].problem.is_some());
    assert_eq!(shown(&window)[0].found.as_ref().unwrap().solution.points[0], before.points[0]);
    let problem = shown(&window)[0].problem.clone().unwrap().to_string();
    assert!(problem.starts_with("The goal ") && problem.contains("outside the domain"), "{problem}");
    assert!(window.query_by_label_contains("The path that is shown is outdated.").is_some());
}

#[test]
fn escape_forgets_a_start_without_a_goal() {
    let mut window = window_of(TALL);
    key(&mut window, Modifiers::NONE, Key::P);
    click(&mut window, START, Modifiers::NONE);
    assert!(window.state().features().get::<Paths>().tool.pending.is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.state().features().get::<Paths>().tool.pending.is_none());
}

#[test]
fn an_idle_window_with_a_certified_path_does_no_work() {
    let mut window = window_with_path();
    window.run_steps(3);
    let revision = window.state().session().document().revision();
    window.run();
    assert!(is_complete(&window));
    assert_eq!(window.state().session().document().revision(), revision);
}

#[test]
fn the_example_opens_with_its_path() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(PathCommand::Width(1.0)));
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Path)));
    wait_for_paths(&mut window);
    let solution = &shown(&window)[0].found.as_ref().unwrap().solution;
    assert!((146.0..147.5).contains(&solution.cost) && solution.highest_risk < 0.1, "{}", solution.cost);
    open_tab(&mut window, Tab::Paths);
    assert!(window.query_by_label("Risk along the path").is_some());
}

#[test]
fn a_place_in_between_comes_where_it_makes_the_way_longer_by_the_least() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(PathCommand::StartAt(dvec2(0.1, 0.5))));
    send(&mut window, Command::from(PathCommand::GoalAt(dvec2(0.9, 0.5))));
    let xs = |window: &Window| -> Vec<f64> {
        settings(window).paths.routes[0].iter().map(|place| place.x).collect()
    };
    for (x, expected) in [
        (0.5, vec![0.1, 0.5, 0.9]),
        (0.7, vec![0.1, 0.5, 0.7, 0.9]),
        (0.3, vec![0.1, 0.3, 0.5, 0.7, 0.9]),
        (0.2, vec![0.1, 0.2, 0.3, 0.5, 0.7, 0.9]),
    ] {
        send(&mut window, Command::from(PathCommand::ViaAt(dvec2(x, 0.52))));
        assert_eq!(xs(&window), expected);
    }
}
