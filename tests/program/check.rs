//! `meshbrush check`: the rules of solvers on the mesh as its file has it, against counts from the files.

use std::collections::{HashMap, HashSet};

use crate::folder::Folder;
use serde_json::Value;

/// A square of which every side is open, as in the smallest case in which ADCIRC doubled the tide.
const SQUARE: &str = "--domain 0,0,40000,40000 --spacing 10000 --quantity depth=50";
/// A sea with a coast of polygons that is too coarse for its bays.
const BAY: &str = r#"{"type": "Polygon", "coordinates": [[[0, 0], [8, 0], [8, 3], [6.2, 3.1], [6, 6], [5.8, 3.2], [4, 3],
    [3.1, 5], [2.8, 3], [0, 3], [0, 0]], [[3, 1], [3, 1.4], [3.4, 1.4], [3.4, 1], [3, 1]]]}"#;

fn check(folder: &Folder, arguments: &str, solver: &str) -> (i32, Value) {
    let ran = folder.run(format!("check {arguments} --for {solver} --json").as_str());
    assert_eq!(ran.out.lines().count(), 1, "{arguments} {solver}: {}", ran.err);
    (ran.status, ran.json())
}

/// Returns how many violations of a rule there are.
fn count(answer: &Value, rule: &str) -> usize {
    let violations = answer["violations"].as_array().unwrap();
    let of_rule = violations.iter().filter(|violation| violation["rule"] == rule).count();
    let listed = answer["rules"].as_array().unwrap().iter().find(|row| row["rule"] == rule).unwrap();
    assert_eq!(listed["count"], of_rule);
    of_rule
}

/// Reads triangles, boundary nodes and open nodes from the files of FVCOM.
fn read_fvcom(folder: &Folder, stem: &str) -> (Vec<[usize; 3]>, HashSet<usize>, HashSet<usize>) {
    let grid = folder.read(&format!("{stem}_grd.dat"));
    let triangles: usize = grid.lines().nth(1).unwrap().rsplit(' ').next().unwrap().parse().unwrap();
    let row = |line: &str| line.split(' ').map(|word| word.parse().unwrap()).collect::<Vec<usize>>();
    let corners = |line: &str| <[usize; 3]>::try_from(&row(line)[1..4]).unwrap();
    let triangles: Vec<[usize; 3]> = grid.lines().skip(2).take(triangles).map(corners).collect();
    let mut uses: HashMap<[usize; 2], usize> = HashMap::new();
    for &[a, b, c] in &triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *uses.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    let boundary = uses.iter().filter(|(_, count)| **count == 1).flat_map(|(edge, _)| *edge).collect();
    let open = folder.read(&format!("{stem}_obc.dat"));
    let open = open.lines().skip(1).map(|line| row(line)[1]).collect();
    (triangles, boundary, open)
}

#[test]
fn violations_are_those_that_the_files_have() {
    let folder = Folder::new("check-files");
    folder.file("bay.geojson", BAY);
    let bay =
        "--region bay.geojson --bounds 0,0,8,6 --open frame --spacing 2 --boundary-diameter 1 --target 1";
    for arguments in [SQUARE, bay] {
        let written = folder.run(format!("mesh {arguments} -o sea.dat").as_str());
        assert_eq!(written.status, 0, "{}", written.err);
        let (triangles, boundary, open) = read_fvcom(&folder, "sea");
        let sum = |node: &usize| usize::from(boundary.contains(node)) + usize::from(open.contains(node));
        let broken = triangles.iter().filter(|corners| corners.iter().map(sum).sum::<usize>() > 4).count();
        let options = arguments.split(" --quantity").next().unwrap();
        let (status, answer) = check(&folder, options, "fvcom");
        assert_eq!(count(&answer, "two_open_nodes_and_shore"), broken, "{arguments}");
        assert_eq!((status == 1, &answer["triangles"]), (broken > 0, &triangles.len().into()));
        let shore = triangles.iter().filter(|corners| corners.iter().all(|node| boundary.contains(node)));
        let expected = shore.count();
        assert!(expected > 0, "{arguments}");
        assert_eq!(count(&check(&folder, options, "telemac").1, "overconstrained_triangle"), expected);
    }
}

