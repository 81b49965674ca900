//! Cutting the domain.

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::domain::{DomainCommand, DomainToolMode};
use crate::app::tests::{
    FREE, TALL, Window, area, click, entries, fingerprint, key, level_at, move_to, notice, open_section,
    open_tab, press, release, scratch, send, set, settings, show, stroke, value_of, wait_for_notice,
    wait_until, window, window_of,
};
use meshbrush_core::document::{Example, Setting, Settings};
use meshbrush_core::domain::{CutShape, Domain};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Location;

/// Chooses a shape in the list of the strip.
fn cut_with(window: &mut Window, shape: &str) {
    window.get_by_role_and_label(Role::ComboBox, "Cut with").click();
    window.run();
    window.get_all_by_role_and_label(Role::Button, shape).last().unwrap().click();
    window.run();
}

#[test]
fn circle_and_lasso_cut_and_a_fill_adds_what_they_left() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::D);
    cut_with(&mut window, "Circle");
    stroke(&mut window, dvec2(0.5, 0.5), dvec2(0.7, 0.5));
    let disc = std::f64::consts::PI * 0.04;
    assert!((area(&window) - (1.0 - disc)).abs() < 0.002, "{}", area(&window));
    cut_with(&mut window, "Lasso");
    let corners = [dvec2(0.1, 0.1), dvec2(0.2, 0.1), dvec2(0.2, 0.2), dvec2(0.1, 0.2)];
    press(&mut window, corners[0], Modifiers::NONE);
    corners[1..].iter().for_each(|&corner| move_to(&mut window, corner));
    release(&mut window, corners[3]);
    assert!((area(&window) - (1.0 - disc - 0.01)).abs() < 0.002, "{}", area(&window));
    assert_eq!(entries(&window), 2);
    cut_with(&mut window, "Fill");
    click(&mut window, dvec2(0.5, 0.5), Modifiers::ALT);
    assert!((area(&window) - 0.99).abs() < 1e-3, "Alt adds: {}", area(&window));
    assert_eq!(entries(&window), 3);
    click(&mut window, dvec2(0.5, 0.5), Modifiers::ALT);
    assert_eq!(entries(&window), 3, "there is no hole any more");
    assert!(notice(&window).contains("in no hole"), "{}", notice(&window));
}

#[test]
fn a_frame_drawn_with_the_domain_tool_becomes_the_domain() {
    let mut window = window();
    let before = fingerprint(&window);
    key(&mut window, Modifiers::NONE, Key::D);
    cut_with(&mut window, "Frame");
    stroke(&mut window, dvec2(-0.05, 0.25), dvec2(0.5, 0.8));
    let bounds = settings(&window).domain.bounds;
    assert!(bounds.min.distance(dvec2(-0.05, 0.25)) < 0.003, "{bounds:?}");
    assert!(bounds.max.distance(dvec2(0.5, 0.8)) < 0.003, "{bounds:?}");
    assert_eq!(entries(&window), 1);
    assert!(level_at(&window, dvec2(0.24, 0.76)) > 5, "paint stays where it was");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
    click(&mut window, FREE, Modifiers::NONE);
    assert_eq!((fingerprint(&window), entries(&window)), (before, 0), "a click is no rectangle");
    press(&mut window, FREE, Modifiers::NONE);
    move_to(&mut window, FREE - dvec2(0.3, 0.3));
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, FREE - dvec2(0.3, 0.3));
    assert_eq!(fingerprint(&window), before, "Escape gives it up");
}

#[test]
fn the_domain_is_cut_with_brush_rectangle_and_polygon_and_each_is_one_entry() {
    let mut window = window();
    let before = fingerprint(&window);
    key(&mut window, Modifiers::NONE, Key::D);
    let radius = window.state().tools().radius;
    stroke(&mut window, dvec2(0.3, 0.6), dvec2(0.6, 0.6));
    let cut = std::f64::consts::PI * radius * radius + 0.6 * radius;
    assert!((area(&window) - (1.0 - cut)).abs() < 0.005, "{} {cut}", area(&window));
    assert_eq!(entries(&window), 1);
    assert_eq!(window.state().session().derived().unwrap().topology.holes, 1);
    assert_eq!(window.state().session().mesh().locate(dvec2(0.45, 0.6)), Location::OutsideDomain);
    let brushed = fingerprint(&window);

    cut_with(&mut window, "Rectangle");
    let whole = area(&window);
    stroke(&mut window, dvec2(0.7, 0.1), dvec2(0.9, 0.3));
    assert!((area(&window) - (whole - 0.04)).abs() < 0.004, "{}", area(&window));
    assert_eq!(entries(&window), 2);

    cut_with(&mut window, "Polygon");
    window.get_by_role_and_label(Role::RadioButton, "Add").click();
    window.run();
    let smaller = area(&window);
    for corner in [dvec2(0.65, 0.05), dvec2(0.95, 0.05), dvec2(0.65, 0.35)] {
        click(&mut window, corner, Modifiers::NONE);
    }
    assert_eq!(entries(&window), 2, "a polygon that is not closed cuts nothing");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!((area(&window) - (smaller + 0.02)).abs() < 0.004, "half of the square is back");
    assert_eq!(entries(&window), 3);

    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), brushed);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
    assert_eq!(window.state().session().mesh().violations(), []);
}

