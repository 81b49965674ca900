//! Messages on the canvas: how long they stay.

use std::time::Duration;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, ViewportId, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::{
    RESTING_PLACE, Window, folder, notice, paint, scratch, send, set, step_until, wait_for_notice,
    wait_until, window,
};
use crate::app::App;
use meshbrush_core::document::Setting;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, ShellCommand};

/// Lets the window show frames for some seconds of its own time.
fn wait_seconds(window: &mut Window, seconds: f32) {
    for _ in 0..(4.0 * seconds) as usize {
        window.step();
    }
}

fn pause_before_next_frame(window: &Window) -> Duration {
    window.output().viewport_output[&ViewportId::ROOT].repaint_delay
}

fn export(window: &mut Window, name: &str) {
    send(window, Command::from(FileCommand::Export(scratch(name))));
    assert!(wait_for_notice(window).contains("written"));
}

#[test]
fn news_fade_and_the_window_sleeps_meanwhile() {
    let mut window = window();
    window.hover_at(RESTING_PLACE);
    window.run();
    export(&mut window, "messages.obj");
    window.run();
    let pause = pause_before_next_frame(&window);
    assert!((Duration::from_secs(2)..=Duration::from_secs(5)).contains(&pause), "{pause:?}");
    wait_seconds(&mut window, 3.0);
    assert_ne!(notice(&window), "");
    wait_seconds(&mut window, 3.0);
    assert_eq!(notice(&window), "");
    window.run();
    assert_eq!(pause_before_next_frame(&window), Duration::MAX, "the window rests");
}

#[test]
fn news_stay_under_the_pointer() {
    let mut window = window();
    export(&mut window, "messages-pointer.obj");
    window.run();
    let at = window.get_by_role(Role::Alert).rect().center();
    window.event(Event::PointerMoved(at));
    wait_seconds(&mut window, 10.0);
    assert_ne!(notice(&window), "");
    window.event(Event::PointerMoved(RESTING_PLACE));
    wait_seconds(&mut window, 1.0);
    assert_ne!(notice(&window), "");
    wait_seconds(&mut window, 3.0);
    assert_eq!(notice(&window), "");
}

#[test]
fn a_failed_edit_is_forgotten_with_the_next_edit() {
    let mut window = window();
    set(&mut window, Setting::Spacing(-1.0));
    assert!(!notice(&window).is_empty());
    wait_seconds(&mut window, 8.0);
    assert!(!notice(&window).is_empty(), "a failure does not fade");
    paint(&mut window, 0.9);
    assert_eq!(notice(&window), "");
    set(&mut window, Setting::Spacing(-1.0));
    assert!(!notice(&window).is_empty());
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(notice(&window), "");
}

#[test]
fn news_stays_long_enough_to_be_read() {
    let mut window = window();
    for (length, seconds) in [(40, 5.0), (280, 20.0)] {
        send(&mut window, Command::from(ShellCommand::Tell("a".repeat(length))));
        wait_seconds(&mut window, seconds - 1.0);
        assert!(!notice(&window).is_empty(), "{length} characters are not read in {seconds} s");
        wait_seconds(&mut window, 3.0);
        assert_eq!(notice(&window), "", "{length} characters");
    }
}

#[test]
fn a_file_that_cannot_be_opened_is_forgotten_once_another_one_is() {
    let folder = folder("app-messages", "files");
    let good = folder.join("sea.geojson");
    let triangle = r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}"#;
    std::fs::write(&good, triangle).unwrap();
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Open(folder.join("missing.geojson"))));
    assert!(wait_for_notice(&mut window).contains("missing.geojson"));
    paint(&mut window, 0.9);
    assert!(!notice(&window).is_empty(), "an edit does not change what failed");
    send(&mut window, Command::from(EditCommand::Undo));
    send(&mut window, Command::from(FileCommand::Open(good)));
    wait_until(&mut window, |window| window.query_by_label("What is the file to be?").is_some());
    super::click_button(&mut window, "Open");
    wait_until(&mut window, |window| notice(window).is_empty());
    wait_until(&mut window, |window| super::document(window).settings().name == "sea");
}

/// Returns a window that was started with a file.
fn started_with(file: std::path::PathBuf) -> Window {
    let mut window = Harness::builder()
        .with_size(vec2(1440.0, 900.0))
        .with_max_steps(4000)
        .build_eframe(|cc| App::with_file(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), file).unwrap());
    window.step();
    window
}

#[test]
fn a_file_given_at_start_is_the_first_that_is_shown() {
    let folder = folder("app-messages", "start");
    let file = folder.join("sea.geojson");
    let triangle = r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}"#;
    std::fs::write(&file, triangle).unwrap();
    let mut window = started_with(file);
    step_until(&mut window, |window| {
        let name = super::document(window).settings().name.clone();
        assert!(name == "Untitled" || name == "sea", "{name}");
        assert_eq!(window.state().starts_with_file, name == "Untitled", "no mesh until the file is read");
        name == "sea"
    });

    let mut window = started_with(folder.join("missing.geojson"));
    assert!(wait_for_notice(&mut window).contains("missing.geojson"));
    assert!(!window.state().starts_with_file && super::document(&window).settings().name == "Untitled");
}
