//! The figures of the report, opened from the menu.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

use crate::app::features::plots::Plots;
use crate::app::features::plots::PlotsCommand;
use crate::app::features::report::FigureCommand;
use crate::app::tests::{
    FREE, TALL, Window, canvas, choose, fingerprint, key, on_screen, paint, send, settings, tips, triangles,
    wait_until, window_of,
};
use meshbrush_kit::kit::command::Command;
use meshbrush_study::report::ReportFigure;
use meshbrush_study::steps::StepPlayer;

fn open(window: &mut Window, figure: ReportFigure) {
    choose(window, "Method", &format!("The report, {}", figure.name()));
    assert_eq!(settings(window).name, figure.name());
    assert!(window.query_by_label(figure.text()).is_some(), "what the report shows");
}

fn opened(figure: ReportFigure) -> Window {
    let mut window = window_of(TALL);
    open(&mut window, figure);
    window
}

fn has(window: &Window, text: &str) -> bool {
    window.query_all_by_label(text).next().is_some()
}

fn player(window: &Window) -> Option<&StepPlayer> {
    window.state().stepping()?.player()
}

#[test]
fn figure_1_is_the_mesh_with_the_triangles_of_the_report() {
    let window = opened(ReportFigure::Mesh);
    assert_eq!(triangles(&window), 9_560);
    assert_eq!(window.query_all_by_label("9,560").count(), 2, "the report's and ours");
}

#[test]
fn figure_2_is_the_coarse_triangulation_with_its_numbers() {
    let mut window = opened(ReportFigure::CoarseGrid);
    wait_until(&mut window, |window| player(window).is_some());
    assert_eq!(player(&window).unwrap().position(), 0);
    assert!(has(&window, "(N_e + 1)² = 25") && has(&window, "25") && has(&window, "2 N_e² = 32"));
}

#[test]
fn figures_3_and_4_stand_at_their_steps() {
    for figure in [ReportFigure::Descendants, ReportFigure::Neighbours] {
        let mut window = opened(figure);
        wait_until(&mut window, |window| player(window).is_some());
        let shown = player(&window).unwrap();
        assert!(shown.step().is_some_and(|step| figure.shows(step)), "{figure:?}");
        for row in figure.compare_step(shown) {
            assert!(has(&window, &row.report) && has(&window, &row.ours), "{row:?}");
        }
        assert_eq!(tips::unexplained(&window), [""; 0], "{figure:?}");
        key(&mut window, Modifiers::NONE, Key::ArrowRight);
        assert!(window.query_by_label_contains("This is another step").is_some());
    }
}

#[test]
fn figure_5_is_measured_at_once_and_shows_the_gradient() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(PlotsCommand::SetUp { last_level: 6, runs: 1 }));
    open(&mut window, ReportFigure::Times);
    wait_until(&mut window, |window| !window.state().features().get::<Plots>().is_measuring());
    assert!(window.query_by_role_and_label(Role::Image, "Figure 5 of the report").is_some());
    assert!(has(&window, "1.01") && has(&window, "Gradient"));
}

#[test]
fn figure_6_shows_the_walk_to_a_queried_point() {
    let mut window = opened(ReportFigure::Orientation);
    let shown = canvas(&window);
    let queried = window.state().session().queried().expect("a point is queried");
    assert!(window.state().view().aids.walk);
    let path = window.state().session().mesh().walk_path(queried);
    assert!(path.len() > 5);
    for id in path {
        let corners = window.state().session().view().world_corners(id);
        let corners = corners.map(|corner| on_screen(&window, corner));
        assert!(corners.iter().all(|&corner| shown.contains(corner)), "the walk is in view: {corners:?}");
        assert!(corners[0].distance(corners[1]) > 40.0, "and large enough: {corners:?}");
    }
    assert!(has(&window, "Steps of the walk") && has(&window, "at most 2^5 = 32"));
    assert_eq!(tips::unexplained(&window), [""; 0]);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_label_contains("Query a point").is_some());
}

#[test]
fn the_experiment_is_made_beside_the_triangles_of_the_report() {
    let mut window = opened(ReportFigure::Experiment);
    wait_until(&mut window, |window| window.state().features().get::<Plots>().experiment().meshes.len() >= 5);
    window.get_by_role_and_label(Role::Button, "Cancel measuring").click();
    window.run();
    assert!(has(&window, "Level 5") && has(&window, "9,560"));
    assert!(window.query_by_label_contains("9,560 in ").is_some());
    assert_eq!(tips::unexplained(&window), [""; 0]);
    window.get_by_role_and_label(Role::Button, "Copy the comparison").click();
    window.run();
    assert_eq!(crate::app::tests::notice(&window), "Copied: the figure with its numbers.");
}

#[test]
fn a_figure_is_closed_or_ends_with_its_document() {
    let mut window = opened(ReportFigure::Mesh);
    let mesh = fingerprint(&window);
    window.get_by_role_and_label(Role::Button, "Close the figure").click();
    window.run();
    assert!(!has(&window, ReportFigure::Mesh.text()));
    assert_eq!(fingerprint(&window), mesh, "the document stays");
    open(&mut window, ReportFigure::Orientation);
    choose(&mut window, "Examples", "Radar threats");
    assert!(!has(&window, ReportFigure::Orientation.text()));
}

#[test]
fn edits_are_asked_about_before_a_figure_opens() {
    let mut window = window_of(TALL);
    paint(&mut window, FREE.x);
    send(&mut window, Command::from(FigureCommand::Open(ReportFigure::Mesh)));
    assert_ne!(settings(&window).name, ReportFigure::Mesh.name());
    assert!(window.query_by_role_and_label(Role::Button, "Do not save").is_some());
    assert!(canvas(&window).width() > 0.0);
}
