//! Opening recipes in the window, by role and label.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::project::Dropped;
use super::{Window, document, fingerprint, notice, send, stroke, wait_for_notice, wait_until, window};
use meshbrush_core::document::{Document, Follower};
use meshbrush_io::io::{Meter, recipe};
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};

/// Returns a recipe in a folder of its own, whose layer reads a file beside it.
fn recipe_in(name: &str, text: &str) -> PathBuf {
    let folder = super::folder("app-recipes", name);
    fs::write(folder.join("depth.asc"), "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n")
        .unwrap();
    let file = folder.join("strait.toml");
    fs::write(&file, text).unwrap();
    file
}

const STRAIT: &str = "[mesh]\nspacing = 0.2\n[limits]\nh_max = 0.4\n\
                      [[layer]]\nname = \"Shallow\"\nkind = \"band\"\nfile = \"depth.asc\"\n\
                      between = [0, 1.5]\ndiameter = 0.05\n";

fn shows(window: &Window, label: &str) -> bool {
    window.query_by_label(label).is_some()
}

fn is_open(window: &Window) -> bool {
    shows(window, "strait") && window.state().session().follower().is_in_step(document(window))
}

fn opened_by_itself(file: &Path) -> Document {
    recipe::open(file, &Meter::default()).unwrap().document
}

#[test]
fn a_dropped_recipe_opens_as_a_new_document_that_has_no_file() {
    let file = recipe_in("drop", STRAIT);
    let mut window = window();
    window.input_mut().dropped_files.push(Arc::new(Dropped(file.clone())));
    window.run();
    wait_until(&mut window, is_open);
    let expected = Follower::new(&mut opened_by_itself(&file)).unwrap().mesh().fingerprint();
    assert_eq!(fingerprint(&window), expected);
    let layers = &document(&window).settings().layers;
    assert!(layers.len() == 1 && layers[0].name == "Shallow");
    assert!(window.state().project.path().is_none());
    assert_eq!(window.state().project.recent(), [file]);

    // Saving asks for the name of a project.
    window.key_press_modifiers(Modifiers::COMMAND, Key::S);
    window.run();
    assert!(shows(&window, "Save project"));
    window.get_by_role_and_label(Role::TextInput, "Path");
}

#[test]
fn a_recipe_is_opened_by_name_and_edits_are_asked_about() {
    let file = recipe_in("open", STRAIT);
    let mut window = window();
    stroke(&mut window, dvec2(0.1, 0.1), dvec2(0.2, 0.1));
    send(&mut window, Command::from(FileCommand::Open(file)));
    wait_until(&mut window, |window| shows(window, "Do not save"));
    window.get_by_role_and_label(Role::Button, "Do not save").click();
    window.run();
    wait_until(&mut window, is_open);
}

#[test]
fn the_files_of_a_recipe_are_written_together_and_saved_with_it() {
    let outputs = "[[output]]\nfile = \"strait.vtu\"\n\n[[output]]\nfile = \"strait.msh\"\nbinary = true\n";
    let file = recipe_in("outputs", &format!("{STRAIT}{outputs}"));
    let folder = file.parent().unwrap();
    for name in ["strait.vtu", "strait.msh", "again.toml"] {
        _ = fs::remove_file(folder.join(name));
    }
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Open(file.clone())));
    wait_until(&mut window, is_open);
    assert!(notice(&window).contains("keys for strait.msh"), "{}", notice(&window));
    let written = |window: &mut Window| {
        send(window, Command::from(FileCommand::ExportAgain));
        wait_until(window, |window| window.state().background.rows(true).is_empty());
        window.run();
    };
    written(&mut window);
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    let first = bytes("strait.vtu");
    assert!(!first.is_empty() && !bytes("strait.msh").is_empty());
    send(&mut window, Command::from(FileCommand::Export(folder.join("strait.2dm"))));
    wait_for_notice(&mut window);
    fs::write(folder.join("strait.vtu"), "old").unwrap();
    written(&mut window);
    assert_eq!(bytes("strait.vtu"), first, "what this window wrote is replaced without a question");

    send(&mut window, Command::from(FileCommand::SaveRecipe(folder.join("again.toml"))));
    wait_until(&mut window, |window| window.state().background.rows(true).is_empty());
    let saved = String::from_utf8(bytes("again.toml")).unwrap();
    let at = saved.find("[[output]]").unwrap();
    let expected = "[[output]]\nfile = \"strait.vtu\"\n\n[[output]]\nfile = \"strait.msh\"\nbinary = true\n\n[[output]]\nfile = \"strait.2dm\"\n";
    assert_eq!(saved[at..], *expected);
    send(&mut window, Command::from(FileCommand::New));
    assert_eq!(window.state().project.exports.paths().len(), 0, "another document has its own");
}

#[test]
fn files_of_a_recipe_that_exist_are_replaced_after_a_question_only() {
    let file = recipe_in("asked", &format!("{STRAIT}[[output]]\nfile = \"asked.vtu\"\n"));
    let target = file.with_file_name("asked.vtu");
    fs::write(&target, "of somebody else").unwrap();
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Open(file)));
    wait_until(&mut window, is_open);
    send(&mut window, Command::from(FileCommand::ExportAgain));
    assert_eq!(fs::read_to_string(&target).unwrap(), "of somebody else");
    window.get_by_role_and_label(Role::Button, "Replace").click();
    window.run();
    wait_until(&mut window, |window| window.state().background.rows(true).is_empty());
    assert!(fs::metadata(&target).unwrap().len() > 1000);
}

#[test]
fn a_mistake_in_a_recipe_is_reported_with_line_and_column() {
    let mut window = window();
    let before = fingerprint(&window);
    for (name, text, words) in [
        ("key", "[mesh]\nspacng = 1\n", "strait.toml, line 2, column 1: there is no key `spacng` here"),
        (
            "file",
            "[[layer]]\nkind = \"band\"\nfile = \"no.asc\"\nbetween = [0, 1]\ndiameter = 2\n",
            "strait.toml, line 3, column 1: the file",
        ),
        ("fine", "[mesh]\nspacing = 1e-4\n", "spacing"),
    ] {
        send(&mut window, Command::from(FileCommand::Open(recipe_in(name, text))));
        let message = wait_for_notice(&mut window);
        assert!(message.contains(words), "{message}");
        send(&mut window, Command::from(ShellCommand::Escape));
    }
    assert_eq!(fingerprint(&window), before);
}
