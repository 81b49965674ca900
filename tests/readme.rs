//! What the README says can be done as it says. (Its Rust examples are doc tests of the library.)

use std::path::Path;
use std::process::Command;

use meshbrush::internals::field::formula::functions;

const README: &str = include_str!("../README.md");
const PROGRAM: &str = env!("CARGO_BIN_EXE_meshbrush");

/// The contents of the blocks of code in a language.
fn blocks(language: &str) -> impl Iterator<Item = &'static str> {
    let opening = format!("```{language}\n");
    README.split("```\n").filter_map(move |part| part.split_once(&opening).map(|(_, block)| block))
}

#[cfg(unix)]
#[test]
fn every_command_works_as_typed() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("readme-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("assets")).unwrap();
    for input in ["assets/jacksboro_slope.png", "assets/jacksboro.toml", "assets/aegean_sea.geojson"] {
        std::fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join(input), folder.join(input)).unwrap();
    }
    let programs = Path::new(PROGRAM).parent().unwrap();
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    let mut commands = 0;
    for block in blocks("sh") {
        commands += block.lines().filter(|line| line.starts_with("meshbrush ")).count();
        let ran = Command::new("sh")
            .args(["-euc", block])
            .env("PATH", &path)
            .current_dir(&folder)
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
    assert_eq!(commands, 9, "the commands were found");
    for file in
        ["diamond.vtu", "terrain.msh", "terrain.png", "sea.2dm", "found.csv", "path.geojson", "jacksboro.png"]
    {
        assert!(folder.join(file).metadata().unwrap().len() > 100, "{file}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_option_and_every_function_is_mentioned() {
    let mut missing = Vec::new();
    for command in ["mesh", "locate", "path"] {
        let help = Command::new(PROGRAM).args([command, "--help"]).output().unwrap();
        let help = String::from_utf8(help.stdout).unwrap();
        let options =
            help.lines().filter_map(|line| line.trim_start().split([' ', ',']).find(|w| w.starts_with("--")));
        missing.extend(
            options.filter(|option| *option != "--help" && !README.contains(*option)).map(str::to_owned),
        );
    }
    let names = functions().map(|(call, _)| call.split('(').next().unwrap());
    missing.extend(names.filter(|name| !README.contains(&format!("`{name}"))).map(str::to_owned));
    assert_eq!(missing, Vec::<String>::new());
}

#[test]
fn every_link_leads_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for page in ["README.md", "ARCHITECTURE.md", "CHANGELOG.md"] {
        let text = std::fs::read_to_string(root.join(page)).unwrap();
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            // Pictures are written by a command of the program, after the tests.
            let elsewhere = ["http", "#"].iter().any(|start| target.starts_with(start));
            assert!(elsewhere || root.join(target).exists(), "{page}: {target}");
        }
    }
}
