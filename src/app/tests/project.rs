//! Saving, opening and the questions before something would be lost, in the window, by role and label.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::{Kept, Window, document, paint, send, show, wait_until, window};
use meshbrush_core::document::{Example, Setting, Settings, Stage};
use meshbrush_io::io::journal::{self, Journal, Left};
use meshbrush_io::io::project::{self, Project};
use meshbrush_io::io::{Meter, recipe, recording};
use meshbrush_kit::kit::command::{
    BrushCommand, Command, EditCommand, FileCommand, LayerCommand, ShellCommand,
};
use meshbrush_mesh::mesh::Fingerprint;

/// The title of the first example once it is edited.
const EDITED: &str = "Radar threats — edited";

fn folder(name: &str) -> PathBuf {
    super::folder("app-project", name)
}

fn key(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run();
}

fn press(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    window.run();
}

/// Waits for something that jobs bring about, and for the mesh.
#[track_caller]
fn wait(window: &mut Window, is_so: impl Fn(&Window) -> bool) {
    wait_until(window, |window| is_so(window) && window.state().session().stage() == Stage::InStep);
}

fn shows(window: &Window, label: &str) -> bool {
    window.query_by_label(label).is_some()
}

fn fingerprint(window: &Window) -> Fingerprint {
    window.state().session().mesh().fingerprint()
}

#[test]
fn what_is_saved_by_key_is_opened_with_the_same_mesh() {
    let file = folder("save").join("threats");
    let mut window = window();
    paint(&mut window, 0.9);
    assert!(shows(&window, EDITED));
    key(&mut window, Modifiers::COMMAND, Key::S);
    assert!(shows(&window, "Save project"), "a new document has no file yet");
    window.get_by_role_and_label(Role::TextInput, "Path").type_text(file.to_str().unwrap());
    window.run();
    press(&mut window, "Save");
    // The ending is added.
    let saved = file.with_extension("meshbrush");
    wait(&mut window, |window| shows(window, "threats"));
    assert!(project::read(&saved).unwrap().paint() == document(&window).paint());

    let (before, bytes) = (fingerprint(&window), fs::read(&saved).unwrap());
    paint(&mut window, 0.8);
    assert!(shows(&window, "threats — edited") && fingerprint(&window) != before);
    send(&mut window, Command::from(EditCommand::Undo));
    assert!(shows(&window, "threats"), "undone to what is saved");
    send(&mut window, Command::from(EditCommand::Redo));
    key(&mut window, Modifiers::COMMAND, Key::S);
    wait(&mut window, |window| shows(window, "threats"));
    assert!(fs::read(&saved).unwrap() != bytes);

    fs::write(&saved, &bytes).unwrap();
    send(&mut window, Command::from(FileCommand::Open(saved.clone())));
    wait(&mut window, |window| document(window).history().is_empty());
    assert_eq!(fingerprint(&window), before);
    assert!(shows(&window, "threats"));
}

#[test]
fn edits_after_the_start_of_saving_stay_unsaved() {
    let file = folder("during").join("a.meshbrush");
    let mut window = window();
    send(&mut window, Command::from(BrushCommand::BeginStroke(dvec2(0.9, 0.5))));
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    let saved = document(&window).paint().clone();
    paint(&mut window, 0.8);
    wait(&mut window, |window| shows(window, "a — edited"));
    assert!(*project::read(&file).unwrap().paint() == saved);
    assert!(saved != *document(&window).paint());
}

#[test]
fn unsaved_edits_are_asked_about() {
    let file = folder("asked").join("b.meshbrush");
    let question = "Save changes to “Radar threats”?";
    let shown = show(Settings { spacing: 0.3, ..Settings::default() });
    let leaves = [
        Command::from(FileCommand::New),
        Command::from(FileCommand::OpenExample(Example::Diamond)),
        shown,
        Command::from(FileCommand::Quit),
    ];
    for leave in leaves {
        let mut window = window();
        send(&mut window, leave.clone());
        assert!(!shows(&window, question), "nothing is unsaved");
        send(&mut window, Command::from(FileCommand::OpenExample(Example::Threats)));
        paint(&mut window, 0.9);
        let before = document(&window).version();
        send(&mut window, leave.clone());
        assert!(shows(&window, question), "{leave:?}");
        press(&mut window, "Cancel");
        assert_eq!(document(&window).version(), before);
        send(&mut window, leave.clone());
        press(&mut window, "Do not save");
        assert!(!shows(&window, question));
        assert_eq!(document(&window).version() == before, leave == Command::from(FileCommand::Quit));
    }
    // Saved first, and then left.
    let mut window = window();
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    wait(&mut window, |window| shows(window, "b"));
    paint(&mut window, 0.9);
    let painted = document(&window).paint().clone();
    send(&mut window, Command::from(FileCommand::New));
    press(&mut window, "Save");
    wait(&mut window, |window| document(window).paint().is_blank());
    assert!(*project::read(&file).unwrap().paint() == painted);
    // A new document has no file: nothing is written over.
    paint(&mut window, 0.5);
    key(&mut window, Modifiers::COMMAND, Key::S);
    assert!(shows(&window, "Save project"));
}