/// Returns a window on a round island with so many corners that a cut takes many frames, with the domain tool
/// in hand.
fn window_on_a_long_coast() -> Window {
    const CORNERS: u32 = 120_000;
    let corner = |k: u32| {
        let angle = f64::from(k) / f64::from(CORNERS) * std::f64::consts::TAU;
        (0.4 + 0.01 * (99.0 * angle).sin()) * dvec2(angle.cos(), angle.sin())
    };
    let coast = Domain::of_polygons(&[vec![(0..CORNERS).map(corner).collect()]]).unwrap();
    let mut window = window();
    send(&mut window, show(Settings::for_domain("coast".into(), coast)));
    key(&mut window, Modifiers::NONE, Key::D);
    window
}

/// Cuts along a line, and does not wait for it.
fn begin_to_cut(window: &mut Window, path: &[DVec2]) {
    let cut_shape = CutShape::Stroke { path: path.to_vec(), radius: 0.05 };
    window.state_mut().send(Command::from(DomainCommand::Reshape(cut_shape, false)));
    window.step();
}

#[test]
fn a_long_coast_is_cut_while_the_window_goes_on() {
    let mut window = window_on_a_long_coast();
    let (before, whole, entries_before) = (fingerprint(&window), area(&window), entries(&window));
    let [a, b, c] = [dvec2(-0.2, 0.0), DVec2::ZERO, dvec2(0.2, 0.0)];
    begin_to_cut(&mut window, &[a]);
    assert!(window.state().is_cutting(), "a frame does not wait for it");
    begin_to_cut(&mut window, &[a, b]);
    begin_to_cut(&mut window, &[b, c]);
    send(&mut window, Command::from(EditCommand::EndGesture));
    assert!(!window.state().is_cutting());
    let swept = 0.4 * 0.1 + std::f64::consts::PI * 0.05 * 0.05;
    assert!((whole - area(&window) - swept).abs() < 0.002, "{}", whole - area(&window));
    assert_eq!(entries(&window), entries_before + 1, "one gesture");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
}

#[test]
fn a_cut_under_way_is_given_up_by_undo_by_escape_and_by_another_domain() {
    let mut window = window_on_a_long_coast();
    let (before, entries_before) = (fingerprint(&window), entries(&window));
    let give_up: [fn(&mut Window); 3] = [
        |window| key(window, Modifiers::COMMAND, Key::Z),
        |window| key(window, Modifiers::NONE, Key::Escape),
        |window| {
            window.state_mut().execute(Command::from(EditCommand::CancelUpdate), &egui::Context::default())
        },
    ];
    for give_up in give_up {
        begin_to_cut(&mut window, &[DVec2::ZERO]);
        assert!(window.state().is_cutting());
        give_up(&mut window);
        assert!(!window.state().is_cutting());
        window.run();
        assert_eq!((fingerprint(&window), entries(&window)), (before, entries_before));
    }
    // Half of a stroke is cut, and the brush lifted: what is left is given up, and the half is an entry of
    // its own.
    begin_to_cut(&mut window, &[DVec2::ZERO]);
    window.run();
    assert!(window.state().session().document().is_in_gesture());
    begin_to_cut(&mut window, &[DVec2::ZERO, dvec2(0.1, 0.0)]);
    window.state_mut().execute(Command::from(EditCommand::EndGesture), &egui::Context::default());
    window.state_mut().execute(Command::from(EditCommand::CancelUpdate), &egui::Context::default());
    assert!(!window.state().session().document().is_in_gesture(), "the journal would wait for its end");
    assert_eq!(entries(&window), entries_before + 1);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((fingerprint(&window), entries(&window)), (before, entries_before));

    press(&mut window, DVec2::ZERO, Modifiers::NONE);
    move_to(&mut window, dvec2(0.1, 0.0));
    assert_ne!(fingerprint(&window), before);
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, dvec2(0.1, 0.0));
    assert_eq!(
        (fingerprint(&window), entries(&window)),
        (before, entries_before),
        "nor is half a stroke left"
    );

    begin_to_cut(&mut window, &[DVec2::ZERO]);
    let bounds = settings(&window).domain.bounds;
    set(&mut window, Setting::Domain(Domain::rectangle(bounds)));
    window.run();
    assert!(!window.state().is_cutting() && settings(&window).domain.region().is_none());
}

/// Waits until the mesh is derived and compared with the outline.
fn wait_for_quality(window: &mut Window) {
    wait_until(window, |window| {
        let derived = window.state().session().derived();
        derived.is_some_and(|derived| derived.quality.is_some())
    });
}

