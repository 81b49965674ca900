//! How good the triangles are: the panel, and the ways from it.

use eframe::egui::accesskit::Role;
use eframe::egui::vec2;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::DVec2;

use super::figures::{figures, row, wait_for_figures};
use crate::app::features::statistics::{Statistics, StatisticsCommand};
use crate::app::tests::{
    TALL, Window, click_button, open_section, send, set, triangles, wait_for_jobs, wait_until, window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::quality::QualityMeasure;
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::view::FieldOverlay;

fn open(window: &mut Window, example: Example) {
    send(window, Command::from(FileCommand::OpenExample(example)));
    wait_for_jobs(window);
    if example == Example::CelticSea {
        // A coarse sea is measured soon.
        set(window, Setting::SmallestDiameter(15_000.0));
        wait_for_jobs(window);
    }
    wait_until(window, |window| {
        let session = window.state().session();
        let is_fitted = session.document().settings().domain.region().is_some();
        !is_fitted || session.derived().is_some()
    });
    open_section(window, "Quality");
    wait_for_figures(window);
}

/// Returns the bars of a histogram: class and count.
fn bars(window: &Window, name: &str) -> Vec<(String, usize)> {
    let rows = window.query_all_by_role(Role::ListItem).filter_map(|node| node.accesskit_node().label());
    let parts = rows.filter_map(|label| {
        let (class, count) = label.strip_prefix(name)?.rsplit_once(": ")?;
        let count: String = count.chars().filter(char::is_ascii_digit).collect();
        Some((class.trim().to_owned(), count.parse().ok()?))
    });
    parts.collect()
}

fn middle(window: &Window) -> DVec2 {
    window.state().view().camera.unwrap().visible_world().center()
}

#[test]
fn a_plain_mesh_has_half_squares_only() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Quality");
    wait_for_figures(&mut window);
    assert_eq!([row(&window, "Smallest angle"), row(&window, "Largest angle")], ["45°", "90°"]);
    assert_eq!(row(&window, "Edge ratio"), "1.41");
    assert_eq!(row(&window, "Triangles at a node"), "8");
    assert_eq!(row(&window, "Time step"), "no layer of depths");
    let count = triangles(&window);
    assert_eq!(bars(&window, "Smallest angle"), [("45° to 50°".to_owned(), count)]);
    assert_eq!(bars(&window, "Largest angle"), [("90° to 95°".to_owned(), count)]);
    assert_eq!(bars(&window, "Longest edge / h̄").iter().map(|(_, count)| count).sum::<usize>(), count);
    let nodes: usize = bars(&window, "Triangles at a node").iter().map(|(_, count)| count).sum();
    assert_eq!(nodes, window.state().session().mesh().extract().nodes().len());
    set(&mut window, Setting::SmallestDiameter(0.01));
    wait_for_figures(&mut window);
    assert_eq!(bars(&window, "Smallest angle"), [("45° to 50°".to_owned(), triangles(&window))]);
}

#[test]
fn the_worst_triangle_on_a_coast_is_gone_to_and_explained() {
    let mut window = window_of(TALL);
    open(&mut window, Example::Aegean);
    let worst = {
        let (measured, _) = figures(&window).unwrap();
        *measured.quality.get(QualityMeasure::SmallestAngle).unwrap().worst()
    };
    assert!(worst.value < 44.0, "nodes on the outline are measured: {worst:?}");
    click_button(&mut window, "Smallest angle");
    assert!(middle(&window).distance(worst.at) < worst.size, "{} {worst:?}", middle(&window));
    // A bar leads to the worst of its class.
    let bar = window.query_all_by_role(Role::ListItem).find(|node| {
        node.accesskit_node().label().is_some_and(|label| label.starts_with("Smallest angle 45° to 50°"))
    });
    bar.expect("most triangles have 45°").click();
    window.run();
    assert!(middle(&window).distance(worst.at) > worst.size);
    click_button(&mut window, "Why: Smallest angle");
    wait_for_jobs(&mut window);
    let app = window.state();
    assert!(middle(&window).distance(worst.at) < worst.size);
    assert_eq!(app.view().dock.tab(), Tab::Inspect);
    assert!(app.session().queried_triangle().is_some());
    assert!(window.query_by_label("Why this triangle").is_some());
    assert!(window.query_by_label("State").is_some(), "the triangle is explained");
}

#[test]
fn time_steps_follow_the_courant_number_of_the_person() {
    let mut window = window_of(TALL);
    open(&mut window, Example::CelticSea);
    let least = {
        let (measured, _) = figures(&window).unwrap();
        measured.quality.get(QualityMeasure::TimeStep).expect("it has depths").least
    };
    let shown = |seconds: f64| meshbrush_ui::widgets::format::time(seconds);
    assert_eq!(row(&window, "Time step"), shown(least.value));
    let before: Vec<usize> = bars(&window, "Time step").into_iter().map(|(_, count)| count).collect();
    send(&mut window, Command::from(StatisticsCommand::SetCourant(0.5)));
    window.run();
    assert_eq!(row(&window, "Time step"), shown(0.5 * least.value));
    let after = bars(&window, "Time step");
    assert!(after[0].0.starts_with(&shown(0.5 * least.value)), "{after:?}");
    assert_eq!(after.into_iter().map(|(_, count)| count).collect::<Vec<_>>(), before);
    // Another document has the number of the person, too, and numbers that are none change nothing.
    send(&mut window, Command::from(FileCommand::OpenExample(Example::ALL[0])));
    send(&mut window, Command::from(StatisticsCommand::SetCourant(f64::NAN)));
    assert_eq!(window.state().features().get::<Statistics>().courant(), 0.5);
}

#[test]
fn a_measure_is_shown_as_an_overlay_and_hidden_again() {
    let mut window = window_of(vec2(TALL.x, 1.3 * TALL.y));
    open(&mut window, Example::CelticSea);
    for measure in QualityMeasure::ALL {
        let overlay = FieldOverlay::of_measure(measure);
        let button = format!("{} as overlay", overlay.name());
        click_button(&mut window, &button);
        wait_for_jobs(&mut window);
        assert_eq!(window.state().view().overlay, overlay);
        assert!(window.query_by_label_contains("Legend: ").is_some(), "{overlay:?}");
        click_button(&mut window, &button);
        assert_eq!(window.state().view().overlay, FieldOverlay::None);
    }
}
