//! Number and formula fields: typed, dragged, turned by the wheel.

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{
    TALL, Window, button_event, entries, find, fingerprint, key, notice, open_section, press_at, release_at,
    send, set, settings, type_into, value_of, wheel, wheel_with, window_with,
};
use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::domain::Domain;
use meshbrush_core::earth::Projection;
use meshbrush_core::layers::{FormulaLayer, Layer, LayerKind};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{LengthUnit, typed};

/// Returns a tall window whose frames are as short as those on a screen, so that there is time within a
/// double click.
fn quick_window() -> Window {
    window_with(Harness::builder().with_size(TALL).with_step_dt(0.02))
}

fn field(window: &Window, name: &str) -> Pos2 {
    window.get_by_role_and_label(Role::TextInput, name).rect().center()
}

/// Returns the sentences that the window shows about what was typed.
fn alerts(window: &Window) -> String {
    let alerts = window.query_all_by_role(Role::Alert);
    alerts.filter_map(|node| node.accesskit_node().label()).collect::<Vec<_>>().join(" ")
}

fn drag_number(window: &mut Window, name: &str, by: f32, modifiers: Modifiers) {
    let at = field(window, name);
    press_at(window, at, PointerButton::Primary, modifiers);
    for share in [0.1, 0.5, 1.0] {
        window.event(Event::PointerMoved(at + vec2(share * by, 0.0)));
        window.run();
    }
    release_at(window, at + vec2(by, 0.0), PointerButton::Primary);
}

/// Both clicks before anything else happens, after the pointer has rested at the place.
fn double_click(window: &mut Window, at: Pos2) {
    window.event(Event::PointerMoved(at));
    window.run_steps(20);
    for pressed in [true, false, true, false] {
        window.event(button_event(at, PointerButton::Primary, pressed, Modifiers::NONE));
    }
    window.run();
}

#[test]
fn a_number_beside_a_slider_is_dragged_as_one_gesture() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    let before = settings(&window).spacing;
    drag_number(&mut window, "Spacing δ value", 60.0, Modifiers::NONE);
    assert!(settings(&window).spacing > 1.5 * before, "{}", settings(&window).spacing);
    assert_eq!(entries(&window), 1);
    let coarse = settings(&window).spacing;
    drag_number(&mut window, "Spacing δ value", -60.0, Modifiers::SHIFT);
    let fine = settings(&window).spacing;
    assert!(fine < coarse && fine > 0.9 * coarse, "Shift is ten times finer: {coarse} to {fine}");
}

#[test]
fn a_number_in_a_field_is_dragged_and_taken_where_the_drag_ends() {
    let mut window = quick_window();
    super::select_base(&mut window);
    drag_number(&mut window, "Diameter", -60.0, Modifiers::NONE);
    // The first points of a movement decide that it is a drag.
    let diameter = settings(&window).layers[0].kind.clone();
    assert_eq!(diameter, LayerKind::constant(0.107), "{diameter:?}");
    assert_eq!(entries(&window), 1);
}

#[test]
fn ctrl_and_the_wheel_turn_the_number_under_the_pointer_and_nothing_else() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    let before = settings(&window).spacing;
    let scale = |window: &Window| window.state().view().camera.unwrap().px_per_world();
    let zoomed = scale(&window);
    let at = field(&window, "Spacing δ value");
    wheel_with(&mut window, at, 120.0, Modifiers::COMMAND);
    window.run_steps(40);
    assert!((settings(&window).spacing / before - 1.41).abs() < 0.02, "{}", settings(&window).spacing);
    assert_eq!(entries(&window), 1, "one turn is one gesture");
    assert_eq!(field(&window, "Spacing δ value"), at, "the panel does not scroll");
    assert_eq!(scale(&window), zoomed, "the view does not zoom");
}

