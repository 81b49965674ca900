//! Documents and their settings, in the panels.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, pos2};
use egui_kittest::kittest::Queryable as _;
use glam::DVec2;

use super::{
    TALL, Window, choose, entries, fingerprint, key, notice, open_section, press_at, release_at, send, set,
    settings, triangles, type_into, value_of, window, window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::domain::{Domain, DomainShape};
use meshbrush_core::field::{Formula, RefinementRule};
use meshbrush_core::layers::{FormulaLayer, Layer, LayerKind};
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};

#[test]
fn the_diamond_opens_by_menu_and_undo_stops_at_its_start() {
    let mut window = window();
    assert!(window.query_by_label("Radar threats").is_some(), "the bar says what is open");
    choose(&mut window, "Examples", "The report's diamond");
    assert_eq!(triangles(&window), 9560);
    assert_eq!(value_of(&window, Role::Definition, "triangles"), "9,560");
    assert_eq!(value_of(&window, Role::Definition, "rule"), "vertex");
    assert!(window.query_by_label("The report's diamond").is_some(), "and does not call it edited");
    let (opened, entries) = (fingerprint(&window), entries(&window));
    assert_eq!(entries, 0);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), opened, "undo does not return to the former document");
    assert!(window.query_by_label("The report's diamond").is_some());
    set(&mut window, Setting::Spacing(0.3));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), opened);
}

#[test]
fn every_example_opens_and_new_is_empty() {
    let mut window = window();
    for example in Example::ALL {
        send(&mut window, Command::from(FileCommand::OpenExample(example)));
        assert!(triangles(&window) > 5000, "{}", example.name());
        assert_eq!(notice(&window), "");
    }
    key(&mut window, Modifiers::COMMAND, Key::N);
    assert_eq!(window.state().session().mesh().level_counts().len(), 1);
}

#[test]
fn spacing_diameters_and_base_change_the_mesh_at_once() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    super::select_base(&mut window);
    open_section(&mut window, "Domain");
    let mut last = fingerprint(&window);
    let mut changed = |window: &Window, what: &str| {
        assert_ne!(fingerprint(window), last, "{what}");
        last = fingerprint(window);
    };
    type_into(&mut window, "Spacing δ value", "0.1");
    assert_eq!(settings(&window).spacing, 0.1);
    changed(&window, "spacing");
    set(&mut window, Setting::SmallestDiameter(0.01));
    changed(&window, "h_min");
    set(&mut window, Setting::LargestDiameter(0.1));
    changed(&window, "h_max");
    type_into(&mut window, "Diameter", "0.05");
    assert_eq!(settings(&window).layers[0].kind, LayerKind::constant(0.05));
    changed(&window, "constant");
    type_into(&mut window, "Target diameter h̄(x, y)", "0.02 + 0.1*x");
    assert!(
        matches!(&settings(&window).layers[0].kind, LayerKind::Formula(FormulaLayer { formula, .. }) if formula.constant().is_none())
    );
    changed(&window, "formula");
    type_into(&mut window, "Domain where", "hypot(x - 0.5, y - 0.5) < 0.5");
    assert!(settings(&window).domain.formula().is_some());
    changed(&window, "domain");
    type_into(&mut window, "Right", "2");
    assert_eq!(settings(&window).domain.bounds.max.x, 2.0);
    changed(&window, "bounds");
    let mesh = window.state().session().mesh();
    assert_eq!(mesh.violations(), []);
}

#[test]
fn a_drag_of_a_slider_is_one_entry() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    let track = |window: &Window| window.get_by_role_and_label(Role::Slider, "Spacing δ").rect();
    let place = track(&window);
    let at = |share: f32| pos2(place.left() + place.width() * share, place.center().y);
    press_at(&mut window, at(0.5), PointerButton::Primary, Modifiers::NONE);
    let spacing = settings(&window).spacing;
    for share in [0.6, 0.7, 0.65, 0.8] {
        window.event(Event::PointerMoved(at(share)));
        window.run();
    }
    assert!(settings(&window).spacing > 2.0 * spacing, "live");
    assert_eq!(track(&window), place, "the slider stays under the pointer, though there are more levels now");
    release_at(&mut window, at(0.8), PointerButton::Primary);
    assert_eq!(entries(&window), 1);
    press_at(&mut window, at(0.4), PointerButton::Primary, Modifiers::NONE);
    release_at(&mut window, at(0.4), PointerButton::Primary);
    assert_eq!(entries(&window), 2, "the next drag is another");
}

