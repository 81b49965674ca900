//! The rules of the house (ARCHITECTURE.md), held by reading the source.
//!
//! Comments, strings and tests are no code here. An exception stands in a list with its reason, and must go from the list
//! when it is no longer needed.

mod source;

use source::{Function, SourceFile, read_src};

/// The rooms, lowest first: each imports only from those before it.
const ROOMS: [&str; 15] = [
    "text", "geometry", "mesh", "raster", "field", "domain", "paint", "build", "document", "io", "colormap",
    "scene", "render", "cli", "app",
];

/// Most lines of a file, without its tests.
const LONGEST_FILE: usize = 450;
/// Files that may be longer: the file, and why.
const LONG_FILES: [(&str, &str); 0] = [];

/// Most lines of a function.
const LONGEST_FUNCTION: usize = 60;
/// Functions that may be longer: file, name, and why.
const LONG_FUNCTIONS: [(&str, &str, &str); 1] = [(
    "src/field/formula/program.rs",
    "run_on",
    "one arm for each instruction, a line each, around one accumulator and one stack",
)];

/// Functions of std that round differently from machine to machine.
const INEXACT: [&str; 23] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "exp2",
    "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "powi", "cbrt", "hypot",
];
/// Where they are harmless: file, name, and why.
const INEXACT_ALLOWED: [(&str, &str, &str); 0] = [];

fn rank(room: &str) -> Option<usize> {
    ROOMS.iter().position(|known| *known == room)
}

/// Files of the rooms, without `lib.rs` and `main.rs`.
fn rooms() -> Vec<SourceFile> {
    read_src().into_iter().filter(|file| !file.module.is_empty()).collect()
}

/// Files of the rooms before the given one.
fn rooms_before(room: &str) -> impl Iterator<Item = SourceFile> {
    let end = rank(room).unwrap();
    rooms().into_iter().filter(move |file| rank(file.room()).is_some_and(|rank| rank < end))
}

/// Fails with all that was found, a line each.
fn assert_none(found: Vec<String>, rule: &str) {
    assert!(found.is_empty(), "{rule}\n  {}", found.join("\n  "));
}

/// Places where code names a path that begins with one of `beginnings` (segments joined by `::`).
fn named<'a>(files: impl IntoIterator<Item = SourceFile>, beginnings: &'a [&'a str]) -> Vec<String> {
    let mut found = Vec::new();
    for file in files {
        for path in file.paths() {
            let text = path.segments.join("::") + "::";
            if beginnings.iter().any(|beginning| text.starts_with(&format!("{beginning}::"))) {
                found.push(format!("{}:{} names {}", file.path, path.line, path.segments.join("::")));
            }
        }
    }
    found
}

/// Places where code has the word, as a name of anything.
fn with_word(files: impl IntoIterator<Item = SourceFile>, word: &str) -> Vec<String> {
    let mut found = Vec::new();
    for file in files {
        let lines = file.tokens.iter().filter(|token| token.text == word).map(|token| token.line);
        found.extend(lines.map(|line| format!("{}:{line} names {word}", file.path)));
    }
    found
}

/// Every exception must still be one.
fn assert_needed(listed: &[String], met: &[String], list: &str) {
    let idle = listed.iter().filter(|exception| !met.contains(exception)).cloned().collect();
    assert_none(idle, &format!("these are listed in {list} and are no exception any more:"));
}

#[test]
fn lib_rs_and_the_folders_are_the_rooms_in_their_order() {
    let files = read_src();
    let lib = files.iter().find(|file| file.path == "src/lib.rs").unwrap();
    let names: Vec<&str> = lib.tokens.iter().map(|token| token.text.as_str()).collect();
    let declared: Vec<&str> = names.windows(2).filter(|pair| pair[0] == "mod").map(|pair| pair[1]).collect();
    assert_eq!(declared, ROOMS, "src/lib.rs declares the rooms in their order");
    let strangers = rooms().into_iter().filter(|file| rank(file.room()).is_none()).map(|file| file.path);
    assert_none(strangers.collect(), "every file is in a room:");
}