#[test]
fn the_wheel_scrolls_the_panel_over_numbers_sliders_and_lists() {
    /// A height within the lower dock, in points.
    const MIDDLE: f32 = 440.0;
    let mut window = quick_window();
    for section in ["Mesh", "Domain"] {
        open_section(&mut window, section);
    }
    window.set_size(vec2(1440.0, 560.0));
    window.run();
    let before = (settings(&window).clone(), window.state().tools().clone());
    for (role, name) in [
        (Role::TextInput, "Spacing δ value"),
        (Role::Slider, "Spacing δ"),
        (Role::TextInput, "h_min value"),
        (Role::ComboBox, "Unit"),
    ] {
        find(&mut window, role, name);
        let place = |window: &Window| window.get_by_role_and_label(role, name).rect().center();
        let beside = pos2(place(&window).x, MIDDLE);
        let away = place(&window).y - MIDDLE;
        wheel(&mut window, beside, -away);
        let back = if away > 0.0 { 20.0 } else { -20.0 };
        // A hand that is never quite still.
        for jitter in [1.0, 0.0, 1.0] {
            let at = place(&window) + vec2(jitter, 0.0);
            wheel(&mut window, at, back);
            window.run_steps(20);
            assert_ne!(place(&window).y, at.y, "{name} is scrolled");
        }
    }
    assert_eq!((settings(&window).clone(), window.state().tools().clone()), before);
}

#[test]
fn ctrl_and_the_wheel_change_no_list() {
    let mut window = quick_window();
    open_section(&mut window, "Domain");
    let list = window.get_by_role_and_label(Role::ComboBox, "Unit");
    let at = list.rect().center();
    list.focus();
    window.run();
    let unit = settings(&window).unit;
    for delta in [40.0, -40.0] {
        wheel_with(&mut window, at, delta, Modifiers::COMMAND);
        wheel(&mut window, at, delta);
    }
    assert_eq!(settings(&window).unit, unit);
}

#[test]
fn a_double_click_edits_the_number_with_all_of_it_selected() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    set(&mut window, Setting::Spacing(0.125));
    let track = window.get_by_role_and_label(Role::Slider, "Hardness").rect().center();
    for (name, place, typed) in
        [("Spacing δ value", field(&window, "Spacing δ value"), "0.2"), ("Hardness value", track, "0.7")]
    {
        double_click(&mut window, place);
        let number = window.get_by_role_and_label(Role::TextInput, name);
        assert!(number.is_focused(), "{name}");
        number.type_text(typed);
        window.run();
        key(&mut window, Modifiers::NONE, Key::Enter);
    }
    assert_eq!(settings(&window).spacing, 0.2, "no digit of the former number is left");
    assert_eq!(window.state().tools().hardness, 0.7);
    find(&mut window, Role::Slider, "h_risk");
    let handle = window.get_by_role_and_label(Role::Slider, "h_risk").rect().center();
    double_click(&mut window, handle);
    assert!(window.get_by_role_and_label(Role::TextInput, "h_risk value").is_focused());
    assert_eq!(entries(&window), 2, "nothing was reset");
}

/// Clicks with the secondary button, and returns the entry of the menu that begins with `entry`.
fn open_number_menu(window: &mut Window, at: Pos2, entry: &str) -> String {
    press_at(window, at, PointerButton::Secondary, Modifiers::NONE);
    release_at(window, at, PointerButton::Secondary);
    let mut entries = window.query_all_by_role(Role::Button).filter_map(|node| node.accesskit_node().label());
    entries.find(|label| label.starts_with(entry)).expect("an entry of the menu")
}

fn choose_in_number_menu(window: &mut Window, at: Pos2, entry: &str) {
    let label = open_number_menu(window, at, entry);
    window.get_by_role_and_label(Role::Button, &label).click();
    window.run();
}

