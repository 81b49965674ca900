//! What README and pages say can be done as they say. (Rust examples are doc tests of the library.)
//!
//! `UPDATE_DOCS=1 cargo test --test program` writes the pages that come from the program.

use std::path::Path;
use std::process::Command;

use crate::folder::Folder;
use meshbrush_core::field::formula::functions;
use meshbrush_mesh::mesh::MemoryLimit;

const README: &str = include_str!("../../README.md");
const PROGRAM: &str = env!("CARGO_BIN_EXE_meshbrush");

/// Returns the contents of the blocks of code in a language.
fn blocks(language: &str) -> impl Iterator<Item = &'static str> {
    let opening = format!("```{language}\n");
    README.split("```\n").filter_map(move |part| part.split_once(&opening).map(|(_, block)| block))
}

#[cfg(unix)]
#[test]
fn every_command_works_as_typed() {
    let folder = Folder::new("readme");
    for input in [
        "jacksboro_slope.png",
        "jacksboro.toml",
        "aegean_sea.geojson",
        "celtic_sea.geojson",
        "celtic_sea_depths.tif",
        "celtic_sea.toml",
    ] {
        let input = Path::new("assets").join(input);
        let bytes = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(&input)).unwrap();
        folder.file(input.to_str().unwrap(), bytes);
    }
    let programs = Path::new(PROGRAM).parent().unwrap();
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    let mut commands = 0;
    for block in blocks("sh") {
        commands += block.lines().filter(|line| line.starts_with("meshbrush ")).count();
        let ran = Command::new("sh")
            .args(["-euc", block])
            .env("PATH", &path)
            .current_dir(&folder.0)
            .output()
            .unwrap();
        assert!(ran.status.success(), "{block}\n{}", String::from_utf8_lossy(&ran.stderr));
        // Standard output has the answer of `why`, and the JSON of the one command that asks for it.
        let printed = String::from_utf8(ran.stdout).unwrap();
        assert!(printed.contains("exceeds its target"), "{printed}");
        let json = printed.lines().find(|line| line.starts_with('{')).unwrap();
        let summary: serde_json::Value = serde_json::from_str(json).unwrap();
        assert_eq!(summary["violations"], 0);
    }
    assert_eq!(commands, 10, "the commands were found");
    for file in [
        "diamond.vtu",
        "terrain.msh",
        "terrain.png",
        "sea.2dm",
        "found.csv",
        "path.geojson",
        "jacksboro.png",
        "celtic_sea.png",
    ] {
        assert!(folder.0.join(file).metadata().unwrap().len() > 100, "{file}");
    }
}

/// Compares a page with what the program says, and writes it instead where `UPDATE_DOCS` is set.
fn assert_page(page: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(written == text, "{page} is not what the program says: UPDATE_DOCS=1 cargo test --test program");
}

fn printed(arguments: &[&str]) -> String {
    let ran = Command::new(PROGRAM).args(arguments).output().unwrap();
    assert!(ran.status.success(), "{arguments:?}");
    String::from_utf8(ran.stdout).unwrap()
}

