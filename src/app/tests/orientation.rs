//! Finding one's way on the canvas: scale bar, coordinates, going to a place, the way back.

use std::collections::HashSet;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::pictures::{drawn_window, picture};
use super::{
    TALL, Window, choose, choose_in_palette, key, move_to, open_tab, send, set, settings, triangles,
    type_into, value_of, wait_for_jobs, wait_until, wheel, window, window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::domain::Domain;
use meshbrush_core::earth::{Projection, geographic_from_text};
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{BrushCommand, Command, FileCommand, ViewCommand};
use meshbrush_kit::kit::view::CanvasAid;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Returns the text of the scale bar.
fn scale(window: &Window) -> Option<String> {
    let mut labels = window.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
    labels.find_map(|label| label.strip_prefix("Scale: ").map(str::to_owned))
}

fn ask_for_place(window: &mut Window, text: &str) {
    key(window, Modifiers::COMMAND, Key::G);
    type_into(window, "Place", text);
}

#[test]
fn the_scale_bar_has_a_round_length_with_the_unit() {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    let degrees = scale(&window).unwrap();
    assert!(degrees.contains("° ≈ ") && degrees.ends_with(" km"), "{degrees}");
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Threats)));
    assert_eq!(scale(&window).as_deref(), Some("0.1"));
    set(&mut window, Setting::LengthUnit(LengthUnit::Kilometre));
    assert_eq!(scale(&window).as_deref(), Some("0.1 km"));
    send(&mut window, Command::from(ViewCommand::Zoom(4.0)));
    assert_eq!(scale(&window).as_deref(), Some("0.02 km"));
    choose(&mut window, "View", "Scale bar");
    assert_eq!(scale(&window), None);
}

/// In the plane of a projection the bar is a length on the Earth, and an arrow shows the north.
#[test]
fn the_scale_bar_of_a_document_on_the_earth_is_a_length_on_the_earth_with_an_arrow_to_the_north() {
    let mut window = window();
    let north = |window: &Window| {
        let mut labels =
            window.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
        labels.find_map(|label| label.strip_prefix("North: ").map(str::to_owned))
    };
    assert_eq!(north(&window), None);
    set(&mut window, Setting::LargestDiameter(1e6));
    set(&mut window, Setting::Layers(Layer::default_stack(LayerKind::constant(1e6))));
    set(&mut window, Setting::Spacing(2e5));
    set(&mut window, Setting::LengthUnit(LengthUnit::Metre));
    for (text, place, turned) in [
        ("+proj=merc +lon_0=0", [10.0, 60.0], 0.0),
        ("+proj=stere +lat_0=90 +lat_ts=70 +lon_0=0", [90.0, 75.0], -90.0),
    ] {
        let projection: Projection = text.parse().unwrap();
        let middle = projection.plane_from_geographic(place.into());
        let bounds = Rect::new(middle - 4e5, middle + 4e5);
        set(
            &mut window,
            Setting::Domain(Domain { projection: Some(projection), ..Domain::rectangle(bounds) }),
        );
        send(&mut window, Command::from(ViewCommand::Fit));
        let shown = north(&window).unwrap();
        let angle: f64 = shown.strip_suffix("° clockwise from up").unwrap().parse().unwrap();
        // The middle of the view is about that of the domain.
        assert!((angle - turned).abs() <= 2.0, "{text}: {angle}");
        let shown = scale(&window).unwrap();
        let metres = 1000.0 * shown.strip_suffix(" km").unwrap().parse::<f64>().unwrap();
        // The largest of 1, 2 and 5 times a power of ten that fits in 132 points.
        let px_per_metre =
            window.state().view().camera.unwrap().px_per_world() * projection.scale_at(place.into());
        assert!((132.0 / 2.5..=132.0).contains(&(px_per_metre * metres)), "{text}: {shown}");
    }
}

#[test]
fn coordinates_along_the_canvas_are_switched_off_in_the_menu() {
    let mut window = window();
    assert!(window.state().view().aids.coordinates);
    choose(&mut window, "View", "Coordinates along the canvas");
    assert!(!window.state().view().aids.coordinates);
    send(&mut window, Command::from(ViewCommand::ToggleAid(CanvasAid::Coordinates)));
    assert!(window.state().view().aids.coordinates);
}