#[test]
fn a_formula_that_cannot_be_read_says_why_and_changes_nothing() {
    let mut window = window_of(TALL);
    let before = (fingerprint(&window), settings(&window).clone());
    super::select_base(&mut window);
    type_into(&mut window, "Target diameter h̄(x, y)", "0.1 + sqr(x)");
    assert!(window.query_by_label_contains("sqr").is_some(), "the sentence names what is wrong");
    assert_eq!((fingerprint(&window), settings(&window).clone()), before);
    assert_eq!(entries(&window), 0);
}

#[test]
fn a_formula_that_is_no_length_somewhere_says_where_and_changes_nothing() {
    for (formula, x) in [("if(x > 0.75, sqrt(-1), 0.1)", "x = 0.75"), ("0.1 - 0.2*(x > 0.5)", "x = 0.5")] {
        for rule in [RefinementRule::Area, RefinementRule::Vertex] {
            let mut window = window_of(TALL);
            set(&mut window, Setting::RefinementRule(rule));
            let before = (fingerprint(&window), settings(&window).clone(), entries(&window));
            super::select_base(&mut window);
            type_into(&mut window, "Target diameter h̄(x, y)", formula);
            let message = notice(&window);
            assert!(message.contains(x) || message.contains("x = 0."), "{formula}: {message}");
            assert!(window.query_by_role_and_label(Role::Alert, &message).is_some(), "{message}");
            assert_eq!((fingerprint(&window), settings(&window).clone(), entries(&window)), before);
        }
    }
}

#[test]
fn impossible_settings_are_refused_with_a_sentence() {
    let mut window = window();
    let before = (fingerprint(&window), settings(&window).clone());
    for setting in [
        Setting::Spacing(0.0),
        Setting::Spacing(1e-9),
        Setting::SmallestDiameter(f64::NAN),
        Setting::Layers(Layer::default_stack(LayerKind::constant(-1.0))),
        Setting::Gradation(Some(0.0)),
        Setting::Gradation(Some(f64::NAN)),
        Setting::Bounds(meshbrush_mesh::geometry::Rect::new(DVec2::ONE, DVec2::ZERO)),
        Setting::Domain(Domain {
            bounds: meshbrush_mesh::geometry::Rect::UNIT,
            shape: DomainShape::from(Formula::parse("x > 9").unwrap()),
            projection: None,
        }),
    ] {
        set(&mut window, setting.clone());
        assert!(notice(&window).ends_with('.'), "{setting:?}: {}", notice(&window));
        assert_eq!((fingerprint(&window), settings(&window).clone()), before, "{setting:?}");
        assert_eq!(entries(&window), 0);
        send(&mut window, Command::from(ShellCommand::Escape));
        assert_eq!(notice(&window), "", "Escape dismisses it");
    }
}

#[test]
fn a_base_of_infinity_asks_for_nothing() {
    let mut window = window_of(TALL);
    set(&mut window, Setting::Layers(Layer::default_stack(LayerKind::constant(0.02))));
    super::select_base(&mut window);
    let fine = fingerprint(&window);
    type_into(&mut window, "Target diameter h̄(x, y)", "1/0");
    assert_ne!(fingerprint(&window), fine);
    assert!(
        notice(&window).is_empty() && window.query_by_role_and_label(Role::TextInput, "Diameter").is_none()
    );
    let nothing = fingerprint(&window);
    let h_max = settings(&window).transfer.h_max;
    set(&mut window, Setting::Layers(Layer::default_stack(LayerKind::constant(h_max))));
    assert_eq!(fingerprint(&window), nothing);
}

#[test]
fn the_rule_switches_and_says_what_it_misses() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    let area = fingerprint(&window);
    window.get_by_role_and_label(Role::RadioButton, "Vertex rule").click();
    window.run();
    assert_eq!(settings(&window).rule, RefinementRule::Vertex);
    assert_ne!(fingerprint(&window), area);
    assert!(window.query_by_label_contains("leaves no trace").is_some());
    window.get_by_role_and_label(Role::RadioButton, "Area rule").click();
    window.run();
    assert_eq!(fingerprint(&window), area);
}

#[test]
fn a_formula_typed_for_another_document_is_gone() {
    let mut window = window_of(TALL);
    super::select_base(&mut window);
    let field = "Target diameter h̄(x, y)";
    window.get_by_role_and_label(Role::TextInput, field).type_text("0.1*");
    window.run();
    send(&mut window, Command::from(FileCommand::New));
    assert!(window.query_by_role_and_label(Role::TextInput, field).is_none(), "a paint layer is selected");
    super::select_base(&mut window);
    assert_eq!(value_of(&window, Role::TextInput, field), "0.2");
}
