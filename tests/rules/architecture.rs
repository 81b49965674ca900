//! Checks the rules of ARCHITECTURE.md by reading the source.
//!
//! Comments, strings and tests do not count as code. Exceptions are listed with a reason, and an exception
//! that is no longer needed must be removed from its list.

use std::collections::BTreeSet;
use std::fs;

use crate::ROOT;
use crate::source::{Function, SOURCES, SourceFile, read_src, read_texts};

/// The modules, lowest first: each imports only from those before it.
const MODULES: [&str; 36] = [
    "text",
    "geometry",
    "mesh",
    "earth",
    "raster",
    "field",
    "domain",
    "layers",
    "surface",
    "outline",
    "paint",
    "build",
    "path",
    "explain",
    "cells",
    "quality",
    "document",
    "fem",
    "drawing",
    "plot",
    "steps",
    "levels",
    "pixels",
    "relief",
    "report",
    "error_plot",
    "io",
    "colormap",
    "scene",
    "render",
    "cli",
    "theme",
    "lettering",
    "widgets",
    "kit",
    "app",
];

/// The modules of the window.
const OF_WINDOW: [&str; 5] = ["theme", "lettering", "widgets", "kit", "app"];

/// What `src/lib.rs` declares besides: documentation.
const OTHER_MODULES: [&str; 1] = ["guide"];

/// Largest number of lines of a file, without its tests.
pub const LONGEST_FILE: usize = 450;
/// Files that may be longer: the file and the reason.
const LONG_FILES: [(&str, &str); 0] = [];

/// Largest number of lines of a function.
const LONGEST_FUNCTION: usize = 60;
/// Functions that may be longer: file, name and reason.
const LONG_FUNCTIONS: [(&str, &str, &str); 1] = [(
    "crates/core/src/field/formula/program.rs",
    "run_on",
    "one arm for each instruction, a line each, around one accumulator and one stack",
)];

/// Largest width of a line of a comment: max_width in rustfmt.toml.
pub const WIDEST_COMMENT: usize = 110;

/// Functions of std that round differently on different machines.
const INEXACT: [&str; 26] = [
    "sin",
    "cos",
    "tan",
    "sin_cos",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "exp",
    "exp2",
    "exp_m1",
    "ln",
    "ln_1p",
    "log",
    "log2",
    "log10",
    "powf",
    "powi",
    "cbrt",
    "hypot",
    "from_angle",
    "angle_to",
    "angle_between",
];
/// Places where they are harmless: file, name and reason.
const INEXACT_ALLOWED: [(&str, &str, &str); 0] = [];

fn rank(module: &str) -> Option<usize> {
    MODULES.iter().position(|known| *known == module)
}

/// Returns the files of the modules, without `lib.rs`, `main.rs` and [`OTHER_MODULES`].
fn files() -> impl Iterator<Item = &'static SourceFile> {
    let ours = |file: &&SourceFile| !file.module.is_empty() && !OTHER_MODULES.contains(&file.top_module());
    read_src().iter().filter(ours)
}

fn is_of_window(file: &SourceFile) -> bool {
    OF_WINDOW.contains(&file.top_module())
}

/// Returns the files of the modules before the given one.
fn files_before(module: &str) -> impl Iterator<Item = &'static SourceFile> + use<> {
    let end = rank(module).unwrap();
    files().filter(move |file| rank(file.top_module()).is_some_and(|rank| rank < end))
}

/// Fails with everything found, one per line.
pub fn assert_none(found: Vec<String>, rule: &str) {
    assert!(found.is_empty(), "{rule}\n  {}", found.join("\n  "));
}

/// Returns the places where code names a path that begins with one of `beginnings` (segments joined by `::`).
fn named<'a>(files: impl IntoIterator<Item = &'a SourceFile>, beginnings: &[&str]) -> Vec<String> {
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

/// Returns the places where the code contains a word.
fn with_word<'a>(files: impl IntoIterator<Item = &'a SourceFile>, word: &str) -> Vec<String> {
    let mut found = Vec::new();
    for file in files {
        let lines = file.tokens.iter().filter(|token| token.text == word).map(|token| token.line);
        found.extend(lines.map(|line| format!("{}:{line} names {word}", file.path)));
    }
    found
}

