//! The program in a browser: what exists for it only is little, and in one place.

use std::fs;

use crate::ROOT;
use crate::source::{read_src, read_texts};

/// The folders with what exists only for browsers.
const FOLDERS: [&str; 2] = ["src/app/web", "web"];
/// Most lines in them.
const MOST_LINES: usize = 1500;
/// Most places elsewhere that ask for which system they are compiled.
const MOST_PLACES: usize = 10;

#[test]
fn what_exists_for_browsers_only_is_in_two_folders_and_short() {
    let mut lines = 0;
    for folder in FOLDERS {
        for entry in fs::read_dir(format!("{ROOT}/{folder}")).unwrap() {
            lines += fs::read_to_string(entry.unwrap().path()).unwrap().lines().count();
        }
    }
    assert!((100..MOST_LINES).contains(&lines), "{lines} lines in {FOLDERS:?}");
}

#[test]
fn few_places_elsewhere_ask_whether_they_are_compiled_for_a_browser() {
    let mut places = Vec::new();
    for (path, text) in read_texts() {
        let asks = |line: &&str| line.contains("target_family") || line.contains("target_arch");
        let count = text.lines().filter(asks).count();
        if !FOLDERS.iter().any(|folder| path.starts_with(&format!("{folder}/"))) {
            places.extend((0..count).map(|_| path.clone()));
        }
    }
    assert!((1..MOST_PLACES).contains(&places.len()), "{places:?}");
}

#[test]
fn the_window_reads_one_clock() {
    // std's clock panics in a browser.
    let forbidden = ["Instant", "SystemTime", "UNIX_EPOCH"];
    let of_window = ["src/app/", "crates/kit/", "crates/ui/"];
    let is_of_window = |path: &str| of_window.iter().any(|folder| path.starts_with(folder));
    for file in read_src().iter().filter(|file| is_of_window(&file.path)) {
        for path in file.paths() {
            let names_std = path.segments.starts_with(&["std".to_owned(), "time".to_owned()]);
            let named = path.segments.get(2).filter(|name| names_std && forbidden.contains(&name.as_str()));
            assert!(named.is_none(), "{}:{} names a clock of std; use kit/clock.rs", file.path, path.line);
        }
    }
}
