//! Lines along which meshes have edges: in the answer of the program, and in files, which are read here by
//! themselves.

use std::collections::BTreeMap;

use crate::folder::Folder;
use serde_json::Value;

/// A breakwater with a bend, and a small island.
const LINES: &str = r#"{"type":"GeometryCollection","geometries":[
    {"type":"LineString","coordinates":[[0.2,0.3],[0.55,0.4],[0.7,0.75]]},
    {"type":"Polygon","coordinates":[[[0.2,0.7],[0.4,0.7],[0.3,0.85],[0.2,0.7]]]}]}"#;

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.file("walls.geojson", LINES);
    folder
}

/// The nodes and the nodestrings of a `.2dm`, by their names.
fn nodestrings(text: &str) -> (Vec<[f64; 2]>, BTreeMap<String, Vec<usize>>) {
    let mut names = BTreeMap::new();
    let (mut nodes, mut strings, mut open) = (Vec::new(), BTreeMap::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[0] {
            "#" if words.get(1) == Some(&"nodestring") => {
                let (number, name) = line.trim_start_matches("# nodestring ").split_once(": ").unwrap();
                names.insert(number.parse::<usize>().unwrap(), name.to_owned());
            }
            "ND" => nodes.push([words[2], words[3]].map(|word| word.parse().unwrap())),
            "NS" => {
                let numbers = words[1..].iter().map(|word| word.parse::<i64>().unwrap());
                for (place, number) in numbers.enumerate() {
                    if number > 0 {
                        open.push(number as usize - 1);
                        continue;
                    }
                    open.push(-number as usize - 1);
                    let id: usize = words[place + 2].parse().unwrap();
                    strings.insert(names[&id].clone(), std::mem::take(&mut open));
                    break;
                }
            }
            _ => {}
        }
    }
    (nodes, strings)
}

fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [p[0] - a[0], p[1] - a[1]];
    let share = (along[0] * to[0] + along[1] * to[1]) / (along[0] * along[0] + along[1] * along[1]);
    let share = share.clamp(0.0, 1.0);
    f64::hypot(to[0] - share * along[0], to[1] - share * along[1])
}

