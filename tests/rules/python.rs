//! The module for Python is a workspace of its own, in which the rest has the same versions and the same rules.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::ROOT;
use crate::architecture::{LONGEST_FILE, WIDEST_COMMENT};

/// Packages that only the module for Python needs, and whose names the main workspace may have in other versions.
const OWN: [&str; 1] = ["meshbrush-python"];

fn read(path: &str) -> String {
    fs::read_to_string(format!("{ROOT}/{path}")).unwrap()
}

/// Returns the versions of each package in a `Cargo.lock`.
fn locked(path: &str) -> BTreeMap<String, Vec<String>> {
    let mut versions: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let text = read(path);
    let value = |line: &str| line.split('"').nth(1).unwrap().to_owned();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.starts_with("name = ") {
            versions.entry(value(line)).or_default().push(value(lines.next().unwrap()));
        }
    }
    versions
}

/// The same document has the same mesh in Python: another version of a library could calculate otherwise.
#[test]
fn shared_packages_have_the_same_versions_in_python() {
    let (main, python) = (locked("Cargo.lock"), locked("python/Cargo.lock"));
    let differs = |(name, versions): &(&String, &Vec<String>)| {
        let known = main.get(*name);
        known.is_some_and(|known| versions.iter().any(|version| !known.contains(version)))
    };
    let found: Vec<_> = python.iter().filter(differs).collect();
    let advice = "copy Cargo.lock to python/Cargo.lock, and run `cargo metadata` there";
    assert!(found.is_empty(), "python/Cargo.lock has other versions; {advice}: {found:?}");
    assert!(python.contains_key(OWN[0]) && python["libm"] == main["libm"]);
}

#[test]
fn the_package_for_python_has_the_version_of_the_program() {
    let version = |path: &str| {
        let text = read(path);
        let line = text.lines().find(|line| line.starts_with("version = ")).unwrap().to_owned();
        line.split('"').nth(1).unwrap().to_owned()
    };
    assert_eq!(version("python/Cargo.toml"), version("Cargo.toml"));
}

fn files_in(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files_in(&path, ending, found);
        } else if path.extension().is_some_and(|own| own == ending) {
            found.push(path);
        }
    }
}

#[test]
fn source_for_python_obeys_the_rules_of_the_source() {
    let mut files = Vec::new();
    files_in(&Path::new(ROOT).join("python/src"), "rs", &mut files);
    files_in(&Path::new(ROOT).join("python/meshbrush"), "py", &mut files);
    assert!(files.len() > 20);
    for path in files {
        let (text, name) = (fs::read_to_string(&path).unwrap(), path.display());
        assert!(text.lines().count() <= LONGEST_FILE, "{name} is longer than {LONGEST_FILE} lines");
        let is_comment = |line: &&str| line.trim_start().starts_with("//");
        let wide = text.lines().filter(is_comment).find(|line| line.chars().count() > WIDEST_COMMENT);
        assert_eq!(wide, None, "a comment in {name} is wider than {WIDEST_COMMENT} columns");
        let is_unsafe = text.lines().any(|line| !is_comment(&line) && line.contains("unsafe {"));
        assert!(!is_unsafe || path.ends_with("arrays.rs"), "unsafe code in {name}; it is in arrays.rs only");
    }
}
