//! The modes of the brush, picking, mirrored and smoothed strokes, the pen, and why a dab changes nothing.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, TouchDeviceId, TouchId, TouchPhase};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};

use crate::app::features::painting::BRUSH;
use crate::app::tests::{
    FREE, PAINTED_DIAMETER, PAINTED_RISK, Window, click, entries, hover, key, move_to, on_screen, open_popup,
    painted, press, price_tag, release, send, settings, stroke, triangles, value_of, window, with_base,
};
use meshbrush_core::field::RiskToDiameter as _;
use meshbrush_core::layers::LayerKind;
use meshbrush_kit::kit::command::{BrushCommand, Command, EditCommand, LayerCommand};
use meshbrush_kit::kit::tools::{BrushMode, PaintKind, PenResponse};
use meshbrush_ui::widgets::format;

fn risk_at(window: &Window, point: DVec2) -> f32 {
    painted(window, PAINTED_RISK, point)
}

fn brush(window: &mut Window, command: BrushCommand) {
    send(window, Command::from(command));
}

fn label(window: &Window, start: &str) -> Option<String> {
    let mut labels = window.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
    labels.find(|label| label.starts_with(start))
}

#[test]
fn a_risk_is_built_up_set_and_lowered() {
    let mut window = window();
    brush(&mut window, BrushCommand::Strength(0.5));
    for _ in 0..3 {
        stroke(&mut window, FREE, FREE);
    }
    assert_eq!(risk_at(&window, FREE), 0.875, "half of the rest with each stroke");
    window.get_by_role_and_label(Role::RadioButton, "Set").click();
    window.run();
    let row = window.get_by_role_and_label(Role::Slider, "Value").accesskit_node().numeric_value();
    assert_eq!(row, Some(0.5), "the slider is that of the value now");
    stroke(&mut window, FREE, FREE);
    assert_eq!(risk_at(&window, FREE), 0.5);
    key(&mut window, Modifiers::NONE, Key::Num9);
    stroke(&mut window, FREE, FREE);
    assert_eq!(risk_at(&window, FREE), 0.9, "the digits set the value in this mode");
    key(&mut window, Modifiers::NONE, Key::L);
    stroke(&mut window, FREE, FREE);
    assert_eq!(risk_at(&window, FREE), 0.45);
    key(&mut window, Modifiers::NONE, Key::U);
    assert_eq!(window.state().tools().mode, BrushMode::BuildUp);
}

#[test]
fn the_panel_says_which_diameter_a_stroke_aims_at() {
    let mut window = window();
    let transfer = settings(&window).transfer;
    brush(&mut window, BrushCommand::Strength(0.3));
    brush(&mut window, BrushCommand::Risk(0.6));
    for (mode, risk) in [(BrushMode::BuildUp, 0.3), (BrushMode::Set, 0.6), (BrushMode::Lower, 0.7)] {
        brush(&mut window, BrushCommand::Mode(mode));
        let said = value_of(&window, Role::Definition, "h̄ · level");
        let aim = format::length(transfer.diameter(risk), settings(&window).unit);
        assert!(said.starts_with(&format!("{aim} · ")), "{mode:?}: {said}, not {aim}");
    }
}

#[test]
fn a_diameter_is_made_smaller_or_larger_as_the_mode_permits() {
    let mut window = window();
    brush(&mut window, BrushCommand::Kind(PaintKind::Diameter));
    let painted = |window: &mut Window, mode, diameter| {
        brush(window, BrushCommand::Mode(mode));
        brush(window, BrushCommand::Diameter(diameter));
        stroke(window, FREE, FREE);
        f64::from(crate::app::tests::painted(window, PAINTED_DIAMETER, FREE))
    };
    for (mode, diameter, after) in [
        (BrushMode::BuildUp, 0.01, 0.01),
        (BrushMode::BuildUp, 0.05, 0.01),
        (BrushMode::Lower, 0.005, 0.01),
        (BrushMode::Lower, 0.02, 0.02),
        (BrushMode::Set, 0.03, 0.03),
        (BrushMode::Set, 0.004, 0.004),
    ] {
        let painted = painted(&mut window, mode, diameter);
        assert!((painted - after).abs() < 1e-8, "{mode:?} of {diameter}: {painted}");
    }
}

