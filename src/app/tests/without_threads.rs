//! A window whose system starts no threads, as in a browser: frames do the work of jobs.

use std::fs;
use std::path::Path;
use std::time::Duration;

use super::{Window, document, folder, send, window};
use meshbrush_core::document::Example;
use meshbrush_kit::kit::command::{Command, FileCommand};

/// Opens an example and writes files of it. Returns their contents.
fn written(window: &mut Window, example: Example, folder: &Path) -> Vec<Vec<u8>> {
    send(window, Command::from(FileCommand::OpenExample(example)));
    let (project, mesh) = (folder.join("saved.meshbrush"), folder.join("mesh.svg"));
    send(window, Command::from(FileCommand::SaveTo(project.clone())));
    send(window, Command::from(FileCommand::Export(mesh.clone())));
    window.state().jobs.wait_for_writing(Duration::from_secs(60));
    [project, mesh].iter().map(|file| fs::read(file).unwrap()).collect()
}

#[test]
fn without_threads_the_window_computes_and_writes_the_same() {
    for example in [Example::Aegean, Example::Path] {
        let mut with = window();
        with.state().jobs.wait_for_all();
        let expected = written(&mut with, example, &folder("app-without-threads", "with"));
        let mut without = window();
        without.state().jobs.do_without_threads();
        let found = written(&mut without, example, &folder("app-without-threads", "without"));
        assert!(expected == found, "{}: other files", example.name());
        let derived = |window: &Window| {
            let session = &window.state().session;
            session.derivation().current(session.follower()).is_some()
        };
        assert_eq!(derived(&without), derived(&with));
        assert_eq!(document(&without).settings(), document(&with).settings());
    }
}