#[test]
fn a_mesh_that_keeps_the_rules_passes_and_one_that_breaks_them_fails_after_its_answer() {
    let folder = Folder::new("check-status");
    let (status, answer) = check(&folder, SQUARE, "adcirc");
    assert_eq!(
        (status, &answer["violations"], &answer["notes"]),
        (0, &Value::Array(vec![]), &Value::Array(vec![]))
    );
    let (status, answer) = check(&folder, &SQUARE.replace("=50", "=x-9000"), "adcirc");
    let notes = answer["notes"].as_array().unwrap();
    assert_eq!((status, notes.len(), &notes[0]["rule"]), (0, 5, &"dry_node".into()), "notes break nothing");
    let (status, answer) = check(&folder, SQUARE, "fvcom");
    let first = &answer["violations"][0];
    assert_eq!((status, first["source"].as_str()), (1, Some("FVCOM tge.F")));
    let [x, y] = [0, 1].map(|n| first["place"][n].as_f64().unwrap());
    assert!((0.0..40000.0).contains(&x) && (0.0..40000.0).contains(&y));
    assert!(first["sentence"].as_str().unwrap().contains("the sum over its nodes is 6, and may be 4"));

    let text = folder.run(format!("check {SQUARE} --for fvcom").as_str());
    assert!(
        text.status == 1 && text.err.contains("The mesh breaks rules of FVCOM in 2 places."),
        "{}",
        text.err
    );
    assert!(
        text.out.starts_with("FVCOM: 2 violations of 7 rules in 32 triangles, with x, y\n"),
        "{}",
        text.out
    );
    assert!(text.out.contains("\ntwo_open_nodes_and_shore (FVCOM tge.F): 2\n  x = "), "{}", text.out);
    let text = folder.run(format!("check {SQUARE} --for schism").as_str());
    assert_eq!(
        (text.status, text.out.as_str()),
        (0, "SCHISM: no violation of 7 rules in 32 triangles, with x, y\n")
    );
}

#[test]
fn links_of_squares_vanish_and_places_are_in_the_coordinates_of_the_file() {
    let folder = Folder::new("check-links");
    for (cells, short) in [("", 0), ("--cells triangles", 16)] {
        let (_, answer) = check(&folder, &format!("--domain 0,0,4,4 --spacing 1 {cells}"), "delft3dfm");
        assert_eq!((count(&answer, "short_flow_link"), count(&answer, "skewed_flow_link")), (short, 0));
    }
    folder.file("bay.geojson", BAY);
    let bay = "--region bay.geojson --projection auto --spacing 100000";
    for (crs, coordinates, largest) in
        [("lonlat", "longitude, latitude in degrees", 8.0), ("plane", "x, y in ", 1e7)]
    {
        let (_, answer) = check(&folder, &format!("{bay} --cells triangles --out-crs {crs}"), "delft3dfm");
        assert!(
            answer["coordinates"].as_str().unwrap().starts_with(coordinates),
            "{}",
            answer["coordinates"]
        );
        let far = |place: &Value| place["place"][0].as_f64().unwrap().abs() > 8.0;
        let places = answer["violations"].as_array().unwrap();
        assert!(!places.is_empty() && places.iter().any(far) == (largest > 8.0), "{crs}");
    }
}

#[test]
fn a_boundary_that_touches_itself_is_named_with_the_rules_that_wait_for_it() {
    let folder = Folder::new("check-touches");
    let words = ["check", "--domain", "0,0,4,4", "--spacing", "1", "--inside", "max(x,y)<=2 or min(x,y)>=2"];
    let words = [&words[..], &["--boundary", "report"]].concat();
    let ran = folder.run([&words[..], &["--for", "fvcom", "--json"]].concat());
    let answer = ran.json();
    assert_eq!((ran.status, count(&answer, "boundaries_that_touch")), (1, 1));
    assert_eq!(answer["violations"][0]["place"], serde_json::json!([2.0, 2.0]));
    let unchecked =
        serde_json::json!(["open_piece_without_edge", "two_open_nodes_and_shore", "strip_along_frame"]);
    assert_eq!(answer["unchecked"], unchecked);
    let ran = folder.run("check --for roms");
    assert!(ran.status == 2 && ran.err.contains("“roms” is no solver whose rules are known"), "{}", ran.err);
    assert_eq!(folder.run("check").status, 2, "--for is needed");
}