/// Every exception must still be needed.
pub fn assert_needed(listed: &[String], met: &[String], list: &str) {
    let idle = listed.iter().filter(|exception| !met.contains(exception)).cloned().collect();
    assert_none(idle, &format!("these are listed in {list} and no longer need to be:"));
}

#[test]
fn the_packages_declare_the_modules_in_their_order() {
    let all = read_src();
    let mut declared = Vec::new();
    for folder in SOURCES {
        let lib = all.iter().find(|file| file.path == format!("{folder}/lib.rs")).unwrap();
        let names = lib.tokens.windows(2).filter(|pair| pair[0].text == "mod");
        declared.extend(names.map(|pair| pair[1].text.as_str()));
    }
    assert_eq!(
        declared,
        [&MODULES[..], &OTHER_MODULES].concat(),
        "each lib.rs declares its modules in order"
    );
    let strangers = files().filter(|file| rank(file.top_module()).is_none()).map(|file| file.path.clone());
    assert_none(strangers.collect(), "every file is in a listed module:");
}

#[test]
fn a_module_imports_only_from_modules_before_it() {
    let mut found = Vec::new();
    for file in files() {
        for path in file.paths().into_iter().filter(|path| path.segments[0] == "crate") {
            // A path to the crate itself, or a glob of it, would hide what is imported.
            let to = path.segments.get(1).map_or("the whole crate", String::as_str);
            let (from, target) = (rank(file.top_module()), rank(to));
            if target.is_none() || target > from {
                found.push(format!("{}:{} imports from {to}", file.path, path.line));
            }
        }
        assert!(!file.paths().iter().any(|path| path.segments[0] == "meshbrush"), "{}", file.path);
    }
    assert_none(
        found,
        &format!("a module imports only from modules before it; the order is {}:", MODULES.join(" ")),
    );
}

#[test]
fn the_program_is_one_call_of_the_library() {
    let main = read_src().iter().filter(|file| file.path == "src/main.rs");
    let allowed = ["meshbrush::run_program", "meshbrush::ProgramAllocator"];
    let inner = named(main, &["meshbrush"])
        .into_iter()
        .filter(|found| !allowed.iter().any(|allowed| found.contains(allowed)));
    assert_none(inner.collect(), "main.rs calls run_program, takes the allocator, and nothing else:");
}

#[test]
fn the_mesh_knows_only_geometry() {
    let mesh = files().filter(|file| file.top_module() == "mesh");
    let others: Vec<String> = MODULES[3..].iter().map(|module| format!("crate::{module}")).collect();
    let others: Vec<&str> = others.iter().map(String::as_str).collect();
    assert_none(named(mesh, &others), "the mesh takes rule and domain as closures:");
}

