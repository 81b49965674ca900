//! What desktops and package managers are told about the program is true.

use std::fs;

use crate::ROOT;

/// The identity of the program on desktops: the name of its entry, and of its window.
const ID: &str = "org.meshbrush.Meshbrush";

fn read(path: &str) -> String {
    fs::read_to_string(format!("{ROOT}/{path}")).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Returns what stands between two words in a text.
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    let rest = text.split_once(before).unwrap_or_else(|| panic!("no {before}")).1;
    rest.split_once(after).unwrap_or_else(|| panic!("no {after} after {before}")).0
}

/// A desktop finds name and icon of a window by the identity that the window has.
#[test]
fn the_window_has_the_identity_of_its_desktop_entry() {
    let window = read("src/app/desktop/mod.rs");
    assert_eq!(between(&window, "const APP_ID: &str = \"", "\""), ID);
    let entry = read(&format!("packaging/{ID}.desktop"));
    for line in [format!("Icon={ID}"), format!("StartupWMClass={ID}")] {
        assert!(entry.lines().any(|own| own == line), "no line {line}");
    }
    assert!(read(&format!("packaging/{ID}.metainfo.xml")).contains(&format!("<id>{ID}</id>")));
}

#[test]
fn every_place_names_the_same_type_of_a_project() {
    for ending in ["desktop", "xml", "thumbnailer", "metainfo.xml"] {
        let text = read(&format!("packaging/{ID}.{ending}"));
        assert!(text.contains("application/x-meshbrush"), "{ending}");
    }
}

/// The newest version in the changelog is that of the program, and has the same date for software centres.
#[test]
fn the_changelog_and_the_metainfo_describe_this_version() {
    let version = between(&read("Cargo.toml"), "\nversion = \"", "\"").to_owned();
    let metainfo = read(&format!("packaging/{ID}.metainfo.xml"));
    let release = between(&metainfo, "<release ", ">");
    let date = between(release, "date=\"", "\"");
    assert_eq!(between(release, "version=\"", "\""), version);
    let changelog = read("CHANGELOG.md");
    let titles: Vec<&str> = changelog.lines().filter_map(|line| line.strip_prefix("## ")).collect();
    let newest = titles.iter().find(|title| **title != "Unreleased").unwrap();
    assert_eq!(**newest, format!("{version} ({date})"));
}