#[test]
fn the_outline_is_met_in_three_ways_and_the_panel_says_how_well() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    key(&mut window, Modifiers::NONE, Key::D);
    open_section(&mut window, "Fit to outline");
    wait_for_quality(&mut window);
    let (mesh, shown) = (fingerprint(&window), window.state().session().triangle_count());
    let rows = |window: &Window| {
        ["Parts", "Holes", "Misclassified", "Length"].map(|row| value_of(window, Role::Definition, row))
    };
    assert_eq!(rows(&window), ["1 (outline 1)", "81 (outline 65)", "0.22 %", "× 0.94"]);
    assert_eq!(value_of(&window, Role::Button, "Islands kept"), "64 of 65");
    assert!(value_of(&window, Role::Definition, "Nodes on outline").starts_with("8,"));

    open_tab(&mut window, Tab::Domain);
    window.get_by_role_and_label(Role::RadioButton, "Fitted").click();
    open_tab(&mut window, Tab::Mesh);
    wait_for_quality(&mut window);
    assert_eq!(fingerprint(&window), mesh, "the mesh under it is the same");
    assert_ne!(window.state().session().triangle_count(), shown);
    assert_eq!(value_of(&window, Role::Definition, "Angles"), "45.0° to 90.0°");
    assert!(value_of(&window, Role::Definition, "Removed").contains("triangles"));
    open_tab(&mut window, Tab::Domain);
    window.get_by_role_and_label(Role::RadioButton, "All parts").click();
    window.get_by_label("Keep pinched nodes").click();
    open_tab(&mut window, Tab::Mesh);
    wait_for_quality(&mut window);
    assert!(window.query_by_role_and_label(Role::Definition, "Removed").is_none());
    assert_eq!(window.state().session().triangle_count(), window.state().session().mesh().triangle_count());

    open_tab(&mut window, Tab::Domain);
    window.get_by_role_and_label(Role::RadioButton, "As in report").click();
    wait_for_quality(&mut window);
    assert!(window.state().session().mesh().triangle_count() < 1000);
    assert_eq!(window.state().session().mesh().outside_count(), 0);
    window.get_by_role_and_label(Role::RadioButton, "On outline").click();
    wait_for_quality(&mut window);
    assert_eq!(fingerprint(&window), mesh, "the diameter at the outline was kept");
    window.get_by_label("Whole rectangle").click();
    window.run();
    assert!(settings(&window).domain.region().is_none());
    assert_eq!(area(&window), 36.0);
}

#[test]
fn one_click_shows_the_place_where_the_fit_is_worst() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    open_section(&mut window, "Fit to outline");
    wait_for_quality(&mut window);
    let quality = window.state().session().derived().unwrap().quality.clone().unwrap();
    window.get_by_role_and_label(Role::Button, "Outline off mesh").click();
    window.run();
    let shown = window.state().view().camera.unwrap().visible_world();
    let (_, worst) = quality.farthest_from_mesh.unwrap();
    assert!(
        (shown.center() - worst).length() < 1e-6 && shown.size().min_element() < 1.0,
        "{shown:?} {worst}"
    );
}

#[test]
fn a_file_of_polygons_opens_as_a_document() {
    let path = scratch("lake.geojson");
    let rings = "[[[10, 0], [14, 0], [14, 2], [10, 2], [10, 0]], [[11, 0.5], [12, 0.5], [12, 1], [11, 1], [11, 0.5]]]";
    std::fs::write(&path, format!("{{\"type\": \"Polygon\", \"coordinates\": {rings}}}")).unwrap();
    let mut window = window();
    send(&mut window, Command::from(DomainCommand::Open(path.clone())));
    wait_until(&mut window, |window| settings(window).name == "lake");
    assert_eq!(settings(&window).domain.bounds.max, dvec2(14.0, 2.0));
    assert!((area(&window) - 7.5).abs() < 0.01, "{}", area(&window));
    std::fs::write(&path, "{\"type\": \"Point\", \"coordinates\": [1, 2]}").unwrap();
    send(&mut window, Command::from(DomainCommand::Open(path)));
    let text = wait_for_notice(&mut window);
    assert!(text.contains("lake.geojson: a domain needs a Polygon"), "{text}");
    assert_eq!(settings(&window).name, "lake");
}

#[test]
fn the_hint_of_the_tool_goes_once_it_was_used_a_few_times() {
    let mut window = window();
    send(&mut window, Command::from(DomainCommand::Mode(DomainToolMode::Rectangle)));
    let has_hint = |window: &Window| !window.state().tools().hint(&window.state().state(None)).is_empty();
    for use_ in 0..6 {
        assert!(has_hint(&window), "{use_} uses");
        let bounds = Rect::new(DVec2::ZERO, dvec2(1.0, 0.5 + 0.05 * f64::from(use_)));
        send(&mut window, Command::from(DomainCommand::Bounds(bounds)));
    }
    assert!(!has_hint(&window));
}
