//! The module for Python and the package for JavaScript are workspaces of their own, in which the rest has the same
//! versions and the same rules.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::ROOT;
use crate::architecture::{LONGEST_FILE, WIDEST_COMMENT};

/// The folders of the other workspaces, with the names of their packages.
const OTHERS: [(&str, &str); 2] = [("python", "meshbrush-python"), ("javascript", "meshbrush-javascript")];

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

/// The same document has the same mesh everywhere: another version of a library could calculate otherwise.
#[test]
fn shared_packages_have_the_same_versions_in_all_workspaces() {
    let main = locked("Cargo.lock");
    for (folder, own) in OTHERS {
        let other = locked(&format!("{folder}/Cargo.lock"));
        let differs = |(name, versions): &(&String, &Vec<String>)| {
            let known = main.get(*name);
            known.is_some_and(|known| versions.iter().any(|version| !known.contains(version)))
        };
        let found: Vec<_> = other.iter().filter(differs).collect();
        let advice = format!("copy Cargo.lock to {folder}/Cargo.lock, and run `cargo metadata` there");
        assert!(found.is_empty(), "{folder}/Cargo.lock has other versions; {advice}: {found:?}");
        assert!(other.contains_key(own) && other["libm"] == main["libm"]);
    }
}

#[test]
fn packages_for_other_languages_have_the_version_of_the_program() {
    let version = |path: &str| {
        let text = read(path);
        let line = text.lines().find(|line| line.starts_with("version = ")).unwrap().to_owned();
        line.split('"').nth(1).unwrap().to_owned()
    };
    for (folder, _) in OTHERS {
        assert_eq!(version(&format!("{folder}/Cargo.toml")), version("Cargo.toml"));
    }
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
fn source_for_other_languages_obeys_the_rules_of_the_source() {
    let mut files = Vec::new();
    files_in(&Path::new(ROOT).join("python/src"), "rs", &mut files);
    files_in(&Path::new(ROOT).join("python/meshbrush"), "py", &mut files);
    files_in(&Path::new(ROOT).join("javascript/src"), "rs", &mut files);
    files_in(&Path::new(ROOT).join("javascript/sequential"), "rs", &mut files);
    files.extend(
        ["index.js", "index.d.ts", "node.js"].map(|name| Path::new(ROOT).join("javascript").join(name)),
    );
    assert!(files.len() > 30);
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