#[test]
fn the_parts_of_the_mesh_import_downwards() {
    let parts = ["kernel", "extract", "query"];
    let mut found = Vec::new();
    for file in files().filter(|file| file.module.len() > 1 && file.top_module() == "mesh") {
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
fn nothing_before_render_reads_clock_environment_or_screen() {
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
    // To open a pipe waits for another program, for some time. No mesh depends on that.
    let others = files_before("render").filter(|file| !file.path.ends_with("io/pipe.rs"));
    assert_none(named(others, &forbidden), "the same document must give the same mesh on every machine:");
    let mut up_to_render = files_before("render").collect::<Vec<_>>();
    up_to_render.extend(files().filter(|file| file.top_module() == "render"));
    for word in ["Instant", "SystemTime"] {
        assert_none(with_word(up_to_render.clone(), word), "no module before cli reads the clock:");
    }
}

#[test]
fn only_io_opens_files() {
    let others = files().filter(|file| file.top_module() != "io");
    assert_none(named(others, &["std::fs", "fs", "File"]), "only io opens files:");
}

#[test]
fn code_that_decides_a_mesh_rounds_the_same_on_every_machine() {
    let (mut found, mut met) = (Vec::new(), Vec::new());
    let allowed: Vec<String> =
        INEXACT_ALLOWED.iter().map(|(file, name, _)| format!("{file} {name}")).collect();
    for file in files_before("io") {
        for call in file.tokens.windows(3).filter(|three| three[0].text == "." && three[2].text == "(") {
            let (name, place) = (call[1].text.as_str(), format!("{} {}", file.path, call[1].text));
            if INEXACT.contains(&name) && allowed.contains(&place) {
                met.push(place);
            } else if INEXACT.contains(&name) {
                found.push(format!("{}:{} calls {name}; use libm", file.path, call[1].line));
            }
        }
    }
    let by_path =
        ["f64", "f32", "DVec2", "Vec2"].map(|float| INEXACT.map(|name| format!("{float}::{name}"))).concat();
    let by_path: Vec<&str> = by_path.iter().map(String::as_str).collect();
    found.extend(named(files_before("io"), &by_path));
    assert_none(found, "the results of std's functions depend on the machine, those of libm do not:");
    assert_needed(&allowed, &met, "INEXACT_ALLOWED");
}

#[test]
fn egui_and_wgpu_meet_in_listed_files_only() {
    // The second shows a window that is drawn in software. The third draws the whole window without a
    // display, as eframe does with one. The fourth configures eframe. The fifth hears of errors of a browser.
    let joins = [
        "src/app/canvas/gpu.rs",
        "src/app/software_window/gpu.rs",
        "src/app/screenshots/offscreen.rs",
        "src/app/mod.rs",
        "src/app/web/interface.rs",
    ];
    let window = files().filter(|file| is_of_window(file) && !joins.contains(&file.path.as_str()));
    let window: Vec<&SourceFile> = window.collect();
    for word in ["wgpu", "egui_wgpu"] {
        assert_none(with_word(window.clone(), word), "of the window, only these files use wgpu:");
    }
    let others =
        files().filter(|file| !is_of_window(file) && !file.path.starts_with("crates/render/src/render/gpu/"));
    assert_none(with_word(others, "wgpu"), "besides the window, only render/gpu uses wgpu:");
}

#[test]
fn only_the_window_uses_egui() {
    let others: Vec<&SourceFile> = files().filter(|file| !is_of_window(file)).collect();
    for word in ["egui", "egui_plot", "eframe", "rfd"] {
        assert_none(with_word(others.clone(), word), "only the window uses egui:");
    }
}

/// Files of the window that may wait by themselves: the file, and why.
const WAITS: [(&str, &str); 2] = [
    ("src/app/desktop/journal.rs", "its job waits for the next gesture, beside the window"),
    ("src/app/screenshots/offscreen.rs", "no window is open"),
];

#[test]
fn only_jobs_start_threads_wait_and_catch_panics() {
    let window = files().filter(|file| is_of_window(file));
    let others: Vec<&SourceFile> =
        window.filter(|file| !file.path.starts_with("crates/kit/src/kit/jobs/")).collect();
    let listed: Vec<String> = WAITS.iter().map(|(file, _)| (*file).to_owned()).collect();
    let (mut found, mut met) = (Vec::new(), Vec::new());
    for word in ["spawn", "catch_unwind", "recv_timeout", "sleep"] {
        for file in others.iter().filter(|file| file.tokens.iter().any(|token| token.text == word)) {
            if listed.contains(&file.path) && ["recv_timeout", "sleep"].contains(&word) {
                met.push(file.path.clone());
            } else {
                found.push(format!("{} names {word}", file.path));
            }
        }
    }
    assert_none(found, "work that takes longer than a frame is a job:");
    assert_needed(&listed, &met, "WAITS");
}

/// Files of the window that may name a tool of another module: the file, and why. All others read the table
/// of tools.
const NAMES_A_TOOL: [(&str, &str); 4] = [
    ("src/app/canvas/mod.rs", "Space and the middle button pan with every tool"),
    ("crates/kit/src/kit/features.rs", "the tool that moves the view belongs to no feature"),
    ("src/app/screenshots/mod.rs", "pictures of single tools"),
    ("src/app/screenshots/tour.rs", "pictures of single tools"),
];

/// Returns the tools of a file: where others find them, and their names.
fn tools_of(file: &SourceFile) -> Vec<(String, String)> {
    let depth = if file.module.get(1).is_some_and(|module| module == "features") { 3 } else { 2 };
    let module = format!("crate::{}", file.module[..depth.min(file.module.len())].join("::"));
    let words = file
        .tokens
        .windows(4)
        .map(|four| [&four[0], &four[1], &four[2], &four[3]].map(|token| token.text.as_str()));
    let tools = words.filter(|words| matches!(words, ["static", _, ":", "ToolSpec"]));
    tools.map(|words| (module.clone(), words[1].to_owned())).collect()
}

#[test]
fn a_tool_is_one_file_and_one_entry_of_the_table() {
    let window = files().filter(|file| is_of_window(file));
    let tools: Vec<(String, String)> = files().filter(|file| is_of_window(file)).flat_map(tools_of).collect();
    assert!(tools.len() >= 8, "there are tools");
    let listed: Vec<String> = NAMES_A_TOOL.iter().map(|(file, _)| (*file).to_owned()).collect();
    let (mut found, mut met) = (Vec::new(), Vec::new());
    for file in window {
        let own = format!("crate::{}::", file.module.join("::"));
        let others = tools.iter().filter(|(module, _)| !own.starts_with(&format!("{module}::")));
        let paths: Vec<String> = others.map(|(module, tool)| format!("{module}::{tool}")).collect();
        let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
        let (path, names) = (file.path.clone(), named([file], &paths));
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
fn no_feature_imports_the_shell() {
    let mut found = Vec::new();
    for file in files().filter(|file| file.path.starts_with("src/app/features/")) {
        for path in file.paths() {
            let [first, second, module, ..] = &path.segments[..] else { continue };
            if first == "crate" && second == "app" && module != "features" {
                found.push(format!("{}:{} imports from {module}", file.path, path.line));
            }
        }
    }
    assert_none(
        found,
        "frame, menus, panels, canvas and dialogs know the features, and not the other way round:",
    );
}

#[test]
fn widgets_know_no_mesh() {
    let known = ["text", "colormap", "plot", "theme", "widgets"];
    let mut found = Vec::new();
    for file in files().filter(|file| ["theme", "widgets"].contains(&file.top_module())) {
        for path in file.paths().into_iter().filter(|path| path.segments[0] == "crate") {
            let module = path.segments[1].as_str();
            if !known.contains(&module) {
                found.push(format!("{}:{} imports from {module}", file.path, path.line));
            }
        }
    }
    assert_none(found, "widgets and theme show texts, colours and plots:");
}

/// Features that import more from another one than its commands: the file, the other feature, and why.
const IMPORTS_A_FEATURE: [(&str, &str, &str); 3] = [
    ("src/app/features/report/comparison.rs", "plots", "compares the experiment with the report"),
    ("src/app/features/report/comparison.rs", "stepping", "compares the step that is shown with the report"),
    ("src/app/features/report/panel.rs", "plots", "shows the experiment of a figure"),
];

#[test]
fn features_see_a_context_and_not_each_other() {
    let is_inside = |file: &&SourceFile| file.path.starts_with("src/app/features/") && file.module.len() > 2;
    let code: Vec<&SourceFile> = files().filter(is_inside).collect();
    assert!(code.iter().any(|file| file.path.ends_with("/execute.rs")), "there are features");
    assert_none(with_word(code.clone(), "App"), "a feature sees the window through `Ctx`:");
    let commands = commands_of_features(&code);
    let listed: Vec<String> =
        IMPORTS_A_FEATURE.iter().map(|(file, other, _)| format!("{file} {other}")).collect();
    let (mut found, mut met) = (Vec::new(), Vec::new());
    for file in code {
        let paths =
            file.paths().into_iter().filter(|path| path.segments.starts_with(&FEATURES.map(String::from)));
        let named = paths.filter_map(|path| Some((path.segments.get(3)?.clone(), path)));
        for (other, path) in named.filter(|(other, _)| *other != file.module[2]) {
            let place = format!("{} {other}", file.path);
            let is_command =
                path.segments.get(4).is_some_and(|name| commands.contains(&(other.as_str(), name.as_str())));
            if listed.contains(&place) {
                met.push(place);
            } else if !is_command {
                found.push(format!("{}:{} names {}", file.path, path.line, path.segments.join("::")));
            }
        }
    }
    assert_none(found, "a feature sends commands of another one and imports nothing else from it:");
    assert_needed(&listed, &met, "IMPORTS_A_FEATURE");
}

/// Returns the types of the commands of each feature: those in its file `command.rs`.
fn commands_of_features<'a>(features: &[&'a SourceFile]) -> BTreeSet<(&'a str, &'a str)> {
    let files = features.iter().filter(|file| file.path.ends_with("/command.rs"));
    let enums = files.flat_map(|file| {
        let pairs = file.tokens.windows(2).filter(|pair| pair[0].text == "enum");
        pairs.map(|pair| (file.module[2].as_str(), pair[1].text.as_str()))
    });
    enums.collect()
}

/// The path of the features.
const FEATURES: [&str; 3] = ["crate", "app", "features"];

#[test]
fn every_command_has_an_arm() {
    let window = files().filter(|file| is_of_window(file) && !file.path.contains("/tests"));
    assert_none(with_word(window, "unreachable"), "the compiler knows what the window does with a value:");
}

/// Files with unsafe code: memory that grows in place, values of a library whose types have no public name,
/// and a look at standard output before `main`.
const UNSAFE_FILES: [&str; 3] = [
    "crates/mesh/src/mesh/kernel/memory.rs",
    "crates/core/src/path/certificate/solver.rs",
    "crates/cli/src/cli/standard_output.rs",
];

#[test]
fn unsafe_code_is_in_three_files() {
    let others = read_src().iter().filter(|file| !UNSAFE_FILES.contains(&file.path.as_str()));
    assert_none(with_word(others, "unsafe"), "unsafe code is in UNSAFE_FILES only:");
}

#[test]
fn files_are_short() {
    let long: Vec<&SourceFile> = read_src().iter().filter(|file| file.line_count > LONGEST_FILE).collect();
    let listed: Vec<String> = LONG_FILES.iter().map(|(file, _)| (*file).to_owned()).collect();
    let found = long.iter().filter(|file| !listed.contains(&file.path));
    assert_none(
        found.map(|file| format!("{} has {}", file.path, file.line_count)).collect(),
        &format!("a file has at most {LONGEST_FILE} lines, or a reason in LONG_FILES:"),
    );
    assert_needed(&listed, &long.into_iter().map(|file| file.path.clone()).collect::<Vec<_>>(), "LONG_FILES");
}

/// Returns a row of a table or a line of a drawing, which cannot be wrapped.
fn is_table_or_drawing(comment: &str) -> bool {
    let text = comment.trim_start().trim_start_matches(['/', '!']);
    text.starts_with(" |") || text.starts_with("     ")
}

#[test]
fn comments_fit_the_width_of_the_code() {
    let mut found = Vec::new();
    for (path, text) in read_texts() {
        let comments = text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with("//"));
        for (index, line) in comments.filter(|(_, line)| !is_table_or_drawing(line)) {
            if line.chars().count() > WIDEST_COMMENT {
                found.push(format!("{path}:{} has {} columns", index + 1, line.chars().count()));
            }
        }
    }
    assert_none(
        found,
        &format!("a comment has at most {WIDEST_COMMENT} columns, like max_width in rustfmt.toml:"),
    );
}

/// Returns keys of the form `[Name1995]`, and `[Report]`.
fn keys(text: &str) -> BTreeSet<String> {
    let bracketed = text.split('[').skip(1).filter_map(|rest| rest.split(']').next());
    let is_key = |word: &&str| {
        let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let year = &word[name.len()..];
        *word == "Report"
            || (year.len() == 4
                && name.starts_with(|c: char| c.is_ascii_uppercase())
                && name.chars().all(|c| c.is_ascii_alphabetic()))
    };
    bracketed.map(|word| word.trim_end_matches('\\')).filter(is_key).map(str::to_owned).collect()
}

#[test]
fn every_reference_is_cited_and_every_citation_is_defined() {
    let list = fs::read_to_string(format!("{ROOT}/docs/references.md")).unwrap();
    let defined =
        list.lines().filter(|line| line.starts_with(r"**\[")).flat_map(keys).collect::<BTreeSet<_>>();
    let mut cited = BTreeSet::new();
    for (path, text) in read_texts() {
        for key in keys(text) {
            assert!(defined.contains(&key), "{path} cites [{key}], which docs/references.md does not define");
            cited.insert(key);
        }
    }
    assert_eq!(cited, defined, "every key of docs/references.md is cited in the source");
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

/// Source that is easy to misread.
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
fn the_reader_handles_source_that_is_easy_to_misread() {
    let file = SourceFile::new("crates/core/src/field/formula/mod.rs", TRAPS);
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
