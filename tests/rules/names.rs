//! Checks that a search for the name of a type finds one type.

use std::collections::BTreeMap;

use crate::architecture::{assert_needed, assert_none};
use crate::source::{SOURCES, SourceFile, read_src};

/// Words that say nothing about a type by themselves: they fit whatever a program does.
const GENERIC: [&str; 20] = [
    "Answer", "Asked", "Content", "Data", "Entry", "Found", "Given", "Item", "Kept", "Key", "Kind", "Known",
    "Part", "Piece", "Place", "Question", "Square", "Stage", "Step", "Work",
];
/// Types with such a name: the file, the name, and why.
const GENERIC_ALLOWED: [(&str, &str, &str); 3] = [
    ("crates/mesh/src/mesh/kernel/answer.rs", "Answer", "public: the answer of a refinement rule"),
    ("crates/core/src/document/stage.rs", "Stage", "public: the stage that a follower is in"),
    ("crates/io/src/io/given.rs", "Given", "public: data that are given in memory, in place of files"),
];

/// Names that several types of a package have: the folder, the name, and why.
const SHARED: [(&str, &str, &str); 1] =
    [("src", "JournalKeeper", "one for a desktop, one for a browser: only one of them is compiled")];

/// Returns where the types of a package are declared, by their names.
fn types_of(folder: &str) -> BTreeMap<String, Vec<String>> {
    let mut types = BTreeMap::<String, Vec<String>>::new();
    for file in read_src().iter().filter(|file| file.path.starts_with(&format!("{folder}/"))) {
        for declared in file.types() {
            types.entry(declared.name).or_default().push(format!("{}:{}", file.path, declared.line));
        }
    }
    types
}

#[test]
fn no_two_types_of_a_package_have_the_same_name() {
    let listed: Vec<String> = SHARED.iter().map(|(folder, name, _)| format!("{folder} {name}")).collect();
    let (mut found, mut met) = (Vec::new(), Vec::new());
    for folder in SOURCES {
        for (name, places) in types_of(folder).into_iter().filter(|(_, places)| places.len() > 1) {
            let shared = format!("{folder} {name}");
            if listed.contains(&shared) {
                met.push(shared);
            } else {
                found.push(format!("{name}: {}", places.join(", ")));
            }
        }
    }
    assert_none(found, "a name says what a type is where it is used, and a search finds that type alone:");
    assert_needed(&listed, &met, "SHARED");
}

#[test]
fn names_of_types_say_what_they_are() {
    let listed: Vec<String> =
        GENERIC_ALLOWED.iter().map(|(file, name, _)| format!("{file} {name}")).collect();
    let (mut found, mut met) = (Vec::new(), Vec::new());
    for file in read_src() {
        for declared in file.types().into_iter().filter(|declared| GENERIC.contains(&declared.name.as_str()))
        {
            let place = format!("{} {}", file.path, declared.name);
            if listed.contains(&place) {
                met.push(place);
            } else {
                found.push(format!("{}:{} {}", file.path, declared.line, declared.name));
            }
        }
    }
    assert_none(found, "these names fit anything; a type says whose step, key or part it is:");
    assert_needed(&listed, &met, "GENERIC_ALLOWED");
}

#[test]
fn the_reader_finds_the_types_of_modules() {
    let file = SourceFile::new("crates/core/src/field/types.rs", TYPES);
    let names: Vec<String> = file.types().into_iter().map(|declared| declared.name).collect();
    assert_eq!(names, ["Plain", "Choice", "Short", "Ability", "Inner"]);
}

const TYPES: &str = r#"
pub struct Plain<T>(T);
enum Choice { A { b: u8 }, C }
type Short = Plain<u8>;
pub(super) trait Ability { type Output; }
impl Ability for Plain<u8> { type Output = u8; }
fn function() { struct Local; }
mod inner { struct Inner { x: u8 } }
#[cfg(test)]
mod tests { struct Tested; }
"#;