#[test]
fn edits_are_asked_about_before_unsaved_work_is_restored() {
    let folder = folder("restored");
    let left = Example::Diamond.without_data();
    let journal = Journal::begin(&folder, Project::of(&left), None, 1, &Meter::default()).unwrap();
    drop(journal);
    let mut window = window();
    window.state_mut().keep_journal_in(folder);
    let (offer, question) = ("Restore unsaved work?", "Save changes to “Radar threats”?");
    wait(&mut window, |window| shows(window, offer));
    paint(&mut window, 0.9);
    let painted = document(&window).version();
    press(&mut window, "Restore");
    assert!(shows(&window, question) && !shows(&window, offer));
    press(&mut window, "Cancel");
    assert!(shows(&window, offer), "it is still offered");
    assert_eq!(document(&window).version(), painted);
    press(&mut window, "Restore");
    press(&mut window, "Do not save");
    assert!(!shows(&window, offer) && !shows(&window, question));
    assert_eq!(document(&window).settings(), left.settings());
    assert!(document(&window).history().is_empty() && shows(&window, "The report's diamond — edited"));
}

#[test]
fn a_journal_that_cannot_be_read_is_named() {
    let folder = folder("unreadable");
    let file = folder.join("1-0.journal");
    fs::write(&file, "MBJOUR99 of another program").unwrap();
    let mut window = window();
    window.state_mut().keep_journal_in(folder);
    let told = |window: &Window| window.state().session().notices().shown().map(|shown| shown.text.clone());
    wait(&mut window, |window| told(window).is_some());
    let text = told(&window).unwrap();
    assert!(text.contains(file.to_str().unwrap()) && text.contains("another version"), "{text}");
    assert!(file.exists());
}

#[test]
fn a_journal_that_cannot_be_written_is_told() {
    // Where the folder should be, there is a file: as on a disk that takes no journal.
    let taken = folder("taken").join("file");
    fs::write(&taken, "").unwrap();
    let mut window = window();
    window.state_mut().keep_journal_in(taken.join("journals"));
    send(&mut window, Command::from(FileCommand::New));
    paint(&mut window, 0.9);
    let told = |window: &Window| window.state().session().notices().shown().map(|shown| shown.text.clone());
    wait(&mut window, |window| told(window).is_some());
    let text = told(&window).unwrap();
    assert!(text.starts_with("Unsaved work is no longer kept in case of a crash: "), "{text}");
    assert!(text.ends_with("Save the project from time to time."), "{text}");
}

#[test]
fn the_journal_keeps_edits_while_the_painted_layer_is_hidden() {
    let (live, copied) = (folder("hidden"), folder("hidden-copy"));
    let mut window = window();
    window.state_mut().keep_journal_in(live.clone());
    send(&mut window, Command::from(FileCommand::New));
    paint(&mut window, 0.9);
    let painted = document(&window).active_layer().unwrap().id;
    send(&mut window, Command::from(LayerCommand::Show(painted, false)));
    paint(&mut window, 0.4);
    let hidden = |settings: &Settings| settings.layer(painted).is_some_and(|layer| !layer.visible);
    assert!(hidden(document(&window).settings()));
    let kept = kept(&mut window, &live, &copied, |project| hidden(&project.settings));
    assert!(kept.paint == *document(&window).paint() && kept.settings == *document(&window).settings());
}

/// Waits until the journals in `live` have a project of some kind, and returns it. The journal of a window
/// that is open is locked; a copy of it in `copied` is not, as after a kill.
fn kept(window: &mut Window, live: &Path, copied: &Path, is_meant: impl Fn(&Project) -> bool) -> Project {
    let kept = RefCell::new(None);
    wait_until(window, |_| {
        for entry in fs::read_dir(live).unwrap().flatten() {
            fs::copy(entry.path(), copied.join(entry.file_name())).unwrap();
        }
        if let Some(Left::Work(work)) = journal::left(copied).next()
            && is_meant(&work.project)
        {
            kept.replace(Some(work.project));
        }
        kept.borrow().is_some()
    });
    kept.into_inner().unwrap()
}