/// Returns how many pixels of a window the graticule changes.
fn changed_by_graticule(window: &mut Window) -> usize {
    let before = picture(window);
    send(window, Command::from(ViewCommand::ToggleAid(CanvasAid::Graticule)));
    let after = picture(window);
    send(window, Command::from(ViewCommand::ToggleAid(CanvasAid::Graticule)));
    before.rgba.chunks(4).zip(after.rgba.chunks(4)).filter(|(a, b)| a != b).count()
}

#[test]
fn the_graticule_is_drawn_in_documents_on_the_earth_only() {
    let mut window = drawn_window();
    assert!(!window.state().view().aids.graticule);
    assert_eq!(changed_by_graticule(&mut window), 0);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    wait_for_jobs(&mut window);
    let changed = changed_by_graticule(&mut window);
    assert!(changed > 3000, "{changed} pixels");
    choose_in_palette(&mut window, "meridians");
    assert!(window.state().view().aids.graticule, "the palette knows other words for it");
}

#[test]
fn a_point_and_a_triangle_are_gone_to_by_their_numbers() {
    let mut window = window();
    ask_for_place(&mut window, "0.25, 0.75");
    let camera = window.state().view().camera.unwrap();
    assert!(camera.visible_world().center().distance(dvec2(0.25, 0.75)) < 1e-9);
    let queried = window.state().session().readout(window.state().view().quantity).unwrap();
    assert_eq!(queried.point, dvec2(0.25, 0.75));

    let last = triangles(&window) - 1;
    ask_for_place(&mut window, &last.to_string());
    let readout = window.state().session().readout(window.state().view().quantity).unwrap();
    assert_eq!(readout.location.triangle().map(|id| id.index()), Some(last));
    let camera = window.state().view().camera.unwrap();
    let diameter = readout.triangle.unwrap().diameter;
    assert!(diameter * camera.px_per_world() >= 59.0, "it is large enough to be seen");
}

/// In a document on the Earth, places are shown and typed as longitudes and latitudes, or in the plane.
#[test]
fn places_on_the_earth_are_shown_and_gone_to_in_the_coordinates_that_are_chosen() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::CelticSea)));
    wait_for_jobs(&mut window);
    let projection = settings(&window).domain.projection.expect("it lies on the Earth");
    let at = projection.plane_from_geographic(dvec2(-5.5, 49.75));
    let shown = |window: &Window, names: [&str; 2]| {
        names.map(|name| value_of(window, Role::Definition, name)).join(" ")
    };
    for (entry, names) in
        [("Places in degrees", ["lon", "lat"]), ("Places in degrees and minutes", ["lon", "lat"])]
    {
        choose_in_palette(&mut window, entry);
        move_to(&mut window, at);
        let text = shown(&window, names);
        let read = geographic_from_text(&text).unwrap_or_else(|| panic!("{text}"));
        // A pixel is about 1 km wide.
        assert!((read - dvec2(-5.5, 49.75)).abs().max_element() < 0.02, "{text}");
    }
    choose_in_palette(&mut window, "Places in the plane");
    move_to(&mut window, at);
    assert!(shown(&window, ["x", "y"]).contains(" m"), "{}", shown(&window, ["x", "y"]));
    for text in ["5.5 W 49.75 N", "49° 45′ N, 5° 30′ W", "-5.5°, 49.75°"] {
        send(&mut window, Command::from(ViewCommand::Fit));
        window.run();
        let before = window.state().view().camera.unwrap().px_per_world();
        ask_for_place(&mut window, text);
        let camera = window.state().view().camera.unwrap();
        assert!(camera.visible_world().center().distance(at) < 1.0, "{text}");
        assert!(camera.px_per_world() > before, "{text}: the triangle is large enough to be seen");
    }
}

