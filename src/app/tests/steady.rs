//! Nothing moves under the pointer, and nothing takes a click that was meant for what has just vanished.

use eframe::egui::accesskit::Role;
use eframe::egui::{Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::{
    RESTING_PLACE, TALL, Window, canvas, press_at, release_at, select_base, send, type_into, window_with,
};
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_kit::kit::notices::Offer;

fn quick_window() -> Window {
    window_with(Harness::builder().with_size(TALL).with_step_dt(0.02))
}

/// Returns the places of all sliders, numbers and lists of the panel.
fn places(window: &Window) -> Vec<Rect> {
    let roles = [Role::Slider, Role::TextInput, Role::ComboBox, Role::CheckBox];
    roles.into_iter().flat_map(|role| window.query_all_by_role(role)).map(|node| node.rect()).collect()
}

#[test]
fn a_sentence_about_a_field_moves_nothing_and_covers_no_control() {
    let mut window = quick_window();
    select_base(&mut window);
    let before = places(&window);
    for (field, text) in
        [("Hardness value", "3"), ("h_min value", "wide"), ("Target diameter h̄(x, y)", "sqr(")]
    {
        type_into(&mut window, field, text);
        window.run_steps(60);
        let said = window.query_all_by_role(Role::Alert).map(|node| node.rect()).collect::<Vec<_>>();
        assert!(!said.is_empty(), "{field}");
        let middles = |places: &[Rect]| places.iter().map(Rect::center).collect::<Vec<_>>();
        // A field that is typed into is a little narrower.
        assert_eq!(middles(&places(&window)), middles(&before), "{field}");
        for place in said {
            assert!(before.iter().all(|control| !control.intersects(place)), "{field}: {place:?}");
            assert!(place.right() <= canvas(&window).right(), "{field}: {place:?}");
        }
    }
}

/// Presses and releases the primary button, and returns whether a stroke began.
fn click_paints(window: &mut Window, at: Pos2) -> bool {
    press_at(window, at, PointerButton::Primary, Modifiers::NONE);
    let paints = window.state().session().document().stroke().is_some();
    release_at(window, at, PointerButton::Primary);
    paints
}

#[test]
fn the_place_of_a_vanished_button_takes_no_click_for_half_a_second() {
    let mut window = quick_window();
    let offer = Offer { label: "Try again", command: Command::from(EditCommand::EndGesture) };
    window.state_mut().session.notices_mut().report_with_offer("It failed.", offer);
    window.run();
    let button = window.get_by_role_and_label(Role::Button, "Try again").rect().center();
    window.hover_at(button);
    window.run();
    send(&mut window, Command::from(meshbrush_kit::kit::command::ShellCommand::DismissNotice));
    assert!(window.query_by_label("Try again").is_none());
    assert!(!click_paints(&mut window, button), "the click was meant for the button");
    assert!(click_paints(&mut window, button + vec2(0.0, 80.0)), "elsewhere the canvas takes clicks");
    window.hover_at(RESTING_PLACE);
    window.run_steps(30);
    assert!(click_paints(&mut window, button), "half a second later");
}