#[test]
fn a_room_imports_only_from_rooms_before_it() {
    let mut found = Vec::new();
    for file in rooms() {
        for path in file.paths().into_iter().filter(|path| path.segments[0] == "crate") {
            // A path to the crate itself, or to everything in it, would hide what it leads to.
            let to = path.segments.get(1).map_or("the whole crate", String::as_str);
            let (from, target) = (rank(file.room()), rank(to));
            if target.is_none() || target > from {
                found.push(format!("{}:{} imports from {to}", file.path, path.line));
            }
        }
        assert!(!file.paths().iter().any(|path| path.segments[0] == "meshbrush"), "{}", file.path);
    }
    assert_none(
        found,
        &format!("a room imports only from rooms before it; the order is {}:", ROOMS.join(" ")),
    );
}

#[test]
fn the_program_is_a_thin_door() {
    let main = read_src().into_iter().filter(|file| file.path == "src/main.rs");
    let inner: Vec<String> = named(main, &["meshbrush"])
        .into_iter()
        .filter(|found| !found.contains("meshbrush::cli") && !found.contains("meshbrush::app"))
        .collect();
    assert_none(inner, "main.rs knows only cli and app:");
}

#[test]
fn the_mesh_knows_geometry_and_nothing_else_of_the_house() {
    let mesh = rooms().into_iter().filter(|file| file.room() == "mesh");
    let others: Vec<String> = ROOMS[3..].iter().map(|room| format!("crate::{room}")).collect();
    let others: Vec<&str> = others.iter().map(String::as_str).collect();
    assert_none(named(mesh, &others), "rule and domain come to the mesh as closures:");
}

#[test]
fn the_parts_of_the_mesh_import_downwards() {
    let parts = ["kernel", "extract", "query"];
    let mut found = Vec::new();
    for file in rooms().into_iter().filter(|file| file.module.len() > 1 && file.room() == "mesh") {
        let own = parts.iter().position(|part| *part == file.module[1]);
        let allowed = &parts[..=own.unwrap_or_else(|| panic!("{} is in no part of mesh", file.path))];
        for path in file.paths() {
            // `crate::mesh` alone is a visibility.
            let names_mesh = path.segments.len() > 2 && path.segments[..2] == ["crate", "mesh"];
            if names_mesh && !allowed.contains(&path.segments[2].as_str()) {
                found.push(format!("{}:{} names {}", file.path, path.line, path.segments.join("::")));
            }
        }
    }
    assert_none(found, &format!("in mesh the order is {}:", parts.join(" ")));
}

#[test]
fn before_render_nothing_knows_time_place_or_screen() {
    let forbidden = [
        "std::time",
        "std::env",
        "std::thread",
        "std::net",
        "std::process::Command",
        "eframe",
        "egui",
        "egui_wgpu",
        "wgpu",
        "rfd",
        "pollster",
        "clap",
    ];
    assert_none(named(rooms_before("render"), &forbidden), "same document, same mesh, bit for bit:");
    let mut files = rooms_before("render").collect::<Vec<_>>();
    files.extend(rooms().into_iter().filter(|file| file.room() == "render"));
    for word in ["Instant", "SystemTime"] {
        assert_none(with_word(files.clone(), word), "no room before cli reads the clock:");
    }
}

#[test]
fn only_io_opens_files() {
    let others = rooms().into_iter().filter(|file| file.room() != "io");
    assert_none(named(others, &["std::fs", "fs", "File"]), "one file per format, and all of them in io:");
}