#[test]
fn gestures_in_quick_succession_are_kept_in_little_and_nothing_is_done_after_them() {
    let (live, copied) = (folder("succession"), folder("succession-copy"));
    let mut window = window();
    window.state_mut().keep_journal_in(live.clone());
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Threats)));
    paint(&mut window, 0.9);
    let painted = document(&window).active_layer().unwrap().id;
    let length = || -> u64 {
        fs::read_dir(&live).unwrap().flatten().map(|entry| entry.metadata().unwrap().len()).sum()
    };
    let layers = document(&window).settings().layers.len();
    kept(&mut window, &live, &copied, |project| project.settings.layers.len() == layers);
    let before = length();
    for _ in 0..20 {
        send(&mut window, Command::from(LayerCommand::Duplicate(painted)));
    }
    let kept = kept(&mut window, &live, &copied, |project| project.settings.layers.len() == layers + 20);
    assert!(kept.paint == *document(&window).paint() && kept.settings == *document(&window).settings());
    let after = length();
    assert!(after - before < 20_000, "{} bytes", after - before);
    (0..10).for_each(|_| _ = window.run());
    assert_eq!(length(), after, "nothing is written at rest");
}

#[test]
fn a_file_that_is_there_is_not_replaced_without_a_question() {
    let file = folder("replace").join("c.meshbrush");
    fs::write(&file, "somebody's").unwrap();
    let mut window = window();
    send(&mut window, Command::from(FileCommand::SaveAs(file.clone())));
    press(&mut window, "Cancel");
    assert_eq!(fs::read(&file).unwrap(), b"somebody's");
    send(&mut window, Command::from(FileCommand::SaveAs(file.clone())));
    press(&mut window, "Replace");
    wait(&mut window, |window| shows(window, "c"));
    assert!(project::read(&file).is_ok());
}

#[test]
fn a_document_is_saved_as_a_recipe_and_files_beside_it_are_asked_about() {
    let folder = folder("recipe");
    let file = folder.join("c.toml");
    let beside = folder.join("c-paint.meshbrush");
    fs::write(&beside, "somebody's").unwrap();
    let mut window = window();
    send(&mut window, Command::from(FileCommand::SaveRecipeAs(folder.join("c"))));
    press(&mut window, "Cancel");
    assert!(fs::read(&beside).unwrap() == b"somebody's" && !file.exists());
    send(&mut window, Command::from(FileCommand::SaveRecipeAs(file.clone())));
    press(&mut window, "Replace");
    wait(&mut window, |_| file.exists());
    let recipe = recipe::read(&file).unwrap();
    assert!(
        recipe.settings.layer.len() == 2 && project::read(&beside).is_ok(),
        "{:?}",
        recipe.settings.layer
    );
}

#[test]
fn a_session_is_exported_as_a_test_that_replays() {
    let file = folder("test").join("threats.jsonl");
    let mut window = window();
    paint(&mut window, 0.9);
    send(&mut window, Command::from(EditCommand::Set(Setting::SmallestDiameter(0.004))));
    send(&mut window, Command::from(EditCommand::EndGesture));
    send(&mut window, Command::from(EditCommand::Undo));
    send(&mut window, Command::from(EditCommand::Set(Setting::Spacing(1e-9))));
    send(&mut window, Command::from(FileCommand::ExportTestAs(file.with_extension(""))));
    wait(&mut window, |_| file.exists());
    let replayed = recording::read(&file).unwrap().replay(&Meter::default()).unwrap();
    assert_eq!((replayed.edits, replayed.difference), (3, None), "what was refused is no edit");
    assert_eq!(replayed.triangles, window.state().session().mesh().triangle_count());
    // A document that is opened has a recording of its own.
    let before = fs::read(&file).unwrap();
    send(&mut window, Command::from(FileCommand::ExportTestAs(file.clone())));
    press(&mut window, "Cancel");
    assert_eq!(fs::read(&file).unwrap(), before);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Diamond)));
    press(&mut window, "Do not save");
    send(&mut window, Command::from(FileCommand::ExportTest(file.clone())));
    wait(&mut window, |_| fs::read(&file).unwrap() != before);
    let replayed = recording::read(&file).unwrap().replay(&Meter::default()).unwrap();
    assert_eq!((replayed.edits, replayed.triangles), (0, 9560));
}