#[test]
fn what_is_picked_is_painted_exactly() {
    let mut window = window();
    let source = dvec2(0.37, 0.4); // within the painted band of the example, near its rim
    let elsewhere = dvec2(0.9, 0.1);
    let risk = risk_at(&window, source);
    assert!(risk > 0.0 && risk < 1.0, "{risk}");
    key(&mut window, Modifiers::NONE, Key::E);
    click(&mut window, source, Modifiers::ALT);
    assert_eq!((window.state().tools().mode, window.state().tools().tool), (BrushMode::Set, &BRUSH));
    stroke(&mut window, elsewhere, elsewhere);
    assert_eq!(risk_at(&window, elsewhere), risk);
    assert_eq!(entries(&window), 1, "picking changes nothing");
}

#[test]
fn alt_shows_the_value_under_the_pointer_before_it_is_picked() {
    let mut window = window();
    assert!(hover(&mut window, FREE).is_some_and(|tag| tag.starts_with('+')));
    window.event(Event::ModifiersChanged(Modifiers::ALT));
    window.run();
    assert_eq!((price_tag(&window), label(&window, "risk ")), (None, Some("risk 0".into())));
    key(&mut window, Modifiers::NONE, Key::T);
    window.event(Event::ModifiersChanged(Modifiers::ALT));
    window.run();
    assert_eq!(label(&window, "h̄ 0.2"), Some("h̄ 0.2 · level 0".into()));
}

#[test]
fn the_tag_says_why_a_dab_changes_nothing() {
    let mut window = window();
    let in_band = dvec2(0.3, 0.52);
    brush(&mut window, BrushCommand::Radius(0.01));
    assert_eq!(hover(&mut window, dvec2(-0.02, 0.5)).unwrap(), "no change: outside the domain");
    key(&mut window, Modifiers::NONE, Key::E);
    assert_eq!(hover(&mut window, FREE).unwrap(), "no change: nothing is painted here");
    key(&mut window, Modifiers::NONE, Key::T);
    brush(&mut window, BrushCommand::Diameter(0.15));
    assert_eq!(hover(&mut window, FREE).unwrap(), "no change: h̄ is coarser than the grid here");
    brush(&mut window, BrushCommand::Diameter(0.02));
    assert_eq!(hover(&mut window, in_band).unwrap(), "no change: “Painted risk” decides here");
    let base = with_base(&window, LayerKind::constant(0.01));
    send(&mut window, Command::from(EditCommand::Set(base)));
    send(&mut window, Command::from(EditCommand::EndGesture));
    assert_eq!(hover(&mut window, FREE).unwrap(), "no change: “Base” decides here");
}

#[test]
fn tag_and_hint_say_that_there_is_no_layer_to_paint_on() {
    let mut window = window();
    let layer = settings(&window).layers.iter().rfind(|layer| layer.paints().is_some()).unwrap().id;
    let mut tag = |command, hint: &str| {
        send(&mut window, Command::from(command));
        let tag = hover(&mut window, FREE).unwrap();
        assert!(window.query_by_label_contains(hint).is_some(), "{hint}");
        tag
    };
    let locked = tag(LayerCommand::Lock(layer, true), "a click offers to unlock it");
    assert_eq!(locked, "no change: “Painted risk” is locked");
    assert!(tag(LayerCommand::Lock(layer, false), "Drag to paint risk").starts_with('+'));
    let hidden = tag(LayerCommand::Show(layer, false), "a click offers to show it");
    assert_eq!(hidden, "no change: “Painted risk” is hidden");
    send(&mut window, Command::from(LayerCommand::Delete(layer)));
    assert_eq!(window.state().tools().kind, PaintKind::Diameter, "the layer that is selected now");
    brush(&mut window, BrushCommand::Kind(PaintKind::Risk));
    let deleted = hover(&mut window, FREE);
    assert!(window.query_by_label_contains("No layer takes this paint: a click offers one").is_some());
    assert_eq!(deleted.as_deref(), Some("no change: no layer for painted risk"));
    key(&mut window, Modifiers::NONE, Key::E);
    hover(&mut window, FREE);
    assert!(price_tag(&window).is_some());
}

