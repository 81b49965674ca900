//! The documents for developers stay short, and name files that exist.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::ROOT;

/// The folders with files that a page can name.
const TOP: [&str; 11] = [
    "assets",
    "benches",
    "crates",
    "docs",
    "fuzz",
    "javascript",
    "packaging",
    "python",
    "src",
    "tests",
    "web",
];

fn read(page: &str) -> String {
    fs::read_to_string(format!("{ROOT}/{page}")).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// Returns the pages that name files of the source.
fn pages() -> Vec<String> {
    let decisions = fs::read_dir(format!("{ROOT}/docs/decisions")).unwrap();
    let names = decisions.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let decisions = names.map(|name| format!("docs/decisions/{name}"));
    ["ARCHITECTURE.md", "tests/README.md"].map(str::to_owned).into_iter().chain(decisions).collect()
}

/// Returns the paths of all files and folders that a page can name, relative to the root of the repository.
fn paths() -> Vec<String> {
    let mut paths = Vec::new();
    let mut folders: Vec<PathBuf> = TOP.iter().map(|top| Path::new(ROOT).join(top)).collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            paths.push(path.strip_prefix(ROOT).unwrap().to_str().unwrap().replace('\\', "/"));
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    paths
}

/// Returns what looks like the path of a file or a folder: words in backticks with a `/` or an ending.
fn named_files(page: &str) -> BTreeSet<String> {
    let words = page.split('`').skip(1).step_by(2);
    let is_path = |word: &&str| {
        let is_plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "/_.-".contains(c));
        let has_ending =
            [".rs", ".py", ".md", ".mjs", ".wgsl", ".toml", ".txt"].iter().any(|end| word.ends_with(end));
        is_plain && !word.starts_with(['/', '.', '-']) && (has_ending || word.contains('/'))
    };
    words.filter(is_path).map(str::to_owned).collect()
}

#[test]
fn documents_stay_short() {
    for (page, most) in [("ARCHITECTURE.md", 250), ("README.md", 130)] {
        let lines = read(page).lines().count();
        assert!(lines <= most, "{page} has {lines} lines, and at most {most} are allowed");
    }
}

#[test]
fn documents_name_files_that_exist() {
    let paths = paths();
    // A page names a file by the end of its path, and these are no files of the repository.
    let exists = |name: &String| {
        let end = format!("/{}", name.trim_end_matches('/'));
        name.starts_with("target/") || paths.iter().any(|path| path == name || path.ends_with(&end))
    };
    let mut missing = Vec::new();
    for page in pages() {
        let names = named_files(&read(&page));
        let absent = names.iter().filter(|name| !exists(name) && !TOP.contains(&name.trim_end_matches('/')));
        missing.extend(absent.map(|name| format!("{page}: {name}")));
    }
    assert!(missing.is_empty(), "these files do not exist:\n{}", missing.join("\n"));
}
