//! A project that somebody else changes, in another window or with another program.

use std::fs;
use std::path::{Path, PathBuf};

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

use super::{Window, document, notice, paint, send, wait_until, window};
use meshbrush_core::document::{Example, Settings};
use meshbrush_io::io::project::{self, Project};
use meshbrush_kit::kit::command::{Command, FileCommand};

fn folder(name: &str) -> PathBuf {
    super::folder("app-other-window", name)
}

fn press(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    window.run();
}

fn asks(window: &Window, file: &Path) -> bool {
    window.query_by_label(&format!("Replace {}?", file.display())).is_some()
}

fn open(window: &mut Window, file: &Path) {
    send(window, Command::from(FileCommand::Open(file.to_owned())));
    wait_until(window, |window| window.state().project.path() == Some(file));
}

fn save(window: &mut Window, file: &Path) {
    send(window, Command::from(FileCommand::Save));
    wait_until(window, |window| {
        asks(window, file) || !window.state().project.is_edited(window.state().session())
    });
}

/// Paints, and returns what is painted.
fn painted(window: &mut Window, x: f64) -> meshbrush_core::layers::PaintLayers {
    paint(window, x);
    document(window).paint().clone()
}

fn write(file: &Path, settings: Settings) {
    let project = Project { settings, paint: Default::default() };
    let mut bytes = Vec::new();
    project::write(&mut bytes, &project).unwrap();
    fs::write(file, bytes).unwrap();
}

#[test]
fn a_project_that_somebody_changed_is_not_replaced_without_a_question() {
    let file = folder("changed").join("a.meshbrush");
    write(&file, Settings::default());
    let mut window = window();
    open(&mut window, &file);
    paint(&mut window, 0.9);
    save(&mut window, &file);
    assert!(!asks(&window, &file), "nobody else wrote it");

    let others = Settings { name: "theirs".into(), ..Settings::default() };
    write(&file, others.clone());
    let last = painted(&mut window, 0.5);
    save(&mut window, &file);
    assert!(asks(&window, &file));
    press(&mut window, "Cancel");
    assert_eq!(*project::read(&file).unwrap().settings(), others);
    assert!(window.query_by_label("a — edited").is_some());
    // Saved before the document closes: the question comes first, and what was to be done waits for it.
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Diamond)));
    press(&mut window, "Save");
    wait_until(&mut window, |window| asks(window, &file));
    assert!(*document(&window).paint() == last);
    press(&mut window, "Replace");
    wait_until(&mut window, |window| document(window).paint().is_blank());
    assert!(*project::read(&file).unwrap().paint() == last);
    // A file that is gone is written again.
    open(&mut window, &file);
    fs::remove_file(&file).unwrap();
    paint(&mut window, 0.2);
    save(&mut window, &file);
    assert!(!asks(&window, &file) && file.exists());
}

#[test]
fn a_read_only_project_is_not_replaced_without_a_question() {
    let file = folder("read-only").join("a.meshbrush");
    let _ = fs::remove_file(&file); // of an earlier run
    write(&file, Settings::default());
    let mut permissions = fs::metadata(&file).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&file, permissions).unwrap();
    let mut window = window();
    open(&mut window, &file);
    let last = painted(&mut window, 0.9);
    save(&mut window, &file);
    assert!(asks(&window, &file));
    press(&mut window, "Cancel");
    assert!(project::read(&file).unwrap().paint().is_blank());
    save(&mut window, &file);
    press(&mut window, "Replace");
    wait_until(&mut window, |window| !window.state().project.is_edited(window.state().session()));
    assert!(*project::read(&file).unwrap().paint() == last);
    // It stays read-only, so the next one is a question, too; also where another document is saved there.
    paint(&mut window, 0.5);
    save(&mut window, &file);
    assert!(asks(&window, &file));
    press(&mut window, "Cancel");
    send(&mut window, Command::from(FileCommand::New));
    press(&mut window, "Do not save");
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    wait_until(&mut window, |window| asks(window, &file));
    assert!(*project::read(&file).unwrap().paint() == last);
}

#[test]
fn two_windows_with_one_project_know_of_each_other() {
    let (locks, file) = (folder("locks"), folder("both").join("a.meshbrush"));
    write(&file, Settings::default());
    let mut windows = [window(), window()];
    for window in &mut windows {
        window.state_mut().project.keep_claims_in(locks.clone());
    }
    let [first, second] = &mut windows;
    open(first, &file);
    assert_eq!(notice(first), "");
    open(second, &file);
    assert!(notice(second).contains("a.meshbrush is open in another window"), "{}", notice(second));
    // The one that came first saves; the other one is asked, and again because the file is another one then.
    paint(first, 0.9);
    save(first, &file);
    let theirs = project::read(&file).unwrap().paint().clone();
    assert!(!asks(first, &file) && theirs == *document(first).paint());
    let ours = painted(second, 0.5);
    save(second, &file);
    assert!(asks(second, &file));
    press(second, "Cancel");
    assert!(*project::read(&file).unwrap().paint() == theirs);
    save(second, &file);
    press(second, "Replace");
    wait_until(second, |window| !window.state().project.is_edited(window.state().session()));
    assert!(*project::read(&file).unwrap().paint() == ours);
    paint(first, 0.7);
    save(first, &file);
    assert!(asks(first, &file), "the other window changed it");
    press(first, "Cancel");
    // When one has another document, the other one is alone.
    send(first, Command::from(FileCommand::New));
    press(first, "Do not save");
    paint(second, 0.4);
    save(second, &file);
    assert!(!asks(second, &file));
    open(first, &file);
    assert!(notice(first).contains("in another window"), "{}", notice(first));
}
