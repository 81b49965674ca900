//! Work that takes many frames.

use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::{
    FREE, PAINTED_RISK, Window, button_event, fingerprint, key, level_at, notice, on_screen, painted,
    release_at, send, set, stroke, triangles, value_of, window, window_with,
};
use meshbrush_core::document::{Document, Example, Follower, Setting, Stage};
use meshbrush_kit::kit::busy::MOMENT;
use meshbrush_kit::kit::command::{Command, EditCommand};

/// A smallest diameter that makes the first example's mesh have about two million triangles.
const TWO_MILLIONS: f64 = 0.00025;

/// Returns a window as on a screen: frames that are longer have more time for the mesh.
fn at_60_frames_a_second(size: Vec2) -> Window {
    window_with(Harness::builder().with_size(size).with_step_dt(1.0 / 60.0))
}

/// Makes the first example's mesh have about two million triangles, which is asked for first.
fn set_two_millions(window: &mut Window) {
    set(window, Setting::DiameterAtRiskOne(TWO_MILLIONS));
    agree(window);
}

fn agree(window: &mut Window) {
    assert!(window.state().session().question().is_some(), "so many triangles are asked for");
    send(window, Command::from(EditCommand::ApplyAnyway));
}

/// Runs as few frames as possible until the progress of long work is shown.
fn show_progress(window: &mut Window) {
    window.step();
    std::thread::sleep(MOMENT + Duration::from_millis(50));
    window.step();
    assert!(window.query_by_label("Cancel").is_some(), "no progress is shown");
}

#[test]
fn the_former_mesh_is_shown_until_the_new_one_is_whole() {
    let mut window = at_60_frames_a_second(vec2(1440.0, 900.0));
    set_two_millions(&mut window);
    let (before, generation) = (fingerprint(&window), window.state().session().follower().revision());
    // Layers and limits are followed in place; another grid is another mesh.
    window.state_mut().send(Command::from(EditCommand::Set(Setting::Spacing(1.0 / 23.0))));
    window.step();
    let mut frames = 0;
    while window.state().session().stage() != Stage::InStep {
        assert_eq!(window.state().session().follower().revision(), generation);
        assert_eq!(fingerprint(&window), before, "not a part of the new mesh is shown");
        window.step();
        frames += 1;
    }
    assert!(frames > 5, "so much work is spread over more than {frames} frames");
    assert!(triangles(&window) > 1_500_000, "{}", triangles(&window));
    assert_eq!(window.state().session().follower().revision(), generation + 1);
}

#[test]
fn in_a_small_window_nothing_covers_the_button_that_cancels() {
    let mut window = at_60_frames_a_second(vec2(900.0, 600.0));
    window.state_mut().send(Command::from(EditCommand::Set(Setting::DiameterAtRiskOne(1e-4))));
    show_progress(&mut window);
    assert!(window.query_by_label_contains("Drag to paint risk").is_none(), "the hint makes room");
}

#[test]
fn cancel_gives_a_long_update_up_and_the_next_edit_takes_it_up_again() {
    let mut window = at_60_frames_a_second(vec2(1440.0, 900.0));
    set_two_millions(&mut window);
    let before = fingerprint(&window);
    window.state_mut().send(Command::from(EditCommand::Set(Setting::Spacing(1.0 / 23.0))));
    show_progress(&mut window);
    assert!(window.query_by_role(Role::ProgressIndicator).is_some());
    window.get_by_role_and_label(Role::Button, "Cancel").click();
    window.run();
    assert_eq!(window.state().session().stage(), Stage::GaveUp(None));
    assert_eq!(fingerprint(&window), before);
    assert!(notice(&window).contains("not updated"), "{}", notice(&window));
    assert!(window.query_by_label("Cancel").is_none());
    for _ in 0..40 {
        window.step();
    }
    assert!(notice(&window).contains("not updated"), "the message stays as long as it is true");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(notice(&window), "");
    assert_eq!(fingerprint(&window), before);
    stroke(&mut window, FREE, FREE);
    assert_ne!(fingerprint(&window), before);
}

#[test]
fn one_slice_of_work_is_small_however_much_there_is_to_do() {
    const VISITS: usize = 2048;
    let mut document = Example::Threats.without_data();
    let mut follower = Follower::new(&mut document).unwrap();
    document.set(Setting::DiameterAtRiskOne(TWO_MILLIONS)).unwrap();
    // The mesh that is there grows in place.
    let (mut last, mut most, mut slices) = (follower.mesh().raw_triangle_count(), 0, 0);
    loop {
        match follower.advance(&mut document, VISITS).unwrap() {
            Stage::InStep => break,
            Stage::Indexing | Stage::Checking => {}
            stage @ (Stage::Copying { .. } | Stage::GaveUp(_)) => panic!("{stage:?}"),
            Stage::Refining { triangles } => {
                most = most.max(triangles.saturating_sub(last.max(1200)));
                last = triangles;
            }
        }
        slices += 1;
    }
    assert!(last > 1_000_000 && slices > 500, "{last} triangles in {slices} slices");
    // A visit bisects a triangle, its neighbour, and now and then a chain of them.
    assert!(most <= 4 * VISITS, "{most} triangles in one slice of {VISITS} visits");
}

#[test]
fn a_long_stroke_never_waits_for_the_mesh() {
    let mut window = window();
    window.state_mut().send(Command::from(EditCommand::Set(Setting::DiameterAtRiskOne(TWO_MILLIONS))));
    window.step();
    let from = on_screen(&window, FREE);
    window.event(Event::PointerMoved(from));
    window.event(button_event(from, PointerButton::Primary, true, Modifiers::NONE));
    for i in 0..10 {
        window.event(Event::PointerMoved(from - vec2(8.0 * i as f32, 0.0)));
    }
    window.step();
    let document: &Document = window.state().session().document();
    assert!(document.stroke().is_some());
    assert!(painted(&window, PAINTED_RISK, FREE - dvec2(0.05, 0.0)) > 0.1, "paint does not wait");
    release_at(&mut window, from, PointerButton::Primary);
    agree(&mut window);
    assert!(level_at(&window, FREE) > 10);
}

#[test]
fn the_time_of_an_update_is_that_on_the_clock_with_a_unit() {
    let mut window = window();
    let update = |window: &Window| value_of(window, Role::Definition, "update");
    let has_unit = |text: &str| [" ms", " s"].iter().any(|unit| text.trim_end_matches('…').ends_with(unit));
    let began = Instant::now();
    window.state_mut().send(Command::from(EditCommand::Set(Setting::DiameterAtRiskOne(TWO_MILLIONS))));
    window.step();
    assert_ne!(window.state().session().stage(), Stage::InStep);
    assert!(update(&window).ends_with('…') && has_unit(&update(&window)), "{}", update(&window));
    // What is drawn between the slices takes time, too.
    std::thread::sleep(Duration::from_millis(300));
    window.run();
    assert_eq!(update(&window), "waits");
    agree(&mut window);
    assert!(has_unit(&update(&window)), "{}", update(&window));
    let measured = window.state().session().last_update().unwrap();
    assert!(measured >= Duration::from_millis(300) && measured <= began.elapsed(), "{measured:?}");
    stroke(&mut window, FREE, FREE);
    let stroke = window.state().session().last_update().unwrap();
    assert!(stroke < measured, "{stroke:?}: the time of another update");
}