#[test]
fn the_menu_of_a_number_shows_its_default_and_sets_it() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    let default = Settings::default().spacing;
    let places = [
        field(&window, "Spacing δ value"),
        window.get_by_role_and_label(Role::Slider, "Spacing δ").rect().center(),
    ];
    for at in places {
        set(&mut window, Setting::Spacing(0.1));
        let entry = open_number_menu(&mut window, at, "Reset to");
        assert_eq!(entry, format!("Reset to {}", meshbrush_ui::widgets::format::significant(default, 3)));
        assert_eq!(settings(&window).spacing, 0.1, "a secondary click changes nothing");
        window.get_by_role_and_label(Role::Button, &entry).click();
        window.run();
        assert_eq!(settings(&window).spacing, default);
    }
    let handle = |window: &Window, name| window.get_by_role_and_label(Role::Slider, name).rect().center();
    find(&mut window, Role::Slider, "Curve shape");
    let shape = handle(&window, "Curve shape");
    type_into(&mut window, "h_min value", "0.02");
    assert_eq!(settings(&window).transfer.h_min, 0.02);
    let h_min = handle(&window, "h_min");
    choose_in_number_menu(&mut window, h_min, "Reset to");
    assert_eq!(settings(&window).transfer.h_min, Settings::default().transfer.h_min);
    assert!(open_number_menu(&mut window, shape, "Reset to").starts_with("Reset to"));
}

#[test]
fn the_menu_of_a_number_copies_and_pastes() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    let at = field(&window, "Spacing δ value");
    press_at(&mut window, at, PointerButton::Secondary, Modifiers::NONE);
    release_at(&mut window, at, PointerButton::Secondary);
    window.get_by_role_and_label(Role::Button, "Copy").click();
    let exact = settings(&window).spacing.to_string();
    let copies = |window: &Window| {
        let commands = &window.output().platform_output.commands;
        commands.iter().any(|command| *command == egui::OutputCommand::CopyText(exact.clone()))
    };
    let copied = (0..10).any(|_| {
        window.step();
        copies(&window)
    });
    assert!(copied);
    window.run();
    for (text, spacing, alert) in [("0.25", 0.25, ""), ("wide", 0.25, "“wide” is not a number")] {
        choose_in_number_menu(&mut window, at, "Paste");
        window.event(Event::Paste(text.into()));
        window.run();
        assert_eq!(settings(&window).spacing, spacing);
        assert!(alerts(&window).contains(alert), "{}", alerts(&window));
        // What is pasted afterwards is for somebody else.
        window.event(Event::Paste("0.125".into()));
        window.run();
        assert_eq!(settings(&window).spacing, spacing);
    }
}