#[test]
fn lines_of_a_file_are_on_edges_and_reach_the_files_with_their_names() {
    let folder = folder("lines-files");
    let options = "--spacing 0.1 --target 0.04 --lines walls.geojson -o a.2dm -o a.msh -o a.msh2";
    let answer = folder.json("mesh", options);
    let lines = answer["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 2, "{answer}");
    for (line, length) in
        lines.iter().zip([0.35_f64.hypot(0.1) + 0.15_f64.hypot(0.35), 0.2 + 2.0 * 0.1_f64.hypot(0.15)])
    {
        let of = |key: &str| line[key].as_f64().unwrap();
        assert!(
            (of("length") - length).abs() < 1e-12 && (of("length_on_edges") - length).abs() < 1e-8,
            "{line}"
        );
        assert!(of("farthest") < 1e-8 && line["unresolved"] == Value::Array(vec![]), "{line}");
    }
    let (nodes, strings) = nodestrings(&folder.read("a.2dm"));
    let wall = [[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]];
    let string = &strings["walls 1"];
    let off = |&node: &usize| {
        let sides = [[wall[0], wall[1]], [wall[1], wall[2]]];
        sides.into_iter().map(|side| distance(nodes[node], side)).fold(f64::INFINITY, f64::min)
    };
    assert!(string.len() > 10 && string.iter().map(off).fold(0.0, f64::max) < 2e-9);
    let island = &strings["walls 2"];
    assert_eq!((island.first(), island.len() > 10), (island.last(), true), "a closed line");
    // Each step of a string is an edge of a triangle.
    let text = folder.read("a.2dm");
    let triangles: Vec<Vec<usize>> = text
        .lines()
        .filter(|line| line.starts_with("E3T"))
        .map(|line| {
            line.split_whitespace().skip(2).take(3).map(|word| word.parse::<usize>().unwrap() - 1).collect()
        })
        .collect();
    for pair in string.windows(2).chain(island.windows(2)) {
        let beside = triangles.iter().filter(|triangle| pair.iter().all(|node| triangle.contains(node)));
        assert_eq!(beside.count(), 2, "{pair:?}");
    }
    for file in ["a.msh", "a.msh2"] {
        let text = folder.read(file);
        assert!(text.contains("\"walls 1\"") && text.contains("\"walls 2\""), "{file}");
    }
    let groups = |text: &str| text.lines().filter(|line| line.split(' ').nth(1) == Some("1")).count();
    let elements = folder.read("a.msh2");
    let elements = elements.split("$Elements").nth(1).unwrap();
    let mut sides: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for triangle in &triangles {
        let [a, b, c] = triangle[..] else { panic!("{triangle:?}") };
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *sides.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    let around = sides.values().filter(|&&count| count == 1).count();
    assert_eq!(groups(elements), around + string.len() + island.len() - 2, "edges of curves");
}

#[test]
fn recipes_have_lines_and_those_of_options_are_added() {
    let folder = folder("lines-recipe");
    let mesh = "[mesh]\nspacing = 0.1\n\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"0.04\"\n";
    folder.file("a.toml", format!("{mesh}\n[[line]]\nfile = \"walls.geojson\"\n"));
    let walls = r#"[[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]]"#;
    let island = r#"[[0.2, 0.7], [0.4, 0.7], [0.3, 0.85]]"#;
    let in_place = format!(
        "{mesh}\n[[line]]\nname = \"walls 2\"\npoints = {island}\nclosed = true\n\n[[line]]\nname = \"walls 1\"\npoints = {walls}\n"
    );
    folder.file("b.toml", in_place);
    let nodes = |options: &str| {
        let answer = folder.json("mesh", format!("{options} -o a.vtu"));
        (answer["nodes"].clone(), answer["triangles"].clone(), answer["statistics"].clone())
    };
    // In another order, with the same edges.
    assert_eq!(nodes("a.toml"), nodes("b.toml"));
    assert_eq!(nodes("a.toml"), nodes("--spacing 0.1 --target 0.04 --lines walls.geojson"));
    let added = folder.json("mesh", "b.toml --lines walls.geojson");
    assert_eq!(added["lines"].as_array().unwrap().len(), 4);
    for (line, sentence) in [
        ("name = \"a\"", "a line needs `points` or `file`"),
        ("points = [[0, 0]]", "a line needs 2 points at least"),
        ("points = [[0, 0], [1, 1]]\nfile = \"walls.geojson\"", "a line has `points` or `file`, not both"),
        ("file = \"gone.geojson\"", "gone.geojson"),
        ("file = \"walls.geojson\"\nclosed = true", "polygons are closed lines"),
    ] {
        folder.file("bad.toml", format!("{mesh}\n[[line]]\n{line}\n"));
        let ran = folder.run("mesh bad.toml");
        assert!(ran.status != 0 && ran.err.contains(sentence), "{line}: {}", ran.err);
    }
}

#[test]
fn what_the_mesh_cannot_resolve_is_listed_with_its_place() {
    let folder = Folder::new("lines-coarse");
    let line =
        r#"{"type":"LineString","coordinates":[[0.1,0.5],[0.5,0.5],[0.5,0.501],[0.9,0.501],[1.5,0.501]]}"#;
    folder.file("step.geojson", line);
    let answer = folder.json("mesh", "--spacing 0.1 --target 0.1 --lines step.geojson");
    let line = &answer["lines"][0];
    let parts = line["unresolved"].as_array().unwrap();
    assert!(line["length_on_edges"].as_f64() < line["length"].as_f64() && !parts.is_empty(), "{line}");
    let reasons: Vec<&str> = parts.iter().map(|part| part["reason"].as_str().unwrap()).collect();
    assert!(reasons.contains(&"it is not in the domain"), "{reasons:?}");
    let text = folder.run("mesh --spacing 0.1 --target 0.1 --lines step.geojson");
    assert!(text.err.contains("line “step”:"), "{}", text.err);
    folder.file("points.geojson", r#"{"type":"Point","coordinates":[0.1,0.5]}"#);
    let ran = folder.run("mesh --lines points.geojson");
    assert!(ran.status == 1 && ran.err.contains("has no lines and no polygons"), "{}", ran.err);
}