#[test]
fn what_decides_a_mesh_rounds_the_same_on_every_machine() {
    let (mut found, mut met) = (Vec::new(), Vec::new());
    let allowed: Vec<String> =
        INEXACT_ALLOWED.iter().map(|(file, name, _)| format!("{file} {name}")).collect();
    for file in rooms_before("io") {
        for call in file.tokens.windows(3).filter(|three| three[0].text == "." && three[2].text == "(") {
            let (name, place) = (call[1].text.as_str(), format!("{} {}", file.path, call[1].text));
            if INEXACT.contains(&name) && allowed.contains(&place) {
                met.push(place);
            } else if INEXACT.contains(&name) {
                found.push(format!("{}:{} calls {name}; libm has it", file.path, call[1].line));
            }
        }
    }
    let by_path = ["f64", "f32"].map(|float| INEXACT.map(|name| format!("{float}::{name}"))).concat();
    let by_path: Vec<&str> = by_path.iter().map(String::as_str).collect();
    found.extend(named(rooms_before("io"), &by_path));
    assert_none(found, "std's functions are those of the machine, libm's are ours:");
    assert_needed(&allowed, &met, "INEXACT_ALLOWED");
}

#[test]
fn one_file_of_the_window_speaks_wgpu() {
    // The second paints the whole window where there is no display, as eframe does where there is one.
    let joins = ["src/app/canvas/gpu.rs", "src/app/screenshots/offscreen.rs", "src/app/mod.rs"];
    let window =
        rooms().into_iter().filter(|file| file.room() == "app" && !joins.contains(&file.path.as_str()));
    let window: Vec<SourceFile> = window.collect();
    for word in ["wgpu", "egui_wgpu"] {
        assert_none(with_word(window.clone(), word), "only the canvas's gpu.rs joins egui and wgpu:");
    }
    let others =
        rooms().into_iter().filter(|file| file.room() != "app" && !file.path.starts_with("src/render/gpu/"));
    assert_none(with_word(others, "wgpu"), "beside the window only render/gpu speaks wgpu:");
}

#[test]
fn only_the_window_speaks_egui() {
    let others: Vec<SourceFile> = rooms().into_iter().filter(|file| file.room() != "app").collect();
    for word in ["egui", "eframe", "rfd"] {
        assert_none(with_word(others.clone(), word), "everything but the window works without one:");
    }
}

/// Files of the window that may name a tool: the file, and why. All others read the table of tools.
const NAMES_A_TOOL: [(&str, &str); 6] = [
    ("src/app/canvas/mod.rs", "Space and the middle button pan with every tool"),
    ("src/app/catalog.rs", "the modes of the domain tool are commands"),
    ("src/app/execute.rs", "some commands belong to one tool"),
    ("src/app/panels/brush.rs", "brush and eraser share a section"),
    ("src/app/panels/domain.rs", "the section shows the tool's settings while it is selected"),
    ("src/app/screenshots/mod.rs", "pictures of single tools"),
];

#[test]
fn a_tool_is_one_file_and_one_entry_of_the_table() {
    let window = rooms().into_iter().filter(|file| file.path.starts_with("src/app/"));
    let window = window.filter(|file| !file.path.starts_with("src/app/tools/"));
    let tools =
        ["BRUSH", "ERASER", "QUERY", "DOMAIN", "PAN"].map(|tool| format!("crate::app::tools::{tool}"));
    let tools: Vec<&str> = tools.iter().map(String::as_str).collect();
    let listed: Vec<String> = NAMES_A_TOOL.iter().map(|(file, _)| (*file).to_owned()).collect();
    let (mut found, mut met) = (Vec::new(), Vec::new());
    for file in window {
        let (path, names) = (file.path.clone(), named([file], &tools));
        if listed.contains(&path) && !names.is_empty() {
            met.push(path);
        } else {
            found.extend(names);
        }
    }
    assert_none(found, "keys, menus, panels and canvas read the table of tools:");
    assert_needed(&listed, &met, "NAMES_A_TOOL");
}

#[test]
fn unsafe_code_is_in_one_file() {
    let others = read_src().into_iter().filter(|file| file.path != "src/mesh/kernel/memory.rs");
    assert_none(with_word(others, "unsafe"), "unsafe stands in mesh/kernel/memory.rs only:");
}