#[test]
fn what_cannot_be_opened_or_saved_is_told_and_changes_nothing() {
    let folder = folder("bad");
    let mut sound = Vec::new();
    project::write(&mut sound, &Project::of(&Example::Threats.without_data())).unwrap();
    let bad: [(&str, &[u8], &str); 4] = [
        ("cut.meshbrush", &sound[..sound.len() / 2], "cut off"),
        ("empty.meshbrush", b"", "empty"),
        ("text.txt", b"hello", ".meshbrush"),
        ("picture.meshbrush", b"\x89PNG", "not a Meshbrush project"),
    ];
    let mut window = window();
    let version = document(&window).version();
    for (name, bytes, word) in bad {
        let file = folder.join(name);
        fs::write(&file, bytes).unwrap();
        send(&mut window, Command::from(FileCommand::Open(file)));
        let message =
            |window: &Window| window.state().session().notices().shown().map(|notice| notice.text.clone());
        wait(&mut window, |window| message(window).is_some_and(|text| text.contains(name)));
        let text = message(&window).unwrap();
        assert!(text.contains(word), "{text}");
    }
    assert_eq!(document(&window).version(), version);
    paint(&mut window, 0.9);
    send(&mut window, Command::from(FileCommand::SaveTo(folder.join("no-such-folder").join("d.meshbrush"))));
    // The message about the last file may still be shown.
    let failed = |window: &Window| {
        let shown = window.state().session().notices().shown();
        shown.is_some_and(|notice| notice.failed && notice.text.contains("no-such-folder"))
    };
    wait(&mut window, failed);
    assert!(shows(&window, EDITED), "it is not saved");
    // A file that cannot be opened raises no question about edits.
    send(&mut window, Command::from(ShellCommand::Escape));
    send(&mut window, Command::from(FileCommand::Open(folder.join("cut.meshbrush"))));
    let message = |window: &Window| {
        window.state().session().notices().shown().is_some_and(|n| n.text.contains("cut off"))
    };
    wait(&mut window, message);
    assert!(!shows(&window, "Save changes to “Radar threats”?") && shows(&window, EDITED));
    send(&mut window, Command::from(FileCommand::Quit));
    assert!(shows(&window, "Save changes to “Radar threats”?"));
}

/// A file as the desktop hands it over.
#[derive(Debug)]
pub(super) struct Dropped(pub PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        unreachable!("files are opened by their path")
    }
}

#[test]
fn files_can_be_dropped_and_recent_ones_are_in_the_menu() {
    let file = folder("recent").join("dropped.meshbrush");
    let mut bytes = Vec::new();
    project::write(&mut bytes, &Project::of(&Example::Diamond.without_data())).unwrap();
    fs::write(&file, bytes).unwrap();
    let mut window = window();
    window.input_mut().dropped_files.push(Arc::new(Dropped(file)));
    window.run();
    wait(&mut window, |window| shows(window, "dropped"));
    assert_eq!(window.state().session().mesh().triangle_count(), 9560);
    press(&mut window, "File");
    assert!(shows(&window, "Open recent dropped.meshbrush"));
}

#[test]
fn the_brush_is_kept_before_the_end_and_has_its_share_of_every_domain() {
    let (mut first, mut next, mut stored) = (window(), window(), Kept::default());
    let share = |window: &Window| window.state().tools().kept_brush()[0];
    let tools = &mut first.state_mut().tools;
    (tools.radius, tools.hardness, tools.erase_strength) = (1.5 * tools.radius, 0.9, 0.3);
    first.state_mut().store_brush(&mut stored);
    for example in [Example::Diamond, Example::Threats] {
        send(&mut next, Command::from(FileCommand::OpenExample(example)));
        next.state_mut().load_brush(&stored);
        send(&mut next, Command::from(FileCommand::OpenExample(Example::Threats)));
        let tools = next.state().tools();
        assert_eq!((tools.hardness, tools.erase_strength), (0.9, 0.3));
        assert!((share(&next) / share(&first) - 1.0).abs() < 1e-12);
    }
    let tools = &mut first.state_mut().tools;
    tools.hardness = 0.77;
    assert!(tools.chosen_preset().is_none() && tools.keep_preset());
    tools.rename_preset(3, "Surf zone");
    tools.remove_preset(0);
    first.state_mut().store_brush(&mut stored);
    next.state_mut().load_brush(&stored);
    let tools = &mut next.state_mut().tools;
    let names: Vec<&str> = tools.presets().iter().map(|preset| &*preset.name).collect();
    assert_eq!(names, ["Hard edge", "Fine tip", "Surf zone"], "presets are kept, too");
    tools.use_preset(1);
    assert_eq!((tools.hardness, tools.chosen_preset()), (0.6, Some(1)));
    tools.use_preset(2);
    assert_eq!((tools.hardness, tools.chosen_preset()), (0.77, Some(2)));
    tools.hardness = 0.9;
    eframe::Storage::set_string(&mut stored, "brush", "(-3.0,0.5,0.5,0.5,0.5,0.5)".into());
    next.state_mut().load_brush(&stored);
    assert_eq!(next.state().tools().hardness, 0.9, "no slider has such a radius");
}
