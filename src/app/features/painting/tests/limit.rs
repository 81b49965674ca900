//! Painting below the smallest diameter of the document, and the offer to lower it.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use crate::app::tests::{
    FREE, PAINTED_DIAMETER, Window, click_button, entries, hover, key, move_to, on_screen, painted, send,
    settings, stroke, triangles, type_into, value_of, window,
};
use meshbrush_kit::kit::command::{BrushCommand, Command, EditCommand, ViewCommand};
use meshbrush_kit::kit::tools::PaintKind;
use meshbrush_ui::widgets::format;

const LOWER: &str = "Lower the smallest diameter";
const LOWER_BOTH: &str = "Lower it and the risk curve";

/// Paints a third of the smallest diameter in a small place that is free.
fn window_painted_finer() -> (Window, f64) {
    let mut window = window();
    let smallest = settings(&window).transfer.h_min;
    send(&mut window, Command::from(BrushCommand::Kind(PaintKind::Diameter)));
    send(&mut window, Command::from(BrushCommand::Radius(0.01)));
    type_into(&mut window, "Diameter value", &format!("{}", smallest / 3.0));
    stroke(&mut window, FREE, FREE);
    (window, smallest)
}

fn offers(window: &Window, button: &str) -> bool {
    window.query_by_role_and_label(Role::Button, button).is_some()
}

#[test]
fn the_brush_paints_below_the_smallest_diameter_and_offers_to_lower_it() {
    let (mut window, smallest) = window_painted_finer();
    let diameter = f64::from(painted(&window, PAINTED_DIAMETER, FREE));
    assert!((3.0 * diameter / smallest - 1.0).abs() < 1e-6, "painted as it was typed: {diameter}");
    assert!(window.query_by_label_contains("You painted").is_some());
    let before = (triangles(&window), settings(&window).transfer);
    let at_risk = window
        .state()
        .session()
        .follower()
        .field()
        .target_at(window.state().session().document().paint(), dvec2(0.3, 0.5));
    click_button(&mut window, LOWER);
    let after = settings(&window).transfer;
    assert_eq!(
        (after.h_min, after.h_risk),
        (window.state().tools().diameter, before.1.h_risk),
        "the curve stays"
    );
    assert!(triangles(&window) > before.0 && !offers(&window, LOWER));
    let still = window
        .state()
        .session()
        .follower()
        .field()
        .target_at(window.state().session().document().paint(), dvec2(0.3, 0.5));
    assert_eq!(still, at_risk, "where risk decides, nothing changes");
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!((triangles(&window), settings(&window).transfer), before, "one gesture");
}

#[test]
fn the_offer_is_beside_the_brush_however_large_that_is() {
    for zoom in [1.0, 40.0] {
        let (mut window, _) = window_painted_finer();
        send(&mut window, Command::from(ViewCommand::LookAt(FREE)));
        send(&mut window, Command::from(ViewCommand::Zoom(zoom)));
        let offer = window.get_by_role_and_label(Role::Button, LOWER).rect();
        let apart = offer.left() - on_screen(&window, FREE).x;
        assert!((5.0..200.0).contains(&apart), "{apart} points from the middle of the brush");
    }
}

#[test]
fn the_offer_says_the_price_of_both_ways() {
    for (button, elsewhere) in [(LOWER, false), (LOWER_BOTH, true)] {
        let (mut window, _) = window_painted_finer();
        let prices: Vec<String> =
            window.query_all_by_label_contains("triangles here").filter_map(|label| label.value()).collect();
        let before = triangles(&window);
        let text = &prices[usize::from(elsewhere)];
        click_button(&mut window, button);
        let change = (triangles(&window) - before) as i64;
        match elsewhere {
            false => assert_eq!(*text, format!("{} triangles here, none elsewhere", format::change(change))),
            true => assert!(text.contains(" elsewhere") && !text.contains("none elsewhere"), "{text}"),
        }
    }
}

#[test]
fn the_offer_can_be_declined_and_goes_with_what_was_painted() {
    let (mut window, smallest) = window_painted_finer();
    click_button(&mut window, "Not now");
    assert!(!offers(&window, LOWER) && settings(&window).transfer.h_min == smallest);
    stroke(&mut window, FREE, FREE);
    assert!(offers(&window, LOWER), "painted again");
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!offers(&window, LOWER));
    let strokes = entries(&window);
    stroke(&mut window, FREE + dvec2(0.03, 0.0), FREE + dvec2(0.03, 0.0));
    assert!(offers(&window, LOWER) && entries(&window) == strokes + 1);
    send(&mut window, Command::from(EditCommand::Undo));
    assert!(!offers(&window, LOWER), "what was painted is gone");
}

#[test]
fn the_limit_is_named_where_it_decides() {
    let (mut window, smallest) = window_painted_finer();
    let tag = hover(&mut window, FREE).unwrap();
    let limit = format::length(smallest, settings(&window).unit);
    assert_eq!(tag, format!("no change: the smallest diameter, {limit}, limits it"));
    assert_eq!(value_of(&window, Role::Definition, "by"), "smallest diameter");
    move_to(&mut window, dvec2(0.3, 0.5));
    assert_eq!(value_of(&window, Role::Definition, "by"), "Painted risk");
    send(&mut window, Command::from(ViewCommand::Fit));
    key(&mut window, Modifiers::NONE, Key::Q);
    crate::app::tests::click(&mut window, FREE, Modifiers::NONE);
    assert_eq!(value_of(&window, Role::Definition, "Decided by"), "smallest diameter");
    let why = "by the smallest diameter of the document: the layer “Painted diameter” asks for less there.";
    assert!(window.query_by_label_contains(why).is_some(), "the explanation says so");
}
