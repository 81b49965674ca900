//! Results of work beside the window belong to the document that was open when it began. Pipes make the work
//! slow: the test opens another document before it ends.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process;

use egui_kittest::kittest::Queryable as _;

use super::{Window, document, notice, paint, send, wait_until, window};
use crate::app::features::domain::DomainCommand;
use crate::app::features::paths::{KeepOutCommand, PathCommand};
use crate::app::features::picture::PictureCommand;
use crate::app::features::threats::ThreatsCommand;
use meshbrush_io::io::project;
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};

const SQUARE: &str =
    r#"{"type": "Polygon", "coordinates": [[[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.2]]]}"#;
const GRID: &str = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n0.1 0.2\n0.3 0.4\n";
const THREATS: &str = "x,y,range,peak\n0.5,0.5,0.1,0.9\n";
const PICTURE: &[u8] = include_bytes!("../../../assets/icon.png");

/// The name of a file, what is in it, and the command that reads it.
type Case<'a> = (&'a str, &'a [u8], fn(PathBuf) -> Command);

fn pipe(test: &str, name: &str) -> PathBuf {
    let path = super::folder("app-identity", test).join(name);
    assert!(process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    path
}

fn new_document(window: &mut Window) {
    send(window, Command::from(FileCommand::New));
    wait_until(window, |window| document(window).history().is_empty());
    assert_eq!(notice(window), "");
}

#[test]
fn what_is_read_for_one_document_does_not_change_the_next_one() {
    let keep_out = |path| Command::from(PathCommand::KeepOut(KeepOutCommand::Open(path)));
    let cases: [Case<'_>; 10] = [
        ("mask.geojson", SQUARE.as_bytes(), |path| Command::from(LayerCommand::OpenMask(path))),
        ("outline.geojson", SQUARE.as_bytes(), |path| Command::from(DomainCommand::AddOutline(path))),
        ("shapes.geojson", SQUARE.as_bytes(), |path| Command::from(LayerCommand::OpenShapes(path))),
        ("other.geojson", SQUARE.as_bytes(), |path| Command::from(LayerCommand::ReplaceShapes(path))),
        ("region.geojson", SQUARE.as_bytes(), keep_out),
        ("threats.csv", THREATS.as_bytes(), |path| Command::from(ThreatsCommand::Open(path))),
        ("risk.asc", GRID.as_bytes(), |path| Command::from(LayerCommand::OpenImage(path))),
        ("diameters.asc", GRID.as_bytes(), |path| Command::from(LayerCommand::OpenDiameters(path))),
        ("band.asc", GRID.as_bytes(), |path| Command::from(LayerCommand::OpenBand(path))),
        ("traced.png", PICTURE, |path| Command::from(PictureCommand::Open(path))),
    ];
    let mut window = window();
    for (name, content, command) in cases {
        let file = pipe(name, name);
        send(&mut window, command(file.clone()));
        let mut writer = File::options().write(true).open(&file).unwrap();
        new_document(&mut window);
        let before = document(&window).settings().clone();
        writer.write_all(content).unwrap();
        drop(writer);
        wait_until(&mut window, |window| !notice(window).is_empty());
        let told = notice(&window);
        assert!(told.starts_with(name) && told.contains("for the document that was open before"), "{told}");
        assert_eq!(*document(&window).settings(), before, "{name}");
        assert!(document(&window).history().is_empty(), "{name}");
    }
}

#[test]
fn a_save_that_ends_in_another_document_does_not_give_it_the_file() {
    let file = pipe("saved", "a.meshbrush");
    let mut window = window();
    let saved = document(&window).settings().clone();
    send(&mut window, Command::from(FileCommand::SaveTo(file.clone())));
    new_document(&mut window);
    paint(&mut window, 0.3);
    let written = fs::read(&file).unwrap();
    wait_until(&mut window, |window| !notice(window).is_empty());
    assert!(notice(&window).starts_with("The document that was open before was saved to "));
    assert_eq!(project::from_bytes(&written, Path::new("a")).unwrap().settings, saved);
    assert!(window.query_by_label("Untitled — edited").is_some());
    // The new document has no file: it is asked for one.
    send(&mut window, Command::from(FileCommand::Save));
    assert!(window.query_by_label("Save project").is_some());
}

#[test]
fn a_document_that_is_saved_while_the_former_one_is_has_its_own_file() {
    let slow = pipe("both", "a.meshbrush");
    let own = slow.with_file_name("b.meshbrush");
    let mut window = window();
    send(&mut window, Command::from(FileCommand::SaveTo(slow.clone())));
    // A second save of the former document waits behind the first one, and is given up with it.
    paint(&mut window, 0.9);
    send(&mut window, Command::from(FileCommand::SaveTo(slow.with_file_name("c.meshbrush"))));
    send(&mut window, Command::from(FileCommand::New));
    window.get_by_label("Do not save").click();
    window.run();
    paint(&mut window, 0.3);
    let painted = document(&window).paint().clone();
    send(&mut window, Command::from(FileCommand::SaveTo(own.clone())));
    fs::read(&slow).unwrap();
    wait_until(&mut window, |window| window.query_by_label("b").is_some());
    assert!(*project::read(&own).unwrap().paint() == painted);
    assert!(!slow.with_file_name("c.meshbrush").exists());
}

#[test]
fn a_file_that_is_a_document_of_its_own_is_opened_all_the_same() {
    let file = pipe("opened", "coast.geojson");
    let mut window = window();
    send(&mut window, Command::from(DomainCommand::Open(file.clone())));
    let mut writer = File::options().write(true).open(&file).unwrap();
    new_document(&mut window);
    writer.write_all(SQUARE.as_bytes()).unwrap();
    drop(writer);
    wait_until(&mut window, |window| window.query_by_label("coast").is_some());
}