#[test]
fn shift_shows_the_price_of_the_line_before_it_is_painted() {
    let mut window = window();
    stroke(&mut window, FREE, FREE);
    let end = FREE + dvec2(0.05, 0.4);
    window.event(Event::ModifiersChanged(Modifiers::SHIFT));
    let tag = hover(&mut window, end).unwrap();
    let before = triangles(&window) as i64;
    click(&mut window, end, Modifiers::SHIFT);
    let change = triangles(&window) as i64 - before;
    assert_eq!(tag, format!("+{} triangles", meshbrush_ui::widgets::format::count(change as u64)));
}

#[test]
fn a_mirrored_stroke_is_one_gesture_and_its_price_is_that_of_all_images() {
    let mut window = window();
    send(&mut window, Command::from(EditCommand::ClearPaint));
    open_popup(&mut window, "More options");
    for (name, menu) in [("Mirror x", "Mirror y"), ("Mirror y", "Mirror x")] {
        window.get_by_role_and_label(Role::CheckBox, name).click();
        window.run();
        assert!(window.query_by_role_and_label(Role::CheckBox, menu).is_some());
    }
    key(&mut window, Modifiers::NONE, Key::Escape);
    let (at, before) = (dvec2(0.2, 0.3), triangles(&window));
    let tag = hover(&mut window, at).unwrap();
    stroke(&mut window, at, at);
    let change = triangles(&window) - before;
    assert_eq!(tag, format!("+{} triangles", meshbrush_ui::widgets::format::count(change as u64)));
    for image in [dvec2(0.8, 0.3), dvec2(0.2, 0.7), dvec2(0.8, 0.7)] {
        assert_eq!(risk_at(&window, image), risk_at(&window, at));
    }
    assert_eq!(entries(&window), 2, "clearing, and one stroke");
}

#[test]
fn what_mirrors_strokes_is_on_the_strip_and_stops_with_a_click() {
    let mut window = window();
    assert!(window.query_by_role_and_label(Role::CheckBox, "Mirrored x").is_none());
    brush(&mut window, BrushCommand::MirrorX(true));
    brush(&mut window, BrushCommand::MirrorY(true));
    window.get_by_role_and_label(Role::CheckBox, "Mirrored x, y").click();
    window.run();
    assert_eq!(window.state().tools().mirrored, [false; 2]);
}

#[test]
fn a_preset_is_kept_named_used_and_removed() {
    let mut window = window();
    brush(&mut window, BrushCommand::Hardness(0.21));
    open_popup(&mut window, "More options");
    window.get_by_role_and_label(Role::Button, "Keep the brush as a preset").click();
    window.run();
    let name = window.get_by_role_and_label(Role::TextInput, "Name");
    assert_eq!(name.accesskit_node().value().as_deref(), Some("Brush 1"));
    key(&mut window, Modifiers::NONE, Key::Escape);
    brush(&mut window, BrushCommand::UsePreset(1));
    assert_eq!(window.state().tools().hardness, 1.0, "the hard edge");
    assert_eq!(window.state().tools().kind, PaintKind::Risk, "it leaves what is painted");
    brush(&mut window, BrushCommand::UsePreset(3));
    assert_eq!(window.state().tools().hardness, 0.21);
    open_popup(&mut window, "More options");
    window.get_by_role_and_label(Role::Button, "Remove the preset").click();
    window.run();
    assert_eq!(window.state().tools().presets().len(), 3);
    brush(&mut window, BrushCommand::UsePreset(9));
    assert_eq!(window.state().tools().hardness, 0.21, "there is no such preset");
}

