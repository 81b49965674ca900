//! `meshbrush path`, run as a person runs it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// A folder of its own for each test, removed at the end.
struct Folder(PathBuf);

struct Ran {
    status: i32,
    out: String,
    err: String,
}

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("path-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    /// Runs `meshbrush path` with arguments parted by spaces; `'…'` keeps spaces.
    fn run(&self, arguments: &str) -> Ran {
        let words = arguments.split('\'').enumerate().flat_map(|(n, part)| match n % 2 {
            0 => part.split_whitespace().collect(),
            _ => vec![part],
        });
        let mut command = Command::new(env!("CARGO_BIN_EXE_meshbrush"));
        let output = command.current_dir(&self.0).arg("path").args(words).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let status = output.status.code().expect("the program ends by itself");
        Ran { status, out: text(output.stdout), err: text(output.stderr) }
    }

    fn json(&self, arguments: &str) -> Value {
        let ran = self.run(&format!("--json {arguments}"));
        assert_eq!(ran.status, 0, "{arguments}: {}", ran.err);
        serde_json::from_str(&ran.out).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const COARSE: &str = "--spacing 0.125";

#[test]
fn the_answer_has_the_path_its_figures_and_an_interval() {
    let folder = Folder::new("answer");
    let answer = folder.json(&format!("--from 0.1,0.2 --to 0.9,0.8 --length-weight 2 {COARSE}"));
    let number = |name: &str| answer[name].as_f64().unwrap_or_else(|| panic!("{name}"));
    assert!((number("cost") - 2.0).abs() < 1e-9 && (number("length") - 1.0).abs() < 1e-9);
    assert!(number("lower") <= 2.0 && number("upper") >= 2.0 && number("lower") > 1.9);
    assert_eq!((number("risk"), number("highest_risk"), number("triangles")), (0.0, 0.0, 128.0));
    assert!(number("seconds") > 0.0);
    let points = answer["points"].as_array().unwrap();
    assert_eq!((&points[0][0], &points[points.len() - 1][1]), (&0.1.into(), &0.8.into()));
}

#[test]
fn a_proof_narrows_the_interval() {
    let folder = Folder::new("proof");
    let options = format!("--from 0.2,0.3 --to 0.8,0.6 --cost '1 + x' {COARSE}");
    let width = |answer: &Value| {
        let [lower, upper] = ["lower", "upper"].map(|name| answer[name].as_f64().unwrap());
        (upper - lower) / upper
    };
    assert!(width(&folder.json(&options)) > 0.01);
    assert!(width(&folder.json(&format!("{options} --within 1%"))) <= 0.01);
    // The proof has a grid of its own, however fine that of the mesh is.
    let fine = "--from 0.2,0.3 --to 0.8,0.6 --cost '1 + x' --spacing 0.012 --within 0.05%";
    assert!(width(&folder.json(fine)) <= 0.0005);
    let ran = folder.run(&format!("{options} --within 2%"));
    assert!(ran.out.starts_with("cost ") && ran.out.contains("of the best"), "{}", ran.out);
}

#[test]
fn the_best_valley_between_threats_is_found_on_a_coarse_mesh() {
    let folder = Folder::new("valley");
    let threats = "x,y,range,peak,law\n27,38,19,1,radar\n45,70,22,0.9,radar\n52,22,17,1,radar\n\
        63,47,15,0.8,radar\n78,74,17,1,radar\n84,27,14,0.9,radar\n17,78,15,0.7,radar\n";
    fs::write(folder.0.join("threats.csv"), threats).unwrap();
    let answer = folder.json(
        "--domain 0,0,100,100 --spacing 5 --h-min 0.5 --h-max 20 --threats threats.csv \
         --from 6,12 --to 94,88 --within 1%",
    );
    let [cost, lower, upper] = ["cost", "lower", "upper"].map(|name| answer[name].as_f64().unwrap());
    // Another valley costs 166.5.
    assert!(cost < 146.5 && upper - lower <= 0.01 * upper, "{cost} {lower} {upper}");
}

#[test]
fn via_points_and_keep_out_regions_count() {
    let folder = Folder::new("around");
    let ring = "[[[0.4,-0.1],[0.6,-0.1],[0.6,0.7],[0.4,0.7],[0.4,-0.1]]]";
    fs::write(folder.0.join("wall.geojson"), format!("{{\"type\":\"Polygon\",\"coordinates\":{ring}}}"))
        .unwrap();
    let ends = "--from 0.1,0.1 --to 0.9,0.1 --spacing 0.05";
    let cost = |options: &str| folder.json(&format!("{ends} {options}"))["cost"].as_f64().unwrap();
    assert!((cost("") - 0.8).abs() < 1e-9);
    let via = 2.0 * f64::hypot(0.4, 0.5);
    assert!((cost("--via 0.5,0.6") - via).abs() < 1e-6);
    let around = 2.0 * f64::hypot(0.3, 0.6) + 0.2;
    let found = cost("--keep-out wall.geojson");
    assert!(found > around - 1e-9 && found < around * 1.1, "{found} {around}");
    let proof = folder.json(&format!("{ends} --keep-out wall.geojson --within 1%"));
    let lower = proof["lower"].as_f64().unwrap();
    assert!(lower <= around && lower > 0.97 * around, "{lower} {around}");
}

#[test]
fn every_output_is_written() {
    let folder = Folder::new("outputs");
    let outputs = "-o path.geojson -o path.csv -o path.svg -o path.png --size 200 --simplify 0.01";
    let options =
        "--from 0.1,0.1 --to 0.9,0.8 --risk 'exp(-20*hypot(x-0.5, y-0.5)^2)' --h-min 0.1 --h-max 0.2";
    let answer = folder.json(&format!("{options} {COARSE} {outputs}"));
    let points = answer["points"].as_array().unwrap();
    let feature: Value = serde_json::from_str(&folder.read("path.geojson")).unwrap();
    assert_eq!(feature["geometry"]["coordinates"].as_array().unwrap(), points);
    assert_eq!(feature["properties"]["cost"], answer["cost"]);
    let table = folder.read("path.csv");
    assert_eq!(table.lines().next().unwrap(), "x,y,distance,cost,risk,density");
    assert_eq!(table.lines().count(), points.len() + 1);
    let last: Vec<f64> = table.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert!((last[3] - answer["cost"].as_f64().unwrap()).abs() < 1e-3 * last[3]);
    assert!((last[2] - answer["length"].as_f64().unwrap()).abs() < 1e-9);
    assert!(folder.read("path.svg").contains("<polyline") && points.len() < 60);
    assert_eq!(&fs::read(folder.0.join("path.png")).unwrap()[1..4], b"PNG");
}

#[test]
fn bad_input_has_a_sentence_and_a_status() {
    let folder = Folder::new("bad");
    let ends = format!("--from 0.1,0.1 --to 0.9,0.8 {COARSE}");
    let ends = ends.as_str();
    let outside = format!("--from 0.1,0.1 --to 1.5,0.8 {COARSE}");
    for (arguments, status, message) in [
        (outside.clone(), 1, "The goal (1.5, 0.8) lies outside the domain."),
        (format!("--from 0.1 --to 1,1 {COARSE}"), 2, "“0.1” is no point."),
        (format!("{ends} --cost 'x - 0.5'"), 1, "A cost per unit of length must be positive and finite"),
        (
            format!("{ends} --cost '1 + rsk'"),
            2,
            "There is no `rsk`; a cost is a formula of `x`, `y` and `risk`.",
        ),
        (format!("{ends} --length-weight 0 --risk-weight 0"), 1, "one of them above 0."),
        (format!("{ends} --length-weight 0"), 1, "give the length a weight above 0."),
        (format!("{ends} --within 0"), 2, "--within 0: write a share"),
        (format!("{ends} -o path.vtu"), 2, "use .geojson, .csv, .svg or .png."),
        (format!("{ends} --simplify -1"), 1, "A tolerance of -1 is no distance"),
        (format!("{ends} --cost 1 --risk-weight 2"), 2, "cannot be used with"),
    ] {
        let ran = folder.run(&arguments);
        assert_eq!(ran.status, status, "{arguments}: {}", ran.err);
        assert!(ran.err.contains(message), "{arguments}: {}", ran.err);
    }
    let same = folder.json(&format!("--from 0.5,0.5 --to 0.5,0.5 {COARSE} --within 1%"));
    assert_eq!((&same["cost"], &same["lower"]), (&0.0.into(), &0.0.into()));
}