/// Returns the commands of the program, as its help lists them.
fn commands() -> Vec<String> {
    let help = printed(&["help"]);
    let list =
        help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = list.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

#[test]
fn the_page_of_options_is_the_help() {
    let mut page =
        "# Commands and options\n\nWhat `meshbrush help COMMAND` prints. Written by a test.\n".to_owned();
    for command in commands().iter().filter(|command| *command != "help") {
        let help = printed(&["help", command]);
        page += &format!("\n## {command}\n\n```text\n{}\n```\n", help.trim_end());
    }
    assert_page("docs/options.md", &page);
}

#[test]
fn the_page_of_formulas_has_every_function_and_constant() {
    let mut page = "# Formulas\n\nWhat formulas in the window, in recipes and on the command line can say. Written by a test.\n\n\
                    Formulas use `x` and `y`, or the polar coordinates `r` and `theta`; those of a cost also `risk`, and those of a \
                    target diameter also `depth`, the depth of the water in metres, positive downwards. \
                    Constants are `pi`, `tau`, `e` and `inf`.\n\n\
                    | lowest precedence first | |\n|---|---|\n\
                    | logic | `a or b`, `a and b`, `not a` (also `\\|\\|`, `&&`, `!`); 0 is false, any other value is true |\n\
                    | comparison | `<` `<=` `>` `>=` `==` `!=`, 1 or 0; comparisons can be chained: `0 < x <= 1` |\n\
                    | arithmetic | `+` `-`, then `*` `/` `%`, then signs, then `^` (right-associative: `2^3^2` is 512, `-2^2` is -4) |\n\n\
                    | function | |\n|---|---|\n"
        .to_owned();
    for (call, meaning) in functions() {
        page += &format!("| `{call}` | {} |\n", meaning.replace('|', "\\|"));
    }
    assert_page("docs/formulas.md", &page);
}

/// Every key of a JSON value, at any depth.
fn keys(value: &serde_json::Value, found: &mut std::collections::BTreeSet<String>) {
    match value {
        serde_json::Value::Object(map) => {
            for (key, value) in map {
                found.insert(key.clone());
                keys(value, found);
            }
        }
        serde_json::Value::Array(list) => list.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn the_page_of_output_has_every_key() {
    let page = std::fs::read_to_string("docs/output.md").unwrap();
    let sea = [
        "mesh",
        "--region",
        "assets/aegean_sea.geojson",
        "--spacing",
        "0.5",
        "--target",
        "0.5",
        "--checks",
        "--json",
    ];
    let risk = ["--spacing", "0.2", "--risk", "x", "--h-min", "0.1", "--json"];
    let mut found = std::collections::BTreeSet::new();
    for arguments in [
        sea.to_vec(),
        [&["path", "--from", "0.1,0.1", "--to", "0.9,0.8"], &risk[..]].concat(),
        [&["why", "0.3,0.4"], &risk[..]].concat(),
        vec!["replay", "tests/sessions/random_gestures.jsonl", "--json"],
    ] {
        let printed = printed(&arguments);
        keys(
            &serde_json::from_str(&printed).unwrap_or_else(|e| panic!("{arguments:?}: {e}\n{printed}")),
            &mut found,
        );
    }
    let missing: Vec<_> = found.iter().filter(|key| !page.contains(&format!("`{key}`"))).collect();
    assert!(found.len() > 60 && missing.is_empty(), "{} keys; missing: {missing:?}", found.len());
}

#[test]
fn every_link_leads_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pages = [
        "README.md",
        "ARCHITECTURE.md",
        "CHANGELOG.md",
        "docs/output.md",
        "docs/limits.md",
        "docs/differences.md",
    ];
    for page in pages {
        let text = std::fs::read_to_string(root.join(page)).unwrap();
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            // Pictures are written by a command of the program, after the tests.
            let elsewhere = ["http", "#"].iter().any(|start| target.starts_with(start));
            let folder = root.join(page).parent().unwrap().to_owned();
            let file = target.split('#').next().unwrap_or_default();
            assert!(elsewhere || folder.join(file).exists(), "{page}: {target}");
        }
    }
}

#[test]
fn the_help_and_the_documentation_name_the_bytes_of_a_triangle() {
    let [one, two] = [MemoryLimit::ONE_MESH, MemoryLimit::TWO_MESHES];
    for (text, words) in [
        (include_str!("../../docs/options.md"), format!(": {one} bytes a triangle")),
        (include_str!("../../docs/manual/limits.md"), format!("; {two} bytes a triangle")),
        (
            include_str!("../../docs/limits.md"),
            format!("{two} bytes each in the window, and {one} on the command line"),
        ),
    ] {
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(&words), "{words}");
    }
}