/// Returns how many triangles in the files of FVCOM have two open nodes and a third one on the boundary, and
/// how many have no node inside.
pub fn refused(folder: &Folder, stem: &str) -> [usize; 2] {
    let (triangles, boundary, open) = read_fvcom(folder, stem);
    let sum = |node: &usize| usize::from(boundary.contains(node)) + usize::from(open.contains(node));
    let is_refused = |corners: &&[usize; 3]| corners.iter().map(sum).sum::<usize>() > 4;
    let is_shore = |corners: &&[usize; 3]| corners.iter().all(|node| boundary.contains(node));
    [triangles.iter().filter(is_refused).count(), triangles.iter().filter(is_shore).count()]
}

#[test]
fn smaller_triangles_mend_what_they_can_in_the_mesh_itself() {
    let folder = Folder::new("check-repair");
    folder.file("bay.geojson", BAY);
    let recipe = "[domain]\nregion = \"bay.geojson\"\nbounds = [0, 0, 8, 6]\nopen = [\"frame\"]\nboundary_diameter = 1.5\n
[mesh]\nspacing = 2\n\n[limits]\nh_min = 1.5\n\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"1.5\"\n\n";
    folder.file("bay.toml", recipe);
    for (solver, column) in [("fvcom", 0), ("telemac", 1)] {
        assert_eq!(folder.run("mesh bay.toml -o before.dat").status, 0);
        let before = refused(&folder, "before")[column];
        let ran = folder.run(format!("mesh bay.toml --repair-for {solver} -o after.dat --json").as_str());
        let mended = ran.json();
        let left = mended["repaired"]["left"].as_u64().unwrap() as usize;
        assert_eq!(refused(&folder, "after")[column], left, "{solver}: what is left is counted");
        assert!(before > left && mended["repaired"]["bisected"].as_u64() > Some(0), "{before} {left}");
        assert!(ran.err.contains("bisected once more"), "{}", ran.err);
        // The smallest diameter has to be less, and the layers keep it elsewhere.
        assert!(mended["repaired"]["h_min"].as_f64().unwrap() < 1.5);
        let checked = check(&folder, "bay.toml --repair", solver).1;
        assert_eq!(checked["hash"], mended["hash"]);

        // The text for a recipe makes the same mesh, where nothing is repaired.
        let text = folder.run(format!("check bay.toml --for {solver} --repair").as_str()).out;
        let layers = &text[text.find("\n[limits]\n").unwrap()..];
        let layers = layers.split("\nnot checked").next().unwrap();
        let own = recipe.split("[limits]").next().unwrap();
        let base = &recipe[recipe.find("[[layer]]").unwrap()..];
        let (limits, repair) = layers.split_at(layers.find("[[layer]]").unwrap());
        folder.file("mended.toml", format!("{own}{limits}{base}{repair}"));
        let again = folder.run("mesh mended.toml --json").json();
        assert_eq!((&again["hash"], again.get("repaired")), (&mended["hash"], None), "{layers}");
    }
}

#[test]
fn an_area_whose_rules_are_kept_is_not_repaired_and_the_vertex_rule_cannot_be() {
    let folder = Folder::new("check-repair-none");
    let [plain, repaired] = ["", " --repair-for adcirc"].map(|option| {
        let domain = SQUARE.split(" --quantity").next().unwrap();
        folder.run(format!("mesh {domain} --json{option}").as_str())
    });
    assert_eq!(plain.json()["hash"], repaired.json()["hash"]);
    assert!(repaired.err.contains("For ADCIRC no triangle was bisected once more."), "{}", repaired.err);
    let (_, answer) = check(&folder, &format!("{SQUARE} --repair"), "fvcom");
    assert_eq!((&answer["repaired"]["left"], answer["violations"].as_array().unwrap().len()), (&0.into(), 0));
    // Whatever all sizes are multiplied by, one bisection at each corner is enough.
    for scale in ["0.5", "3", "0.01"] {
        let options = format!("{SQUARE} --scale {scale} --repair");
        let (status, answer) = check(&folder, &options, "fvcom");
        assert_eq!((status, &answer["repaired"]["bisected"]), (0, &2.into()), "{options}: {answer}");
    }
    let ran = folder.run(format!("check {SQUARE} --rule vertex --for fvcom --repair").as_str());
    assert!(ran.status == 2 && ran.err.contains("--repair: by the vertex rule"), "{}", ran.err);
}