#[test]
fn a_number_says_how_it_is_changed() {
    let window = quick_window();
    let hardness = window.get_by_role_and_label(Role::TextInput, "Hardness value");
    let said = hardness.accesskit_node().description().unwrap_or_default();
    for word in ["Share of the radius", "drag", "Ctrl", "Right-click", "default"] {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn typed_multiples_are_understood() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    type_into(&mut window, "Triangle budget", "100k");
    assert_eq!(settings(&window).max_triangles, 100_000);
    type_into(&mut window, "Triangle budget", "2M");
    assert_eq!(settings(&window).max_triangles, 2_000_000);
    type_into(&mut window, "Memory budget", "500 MB");
    assert_eq!(settings(&window).max_memory, 500_000_000);
    type_into(&mut window, "Spacing δ value", "5e-2");
    assert_eq!(settings(&window).spacing, 0.05);
    assert_eq!(alerts(&window), "");
}

#[test]
fn a_number_out_of_range_says_what_it_was_set_to() {
    let mut window = quick_window();
    type_into(&mut window, "Hardness value", "3");
    assert_eq!(window.state().tools().hardness, 1.0);
    let alert = alerts(&window);
    assert_eq!(alert, "3 is above the largest value, 1.00. Hardness was set to that.");
    type_into(&mut window, "Hardness value", "0.5");
    assert_eq!(alerts(&window), "", "the sentence goes away with its cause");
    type_into(&mut window, "h_min value", "7");
    assert!(alerts(&window).contains("h_min was set to that"), "{}", alerts(&window));
}

#[test]
fn what_is_no_number_keeps_the_focus_and_the_text() {
    let mut window = quick_window();
    let hardness = window.state().tools().hardness;
    type_into(&mut window, "Hardness value", "soft");
    assert!(alerts(&window).contains("“soft” is not a number"), "{}", alerts(&window));
    assert!(window.get_by_role_and_label(Role::TextInput, "Hardness value").is_focused());
    assert_eq!(value_of(&window, Role::TextInput, "Hardness value"), "soft");
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(window.state().tools().hardness, hardness);
    type_into(&mut window, "Radius value", "1 km");
    assert!(alerts(&window).contains("has no unit"), "{}", alerts(&window));
}

fn type_formula(window: &mut Window, text: &str) {
    super::select_base(window);
    window.get_by_role_and_label(Role::TextInput, FORMULA).focus();
    window.run();
    key(window, Modifiers::COMMAND, Key::A);
    window.get_by_role_and_label(Role::TextInput, FORMULA).type_text(text);
    window.run();
}

const FORMULA: &str = "Target diameter h̄(x, y)";

fn is_marked(window: &Window) -> bool {
    window.query_by_role_and_label(Role::Status, "not applied").is_some()
}

#[test]
fn a_formula_is_applied_once_typing_pauses() {
    let mut window = quick_window();
    let before = fingerprint(&window);
    type_formula(&mut window, "0.02 + 0.1*x");
    assert!(is_marked(&window));
    window.run_steps(60);
    window.run();
    let is_constant = |kind: &LayerKind| matches!(kind, LayerKind::Formula(FormulaLayer { formula, .. }) if formula.constant().is_some());
    assert!(!is_constant(&settings(&window).layers[0].kind), "without Enter");
    assert_ne!(fingerprint(&window), before);
    assert!(!is_marked(&window));
    assert!(window.get_by_role_and_label(Role::TextInput, FORMULA).is_focused());
    assert_eq!(entries(&window), 1);
}

#[test]
fn a_formula_that_cannot_be_read_keeps_the_focus_and_is_marked() {
    let mut window = quick_window();
    type_formula(&mut window, "0.1 + sqr(x)");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(window.get_by_role_and_label(Role::TextInput, FORMULA).is_focused());
    assert!(is_marked(&window));
    assert!(alerts(&window).contains("sqr"));
}

#[test]
fn a_refused_formula_keeps_its_text_and_is_marked() {
    let mut window = quick_window();
    type_formula(&mut window, "0.1 - 0.2*(x > 0.5)");
    key(&mut window, Modifiers::NONE, Key::Enter);
    window.run_steps(60);
    window.run();
    assert!(notice(&window).contains("x = 0."), "{}", notice(&window));
    assert_eq!(value_of(&window, Role::TextInput, FORMULA), "0.1 - 0.2*(x > 0.5)");
    assert!(is_marked(&window));
    assert_eq!(entries(&window), 0);
}

#[test]
fn a_number_that_changed_elsewhere_while_its_field_was_open_stays() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    set(&mut window, Setting::Spacing(0.1));
    window.get_by_role_and_label(Role::TextInput, "Spacing δ value").focus();
    window.run();
    set(&mut window, Setting::Spacing(0.2));
    window.get_by_role_and_label(Role::Slider, "Spacing δ").focus();
    window.run();
    assert_eq!(settings(&window).spacing, 0.2, "nothing was typed");
}

/// Returns the name of the button with the focus.
fn focused_button(window: &Window) -> Option<String> {
    let mut buttons = window.query_all_by_role(Role::Button);
    buttons.find(|node| node.is_focused()).and_then(|node| node.accesskit_node().label())
}

#[test]
fn the_menu_of_a_number_is_opened_by_keyboard_and_gives_the_focus_back() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    let default = Settings::default().spacing;
    for (role, name) in [(Role::TextInput, "Spacing δ value"), (Role::Slider, "Spacing δ")] {
        set(&mut window, Setting::Spacing(0.1));
        let is_focused = |window: &Window| window.get_by_role_and_label(role, name).is_focused();
        window.get_by_role_and_label(role, name).focus();
        window.run();
        key(&mut window, Modifiers::SHIFT, Key::F10);
        assert!(focused_button(&window).is_some_and(|button| button.starts_with("Reset to")), "{name}");
        key(&mut window, Modifiers::NONE, Key::Escape);
        assert!(is_focused(&window), "{name}: the focus is back");
        key(&mut window, Modifiers::SHIFT, Key::F10);
        key(&mut window, Modifiers::NONE, Key::Enter);
        assert_eq!(settings(&window).spacing, default, "{name}");
        assert!(is_focused(&window), "{name}");
        key(&mut window, Modifiers::NONE, Key::Escape);
        assert!(window.state().stepping().is_none(), "F10 steps through the refinement, Shift+F10 does not");
    }
}