#[test]
fn files_are_short_enough_to_be_read() {
    let long: Vec<SourceFile> =
        read_src().into_iter().filter(|file| file.line_count > LONGEST_FILE).collect();
    let listed: Vec<String> = LONG_FILES.iter().map(|(file, _)| (*file).to_owned()).collect();
    let found = long.iter().filter(|file| !listed.contains(&file.path));
    assert_none(
        found.map(|file| format!("{} has {}", file.path, file.line_count)).collect(),
        &format!("a file has at most {LONGEST_FILE} lines, or a reason in LONG_FILES:"),
    );
    assert_needed(&listed, &long.into_iter().map(|file| file.path).collect::<Vec<_>>(), "LONG_FILES");
}

#[test]
fn functions_fit_on_a_screen() {
    let listed: Vec<String> = LONG_FUNCTIONS.iter().map(|(file, name, _)| format!("{file} {name}")).collect();
    let (mut found, mut met) = (Vec::new(), Vec::new());
    for file in read_src() {
        for Function { name, lines } in file.functions() {
            let (length, place) = (lines.end() - lines.start() + 1, format!("{} {name}", file.path));
            if length > LONGEST_FUNCTION && listed.contains(&place) {
                met.push(place);
            } else if length > LONGEST_FUNCTION {
                found.push(format!("{}:{} {name} has {length} lines", file.path, lines.start()));
            }
        }
    }
    let rule = format!("a function has at most {LONGEST_FUNCTION} lines, or a reason in LONG_FUNCTIONS:");
    assert_none(found, &rule);
    assert_needed(&listed, &met, "LONG_FUNCTIONS");
}

/// What a reader of source can be fooled by.
const TRAPS: &str = r####"
//! crate::io in a doc comment
use std::{fmt, time::{self, Instant as Clock}}; // crate::document
use crate::{geometry::{Rect, Side}, mesh};
use super::super::raster::*;
/* crate::app /* nested */ unsafe */
const TEXT: &str = "crate::cli \" unsafe"; const RAW: &[u8] = br##"wgpu"# crate::app"##;
const QUOTE: char = '"'; const ESCAPED: char = '\''; const HEX: char = '\u{22}';
fn generic<'a>(x: &'a [u8; 3]) -> self::own::Type { super::sibling::call(x); 1..2; }
mod inner { fn up() { super::near(); super::super::sibling::call() } }
#[cfg(test)]
mod tests { use crate::app::App; fn unsafe_test() { unsafe {} } }
#[cfg(test)] #[allow(unused)]
fn helper(x: [u8; 3]) { crate::cli::run(); }
#[cfg(test)]
mod elsewhere;
#[cfg(not(test))]
fn last() { crate::paint::stamp::<u8>() }
"####;

#[test]
fn the_reader_is_not_fooled() {
    let file = SourceFile::new("src/field/formula/mod.rs", TRAPS);
    let paths: Vec<String> = file.paths().iter().map(|path| path.segments.join("::")).collect();
    let expected = [
        "std::fmt",
        "std::time::self",
        "std::time::Instant",
        "crate::geometry::Rect",
        "crate::geometry::Side",
        "crate::mesh",
        "crate::raster::*",
        "crate::field::formula::own::Type",
        "crate::field::sibling::call",
        "crate::field::formula::near",
        "crate::field::sibling::call",
        "crate::paint::stamp",
    ];
    assert_eq!(paths, expected);
    let words: Vec<&str> = file.tokens.iter().map(|token| token.text.as_str()).collect();
    assert!(!words.iter().any(|word| ["unsafe", "wgpu", "app", "document", "cli", "helper"].contains(word)));
    let functions: Vec<String> = file.functions().into_iter().map(|function| function.name).collect();
    assert_eq!(functions, ["generic", "up", "last"]);
    assert_eq!(file.line_count, TRAPS.lines().count() - 6);
    assert_eq!(file.functions()[0].lines, 9..=9);
}