#[test]
fn pins_and_pieces_of_the_boundary_are_gone_to_by_their_names() {
    let mut window = window();
    set(&mut window, Setting::Pins(vec![dvec2(0.2, 0.3), dvec2(0.7, 0.6)].into()));
    ask_for_place(&mut window, "pin 2");
    let center = |window: &Window| window.state().view().camera.unwrap().visible_world().center();
    assert!(center(&window).distance(dvec2(0.7, 0.6)) < 1e-9);
    key(&mut window, Modifiers::COMMAND, Key::G);
    wait_until(&mut window, |window| window.state().session().boundary_pieces().is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    let pieces = window.state().session().boundary_pieces().unwrap().list();
    let (name, middle) = (pieces[0].name.clone(), Rect::holding(pieces[0].points.iter().copied()).unwrap());
    ask_for_place(&mut window, &name);
    assert!(center(&window).distance(middle.center()) < 1e-9, "{name}");
    assert!(window.state().view().camera.unwrap().visible_world().contains(middle.min));
}

#[test]
fn a_place_that_does_not_exist_keeps_the_question_open() {
    let mut window = window();
    let camera = window.state().view().camera;
    ask_for_place(&mut window, "5, 5");
    assert!(window.query_by_label_contains("x is 0 to 1, and y is 0 to 1").is_some());
    type_into(&mut window, "Place", "99,999,999");
    assert!(window.query_by_label_contains("There is no such triangle").is_some());
    assert_eq!(window.state().view().camera, camera);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_role_and_label(Role::TextInput, "Place").is_none());
}

#[test]
fn an_arrow_leads_back_to_the_mesh_when_none_of_it_is_in_view() {
    let mut window = window();
    let square =
        |low: f64, high: f64| vec![dvec2(low, low), dvec2(high, low), dvec2(high, high), dvec2(low, high)];
    let frame = Domain::of_polygons(&[vec![square(0.0, 1.0), square(0.1, 0.9)]]).unwrap();
    set(&mut window, Setting::Domain(frame));
    let back = |window: &Window| window.query_by_role_and_label(Role::Button, "Back to the mesh").is_some();
    assert!(!back(&window));
    send(&mut window, Command::from(ViewCommand::LookAt(dvec2(0.5, 0.5))));
    send(&mut window, Command::from(ViewCommand::Zoom(6.0)));
    assert!(back(&window));
    window.get_by_role_and_label(Role::Button, "Back to the mesh").click();
    window.run();
    assert!(!back(&window));
    let bounds = settings(&window).domain.bounds;
    let seen = window.state().view().camera.unwrap().visible_world();
    assert!(seen.contains(bounds.min) && seen.contains(bounds.max));
}

#[test]
fn no_arrow_leads_back_where_a_part_of_the_mesh_is_in_view() {
    let mut window = window();
    let back = |window: &Window| window.query_by_role_and_label(Role::Button, "Back to the mesh").is_some();
    // The middle of the domain is not in view, and nothing but the mesh is.
    for (inside, zoom) in [(dvec2(0.2, 0.2), 4.0), (dvec2(0.8, 0.3), 6.0), (dvec2(0.1, 0.9), 50.0)] {
        send(&mut window, Command::from(ViewCommand::Fit));
        send(&mut window, Command::from(ViewCommand::LookAt(inside)));
        send(&mut window, Command::from(ViewCommand::Zoom(zoom)));
        let seen = window.state().view().camera.unwrap().visible_world();
        assert!(!seen.contains(dvec2(0.5, 0.5)) && !back(&window), "{inside}: {seen:?}");
    }
}

#[test]
fn the_view_is_fitted_to_the_window_until_it_is_moved() {
    let mut window = window();
    let scale = |window: &Window| window.state().view().camera.unwrap().px_per_world();
    let at_first = scale(&window);
    window.set_size(vec2(1000.0, 640.0));
    window.run();
    assert!(scale(&window) < 0.8 * at_first);
    window.set_size(vec2(1440.0, 900.0));
    window.run();
    assert_eq!(scale(&window), at_first);
    let at = super::canvas(&window).center();
    wheel(&mut window, at, 20.0);
    let moved = scale(&window);
    window.set_size(vec2(1000.0, 640.0));
    window.run();
    assert_eq!(scale(&window), moved, "a view that was moved stays");
    key(&mut window, Modifiers::NONE, Key::Home);
    window.set_size(vec2(1440.0, 900.0));
    window.run();
    assert_eq!(scale(&window), at_first, "after Home it follows again");
}