#[test]
fn smoothing_ignores_a_trembling_hand_and_ends_where_the_pointer_does() {
    let mut window = window();
    send(&mut window, Command::from(EditCommand::ClearPaint));
    brush(&mut window, BrushCommand::Radius(0.01));
    brush(&mut window, BrushCommand::Smoothing(0.5));
    let start = dvec2(0.2, 0.5);
    press(&mut window, start, Modifiers::NONE);
    move_to(&mut window, start + dvec2(0.0, 0.03));
    assert_eq!(risk_at(&window, start + dvec2(0.0, 0.025)), 0.0, "within the length of the string");
    move_to(&mut window, start);
    move_to(&mut window, start + dvec2(0.5, 0.0));
    assert!(risk_at(&window, start + dvec2(0.3, 0.0)) > 0.0);
    assert_eq!(risk_at(&window, start + dvec2(0.49, 0.0)), 0.0, "the brush follows behind");
    release(&mut window, start + dvec2(0.5, 0.0));
    assert!(risk_at(&window, start + dvec2(0.49, 0.0)) > 0.0);
}

#[test]
fn the_pressure_of_a_pen_changes_the_radius_or_the_strength() {
    let mut window = window();
    send(&mut window, Command::from(EditCommand::ClearPaint));
    let changes = "Pen: strength";
    open_popup(&mut window, "More options");
    assert!(window.query_by_role_and_label(Role::CheckBox, changes).is_none(), "no pen yet");
    key(&mut window, Modifiers::NONE, Key::Escape);
    brush(&mut window, BrushCommand::Hardness(1.0));
    let pressed = |window: &mut Window, at: DVec2, force: f32| {
        let pos = on_screen(window, at);
        let touch =
            |phase, force| Event::Touch { device_id: TouchDeviceId(1), id: TouchId(1), phase, pos, force };
        window.event(touch(TouchPhase::Start, Some(force)));
        press(window, at, Modifiers::NONE);
        window.event(touch(TouchPhase::End, None));
        release(window, at);
    };
    let at = dvec2(0.3, 0.3);
    pressed(&mut window, at, 0.25);
    let rim = dvec2(0.0, 0.03);
    assert!(risk_at(&window, at) > 0.7 && risk_at(&window, at + rim) == 0.0, "a quarter of the radius");
    open_popup(&mut window, "More options");
    for name in ["Pen: radius", changes] {
        window.get_by_role_and_label(Role::CheckBox, name).click();
        window.run();
    }
    key(&mut window, Modifiers::NONE, Key::Escape);
    let at = dvec2(0.7, 0.3);
    pressed(&mut window, at, 0.25);
    assert!((risk_at(&window, at + rim) - 0.2).abs() < 1e-3, "a quarter of the strength");
    send(&mut window, Command::from(EditCommand::ClearPaint));
    brush(
        &mut window,
        BrushCommand::PenResponse(PenResponse {
            changes_radius: true,
            changes_strength: true,
            exponent: 0.5,
        }),
    );
    pressed(&mut window, at, 0.25);
    assert!((risk_at(&window, at) - 0.4).abs() < 1e-3, "the root of a quarter of the strength");
    assert_eq!(risk_at(&window, at + 1.2 * rim), 0.0, "and of the radius");
    brush(&mut window, BrushCommand::PenResponse(PenResponse::default()));
    let at = dvec2(0.3, 0.7);
    stroke(&mut window, at, at);
    assert!((risk_at(&window, at + rim) - 0.8).abs() < 1e-3, "the mouse has no pressure");
}
