//! Painting, erasing, undo.

use std::time::Duration;

use eframe::egui::{self, Event, Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use crate::app::tests::{
    CTRL_SHIFT, FREE, entries, fingerprint, key, level_at, move_to, on_screen, press, release, send, stroke,
    triangles, window,
};
use meshbrush_kit::kit::command::{BrushCommand, Command};
use meshbrush_kit::kit::tools::PaintKind;

#[test]
fn the_mesh_refines_under_the_brush_while_the_button_is_still_down() {
    let mut window = window();
    let (before, level) = (triangles(&window), level_at(&window, FREE));
    press(&mut window, FREE, Modifiers::NONE);
    let at_press = triangles(&window);
    assert!(at_press > before + 200, "{before} triangles before, {at_press} with the brush down");
    assert!(level_at(&window, FREE) >= level + 6);
    move_to(&mut window, FREE - dvec2(0.1, 0.0));
    let after_move = triangles(&window);
    assert!(after_move > at_press + 200, "{at_press} at first, {after_move} after a move");
    assert!(window.state().session().document().stroke().is_some(), "the brush is still down");
    release(&mut window, FREE - dvec2(0.1, 0.0));
    assert_eq!(triangles(&window), after_move, "lifting the brush changes nothing");
}

#[test]
fn the_eraser_coarsens_back() {
    let mut window = window();
    let before = fingerprint(&window);
    stroke(&mut window, FREE, FREE);
    assert_ne!(fingerprint(&window), before);
    key(&mut window, Modifiers::NONE, Key::E);
    window.state_mut().send(Command::from(BrushCommand::Hardness(1.0)));
    send(&mut window, Command::from(BrushCommand::Radius(0.09)));
    stroke(&mut window, FREE, FREE);
    assert_eq!(fingerprint(&window), before, "all of the paint is gone, and so is all that it refined");
}

#[test]
fn a_stroke_is_one_entry_and_undo_and_redo_restore_the_very_mesh() {
    let mut window = window();
    let before = fingerprint(&window);
    stroke(&mut window, FREE, FREE - dvec2(0.15, 0.05));
    let once = fingerprint(&window);
    assert_eq!(entries(&window), 1);
    stroke(&mut window, dvec2(0.05, 0.05), dvec2(0.3, 0.05));
    let twice = fingerprint(&window);
    assert_eq!(entries(&window), 2);
    for (modifiers, expected) in [
        (Modifiers::COMMAND, once),
        (Modifiers::COMMAND, before),
        (CTRL_SHIFT, once),
        (CTRL_SHIFT, twice),
        (Modifiers::COMMAND, once),
    ] {
        key(&mut window, modifiers, Key::Z);
        assert_eq!(fingerprint(&window), expected);
    }
}

#[test]
fn a_painted_diameter_is_the_diameter_of_the_mesh() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::T);
    assert_eq!(window.state().tools().kind, PaintKind::Diameter);
    send(&mut window, Command::from(BrushCommand::Diameter(0.02)));
    stroke(&mut window, FREE, FREE);
    let mesh = window.state().session().mesh();
    let diameter = mesh.diameter(level_at(&window, FREE));
    assert!(diameter <= 0.02 && diameter > 0.02 / 1.5, "{diameter}");
}

#[test]
fn escape_gives_the_stroke_up() {
    let mut window = window();
    let before = fingerprint(&window);
    press(&mut window, FREE, Modifiers::NONE);
    assert_ne!(fingerprint(&window), before);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(fingerprint(&window), before);
    move_to(&mut window, FREE - dvec2(0.1, 0.1));
    release(&mut window, FREE - dvec2(0.1, 0.1));
    assert_eq!((fingerprint(&window), entries(&window)), (before, 0));
}

#[test]
fn a_button_that_was_let_go_unseen_does_not_paint_on() {
    let mut window = window();
    press(&mut window, FREE, Modifiers::NONE);
    window.event(Event::PointerGone);
    window.event(Event::WindowFocused(false));
    window.run();
    window.event(Event::WindowFocused(true));
    window.run();
    let painted = fingerprint(&window);
    move_to(&mut window, FREE - dvec2(0.2, 0.2));
    assert_eq!(fingerprint(&window), painted);
    assert_eq!(entries(&window), 1, "the stroke ended where it was last seen");
}

#[test]
fn a_hundred_idle_frames_do_nothing() {
    let mut window = window();
    window.event(Event::PointerMoved(on_screen(&window, FREE)));
    window.run();
    let generation = window.state().session().follower().revision();
    let revision = window.state().session().document().revision();
    for frame in 0..100 {
        window.step();
        let delay = window.output().viewport_output[&egui::ViewportId::ROOT].repaint_delay;
        assert_eq!(delay, Duration::MAX, "frame {frame} asks for another");
    }
    assert_eq!(entries(&window), 0);
    assert_eq!(window.state().session().follower().revision(), generation);
    assert_eq!(window.state().session().document().revision(), revision);
}

#[test]
fn a_stroke_makes_the_title_say_edited() {
    let mut window = window();
    stroke(&mut window, FREE, FREE);
    assert!(window.query_by_label("Radar threats — edited").is_some());
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(window.query_by_label("Radar threats").is_some());
}