#[test]
fn after_a_change_of_size_the_pointer_is_where_it_is_seen() {
    let mut window = window();
    let at = super::canvas(&window).center();
    window.event(Event::PointerMoved(at));
    window.run();
    window.set_size(vec2(1000.0, 640.0));
    window.run();
    let pointer = window.state().canvas.pointer().unwrap();
    window.event(Event::PointerMoved(at));
    window.run();
    assert_eq!(window.state().canvas.pointer(), Some(pointer));
}

/// Returns the text of the legend on the canvas.
fn legend(window: &Window) -> Option<String> {
    let mut labels = window.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
    labels.find_map(|label| label.strip_prefix("Legend: ").map(str::to_owned))
}

#[test]
fn an_overlay_and_contour_lines_have_a_legend() {
    let mut window = window();
    assert_eq!(legend(&window).as_deref(), Some("levels of the mesh"));
    choose_in_palette(&mut window, "Legend of the levels");
    assert_eq!(legend(&window), None);
    key(&mut window, Modifiers::NONE, Key::O);
    assert_eq!(legend(&window).as_deref(), Some("risk 0 to 1"));
    key(&mut window, Modifiers::SHIFT, Key::O);
    assert_eq!(legend(&window).as_deref(), Some("diameters of levels 0 to 10"));
    key(&mut window, Modifiers::SHIFT, Key::O);
    assert_eq!(legend(&window), None);
    choose(&mut window, "View", "Contour lines of h̄");
    assert_eq!(legend(&window).as_deref(), Some("diameters of levels 0 to 10"));
}

#[test]
fn a_click_in_the_legend_on_the_canvas_shows_a_level_alone_and_the_pointer_lights_it() {
    let mut window = window();
    let counts = window.state().session().level_counts();
    let levels: Vec<usize> = (0..counts.len()).filter(|&level| counts[level] > 0).collect();
    let row = |window: &Window, level: usize| {
        window.get_by_role_and_label(Role::Button, &format!("Show level {level} alone")).rect().center()
    };
    let level = levels[levels.len() / 2];
    let at = row(&window, level);
    window.event(Event::PointerMoved(at));
    window.run();
    assert_eq!(window.state().view().lone_level, Some(level as u32));
    super::press_at(&mut window, at, eframe::egui::PointerButton::Primary, Modifiers::NONE);
    super::release_at(&mut window, at, eframe::egui::PointerButton::Primary);
    assert_eq!(window.state().view().hidden_levels, !(1 << level));
    super::click_button(&mut window, &format!("Show level {level} alone"));
    assert_eq!(window.state().view().hidden_levels, 0, "a second click shows all again");
    window.event(Event::PointerMoved(super::canvas(&window).center()));
    window.run();
    assert_eq!(window.state().view().lone_level, None);
    window.event(Event::PointerMoved(at));
    window.run();
    assert_eq!(window.state().view().lone_level, Some(level as u32));
    key(&mut window, Modifiers::NONE, Key::O);
    assert_eq!(window.state().view().lone_level, None, "an overlay has the place of the legend");
}

#[test]
fn every_level_along_an_outline_has_a_colour_of_its_own() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    // The outline asks for finer triangles than any paint can.
    set(&mut window, Setting::SmallestDiameter(0.2));
    let deepest = window.state().session().level_counts().len() - 1;
    let colors = window.state().view().level_colors(settings(&window));
    let own: HashSet<_> = (0..=deepest).map(|level| colors.of(level as u8)).collect();
    assert_eq!(own.len(), deepest + 1);
    send(&mut window, Command::from(BrushCommand::BeginStroke(dvec2(25.0, 38.0))));
    send(&mut window, Command::from(BrushCommand::DrawTo(dvec2(25.5, 38.0))));
    send(&mut window, Command::from(BrushCommand::EndStroke));
    assert_eq!(window.state().view().level_colors(settings(&window)), colors, "paint changes no colour");
    open_tab(&mut window, Tab::Mesh);
    for level in 0..=deepest {
        let name = format!("Level {level}: ");
        let row = window.get_by_label_contains(&name);
        assert!(row.rect().height() >= 14.0 && row.rect().bottom() < TALL.y, "level {level} is visible");
    }
}
