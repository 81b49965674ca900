//! Files being read and written beside the window: their progress, cancelling them, and closing the window
//! before they are done.
//!
//! Pipes make it slow: reading or writing one waits for the test.

use std::fs::{self, File};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::time::Duration;

use eframe::egui::accesskit::Role;
use eframe::egui::{ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::kittest::Queryable as _;

use super::{Window, document, paint, send, step_until, wait_for_jobs, wait_until, window};
use crate::app::features::domain::DomainCommand;
use meshbrush_io::io::project;
use meshbrush_kit::kit::command::{Command, FileCommand};

const QUESTION: &str = "Save changes to “Radar threats”?";

/// The title of the first example once it is edited.
const EDITED: &str = "Radar threats — edited";

fn folder(name: &str) -> PathBuf {
    super::folder("app-background", name)
}

fn pipe(path: PathBuf) -> PathBuf {
    assert!(process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    path
}

/// Opens a pipe for writing, which waits until the window reads it.
fn writer(pipe: &Path) -> File {
    File::options().write(true).open(pipe).unwrap()
}

fn message(window: &Window) -> String {
    window.state().session().notices().shown().map(|notice| notice.text.clone()).unwrap_or_default()
}

fn shows(window: &Window, label: &str) -> bool {
    window.query_by_label(label).is_some()
}

/// Returns whether there is a bar with that name.
fn has_bar(window: &Window, what: &str) -> bool {
    window.query_by_role_and_label(Role::ProgressIndicator, what).is_some()
}

fn cancel(window: &mut Window, what: &str) {
    window.get_by_role_and_label(Role::Button, &format!("Cancel: {what}")).click();
    window.run();
}

/// Returns the commands that the last frame sent to the desktop.
fn asked(window: &Window) -> &[ViewportCommand] {
    &window.output().viewport_output[&ViewportId::ROOT].commands
}

fn pause_before_next_frame(window: &Window) -> Duration {
    window.output().viewport_output[&ViewportId::ROOT].repaint_delay
}

/// Clicks the cross of the window, and returns whether the window stays.
fn close(window: &mut Window) -> bool {
    let viewport = window.input_mut().viewports.get_mut(&ViewportId::ROOT).unwrap();
    viewport.events.push(ViewportEvent::Close);
    window.step();
    asked(window).contains(&ViewportCommand::CancelClose)
}

/// Runs frames until the window is over; fails if it does not close.
fn wait_for_close(window: &mut Window) {
    step_until(window, |window| asked(window).contains(&ViewportCommand::Close));
    assert!(!close(window), "nothing is left that would be lost");
}

fn read_all(pipe: &Path) -> Vec<u8> {
    fs::read(pipe).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_read_shows_how_far_it_is_and_cancelled_it_changes_nothing() {
    let file = pipe(folder("read").join("coast.geojson"));
    let mut window = window();
    send(&mut window, Command::from(DomainCommand::Open(file.clone())));
    let mut coast = writer(&file);
    write!(coast, "{{\"type\": \"Polygon\", \"coordinates\": [[[0, 0], [1, 0]").unwrap();
    assert!(!has_bar(&window, "Reading coast.geojson"), "not for a moment");
    wait_until(&mut window, |window| has_bar(window, "Reading coast.geojson"));
    let pause = pause_before_next_frame(&window);
    assert!((Duration::from_millis(50)..Duration::from_secs(1)).contains(&pause), "{pause:?}");
    // The window continues meanwhile.
    paint(&mut window, 0.9);
    let version = document(&window).version();

    cancel(&mut window, "Reading coast.geojson");
    assert!(message(&window).contains("Reading coast.geojson was cancelled"), "{}", message(&window));
    assert!(!has_bar(&window, "Reading coast.geojson"));
    let pause = pause_before_next_frame(&window);
    assert!(pause > Duration::from_secs(2), "the window rests until the message fades: {pause:?}");
    // Nobody reads on.
    let mut bytes = 0;
    let end = loop {
        bytes += 1 << 12;
        match coast.write_all(&[b' '; 1 << 12]) {
            Ok(()) => assert!(bytes < 1 << 24, "it is read on and on"),
            Err(error) => break error,
        }
    };
    assert_eq!(end.kind(), ErrorKind::BrokenPipe);
    wait_for_jobs(&mut window);
    assert_eq!(document(&window).version(), version);
    assert!(shows(&window, EDITED));
}

#[test]
fn a_read_that_is_left_alone_is_opened() {
    let file = pipe(folder("whole").join("coast.geojson"));
    let mut window = window();
    send(&mut window, Command::from(DomainCommand::Open(file.clone())));
    let mut coast = writer(&file);
    wait_until(&mut window, |window| has_bar(window, "Reading coast.geojson"));
    write!(coast, "{{\"type\": \"Polygon\", \"coordinates\": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}}").unwrap();
    drop(coast);
    wait_until(&mut window, |window| shows(window, "coast"));
    assert!(!has_bar(&window, "Reading coast.geojson"));
}

#[test]
fn edits_are_asked_about_once_the_file_is_read() {
    let file = pipe(folder("asked").join("coast.geojson"));
    let mut window = window();
    paint(&mut window, 0.9);
    send(&mut window, Command::from(DomainCommand::Open(file.clone())));
    let mut coast = writer(&file);
    wait_until(&mut window, |window| has_bar(window, "Reading coast.geojson"));
    assert!(!shows(&window, QUESTION), "it is not clear yet that the file can be opened");
    write!(coast, "{{\"type\": \"Polygon\", \"coordinates\": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}}").unwrap();
    drop(coast);
    wait_until(&mut window, |window| shows(window, QUESTION));
    assert!(shows(&window, EDITED));
    window.get_by_label("Do not save").click();
    wait_until(&mut window, |window| shows(window, "coast"));
}

#[test]
fn a_cancelled_export_leaves_the_former_files() {
    let folder = folder("export");
    for ending in ["node", "ele", "neigh"] {
        fs::write(folder.join("mesh").with_extension(ending), format!("the former {ending}")).unwrap();
    }
    let last = pipe(folder.join("mesh.edge"));
    let before = names(&folder);
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Export(folder.join("mesh.node"))));
    wait_until(&mut window, |window| has_bar(window, "Writing mesh.node"));
    // This waits until the last of the four files is being written.
    let mut last = File::open(&last).unwrap();
    cancel(&mut window, "Writing mesh.node");
    assert!(has_bar(&window, "Cancelling mesh.node"), "the pipe is full");
    last.read_to_end(&mut Vec::new()).unwrap();
    wait_until(&mut window, |window| !message(window).is_empty());
    assert_eq!(message(&window), "Writing mesh.node was cancelled. The file that was there is unchanged.");
    assert!(!has_bar(&window, "Cancelling mesh.node"));
    assert_eq!(names(&folder), before);
    for ending in ["node", "ele", "neigh"] {
        let file = fs::read_to_string(folder.join("mesh").with_extension(ending)).unwrap();
        assert_eq!(file, format!("the former {ending}"));
    }
}

#[test]
fn a_window_that_is_closed_while_the_document_is_saved_closes_when_it_is() {
    for by_key in [false, true] {
        let file = pipe(folder(&format!("save-{by_key}")).join("a.meshbrush"));
        let mut window = window();
        paint(&mut window, 0.9);
        let painted = document(&window).paint().clone();
        send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
        if by_key {
            send(&mut window, Command::from(FileCommand::Quit));
        } else {
            assert!(close(&mut window), "the file is not written yet");
            window.run();
        }
        assert!(!shows(&window, QUESTION), "it is being saved");
        assert!(has_bar(&window, "Saving a.meshbrush"), "at once, because the user waits for it");
        assert!(message(&window).contains("closes as soon as") && message(&window).contains("a.meshbrush"));
        assert!(close(&mut window), "not even when asked twice");
        let saved = std::thread::spawn(move || read_all(&file));
        wait_for_close(&mut window);
        let saved = project::from_bytes(&saved.join().unwrap(), Path::new("a")).unwrap();
        assert!(*saved.into_document().unwrap().paint() == painted);
    }
}

#[test]
fn edits_made_while_the_document_is_saved_are_asked_about_before_the_window_closes() {
    let file = pipe(folder("edited").join("a.meshbrush"));
    let mut window = window();
    paint(&mut window, 0.9);
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    assert!(close(&mut window));
    window.run();
    paint(&mut window, 0.8);
    let saved = std::thread::spawn(move || read_all(&file));
    wait_until(&mut window, |window| shows(window, "Save changes to “a”?"));
    assert!(!saved.join().unwrap().is_empty());
}

#[test]
fn a_cancelled_save_leaves_the_document_unsaved_and_the_window_open() {
    let file = pipe(folder("cancelled").join("a.meshbrush"));
    let mut window = window();
    paint(&mut window, 0.9);
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    assert!(close(&mut window));
    window.run();
    cancel(&mut window, "Saving a.meshbrush");
    let saved = std::thread::spawn(move || read_all(&file));
    wait_until(&mut window, |window| message(window).contains("Saving a.meshbrush was cancelled"));
    assert!(shows(&window, EDITED));
    assert!(project::from_bytes(&saved.join().unwrap(), Path::new("a")).is_err());
    assert!(close(&mut window), "it is asked first");
    window.run();
    assert!(shows(&window, QUESTION));
}

#[test]
fn what_is_saved_again_after_cancelling_is_saved() {
    let folder = folder("again");
    let (slow, file) = (pipe(folder.join("slow.meshbrush")), folder.join("a.meshbrush"));
    let mut window = window();
    paint(&mut window, 0.9);
    send(&mut window, Command::from(FileCommand::SaveTo(slow.clone())));
    wait_until(&mut window, |window| has_bar(window, "Saving slow.meshbrush"));
    cancel(&mut window, "Saving slow.meshbrush");
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    let reader = std::thread::spawn(move || read_all(&slow));
    wait_until(&mut window, |window| shows(window, "a"));
    assert!(project::read(&file).is_ok());
    reader.join().unwrap();
}

#[test]
fn what_is_saved_while_the_document_is_saved_is_saved_next_and_then_it_is_left() {
    let file = folder("next").join("a.meshbrush");
    let mut window = window();
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    wait_until(&mut window, |window| shows(window, "a"));
    fs::remove_file(&file).unwrap();
    let file = pipe(file);
    paint(&mut window, 0.9);
    send(&mut window, Command::from(FileCommand::Save));
    paint(&mut window, 0.8);
    send(&mut window, Command::from(FileCommand::New));
    // What is being saved lacks the last stroke.
    window.get_by_label("Save").click();
    window.run();
    assert!(!document(&window).paint().is_blank());
    // Open for writing too, so that it does not end between the two.
    let mut drain = File::options().read(true).write(true).open(&file).unwrap();
    std::thread::spawn(move || std::io::copy(&mut drain, &mut std::io::sink()));
    wait_until(&mut window, |window| document(window).paint().is_blank());
    assert!(message(&window).is_empty(), "{}", message(&window));
}

#[test]
fn a_window_that_is_closed_during_an_export_waits_for_it_or_until_it_is_cancelled() {
    for cancelled in [false, true] {
        let file = pipe(folder(&format!("closing-{cancelled}")).join("mesh.csv"));
        let mut window = window();
        send(&mut window, Command::from(FileCommand::Export(file.clone())));
        assert!(close(&mut window), "the file is not written yet");
        window.run();
        assert!(has_bar(&window, "Writing mesh.csv") && message(&window).contains("mesh.csv"));
        if cancelled {
            // Nothing reads the pipe: the window must not wait for it.
            window.get_by_role_and_label(Role::Button, "Cancel: Writing mesh.csv").click();
            wait_for_close(&mut window);
            read_all(&file);
        } else {
            let written = std::thread::spawn(move || read_all(&file));
            wait_for_close(&mut window);
            assert!(written.join().unwrap().starts_with(b"triangle,level"));
        }
    }
}

#[test]
fn an_export_that_fails_keeps_the_window_open_to_say_so() {
    let file = pipe(folder("failing").join("mesh.csv"));
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Export(file.clone())));
    assert!(close(&mut window));
    window.run();
    // Somebody reads a little of it and goes away.
    File::open(&file).unwrap().read_exact(&mut [0; 10]).unwrap();
    wait_until(&mut window, |window| message(window).contains("could not be written"));
    for _ in 0..10 {
        window.step();
        assert!(!asked(&window).contains(&ViewportCommand::Close));
    }
}