#[test]
fn the_menu_of_the_canvas_is_opened_by_keyboard() {
    for px_per_point in [1.0, 2.0] {
        query_by_menu(window_with(
            Harness::builder().with_size(TALL).with_step_dt(0.02).with_pixels_per_point(px_per_point),
        ));
    }
}

/// Queries the middle of the canvas by its menu, without a pointer.
fn query_by_menu(mut window: Window) {
    let entry = |window: &Window| window.query_by_role_and_label(Role::Button, "Query here").is_some();
    key(&mut window, Modifiers::SHIFT, Key::F10);
    assert!(entry(&window));
    assert!(focused_button(&window).is_some());
    while focused_button(&window).as_deref() != Some("Query here") {
        key(&mut window, Modifiers::NONE, Key::Tab);
    }
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(!entry(&window));
    let queried = window.state().session().queried().expect("a queried point");
    let middle = settings(&window).domain.bounds.center();
    // The view fits the domain a little below the middle of the canvas: the hint has its room.
    assert!(queried.distance(middle) < 0.03, "{queried}");
}

/// On a chart in Mercator the brush is drawn in the plane, and its radius is read and typed on the Earth.
#[test]
fn the_radius_of_the_brush_is_a_length_on_the_earth_at_the_place() {
    let mut window = quick_window();
    let projection: Projection = "+proj=merc +lon_0=0".parse().unwrap();
    let [low, high] = [[-15.0, 50.0], [15.0, 68.0]].map(|at| projection.plane_from_geographic(at.into()));
    let domain = Domain { projection: Some(projection), ..Domain::rectangle(Rect::new(low, high)) };
    set(&mut window, Setting::LargestDiameter(1e6));
    set(&mut window, Setting::Layers(Layer::default_stack(LayerKind::constant(1e6))));
    set(&mut window, Setting::Spacing(5e5));
    set(&mut window, Setting::Domain(domain.clone()));
    set(&mut window, Setting::LengthUnit(LengthUnit::Metre));
    send(&mut window, Command::from(ViewCommand::Fit));
    type_into(&mut window, "Radius value", "50 km");
    let center = window.state().view().camera.unwrap().visible_world().center();
    let radius = window.state().tools().radius;
    let scale = projection.scale_in_plane(center);
    assert!((1.8..2.2).contains(&scale), "{scale} at {center}");
    assert!((radius / (50e3 * scale) - 1.0).abs() < 1e-12, "{radius} at {center}");
    // It ends where the ellipsoid says.
    let metres = domain.ground().length([center, center + glam::dvec2(radius, 0.0)]);
    assert!((metres / 50e3 - 1.0).abs() < 1e-6, "{metres}");
    let typed = value_of(&window, Role::TextInput, "Radius value");
    assert!(typed.starts_with("50"), "{typed}");
    // Farther north the same ring is smaller on the Earth.
    let canvas = super::canvas(&window);
    window.event(Event::PointerMoved(canvas.center_top() + vec2(0.0, 0.1 * canvas.height())));
    window.run_steps(3);
    let shown = typed::number(&value_of(&window, Role::TextInput, "Radius value"), "m").unwrap();
    assert!((30e3..46e3).contains(&shown), "{shown}");
    assert_eq!(window.state().tools().radius, radius);
}

#[test]
fn a_metric_length_in_a_document_in_degrees_is_answered_with_degrees() {
    let mut window = quick_window();
    open_section(&mut window, "Mesh");
    for (unit, says) in [(LengthUnit::Degree, true), (LengthUnit::None, false)] {
        set(&mut window, Setting::LengthUnit(unit));
        type_into(&mut window, "Spacing δ value", "2 km");
        assert_eq!(alerts(&window).contains("type one of these"), says, "{unit:?}: {}", alerts(&window));
        key(&mut window, Modifiers::NONE, Key::Escape);
    }
}
